//! `nfr info`: what a neural font carries.

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::PathBuf;

use serde::Serialize;

use super::failure::Failure;
use super::files::{open_neural, read};
use nfr::internals::network::Precision;
use nfr::internals::table::{DropoutModes, MAJOR_VERSION, MINOR_VERSION, NETWORK_MINOR_VERSION, Table};
use nfr_convert::compare::certificate::StatedErrors;
use nfr_convert::compare::report::glyph_count_text;
use nfr_convert::select::glyph_count;

/// Says what a neural font carries
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The neural font
    font: PathBuf,
    /// Print a line for each glyph that has a model: its bytes, and what the certificate says of its errors
    #[arg(long, conflicts_with = "json")]
    glyphs: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What the certificate says.
#[derive(Debug, Serialize)]
struct CertificateInfo {
    teacher: String,
    converter: String,
    options: String,
    is_exact: bool,
    glyphs: Vec<GlyphInfo>,
}

#[derive(Debug, Serialize)]
struct GlyphInfo {
    gid: u16,
    #[serde(flatten)]
    errors: StatedErrors,
}

impl CertificateInfo {
    fn of(table: &Table<'_>) -> Option<Self> {
        let certificate = table.certificate()?;
        let glyphs = table.gids().zip(certificate.errors());
        Some(Self {
            teacher: certificate.teacher.to_owned(),
            converter: certificate.converter.to_owned(),
            options: certificate.options.to_owned(),
            is_exact: certificate.is_exact,
            glyphs: glyphs.map(|(gid, errors)| GlyphInfo { gid, errors: errors.into() }).collect(),
        })
    }

    fn print(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "teacher         {}", self.teacher)?;
        writeln!(out, "converted by    {} {}", self.converter, self.options)?;
        let Some(worst) = self.glyphs.iter().max_by(|a, b| a.errors.mae.total_cmp(&b.errors.mae)) else {
            return Ok(());
        };
        let mean = self.glyphs.iter().map(|glyph| glyph.errors.mae).sum::<f64>() / self.glyphs.len() as f64;
        let bad16 = self.glyphs.iter().map(|glyph| glyph.errors.bad16).fold(0.0, f64::max);
        let max = self.glyphs.iter().map(|glyph| glyph.errors.max).max().unwrap_or(0);
        writeln!(
            out,
            "errors          mae {mean:.5} on average and {:.5} for glyph {}; bad16 {:.3} % and a pixel's {max} of 255, at most",
            worst.errors.mae,
            worst.gid,
            100.0 * bad16
        )?;
        let exact = if self.is_exact { "all hinted points are the teacher's" } else { "not promised" };
        writeln!(out, "exactness       {exact}")
    }
}

#[derive(Debug, Serialize)]
struct Info {
    version: String,
    target: &'static str,
    first_ppem: u16,
    last_ppem: u16,
    glyphs_with_models: usize,
    glyphs: u32,
    table_bytes: usize,
    bytes_per_glyph: f64,
    file_bytes: usize,
    outlines_match: bool,
    outlines_dropped: bool,
    /// How many of the glyphs with models have a network instead.
    networks: usize,
    /// The bytes of all networks.
    network_bytes: usize,
    /// Bits of their weights, each kind once.
    network_bits: Vec<u8>,
    certificate: Option<CertificateInfo>,
}

/// Runs `nfr info`.
///
/// # Errors
///
/// A file that cannot be read, or that is no neural font.
pub fn run(args: &Args) -> Result<(), Failure> {
    let data = read(&args.font)?;
    let (file, font) = open_neural(&args.font, &data)?;
    let (first_ppem, last_ppem) = font.ppem_range();
    let glyphs_with_models = font.modelled_glyphs().count();
    let table = nfr::internals::table(&font)?;
    let networks: Vec<u32> = table.network_gids().map(u32::from).collect();
    let network_bytes = networks.iter().map(|gid| font.model_len(*gid)).sum::<Result<usize, _>>();
    let network_bits = networks.iter().map(|gid| table.precision(*gid).map(Precision::bits));
    let network_bits = network_bits.collect::<Result<BTreeSet<u8>, _>>();
    // The reader refuses any other major version.
    let minor = if networks.is_empty() { MINOR_VERSION } else { NETWORK_MINOR_VERSION };
    let info = Info {
        version: format!("{}.{minor}", MAJOR_VERSION),
        target: font.target().name(),
        first_ppem,
        last_ppem,
        glyphs_with_models,
        glyphs: glyph_count(&file)?,
        table_bytes: font.table_len(),
        bytes_per_glyph: font.table_len() as f64 / glyphs_with_models.max(1) as f64,
        file_bytes: data.len(),
        outlines_match: font.outlines_match(),
        outlines_dropped: font.outlines_dropped(),
        networks: networks.len(),
        network_bytes: network_bytes?,
        network_bits: network_bits?.into_iter().collect(),
        certificate: CertificateInfo::of(&table),
    };
    let mut out = io::stdout().lock();
    if args.json {
        let json = serde_json::to_string(&info).map_err(|e| Failure::failed(e.to_string()))?;
        writeln!(out, "{json}")?;
        return Ok(());
    }
    writeln!(out, "table version   {}", info.version)?;
    writeln!(out, "target          {}", info.target)?;
    writeln!(out, "sizes           {first_ppem}-{last_ppem} ppem")?;
    writeln!(out, "glyphs          {} of {} have models", info.glyphs_with_models, info.glyphs)?;
    if info.networks > 0 {
        let bits: Vec<String> = info.network_bits.iter().map(u8::to_string).collect();
        let bits = bits.join(" and ");
        writeln!(
            out,
            "networks        {}, {} bytes, weights of {bits} bits",
            info.networks, info.network_bytes
        )?;
    }
    writeln!(out, "table           {} bytes, {:.1} per glyph", info.table_bytes, info.bytes_per_glyph)?;
    writeln!(out, "file            {} bytes", info.file_bytes)?;
    let outlines = match (info.outlines_dropped, info.outlines_match) {
        (true, _) => "dropped for the glyphs that have models",
        (false, true) => "those that the models were trained from",
        (false, false) => "changed after training; convert the font again",
    };
    writeln!(out, "outlines        {outlines}")?;
    match &info.certificate {
        Some(certificate) => certificate.print(&mut out)?,
        None => writeln!(out, "certificate     none")?,
    }
    if let Some(dropout) = table.dropout() {
        writeln!(out, "drop-outs       {}", dropout_text(first_ppem, &dropout))?;
    }
    if args.glyphs {
        print_glyphs(&mut out, &table, info.certificate.as_ref())?;
    }
    Ok(())
}

/// A line for each glyph that has a model.
fn print_glyphs(
    out: &mut impl Write,
    table: &Table<'_>,
    certificate: Option<&CertificateInfo>,
) -> Result<(), Failure> {
    writeln!(out, "\n{:>7}{:>8}{:>11}{:>11}{:>6}", "glyph", "bytes", "mae", "bad16", "max")?;
    for (index, gid) in table.gids().enumerate() {
        write!(out, "{gid:>7}{:>8}", table.model_len(gid.into())?)?;
        match certificate.and_then(|certificate| certificate.glyphs.get(index)) {
            Some(GlyphInfo { errors: StatedErrors { mae, bad16, max }, .. }) => {
                writeln!(out, "{mae:>11.6}{bad16:>11.6}{max:>6}")?;
            }
            None => writeln!(out, "{:>11}{:>11}{:>6}", "-", "-", "-")?,
        }
    }
    Ok(())
}

/// The modes of drop-out control for people.
fn dropout_text(first_ppem: u16, dropout: &DropoutModes<'_>) -> String {
    let (mut first, mut parts) = (first_ppem, Vec::new());
    for (last, mode) in dropout.ranges() {
        let stubs = if mode.fills_stubs() { " with stubs" } else { "" };
        let name = match (mode.is_enabled(), mode.is_smart()) {
            (false, _) => "none",
            (true, true) => "smart",
            (true, false) => "simple",
        };
        let sizes = if first == last { last.to_string() } else { format!("{first}-{last}") };
        parts.push(format!("{name}{stubs} at {sizes} ppem"));
        first = last + 1;
    }
    let glyphs: BTreeSet<u16> = dropout.exceptions().map(|exception| exception.gid).collect();
    if !glyphs.is_empty() {
        parts.push(format!("others for {}", glyph_count_text(glyphs.len())));
    }
    parts.join(", ")
}
