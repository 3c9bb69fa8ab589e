//! The ground truth: hinted bitmaps in square boxes, sized by the rule of the paper "Neural Font Rendering"
//! (Anderson, Shamir, Fried).
//!
//! All glyphs of a set share one box of *s*×*s* pixels and one origin in it. The type is as large as the set allows: the
//! box around all hinted glyphs, the origin and the baseline must not be larger than the square.

mod fit;
mod store;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::RangeInclusive;

use read_fonts::tables::head::Flags;
use read_fonts::{FontRef, TableProvider};

use super::SquareBitmap;
use nfr::Target;
use nfr::{Bitmap, Placement};
use nfr_convert::compare::metrics::coverage_at;
use nfr_convert::error::Error;
use nfr_convert::teacher::Outline;
use nfr_convert::teacher::Teacher;

pub use store::store;

/// One size of the ground truth, as the rule finds it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TruthSize {
    /// Pixels along a side of the box, *s*.
    pub side: usize,
    /// The size in points (1/72 inch).
    pub point_size: u32,
    /// The resolution in dots per inch, at least 72.
    pub resolution: u32,
    /// The resulting size in whole pixels per em.
    pub ppem: u16,
    /// The box around all glyphs, the origin and the baseline: x_min, y_min, x_max, y_max in pixels from the origin, y up.
    pub bounds: [i32; 4],
}

impl TruthSize {
    /// The glyphs' common origin in the box: the column right of it, and the row below the baseline, counted from the top.
    pub fn origin(&self) -> [i32; 2] {
        [-self.bounds[0], self.bounds[3]]
    }

    /// The column and the row, from the top, of the box's pixel where a bitmap's first pixel lies.
    pub fn corner(&self, placement: &Placement) -> [i32; 2] {
        let [column, row] = self.origin();
        [column + placement.left, row - placement.top]
    }

    /// A bitmap in the box, its origin where it is for all glyphs. What lies outside is cut off.
    pub fn square(&self, bitmap: &Bitmap) -> SquareBitmap {
        let mut pixels = vec![0; self.side * self.side];
        let [left, top] = self.corner(&bitmap.placement);
        let inside = |v: i32| usize::try_from(v).ok().filter(|&v| v < self.side);
        for (y, row) in (top..).zip(bitmap.pixels.chunks_exact(bitmap.placement.width.max(1) as usize)) {
            for (x, &coverage) in (left..).zip(row) {
                if let (Some(x), Some(y)) = (inside(x), inside(y)) {
                    pixels[y * self.side + x] = coverage;
                }
            }
        }
        SquareBitmap { side: self.side, pixels }
    }
}

/// A set of glyphs of one font, hinted and plain, at every size.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The sizes, ascending.
    pub sizes: Vec<TruthSize>,
    /// Deviations from the paper: fonts that ask for sizes between whole pixels, hints switched off, programs
    /// that fail. In sentences, for people.
    pub warnings: Vec<String>,
    gids: Vec<u16>,
    /// By pixels per em, in the order of `gids`.
    drawn: BTreeMap<u16, Vec<GlyphBitmaps>>,
}

/// A glyph at one size.
#[derive(Debug, Clone)]
struct GlyphBitmaps {
    hinted: Bitmap,
    plain: Bitmap,
}

impl Truth {
    /// Finds the sizes for boxes of `sides` pixels, and draws the glyphs at them, hinted for grey pixels as FreeType
    /// does by default.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for a set without ink, or a side at which nothing fits or every size does; and as the
    /// teacher's, if the font cannot be hinted.
    pub fn new(font: &FontRef<'_>, gids: &[u16], sides: RangeInclusive<usize>) -> Result<Self, Error> {
        let mut one = Self::of_family(&[(font.clone(), gids)], sides)?;
        one.pop().ok_or_else(|| Error::InvalidParameter("no font is given".into()))
    }

    /// The truths of several fonts at common sizes: those at which the glyphs of all of them fit the box.
    ///
    /// # Errors
    ///
    /// As `new`.
    pub fn of_family(
        fonts: &[(FontRef<'_>, &[u16])],
        sides: RangeInclusive<usize>,
    ) -> Result<Vec<Self>, Error> {
        let mut sets = Vec::with_capacity(fonts.len());
        for (font, gids) in fonts {
            let teacher = Teacher::new(font, Target::Smooth)?;
            let mut gids = gids.to_vec();
            gids.sort_unstable();
            gids.dedup();
            check_ink(&teacher, &gids)?;
            sets.push((teacher, gids));
        }
        let mut hinters: Vec<Hinter<'_>> =
            sets.iter().map(|(teacher, gids)| Hinter { teacher, gids, sizes: BTreeMap::new() }).collect();
        let sizes = sides.map(|side| common_size(&mut hinters, side)).collect::<Result<Vec<_>, _>>()?;
        let truth = |(hinter, (font, _)): (&mut Hinter<'_>, &(FontRef<'_>, &[u16]))| {
            let mut warnings = whole_size_warning(font)?;
            let mut drawn = BTreeMap::new();
            for size in &sizes {
                if let Entry::Vacant(entry) = drawn.entry(size.ppem) {
                    entry.insert(hinter.draw(size.ppem, &mut warnings)?);
                }
            }
            Ok(Self { sizes: sizes.clone(), warnings, gids: hinter.gids.to_vec(), drawn })
        };
        hinters.iter_mut().zip(fonts).map(truth).collect()
    }

    /// The same at some of the sizes only, those whose sides are given.
    pub fn at_sides(mut self, sides: &[usize]) -> Self {
        self.sizes.retain(|size| sides.contains(&size.side));
        self
    }

    /// The glyphs of the set, ascending.
    pub fn gids(&self) -> &[u16] {
        &self.gids
    }

    /// A glyph's hinted bitmap at the size with this index, as large as FreeType's and placed from the origin.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for a glyph that is not in the set, or an index that has no size.
    pub fn bitmap(&self, gid: u16, index: usize) -> Result<&Bitmap, Error> {
        self.pair(gid, index).map(|(_, pair)| &pair.hinted)
    }

    /// A glyph's hinted bitmap in the box: what the paper calls the ground truth.
    ///
    /// # Errors
    ///
    /// As `bitmap`.
    pub fn hinted(&self, gid: u16, index: usize) -> Result<SquareBitmap, Error> {
        self.pair(gid, index).map(|(size, pair)| size.square(&pair.hinted))
    }

    /// The same glyph without its hints, at the same pixels per em and the same origin.
    ///
    /// # Errors
    ///
    /// As `bitmap`.
    pub fn plain(&self, gid: u16, index: usize) -> Result<SquareBitmap, Error> {
        self.pair(gid, index).map(|(size, pair)| size.square(&pair.plain))
    }

    fn pair(&self, gid: u16, index: usize) -> Result<(&TruthSize, &GlyphBitmaps), Error> {
        let size = self.sizes.get(index).ok_or_else(|| {
            let count = self.sizes.len();
            Error::InvalidParameter(format!("there is no size {index}; count from 0 to below {count}"))
        })?;
        let glyph = self.gids.binary_search(&gid).ok();
        let pair = glyph.and_then(|glyph| self.drawn.get(&size.ppem)?.get(glyph));
        let pair = pair.ok_or_else(|| {
            Error::InvalidParameter(format!("glyph {gid} is not in the set; make the truth of a set with it"))
        })?;
        Ok((size, pair))
    }
}

/// The hinted outlines of a set, drawn once per size, since the rule tries the same sizes many times.
struct Hinter<'t> {
    teacher: &'t Teacher,
    gids: &'t [u16],
    sizes: BTreeMap<u16, HintedSet>,
}

struct HintedSet {
    outlines: Vec<Outline>,
    bounds: [i32; 4],
    warnings: Vec<String>,
}

impl Hinter<'_> {
    fn at(&mut self, ppem: u16) -> Result<&HintedSet, Error> {
        if !self.sizes.contains_key(&ppem) {
            let hinted = self.hint(ppem)?;
            self.sizes.insert(ppem, hinted);
        }
        Ok(&self.sizes[&ppem])
    }

    fn hint(&self, ppem: u16) -> Result<HintedSet, Error> {
        let at = self.teacher.at(ppem)?;
        let mut warnings = Vec::new();
        if !at.is_hinted() {
            warnings.push(format!(
                "the font switches its hints off at {ppem} ppem; the truth is the plain glyph"
            ));
        }
        let mut outlines = Vec::with_capacity(self.gids.len());
        for &gid in self.gids {
            let (outline, complaint) = at.hinted_with_error(gid)?;
            warnings.extend(complaint);
            outlines.push(outline);
        }
        let bounds = outlines.iter().map(frame).fold([0; 4], |all, place| {
            let (right, bottom) = (place.left + place.width as i32, place.top - place.height as i32);
            [all[0].min(place.left), all[1].min(bottom), all[2].max(right), all[3].max(place.top)]
        });
        Ok(HintedSet { outlines, bounds, warnings })
    }

    fn draw(&mut self, ppem: u16, warnings: &mut Vec<String>) -> Result<Vec<GlyphBitmaps>, Error> {
        let (teacher, gids) = (self.teacher, self.gids);
        let hinted = self.at(ppem)?;
        warnings.extend(hinted.warnings.iter().cloned());
        let pair = |(outline, &gid): (&Outline, &u16)| {
            let plain = teacher.unhinted(gid, ppem.into())?;
            Ok(GlyphBitmaps { hinted: framed(outline)?, plain: framed(&plain)? })
        };
        hinted.outlines.iter().zip(gids).map(pair).collect()
    }
}

/// The size for a box, at which all sets fit it together.
fn common_size(hinters: &mut [Hinter<'_>], side: usize) -> Result<TruthSize, Error> {
    let mut bounds = |ppem| {
        hinters.iter_mut().try_fold([0; 4], |all: [i32; 4], hinter| {
            let own = hinter.at(ppem)?.bounds;
            Ok::<_, Error>([all[0].min(own[0]), all[1].min(own[1]), all[2].max(own[2]), all[3].max(own[3])])
        })
    };
    let fits = |ppem| {
        let [x_min, y_min, x_max, y_max] = bounds(ppem)?;
        Ok(i64::from(x_max - x_min).max((y_max - y_min).into()) <= side as i64)
    };
    let found = fit::search(fits).map_err(|error| match error {
        Error::InvalidParameter(what) => Error::InvalidParameter(format!(
            "no size of the type fills a box of {side}×{side} pixels ({what}); choose a smaller box"
        )),
        other => other,
    })?;
    let (point_size, resolution) = found.ok_or_else(|| {
        Error::InvalidParameter(format!(
            "at no size do the glyphs fit a box of {side}×{side} pixels; choose a larger box"
        ))
    })?;
    let ppem = fit::whole_ppem(point_size, resolution);
    Ok(TruthSize { side, point_size, resolution, ppem, bounds: bounds(ppem)? })
}

/// The whole pixels around every point of an outline, control points too: the box that FreeType gives its bitmaps,
/// and its metrics of hinted glyphs.
fn frame(outline: &Outline) -> Placement {
    let Some(first) = outline.points.first() else { return Placement::default() };
    let (low, high) = outline.points.iter().fold((*first, *first), |(low, high), point| {
        ([0, 1].map(|k| low[k].min(point[k])), [0, 1].map(|k| high[k].max(point[k])))
    });
    let ([left, bottom], [right, top]) = (low.map(|v| v.floor() as i32), high.map(|v| v.ceil() as i32));
    Placement { left, top, width: (right - left) as u32, height: (top - bottom) as u32 }
}

/// An outline's coverage in its frame.
fn framed(outline: &Outline) -> Result<Bitmap, Error> {
    let (drawn, placement) = (outline.rasterize()?, frame(outline));
    let pixels = (0..placement.height)
        .flat_map(|row| (0..placement.width).map(move |column| (i64::from(column), i64::from(row))))
        .map(|(x, y)| coverage_at(&drawn, x + i64::from(placement.left), y - i64::from(placement.top)))
        .collect();
    Ok(Bitmap { placement, pixels })
}

fn check_ink(teacher: &Teacher, gids: &[u16]) -> Result<(), Error> {
    for &gid in gids {
        if !teacher.unhinted_em(gid)?.points.is_empty() {
            return Ok(());
        }
    }
    Err(Error::InvalidParameter("no glyph of the set has ink; name at least one that has".into()))
}

fn whole_size_warning(font: &FontRef<'_>) -> Result<Vec<String>, Error> {
    let head = font.head().map_err(|e| Error::Malformed(format!("table 'head' cannot be read ({e})")))?;
    let whole = head.flags().contains(Flags::FORCE_INTEGER_PPEM);
    let warning = "the font allows sizes between whole pixels per em ('head' flag 3 is off), where FreeType would \
                   not round; the truth is at the nearest whole sizes";
    Ok(if whole { Vec::new() } else { vec![warning.into()] })
}
