//! Tracks that glyphs share.

use std::collections::HashMap;

use super::fit::FittedOutline;
use crate::options::Fidelity;
use nfr::internals::table::outline::Source;

/// A shared track: its level in font units, and its move at each size.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SharedTrack {
    pub(super) level: i16,
    pub(super) moves: Vec<i16>,
}

/// The shared tracks of a font along an axis, by ascending levels, those of a level by descending use.
#[derive(Debug, Clone, Default)]
pub(super) struct SharedTracks(pub(super) Vec<SharedTrack>);

/// The bits that sharing saves for a track that moves a little differently.
const SAVED_BITS: f64 = 45.0;
/// A track is shared by so many others at least.
const LEAST_USES: usize = 2;
/// Levels whose distance is at most this, in thousandths of an em, may predict each other.
const REACH: i32 = 60;
/// A shared track predicts another if it is right at so many sizes, of 100.
const LEAST_HITS: usize = 45;

/// A track of a glyph.
pub(super) struct Track<'f> {
    pub(super) level: i16,
    pub(super) moves: Vec<i16>,
    pub(super) costs: &'f [f64],
}

/// The tracks of a glyph along an axis.
pub(super) fn tracks(outline: &FittedOutline, axis: usize) -> impl Iterator<Item = Track<'_>> {
    let (hints, costs) = (&outline.weights.axes[axis], &outline.costs[axis]);
    let count = hints.levels.len();
    hints.levels.iter().zip(costs).enumerate().map(move |(track, (level, costs))| Track {
        level: *level,
        moves: hints.moves.iter().skip(track).step_by(count.max(1)).copied().collect(),
        costs,
    })
}

/// The error, in pixels, of other moves in a track's place.
fn error(track: &Track<'_>, moves: &[i16]) -> f64 {
    let sizes = track.moves.iter().zip(moves).zip(track.costs);
    sizes.map(|((a, b), cost)| f64::from(a.abs_diff(*b)) * cost).sum()
}

impl SharedTracks {
    /// Finds the tracks along an axis that several glyphs have, or nearly have.
    pub(super) fn find(outlines: &[FittedOutline], axis: usize, fidelity: Fidelity) -> Self {
        let all: Vec<Track<'_>> = outlines.iter().flat_map(|outline| tracks(outline, axis)).collect();
        let mut same: HashMap<(i16, &[i16]), usize> = HashMap::new();
        for track in all.iter().filter(|track| track.moves.iter().any(|moved| *moved != 0)) {
            *same.entry((track.level, &track.moves)).or_default() += 1;
        }
        let mut candidates: Vec<((i16, &[i16]), usize)> = same.into_iter().collect();
        candidates.sort_by(|(a, n), (b, m)| a.0.cmp(&b.0).then(m.cmp(n)).then(a.1.cmp(b.1)));
        // Each track goes to the most frequent one that is near enough.
        let limit = fidelity.error_per_bit() * SAVED_BITS;
        let mut uses = vec![0usize; candidates.len()];
        for track in &all {
            let first = candidates.partition_point(|((level, _), _)| *level < track.level);
            let of_level = candidates[first..].iter().take_while(|((level, _), _)| *level == track.level);
            let near = |((_, moves), _): &((i16, &[i16]), usize)| {
                *moves == track.moves.as_slice() || error(track, moves) <= limit
            };
            if let Some(at) = of_level.clone().position(near) {
                uses[first + at] += 1;
            }
        }
        let mut kept: Vec<(usize, SharedTrack)> = candidates
            .iter()
            .zip(&uses)
            .filter(|(_, uses)| **uses >= LEAST_USES)
            .map(|(((level, moves), _), uses)| (*uses, SharedTrack { level: *level, moves: moves.to_vec() }))
            .collect();
        kept.sort_by(|(n, a), (m, b)| a.level.cmp(&b.level).then(m.cmp(n)));
        kept.truncate(usize::from(u16::MAX));
        Self(kept.into_iter().map(|(_, track)| track).collect())
    }

    /// Where a track's moves come from: nowhere if it stays, or the shared track that takes its place, or predicts it.
    pub(super) fn source(&self, track: &Track<'_>, units_per_em: u16, fidelity: Fidelity) -> Source {
        let first = self.0.partition_point(|shared| shared.level < track.level);
        let end = self.0.partition_point(|shared| shared.level <= track.level);
        let limit = fidelity.error_per_bit() * SAVED_BITS;
        let errors =
            (first..end).map(|at| (at, error(track, &self.0[at].moves), self.0[at].moves == track.moves));
        let near = errors.filter(|(_, error, same)| *same || *error <= limit && !fidelity.is_exact());
        let near = near.min_by(|a, b| a.1.total_cmp(&b.1));
        let still = error(track, &vec![0; track.moves.len()]);
        let is_still = track.moves.iter().all(|moved| *moved == 0)
            || still <= limit && !fidelity.is_exact() && near.is_none_or(|(_, error, _)| still <= error);
        if is_still {
            return Source::Still;
        }
        if let Some((at, ..)) = near {
            return Source::Same(at as u16);
        }
        let reach = REACH * i32::from(units_per_em) / 1000;
        let from = self.0.partition_point(|shared| i32::from(shared.level) < i32::from(track.level) - reach);
        let until =
            self.0.partition_point(|shared| i32::from(shared.level) <= i32::from(track.level) + reach);
        let hits = |at: usize| self.0[at].moves.iter().zip(&track.moves).filter(|(a, b)| a == b).count();
        let best = (from..until).map(|at| (hits(at), at)).max_by_key(|(hits, at)| (*hits, usize::MAX - at));
        match best {
            Some((hits, at)) if hits * 100 >= LEAST_HITS * track.moves.len() => Source::Near(at as u16),
            _ => Source::Own,
        }
    }
}
