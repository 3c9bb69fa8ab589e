//! What drawing allocates, counted by a global allocator of this file's own.
#![allow(unsafe_code, reason = "a global allocator is unsafe to implement")]
#![allow(clippy::unwrap_used)]

mod samples;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use nfr::internals::model::gridfit::{AxisWarp, GridFit, Scale, Weights};
use nfr::internals::table::codec::{MAX_CELLS, MAX_RANK};
use nfr::{DrawOptions, Font, Limits, Rasterizer};
use proptest::prelude::*;

use samples::{bytes, font, table};

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
/// The subpixel offset for each size.
const OFFSETS: [[f32; 2]; 8] =
    [[0.0; 2], [0.25, 0.0], [0.5, 0.5], [0.75, -0.3], [-0.9, 0.0], [0.0, 0.1], [3.3, -7.2], [0.6, 0.0]];

/// Outlines, which black and white takes other ways for than fields.
#[test]
fn a_warm_loop_allocates_nothing() {
    for font in ["sans", "outline-mono"].map(font) {
        let mut rasterizer = Rasterizer::new(&font);
        let glyphs: Vec<u32> = font.modelled_glyphs().collect();
        let mut pixels = vec![0; 1 << 16];
        let mut draw_all = || {
            let before = ALLOCATIONS.get();
            for glyph in &glyphs {
                for (ppem, offset) in SIZES.into_iter().zip(OFFSETS) {
                    let options = DrawOptions::new(ppem).with_offset(offset);
                    rasterizer.placement(*glyph, options).unwrap();
                    rasterizer.draw(*glyph, options).unwrap();
                    rasterizer.draw_mono(*glyph, options).unwrap();
                    rasterizer.render_into(*glyph, options, &mut pixels, 256).unwrap();
                }
            }
            ALLOCATIONS.get() - before
        };
        assert!(draw_all() > 0, "the first round allocates: the counter does not count");
        assert_eq!(draw_all(), 0);
    }
}

/// What opening a font may take beside its bytes.
const OPENING: isize = 8_000;

#[test]
fn opening_takes_the_same_memory_for_any_number_of_glyphs() {
    for name in ["sans", "serif", "mono", "network"] {
        let data: &'static [u8] = bytes(name).leak();
        let before = LIVE.get();
        PEAK.set(before);
        let _font = Font::new(data).unwrap();
        let taken = PEAK.get() - before;
        assert!((1..=OPENING).contains(&taken), "{name}: {taken} bytes");
    }
}

/// What a rasterizer may take beside its cache: the slots and the field of the glyph that is decoded, the hash table,
/// and the working memory of a glyph of 100 pixels.
const BESIDE_THE_CACHE: isize = 400_000;

#[test]
fn a_cache_stays_within_its_limit() {
    let font = font("sans");
    let mut pixels = vec![0; 1 << 16];
    let all = || font.modelled_glyphs();
    let everything: usize = all().map(|glyph| nfr::internals::decode(&font, glyph).unwrap().memory()).sum();
    let mut taken = |limit: usize| {
        let before = LIVE.get();
        let mut rasterizer = Rasterizer::new(&font).with_cache(limit);
        for glyph in all().chain(all()) {
            rasterizer.render_into(glyph, 33.0, &mut pixels, 256).unwrap();
        }
        let taken = LIVE.get() - before;
        drop(rasterizer);
        taken
    };
    for limit in [0, everything / 10, everything / 2] {
        let taken = taken(limit);
        assert!(taken <= limit as isize + BESIDE_THE_CACHE, "{taken} bytes with a limit of {limit}");
    }
    // Composed glyphs share the models of their parts, which `everything` counts in each of them.
    assert!(taken(usize::MAX) >= everything as isize / 2, "the counter does not count");
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
    let scale = Scale::new(16, 1, 1024).unwrap();
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

/// Opens a font and decodes some of its glyphs; gives the memory that this took at most.
fn reading(data: &'static [u8], limits: Limits) -> isize {
    let before = LIVE.get();
    PEAK.set(before);
    if let Ok(font) = Font::new(data) {
        let mut decoder = nfr::internals::Decoder::new(&font, limits);
        // Not the glyphs' own order, so that damage to any part of the lists shows.
        for glyph in font.modelled_glyphs().step_by(5).chain(font.modelled_glyphs().skip(30)) {
            drop(decoder.glyph(glyph));
        }
    }
    PEAK.get() - before
}

/// What damage is done to: the header, the arrays behind it, the packed models, or anything in the table.
#[derive(Debug, Clone, Copy)]
enum Place {
    Header,
    Arrays,
    Anywhere,
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_font_does_not_make_the_reader_allocate_beyond_its_limits(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        place in prop_oneof![Just(Place::Header), Just(Place::Arrays), Just(Place::Anywhere)],
    ) {
        let mut data = bytes("sans");
        let range = table(&data, b"Nfrt");
        let range = match place {
            Place::Header => range.start..range.start + 52,
            Place::Arrays => range.start + 52..range.start + 320,
            Place::Anywhere => range,
        };
        for (at, value) in damage {
            data[range.start + at.index(range.len())] = value;
        }
        let taken = reading(data.leak(), Limits::default());
        prop_assert!(taken <= READING, "{taken} bytes");
    }
}

#[test]
fn the_largest_sizes_that_a_font_can_claim_stay_within_what_reading_may_take() {
    // 1024 sizes from 1 ppem on, of models with few: what is decoded means nothing, but it is much.
    let mut data = bytes("sans");
    let at = table(&data, b"Nfrt").start + 6;
    data[at..at + 4].copy_from_slice(&[0, 1, 4, 0]);
    let taken = reading(data.leak(), Limits::default());
    assert!((100_000..=READING).contains(&taken), "{taken} bytes");
}

#[test]
fn a_lower_limit_takes_less_memory() {
    let mut data = bytes("sans");
    let at = table(&data, b"Nfrt").start + 6;
    data[at..at + 4].copy_from_slice(&[0, 1, 4, 0]);
    let mut limits = Limits::default();
    limits.decoded_bytes = 10_000;
    let taken = reading(data.leak(), limits);
    assert!(taken < 100_000, "{taken} bytes");
}
