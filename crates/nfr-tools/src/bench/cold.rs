//! Drawing with ours what has not been drawn before.
//!
//! - `nfr_new_size`: a `Rasterizer` that has decoded the glyph's model and drawn it at another size.
//! - `nfr_next`: a `Rasterizer` that has drawn other glyphs, so that its memory has grown, decodes the model and draws it.
//! - `nfr_cold`: a new `Rasterizer` of an open font does.
//! - `nfr_open`: a new `Rasterizer` of a new `Font` does. The file's bytes are shared and not copied.
//!
//! All draw with `Rasterizer::render_into` a buffer that is used again, as in `warm.rs`. What is made for a glyph is also
//! dropped in its time.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use nfr::{Font, Rasterizer};

use super::buffer::Buffer;
use super::round::Candidate;

/// Ours, drawing something for the first time.
pub(super) fn candidates(font: &Font, neural: Arc<[u8]>) -> [Candidate<'_>; 4] {
    [nfr_new_size(font), nfr_next(font), nfr_cold(font), nfr_open(font, neural)]
}

/// Times `pass`, which has a buffer for each of the glyphs at a size. Another rasterizer than the one that is timed makes
/// the buffer.
fn candidate<'a>(
    name: &'static str,
    about: &'static str,
    font: &'a Font,
    mut pass: impl FnMut(u16, &[u16], &mut Buffer) -> Result<Duration, Box<dyn Error>> + 'a,
) -> Candidate<'a> {
    let (mut last, mut buffer) = (None, Buffer::default());
    Candidate::new(name, about, move |ppem, gids| {
        if last != Some(ppem) {
            buffer = Buffer::new(&mut Rasterizer::new(font), &[ppem, next_to(ppem)], gids)?;
            last = Some(ppem);
        }
        pass(ppem, gids, &mut buffer)
    })
}

/// The size that is drawn before this one. It is larger, so that working memory has grown to what is needed.
fn next_to(ppem: u16) -> u16 {
    ppem + 1
}

fn timed(draw: impl FnOnce() -> Result<(), Box<dyn Error>>) -> Result<Duration, Box<dyn Error>> {
    let start = Instant::now();
    draw()?;
    Ok(start.elapsed())
}

/// Draws a glyph with ours.
fn draw(rasterizer: &mut Rasterizer, gid: u16, ppem: u16, buffer: &mut Buffer) -> Result<(), Box<dyn Error>> {
    black_box(buffer.draw(rasterizer, black_box(gid), f32::from(ppem))?);
    Ok(())
}

/// Each glyph is timed on its own, and reading the clock, some 20 nanoseconds, is part of its time.
fn nfr_new_size(font: &Font) -> Candidate<'_> {
    candidate("nfr_new_size", "model decoded; a size not drawn before", font, |ppem, gids, buffer| {
        let time = |gid: &u16| {
            // A new one each time, so that nothing can be left of this size.
            let mut rasterizer = Rasterizer::new(font);
            draw(&mut rasterizer, *gid, next_to(ppem), buffer)?;
            timed(|| draw(&mut rasterizer, *gid, ppem, buffer))
        };
        gids.iter().map(time).sum()
    })
}

fn nfr_next(font: &Font) -> Candidate<'_> {
    candidate("nfr_next", "model not decoded; other glyphs drawn before", font, |ppem, gids, buffer| {
        // Only the last decoded model is kept, so that each glyph of the pass has to be decoded.
        let mut rasterizer = Rasterizer::new(font).with_cache(0);
        if let Some(glyph) = other_than_first(font, gids) {
            rasterizer.draw(glyph, f32::from(ppem))?;
        }
        timed(|| gids.iter().try_for_each(|gid| draw(&mut rasterizer, *gid, ppem, buffer)))
    })
}

/// A glyph that is not the first of these, one of them if there are several. A font with a single model has none.
fn other_than_first(font: &Font, gids: &[u16]) -> Option<u32> {
    let (first, others) = gids.split_first()?;
    let mut glyphs = others.iter().copied().map(u32::from).chain(font.modelled_glyphs());
    glyphs.find(|glyph| *glyph != u32::from(*first))
}

fn nfr_cold(font: &Font) -> Candidate<'_> {
    candidate("nfr_cold", "model not decoded; a new rasterizer", font, |ppem, gids, buffer| {
        timed(|| gids.iter().try_for_each(|gid| draw(&mut Rasterizer::new(font), *gid, ppem, buffer)))
    })
}

fn nfr_open(font: &Font, neural: Arc<[u8]>) -> Candidate<'_> {
    candidate("nfr_open", "model not decoded; from the file's bytes", font, move |ppem, gids, buffer| {
        timed(|| {
            for &gid in gids {
                let font = Font::new(black_box(neural.clone()))?;
                draw(&mut Rasterizer::new(&font), gid, ppem, buffer)?;
            }
            Ok(())
        })
    })
}
