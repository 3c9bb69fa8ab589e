//! The ground truth as files: a PNG for each glyph and size, and a manifest that says what they are.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Cursor};
use std::path::Path;

use image::{GrayImage, ImageFormat};
use serde::Serialize;

use super::{Truth, TruthSize};
use crate::SquareBitmap;
use nfr_convert::error::Error;

/// The file that says what the others are.
const MANIFEST: &str = "manifest.json";

#[derive(Serialize)]
struct Manifest<'m> {
    font: &'m str,
    set: String,
    warnings: &'m [String],
    sizes: Vec<SizeEntry>,
}

#[derive(Serialize)]
struct SizeEntry {
    side: usize,
    point_size: u32,
    resolution: u32,
    ppem: u16,
    x_min: i32,
    y_min: i32,
    x_max: i32,
    y_max: i32,
    files: BTreeMap<String, String>,
}

/// Writes a directory with one PNG for each glyph and size, named as `20/u0061.png`, ink black on white, and
/// `manifest.json` with the font's name, the set, and of each size the side in pixels, the size in points, the
/// resolution in dpi, the pixels per em, the box in pixels from the origin, and the files by code point. A truth that
/// was written there before is replaced. The directory appears whole or not at all.
///
/// # Errors
///
/// `InvalidParameter` for a glyph that the truth does not have; `Io` if the directory cannot be written, or has files
/// that are not a truth.
pub fn store(truth: &Truth, font: &str, glyphs: &[(char, u16)], directory: &Path) -> Result<(), Error> {
    check_replaceable(directory)?;
    let failed = |error: io::Error| {
        Error::Io(format!(
            "cannot write {} ({}); choose a place that exists and that you may write to",
            directory.display(),
            error.kind()
        ))
    };
    let parent = directory.parent().filter(|parent| !parent.as_os_str().is_empty());
    let beside = tempfile::Builder::new().prefix(".nfr-").tempdir_in(parent.unwrap_or(Path::new(".")));
    let beside = beside.map_err(failed)?;
    let (fresh, old) = (beside.path().join("fresh"), beside.path().join("old"));
    for (name, bytes) in files(truth, font, glyphs)? {
        let path = fresh.join(name);
        path.parent().map_or(Ok(()), fs::create_dir_all).map_err(failed)?;
        fs::write(path, bytes).map_err(failed)?;
    }
    if directory.exists() {
        fs::rename(directory, &old).map_err(failed)?;
    }
    fs::rename(&fresh, directory).map_err(failed)
}

/// Every file of a stored truth: its name and its bytes.
fn files(truth: &Truth, font: &str, glyphs: &[(char, u16)]) -> Result<Vec<(String, Vec<u8>)>, Error> {
    let (mut files, mut sizes) = (Vec::new(), Vec::new());
    for (index, size) in truth.sizes.iter().enumerate() {
        let mut names = BTreeMap::new();
        for &(character, gid) in glyphs {
            let code = u32::from(character);
            let name = format!("{}/u{code:04x}.png", size.side);
            files.push((name.clone(), png(&truth.hinted(gid, index)?)?));
            names.insert(format!("U+{code:04X}"), name);
        }
        let TruthSize { side, point_size, resolution, ppem, bounds: [x_min, y_min, x_max, y_max] } = *size;
        sizes.push(SizeEntry {
            side,
            point_size,
            resolution,
            ppem,
            x_min,
            y_min,
            x_max,
            y_max,
            files: names,
        });
    }
    let set = glyphs.iter().map(|(character, _)| *character).collect();
    let manifest = Manifest { font, set, warnings: &truth.warnings, sizes };
    let json = serde_json::to_string_pretty(&manifest);
    let json = json.map_err(|e| Error::Io(format!("{MANIFEST} cannot be written ({e})")))?;
    files.push((MANIFEST.into(), (json + "\n").into()));
    Ok(files)
}

/// Coverage as a grey picture, ink black on white.
fn png(square: &SquareBitmap) -> Result<Vec<u8>, Error> {
    let side = square.side as u32;
    let ink = square.pixels.iter().map(|coverage| 255 - coverage).collect();
    let mut file = Cursor::new(Vec::new());
    let written =
        GrayImage::from_raw(side, side, ink).map(|picture| picture.write_to(&mut file, ImageFormat::Png));
    match written {
        Some(Ok(())) => Ok(file.into_inner()),
        _ => Err(Error::LimitExceeded(format!("a picture of {side}×{side} pixels cannot be written"))),
    }
}

/// Refuses a directory with other files than a truth, so that nothing else is deleted.
fn check_replaceable(directory: &Path) -> Result<(), Error> {
    let occupied = if directory.is_dir() {
        let entries = fs::read_dir(directory).map(|mut entries| entries.next().is_some());
        entries.unwrap_or(true) && !directory.join(MANIFEST).is_file()
    } else {
        directory.exists()
    };
    if occupied {
        let place = directory.display();
        return Err(Error::Io(format!(
            "{place} exists and has other files than a ground truth; name an empty or a new directory"
        )));
    }
    Ok(())
}
