//! Syntax elements: the kinds of numbers that models are coded as, each with its binarisation and contexts. Fields and
//! outlines have elements of their own, with slots and mixers of their own.

/// Slots for the suffix, the bits of a number below its leading one: two bits for each of seven lengths.
const SUFFIX_SLOTS: usize = 3 * SUFFIX_LENGTHS;
pub(super) const SUFFIX_LENGTHS: usize = 7;

/// A syntax element: a kind of number, its binarisation, and the contexts that it is coded in.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// The number of contexts of each of the three sets. If only the first set is not empty, nothing is mixed.
    pub(super) contexts: [usize; 3],
    /// Bins with contexts: is it 0, is it negative, has it more than 1, 2, … bits. The last stands for all longer ones.
    pub(super) bins: usize,
    /// The first slot. The contexts of each set follow each other, then the slots of the suffix.
    pub(super) first_slot: usize,
    /// The first mixer, of one for each bin.
    pub(super) first_mixer: usize,
}

/// Contexts and bins of each element.
const BINARISATIONS: [([usize; 3], usize); 12] = [
    ([6, 0, 0], 8),
    ([6, 0, 0], 12),
    ([3, 0, 0], 8),
    ([45, 32, 40], 6),
    ([25, 48, 125], 7),
    ([16, 49, 25], 1),
    ([16, 49, 9], 1),
    ([40, 49, 48], 10),
    ([25, 36, 18], 9),
    ([36, 25, 36], 9),
    ([9, 0, 0], 8),
    ([1, 0, 0], 1),
];

/// Counts: of knots, patterns and cells.
pub const COUNT: Element = ELEMENTS.0[0];
/// Knots and the box, in font units.
pub const UNITS: Element = ELEMENTS.0[1];
/// The predictor of a knot, bit by bit.
pub const PREDICTOR: Element = ELEMENTS.0[2];
/// The error of a prediction in whole pixels.
pub const JUMP: Element = ELEMENTS.0[3];
/// The rest of that error.
pub const FRACTION: Element = ELEMENTS.0[4];
/// Whether a coefficient is clipped.
pub const CLIPPED: Element = ELEMENTS.0[5];
/// Whether a coefficient is the least.
pub const LEAST: Element = ELEMENTS.0[6];
/// The residual of any other coefficient.
pub const COEFFICIENT: Element = ELEMENTS.0[7];
/// A node of a pattern.
pub const PATTERN: Element = ELEMENTS.0[8];
/// The weight of a pattern, against that of the size before.
pub const EMBEDDING: Element = ELEMENTS.0[9];
/// The grid offset of a part, against that of the size before.
pub const GRID_OFFSET: Element = ELEMENTS.0[10];
/// Whether there is ink.
pub const INK: Element = ELEMENTS.0[11];

/// The number of slots of fields: adaptive probabilities.
pub const SLOTS: usize = ELEMENTS.1;
/// The number of mixers of fields.
pub const MIXERS: usize = ELEMENTS.2;

/// Contexts and bins of each element of outlines.
const OUTLINE_BINARISATIONS: [([usize; 3], usize); 19] = [
    ([1, 0, 0], 4),
    ([24, 24, 24], 1),
    ([6, 0, 0], 1),
    ([2, 0, 0], 6),
    ([6, 0, 0], 4),
    ([4, 0, 0], 12),
    ([16, 44, 24], 1),
    ([21, 0, 0], 6),
    ([28, 0, 0], 8),
    ([27, 0, 0], 5),
    ([4, 0, 0], 1),
    ([8, 0, 0], 1),
    ([4, 0, 0], 8),
    ([4, 0, 0], 12),
    ([4, 0, 0], 12),
    ([9, 0, 0], 8),
    ([1, 0, 0], 4),
    ([4, 0, 0], 12),
    ([1, 0, 0], 1),
];

/// The kind of a message.
pub const MESSAGE: Element = OUTLINE_ELEMENTS.0[0];
/// Whether a level has a track.
pub const TRACK: Element = OUTLINE_ELEMENTS.0[1];
/// Whether something is not as usual: a level of several tracks, an advance width that is not rounded, corrections, parts
/// that are not those of `glyf`.
pub const UNUSUAL: Element = OUTLINE_ELEMENTS.0[2];
/// The track of a point, among those of its level.
pub const SUBTRACK: Element = OUTLINE_ELEMENTS.0[3];
/// Where a track's moves come from.
pub const SOURCE: Element = OUTLINE_ELEMENTS.0[4];
/// The number of a shared track.
pub const SHARED: Element = OUTLINE_ELEMENTS.0[5];
/// Whether a hinted position is a candidate's.
pub const HIT: Element = OUTLINE_ELEMENTS.0[6];
/// How far it is from a rule's, in whole pixels.
pub const MISS_PIXELS: Element = OUTLINE_ELEMENTS.0[7];
/// The rest of that, in 1/64 pixel.
pub const MISS_FRACTION: Element = OUTLINE_ELEMENTS.0[8];
/// The hinted advance width.
pub const ADVANCE: Element = OUTLINE_ELEMENTS.0[9];
/// Whether a size has corrections.
pub const CORRECTED_SIZE: Element = OUTLINE_ELEMENTS.0[10];
/// Whether a point is corrected.
pub const CORRECTED: Element = OUTLINE_ELEMENTS.0[11];
/// By how much.
pub const CORRECTION: Element = OUTLINE_ELEMENTS.0[12];
/// A part's list of grid offsets.
pub const PART_LIST: Element = OUTLINE_ELEMENTS.0[13];
/// A part's glyph and offset.
pub const PART: Element = OUTLINE_ELEMENTS.0[14];
/// The grid offset of an outline's part, against that of the size before.
pub const OUTLINE_GRID_OFFSET: Element = OUTLINE_ELEMENTS.0[15];
/// Which hinted advance widths a composed glyph has.
pub const ADVANCES: Element = OUTLINE_ELEMENTS.0[16];
/// The bytes of a section of a message.
pub const SECTION: Element = OUTLINE_ELEMENTS.0[17];
/// Whether a track moves its own points alone.
pub const LOCAL: Element = OUTLINE_ELEMENTS.0[18];

/// The number of slots of outlines.
pub const OUTLINE_SLOTS: usize = OUTLINE_ELEMENTS.1;
/// The number of mixers of outlines.
pub const OUTLINE_MIXERS: usize = OUTLINE_ELEMENTS.2;

const ELEMENTS: ([Element; BINARISATIONS.len()], usize, usize) = elements(BINARISATIONS);
const OUTLINE_ELEMENTS: ([Element; OUTLINE_BINARISATIONS.len()], usize, usize) =
    elements(OUTLINE_BINARISATIONS);

/// Numbers slots and mixers.
const fn elements<const N: usize>(binarisations: [([usize; 3], usize); N]) -> ([Element; N], usize, usize) {
    let mut elements = [Element { contexts: [0; 3], bins: 0, first_slot: 0, first_mixer: 0 }; N];
    let (mut slot, mut mixer, mut k) = (0, 0, 0);
    while k < N {
        let (contexts, bins) = binarisations[k];
        elements[k] = Element { contexts, bins, first_slot: slot, first_mixer: mixer };
        slot += (contexts[0] + contexts[1] + contexts[2]) * bins;
        if bins > 1 {
            slot += SUFFIX_SLOTS;
        }
        if contexts[1] > 0 {
            mixer += bins;
        }
        k += 1;
    }
    (elements, slot, mixer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specification_lists_the_elements_with_their_contexts_and_bins() {
        let page = include_str!("../../spec/nfrt.md");
        let names = [
            "count",
            "units",
            "predictor",
            "jump",
            "fraction",
            "clipped",
            "least",
            "coefficient",
            "pattern",
            "embedding",
            "grid offset",
            "ink",
        ];
        for (name, (contexts, bins)) in names.iter().zip(BINARISATIONS) {
            let sets: Vec<String> = contexts.iter().filter(|n| **n > 0).map(usize::to_string).collect();
            let row = format!("| {name} | {} | {bins} |", sets.join(", "));
            assert!(page.contains(&row), "spec/nfrt.md does not say {row:?}");
        }
    }
}
