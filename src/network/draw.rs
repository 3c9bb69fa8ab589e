//! Drawing networks: the box of a size that a network was trained for, cut down to the glyph.

use super::eval::Network;
use super::layout::NetworkSize;
use crate::bitmap::Canvas;
use crate::error::Error;
use crate::limits::Budget;
use crate::options::{DrawOptions, Sampling};
use crate::placement::Placement;

impl Network {
    /// Where the bitmap lies.
    ///
    /// # Errors
    ///
    /// `NetworkSize` for a size that the network was not trained for, `NetworkOffset` for an offset that is not whole,
    /// `NetworkSubpixels` for subpixels.
    pub(crate) fn placement(&self, glyph: u32, options: DrawOptions) -> Result<Placement, Error> {
        if options.sampling != Sampling::PIXELS {
            return Err(Error::NetworkSubpixels(glyph));
        }
        let (_, size) = self.size(glyph, options.ppem)?;
        let offset = options.offset.map(|pixels| pixels as i32);
        if [0, 1].iter().any(|&axis| offset[axis] as f32 != options.offset[axis]) {
            return Err(Error::NetworkOffset { glyph, offset: options.offset });
        }
        let [left, top, width, height] = size.crop;
        if width == 0 || height == 0 {
            return Ok(Placement::default());
        }
        Ok(Placement {
            left: i32::from(left) - i32::from(size.origin[0]) + offset[0],
            top: i32::from(size.origin[1]) - i32::from(top) + offset[1],
            width: width.into(),
            height: height.into(),
        })
    }

    /// Draws the glyph into the canvas that `room` gives for its placement, if it gives one.
    pub(crate) fn draw<'b>(
        &self,
        glyph: u32,
        options: DrawOptions,
        budget: &mut Budget,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        let placement = self.placement(glyph, options)?;
        let (index, size) = self.size(glyph, options.ppem)?;
        let Some(canvas) = room(placement)? else { return Ok(None) };
        if placement.area() == 0 {
            return Ok(Some(placement));
        }
        budget.spend(self.work(size.side))?;
        let [left, top, width, height] = size.crop.map(usize::from);
        let coverage = self.coverage(index).unwrap_or_default();
        let rows = coverage.chunks_exact(size.side.into()).skip(top).take(height);
        for (out, row) in canvas.pixels.chunks_mut(canvas.pitch).zip(rows) {
            out[..width].copy_from_slice(&row[left..left + width]);
        }
        Ok(Some(placement))
    }

    /// The first size that equals `ppem`, rounded to a whole number with halves upwards, and its index.
    fn size(&self, glyph: u32, ppem: f32) -> Result<(usize, &NetworkSize), Error> {
        let whole = (ppem + 0.5) as usize;
        let found = self.sizes().iter().enumerate().find(|(_, size)| usize::from(size.ppem) == whole);
        found.ok_or(Error::NetworkSize { glyph, ppem })
    }
}
