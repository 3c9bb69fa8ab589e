//! The steps from a glyph's bytes to its pixels, each by itself.
//!
//! `cargo bench --bench kernels`: of the same font and glyphs as the benchmark `render`, and each figure for all of
//! them. `unpack` decodes the stored integers; `trace` builds the model, which traces its outline; `placement`
//! finds the box at a size; `fill` hints the outline and fills it, from 128 pixels per em on after tracing it again.

mod font;

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nfr::Font;
use nfr::internals::model::gridfit::{GridFit, Weights};
use nfr::internals::{Scratch, scale, table};

use font::{glyphs, neural};

const SIZES: [f32; 4] = [12.0, 24.0, 63.0, 200.0];

fn measure(criterion: &mut Criterion) -> Result<(), Box<dyn Error>> {
    let font = Font::new(neural()?)?;
    let (table, scale) = (table(&font)?, scale(&font));
    let gids = glyphs(&font)?;
    let unpack = |glyph: &u32| table.weights(*glyph, scale, usize::MAX);
    let weights = gids.iter().map(unpack).collect::<Result<Vec<Weights>, _>>()?;
    let model = |weights: &Weights| GridFit::new(weights, scale).map_err(|damage| damage.of(0));
    let models = weights.iter().map(model).collect::<Result<Vec<GridFit>, _>>()?;
    criterion.bench_function("unpack", |bencher| {
        bencher.iter(|| gids.iter().for_each(|gid| drop(black_box(unpack(gid)))));
    });
    criterion.bench_function("trace", |bencher| {
        bencher.iter(|| weights.iter().for_each(|weights| drop(black_box(GridFit::new(weights, scale)))));
    });
    let mut scratch = Scratch::default();
    let mut pixels = vec![0; 1 << 18];
    for ppem in SIZES {
        criterion.bench_function(&format!("placement at {ppem} ppem"), |bencher| {
            bencher.iter(|| models.iter().all(|model| black_box(model.placement(ppem)).is_ok()));
        });
        let placements = models.iter().map(|model| model.placement(ppem)).collect::<Result<Vec<_>, _>>()?;
        criterion.bench_function(&format!("fill at {ppem} ppem"), |bencher| {
            bencher.iter(|| {
                for (model, placement) in models.iter().zip(&placements) {
                    black_box(model.draw(ppem, *placement, &mut scratch, &mut pixels[..placement.area()]))
                        .ok();
                }
            });
        });
    }
    Ok(())
}

fn benchmarks(criterion: &mut Criterion) {
    if let Err(error) = measure(criterion) {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

criterion_group!(kernels, benchmarks);
criterion_main!(kernels);
