//! What drawing allocates, counted by a global allocator of this file's own.
#![allow(unsafe_code, reason = "a global allocator is unsafe to implement")]
#![allow(clippy::unwrap_used)]

mod samples;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use nfr::internals::model::gridfit::{AxisWarp, GridFit, Scale, Weights};
use nfr::internals::model::network::{Network, Shape};
use nfr::internals::table::Precision;
use nfr::internals::table::codec::{MAX_CELLS, MAX_RANK};
use nfr::internals::table::network::{decode, encode};
use nfr::{Font, Rasterizer, Scratch, Setting};
use proptest::prelude::*;

use samples::{ascii, converted, font, network};

/// Counts what each thread allocates on its own, so that tests beside each other do not disturb each other.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
    static LIVE: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

fn count(change: isize) {
    if change > 0 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
    }
    LIVE.set(LIVE.get() + change);
    PEAK.set(PEAK.get().max(LIVE.get()));
}

// SAFETY: every call is handed on to the system's allocator unchanged. The counters need no allocation: they are
// initialised in place and have no destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller's promise is the one that the system's allocator asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as above.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Small and large ones in turn; from 128 on, outlines are traced anew each time.
const SIZES: [f32; 8] = [8.0, 100.0, 12.5, 200.0, 20.0, 64.0, 130.5, 33.0];
/// Where the pen is, for each size.
const PENS: [[f32; 2]; 8] =
    [[0.0; 2], [0.25, 0.0], [0.5, 0.5], [0.75, -0.3], [-0.9, 0.0], [0.0, 0.1], [3.3, -7.2], [0.6, 0.0]];

#[test]
fn a_warm_loop_allocates_nothing() {
    let data = converted(&font("LiberationSans-Regular"), &(ascii() + "áèô"), 0).font;
    let font = Font::parse(&data).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let glyphs: Vec<_> = font.modelled_glyphs().map(|gid| (gid, font.glyph(gid).unwrap())).collect();
    let mut scratch = Scratch::default();
    let mut pixels = vec![0; 1 << 16];
    let mut draw_all = || {
        let before = ALLOCATIONS.get();
        for (gid, glyph) in &glyphs {
            for (ppem, pen) in SIZES.into_iter().zip(PENS) {
                let setting = Setting { pen, ..Setting::from(ppem) };
                rasterizer.placement(*gid, setting).unwrap();
                rasterizer.render_into(*gid, setting, &mut pixels).unwrap();
                glyph.render_into(setting, &mut scratch, &mut pixels).unwrap();
            }
        }
        ALLOCATIONS.get() - before
    };
    assert!(draw_all() > 0, "the first round allocates: the counter does not count");
    assert_eq!(draw_all(), 0);
}

/// What a rasterizer may take beside its cache: the odds and the field of the glyph that is decoded, the hash table,
/// and the working memory of a glyph of 100 pixels.
const BESIDE_THE_CACHE: isize = 400_000;

#[test]
fn a_cache_stays_within_its_limit() {
    let data = converted(&font("LiberationSans-Regular"), &ascii(), 0).font;
    let font = Font::parse(&data).unwrap();
    let mut pixels = vec![0; 1 << 16];
    let everything: usize = font.modelled_glyphs().map(|gid| font.glyph(gid).unwrap().memory()).sum();
    let mut taken = |limit: usize| {
        let before = LIVE.get();
        let mut rasterizer = Rasterizer::with_cache(&font, limit);
        for gid in font.modelled_glyphs().chain(font.modelled_glyphs()) {
            rasterizer.render_into(gid, 33.0, &mut pixels).unwrap();
        }
        let taken = LIVE.get() - before;
        drop(rasterizer);
        taken
    };
    for limit in [0, everything / 10, everything / 2] {
        let taken = taken(limit);
        assert!(taken <= limit as isize + BESIDE_THE_CACHE, "{taken} bytes with a limit of {limit}");
    }
    assert!(taken(usize::MAX) >= everything as isize, "the counter does not count");
}

/// What reading a table with its models may take, however damaged it is: the largest model has 65,536 hinted
/// positions of 4 bytes, in a vector for each axis and once more as floating-point numbers; and if its field is
/// inside in every second cell, an outline of some 17,000 vertices of 74 bytes at each of three tolerances, in vectors
/// that may be longer, for which 0.7 MB are taken while it is traced.
const READING: isize = 6 << 20;

/// A model as large as a table can hold one, whose field has the sign that `inside` says.
fn largest(scale: Scale, inside: impl Fn(usize, usize) -> bool) -> Weights {
    let (cells, rank) = (MAX_CELLS, usize::from(MAX_RANK));
    let stride = usize::from(cells) + 2;
    let value = |k: usize| if inside(k % stride, k / stride) { 127 } else { -127 };
    let knots: Vec<i16> = (-16..16).map(|k| k * 2000).collect();
    let warp = AxisWarp { hinted: vec![0; knots.len() * scale.sizes()], knots };
    Weights {
        bounds: [-32000, -32000, 32000, 32000],
        cells: [cells; 2],
        field: (0..stride * stride).map(value).collect(),
        warp_x: warp.clone(),
        warp_y: warp,
        rank: MAX_RANK,
        patterns: vec![1; rank * 64],
        embedding: vec![1; rank * scale.sizes()],
    }
}

#[test]
fn the_largest_models_stay_within_what_reading_may_take() {
    let scale = Scale { units_per_em: 16, first_ppem: 1, last_ppem: 1024 };
    for (name, weights) in [
        ("rows", largest(scale, |_, row| row % 2 == 0)),
        ("squares", largest(scale, |column, row| (column + row) % 2 == 0)),
        ("dots", largest(scale, |column, row| column % 2 == 0 && row % 2 == 0)),
        ("noise", largest(scale, |column, row| (column * column + 3 * row * row * column) % 7 < 3)),
    ] {
        let before = LIVE.get();
        PEAK.set(before);
        let _model = GridFit::new(&weights, scale).unwrap();
        let peak = PEAK.get() - before;
        assert!(peak <= READING, "{name}: {peak} bytes");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_font_does_not_make_the_reader_allocate_beyond_its_limits(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        thread_local! {
            static FONT: Vec<u8> = converted(&font("LiberationSans-Regular"), "aij.", 0).font;
        }
        let mut data = FONT.with(Clone::clone);
        // Tables are in the order of their tags: `Nfrt` comes first, after the directory.
        let part = data.len().min(6000);
        for (at, value) in damage {
            data[at.index(part)] = value;
        }
        let before = LIVE.get();
        PEAK.set(before);
        if let Ok(font) = Font::parse(&data) {
            for gid in font.modelled_glyphs().take(8) {
                let _ = font.glyph(gid);
            }
        }
        prop_assert!(PEAK.get() - before <= READING, "{} bytes", PEAK.get() - before);
    }

    #[test]
    fn a_damaged_network_does_not_make_the_reader_allocate_more_than_its_bytes_are_worth(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4), narrow in any::<bool>(),
    ) {
        let (width, latent) = if narrow { (1, 1) } else { (40, 7) };
        let shape = Shape { width, latent, encoder: 9, frequencies: true, residual: true };
        let mut bytes = encode(&network(shape, &[8, 12], 3), Precision::Eight).unwrap();
        for (at, value) in damage {
            // Within the shape and the sizes.
            bytes[at.index(31)] = value;
        }
        let before = LIVE.get();
        PEAK.set(before);
        if let Ok(weights) = decode(&bytes) {
            let _network = Network::new(weights).unwrap();
        }
        // A weight's byte becomes four, and those of one output are filled up to those of four.
        let limit = (20 * bytes.len() + 10_000) as isize;
        prop_assert!(PEAK.get() - before <= limit, "{} bytes of {limit}", PEAK.get() - before);
    }
}
