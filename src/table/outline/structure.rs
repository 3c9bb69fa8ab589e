//! Coding of an axis's tracks: which levels of the outline have one, which points belong to it, and where its moves come from.

use alloc::vec::Vec;

use super::shared::{Shared, Source};
use crate::error::Damage;
use crate::model::outline::{AxisHints, Interpolation, MAX_TRACKS, OutlinePoints, UNTOUCHED};
use crate::model::sizes::Scale;
use crate::table::context_model::{ContextModel, class};
use crate::table::damage::{malformed, too_large};
use crate::table::elements::{LOCAL, SHARED, SOURCE, SUBTRACK, TRACK, UNUSUAL};
use crate::table::range::Coder;

/// The context of [`UNUSUAL`] for a level with several tracks.
const SPLIT: usize = 5;

/// Room for so many tracks is made at first.
const USUAL_TRACKS: usize = 16;

/// The points of one level.
struct Level<'k> {
    units: i16,
    /// Their keys.
    keys: &'k [u32],
    /// 2 for the lowest and the highest of the glyph, 1 for those of a contour, else 0.
    extreme: usize,
    /// How many are on the curve, 2 for more.
    on_curve: usize,
    /// Whether two of them follow each other.
    is_flat: bool,
}

/// Sorts numbers, in Shell's way: a twentieth of the code of `sort_unstable`.
fn sort(keys: &mut [u32]) {
    for gap in [1750, 701, 301, 132, 57, 23, 10, 4, 1] {
        for at in gap..keys.len() {
            let (key, mut to) = (keys[at], at);
            while to >= gap && keys[to - gap] > key {
                keys[to] = keys[to - gap];
                to -= gap;
            }
            keys[to] = key;
        }
    }
}

/// An outline's points by their coordinates along an axis, as numbers: coordinates from 0 up, then points.
fn sorted_keys(coordinates: &[i16]) -> Vec<u32> {
    let key = |(point, units): (usize, &i16)| u32::from(*units as u16 ^ 0x8000) << 16 | point as u32;
    let mut keys: Vec<u32> = coordinates.iter().enumerate().map(key).collect();
    if cfg!(feature = "small") {
        sort(&mut keys);
    } else {
        keys.sort_unstable();
    }
    keys
}

/// The coordinate of a point, by its key.
fn units_of(key: u32) -> i16 {
    ((key >> 16) ^ 0x8000) as i16
}

/// The point of a key. Outlines have 65535 points at most.
fn point_of(key: &u32) -> usize {
    usize::from(*key as u16)
}

/// What is known of a point: bits.
const ON_CURVE: u8 = 1;
const EXTREME: u8 = 2;
const FLAT: u8 = 4;

/// Of each point, whether it is on the curve, whether it is as low or as high as any of its contour, and whether the next one is as
/// high.
fn point_bits(points: &OutlinePoints, axis: usize) -> Vec<u8> {
    let mut bits: Vec<u8> = points.on_curve.iter().map(|on_curve| u8::from(*on_curve) * ON_CURVE).collect();
    for contour in points.contours() {
        let own = points.coordinates[axis].get(contour.clone()).zip(bits.get_mut(contour));
        let Some((own @ [first, rest @ ..], bits)) = own else { continue };
        let (low, high) = rest.iter().fold((*first, *first), |(low, high), v| (low.min(*v), high.max(*v)));
        for ((bits, v), next) in bits.iter_mut().zip(own).zip(rest.iter().chain([first])) {
            *bits |= if *v == low || *v == high { EXTREME } else { 0 };
            *bits |= if v == next { FLAT } else { 0 };
        }
        // A point alone is followed by itself.
        if let ([bits], []) = (bits, rest) {
            *bits &= !FLAT;
        }
    }
    bits
}

/// The levels of an outline, ascending.
fn levels<'k>(keys: &'k [u32], bits: &'k [u8]) -> impl Iterator<Item = Level<'k>> {
    let count = keys.len();
    let mut end = 0;
    keys.chunk_by(|a, b| units_of(*a) == units_of(*b)).map(move |keys| {
        let (mut known, mut on_curve) = (0, 0);
        for bits in keys.iter().map(|key| bits.get(point_of(key)).copied().unwrap_or(0)) {
            known |= bits;
            on_curve += usize::from(bits & ON_CURVE);
        }
        let is_first = end == 0;
        end += keys.len();
        let extreme = if is_first || end == count { 2 } else { usize::from(known & EXTREME != 0) };
        let units = units_of(keys[0]);
        Level { units, keys, extreme, on_curve: on_curve.min(2), is_flat: known & FLAT != 0 }
    })
}

/// Codes the tracks of an axis and their sources.
pub(super) fn code<C: Coder>(
    model: &mut ContextModel<'_, C>,
    points: &OutlinePoints,
    scale: Scale,
    axis: usize,
    hints: &mut AxisHints,
    sources: &mut Vec<Source>,
    shared: &Shared<'_>,
) -> Result<(), Damage> {
    hints.track_of.resize(points.len(), UNTOUCHED);
    let (keys, bits) = (sorted_keys(&points.coordinates[axis]), point_bits(points, axis));
    let room = if C::WRITES { 0 } else { USUAL_TRACKS.min(keys.len()) };
    let mut tracks =
        Tracks { last: i32::from(i16::MIN), before: [false; 2], levels: Vec::with_capacity(room) };
    for (at, level) in levels(&keys, &bits).enumerate() {
        tracks.code(model, at, &level, scale.units_per_em(), hints)?;
        model.check()?;
    }
    if !C::WRITES {
        hints.levels = tracks.levels;
        hints.levels.shrink_to_fit();
    }
    if Interpolation::of(axis, &scale) == Interpolation::Level {
        hints.is_local.resize(hints.levels.len(), false);
        for is_local in &mut hints.is_local {
            *is_local = model.flag(LOCAL, [0, 0, 0], *is_local);
        }
    }
    sources.resize(hints.levels.len(), Source::Own);
    for (level, source) in hints.levels.iter().zip(sources) {
        *source = code_source(model, axis, *level, *source, shared)?;
    }
    model.check()
}

/// The tracks that are coded so far.
struct Tracks {
    /// The last level with a track.
    last: i32,
    /// Whether each of the last two levels had one.
    before: [bool; 2],
    levels: Vec<i16>,
}

impl Tracks {
    fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        at: usize,
        level: &Level<'_>,
        units_per_em: u16,
        hints: &mut AxisHints,
    ) -> Result<(), Damage> {
        let first = self.levels.len();
        let Level { units, keys, extreme, on_curve, is_flat } = *level;
        let units = i32::from(units);
        let points = || keys.iter().map(point_of);
        // Whether the last track is so many thousandths of an em below, rounded down.
        let limits = [10, 25, 60, 120, 250].map(|limit| limit * i32::from(units_per_em));
        let is_near = class((units - self.last) * 1000, limits);
        let contexts = [
            extreme * 8 + (keys.len().min(4) - 1) * 2 + usize::from(is_flat),
            is_near * 3 + on_curve,
            usize::from(self.before[0]) * 12 + usize::from(self.before[1]) * 6 + at.min(5),
        ];
        let own = |point: usize| hints.track_of[point];
        let count = if C::WRITES { subtracks(points().map(own), first) } else { 0 };
        let has_track = model.flag(TRACK, contexts, count > 0);
        self.before = [has_track, self.before[0]];
        if !has_track {
            return Ok(());
        }
        self.last = units;
        let is_whole = count == 1 && points().all(|point| usize::from(own(point)) == first);
        let mut count = 1;
        if model.flag(UNUSUAL, [SPLIT, 0, 0], !is_whole) {
            count = 0;
            for (k, point) in points().enumerate() {
                let track = &mut hints.track_of[point];
                let sub = if *track == UNTOUCHED { 0 } else { usize::from(*track).wrapping_sub(first) + 1 };
                let sub = model.positive(SUBTRACK, [k.min(1), 0, 0], sub as u32 + 1) as usize - 1;
                if sub > count + 1 {
                    return Err(malformed("skips a track"));
                }
                count = count.max(sub);
                *track = if sub == 0 { UNTOUCHED } else { (first + sub - 1).min(MAX_TRACKS) as u8 };
            }
        } else {
            points().for_each(|point| hints.track_of[point] = first.min(MAX_TRACKS) as u8);
        }
        self.levels.resize(first + count, level.units);
        if self.levels.len() > MAX_TRACKS {
            return Err(too_large("tracks", self.levels.len() as i32, MAX_TRACKS as i32));
        }
        Ok(())
    }
}

/// The number of tracks, counted from `first`, that some points belong to.
fn subtracks(tracks: impl Iterator<Item = u8>, first: usize) -> usize {
    let numbers = tracks.filter(|track| *track != UNTOUCHED).map(|track| usize::from(track) + 1);
    numbers.max().map_or(0, |end| end.saturating_sub(first))
}

fn code_source<C: Coder>(
    model: &mut ContextModel<'_, C>,
    axis: usize,
    level: i16,
    source: Source,
    shared: &Shared<'_>,
) -> Result<Source, Damage> {
    let same = shared.of_level(axis, level);
    let kind = match source {
        Source::Own => 0,
        Source::Same(_) => 1,
        Source::Near(_) => 2,
        Source::Still => 3,
    };
    let kind = model.bits(SOURCE, axis * 3 + same.len().min(2), 2, kind);
    let number = |model: &mut ContextModel<'_, C>, context: usize, number: usize| {
        model.positive(SHARED, [axis * 2 + context, 0, 0], number as u32 + 1) as usize - 1
    };
    match kind {
        0 => Ok(Source::Own),
        1 => {
            let at = if let Source::Same(at) = source { usize::from(at) - same.start } else { 0 };
            let at = same.start.saturating_add(number(model, 0, at));
            if same.contains(&at) {
                Ok(Source::Same(at as u16))
            } else {
                Err(malformed("refers to no shared track"))
            }
        }
        2 => {
            let rank = match source {
                Source::Near(at) if C::WRITES => shared.rank(axis, level, at.into()),
                _ => 0,
            };
            let rank = number(model, 1, rank);
            let at = shared.of_rank(axis, level, rank).ok_or(malformed("refers to no shared track"))?;
            Ok(Source::Near(at as u16))
        }
        _ => Ok(Source::Still),
    }
}

#[cfg(test)]
mod tests;
