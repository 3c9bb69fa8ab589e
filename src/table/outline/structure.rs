//! Coding of an axis's tracks: which levels of the outline have one, which points belong to it, and where its moves come from.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

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

/// The points of one level.
struct Level {
    units: i16,
    /// Where they are in the list of all points by level.
    points: Range<u16>,
    /// 2 for the lowest and the highest of the glyph, 1 for those of a contour, else 0.
    extreme: u8,
    on_curve: u16,
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

/// The numbers of an outline's points by their coordinates along an axis, and its levels, ascending.
fn levels(points: &OutlinePoints, axis: usize) -> (Vec<u16>, Vec<Level>) {
    // Sorted as numbers: coordinates from 0 up, then points.
    let key = |(point, units): (usize, &i16)| u32::from(*units as u16 ^ 0x8000) << 16 | point as u32;
    let mut keys: Vec<u32> = points.coordinates[axis].iter().enumerate().map(key).collect();
    if cfg!(feature = "small") {
        sort(&mut keys);
    } else {
        keys.sort_unstable();
    }
    let mut order = Vec::with_capacity(keys.len());
    let mut levels: Vec<Level> = Vec::with_capacity(keys.len());
    let mut level_of = vec![0u16; keys.len()];
    for (at, key) in keys.iter().enumerate() {
        // Outlines have 65535 points at most.
        let at = at as u16;
        let (units, point) = (((key >> 16) ^ 0x8000) as i16, *key as u16);
        if levels.last().is_none_or(|level| level.units != units) {
            levels.push(Level { units, points: at..at, extreme: 0, on_curve: 0, is_flat: false });
        }
        let number = levels.len() - 1;
        levels[number].points.end = at + 1;
        levels[number].on_curve += u16::from(points.on_curve[usize::from(point)]);
        level_of[usize::from(point)] = number as u16;
        order.push(point);
    }
    for own in points.contours().filter_map(|contour| level_of.get(contour)) {
        for extreme in [own.iter().min(), own.iter().max()].into_iter().flatten() {
            levels[usize::from(*extreme)].extreme = 1;
        }
        for (a, b) in own.iter().zip(own.iter().cycle().skip(1)) {
            if a == b && own.len() > 1 {
                levels[usize::from(*a)].is_flat = true;
            }
        }
    }
    let last = levels.len().saturating_sub(1);
    for at in [0, last] {
        if let Some(level) = levels.get_mut(at) {
            level.extreme = 2;
        }
    }
    (order, levels)
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
    let (order, levels) = levels(points, axis);
    let room = if C::WRITES { 0 } else { levels.len() };
    let mut tracks =
        Tracks { last: i32::from(i16::MIN), before: [false; 2], levels: Vec::with_capacity(room) };
    for (at, level) in levels.iter().enumerate() {
        let points = usize::from(level.points.start)..level.points.end.into();
        let points = order.get(points).unwrap_or_default();
        tracks.code(model, (at, level), points, scale.units_per_em(), hints)?;
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
        (at, level): (usize, &Level),
        points: &[u16],
        units_per_em: u16,
        hints: &mut AxisHints,
    ) -> Result<(), Damage> {
        let first = self.levels.len();
        let thousandths = |units: i32| (units.max(0) * 1000 / i32::from(units_per_em)).min(10_000);
        let units = i32::from(level.units);
        let is_near = class(thousandths(units - self.last), [10, 25, 60, 120, 250]);
        let contexts = [
            usize::from(level.extreme) * 8 + (points.len().min(4) - 1) * 2 + usize::from(level.is_flat),
            is_near * 3 + usize::from(level.on_curve.min(2)),
            usize::from(self.before[0]) * 12 + usize::from(self.before[1]) * 6 + at.min(5),
        ];
        let own = |point: &u16| hints.track_of[usize::from(*point)];
        let count = if C::WRITES { subtracks(points.iter().map(own), first) } else { 0 };
        let has_track = model.flag(TRACK, contexts, count > 0);
        self.before = [has_track, self.before[0]];
        if !has_track {
            return Ok(());
        }
        self.last = units;
        let is_whole = count == 1 && points.iter().all(|point| usize::from(own(point)) == first);
        let mut count = 1;
        if model.flag(UNUSUAL, [SPLIT, 0, 0], !is_whole) {
            count = 0;
            for (k, point) in points.iter().enumerate() {
                let track = &mut hints.track_of[usize::from(*point)];
                let sub = if *track == UNTOUCHED { 0 } else { usize::from(*track).wrapping_sub(first) + 1 };
                let sub = model.positive(SUBTRACK, [k.min(1), 0, 0], sub as u32 + 1) as usize - 1;
                if sub > count + 1 {
                    return Err(malformed("skips a track"));
                }
                count = count.max(sub);
                *track = if sub == 0 { UNTOUCHED } else { (first + sub - 1).min(MAX_TRACKS) as u8 };
            }
        } else {
            points.iter().for_each(|point| hints.track_of[usize::from(*point)] = first.min(MAX_TRACKS) as u8);
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
