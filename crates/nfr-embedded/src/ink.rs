//! The coverage of what was drawn last, at its place on the display.

use alloc::vec;
use alloc::vec::Vec;

use embedded_graphics::geometry::{Point, Size};
use embedded_graphics::primitives::{PointsIter, Rectangle};

/// Coverage 0–255 over a box, top row first. The boxes of neighbouring glyphs may overlap, and a display cannot be read back; so
/// the last glyph is kept until the next one is drawn.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ink {
    pub(crate) area: Rectangle,
    pub(crate) coverage: Vec<u8>,
}

impl Ink {
    pub(crate) fn new(area: Rectangle, coverage: Vec<u8>) -> Self {
        Self { area, coverage }
    }

    /// A glyph, together with what was drawn before it from its first column on. What two glyphs cover of a pixel is added: outlines
    /// of neighbours do not overlap as a rule.
    pub(crate) fn over(self, before: &Self) -> Self {
        let shared = before.area.columns().end - self.area.top_left.x;
        if shared <= 0 || before.area.is_zero_sized() || self.area.is_zero_sized() {
            return self;
        }
        let left = self.area.top_left.x.max(before.area.top_left.x);
        let size = Size::new((before.area.columns().end - left).max(0) as u32, before.area.size.height);
        let kept = Rectangle::new(Point::new(left, before.area.top_left.y), size);
        let area = around(&self.area, &kept);
        let mut coverage = vec![0u8; area.size.width as usize * area.size.height as usize];
        let mut add = |ink: &Self| {
            for (point, level) in ink.area.points().zip(&ink.coverage) {
                if area.contains(point) {
                    let at = point - area.top_left;
                    let pixel = &mut coverage[at.y as usize * area.size.width as usize + at.x as usize];
                    *pixel = pixel.saturating_add(*level);
                }
            }
        };
        add(&self);
        add(before);
        Self { area, coverage }
    }
}

/// The box around two boxes.
fn around(a: &Rectangle, b: &Rectangle) -> Rectangle {
    let top_left = a.top_left.component_min(b.top_left);
    let ends = |area: &Rectangle| Point::new(area.columns().end, area.rows().end);
    let size = ends(a).component_max(ends(b)) - top_left;
    Rectangle::new(top_left, Size::new(size.x as u32, size.y as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(x: i32, y: i32, width: u32, coverage: &[u8]) -> Ink {
        let size = Size::new(width, coverage.len() as u32 / width);
        Ink::new(Rectangle::new(Point::new(x, y), size), coverage.to_vec())
    }

    #[test]
    fn a_shared_column_is_the_sum_and_columns_before_it_are_left_out() {
        let both = ink(2, 0, 2, &[20, 30]).over(&ink(0, 0, 3, &[1, 2, 250, 4, 5, 6]));
        assert_eq!(both.area, Rectangle::new(Point::new(2, 0), Size::new(2, 2)));
        assert_eq!(both.coverage, [255, 30, 6, 0]);
    }

    #[test]
    fn glyphs_that_do_not_meet_stay_alone() {
        let alone = ink(3, 0, 1, &[9]).over(&ink(0, 0, 3, &[1, 2, 3]));
        assert_eq!(alone.coverage, [9]);
        assert_eq!(ink(3, 0, 1, &[9]).over(&Ink::default()).coverage, [9]);
    }
}
