//! Simple rules for the hinted position of a track at a size.

use alloc::vec::Vec;

use wide::i32x4;

use crate::model::outline::{interpolated, rounded_down};

/// The number of rules.
pub(super) const RULES: usize = 11;
/// Rules are compared four at a time; the last lane has none.
pub(super) const LANES: usize = 4 * GROUPS;
const GROUPS: usize = 3;
/// Room for one number for each lane, a power of two: an index is brought into range by its lowest bits.
pub(super) const ROOM: usize = LANES.next_power_of_two();

/// The tracks that are coded before one and lie beside it: the nearest below, or at the same level, and the nearest above.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Neighbours {
    /// The track below.
    pub(super) lower: Option<u8>,
    /// The track above.
    pub(super) upper: Option<u8>,
}

impl Neighbours {
    /// 0 without any, 1 with a lower one, 2 with both. In the coding order no track has an upper one alone.
    pub(super) fn kind(self) -> usize {
        usize::from(self.lower.is_some()) + usize::from(self.upper.is_some())
    }
}

/// The order in which tracks are coded: the lowest, the highest, and then the middle of each gap, which
/// makes two gaps at the end of the line.
pub(super) fn coding_order(count: u8) -> Vec<(u8, Neighbours)> {
    let mut order = Vec::with_capacity(count.into());
    if count > 0 {
        order.push((0, Neighbours::default()));
    }
    if count > 1 {
        order.push((count - 1, Neighbours { lower: Some(0), upper: None }));
    }
    let split = |order: &mut Vec<_>, lower: u8, upper: u8| {
        if upper - lower > 1 {
            order.push((lower.midpoint(upper), Neighbours { lower: Some(lower), upper: Some(upper) }));
        }
    };
    split(&mut order, 0, count.saturating_sub(1));
    let mut next = 2;
    while let Some(&(middle, neighbours)) = order.get(next) {
        next += 1;
        if let Neighbours { lower: Some(lower), upper: Some(upper) } = neighbours {
            split(&mut order, lower, middle);
            split(&mut order, middle, upper);
        }
    }
    order
}

/// From font units to 1/64 pixel at a size.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scaling {
    /// The factor, in 1/65536.
    pub(super) factor: i32,
    /// Whether hinted positions and the distances between them are rounded down, as those of PostScript outlines.
    pub(super) rounds_down: bool,
}

/// What the rules look at: levels of the tracks in font units, and their positions in 1/64 pixel at this size and at the one
/// before.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) levels: &'a [i16],
    pub(super) plain: &'a [i32],
    pub(super) hinted: &'a [i32],
    /// None at the first size.
    pub(super) before: Option<&'a [i32]>,
    pub(super) scaling: Scaling,
}

/// A position, rounded to whole pixels.
pub(super) fn to_grid(position: i32) -> i32 {
    position.wrapping_add(32) & !63
}

/// The positions that the rules give a track: of rules in the first `N` groups of four; no other has what it needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules<const N: usize> {
    /// Four at a time.
    pub(super) lanes: [i32x4; N],
    /// The number of a row of [`VALID`].
    pub(super) valid: usize,
}

/// What a track has beside its plain position: bits of a row of [`VALID`].
pub(super) const LOWER: usize = 1;
const UPPER: usize = 2;
pub(super) const BEFORE: usize = 4;
pub(super) const SHARED: usize = 8;

/// For each rule that has what it needs, all bits.
pub(super) static VALID: [[Mask; ROOM]; 16] = {
    let mut rows = [[0; ROOM]; 16];
    let mut row = 0;
    while row < rows.len() {
        let mut rule = 0;
        while rule < RULES {
            let needs = match rule {
                0 | 1 => 0,
                2 => BEFORE,
                3 => SHARED,
                4 | 5 => LOWER,
                6 => LOWER | BEFORE,
                7 => LOWER | UPPER,
                8 | 9 => UPPER,
                _ => UPPER | BEFORE,
            };
            if row & needs == needs {
                rows[row][rule] = -1;
            }
            rule += 1;
        }
        row += 1;
    }
    rows
};

/// All bits, or none: as wide as what it masks, or as few bytes as can be.
#[cfg(not(feature = "small"))]
type Mask = i32;
#[cfg(feature = "small")]
type Mask = i8;

impl View<'_> {
    /// The position that each rule gives a track; `shared` is the move of the shared track that it refers to.
    #[inline(always)]
    pub(super) fn rules<const N: usize>(
        &self,
        track: usize,
        neighbours: Neighbours,
        shared: Option<i16>,
    ) -> Rules<N> {
        let plain = self.plain[track];
        let mut at = [0; ROOM];
        let mut valid = 0;
        (at[0], at[1]) = (to_grid(plain), plain);
        let before = |track: usize| self.before.map_or(0, |before| before[track]);
        let own = before(track);
        at[2] = own;
        if self.before.is_some() {
            valid |= BEFORE;
        }
        if let Some(moved) = shared {
            valid |= SHARED;
            at[3] = plain.wrapping_add(moved.into());
        }
        let [lower, upper] = [neighbours.lower, neighbours.upper].map(|track| track.map(usize::from));
        if let (2.., Some(a)) = (N, lower) {
            valid |= LOWER;
            let (hinted, apart) = (self.hinted[a], plain.wrapping_sub(self.plain[a]));
            at[4] = hinted.wrapping_add(to_grid(apart));
            at[5] = hinted.wrapping_add(apart);
            at[6] = hinted.wrapping_add(own.wrapping_sub(before(a)));
        }
        if let (3.., Some(b)) = (N, upper) {
            valid |= UPPER;
            let (hinted, apart) = (self.hinted[b], self.plain[b].wrapping_sub(plain));
            at[8] = hinted.wrapping_sub(to_grid(apart));
            at[9] = hinted.wrapping_sub(apart);
            at[10] = hinted.wrapping_sub(before(b).wrapping_sub(own));
        }
        if let (3.., Some(a), Some(b)) = (N, lower, upper) {
            at[7] = self.between([a, b], track);
        }
        if self.scaling.rounds_down {
            return Rules { lanes: lanes(&self.of_stems(track, [lower, upper], at)), valid };
        }
        Rules { lanes: lanes(&at), valid }
    }

    /// The position of a track, interpolated between two others.
    #[inline]
    fn between(&self, [a, b]: [usize; 2], track: usize) -> i32 {
        let end = |track: usize| (i32::from(self.levels[track]), self.plain[track], self.hinted[track]);
        interpolated([end(a), end(b)], self.levels[track].into(), self.plain[track])
    }

    /// The rules that differ for PostScript's hints: they put one edge of a stem on whole pixels, where the tracks around it lead it,
    /// and the other edge as far away as the stem is wide. Positions are rounded down.
    #[inline(never)]
    fn of_stems(&self, track: usize, [lower, upper]: [Option<usize>; 2], mut at: [i32; ROOM]) -> [i32; ROOM] {
        let led = |track: usize| match (lower, upper) {
            (Some(a), Some(b)) => self.between([a, b], track),
            _ => self.plain[track],
        };
        at[0] = to_grid(led(track));
        at[1] = rounded_down(self.levels[track].into(), self.scaling.factor);
        // The other edge may be the track above or the one below.
        let [above, below] = [track.checked_add(1), track.checked_sub(1)]
            .map(|other| other.filter(|other| *other < self.levels.len()));
        let under = above.map(|other| to_grid(led(other)).wrapping_sub(self.width(track, other)[1]));
        let over = below.map(|other| to_grid(led(other)).wrapping_add(self.width(other, track)[0]));
        (at[4], at[8]) = (under.or(over).unwrap_or(at[0]), over.or(under).unwrap_or(at[0]));
        let is_whole = |position: i32| position & 63 == 0;
        if let Some(a) = lower {
            let [down, up] = self.width(a, track);
            at[5] = self.hinted[a].wrapping_add(if is_whole(self.hinted[a]) { down } else { up });
        }
        if let Some(b) = upper {
            let [down, up] = self.width(track, b);
            at[9] = self.hinted[b].wrapping_sub(if is_whole(self.hinted[b]) { up } else { down });
        }
        at
    }

    /// How far a track is above another, rounded down and up.
    fn width(&self, lower: usize, upper: usize) -> [i32; 2] {
        let units = i32::from(self.levels[upper]) - i32::from(self.levels[lower]);
        [rounded_down(units, self.scaling.factor), rounded_down(-units, self.scaling.factor).wrapping_neg()]
    }
}

impl<const N: usize> Rules<N> {
    /// For each rule that has what it needs, all bits.
    #[inline(always)]
    pub(super) fn valid(&self) -> [i32x4; N] {
        lanes(&VALID[self.valid % VALID.len()])
    }

    /// The rules that have what they need, with their positions.
    pub(super) fn each(&self) -> impl Iterator<Item = (usize, i32)> {
        let valid = VALID[self.valid % VALID.len()];
        let rules = (0..RULES).filter(move |rule| valid[*rule] != 0);
        rules.map(|rule| (rule, self.lanes[rule / 4 % N].to_array()[rule % 4]))
    }
}

/// For each lane with this number, all bits.
#[inline(always)]
pub(super) fn equal<const N: usize>(lanes: [i32x4; N], number: i32) -> [i32x4; N] {
    let number = i32x4::splat(number);
    lanes.map(|lanes| lanes.simd_eq(number))
}

#[inline(always)]
pub(super) fn lanes<const N: usize, T: Copy + Into<i32>>(from: &[T; ROOM]) -> [i32x4; N] {
    core::array::from_fn(|group| i32x4::new([0, 1, 2, 3].map(|lane| from[(4 * group + lane) % ROOM].into())))
}

#[cfg(test)]
mod tests;
