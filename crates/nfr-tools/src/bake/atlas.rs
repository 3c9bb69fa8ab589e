//! A texture atlas: one grey picture with all glyphs, and a JSON file that says where each is.

use std::io::Cursor;

use image::{GrayImage, ImageFormat};
use serde::Serialize;

use super::face::Face;
use super::strike::{Glyph, Strike};
use crate::failure::Failure;

/// Blank pixels around each glyph, so that a texture that is scaled or filtered does not mix neighbours.
const GAP: u32 = 1;
/// The longest side of a texture that graphics drivers take everywhere that is not a telephone.
const MAX_SIDE: u32 = 16384;

/// An atlas as two files.
#[derive(Debug)]
pub(super) struct Atlas {
    pub(super) png: Vec<u8>,
    pub(super) json: Vec<u8>,
    pub(super) width: u32,
    pub(super) height: u32,
}

#[derive(Debug, Serialize)]
struct Description<'f> {
    font: &'f str,
    /// The file name of the picture.
    image: &'f str,
    width: u32,
    height: u32,
    ppem: u16,
    bits: u8,
    line: Line,
    glyphs: Vec<Entry<'f>>,
}

/// As in `nfr::LineMetrics`.
#[derive(Debug, Serialize)]
struct Line {
    ascent: f32,
    descent: f32,
    line_gap: f32,
    underline_position: f32,
    underline_thickness: f32,
}

#[derive(Debug, Serialize)]
struct Entry<'f> {
    gid: u16,
    name: Option<&'f str>,
    characters: Vec<char>,
    x: u32,
    y: u32,
    width: u32,
    height: u32,
    left: i32,
    top: i32,
    advance: f32,
    hinted_advance: f32,
}

/// Packs a strike. `image` is the file name of the picture, for the description.
///
/// # Errors
///
/// More pixels than a texture takes.
pub(super) fn atlas(strike: &Strike, face: &Face, image: &str) -> Result<Atlas, Failure> {
    let (width, height, places) = shelves(&strike.glyphs);
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Failure::failed(format!(
            "the atlas at {} ppem would have {width}×{height} pixels, and {MAX_SIDE}×{MAX_SIDE} are the most; choose fewer glyphs or smaller sizes",
            strike.ppem
        )));
    }
    let mut picture = GrayImage::new(width, height);
    let mut glyphs = Vec::new();
    let scale = 255 / ((1u16 << strike.bits) - 1) as u8;
    for (glyph, (x, y)) in strike.glyphs.iter().zip(places) {
        for (row, levels) in (y..).zip(glyph.rows()) {
            for (column, level) in (x..).zip(levels) {
                picture.put_pixel(column, row, image::Luma([level * scale]));
            }
        }
        glyphs.push(entry(glyph, face, x, y));
    }
    let line = Line {
        ascent: strike.line.ascent,
        descent: strike.line.descent,
        line_gap: strike.line.line_gap,
        underline_position: strike.line.underline_position,
        underline_thickness: strike.line.underline_thickness,
    };
    let (ppem, bits) = (strike.ppem, strike.bits);
    let description = Description { font: &face.full_name, image, width, height, ppem, bits, line, glyphs };
    let failed = |e: String| Failure::failed(format!("the atlas at {ppem} ppem cannot be encoded ({e})"));
    let mut json = serde_json::to_vec(&description).map_err(|e| failed(e.to_string()))?;
    json.push(b'\n');
    let mut png = Cursor::new(Vec::new());
    picture.write_to(&mut png, ImageFormat::Png).map_err(|e| failed(e.to_string()))?;
    Ok(Atlas { png: png.into_inner(), json, width, height })
}

fn entry<'f>(glyph: &Glyph, face: &'f Face, x: u32, y: u32) -> Entry<'f> {
    Entry {
        gid: glyph.gid,
        name: face.glyph_name(glyph.gid),
        characters: face.characters_of(glyph.gid).iter().filter_map(|code| char::from_u32(*code)).collect(),
        x,
        y,
        width: glyph.place.width,
        height: glyph.place.height,
        left: glyph.place.left,
        top: glyph.place.top,
        advance: glyph.advance,
        hinted_advance: glyph.hinted_advance,
    }
}

/// Packs glyphs in rows, the highest first. Gives the picture's sides, and where each glyph's top left pixel is; blank glyphs are at 0, 0.
fn shelves(glyphs: &[Glyph]) -> (u32, u32, Vec<(u32, u32)>) {
    let boxed = |glyph: &Glyph| (glyph.place.width + GAP, glyph.place.height + GAP);
    let area: u64 =
        glyphs.iter().map(boxed).map(|(width, height)| u64::from(width) * u64::from(height)).sum();
    let widest = glyphs.iter().map(|glyph| boxed(glyph).0 + GAP).max().unwrap_or(0);
    let width = ((area as f64).sqrt().ceil() as u32).max(widest).next_power_of_two();
    let mut order: Vec<usize> = (0..glyphs.len()).filter(|at| glyphs[*at].place.area() > 0).collect();
    order.sort_by_key(|at| (std::cmp::Reverse(glyphs[*at].place.height), *at));
    let mut places = vec![(0, 0); glyphs.len()];
    let (mut x, mut y, mut shelf) = (GAP, GAP, 0);
    for at in order {
        let (glyph_width, glyph_height) = boxed(&glyphs[at]);
        if x + glyph_width > width {
            (x, y, shelf) = (GAP, y + shelf, 0);
        }
        places[at] = (x, y);
        x += glyph_width;
        shelf = shelf.max(glyph_height);
    }
    (width, y + shelf, places)
}
