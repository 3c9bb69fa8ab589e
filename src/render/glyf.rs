//! Reading outlines (OpenType 1.9, "glyf" and "loca"): the points of simple glyphs, and those of composite ones with their
//! components put in place, as read-fonts has them. Its own reader also varies, scales and hints; this one takes a tenth of the code.

use read_fonts::tables::hmtx::Hmtx;
use read_fonts::tables::loca::Loca;
use read_fonts::types::GlyphId;

use super::bytes::Bytes;
use super::component::Component;
use crate::model::outline::OutlinePoints;

/// The deepest nesting of components that is read, the most components, and the most points of a glyph: those of HarfBuzz.
const MAX_DEPTH: usize = 64;
const MAX_COMPONENTS: usize = 2048;
const MAX_POINTS: usize = 1 << 16;

/// The bytes of a glyph before its contours' ends or its components: the number of contours, and the box.
const HEADER: usize = 10;

/// Bits of a point's flags. Those of y are the next ones.
const ON_CURVE: u8 = 1;
const X_IS_BYTE: u8 = 2;
const REPEATED: u8 = 8;
const X_IS_SAME_OR_POSITIVE: u8 = 0x10;
const CUBIC: u8 = 0x80;

/// Where outlines are.
pub(super) struct Outlines<'a> {
    pub(super) glyf: &'a [u8],
    pub(super) loca: Loca<'a>,
}

/// What a glyph's bytes stand for.
pub(super) enum Outline<'a> {
    Blank,
    Simple { contours: usize, left: i16, bytes: Bytes<'a> },
    Composite { left: i16, bytes: Bytes<'a> },
}

impl<'a> Outlines<'a> {
    /// What there is for a glyph. None if it cannot be read.
    pub(super) fn get(&self, glyph: u32) -> Option<Outline<'a>> {
        let at = |glyph: u32| self.loca.get_raw(glyph as usize).map(|at| at as usize);
        let (start, end) = (at(glyph)?, at(glyph.checked_add(1)?)?);
        if start == end {
            return Some(Outline::Blank);
        }
        let (header, bytes) = self.glyf.get(start..end)?.split_at_checked(HEADER)?;
        let mut header = Bytes(header);
        let (contours, left) = (header.i16()?, header.i16()?);
        let bytes = Bytes(bytes);
        Some(match usize::try_from(contours) {
            Ok(contours) => Outline::Simple { contours, left, bytes },
            Err(_) => Outline::Composite { left, bytes },
        })
    }

    /// The points of a glyph, placed by the left side bearings of `hmtx`. None if they cannot be read.
    pub(super) fn load(&self, hmtx: &Hmtx<'_>, glyph: u32) -> Option<OutlinePoints> {
        let points = OutlinePoints::default();
        let mut loading = Loading { outlines: self, hmtx, points, components: 0 };
        let origin = loading.load(glyph, MAX_DEPTH)?;
        if origin != 0 {
            loading.translate(0, [-origin, 0]);
        }
        Some(loading.points)
    }
}

/// A glyph that is being read.
struct Loading<'l> {
    outlines: &'l Outlines<'l>,
    hmtx: &'l Hmtx<'l>,
    points: OutlinePoints,
    /// How many have been read.
    components: usize,
}

impl Loading<'_> {
    /// Adds the points of a glyph, and returns where its left side bearing begins.
    fn load(&mut self, glyph: u32, depth: usize) -> Option<i32> {
        let bearing = || i32::from(self.hmtx.side_bearing(GlyphId::new(glyph)).unwrap_or(0));
        match self.outlines.get(glyph)? {
            Outline::Blank => Some(-bearing()),
            Outline::Simple { contours, left, bytes } => {
                let origin = i32::from(left) - bearing();
                simple(contours, bytes, &mut self.points)?;
                Some(origin)
            }
            Outline::Composite { left, bytes } => {
                let mut origin = i32::from(left) - bearing();
                let base = self.points.len();
                for component in Component::list(bytes) {
                    let component = component?;
                    self.components += 1;
                    if self.components > MAX_COMPONENTS {
                        return None;
                    }
                    let start = self.points.len();
                    let own = self.load(component.glyph, depth.checked_sub(1)?)?;
                    if component.has_metrics() {
                        origin = own;
                    }
                    self.place(&component, base, start)?;
                }
                Some(origin)
            }
        }
    }

    /// Puts the points from `start` on in place, those of a component. Anchors count from `base`.
    fn place(&mut self, component: &Component, base: usize, start: usize) -> Option<()> {
        if component.is_scaled() {
            for at in start..self.points.len() {
                let point = component.scaled(self.points.at(at)?);
                self.points.set(at, point);
            }
        }
        let offset = match component.offset() {
            Some(offset) => offset,
            None => {
                let [anchor, own] = component.anchors();
                let (anchor, own) = (self.points.at(base + anchor)?, self.points.at(start + own)?);
                [anchor[0] - own[0], anchor[1] - own[1]]
            }
        };
        if offset != [0; 2] {
            self.translate(start, offset);
        }
        Some(())
    }

    fn translate(&mut self, start: usize, by: [i32; 2]) {
        for at in start..self.points.len() {
            if let Some([x, y]) = self.points.at(at) {
                self.points.set(at, [x.wrapping_add(by[0]), y.wrapping_add(by[1])]);
            }
        }
    }
}

/// Adds the points of a simple glyph.
fn simple(contours: usize, mut bytes: Bytes<'_>, points: &mut OutlinePoints) -> Option<()> {
    let ends = bytes.take(2 * contours)?;
    let instructions = usize::from(bytes.u16()?);
    let start = points.len();
    let count = match ends.last_chunk() {
        Some(last) => usize::from(u16::from_be_bytes(*last)) + 1,
        None => return Some(()),
    };
    if start + count > MAX_POINTS {
        return None;
    }
    bytes.take(instructions)?;
    let (mut flags, mut x, mut y) = coordinates(bytes, count)?;
    points.reserve(contours, count);
    let (mut at, mut left) = ([0i32; 2], count);
    while left > 0 {
        let (flag, run) = run(&mut flags, left)?;
        left -= run;
        for _ in 0..run {
            let [dx, dy] = [step(&mut x, flag)?, step(&mut y, flag >> 1)?];
            at = [at[0].wrapping_add(dx), at[1].wrapping_add(dy)];
            points.add(at, flag & ON_CURVE != 0);
        }
        points.is_unfit |= flag & (ON_CURVE | CUBIC) == CUBIC;
    }
    let mut before = 0;
    for end in ends.chunks_exact(2) {
        let end = start + usize::from(u16::from_be_bytes([end[0], end[1]])) + 1;
        if end < before {
            return None;
        }
        points.end_contour_at(end);
        before = end;
    }
    Some(())
}

/// Splits the points of a simple glyph into flags, and coordinates along x and y.
fn coordinates(bytes: Bytes<'_>, count: usize) -> Option<(Bytes<'_>, Bytes<'_>, Bytes<'_>)> {
    let mut rest = bytes;
    let (mut length, mut left) = (0, count);
    while left > 0 {
        let (flag, run) = run(&mut rest, left)?;
        left -= run;
        length += run * width(flag);
    }
    let x = rest.take(length)?;
    Some((bytes, Bytes(x), rest))
}

/// The flags of the next points, and how many have them, of those that are `left`.
#[inline]
fn run(flags: &mut Bytes<'_>, left: usize) -> Option<(u8, usize)> {
    let flag = flags.u8()?;
    let repeats = if flag & REPEATED != 0 { flags.u8()? } else { 0 };
    Some((flag, left.min(usize::from(repeats) + 1)))
}

/// The bytes that a step along x takes.
fn width(flag: u8) -> usize {
    match (flag & X_IS_BYTE != 0, flag & X_IS_SAME_OR_POSITIVE != 0) {
        (true, _) => 1,
        (false, true) => 0,
        (false, false) => 2,
    }
}

/// The distance of the next point along x.
#[inline]
fn step(bytes: &mut Bytes<'_>, flag: u8) -> Option<i32> {
    Some(match (flag & X_IS_BYTE != 0, flag & X_IS_SAME_OR_POSITIVE != 0) {
        (true, true) => bytes.u8()?.into(),
        (true, false) => -i32::from(bytes.u8()?),
        (false, true) => 0,
        (false, false) => bytes.i16()?.into(),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
