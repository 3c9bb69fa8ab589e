//! Whether a glyph is the sum of others' hinted outlines.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use super::coverage::sum;
use crate::compare::metrics::Sums;
use crate::error::Error;
use crate::teacher::{Outline, Teacher, TeacherAt};
use nfr::Bitmap;
use nfr::internals::model::compose::{Part, round_to_fraction, round_to_grid};
use nfr::internals::model::gridfit::Scale;
use nfr::internals::model::outline::scale_of;
use nfr::internals::mul_fixed;
use nfr::internals::table::MAX_GRID_OFFSET_BYTES;

/// The largest distance of a hinted point from the moved part's (pixels): a quantisation step of models.
const MAX_POINT_ERROR: f32 = 1.0 / 32.0;
/// The same where parts have to be exact: less than the 1/64 pixel that hinted points are rounded to.
const ROUNDING: f32 = 1.0 / 256.0;
/// The largest error of the sum of the parts' exact bitmaps (mae over all sizes): a fraction of the models' own. Parts
/// that overlap a lot have more.
const MAX_SUM_ERROR: f64 = 0.0005;

/// A glyph's outlines.
pub(super) struct GlyphOutlines {
    /// In em.
    unhinted: Outline,
    /// In pixels, at each size.
    hinted: Vec<Outline>,
    /// Whether hinting changes the contours at any size, so that points do not correspond.
    contours_change: bool,
}

/// Matches glyphs with parts.
pub(super) struct PartMatcher<'t> {
    teacher: &'t Teacher,
    sizes: &'t [TeacherAt],
    /// The same sizes in pixels per em.
    ppem: Vec<usize>,
    /// The sizes that the table will have.
    scale: Scale,
    /// The largest distance of a hinted point from the moved part's, in pixels.
    tolerance: f32,
    /// The outlines of the glyphs that have been tried as parts.
    outlines: HashMap<u16, Rc<GlyphOutlines>>,
    /// The distinct lists of grid-fitted offsets of all matched parts.
    grid_offsets: BTreeSet<Vec<i8>>,
}

impl<'t> PartMatcher<'t> {
    pub(super) fn new(teacher: &'t Teacher, sizes: &'t [TeacherAt], scale: Scale, exact: bool) -> Self {
        let ppem = sizes.iter().map(|at| at.ppem().into()).collect();
        let tolerance = if exact { ROUNDING } else { MAX_POINT_ERROR };
        Self {
            teacher,
            sizes,
            ppem,
            scale,
            tolerance,
            outlines: HashMap::new(),
            grid_offsets: BTreeSet::new(),
        }
    }

    pub(super) fn units_per_em(&self) -> u16 {
        self.scale.units_per_em()
    }

    pub(super) fn unhinted(&self, gid: u16) -> Result<Outline, Error> {
        self.teacher.unhinted_em(gid)
    }

    pub(super) fn draw(&self, gid: u16) -> Result<GlyphOutlines, Error> {
        let unhinted = self.unhinted(gid)?;
        let hinted = self.sizes.iter().map(|at| at.hinted_with_error(gid).map(|(outline, _)| outline));
        let hinted = hinted.collect::<Result<Vec<_>, _>>()?;
        let contours_change = !hinted.iter().all(|hinted| hinted.has_contours_of(&unhinted));
        Ok(GlyphOutlines { unhinted, hinted, contours_change })
    }

    fn draw_part(&mut self, gid: u16) -> Result<Rc<GlyphOutlines>, Error> {
        if let Some(outlines) = self.outlines.get(&gid) {
            return Ok(outlines.clone());
        }
        let outlines = Rc::new(self.draw(gid)?);
        self.outlines.insert(gid, outlines.clone());
        Ok(outlines)
    }

    /// The parts of a glyph with these simple components, if their models can be drawn in its place.
    pub(super) fn match_parts(
        &mut self,
        whole: &GlyphOutlines,
        components: &[u16],
    ) -> Result<Option<Vec<Part>>, Error> {
        let outlines = components.iter().map(|gid| self.draw_part(*gid)).collect::<Result<Vec<_>, _>>()?;
        if whole.contours_change || outlines.iter().any(|part| part.contours_change) {
            return Ok(None);
        }
        let mut parts = Vec::with_capacity(components.len());
        let mut at = 0;
        for (gid, part) in components.iter().zip(&outlines) {
            let Some(part) =
                match_part(whole, at, *gid, part, &self.ppem, (self.units_per_em(), self.tolerance))
            else {
                return Ok(None);
            };
            at += outlines[parts.len()].unhinted.points.len();
            parts.push(part);
        }
        if at != whole.unhinted.points.len() || self.sum_error(whole, &outlines, &parts)? > MAX_SUM_ERROR {
            return Ok(None);
        }
        let lists =
            parts.iter().flat_map(|part| &part.grid_offsets).filter(|grid_offsets| !grid_offsets.is_empty());
        let new: BTreeSet<&Vec<i8>> =
            lists.filter(|grid_offsets| !self.grid_offsets.contains(*grid_offsets)).collect();
        // Once the table's lists are full, further glyphs get models of their own.
        let count = self.grid_offsets.len() + new.len();
        if count >= usize::from(u16::MAX) || count * self.scale.sizes() > MAX_GRID_OFFSET_BYTES {
            return Ok(None);
        }
        self.grid_offsets.extend(new.into_iter().cloned());
        Ok(Some(parts))
    }

    /// The error of the sum of the parts' exact bitmaps (mae).
    fn sum_error(
        &self,
        whole: &GlyphOutlines,
        outlines: &[Rc<GlyphOutlines>],
        parts: &[Part],
    ) -> Result<f64, Error> {
        let mut sums = Sums::default();
        for (size, (hinted, ppem)) in whole.hinted.iter().zip(&self.ppem).enumerate() {
            let moved = outlines.iter().zip(parts).map(|(outlines, part)| {
                let mut outline = outlines.hinted[size].clone();
                outline.translate(part_offset(part, size, *ppem, self.units_per_em()));
                outline.rasterize()
            });
            sums.add(&hinted.rasterize()?, &sum(&moved.collect::<Result<Vec<Bitmap>, Error>>()?));
        }
        Ok(sums.mae())
    }
}

/// The offset of a part (pixels) at a size, which is given by its index, too.
fn part_offset(part: &Part, size: usize, ppem: usize, units_per_em: u16) -> [f32; 2] {
    [0, 1].map(|axis| {
        let offset = part.offset[axis];
        match part.grid_offsets[axis].get(size) {
            Some(snap) => (round_to_grid(offset, ppem, units_per_em) + i32::from(*snap)) as f32,
            None => round_to_fraction(f32::from(offset) / f32::from(units_per_em), ppem as f32),
        }
    })
}

/// The offset of `part` in a glyph whose points from `at` on have to be the part's. Both are hinted at the sizes `ppem`.
fn match_part(
    whole: &GlyphOutlines,
    at: usize,
    gid: u16,
    part: &GlyphOutlines,
    ppem: &[usize],
    (units_per_em, tolerance): (u16, f32),
) -> Option<Part> {
    let count = part.unhinted.points.len();
    let units = f32::from(units_per_em);
    let mut matched = Part { gid, ..Part::default() };
    for axis in 0..2 {
        // Half the range of the points' differences, and its middle.
        let difference = |whole: &Outline, part: &Outline| {
            let pairs = whole.points.get(at..at + count)?.iter().zip(part.points.get(..count)?);
            let (low, high) = pairs
                .map(|(whole, part)| whole[axis] - part[axis])
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)));
            Some((0.5 * (high - low), 0.5 * (high + low)))
        };
        let (spread, offset) = difference(&whole.unhinted, &part.unhinted)?;
        let offset = offset * units;
        if spread * units > 0.5 || offset.abs() > f32::from(i16::MAX) {
            return None;
        }
        matched.offset[axis] = offset.round() as i16;
        let mut offsets = Vec::with_capacity(part.hinted.len());
        for (whole, part) in whole.hinted.iter().zip(&part.hinted) {
            let (spread, offset) = difference(whole, part)?;
            if spread > tolerance {
                return None;
            }
            offsets.push(offset);
        }
        matched.grid_offsets[axis] =
            grid_fitting(&offsets, matched.offset[axis], ppem, (units_per_em, tolerance))?;
    }
    Some(matched)
}

/// The grid-fitting of a part's hinted `offsets` (pixels, at the sizes `ppem`): empty if they are the unhinted `offset`
/// (font units), otherwise the whole pixels from the rounded one at each size.
fn grid_fitting(
    offsets: &[f32],
    offset: i16,
    ppem: &[usize],
    (units_per_em, tolerance): (u16, f32),
) -> Option<Vec<i8>> {
    let mut sizes = offsets.iter().zip(ppem);
    let unhinted = |ppem: usize| mul_fixed(offset.into(), scale_of(ppem as f32, units_per_em)) as f32 / 64.0;
    if sizes.all(|(at, ppem)| (at - unhinted(*ppem)).abs() <= tolerance) {
        return Some(Vec::new());
    }
    let snap = |(at, ppem): (&f32, &usize)| {
        let pixel = at.round();
        let pixels = i8::try_from(pixel as i32 - round_to_grid(offset, *ppem, units_per_em)).ok()?;
        ((at - pixel).abs() <= tolerance).then_some(pixels)
    };
    offsets.iter().zip(ppem).map(snap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_that_is_neither_unhinted_nor_whole_pixels_does_not_match() {
        // Unhinted: 0.123 em.
        let fit = |offsets: &[f32]| grid_fitting(offsets, 123, &[10, 11, 12], (1000, MAX_POINT_ERROR));
        assert_eq!(fit(&[1.23, 1.353, 1.476]), Some(vec![]));
        assert_eq!(fit(&[1.0, 2.0, 1.0]), Some(vec![0, 1, 0]));
        assert_eq!(fit(&[1.0, 1.5, 1.0]), None);
        assert_eq!(fit(&[1.0, 200.0, 1.0]), None);
    }
}
