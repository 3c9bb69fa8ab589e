//! LVGL's character maps: ranges of characters whose glyphs are numbered in order.

/// LVGL counts a range's characters with 16 bits.
const MAX_RANGE: u32 = 0xffff;
/// The most maps of a font: `cmap_num` has 9 bits.
pub(super) const MAX_MAPS: usize = 511;
/// So many characters in a row are a map of their own, which takes 24 bytes; in a sparse one each takes 2.
const MIN_RUN: usize = 24;

/// One map, whose glyphs have the numbers from `first_glyph` on, in the order of the characters.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Map {
    pub(super) first_glyph: usize,
    /// Ascending.
    pub(super) characters: Vec<u32>,
    /// Whether the characters follow each other without a gap.
    pub(super) is_dense: bool,
}

impl Map {
    /// The first character.
    pub(super) fn start(&self) -> u32 {
        self.characters.first().copied().unwrap_or(0)
    }

    /// How many characters there are from the first to the last.
    pub(super) fn length(&self) -> u32 {
        self.characters.last().map_or(0, |last| last - self.start() + 1)
    }
}

/// Splits ascending characters, whose glyphs are numbered from 1, into maps that do not overlap: LVGL looks no further than the first map
/// whose range holds a character.
pub(super) fn maps(characters: &[u32]) -> Vec<Map> {
    let mut maps: Vec<Map> = Vec::new();
    let mut first_glyph = 1;
    for run in characters.chunk_by(|a, b| a + 1 == *b).flat_map(|run| run.chunks(MAX_RANGE as usize)) {
        let is_dense = run.len() >= MIN_RUN;
        let last = run.last().copied().unwrap_or(0);
        match maps.last_mut() {
            Some(map) if !is_dense && !map.is_dense && last - map.start() < MAX_RANGE => {
                map.characters.extend(run);
            }
            _ => maps.push(Map { first_glyph, characters: run.to_vec(), is_dense }),
        }
        first_glyph += run.len();
    }
    for map in &mut maps {
        map.is_dense |= map.length() as usize == map.characters.len();
    }
    maps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_runs_and_what_lies_between_them_are_maps_of_their_own() {
        let characters: Vec<u32> =
            (0x20..0x7f).chain([0xa0, 0xb0, 0x2022]).chain(0x4e00..0x4e20).chain([0x1_f600]).collect();
        let maps = maps(&characters);
        let shapes: Vec<_> =
            maps.iter().map(|map| (map.first_glyph, map.start(), map.length(), map.is_dense)).collect();
        let expected = [
            (1, 0x20, 95, true),
            (96, 0xa0, 0x1f83, false),
            (99, 0x4e00, 32, true),
            (131, 0x1_f600, 1, true),
        ];
        assert_eq!(shapes, expected);
        assert_eq!(maps[1].characters, [0xa0, 0xb0, 0x2022]);
    }

    #[test]
    fn ranges_neither_overlap_nor_exceed_16_bits() {
        let characters: Vec<u32> = (0..40).map(|at| at * 0x4321).chain(0x20_0000..0x22_0000).collect();
        let maps = maps(&characters);
        assert!(maps.iter().all(|map| map.length() <= MAX_RANGE));
        assert!(maps.windows(2).all(|pair| pair[0].start() + pair[0].length() <= pair[1].start()));
        assert_eq!(maps.iter().flat_map(|map| map.characters.clone()).collect::<Vec<_>>(), characters);
    }
}
