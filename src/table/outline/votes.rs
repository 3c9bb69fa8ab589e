//! What rules vote for: each for its position, with its score and 1. The candidates, which are tried in turn, are the positions with the
//! highest sums, highest first.

#[cfg(feature = "small")]
mod each;
#[cfg(not(feature = "small"))]
mod four;

#[cfg(feature = "small")]
pub(super) use each::Votes;
#[cfg(not(feature = "small"))]
pub(super) use four::Votes;

/// The most candidates that are tried before a position is coded as a number.
pub(super) const CANDIDATES: usize = 2;

/// A position that is tried.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Candidate {
    pub(super) position: i32,
    /// The sum of the scores of the rules that give it, and of 1 for each.
    pub(super) weight: u32,
    /// The one with the highest score.
    pub(super) rule: usize,
    /// That score.
    pub(super) score: u16,
}

impl<const N: usize> Votes<N> {
    /// All candidates.
    pub(super) fn all(mut self) -> impl Iterator<Item = Candidate> {
        (0..CANDIDATES).map_while(move |_| self.take())
    }
}

#[cfg(test)]
mod tests;
