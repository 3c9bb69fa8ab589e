//! The logistic function and its inverse, in integers (lpaq's `squash` and `stretch`).

use super::range::ONE;

/// The logistic function at every half unit from −8 to 8, in 1/4096.
const CURVE: [i32; 33] = [
    1, 2, 3, 6, 10, 16, 27, 45, 73, 120, 194, 310, 488, 747, 1101, 1546, 2047, 2549, 2994, 3348, 3607, 3785,
    3901, 3975, 4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094,
];

/// The logistic function at 256 steps to the unit, in 1/4096: from the logistic domain to probabilities.
pub const fn squash(stretched: i32) -> u32 {
    if stretched > 2047 {
        return ONE - 1;
    }
    if stretched < -2047 {
        return 0;
    }
    let (at, share) = (((stretched >> 7) + 16) as usize, stretched & 127);
    let (start, rise) = PIECES[at];
    ((start + rise * share) >> 7) as u32
}

/// For each piece of the curve, its start, with a half for rounding, and what it rises by in a step: in 1/128.
static PIECES: [(i32, i32); 32] = {
    let (mut pieces, mut at) = ([(0, 0); 32], 0);
    while at < 32 {
        pieces[at] = (128 * CURVE[at] + 64, CURVE[at + 1] - CURVE[at]);
        at += 1;
    }
    pieces
};

/// Its inverse, from probabilities to the logistic domain: the least number with at least that probability.
#[cfg(not(feature = "small"))]
#[inline(always)]
pub fn stretch(probability: u32) -> i32 {
    static TABLE: [i16; ONE as usize] = {
        let (mut table, mut probability) = ([0; ONE as usize], 0);
        while probability < ONE {
            table[probability as usize] = inverse(probability) as i16;
            probability += 1;
        }
        table
    };
    TABLE[(probability % ONE) as usize].into()
}

#[cfg(feature = "small")]
pub use inverse as stretch;

/// The inverse, computed: one division in place of a table of 8 kB.
pub const fn inverse(probability: u32) -> i32 {
    let wanted = probability as i32;
    if wanted <= CURVE[0] {
        return -2047;
    }
    // The last point of the curve that is below.
    let (mut at, mut step) = (0, 16);
    while step > 0 {
        if CURVE[at + step] < wanted {
            at += step;
        }
        step /= 2;
    }
    let (rise, height) = (CURVE[at + 1] - CURVE[at], wanted - CURVE[at]);
    let stretched = ((at as i32 - 16) << 7) + (128 * height - 64 + rise - 1) / rise;
    if stretched < 2047 { stretched } else { 2047 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specification_lists_the_curve() {
        let page = include_str!("../../spec/nfrt.md").split_whitespace().collect::<Vec<_>>().join(" ");
        let curve = CURVE.map(|probability| probability.to_string()).join(" ");
        assert!(page.contains(&format!("C = {curve} and")), "spec/nfrt.md does not list the curve");
    }

    #[test]
    fn stretching_gives_the_least_number_with_that_probability() {
        for probability in 0..ONE {
            let least = (-2047..2047).find(|at| squash(*at) >= probability).unwrap_or(2047);
            assert_eq!((stretch(probability), inverse(probability)), (least, least), "{probability}");
        }
    }

    #[test]
    fn what_is_squashed_is_stretched_back() {
        for probability in 1..ONE - 1 {
            let back = squash(stretch(probability));
            // The curve rises by up to four a step.
            assert!((probability..probability + 4).contains(&back), "{probability} comes back as {back}");
        }
        assert!((0..ONE).is_sorted_by_key(stretch));
    }
}
