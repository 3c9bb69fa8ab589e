//! Drawing converted fonts: buffers, sizes, errors, caches and threads.
#![allow(clippy::unwrap_used)]

mod samples;

use std::sync::LazyLock;

use nfr::{Bitmap, Error, Font, MAX_PEN, Placement, Rasterizer, Scratch, Setting, Target};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::teacher::Teacher;
use read_fonts::FontRef;

use samples::{converted, font, gid};

/// Glyphs with round, straight, slanted and separate parts, and a blank one.
const TEXT: &str = "agRiw%. ";
/// Enough for the deformation to take part.
const STEPS: usize = 40;

static ORIGINAL: LazyLock<Vec<u8>> = LazyLock::new(|| font("LiberationSans-Regular"));
static CONVERTED: LazyLock<Vec<u8>> = LazyLock::new(|| converted(&ORIGINAL, TEXT, STEPS).font);

fn neural() -> Font<'static> {
    Font::parse(&CONVERTED).unwrap()
}

fn letters() -> impl Iterator<Item = u16> {
    TEXT.chars().map(|c| gid(&ORIGINAL, c))
}

/// Whole and fractional sizes, within the trained range and beyond it.
const PPEM: [f32; 14] = [0.5, 3.0, 7.5, 8.0, 10.9, 11.0, 15.5, 16.0, 31.9, 32.0, 50.25, 64.0, 68.0, 256.0];

#[test]
fn all_ways_of_drawing_agree() {
    let font = neural();
    let (mut rasterizer, mut scratch) = (Rasterizer::new(&font), Scratch::default());
    for gid in letters() {
        let glyph = font.glyph(gid).unwrap();
        for ppem in PPEM {
            let bitmap = glyph.render(ppem).unwrap();
            assert_eq!(bitmap.placement, glyph.placement(ppem).unwrap());
            assert_eq!(bitmap.pixels.len(), bitmap.placement.area());
            assert_eq!(rasterizer.placement(gid, ppem), Ok(bitmap.placement));
            assert_eq!(rasterizer.render(gid, ppem).as_ref(), Ok(&bitmap));
            let mut pixels = vec![0; bitmap.placement.area()];
            assert_eq!(glyph.render_into(ppem, &mut scratch, &mut pixels), Ok(bitmap.placement));
            assert_eq!(pixels, bitmap.pixels, "glyph {gid} at {ppem} ppem");
        }
    }
}

#[test]
fn a_buffer_that_is_too_small_is_an_error_and_left_alone() {
    let font = neural();
    let mut rasterizer = Rasterizer::new(&font);
    let g = gid(&ORIGINAL, 'g');
    let area = rasterizer.placement(g, 20.0).unwrap().area();
    let mut pixels = vec![7; area - 1];
    let error = rasterizer.render_into(g, 20.0, &mut pixels).unwrap_err();
    assert!(matches!(error, Error::InvalidParameter(_)), "{error}");
    let glyph = font.glyph(g).unwrap();
    let error = glyph.render_into(20.0, &mut Scratch::default(), &mut pixels).unwrap_err();
    assert!(matches!(error, Error::InvalidParameter(_)), "{error}");
    assert!(pixels.iter().all(|p| *p == 7));
}

#[test]
fn bytes_beyond_the_bitmap_are_left_alone() {
    let font = neural();
    let mut rasterizer = Rasterizer::new(&font);
    for gid in letters() {
        let area = rasterizer.placement(gid, 20.0).unwrap().area();
        for before in [7, 201] {
            let mut pixels = vec![before; area + 100];
            rasterizer.render_into(gid, 20.0, &mut pixels).unwrap();
            assert!(pixels[area..].iter().all(|p| *p == before));
            assert_eq!(
                pixels[..area],
                rasterizer.render(gid, 20.0).unwrap().pixels,
                "old pixels shine through"
            );
        }
    }
}

#[test]
fn sizes_that_make_no_sense_are_errors() {
    let font = neural();
    let mut rasterizer = Rasterizer::new(&font);
    for ppem in [0.0, -0.0, -1.0, 2049.0, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        for gid in letters() {
            let error = rasterizer.render(gid, ppem).unwrap_err();
            assert!(matches!(error, Error::InvalidParameter(_)), "{ppem}: {error}");
            let error = font.glyph(gid).unwrap().placement(ppem).unwrap_err();
            assert!(matches!(error, Error::InvalidParameter(_)), "{ppem}: {error}");
        }
    }
    for ppem in [f32::MIN_POSITIVE, f32::from_bits(1), 1e-10, 0.01, 2048.0] {
        for gid in letters() {
            assert!(rasterizer.render(gid, ppem).is_ok(), "glyph {gid} at {ppem} ppem");
        }
    }
}

#[test]
fn a_glyph_that_the_font_does_not_have_is_missing() {
    let font = neural();
    let mut rasterizer = Rasterizer::new(&font);
    for gid in [font.glyph_count(), u16::MAX] {
        assert!(!font.has_model(gid));
        assert_eq!(rasterizer.render(gid, 16.0), Err(Error::MissingGlyph(gid)));
        assert_eq!(font.glyph(gid).err(), Some(Error::MissingGlyph(gid)));
        assert_eq!(font.model_len(gid), Err(Error::MissingGlyph(gid)));
        assert_eq!(font.advance(gid, 16.0), 0.0);
    }
}

#[test]
fn a_blank_glyph_is_an_empty_bitmap_with_an_advance() {
    let font = neural();
    let space = gid(&ORIGINAL, ' ');
    assert_eq!(font.glyph(space).unwrap().render(16.0), Ok(Bitmap::default()));
    assert!(font.advance(space, 16.0) > 3.0);
}

#[test]
fn the_font_tells_what_it_was_made_for() {
    let font = neural();
    assert_eq!(font.ppem_range(), (8, 64));
    assert_eq!(font.target(), Target::Smooth);
    assert!(font.outlines_match());
    assert_eq!(font.modelled_glyphs().collect::<Vec<_>>(), samples::gids(&ORIGINAL, TEXT));
    assert_eq!(font.glyph_for_char('g'), Some(gid(&ORIGINAL, 'g')));
    assert!(font.modelled_glyphs().all(|gid| font.model_len(gid).unwrap() > 0));
}

#[test]
fn a_font_without_models_is_unsupported_and_other_bytes_are_malformed() {
    assert!(matches!(Font::parse(&ORIGINAL), Err(Error::Unsupported(_))));
    assert!(matches!(Font::parse(b"not a font at all"), Err(Error::Malformed(_))));
    assert!(matches!(Font::parse(&[]), Err(Error::Malformed(_))));
    assert!(matches!(Font::from_index(&CONVERTED, 1), Err(Error::InvalidParameter(_))));
}

/// Full pixels that a bitmap's ink would fill.
fn ink(bitmap: &Bitmap) -> f32 {
    bitmap.pixels.iter().map(|p| f32::from(*p)).sum::<f32>() / 255.0
}

/// A fractional size may have this much less or more ink than the whole ones around it, as a share: it has the rows
/// of the nearer one and columns of its own, and stems of the other may be a pixel thicker.
const BETWEEN: f32 = 0.05;

#[test]
fn a_fractional_size_lies_between_the_whole_ones() {
    let font = neural();
    for gid in letters() {
        let glyph = font.glyph(gid).unwrap();
        for ppem in (8u8..64).map(f32::from) {
            let [low, between, high] = [0.0, 0.5, 1.0].map(|more| glyph.render(ppem + more).unwrap());
            let (least, most) = (ink(&low).min(ink(&high)), ink(&low).max(ink(&high)));
            let found = ink(&between);
            assert!(
                found >= least * (1.0 - BETWEEN) && found <= most * (1.0 + BETWEEN),
                "glyph {gid} at {} ppem: {found} is not in {least}..{most}",
                ppem + 0.5
            );
            let edges = |b: &Bitmap| {
                let p = b.placement;
                [p.left, p.top, p.left + p.width as i32, p.top - p.height as i32]
            };
            for ((low, between), high) in edges(&low).into_iter().zip(edges(&between)).zip(edges(&high)) {
                assert!((low.min(high)..=low.max(high)).contains(&between), "glyph {gid} at {ppem}½ ppem");
            }
        }
    }
}

/// Pixels that are neither empty nor full, as a share of those of the box.
fn grey(bitmap: &Bitmap) -> f32 {
    let grey = bitmap.pixels.iter().filter(|level| (32..224).contains(*level)).count();
    grey as f32 / bitmap.pixels.len() as f32
}

/// A fractional size may have this much more grey than the nearest whole one: its columns lie elsewhere.
/// Mixing the moves of two sizes would make 0.02 more (spec/experiments.md).
const GREYER: f32 = 0.01;

#[test]
fn a_fractional_size_is_as_crisp_in_y() {
    // Horizontal edges that hinting puts between two rows must not become soft at 12.3 or 12.7 ppem.
    let font = neural();
    let sizes = (9u8..=24).map(f32::from);
    let mean = |more: f32| {
        let sharpness = sizes.clone().flat_map(|ppem| letters().map(move |gid| (gid, ppem)));
        let all: Vec<f32> = sharpness
            .filter(|(gid, _)| *gid != samples::gid(&ORIGINAL, ' '))
            .map(|(gid, ppem)| grey(&font.glyph(gid).unwrap().render(ppem + more).unwrap()))
            .collect();
        all.iter().sum::<f32>() / all.len() as f32
    };
    let trained = mean(0.0);
    for more in [-0.3, 0.3, 0.45] {
        eprintln!("{more}: {} for {trained}", mean(more));
        assert!(mean(more) <= trained + GREYER, "{more}: {} for {trained}", mean(more));
    }
}

#[test]
fn a_small_step_in_size_is_a_small_step_in_pixels() {
    // A trained size is what the sizes around it tend to: nothing jumps there but the box.
    let font = neural();
    for gid in letters() {
        let glyph = font.glyph(gid).unwrap();
        for ppem in [8.0, 9.0, 20.0, 40.0, 63.0, 64.0] {
            let at = glyph.render(ppem).unwrap();
            for near in [ppem * (1.0 - 1e-4), ppem * (1.0 + 1e-4)] {
                let mae = Sums::of(&at, &glyph.render(near).unwrap()).mae();
                assert!(mae < 0.002, "glyph {gid} at {near} ppem: {mae}");
            }
        }
    }
}

/// Bounds of the mean absolute error against the plain outline where nothing is hinted, by size. Training fits the
/// field to hinted bitmaps and rounds it, which moves edges by a fixed share of the em: 1.4 % of a large box after
/// these few steps. Of boxes of one or two pixels every pixel is an edge.
const PLAIN_SHAPE_MAE: [(f32, f64); 8] = [
    (2.0, 0.08),
    (5.0, 0.025),
    (7.0, 0.02),
    (65.0, 0.025),
    (72.0, 0.025),
    (96.0, 0.025),
    (128.0, 0.025),
    (256.0, 0.025),
];

#[test]
fn beyond_the_trained_sizes_the_plain_shape_is_drawn() {
    let font = neural();
    let teacher = Teacher::new(&FontRef::new(&ORIGINAL).unwrap(), Target::Smooth).unwrap();
    for (ppem, bound) in PLAIN_SHAPE_MAE {
        let mut sums = Sums::default();
        for gid in letters() {
            let plain = teacher.unhinted(gid, ppem).unwrap().rasterize();
            sums.add(&plain, &font.glyph(gid).unwrap().render(ppem).unwrap());
        }
        assert!(sums.mae() <= bound, "{ppem} ppem: {}", sums.mae());
    }
}

#[test]
fn a_cache_of_any_size_draws_the_same() {
    let font = neural();
    let draw = |bytes: usize| {
        let mut rasterizer = Rasterizer::with_cache(&font, bytes);
        let mut order: Vec<u16> = letters().collect();
        order.extend(order.clone().iter().rev());
        let sizes = order.into_iter().flat_map(|gid| [9.0, 33.0].map(|ppem| (gid, ppem)));
        sizes.map(|(gid, ppem)| rasterizer.render(gid, ppem).unwrap()).collect::<Vec<_>>()
    };
    let unlimited = draw(usize::MAX);
    for bytes in [0, 1, 10_000, 20_000, 50_000] {
        assert!(draw(bytes) == unlimited, "a cache of {bytes} bytes");
    }
}

#[test]
fn threads_draw_the_same() {
    let font = neural();
    let draw = |glyphs: &[nfr::Glyph]| {
        let pairs = glyphs.iter().flat_map(|glyph| PPEM.map(|ppem| (glyph, ppem)));
        pairs.map(|(glyph, ppem)| glyph.render(ppem).unwrap()).collect::<Vec<_>>()
    };
    let glyphs: Vec<_> = letters().map(|gid| font.glyph(gid).unwrap()).collect();
    let alone = draw(&glyphs);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| draw(&glyphs))).collect();
        for thread in threads {
            assert!(thread.join().unwrap() == alone);
        }
    });
}

fn set(ppem: f32, pen: [f32; 2]) -> Setting {
    Setting { pen, ..Setting::from(ppem) }
}

/// What a drawing with the pen between pixels may miss of the teacher's outline moved likewise, as a share of what one
/// with the pen on a pixel misses: edges are off by as much, and lie in other pixels. Measured: at most 1.03.
const PEN_SHARE: f64 = 1.06;

#[test]
fn a_glyph_between_pixels_is_the_hinted_outline_moved() {
    let font = neural();
    let teacher = Teacher::new(&FontRef::new(&ORIGINAL).unwrap(), Target::Smooth).unwrap();
    let mae = |pen: [f32; 2]| {
        let mut sums = Sums::default();
        for ppem in 9..=24u16 {
            let at = teacher.at(ppem).unwrap();
            for gid in letters() {
                let mut outline = at.hinted(gid).unwrap();
                outline.translate(pen);
                let drawn = font.glyph(gid).unwrap().render(set(ppem.into(), pen)).unwrap();
                sums.add(&outline.rasterize(), &drawn);
            }
        }
        sums.mae()
    };
    let whole = mae([0.0; 2]);
    for pen in [[0.25, 0.0], [0.5, 0.0], [0.75, 0.0], [0.0, 0.5], [-0.3, 0.2], [100.6, -70.9]] {
        assert!(mae(pen) <= PEN_SHARE * whole, "{pen:?}: {} for {whole}", mae(pen));
    }
}

#[test]
fn a_pen_on_another_pixel_moves_the_box_and_leaves_its_pixels() {
    let (accented, neural) = (accented(), neural());
    let accented = Font::parse(&accented).unwrap();
    for font in [&neural, &accented] {
        for gid in font.modelled_glyphs() {
            let glyph = font.glyph(gid).unwrap();
            for (ppem, pen) in
                [(9.0, [0.0; 2]), (12.3, [0.25, 0.5]), (50.0, [-0.125, 0.0]), (130.0, [0.5, 0.75])]
            {
                let here = glyph.render(set(ppem, pen)).unwrap();
                for [right, up] in [[1, 0], [-3, 7], [MAX_PEN as i32 - 1, 1 - MAX_PEN as i32]] {
                    let there = glyph.render(set(ppem, [pen[0] + right as f32, pen[1] + up as f32])).unwrap();
                    assert_eq!(there.pixels, here.pixels, "glyph {gid} at {ppem} ppem, {pen:?}");
                    let Placement { left, top, .. } = here.placement;
                    let blank = here.pixels.is_empty();
                    let moved = Placement { left: left + right, top: top + up, ..here.placement };
                    assert_eq!(there.placement, if blank { here.placement } else { moved });
                }
            }
        }
    }
}

/// A font with composed glyphs.
fn accented() -> Vec<u8> {
    let conversion = converted(&ORIGINAL, "aeouáàâéèêóòôúùû", 0);
    assert!(conversion.glyphs.iter().any(|glyph| glyph.composed));
    conversion.font
}

#[test]
fn a_composed_glyph_between_pixels_is_the_hinted_outline_moved() {
    let data = accented();
    let font = Font::parse(&data).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let teacher = Teacher::new(&FontRef::new(&ORIGINAL).unwrap(), Target::Smooth).unwrap();
    let mut mae = |pen: [f32; 2]| {
        let mut sums = Sums::default();
        for ppem in [9u16, 12, 16, 20, 24] {
            let at = teacher.at(ppem).unwrap();
            for gid in samples::gids(&ORIGINAL, "áàâéèêóòôúùû") {
                let mut outline = at.hinted(gid).unwrap();
                outline.translate(pen);
                let setting = set(ppem.into(), pen);
                let drawn = rasterizer.render(gid, setting).unwrap();
                assert_eq!(font.glyph(gid).unwrap().render(setting).as_ref(), Ok(&drawn));
                sums.add(&outline.rasterize(), &drawn);
            }
        }
        sums.mae()
    };
    let whole = mae([0.0; 2]);
    for pen in [[0.25, 0.0], [0.5, 0.0], [0.75, 0.0], [0.0, 0.5], [-0.3, 0.2]] {
        let moved = mae(pen);
        assert!(moved <= PEN_SHARE * whole, "{pen:?}: {moved} for {whole}");
    }
}

#[test]
fn pens_that_make_no_sense_are_errors() {
    let font = neural();
    let mut rasterizer = Rasterizer::new(&font);
    let far = MAX_PEN * (1.0 + f32::EPSILON);
    for gid in letters() {
        let glyph = font.glyph(gid).unwrap();
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, far, -far, f32::MAX] {
            for setting in [set(16.0, [bad, 0.0]), set(16.0, [0.0, bad])] {
                let errors = [
                    glyph.placement(setting).err(),
                    glyph.render(setting).err(),
                    glyph.render_into(setting, &mut Scratch::default(), &mut [0; 1000]).err(),
                    rasterizer.placement(gid, setting).err(),
                    rasterizer.render(gid, setting).err(),
                    rasterizer.render_into(gid, setting, &mut [0; 1000]).err(),
                ];
                let named = |error: &Option<Error>| matches!(error, Some(Error::InvalidParameter(_)));
                assert!(errors.iter().all(named), "{bad}: {errors:?}");
            }
        }
        for pen in [[MAX_PEN, -MAX_PEN], [-MAX_PEN, MAX_PEN], [f32::MIN_POSITIVE, -0.0]] {
            assert!(glyph.render(set(16.0, pen)).is_ok());
        }
    }
}
