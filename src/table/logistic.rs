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
    ((CURVE[at] * (128 - share) + CURVE[at + 1] * share + 64) >> 7) as u32
}

/// Its inverse, from probabilities to the logistic domain: the least number with at least that probability.
pub static STRETCH: [i16; ONE as usize] = {
    let mut table = [2047; ONE as usize];
    let (mut stretched, mut probability) = (-2047, 0);
    while probability < ONE {
        while stretched < 2047 && squash(stretched) < probability {
            stretched += 1;
        }
        table[probability as usize] = stretched as i16;
        probability += 1;
    }
    table
};

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
    fn what_is_squashed_is_stretched_back() {
        for probability in 1..ONE - 1 {
            let back = squash(STRETCH[probability as usize].into());
            // The curve rises by up to four a step.
            assert!((probability..probability + 4).contains(&back), "{probability} comes back as {back}");
        }
        assert!(STRETCH.is_sorted());
    }
}
