//! The buffer that a renderer draws into, and the coverage in it.

use std::error::Error;

use nfr::Rasterizer;

/// A glyph's coverage, 0–255, top row first.
pub(super) struct Coverage<'a> {
    pixels: &'a [u8],
    width: usize,
    /// The bytes between the beginnings of two rows.
    pitch: usize,
}

impl<'a> Coverage<'a> {
    /// Coverage with nothing between its rows.
    pub(super) fn packed(pixels: &'a [u8]) -> Self {
        Self { pixels, width: pixels.len(), pitch: pixels.len() }
    }

    /// Whether any pixel is covered.
    pub(super) fn has_ink(&self) -> bool {
        let mut rows = self.pixels.chunks(self.pitch.max(1));
        rows.any(|row| row.iter().take(self.width).any(|coverage| *coverage > 0))
    }
}

/// An application's buffer, which is used for one glyph after the other. It holds the largest, and its rows are as far
/// apart as the widest asks for.
#[derive(Default)]
pub(super) struct Buffer {
    pixels: Vec<u8>,
    pitch: usize,
}

impl Buffer {
    /// Makes room for each of these glyphs at each of these sizes.
    pub(super) fn new(
        rasterizer: &mut Rasterizer,
        sizes: &[u16],
        gids: &[u16],
    ) -> Result<Self, Box<dyn Error>> {
        let (mut width, mut height) = (0, 0);
        for (gid, ppem) in gids.iter().flat_map(|gid| sizes.iter().map(move |ppem| (*gid, *ppem))) {
            let place = rasterizer.placement(gid.into(), f32::from(ppem))?;
            (width, height) = (width.max(place.width as usize), height.max(place.height as usize));
        }
        Ok(Self { pixels: vec![0; width * height], pitch: width })
    }

    /// Draws a glyph with ours.
    pub(super) fn draw(
        &mut self,
        rasterizer: &mut Rasterizer,
        gid: u16,
        ppem: f32,
    ) -> Result<Coverage<'_>, nfr::Error> {
        let place = rasterizer.render_into(gid.into(), ppem, &mut self.pixels, self.pitch)?;
        let pixels = &self.pixels[..place.height as usize * self.pitch];
        Ok(Coverage { pixels, width: place.width as usize, pitch: self.pitch })
    }
}
