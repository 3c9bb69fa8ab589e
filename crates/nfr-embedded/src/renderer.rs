//! embedded-graphics' interface for text.

use alloc::vec::Vec;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::primitives::{PointsIter, Rectangle};
use embedded_graphics::text::renderer::{TextMetrics, TextRenderer};
use embedded_graphics::text::{Baseline, DecorationColor};
use nfr::{MonoBitmapRef, Placement};

use crate::blend::Blend;
use crate::ink::Ink;
use crate::style::{Line, Style};

impl<C: Blend> Style<'_, C> {
    /// The width of a line of text: the sum of hinted advance widths.
    fn width(&self, text: &str) -> i32 {
        let widths = text.chars().filter_map(|character| {
            let glyph = self.face.glyph(character)?;
            Some(self.face.advance(character, glyph, self.ppem))
        });
        widths.fold(0, i32::saturating_add)
    }

    /// Draws the background of a piece of text.
    fn draw_background<D: DrawTarget<Color = C>>(
        &self,
        area: &Rectangle,
        target: &mut D,
    ) -> Result<(), D::Error> {
        match self.background {
            Some(colour) if !area.is_zero_sized() => target.fill_solid(area, colour),
            _ => Ok(()),
        }
    }

    /// Underlines a piece of text that begins at `top_left`, and strikes it through.
    fn draw_decorations<D: DrawTarget<Color = C>>(
        &self,
        line: &Line,
        top_left: Point,
        width: u32,
        target: &mut D,
    ) -> Result<(), D::Error> {
        for (decoration, y) in [(&self.underline, line.underline), (&self.strikethrough, line.strikethrough)]
        {
            let colour = match decoration {
                DecorationColor::None => None,
                DecorationColor::TextColor => self.text,
                DecorationColor::Custom(colour) => Some(*colour),
            };
            if let (Some(colour), true) = (colour, width > 0 && line.height > 0) {
                let size = Size::new(width, line.thickness);
                target.fill_solid(&Rectangle::new(top_left + Point::new(0, y), size), colour)?;
            }
        }
        Ok(())
    }

    /// Draws one glyph whose origin is at `origin`, the top left of the first pixel below the baseline. Returns what has to be kept
    /// for the next one.
    fn draw_glyph<D: DrawTarget<Color = C>>(
        &self,
        (character, glyph): (char, u32),
        origin: Point,
        before: Ink,
        target: &mut D,
    ) -> Result<Ink, D::Error> {
        let Some(text) = self.text else { return Ok(before) };
        let at = |placement: Placement| {
            let left = origin.x.saturating_add(placement.left);
            let top = origin.y.saturating_sub(placement.top);
            let area = Rectangle::new(Point::new(left, top), Size::new(placement.width, placement.height));
            // What lies outside of the display is not copied.
            let seen = area.intersection(&target.bounding_box());
            (!seen.is_zero_sized()).then_some(area)
        };
        let ink = if C::IS_BINARY {
            self.face.draw_mono(character, glyph, self.ppem, |bitmap| {
                at(bitmap.placement).map(|area| Ink::new(area, unpacked(bitmap)))
            })
        } else {
            self.face.draw(character, glyph, self.ppem, |bitmap| {
                at(bitmap.placement).map(|area| Ink::new(area, bitmap.pixels.to_vec()))
            })
        };
        let Some(ink) = ink.flatten().map(|ink| ink.over(&before)) else { return Ok(before) };
        match self.background {
            Some(ground) => {
                let colours = ink.coverage.iter().map(|level| ground.blend(text, *level));
                target.fill_contiguous(&ink.area, colours)?;
            }
            None => {
                let covered = ink.area.points().zip(&ink.coverage).filter(|(_, level)| **level > 0);
                let pixels = covered.map(|(point, level)| (point, self.ground.blend(text, *level)));
                let seen = pixels.filter(|(_, colour)| *colour != self.ground);
                target.draw_iter(seen.map(|(point, colour)| Pixel(point, colour)))?;
            }
        }
        Ok(ink)
    }
}

/// A byte a pixel: 255 where it is black.
fn unpacked(bitmap: MonoBitmapRef<'_>) -> Vec<u8> {
    let width = bitmap.placement.width;
    let level = |row: &[u8], x: u32| if row[x as usize / 8] & (0x80 >> (x % 8)) == 0 { 0 } else { 255 };
    bitmap.rows().flat_map(|row| (0..width).map(move |x| level(row, x))).collect()
}

impl<C: Blend> TextRenderer for Style<'_, C> {
    type Color = C;

    fn draw_string<D: DrawTarget<Color = C>>(
        &self,
        text: &str,
        position: Point,
        baseline: Baseline,
        target: &mut D,
    ) -> Result<Point, D::Error> {
        let line = self.line();
        let top_left = position - Point::new(0, line.offset(baseline));
        if self.background.is_some() {
            let width = self.width(text).max(0) as u32;
            self.draw_background(&Rectangle::new(top_left, Size::new(width, line.height)), target)?;
        }
        let (mut x, mut ink) = (position.x, Ink::default());
        for character in text.chars() {
            let Some(glyph) = self.face.glyph(character) else { continue };
            let origin = Point::new(x, top_left.y + line.ascent);
            ink = self.draw_glyph((character, glyph), origin, ink, target)?;
            x = x.saturating_add(self.face.advance(character, glyph, self.ppem));
        }
        let width = x.saturating_sub(position.x).max(0) as u32;
        self.draw_decorations(&line, top_left, width, target)?;
        Ok(Point::new(x, position.y))
    }

    fn draw_whitespace<D: DrawTarget<Color = C>>(
        &self,
        width: u32,
        position: Point,
        baseline: Baseline,
        target: &mut D,
    ) -> Result<Point, D::Error> {
        let line = self.line();
        let top_left = position - Point::new(0, line.offset(baseline));
        self.draw_background(&Rectangle::new(top_left, Size::new(width, line.height)), target)?;
        self.draw_decorations(&line, top_left, width, target)?;
        Ok(Point::new(position.x.saturating_add_unsigned(width), position.y))
    }

    /// The box has the height of a line, with the underline, and the width of the advances; letters that lean may reach out of it.
    fn measure_string(&self, text: &str, position: Point, baseline: Baseline) -> TextMetrics {
        let line = self.line();
        let width = self.width(text);
        let underlined = match self.underline {
            DecorationColor::None => 0,
            _ => line.underline.saturating_add_unsigned(line.thickness).max(0) as u32,
        };
        let size = Size::new(width.max(0) as u32, line.height.max(underlined));
        TextMetrics {
            bounding_box: Rectangle::new(position - Point::new(0, line.offset(baseline)), size),
            next_position: Point::new(position.x.saturating_add(width), position.y),
        }
    }

    fn line_height(&self) -> u32 {
        let line = self.line();
        line.height + line.gap
    }
}
