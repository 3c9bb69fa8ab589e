//! Drawing bitmaps with the paper's implicit network.
//!
//! `cargo bench --features networks --bench networks`: networks of random numbers, which take as long as trained ones, as wide as at the lab's two
//! scales, and without the size among their inputs as in the published code. `draw` is all pixels of one box. What the size
//! gives to a network's layers is worked out for every box anew.

#![allow(clippy::unwrap_used)]

mod network;

use std::error::Error;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nfr::internals::network::{Architecture, Network};

/// Widths of trunk, latent vector and encoder.
const WIDTHS: [[u16; 3]; 3] = [[96, 32, 32], [784, 0, 0], [784, 1420, 300]];
/// Sizes whose boxes have 20 and 63 pixels.
const SIZES: [u16; 2] = [18, 61];

fn measure(criterion: &mut Criterion) -> Result<(), Box<dyn Error>> {
    for [width, latent, encoder] in WIDTHS {
        let architecture = Architecture { width, latent, encoder, frequencies: true, residual: true };
        let network =
            Network::new(network::network(architecture, &SIZES, 1)).map_err(|damage| damage.of(0))?;
        for (index, size) in network.sizes().iter().enumerate() {
            let name = format!("draw {} pixels, {width} wide, latent {latent}", u32::from(size.side).pow(2));
            criterion.bench_function(&name, |bencher| {
                bencher.iter(|| black_box(network.coverage(black_box(index))).map(drop));
            });
        }
    }
    Ok(())
}

fn benchmarks(criterion: &mut Criterion) {
    if let Err(error) = measure(criterion) {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

criterion_group! {
    name = networks;
    // Some take more than a second.
    config = Criterion::default().sample_size(10);
    targets = benchmarks
}
criterion_main!(networks);
