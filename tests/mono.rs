//! Drawing in black and white: against a slow twin, and drop-out control on outlines made for it. crates/nfr-convert/tests/mono.rs
//! compares with FreeType.

use nfr::internals::HintedOutline;
use nfr::internals::table::Dropout;
use nfr::{DrawOptions, Error, Font, Limits, MissingModel, MonoBitmap, Rasterizer};
use proptest::prelude::*;

use crate::samples::{bytes, font, without_models};

/// A size at which positions between scan lines have 1/4096 pixel, and one at which they have 1/64.
const PPEM: [f32; 2] = [12.0, 24.0];
/// The twin leaves out centres that are so near to an edge, in 1/64 pixel: positions are rounded to 1/64 pixel at the coarser size.
const NEAR: f64 = 2.0;

/// An outline of polygons, in 1/64 pixel.
fn polygons(contours: &[&[[i32; 2]]]) -> HintedOutline {
    let mut outline = HintedOutline::default();
    for contour in contours {
        for [x, y] in *contour {
            outline.points[0].push(*x);
            outline.points[1].push(*y);
            outline.on_curve.push(true);
        }
        outline.ends.push(outline.on_curve.len());
    }
    outline
}

/// A box from its lower left to its upper right corner, up on its left side as outer contours go.
fn rectangle([left, bottom]: [i32; 2], [right, top]: [i32; 2]) -> [[i32; 2]; 4] {
    [[left, bottom], [left, top], [right, top], [right, bottom]]
}

/// Whether the centre of a pixel is inside, by the winding number; none if it is near to an edge.
fn is_inside(outline: &HintedOutline, centre: [f64; 2]) -> Option<bool> {
    let (mut winding, mut start) = (0, 0);
    for &end in &outline.ends {
        for k in start..end {
            let next = if k + 1 < end { k + 1 } else { start };
            let [a, b] =
                [k, next].map(|k| [0, 1].map(|axis| f64::from(outline.points[axis][k]) - centre[axis]));
            let [along, length] = [
                -(a[0] * (b[0] - a[0]) + a[1] * (b[1] - a[1])),
                (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2),
            ];
            let t = if length > 0.0 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
            if (a[0] + t * (b[0] - a[0])).hypot(a[1] + t * (b[1] - a[1])) <= NEAR {
                return None;
            }
            if (a[1] < 0.0) != (b[1] < 0.0) && a[0] - a[1] * (b[0] - a[0]) / (b[1] - a[1]) > 0.0 {
                winding += if b[1] > a[1] { 1 } else { -1 };
            }
        }
        start = end;
    }
    Some(winding != 0)
}

fn contours() -> impl Strategy<Value = Vec<Vec<[i32; 2]>>> {
    let point = [-200i32..700, -200i32..700];
    prop::collection::vec(prop::collection::vec(point, 3..9), 1..4)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn without_drop_out_control_the_pixels_are_those_whose_centres_are_inside(
        contours in contours(), ppem in prop::sample::select(PPEM.to_vec()),
    ) {
        let contours: Vec<&[[i32; 2]]> = contours.iter().map(Vec::as_slice).collect();
        let outline = polygons(&contours);
        let drawn = outline.black_and_white(ppem, Dropout::default()).unwrap();
        let place = drawn.placement;
        for (column, row) in (0..place.width).flat_map(|x| (0..place.height).map(move |y| (x, y))) {
            let pixel = [place.left + column as i32, place.top - 1 - row as i32];
            if let Some(inside) = is_inside(&outline, pixel.map(|v| f64::from(64 * v + 32))) {
                prop_assert_eq!(drawn.is_black(column, row), inside, "{:?} of {:?}", pixel, outline);
            }
        }
    }

    #[test]
    fn drop_out_control_only_adds_pixels(
        contours in contours(), ppem in prop::sample::select(PPEM.to_vec()), smart: bool,
    ) {
        let contours: Vec<&[[i32; 2]]> = contours.iter().map(Vec::as_slice).collect();
        let outline = polygons(&contours);
        let drawn = |mode| outline.black_and_white(ppem, mode).unwrap();
        let modes = [Dropout::default(), Dropout::new(smart, false), Dropout::new(smart, true)];
        let [none, some, all] = modes.map(drawn);
        prop_assert!(none.placement == some.placement && some.placement == all.placement);
        for ((none, some), all) in none.bits.iter().zip(&some.bits).zip(&all.bits) {
            prop_assert_eq!(none & !some, 0);
            prop_assert_eq!(none & !all, 0);
        }
    }
}

/// The rows of a bitmap as text.
fn rows(bitmap: &MonoBitmap) -> Vec<String> {
    let pixel = |x, y| if bitmap.is_black(x, y) { '#' } else { '.' };
    let row = |y| (0..bitmap.placement.width).map(|x| pixel(x, y)).collect();
    (0..bitmap.placement.height).map(row).collect()
}

/// A thin stroke between two centres, on a bar that widens the box.
fn stem() -> [[[i32; 2]; 4]; 2] {
    [rectangle([0, 0], [256, 64]), rectangle([141, 32], [153, 256])]
}

#[test]
fn a_thin_stroke_is_lost_or_filled_to_its_end_as_the_mode_says() {
    let [bar, stem] = stem();
    for (mode, expected) in [
        (Dropout::default(), ["....", "....", "....", "####"]),
        (Dropout::new(false, false), ["....", ".#..", ".#..", "####"]),
        (Dropout::new(false, true), [".#..", ".#..", ".#..", "####"]),
        // The centre that is closer to the middle of the stroke.
        (Dropout::new(true, false), ["....", "..#.", "..#.", "####"]),
        (Dropout::new(true, true), ["..#.", "..#.", "..#.", "####"]),
    ] {
        for ppem in PPEM {
            let drawn = polygons(&[&bar, &stem]).black_and_white(ppem, mode).unwrap();
            assert_eq!(rows(&drawn), expected, "{mode:?} at {ppem} ppem");
        }
    }
}

#[test]
fn a_thin_stroke_that_lies_is_filled_too() {
    let [bar, stem] = stem().map(|contour| contour.map(|[x, y]| [y, x]));
    for (mode, expected) in [
        (Dropout::default(), ["#...", "#...", "#...", "#..."]),
        (Dropout::new(false, true), ["#...", "#...", "####", "#..."]),
        (Dropout::new(true, true), ["#...", "####", "#...", "#..."]),
        (Dropout::new(true, false), ["#...", "###.", "#...", "#..."]),
    ] {
        let drawn = polygons(&[&bar, &stem]).black_and_white(12.0, mode).unwrap();
        assert_eq!(rows(&drawn), expected, "{mode:?}");
    }
}

#[test]
fn the_end_of_a_stroke_is_no_stub_if_it_is_half_a_pixel_wide_and_reaches_half_a_pixel_farther() {
    let bar = rectangle([0, 0], [256, 64]);
    for ([left, right, top], end) in [
        ([106, 148, 256], ".#.."),
        ([106, 148, 255], "...."),
        ([110, 141, 256], "...."),
        ([109, 141, 256], ".#.."),
    ] {
        let stem = rectangle([left, 32], [right, top]);
        let drawn = polygons(&[&bar, &stem]).black_and_white(12.0, Dropout::new(false, false)).unwrap();
        assert_eq!(rows(&drawn)[0], end, "{left} to {right}, {top} high");
    }
}

#[test]
fn a_gap_beside_a_pixel_that_is_set_stays() {
    let [bar, stem] = stem();
    let block = rectangle([160, 64], [256, 256]);
    let drawn = polygons(&[&bar, &stem, &block]).black_and_white(12.0, Dropout::new(false, true)).unwrap();
    assert_eq!(rows(&drawn), ["..##", "..##", "..##", "####"]);
}

#[test]
fn a_speck_has_the_pixel_that_holds_it_if_a_line_of_centres_crosses_it() {
    for (corner, pixel, row) in [
        ([141, 93], [2, 1], "#"),
        ([-35, -90], [-1, -2], "#"),
        ([93, 93], [1, 1], "#"),
        ([141, 70], [2, 1], "."),
    ] {
        let speck = rectangle(corner, corner.map(|v| v + 6));
        let drawn = polygons(&[&speck]).black_and_white(12.0, Dropout::new(true, true)).unwrap();
        let place = drawn.placement;
        assert_eq!([place.left, place.top - 1], pixel, "{corner:?}");
        assert_eq!((place.width, place.height, rows(&drawn)), (1, 1, vec![row.to_owned()]), "{corner:?}");
    }
}

#[test]
fn the_box_holds_the_pixels_whose_centres_the_outline_reaches_and_one_at_least() {
    for ([low, high], [first, end]) in [
        ([32, 96], [0, 2]),
        ([33, 95], [1, 1]),
        ([-32, 33], [-1, 1]),
        // Between two centres it is the pixel that holds more of the outline, and the upper one of two with as much.
        ([59, 68], [0, 1]),
        ([60, 68], [1, 2]),
        ([60, 69], [1, 2]),
    ] {
        let drawn = polygons(&[&rectangle([low, 0], [high, 640])]).black_and_white(12.0, Dropout::default());
        let place = drawn.unwrap().placement;
        let end = end.max(first + 1);
        assert_eq!([place.left, place.left + place.width as i32], [first, end], "{low} to {high} along x");
        let drawn = polygons(&[&rectangle([0, low], [640, high])]).black_and_white(12.0, Dropout::default());
        let place = drawn.unwrap().placement;
        assert_eq!([place.top - place.height as i32, place.top], [first, end], "{low} to {high} along y");
    }
}

#[test]
fn an_outline_without_points_has_no_bitmap() {
    let empty = HintedOutline::default().black_and_white(12.0, Dropout::new(true, true));
    assert_eq!(empty, Ok(MonoBitmap::default()));
}

#[test]
fn whole_pixels_move_the_placement_alone_and_halves_the_bits() {
    for name in ["outline", "outline-mono"] {
        let font = font(name);
        let glyph = font.glyph_for_char('g').unwrap();
        let mut rasterizer = Rasterizer::new(&font);
        let mut drawn =
            |offset| rasterizer.render_mono(glyph, DrawOptions::new(13.0).with_offset(offset)).unwrap();
        let (here, far, half) = (drawn([0.0, 0.0]), drawn([-3.0, 700.0]), drawn([0.5, 0.0]));
        assert_eq!(far.bits, here.bits, "{name}");
        assert_eq!(
            [far.placement.left, far.placement.top],
            [here.placement.left - 3, here.placement.top + 700]
        );
        assert_ne!(half.bits, here.bits, "{name}");
    }
}

#[test]
fn a_glyph_that_is_kept_is_drawn_as_a_new_one_is() {
    let font = font("outline-mono");
    let mut kept = Rasterizer::new(&font);
    for (ppem, character) in
        [12.0, 30.0, 12.0, 9.0].into_iter().flat_map(|ppem| "gé%i".chars().map(move |c| (ppem, c)))
    {
        let Some(glyph) = font.glyph_for_char(character) else { continue };
        let drawn = kept.render_mono(glyph, ppem).unwrap();
        assert_eq!(drawn, Rasterizer::new(&font).render_mono(glyph, ppem).unwrap(), "{character} at {ppem}");
        kept.draw(glyph, ppem).unwrap();
    }
}

#[test]
fn what_cannot_be_drawn_is_the_error_that_grey_drawing_gives() {
    let font = font("outline-mono");
    let g = font.glyph_for_char('g').unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    assert_eq!(rasterizer.draw_mono(g, 0.0), Err(Error::InvalidSize(0.0)));
    let far = DrawOptions::new(16.0).with_offset([1024.5, 0.0]);
    assert_eq!(rasterizer.draw_mono(g, far), Err(Error::InvalidOffset(1024.5)));
    assert_eq!(rasterizer.draw_mono(99_999, 16.0), Err(Error::NoSuchGlyph(99_999)));
    let mut limits = Limits::default();
    limits.bitmap_side = 10;
    let drawn = Rasterizer::new(&font).with_limits(limits).render_mono(g, 16.0);
    assert!(matches!(drawn, Err(Error::BitmapTooLarge { limit: 10, .. })), "{drawn:?}");
    let mut limits = Limits::default();
    limits.work = 200;
    let drawn = Rasterizer::new(&font).with_limits(limits).render_mono(g, 16.0);
    assert!(matches!(drawn, Err(Error::TooMuchWork { limit: 200, .. })), "{drawn:?}");
}

#[test]
fn a_glyph_without_a_model_is_an_error_or_blank_or_its_plain_outline() {
    let bare = Font::new(without_models(&bytes("outline-mono"))).unwrap();
    let g = bare.glyph_for_char('g').unwrap();
    assert_eq!(Rasterizer::new(&bare).render_mono(g, 16.0), Err(Error::MissingModel(g)));
    let mut blank = Rasterizer::new(&bare).with_missing_model(MissingModel::Blank);
    assert_eq!(blank.render_mono(g, 16.0), Ok(MonoBitmap::default()));
    assert_eq!(blank.render_mono(g, -1.0), Err(Error::InvalidSize(-1.0)));
    let mut plain = Rasterizer::new(&bare).with_missing_model(MissingModel::Outline);
    let mut hinted = Rasterizer::new(&font("outline-mono"));
    let unhinted = DrawOptions::new(16.0).with_hinting(false);
    let drawn = plain.render_mono(g, 16.0).unwrap();
    assert_eq!(drawn, hinted.render_mono(g, unhinted).unwrap());
    assert_ne!(drawn, hinted.render_mono(g, 16.0).unwrap());
}

#[cfg(feature = "fields")]
#[test]
fn a_field_is_black_from_half_coverage_on() {
    let font = font("mono");
    let mut rasterizer = Rasterizer::new(&font);
    for (character, ppem) in "gé%".chars().flat_map(|c| [9.0, 16.4, 70.0].map(|ppem| (c, ppem))) {
        let Some(glyph) = font.glyph_for_char(character) else { continue };
        let grey = rasterizer.render(glyph, ppem).unwrap();
        let drawn = rasterizer.render_mono(glyph, ppem).unwrap();
        assert_eq!(drawn.placement, grey.placement);
        for (y, row) in (0..).zip(grey.rows()) {
            for (x, level) in (0..).zip(row) {
                assert_eq!(drawn.is_black(x, y), *level >= 128, "{character} at {ppem}: {x}, {y}");
            }
        }
    }
}

#[test]
fn points_that_are_far_away_or_too_many_are_errors() {
    let modes = [Dropout::default(), Dropout::new(true, true)];
    for far in [i32::MAX, i32::MIN, 1 << 24, 8193 * 64] {
        let outline = polygons(&[&[[0, 0], [far, 9], [7, far]]]);
        for (mode, ppem) in modes.into_iter().flat_map(|mode| PPEM.map(|ppem| (mode, ppem))) {
            let drawn = outline.black_and_white(ppem, mode);
            assert!(matches!(drawn, Err(Error::BitmapTooLarge { .. })), "{far}: {drawn:?}");
        }
    }
    // All sides cross all rows, or all of them cross one.
    let tall: Vec<[i32; 2]> = (0..65_535).map(|k| [k * 8, k % 2 * 8192 * 64]).collect();
    let low: Vec<[i32; 2]> = (0..65_535).map(|k| [k * 8, k % 2 * 64]).collect();
    for zigzag in [tall, low] {
        let drawn = polygons(&[&zigzag]).black_and_white(12.0, Dropout::new(true, true));
        assert!(matches!(drawn, Err(Error::TooMuchWork { .. })));
    }
}

#[test]
fn the_largest_bitmap_is_drawn_with_curves_of_its_size() {
    let side = 8192 * 64;
    for ppem in PPEM {
        let mut outline = polygons(&[&[[0, 0], [0, side], [side, side], [side, 0]]]);
        outline.on_curve = vec![false; 4];
        let drawn = outline.black_and_white(ppem, Dropout::new(true, true)).unwrap();
        assert_eq!([drawn.placement.width, drawn.placement.height], [8192; 2]);
        let black: u32 = drawn.bits.iter().map(|byte| byte.count_ones()).sum();
        // Four parabolas between the middles of the sides cover 5/6 of the square.
        let share = f64::from(black) / 8192f64.powi(2);
        assert!((share - 5.0 / 6.0).abs() < 1e-3, "{share} at {ppem} ppem");
    }
}
