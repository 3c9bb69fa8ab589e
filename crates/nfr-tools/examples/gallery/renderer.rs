//! Four ways to draw a glyph at a subpixel offset.

use std::error::Error;
use std::ops::Range;

use image::GrayImage;
use nfr::{Bitmap, DrawOptions, Rasterizer};
use nfr_convert::open::owned;
use nfr_convert::teacher::{Teacher, TeacherAt};

use crate::autohinted::{Autohinted, AutohintedAt};
use crate::ink::{blend, split_position};
use crate::layout::PositionedGlyph;
use crate::typeface::Typeface;

/// Their names, in the order of [`Renderer::all`].
pub(crate) const NAMES: [&str; 4] = ["neural", "hinted", "unhinted", "autohinted"];

/// A renderer of one font at one size.
pub(crate) struct Renderer<'t> {
    way: Way<'t>,
    ppem: u16,
    units_per_em: i32,
}

enum Way<'t> {
    Neural(Box<Rasterizer>),
    Hinted(Box<TeacherAt>),
    Unhinted(&'t Teacher),
    Autohinted(Box<AutohintedAt>),
}

impl<'t> Renderer<'t> {
    /// All four.
    pub(crate) fn all(typeface: &'t Typeface<'_>, ppem: u16) -> Result<[Self; 4], Box<dyn Error>> {
        let pair = &typeface.pair;
        let ways = [
            Way::Neural(Box::new(Rasterizer::new(pair.font()))),
            Way::Hinted(Box::new(pair.teacher().at(ppem)?)),
            Way::Unhinted(pair.teacher()),
            Way::Autohinted(Box::new(Autohinted(owned(pair.original())?).at_size(ppem)?)),
        ];
        Ok(ways.map(|way| Self { way, ppem, units_per_em: typeface.units_per_em() }))
    }

    /// Draws a line with its start at `x`, on the baseline `y`. What is not in `columns` is cut off.
    pub(crate) fn line(
        &mut self,
        line: &[PositionedGlyph],
        picture: &mut GrayImage,
        [x, y]: [i64; 2],
        columns: &Range<i64>,
    ) -> Result<(), Box<dyn Error>> {
        for glyph in line {
            let (pixels, offset) = split_position(glyph.x, self.ppem, self.units_per_em);
            let up = f64::from(glyph.y) * f64::from(self.ppem) / f64::from(self.units_per_em);
            let Bitmap { placement, pixels: coverage } = self.bitmap(glyph.gid, offset)?;
            blend(picture, [x + pixels, y - up.round() as i64], &placement, &coverage, columns, 255);
        }
        Ok(())
    }

    fn bitmap(&mut self, gid: u16, x: f32) -> Result<Bitmap, Box<dyn Error>> {
        let mut outline = match &mut self.way {
            Way::Neural(rasterizer) => {
                let options = DrawOptions::new(self.ppem.into()).with_offset([x, 0.0]);
                return Ok(rasterizer.render(gid.into(), options)?);
            }
            Way::Hinted(teacher) => teacher.hinted(gid)?,
            Way::Unhinted(teacher) => teacher.unhinted(gid, self.ppem.into())?,
            Way::Autohinted(hinter) => hinter.outline(gid)?,
        };
        outline.translate([x, 0.0]);
        Ok(outline.rasterize()?)
    }
}
