//! Points that follow the tracks beside them on their contour, as TrueType's `IUP` moves them.

use core::ops::Range;

use super::weights::UNTOUCHED;
use crate::number::{div_fixed, mul_fixed};

/// A point that a track has moved: its coordinate in font units, and its plain and its hinted position.
type Touched = (i32, i32, i32);

/// Moves the points of a contour: those of tracks by their tracks' moves, the others as `IUP` does.
pub(super) fn move_contour(
    units: &[i16],
    contour: Range<usize>,
    track_of: &[u8],
    moves: &[i16],
    out: &mut [i32],
) {
    let Some(tracks) = track_of.get(contour.clone()) else { return };
    let Some(first) = tracks.iter().position(|track| *track != UNTOUCHED) else { return };
    let touch = |at: usize, out: &mut [i32]| {
        let moved = moves.get(usize::from(track_of[at])).map_or(0, |moved| i32::from(*moved));
        let plain = out[at];
        out[at] += moved;
        (units[at].into(), plain, out[at])
    };
    let first_at = contour.start + first;
    let start = touch(first_at, out);
    let mut last = (first_at, start);
    for (at, track) in (contour.start..).zip(tracks).skip(first + 1) {
        if *track != UNTOUCHED {
            let here = touch(at, out);
            between(units, last.0 + 1..at, [last.1, here], out);
            last = (at, here);
        }
    }
    between(units, last.0 + 1..contour.end, [last.1, start], out);
    between(units, contour.start..first_at, [last.1, start], out);
}

/// Interpolates untouched points between the two touched ones beside them.
fn between(units: &[i16], range: Range<usize>, ends: [Touched; 2], out: &mut [i32]) {
    if range.is_empty() {
        return;
    }
    let gap = Gap::new(ends);
    for at in range {
        out[at] = gap.at(units[at].into(), out[at]);
    }
}

/// The position of what lies at `units` in a gap between two touched points.
pub fn interpolated(ends: [Touched; 2], units: i32, plain: i32) -> i32 {
    Gap::new(ends).at(units, plain)
}

/// Two touched points, the one with the lower coordinate first.
struct Gap {
    a: Touched,
    b: Touched,
    /// 1/64 pixel for a font unit, in 1/65536; 0 where both are at one coordinate or at one position.
    slope: i32,
}

impl Gap {
    fn new([a, b]: [Touched; 2]) -> Self {
        let (a, b) = if a.0 > b.0 { (b, a) } else { (a, b) };
        let is_flat = a.2 == b.2 || a.0 == b.0;
        Self { a, b, slope: if is_flat { 0 } else { div_fixed(b.2.wrapping_sub(a.2), b.0 - a.0) } }
    }

    fn at(&self, units: i32, plain: i32) -> i32 {
        let (a, b) = (self.a, self.b);
        if plain <= a.1 {
            plain.wrapping_add(a.2.wrapping_sub(a.1))
        } else if plain >= b.1 {
            plain.wrapping_add(b.2.wrapping_sub(b.1))
        } else {
            a.2.wrapping_add(mul_fixed(units - a.0, self.slope))
        }
    }
}

#[cfg(test)]
mod tests;
