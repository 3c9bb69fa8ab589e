//! Drawing, decoding and placing glyphs.
//!
//! `cargo bench --bench render`: the models are first guesses without training, made when the benchmark starts. They
//! have the parts and sizes of trained ones: drawing takes the same time, decoding a sixth less. `NFR_BENCH_FONT` names
//! a converted font to measure instead. Each figure is for one pass over the glyphs of "agRe%@W8", so an eighth of it
//! is a glyph's. `draw` is a `Rasterizer` that has the models in its cache, box and all; `place` is that box alone;
//! `decode` goes from a glyph's bytes in the table to a model that is ready to draw.

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nfr::convert::select::Selection;
use nfr::convert::{Options, Progress, Quality, convert};
use nfr::{Font, Rasterizer};
use read_fonts::FontRef;

const FONT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSans-Regular.ttf");
const TEXT: &str = "agRe%@W8";
const SIZES: [f32; 4] = [12.0, 16.0, 24.0, 63.0];

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// A neural font with the glyphs of `TEXT`.
fn neural() -> Result<Vec<u8>, Box<dyn Error>> {
    if let Some(path) = std::env::var_os("NFR_BENCH_FONT") {
        return Ok(std::fs::read(path)?);
    }
    let original = std::fs::read(FONT)?;
    let selection = Selection { text: Some(TEXT.into()), ..Selection::default() };
    let mut options =
        Options { gids: selection.resolve(&FontRef::new(&original)?, [])?, ..Options::default() }
            .with_quality(Quality::default());
    options.schedule.steps = 0;
    options.polish.rounds = 0;
    Ok(convert(&original, &options, &Silent)?.font)
}

/// The glyphs of `TEXT`, each of which must have a model.
fn glyphs(font: &Font<'_>) -> Result<Vec<u16>, Box<dyn Error>> {
    let gid = |c| font.glyph_for_char(c).filter(|gid| font.has_model(*gid));
    TEXT.chars().map(|c| gid(c).ok_or_else(|| format!("the font has no model of {c:?}").into())).collect()
}

fn measure(criterion: &mut Criterion) -> Result<(), Box<dyn Error>> {
    let data = neural()?;
    let font = Font::parse(&data)?;
    let gids = glyphs(&font)?;
    for gid in &gids {
        font.glyph(*gid)?.render(SIZES[0])?;
    }
    let mut rasterizer = Rasterizer::new(&font);
    // Larger than any of these glyphs.
    let mut pixels = vec![0; 128 * 128];
    for ppem in SIZES {
        criterion.bench_function(&format!("draw at {ppem} ppem"), |bencher| {
            bencher.iter(|| {
                for gid in &gids {
                    black_box(rasterizer.render_into(black_box(*gid), ppem, &mut pixels).ok());
                }
            });
        });
    }
    criterion.bench_function("place at 16 ppem", |bencher| {
        bencher.iter(|| {
            for gid in &gids {
                black_box(rasterizer.placement(black_box(*gid), 16.0).ok());
            }
        });
    });
    criterion.bench_function("decode", |bencher| {
        bencher.iter(|| {
            for gid in &gids {
                black_box(font.glyph(black_box(*gid)).ok());
            }
        });
    });
    Ok(())
}

fn benchmarks(criterion: &mut Criterion) {
    if let Err(error) = measure(criterion) {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

criterion_group!(render, benchmarks);
criterion_main!(render);
