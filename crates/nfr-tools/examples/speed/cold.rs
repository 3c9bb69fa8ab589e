//! Drawing for the first time: at a size, or at all.
//!
//! The first glyph at a size that was not drawn before, the font open:
//!
//! - `nfr_cold`: a `Rasterizer` that has decoded the glyph's model and drawn it at the next size draws it at this one.
//! - `skrifa_cold`: a new `ScalerFont` of the open font, which runs `fpgm` and `prep`, and the glyph.
//! - `skrifa_reconfigured`: the same in the memory of a `ScalerFont` that was at the next size.
//! - `freetype_cold`: a face that has drawn the glyph at the next size. It runs `prep` again, but not `fpgm`.
//!
//! The first glyph of all:
//!
//! - `nfr_first`: a new `Rasterizer` of an open font decodes the model and draws it.
//! - `nfr_open`, `skrifa_open`: the same from the file's bytes, headers and all. The bytes are shared and not copied.
//!
//! Where something goes before what is timed, each glyph is timed on its own, and reading the clock, some 20
//! nanoseconds, is part of its time.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use nfr::{Font, Rasterizer};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::open::owned;
use skrifa::font::Blob;
use skrifa::{HintOptions, ScalerSource};

use super::buffer::Buffer;
use super::round::Candidate;
use super::skrifa_zeno::{SkrifaZeno, check, hint_options, hinted, outlines};
use super::warm::FreeType;

/// The candidates that draw at a size, or at all, for the first time.
pub(crate) fn candidates<'a>(
    pair: &'a FontPair<'a>,
    neural: Arc<[u8]>,
    original: Arc<[u8]>,
) -> Result<Vec<Candidate<'a>>, Box<dyn Error>> {
    let options = hint_options(pair.font().target())?;
    let outlines = outlines(owned(pair.original())?);
    let freetype = FreeType::new(&original, pair.font().target())?;
    Ok(vec![
        nfr_cold(pair.font()),
        skrifa_cold(outlines.clone(), options),
        skrifa_reconfigured(outlines, options),
        freetype_cold(freetype),
        nfr_first(pair.font()),
        nfr_open(neural),
        skrifa_open(original, options),
    ])
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

/// A buffer for each of these glyphs. Another rasterizer than the one that is timed makes it.
fn buffer(font: &Font, ppem: u16, gids: &[u16]) -> Result<Buffer, Box<dyn Error>> {
    Buffer::new(&mut Rasterizer::new(font), &[ppem, next_to(ppem)], gids)
}

/// Draws a glyph with ours.
fn draw(rasterizer: &mut Rasterizer, gid: u16, ppem: u16, buffer: &mut Buffer) -> Result<(), Box<dyn Error>> {
    black_box(buffer.draw(rasterizer, black_box(gid), f32::from(ppem))?);
    Ok(())
}

fn nfr_cold(font: &Font) -> Candidate<'_> {
    Candidate::new("nfr_cold", move |ppem, gids| {
        let mut buffer = buffer(font, ppem, gids)?;
        let time = |gid: &u16| {
            // A new one each time, so that nothing can be left of this size.
            let mut rasterizer = Rasterizer::new(font);
            draw(&mut rasterizer, *gid, next_to(ppem), &mut buffer)?;
            timed(|| draw(&mut rasterizer, *gid, ppem, &mut buffer))
        };
        gids.iter().map(time).sum()
    })
}

fn skrifa_cold<'a>(outlines: ScalerSource, options: HintOptions) -> Candidate<'a> {
    let mut renderer = SkrifaZeno::new();
    Candidate::new("skrifa_cold", move |ppem, gids| {
        timed(|| {
            for &gid in gids {
                let scaler = hinted(outlines.clone(), black_box(ppem), options)?;
                black_box(renderer.draw(&scaler, black_box(gid), 0.0)?);
            }
            Ok(())
        })
    })
}

fn skrifa_reconfigured<'a>(outlines: ScalerSource, options: HintOptions) -> Candidate<'a> {
    let mut renderer = SkrifaZeno::new();
    Candidate::new("skrifa_reconfigured", move |ppem, gids| {
        let mut scaler = hinted(outlines.clone(), next_to(ppem), options)?;
        let mut draw = |gid: u16, ppem: u16| -> Result<(), Box<dyn Error>> {
            scaler.reconfigure(outlines.clone(), f32::from(black_box(ppem)), options);
            check(&scaler)?;
            black_box(renderer.draw(&scaler, black_box(gid), 0.0)?);
            Ok(())
        };
        let time = |gid: &u16| {
            draw(*gid, next_to(ppem))?;
            timed(|| draw(*gid, ppem))
        };
        gids.iter().map(time).sum()
    })
}

fn freetype_cold<'a>(face: FreeType) -> Candidate<'a> {
    Candidate::new("freetype_cold", move |ppem, gids| {
        let draw = |gid: u16, ppem: u16| {
            face.set_size(black_box(ppem))?;
            face.draw(black_box(gid), &mut |pixels| {
                black_box(pixels);
            })
        };
        let time = |gid: &u16| {
            draw(*gid, next_to(ppem))?;
            timed(|| draw(*gid, ppem))
        };
        gids.iter().map(time).sum()
    })
}

fn nfr_first(font: &Font) -> Candidate<'_> {
    Candidate::new("nfr_first", move |ppem, gids| {
        let mut buffer = buffer(font, ppem, gids)?;
        timed(|| gids.iter().try_for_each(|gid| draw(&mut Rasterizer::new(font), *gid, ppem, &mut buffer)))
    })
}

fn nfr_open<'a>(neural: Arc<[u8]>) -> Candidate<'a> {
    Candidate::new("nfr_open", move |ppem, gids| {
        let mut buffer = buffer(&Font::new(neural.clone())?, ppem, gids)?;
        timed(|| {
            for &gid in gids {
                let font = Font::new(black_box(neural.clone()))?;
                draw(&mut Rasterizer::new(&font), gid, ppem, &mut buffer)?;
            }
            Ok(())
        })
    })
}

fn skrifa_open<'a>(original: Arc<[u8]>, options: HintOptions) -> Candidate<'a> {
    Candidate::new("skrifa_open", move |ppem, gids| {
        timed(|| {
            for &gid in gids {
                let data = Blob::Shared(Arc::new(black_box(original.clone())));
                let font = skrifa::Font::new(data, 0).ok_or("skrifa cannot read the original font")?;
                let scaler = hinted(outlines(font), ppem, options)?;
                black_box(SkrifaZeno::new().draw(&scaler, gid, 0.0)?);
            }
            Ok(())
        })
    })
}
