//! `nfr info`: what a neural font carries.

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::PathBuf;

use serde::Serialize;

use super::failure::Failure;
use super::files::{open_neural, read};
use nfr::internals::network::Precision;
use nfr::internals::table::{MAJOR_VERSION, MINOR_VERSION, NETWORK_MINOR_VERSION};
use nfr_convert::select::glyph_count;

/// Says what a neural font carries
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The neural font
    font: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
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
    Ok(())
}
