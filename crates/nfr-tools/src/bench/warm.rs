//! `nfr`: the models are decoded, and the size has been drawn before. `Rasterizer::render_into` a buffer that is used
//! again; finding the box is part of that call.

use std::error::Error;

use nfr::{Font, Rasterizer};

use super::buffer::{Buffer, Coverage};
use super::renderer::{Renderer, warm};
use super::round::Candidate;

/// Ours, with all models decoded.
pub(super) fn nfr(font: &Font) -> Candidate<'static> {
    let rasterizer = Rasterizer::new(font);
    warm("nfr", "models decoded", Nfr { rasterizer, ppem: 0.0, buffer: Buffer::default() })
}

struct Nfr {
    rasterizer: Rasterizer,
    ppem: f32,
    buffer: Buffer,
}

impl Renderer for Nfr {
    fn set_size(&mut self, ppem: u16, gids: &[u16]) -> Result<(), Box<dyn Error>> {
        self.ppem = ppem.into();
        self.buffer = Buffer::new(&mut self.rasterizer, &[ppem], gids)?;
        Ok(())
    }

    fn draw(&mut self, gids: &[u16], mut show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>> {
        for &gid in gids {
            show(self.buffer.draw(&mut self.rasterizer, gid, self.ppem)?);
        }
        Ok(())
    }
}
