//! Reproducible random numbers. burn's own generator is shared by all threads, so that its numbers would depend on the
//! other trainings.

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014), seeded for a stream.
#[derive(Debug, Clone)]
pub(super) struct Random(SplitMix64);

impl Random {
    /// Numbers that a seed and a stream determine: an epoch, or a layer.
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        let state = seed ^ stream.wrapping_mul(0xD605_1EF6_9B29_3D49);
        let mut random = Self(SplitMix64::from_seed(state.to_le_bytes()));
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Evenly distributed in 0..1.
    pub(super) fn uniform(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// The numbers 0..count in random order (Fisher and Yates).
    pub(super) fn order(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, (self.next() % (last as u64 + 1)) as usize);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_stay_those_of_trainings_so_far() {
        let mut random = Random::new(1, 2);
        assert_eq!([random.next(), random.next()], [0x9089ae2448ba9269, 0x09165bb41a7950d8]);
    }

    #[test]
    fn an_order_has_every_number_once_and_depends_on_seed_and_stream() {
        let order = Random::new(1, 2).order(44);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..44));
        assert_eq!(order, Random::new(1, 2).order(44));
        assert!(order != Random::new(1, 3).order(44) && order != Random::new(2, 2).order(44));
    }

    #[test]
    fn uniform_numbers_fill_their_range() {
        let mut random = Random::new(7, 0);
        let values: Vec<f32> = (0..4096).map(|_| random.uniform()).collect();
        let mean = values.iter().sum::<f32>() / 4096.0;
        assert!((mean - 0.5).abs() < 0.02 && values.iter().all(|v| (0.0..1.0).contains(v)));
    }
}
