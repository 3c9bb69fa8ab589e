//! The bytes of a font's bitmaps.

use std::collections::HashMap;

use crate::bake::strike::{Glyph, packed};

/// Where the bitmaps are. A glyph that stands for several characters has one.
pub(super) struct Bitmaps {
    /// The character that each bitmap is written for, and its bytes.
    pub(super) images: Vec<(u32, Vec<u8>)>,
    pub(super) offsets: HashMap<u16, usize>,
    pub(super) length: usize,
}

impl Bitmaps {
    pub(super) fn new(glyphs: &[(u32, &Glyph)], bits: u8) -> Self {
        let mut bitmaps = Self { images: Vec::new(), offsets: HashMap::new(), length: 0 };
        for (code, glyph) in glyphs {
            if bitmaps.offsets.contains_key(&glyph.gid) {
                continue;
            }
            bitmaps.offsets.insert(glyph.gid, bitmaps.length);
            let image = packed(&glyph.levels, bits);
            bitmaps.length += image.len();
            bitmaps.images.push((*code, image));
        }
        bitmaps
    }
}
