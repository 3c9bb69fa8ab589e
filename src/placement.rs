//! Where a bitmap lies.

/// Where a bitmap lies relative to the glyph's origin, in pixels (FreeType's `bitmap_left` and `bitmap_top`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Placement {
    /// From the origin to the left edge of the left column.
    pub left: i32,
    /// From the baseline up to the top edge of the top row.
    pub top: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Placement {
    /// The number of pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The same in pixels that are so many times narrower and lower.
    #[cfg(feature = "fields")]
    pub(crate) fn stretched(self, by: [i32; 2]) -> Self {
        let [x, y] = by.map(i32::unsigned_abs);
        Self {
            left: self.left.saturating_mul(by[0]),
            top: self.top.saturating_mul(by[1]),
            width: self.width.saturating_mul(x),
            height: self.height.saturating_mul(y),
        }
    }
}

/// The box around two bitmaps; one without pixels takes no room.
pub fn union(a: Placement, b: Placement) -> Placement {
    match (a.area(), b.area()) {
        (0, _) => return b,
        (_, 0) => return a,
        _ => {}
    }
    let right = |p: Placement| i64::from(p.left) + i64::from(p.width);
    let bottom = |p: Placement| i64::from(p.top) - i64::from(p.height);
    let (left, top) = (a.left.min(b.left), a.top.max(b.top));
    let length = |length: i64| u32::try_from(length).unwrap_or(u32::MAX);
    Placement {
        left,
        top,
        width: length(right(a).max(right(b)) - i64::from(left)),
        height: length(i64::from(top) - bottom(a).min(bottom(b))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_union_holds_both_boxes_and_ignores_empty_ones() {
        let a = Placement { left: -1, top: 2, width: 2, height: 2 };
        let b = Placement { left: 0, top: 3, width: 2, height: 2 };
        let empty = Placement { left: 50, top: 50, ..Placement::default() };
        assert_eq!(union(a, b), Placement { left: -1, top: 3, width: 3, height: 3 });
        assert_eq!((union(a, empty), union(empty, b)), (a, b));
    }
}
