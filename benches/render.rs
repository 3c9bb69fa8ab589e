//! Drawing, decoding and placing glyphs.
//!
//! `cargo bench --bench render`: the models are first guesses without training, made when the benchmark starts. They
//! have the parts and sizes of trained ones: drawing takes the same time, decoding a sixth less. `NFR_BENCH_FONT` names
//! a converted font to measure instead. Each figure is for one pass over the glyphs of "agRe%@W8", so an eighth of it
//! is a glyph's. `draw` is a `Rasterizer` that has the models in its cache, box and all; `place` is that box alone;
//! `decode` goes from a glyph's bytes in the table to a model that is ready to draw; `open and draw one` from a file's bytes
//! to the pixels of one glyph.

mod font;

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nfr::{Font, Rasterizer};

use font::{glyphs, neural};

const SIZES: [f32; 4] = [12.0, 16.0, 24.0, 63.0];

fn measure(criterion: &mut Criterion) -> Result<(), Box<dyn Error>> {
    let data: &'static [u8] = neural()?.leak();
    let font = Font::new(data)?;
    let gids = glyphs(&font)?;
    let mut rasterizer = Rasterizer::new(&font);
    for gid in &gids {
        rasterizer.render(*gid, SIZES[0])?;
    }
    // Larger than any of these glyphs.
    let mut pixels = vec![0; 128 * 128];
    for ppem in SIZES {
        criterion.bench_function(&format!("draw at {ppem} ppem"), |bencher| {
            bencher.iter(|| {
                for gid in &gids {
                    black_box(rasterizer.render_into(black_box(*gid), ppem, &mut pixels, 128).ok());
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
    criterion.bench_function("open and draw one", |bencher| {
        bencher.iter(|| {
            let font = Font::new(black_box(data));
            font.and_then(|font| Rasterizer::new(&font).render_into(gids[0], 16.0, &mut pixels, 128)).ok()
        });
    });
    criterion.bench_function("decode", |bencher| {
        bencher.iter(|| {
            for gid in &gids {
                black_box(nfr::internals::decode(&font, black_box(*gid)).ok());
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
