//! Drawing for the first time: at a size, or at all.
//!
//! The first glyph at a size that was not drawn before, the font open:
//!
//! - `nfr_cold`: a `Rasterizer` that has decoded the glyph's model and drawn it at the next size draws it at this one.
//! - `skrifa_cold`: a new `HintingInstance`, which runs `fpgm` and `prep`, and the glyph.
//! - `skrifa_reconfigured`: the same in the memory of an instance that was at the next size.
//! - `freetype_cold`: a face that has drawn the glyph at the next size. It runs `prep` again, but not `fpgm`.
//!
//! The first glyph of all:
//!
//! - `nfr_first`: a new `Rasterizer` of an open font decodes the model and draws it.
//! - `nfr_open`, `skrifa_open`: the same from the file's bytes, headers and all.
//!
//! Where something goes before what is timed, each glyph is timed on its own, and reading the clock, some 20
//! nanoseconds, is part of its time.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use nfr::{Font, Rasterizer};
use nfr_convert::compare::fonts::FontPair;
use read_fonts::FontRef;
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::DrawSettings;

use super::round::Contestant;
use super::skrifa_zeno::{SkrifaZeno, hinting, hinting_options};
use super::warm::FreeType;

/// Those that draw at a size, or at all, for the first time.
pub(crate) fn contestants<'a>(
    pair: &'a FontPair<'a>,
    neural: &'a [u8],
    original: &'a [u8],
) -> Result<Vec<Contestant<'a>>, Box<dyn Error>> {
    Ok(vec![
        nfr_cold(pair.font()),
        skrifa_cold(pair),
        skrifa_reconfigured(pair),
        freetype_cold(FreeType::new(original, pair.font().target())?),
        nfr_first(pair.font()),
        nfr_open(neural),
        skrifa_open(pair, original),
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

/// A buffer that is large enough for each of these glyphs.
fn buffer(font: &Font<'_>, ppem: u16, gids: &[u16]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut rasterizer = Rasterizer::new(font);
    let areas = gids.iter().flat_map(|gid| [ppem, next_to(ppem)].map(|ppem| (*gid, f32::from(ppem))));
    let areas = areas.map(|(gid, ppem)| Ok(rasterizer.placement(gid, ppem)?.area()));
    Ok(vec![0; areas.collect::<Result<Vec<_>, nfr::Error>>()?.into_iter().max().unwrap_or(0)])
}

/// Draws a glyph with ours.
fn draw(
    rasterizer: &mut Rasterizer<'_>,
    gid: u16,
    ppem: u16,
    pixels: &mut [u8],
) -> Result<(), Box<dyn Error>> {
    let place = rasterizer.render_into(black_box(gid), f32::from(ppem), pixels)?;
    black_box(&pixels[..place.area()]);
    Ok(())
}

fn nfr_cold<'a>(font: &'a Font<'a>) -> Contestant<'a> {
    Contestant::new("nfr_cold", move |ppem, gids| {
        let mut pixels = buffer(font, ppem, gids)?;
        let time = |gid: &u16| {
            // A new one each time, so that nothing can be left of this size.
            let mut rasterizer = Rasterizer::new(font);
            draw(&mut rasterizer, *gid, next_to(ppem), &mut pixels)?;
            timed(|| draw(&mut rasterizer, *gid, ppem, &mut pixels))
        };
        gids.iter().map(time).sum()
    })
}

fn skrifa_cold<'a>(pair: &'a FontPair<'a>) -> Contestant<'a> {
    let (outlines, target) = (pair.original().outline_glyphs(), pair.font().target());
    let mut renderer = SkrifaZeno::new(outlines.clone());
    Contestant::new("skrifa_cold", move |ppem, gids| {
        timed(|| {
            for &gid in gids {
                let hinting = hinting(&outlines, black_box(ppem), target)?;
                black_box(renderer.draw(black_box(gid), DrawSettings::hinted(&hinting, false), 0.0)?);
            }
            Ok(())
        })
    })
}

fn skrifa_reconfigured<'a>(pair: &'a FontPair<'a>) -> Contestant<'a> {
    let (outlines, target) = (pair.original().outline_glyphs(), pair.font().target());
    let mut renderer = SkrifaZeno::new(outlines.clone());
    Contestant::new("skrifa_reconfigured", move |ppem, gids| {
        let mut hinting = hinting(&outlines, next_to(ppem), target)?;
        let mut draw = |gid: u16, ppem: u16| -> Result<(), Box<dyn Error>> {
            let size = Size::new(f32::from(black_box(ppem)));
            hinting.reconfigure(&outlines, size, LocationRef::default(), hinting_options(target))?;
            black_box(renderer.draw(black_box(gid), DrawSettings::hinted(&hinting, false), 0.0)?);
            Ok(())
        };
        let time = |gid: &u16| {
            draw(*gid, next_to(ppem))?;
            timed(|| draw(*gid, ppem))
        };
        gids.iter().map(time).sum()
    })
}

fn freetype_cold<'a>(face: FreeType) -> Contestant<'a> {
    Contestant::new("freetype_cold", move |ppem, gids| {
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

fn nfr_first<'a>(font: &'a Font<'a>) -> Contestant<'a> {
    Contestant::new("nfr_first", move |ppem, gids| {
        let mut pixels = buffer(font, ppem, gids)?;
        timed(|| gids.iter().try_for_each(|gid| draw(&mut Rasterizer::new(font), *gid, ppem, &mut pixels)))
    })
}

fn nfr_open(neural: &[u8]) -> Contestant<'_> {
    Contestant::new("nfr_open", move |ppem, gids| {
        let mut pixels = buffer(&Font::parse(neural)?, ppem, gids)?;
        timed(|| {
            for &gid in gids {
                let font = Font::parse(black_box(neural))?;
                draw(&mut Rasterizer::new(&font), gid, ppem, &mut pixels)?;
            }
            Ok(())
        })
    })
}

fn skrifa_open<'a>(pair: &'a FontPair<'a>, original: &'a [u8]) -> Contestant<'a> {
    let target = pair.font().target();
    Contestant::new("skrifa_open", move |ppem, gids| {
        timed(|| {
            for &gid in gids {
                let outlines = FontRef::new(black_box(original))?.outline_glyphs();
                let hinting = hinting(&outlines, ppem, target)?;
                let mut renderer = SkrifaZeno::new(outlines);
                black_box(renderer.draw(gid, DrawSettings::hinted(&hinting, false), 0.0)?);
            }
            Ok(())
        })
    })
}
