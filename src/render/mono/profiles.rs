//! Where contours cross scan lines: a contour falls into profiles, which go up or down only. After FreeType's `ftraster.c`, whose
//! roundings decide which pixels are set where an edge passes close by a centre.

use alloc::vec::Vec;
use core::mem;

use super::grid::Grid;

/// A point along the scan lines and across them.
pub(super) type Point = [i32; 2];

/// The most crossings of a glyph: 128 on each of 8192 scan lines. Letters have up to about ten a line.
const MAX_CROSSINGS: usize = 1 << 20;
/// The most arcs that a curve is split into at once. Halves of a curve of 8192 pixels are shorter than [`Grid::step`] after fewer
/// splits.
const MAX_ARCS: usize = 32;
/// Stands for no profile.
pub(super) const NONE: u32 = u32::MAX;

/// A part of a contour that goes up or down.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Profile {
    /// The lowest scan line that it crosses.
    pub(super) start: i32,
    /// How many scan lines it crosses.
    pub(super) height: i32,
    /// The crossing on the lowest scan line; those above follow.
    first: usize,
    pub(super) is_up: bool,
    /// Whether it reaches half a pixel or more beyond its lowest and its highest scan line.
    pub(super) overshoots: [bool; 2],
    /// The profile that follows in the contour.
    pub(super) next: u32,
    /// Another profile that begins on the same scan line, and comes earlier in the outline; or [`NONE`].
    pub(super) same_start: u32,
}

/// The profiles of an outline.
#[derive(Debug, Clone, Default)]
pub(super) struct Profiles {
    pub(super) grid: Grid,
    /// The scan lines are those from 0 to one below this.
    pub(super) lines: i32,
    pub(super) all: Vec<Profile>,
    /// For each scan line, the last of the profiles that begin there, or [`NONE`].
    pub(super) starts: Vec<u32>,
    /// Positions along the scan lines.
    crossings: Vec<i32>,
    /// The profile that is being traced, if any.
    open: Option<Profile>,
    /// The end of what was traced.
    last: Point,
}

impl Profiles {
    /// Removes all profiles, and sets the number of scan lines.
    pub(super) fn start(&mut self, grid: Grid, lines: u32) {
        (self.grid, self.lines, self.open) = (grid, lines as i32, None);
        self.all.clear();
        self.crossings.clear();
        self.starts.clear();
        self.starts.resize(lines as usize, NONE);
    }

    /// Where a profile crosses a scan line that is one of its own.
    pub(super) fn crossing(&self, profile: &Profile, line: i32) -> i32 {
        self.crossings.get(profile.first + (line - profile.start) as usize).copied().unwrap_or_default()
    }

    /// The number of crossings.
    pub(super) fn crossings(&self) -> usize {
        self.crossings.len()
    }

    /// Whether there are more crossings than any glyph needs; some are missing then.
    pub(super) fn are_too_many(&self) -> bool {
        self.crossings.len() >= MAX_CROSSINGS
    }

    /// Adds a contour: its points, and whether each is on the curve; the others are control points of quadratic curves.
    pub(super) fn contour(&mut self, count: usize, point: impl Fn(usize) -> (Point, bool)) {
        let Some(last) = count.checked_sub(1) else { return };
        let ((first_at, first_on), (last_at, last_on)) = (point(0), point(last));
        let (start, others) = match (first_on, last_on) {
            (true, _) => (first_at, 1..count),
            (false, true) => (last_at, 0..last),
            (false, false) => ([0, 1].map(|k| (first_at[k] + last_at[k]) / 2), 0..count),
        };
        self.last = start;
        let before = self.all.len();
        let mut control: Option<Point> = None;
        for (here, on_curve) in others.map(point) {
            match (control, on_curve) {
                (None, true) => self.line(here),
                (None, false) => {}
                (Some(control), true) => self.conic(control, here),
                (Some(control), false) => self.conic(control, [0, 1].map(|k| (control[k] + here[k]) / 2)),
            }
            control = (!on_curve).then_some(here);
        }
        match control {
            Some(control) => self.conic(control, start),
            None => self.line(start),
        }
        self.close(before);
    }

    /// Ends a contour, whose profiles begin with this one.
    fn close(&mut self, before: usize) {
        // A contour may begin amid a profile, on a scan line, which then has been crossed twice.
        if let (Some(first), Some(open)) = (self.all.get(before), &self.open)
            && first.is_up == open.is_up
            && self.grid.fraction(self.last[1]) == 0
            && self.crossings.len() > open.first
        {
            self.crossings.pop();
        }
        self.end();
        let end = self.all.len();
        for (at, profile) in self.all.iter_mut().enumerate().skip(before) {
            profile.next = if at + 1 < end { at + 1 } else { before } as u32;
        }
    }

    /// Goes on upwards or downwards.
    fn turn(&mut self, is_up: bool) {
        if self.open.is_some_and(|open| open.is_up == is_up) {
            return;
        }
        self.end();
        let (grid, [x, y]) = (self.grid, self.last);
        let line = if is_up { grid.ceil(y) } else { grid.floor(y) };
        let line = line.clamp(0, self.highest());
        let overshoots = if is_up { [grid.is_far_below(y), false] } else { [false, grid.is_far_above(y)] };
        let (start, first) = (grid.pixel(line), self.crossings.len());
        self.open = Some(Profile { start, first, is_up, overshoots, ..Profile::default() });
        if y == line {
            self.cross(x);
        }
    }

    /// Keeps the profile that was being traced, if it crosses a scan line.
    fn end(&mut self) {
        let Some(mut profile) = mem::take(&mut self.open) else { return };
        let Some(crossings) = self.crossings.get_mut(profile.first..).filter(|all| !all.is_empty()) else {
            return;
        };
        profile.height = crossings.len() as i32;
        if profile.is_up {
            profile.overshoots[1] = self.grid.is_far_above(self.last[1]);
        } else {
            crossings.reverse();
            profile.start = (profile.start + 1 - profile.height).max(0);
            profile.overshoots[0] = self.grid.is_far_below(self.last[1]);
        }
        if let Some(start) = self.starts.get_mut(profile.start as usize) {
            profile.same_start = mem::replace(start, self.all.len() as u32);
        }
        self.all.push(profile);
    }

    /// The highest scan line, in units.
    fn highest(&self) -> i32 {
        (self.lines - 1).max(0) * self.grid.one()
    }

    fn cross(&mut self, x: i32) {
        if !self.are_too_many() {
            self.crossings.push(x);
        }
    }

    /// The scan lines from `from` to `to`, the first one excluded, in units; going down, everything is negated.
    fn lines_between(&self, from: i32, to: i32, is_up: bool) -> Option<[i32; 2]> {
        let [low, high] = if is_up { [0, self.highest()] } else { [-self.highest(), 0] };
        if to < low || from > high {
            return None;
        }
        let end = if to > high { high } else { self.grid.floor(to) };
        let start = if from < low { low } else { self.grid.ceil(from) };
        let start = if start == from { start + self.grid.one() } else { start };
        (start <= end).then_some([start, end])
    }

    fn line(&mut self, to: Point) {
        let from = self.last;
        if to[1] != from[1] {
            let is_up = to[1] > from[1];
            self.turn(is_up);
            self.cross_line(from, to, is_up);
        }
        self.last = to;
    }

    fn cross_line(&mut self, [x, mut from]: Point, [to_x, mut to]: Point, is_up: bool) {
        if !is_up {
            (from, to) = (-from, -to);
        }
        let Some([start, end]) = self.lines_between(from, to, is_up) else { return };
        let [width, height] = [i64::from(to_x - x), i64::from(to - from)];
        // Each crossing is rounded towards the line's beginning. The remainder carries what is left over.
        let divided = |by: i32| (i64::from(by) * width / height, i64::from(by) * width % height);
        let ((first, mut rest), (step, more)) = (divided(start - from), divided(self.grid.one()));
        let mut x = i64::from(x) + first;
        for _ in 0..=self.grid.pixel(end - start) {
            self.cross(x as i32);
            x += step;
            rest += more;
            if rest.abs() >= height {
                rest -= height * width.signum();
                x += width.signum();
            }
        }
    }

    /// A quadratic curve from where the last one ended. It is split where it turns.
    fn conic(&mut self, control: Point, to: Point) {
        // Arcs from the last one to the first one, each with its end, its control point, and its start, the end of the next one.
        let mut arcs = [[0; 2]; 2 * MAX_ARCS + 1];
        arcs[..3].copy_from_slice(&[to, control, self.last]);
        let mut at = 0;
        loop {
            let [to, control, from] = [arcs[at], arcs[at + 1], arcs[at + 2]];
            let [low, high] = [from[1].min(to[1]), from[1].max(to[1])];
            let turns = control[1] < self.grid.floor(low) || control[1] > self.grid.ceil(high);
            if turns && split(&mut arcs, at) {
                at += 2;
                continue;
            }
            if from[1] != to[1] {
                let is_up = from[1] < to[1];
                self.turn(is_up);
                self.cross_arc(&mut arcs, at, is_up);
            }
            self.last = to;
            if at == 0 {
                break;
            }
            at -= 2;
        }
    }

    /// Crosses the scan lines of an arc that does not turn. It is split until it is short beside each line that it crosses.
    fn cross_arc(&mut self, arcs: &mut [Point; 2 * MAX_ARCS + 1], base: usize, is_up: bool) {
        let end = arcs[base];
        if !is_up {
            arcs[base..base + 3].iter_mut().for_each(|point| point[1] = -point[1]);
        }
        let lines = self.lines_between(arcs[base + 2][1], arcs[base][1], is_up);
        let (mut at, step) = (base, self.grid.step());
        if let Some([mut line, last]) = lines {
            while line <= last {
                let [x, y] = arcs[at];
                let [width, height] = [x - arcs[at + 2][0], y - arcs[at + 2][1]];
                if y > line && (height > step || width.abs() > step) && split(arcs, at) {
                    at += 2;
                    continue;
                }
                if y >= line {
                    self.cross(x - (y - line).wrapping_mul(width) / height.max(1));
                    line += self.grid.one();
                }
                if at == base {
                    break;
                }
                at -= 2;
            }
        }
        // The next arc begins there.
        arcs[base] = end;
    }
}

/// Splits an arc in two, the first of which is put behind the second. False if there is no room for it.
fn split(arcs: &mut [Point; 2 * MAX_ARCS + 1], at: usize) -> bool {
    let Some([to, control, from, control_before, start]) = arcs.get_mut(at..at + 5) else { return false };
    *start = *from;
    for k in [0, 1] {
        let (after, before) = (to[k] + control[k], control[k] + from[k]);
        control_before[k] = before >> 1;
        from[k] = (after + before) >> 2;
        control[k] = after >> 1;
    }
    true
}
