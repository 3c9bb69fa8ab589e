//! Large bitmaps are drawn in strips of columns, so that working memory is bounded.

use super::scratch::Scratch;
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::placement::Placement;

/// A bitmap with more pixels than this is drawn in strips.
pub(super) const STRIP: usize = 1 << 20;

/// Some columns of a bitmap.
pub(super) struct Strip {
    /// The pixel in the upper left corner.
    pub(super) left: i32,
    #[cfg(feature = "fields")]
    pub(super) top: i32,
    /// Whether these are all columns.
    pub(super) is_whole: bool,
}

/// Draws in strips of columns, each of which has up to so many pixels, but one column at least.
pub(super) fn in_strips<const MOST: usize>(
    placement: Placement,
    scratch: &mut Scratch,
    canvas: &mut Canvas<'_>,
    mut add: impl FnMut(&Strip, &mut Scratch) -> Result<(), Error>,
) -> Result<(), Error> {
    let (width, height) = (placement.width as usize, placement.height as usize);
    if width == 0 || height == 0 {
        return Ok(());
    }
    let columns = (MOST / height).clamp(1, width);
    for column in (0..width).step_by(columns) {
        scratch.area.start(columns.min(width - column), height);
        let left = placement.left.saturating_add(column as i32);
        let strip = Strip {
            left,
            #[cfg(feature = "fields")]
            top: placement.top,
            is_whole: columns == width,
        };
        let added = add(&strip, scratch);
        // Also after an error, so that nothing is left for the next bitmap.
        scratch.area.finish(canvas.pitch, &mut canvas.pixels[column..]);
        added?;
    }
    Ok(())
}
