//! A glyph's outline as `glyf` has it: points in font units, components resolved.

use alloc::vec::Vec;

use read_fonts::model::glyph::outline::UnscaledOutlineSink;
use read_fonts::tables::glyf::PointFlags;

/// The points of an outline in font units, contour after contour.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OutlinePoints {
    /// Coordinates along x and y.
    pub coordinates: [Vec<i16>; 2],
    /// Whether each point is on the curve; the others are control points of quadratic curves.
    pub on_curve: Vec<bool>,
    /// Where each contour ends.
    pub ends: Vec<u16>,
    /// Whether something did not fit: a coordinate outside of 16 bits, more than 65535 points, or a cubic curve.
    pub is_unfit: bool,
}

impl OutlinePoints {
    /// The number of points.
    pub fn len(&self) -> usize {
        self.on_curve.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.on_curve.is_empty()
    }

    /// The points of each contour.
    pub fn contours(&self) -> impl Iterator<Item = core::ops::Range<usize>> + '_ {
        let starts = core::iter::once(0).chain(self.ends.iter().map(|end| usize::from(*end)));
        starts.zip(&self.ends).map(|(start, end)| start..usize::from(*end))
    }

    /// A hash of all points and of the advance width in font units, by which a model knows its outline: FNV-1a of 32 bits, folded
    /// to 16.
    pub fn hash(&self, advance: u16) -> u16 {
        let mut hash = 0x811C_9DC5u32;
        let mut add = |value: u16| hash = (hash ^ u32::from(value)).wrapping_mul(0x0100_0193);
        let [x, y] = &self.coordinates;
        for ((x, y), on_curve) in x.iter().zip(y).zip(&self.on_curve) {
            add(*x as u16);
            add(*y as u16);
            add(u16::from(*on_curve));
        }
        self.ends.iter().for_each(|end| add(*end));
        add(advance);
        (hash ^ hash >> 16) as u16
    }

    /// The memory that the points take, in bytes.
    pub fn memory(&self) -> usize {
        self.len() * (2 * size_of::<i16>() + size_of::<bool>()) + self.ends.len() * size_of::<u16>()
    }
}

impl OutlinePoints {
    /// Makes room for so many more contours and points.
    pub(crate) fn reserve(&mut self, contours: usize, points: usize) {
        self.coordinates.iter_mut().for_each(|coordinates| coordinates.reserve_exact(points));
        self.on_curve.reserve_exact(points);
        self.ends.reserve_exact(contours);
    }

    /// Adds a point.
    #[inline]
    pub(crate) fn add(&mut self, point: [i32; 2], on_curve: bool) {
        for (coordinates, v) in self.coordinates.iter_mut().zip(point) {
            self.is_unfit |= i16::try_from(v).is_err();
            coordinates.push(v as i16);
        }
        self.on_curve.push(on_curve);
    }

    /// Ends a contour before the point with this number.
    pub(crate) fn end_contour_at(&mut self, end: usize) {
        self.is_unfit |= u16::try_from(end).is_err();
        self.ends.push(end.try_into().unwrap_or(u16::MAX));
    }

    /// A point.
    pub(crate) fn at(&self, point: usize) -> Option<[i32; 2]> {
        let [x, y] = &self.coordinates;
        Some([(*x.get(point)?).into(), (*y.get(point)?).into()])
    }

    /// Puts a point somewhere else.
    pub(crate) fn set(&mut self, point: usize, to: [i32; 2]) {
        for (coordinates, v) in self.coordinates.iter_mut().zip(to) {
            self.is_unfit |= i16::try_from(v).is_err();
            if let Some(coordinate) = coordinates.get_mut(point) {
                *coordinate = v as i16;
            }
        }
    }
}

impl UnscaledOutlineSink for OutlinePoints {
    fn start_contour(&mut self) {}

    fn point(&mut self, x: i32, y: i32, flags: PointFlags) {
        self.is_unfit |= flags.is_off_curve_cubic();
        self.add([x, y], flags.is_on_curve());
    }

    fn end_contour(&mut self) {
        self.end_contour_at(self.len());
    }
}

#[cfg(test)]
mod tests;
