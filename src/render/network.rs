//! Drawing networks: the box of a size that a network was trained for, cut down to the glyph.

use super::{Placement, Setting};
use crate::error::Error;
use crate::model::network::{Network, NetworkSize};

impl Network {
    /// Where the bitmap lies.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a size that the network was not trained for, or a pen between pixels.
    pub(super) fn placement(&self, setting: Setting) -> Result<Placement, Error> {
        let (_, size) = self.size(setting.ppem)?;
        let pen = setting.pen.map(|at| at as i32);
        if [0, 1].iter().any(|&axis| pen[axis] as f32 != setting.pen[axis]) {
            return Err(Error::Unsupported(format!(
                "a pen at {}, {} pixels for a glyph that a network draws, which knows whole pixels only; round the pen",
                setting.pen[0], setting.pen[1]
            )));
        }
        let [left, top, width, height] = size.crop;
        if width == 0 || height == 0 {
            return Ok(Placement::default());
        }
        Ok(Placement {
            left: i32::from(left) - i32::from(size.origin[0]) + pen[0],
            top: i32::from(size.origin[1]) - i32::from(top) + pen[1],
            width: width.into(),
            height: height.into(),
        })
    }

    /// Draws the glyph. `pixels` has as many bytes as its placement says.
    pub(super) fn draw(&self, ppem: f32, pixels: &mut [u8]) -> Result<(), Error> {
        let (index, size) = self.size(ppem)?;
        let [left, top, width, _] = size.crop.map(usize::from);
        if pixels.is_empty() {
            return Ok(());
        }
        let levels = self.levels(index)?;
        let rows = levels.chunks_exact(size.side.into()).skip(top);
        for (out, row) in pixels.chunks_exact_mut(width).zip(rows) {
            out.copy_from_slice(&row[left..left + width]);
        }
        Ok(())
    }

    /// The first size that the nearest whole one to `ppem` is, halves upwards, and its number.
    fn size(&self, ppem: f32) -> Result<(usize, &NetworkSize), Error> {
        let whole = (ppem + 0.5) as usize;
        let found = self.sizes().iter().enumerate().find(|(_, size)| usize::from(size.ppem) == whole);
        found.ok_or_else(|| {
            let mut trained: Vec<u16> = self.sizes().iter().map(|size| size.ppem).collect();
            trained.sort_unstable();
            trained.dedup();
            let trained: Vec<String> = trained.iter().map(u16::to_string).collect();
            Error::Unsupported(format!(
                "{ppem} ppem for a glyph whose network was trained for {} ppem; use one of these",
                trained.join(", ")
            ))
        })
    }
}
