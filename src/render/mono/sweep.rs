//! Setting the pixels between profiles, and drop-out control: rules 1 to 6 of TrueType's scan converter (OpenType 1.9, "TrueType
//! fundamentals"), with what FreeType's `ftraster.c` adds where they leave a choice.

use alloc::vec::Vec;
use core::mem;

use super::profiles::{NONE, Profile, Profiles};
use crate::error::Error;
use crate::limits::Budget;
use crate::placement::Placement;
use crate::table::Dropout;

/// The pixels of a bitmap.
pub(super) struct Bits<'b> {
    pub(super) bits: &'b mut [u8],
    row_bytes: usize,
    width: i32,
    height: i32,
}

impl<'b> Bits<'b> {
    pub(super) fn new(placement: Placement, bits: &'b mut [u8]) -> Self {
        let row_bytes = crate::mono::row_bytes(placement.width);
        Self { bits, row_bytes, width: placement.width as i32, height: placement.height as i32 }
    }

    /// The byte of a pixel that is inside, counted from the left and from the bottom, and its bit.
    fn at(&mut self, x: i32, y: i32) -> Option<(&mut u8, u8)> {
        let byte = self.bits.get_mut((self.height - 1 - y) as usize * self.row_bytes + x as usize / 8)?;
        Some((byte, 0x80 >> (x & 7)))
    }
}

/// Which way scan lines go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pass {
    /// From left to right: pixels inside the outline are set, and gaps of strokes that are upright.
    Rows,
    /// Upwards: gaps of strokes that lie, and pixels whose centre is on an edge.
    Columns,
}

impl Pass {
    /// The number of pixels of a scan line.
    fn length(self, bits: &Bits<'_>) -> i32 {
        if self == Self::Rows { bits.width } else { bits.height }
    }

    fn at<'b>(self, bits: &'b mut Bits<'_>, along: i32, line: i32) -> Option<(&'b mut u8, u8)> {
        if self == Self::Rows { bits.at(along, line) } else { bits.at(line, along) }
    }

    /// Sets a pixel of a scan line, if it is inside.
    fn set(self, bits: &mut Bits<'_>, along: i32, line: i32) {
        if (0..self.length(bits)).contains(&along)
            && let Some((byte, bit)) = self.at(bits, along, line)
        {
            *byte |= bit;
        }
    }

    /// Sets the pixels of a scan line whose centres lie between two edges or on them.
    fn span(self, bits: &mut Bits<'_>, profiles: &Profiles, line: i32, ends: [i32; 2]) {
        let grid = profiles.grid;
        if self == Self::Rows {
            let [first, last] = [grid.pixel(grid.ceil(ends[0])).max(0), grid.pixel(ends[1])];
            fill(bits, line, first, last.min(bits.width - 1));
        } else {
            // What lies between was set with the rows.
            ends.iter()
                .filter(|end| grid.fraction(**end) == 0)
                .for_each(|end| self.set(bits, grid.pixel(*end), line));
        }
    }

    /// Sets one of the pixels beside a gap, unless the other one is set. Beyond the bitmap's border the other one is taken.
    fn fill_gap(self, bits: &mut Bits<'_>, line: i32, [chosen, other]: [i32; 2]) {
        let inside = 0..self.length(bits);
        if !inside.contains(&chosen) {
            self.set(bits, other, line);
        } else if !inside.contains(&other)
            || self.at(bits, other, line).is_some_and(|(byte, bit)| *byte & bit == 0)
        {
            self.set(bits, chosen, line);
        }
    }
}

/// Sets the pixels from one to another of a row.
fn fill(bits: &mut Bits<'_>, y: i32, first: i32, last: i32) {
    if first > last {
        return;
    }
    let start = (bits.height - 1 - y) as usize * bits.row_bytes;
    let Some(row) = bits.bits.get_mut(start..start + bits.row_bytes) else { return };
    let [a, b] = [first as usize / 8, last as usize / 8];
    let (from_first, to_last) = (0xFF >> (first & 7), !(0x7F >> (last & 7)));
    match row.get_mut(a..=b) {
        Some([only]) => *only |= from_first & to_last,
        Some([start, between @ .., end]) => {
            *start |= from_first;
            between.fill(0xFF);
            *end |= to_last;
        }
        _ => {}
    }
}

/// A profile that crosses the current scan line, and where.
#[derive(Debug, Clone, Copy)]
struct Active {
    profile: u32,
    at: i32,
}

/// Working memory of a sweep.
#[derive(Debug, Clone, Default)]
pub(super) struct Sweep {
    /// The profiles that go down and those that go up, along the scan line.
    active: [Vec<Active>; 2],
    fresh: Vec<Active>,
    /// The pixels beside each gap, the preferred one first.
    gaps: Vec<[i32; 2]>,
}

impl Sweep {
    /// Sets the pixels of an outline, scan line after scan line.
    ///
    /// # Errors
    ///
    /// `TooMuchWork`.
    pub(super) fn draw(
        &mut self,
        profiles: &Profiles,
        mode: Dropout,
        pass: Pass,
        bits: &mut Bits<'_>,
        budget: &mut Budget,
    ) -> Result<(), Error> {
        self.active.iter_mut().for_each(Vec::clear);
        for line in 0..profiles.lines {
            for (is_up, active) in [false, true].into_iter().zip(&mut self.active) {
                advance(profiles, line, is_up, active, &mut self.fresh, budget)?;
            }
            let [down, up] = &self.active;
            self.gaps.clear();
            for (up, down) in up.iter().zip(down) {
                let ends = [up.at.min(down.at), up.at.max(down.at)];
                if profiles.grid.ceil(ends[0]) <= profiles.grid.floor(ends[1]) {
                    pass.span(bits, profiles, line, ends);
                } else if mode.is_enabled()
                    && (mode.fills_stubs() || !is_stub(profiles, line, [up, down], ends))
                {
                    self.gaps.push(beside(profiles, mode, ends));
                }
            }
            // Afterwards, for what has been set beside a gap fills it.
            self.gaps.iter().for_each(|gap| pass.fill_gap(bits, line, *gap));
        }
        Ok(())
    }
}

/// The profiles that cross the next scan line, sorted. Of those that cross it at the same position, those that begin there come
/// first, the latest before the others: so does FreeType pair them.
fn advance(
    profiles: &Profiles,
    line: i32,
    is_up: bool,
    active: &mut Vec<Active>,
    fresh: &mut Vec<Active>,
    budget: &mut Budget,
) -> Result<(), Error> {
    let at = |profile: u32, of: &Profile| Active { profile, at: profiles.crossing(of, line) };
    fresh.clear();
    let mut next = profiles.starts.get(line as usize).copied().unwrap_or(NONE);
    while let Some(profile) = profiles.all.get(next as usize) {
        if profile.is_up == is_up {
            fresh.push(at(next, profile));
        }
        next = profile.same_start;
    }
    let kept = active.iter().filter_map(|Active { profile, .. }| {
        let of = profiles.all.get(*profile as usize)?;
        (line < of.start + of.height).then(|| at(*profile, of))
    });
    fresh.extend(kept);
    mem::swap(active, fresh);
    sort(active, budget)
}

/// Sorts by position. The order rarely changes from one scan line to the next.
fn sort(active: &mut [Active], budget: &mut Budget) -> Result<(), Error> {
    let mut steps = active.len();
    for end in 1..active.len() {
        let mut at = end;
        while at > 0 && active[at - 1].at > active[at].at {
            active.swap(at - 1, at);
            at -= 1;
        }
        steps += end - at;
        if steps > 1 << 12 {
            budget.spend(mem::take(&mut steps) as u64)?;
        }
    }
    budget.spend(steps as u64)
}

/// Whether a gap is where a stroke ends: two profiles that follow each other in a contour end on this scan line or begin there, and
/// the contour does not reach half a pixel beyond it, or is narrower than that. The published rules do not say what a stub is; this is
/// FreeType's reading.
fn is_stub(profiles: &Profiles, line: i32, [up, down]: [&Active; 2], ends: [i32; 2]) -> bool {
    let of = |active: &Active| profiles.all.get(active.profile as usize);
    let (Some(left), Some(right)) = (of(up), of(down)) else { return false };
    let is_wide = ends[1] - ends[0] >= profiles.grid.one() / 2;
    let [bottom, top] = left.overshoots.map(|overshoots| overshoots && is_wide);
    let ends_above = line == left.start + left.height - 1 && left.next == down.profile;
    let ends_below = line == left.start && right.next == up.profile;
    ends_above && !top || ends_below && !bottom
}

/// The pixels beside a gap, the preferred one first.
fn beside(profiles: &Profiles, mode: Dropout, [start, end]: [i32; 2]) -> [i32; 2] {
    let grid = profiles.grid;
    let [chosen, other] = if mode.is_smart() {
        let middle = grid.middle(start, end);
        [middle, if start > middle { middle + grid.one() } else { middle - grid.one() }]
    } else {
        [grid.floor(end), grid.ceil(start)]
    };
    [grid.pixel(chosen), grid.pixel(other)]
}
