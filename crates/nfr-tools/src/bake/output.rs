//! From strikes to the files of a format.

use std::path::{Path, PathBuf};

use nfr_convert::compare::report::glyph_count_text;
use read_fonts::FontRef;

use super::atlas::atlas;
use super::bdf::bdf;
use super::face::Face;
use super::lvgl::{lvgl, symbol};
use super::strike::Strike;
use super::strikes::{check, tables};
use super::{sfnt, strikes};
use crate::failure::Failure;

/// A format of bitmaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// Strikes in a font file.
    Ttf,
    Bdf,
    Lvgl,
    /// An atlas.
    Png,
}

impl Format {
    /// The format of a name.
    pub(super) fn from_name(name: &str) -> Result<Self, String> {
        match name {
            "ttf" => Ok(Self::Ttf),
            "bdf" => Ok(Self::Bdf),
            "lvgl" => Ok(Self::Lvgl),
            "png" => Ok(Self::Png),
            _ => Err("use ttf, bdf, lvgl or png".into()),
        }
    }

    /// The format of a file's name.
    pub(super) fn of_path(path: &Path) -> Result<Self, Failure> {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "ttf" | "otb" => Ok(Self::Ttf),
            "bdf" => Ok(Self::Bdf),
            "c" => Ok(Self::Lvgl),
            "png" => Ok(Self::Png),
            _ => Err(Failure::usage(format!(
                "{}: no format is known by this name; end it in .ttf, .otb, .bdf, .c or .png, or pass --format",
                path.display()
            ))),
        }
    }

    /// Bits a pixel where none are asked for.
    pub(super) fn default_bits(self) -> u8 {
        match self {
            Self::Ttf | Self::Png => 8,
            Self::Lvgl => 4,
            Self::Bdf => 1,
        }
    }
}

/// What files are made from.
pub(super) struct Job<'j> {
    pub(super) format: Format,
    pub(super) file: &'j FontRef<'j>,
    pub(super) font_bytes: usize,
    pub(super) face: &'j Face,
    pub(super) strikes: &'j [Strike],
    pub(super) strikes_only: bool,
}

/// A file that is ready to be written.
pub(super) struct Made {
    pub(super) path: PathBuf,
    pub(super) bytes: Vec<u8>,
    /// For people.
    pub(super) summary: String,
}

/// Makes all files of a job.
///
/// # Errors
///
/// What the format cannot hold.
pub(super) fn baked(job: &Job<'_>, path: &Path, warn: impl Fn(&str)) -> Result<Vec<Made>, Failure> {
    if job.format == Format::Ttf {
        return Ok(vec![font(job, path, warn)?]);
    }
    let mut files = Vec::new();
    for strike in job.strikes {
        let path = if job.strikes.len() > 1 { sized(path, strike.ppem) } else { path.to_owned() };
        let of = of_strike(strike);
        match job.format {
            Format::Bdf => {
                let bytes = bdf(strike, job.face).into_bytes();
                files.push(Made { summary: format!("{of}, {} bytes", bytes.len()), bytes, path });
            }
            Format::Png => files.extend(picture(strike, job.face, path, &of)?),
            _ => files.push(c_file(strike, job.face, path, &of, &warn)?),
        }
    }
    Ok(files)
}

/// `96 glyphs at 12 ppem, 4 bits a pixel`.
fn of_strike(strike: &Strike) -> String {
    let bits = if strike.bits == 1 { "1 bit" } else { &format!("{} bits", strike.bits) };
    format!("{} at {} ppem, {bits} a pixel", glyph_count_text(strike.glyphs.len()), strike.ppem)
}

fn font(job: &Job<'_>, path: &Path, warn: impl Fn(&str)) -> Result<Made, Failure> {
    for strike in job.strikes {
        check(strike, job.face)?;
    }
    let replaced = sfnt::bitmap_tables(job.file);
    if !replaced.is_empty() {
        warn(&format!("warning: the font has bitmaps already ({}); they are replaced", replaced.join(", ")));
    }
    let tables: strikes::Tables = tables(job.strikes);
    let lengths = (tables.eblc.len(), tables.ebdt.len());
    let bytes = sfnt::assemble(job.file, tables, job.strikes_only);
    let sizes: Vec<String> = job.strikes.iter().map(|strike| strike.ppem.to_string()).collect();
    let summary = format!(
        "{} at {} ppem; tables EBLC, {} bytes, and EBDT, {} bytes; the font has {} bytes, {} before",
        glyph_count_text(job.face.gids.len()),
        sizes.join(", "),
        lengths.0,
        lengths.1,
        bytes.len(),
        job.font_bytes
    );
    Ok(Made { path: path.to_owned(), bytes, summary })
}

fn picture(strike: &Strike, face: &Face, path: PathBuf, of: &str) -> Result<[Made; 2], Failure> {
    let json = path.with_extension("json");
    if json == path {
        return Err(Failure::usage(format!(
            "{}: the description is written beside the picture as .json; end the picture's name in .png",
            path.display()
        )));
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let atlas = atlas(strike, face, &name)?;
    let summary = format!("{of}, {}×{} pixels, {} bytes", atlas.width, atlas.height, atlas.png.len());
    let described = format!("where they are, {} bytes", atlas.json.len());
    Ok([Made { path, bytes: atlas.png, summary }, Made { path: json, bytes: atlas.json, summary: described }])
}

fn c_file(
    strike: &Strike,
    face: &Face,
    path: PathBuf,
    of: &str,
    warn: impl Fn(&str),
) -> Result<Made, Failure> {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let symbol = symbol(&stem);
    let made = lvgl(strike, face, &symbol)?;
    if made.left_out > 0 {
        let left_out = glyph_count_text(made.left_out);
        warn(&format!("warning: {symbol} lacks {left_out}, for which no character stands"));
    }
    if made.is_large {
        warn(&format!("warning: {symbol} needs LV_FONT_FMT_TXT_LARGE, set to 1 in lv_conf.h"));
    }
    let summary = format!("{of}, for {} characters; {symbol} takes {} bytes", made.characters, made.bytes);
    Ok(Made { path, bytes: made.text.into_bytes(), summary })
}

/// A file's name with a size before its extension.
fn sized(path: &Path, ppem: u16) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("_{ppem}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}
