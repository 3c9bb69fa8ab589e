//! Strikes as the library draws them, and as others read them.

// Each test program uses a part of this.
#![allow(dead_code, clippy::unwrap_used, unreachable_pub)]

use std::collections::BTreeMap;
use std::sync::OnceLock;

use freetype::face::LoadFlag;
use nfr::{Font, Limits, Rasterizer};

use super::common::{Directory, SANS, nfr_convert};

/// Neighbours in the font, gaps of all lengths, a blank glyph, and at small sizes bitmaps of 3 columns and 2 or 3 rows.
pub const TEXT: &str = "!\"'(),-./012 =ABCgjlmpqy|éŒ~";

/// The directory and name of a converted font that several tests bake.
fn converted() -> &'static (Directory, String) {
    static CONVERTED: OnceLock<(Directory, String)> = OnceLock::new();
    CONVERTED.get_or_init(|| {
        let directory = Directory::new();
        let output = directory.name("sans.ttf");
        nfr_convert(&["--quiet", "--text", TEXT, SANS, &output]).succeeds();
        (directory, output)
    })
}

pub fn neural() -> &'static str {
    &converted().1
}

/// A glyph's levels where they are not 0, by column and row from the baseline, upwards; and its advance width in pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawn {
    levels: BTreeMap<(i32, i32), u8>,
    advance: i32,
}

/// Glyphs by number or by character.
pub type Strike = BTreeMap<u32, Drawn>;

impl Drawn {
    /// From the levels of a box, top row first, whose top left pixel is right of and under a point.
    pub fn new(levels: Vec<u8>, width: usize, (left, top): (i32, i32), advance: i32) -> Self {
        let at = |index: usize| (left + (index % width) as i32, top - 1 - (index / width) as i32);
        let inked = levels.into_iter().enumerate().filter(|(_, level)| *level > 0);
        Self { levels: inked.map(|(index, level)| (at(index), level)).collect(), advance }
    }

    pub fn left(&self) -> Option<i32> {
        self.levels.keys().map(|(x, _)| *x).min()
    }

    pub fn top(&self) -> Option<i32> {
        self.levels.keys().map(|(_, y)| *y + 1).max()
    }

    pub fn bottom(&self) -> Option<i32> {
        self.levels.keys().map(|(_, y)| *y).min()
    }
}

/// A converted font, drawn by the library.
pub struct Expected {
    pub font: Font,
    rasterizer: Rasterizer,
}

impl Expected {
    pub fn new(path: &str) -> Self {
        let font = Font::new(std::fs::read(path).unwrap()).unwrap();
        let rasterizer = Rasterizer::new(&font).with_limits(Limits::default());
        Self { font, rasterizer }
    }

    /// A glyph in black and white, or with coverages rounded to the nearest level.
    fn drawn(&mut self, gid: u32, ppem: u16, bits: u8) -> Drawn {
        let most = f64::from((1u16 << bits) - 1);
        let advance = self.rasterizer.hinted_advance(gid, ppem.into()).unwrap().round() as i32;
        if bits == 1 {
            let bitmap = self.rasterizer.render_mono(gid, f32::from(ppem)).unwrap();
            let place = bitmap.placement;
            let levels = (0..place.height).flat_map(|y| (0..place.width).map(move |x| (x, y)));
            let levels = levels.map(|(x, y)| u8::from(bitmap.is_black(x, y))).collect();
            return Drawn::new(levels, place.width as usize, (place.left, place.top), advance);
        }
        let bitmap = self.rasterizer.render(gid, f32::from(ppem)).unwrap();
        let level = |coverage: &u8| (f64::from(*coverage) * most / 255.0).round() as u8;
        let origin = (bitmap.placement.left, bitmap.placement.top);
        Drawn::new(
            bitmap.pixels.iter().map(level).collect(),
            bitmap.placement.width as usize,
            origin,
            advance,
        )
    }

    /// All glyphs that have models.
    pub fn strike(&mut self, ppem: u16, bits: u8) -> Strike {
        let gids: Vec<u32> = self.font.modelled_glyphs().collect();
        gids.into_iter().map(|gid| (gid, self.drawn(gid, ppem, bits))).collect()
    }

    /// The glyphs of a text's characters, by character.
    pub fn characters(&mut self, ppem: u16, bits: u8, text: &str) -> Strike {
        let gids: Vec<(char, u32)> =
            text.chars().map(|c| (c, self.font.glyph_for_char(c).unwrap())).collect();
        gids.into_iter().map(|(character, gid)| (character.into(), self.drawn(gid, ppem, bits))).collect()
    }
}

/// Levels that are packed from the highest bits.
pub fn unpacked(bytes: &[u8], bits: u8, count: usize) -> Vec<u8> {
    let bits = usize::from(bits);
    let level =
        |at: usize| (u16::from(bytes[at * bits / 8]) >> (8 - bits - at * bits % 8) & ((1 << bits) - 1)) as u8;
    (0..count).map(level).collect()
}

/// Bitmaps that FreeType has in a font at the size that is set.
pub fn freetype_strike(face: &freetype::Face, gids: impl Iterator<Item = u32>) -> Strike {
    gids.map(|gid| {
        face.load_glyph(gid, LoadFlag::COLOR).unwrap();
        let slot = face.glyph();
        assert_eq!(slot.raw().format, freetype::ffi::FT_GLYPH_FORMAT_BITMAP, "glyph {gid} has no bitmap");
        let bitmap = slot.bitmap();
        let bits = match bitmap.raw().pixel_mode {
            1 => 1,
            2 => 8,
            3 => 2,
            4 => 4,
            mode => panic!("pixel mode {mode}"),
        };
        let (width, rows) = (bitmap.width() as usize, bitmap.rows() as usize);
        let rows = (0..rows)
            .flat_map(|row| unpacked(&bitmap.buffer()[row * bitmap.pitch() as usize..], bits, width));
        let advance = slot.advance().x;
        assert_eq!(advance % 64, 0);
        let origin = (slot.bitmap_left(), slot.bitmap_top());
        (gid, Drawn::new(rows.collect(), width, origin, (advance / 64) as i32))
    })
    .collect()
}

/// A line that `tests/lvgl/print.c` prints for a character.
pub fn printed_glyph(line: &str) -> (u32, Drawn) {
    let (fields, levels) = line.rsplit_once(' ').unwrap();
    let mut fields = fields.split(' ');
    let code = u32::from_str_radix(fields.next().unwrap(), 16).unwrap();
    let numbers: Vec<i32> = fields.map(|field| field.parse().unwrap()).collect();
    let [advance, width, height, left, bottom] = numbers[..] else { panic!("{line}") };
    let digits: Vec<&[u8]> = levels.as_bytes().chunks(2).collect();
    let level = |digits: &&[u8]| u8::from_str_radix(std::str::from_utf8(digits).unwrap(), 16).unwrap();
    let origin = (left, bottom + height);
    (code, Drawn::new(digits.iter().map(level).collect(), width as usize, origin, advance))
}
