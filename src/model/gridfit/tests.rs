use proptest::collection::vec;
use proptest::prelude::*;

use super::*;

const SCALE: Scale = Scale { units_per_em: 1000, first_ppem: 8, last_ppem: 11 };

/// A square of half an em, its knots hinted to whole pixels.
fn square() -> Weights {
    let knots = vec![0i16, 500];
    let snapped = |units: i16, ppem: i32| (i32::from(units) * ppem + 500) / 1000 * WARP_STEPS as i32;
    let hinted = (8..=11).flat_map(|ppem| knots.iter().map(move |k| snapped(*k, ppem))).collect();
    let grid = GridAxis::new(0.0, 0.5, 14);
    let inside = |k: usize| {
        let at = grid.origin + (k as f32 - 0.5) / grid.cells_per_em;
        at.min(0.5 - at)
    };
    let coefficients =
        (0..16 * 16).map(|k| inside(k % 16).min(inside(k / 16)).clamp(-FIELD_LIMIT, FIELD_LIMIT));
    Weights {
        bounds: [0, 0, 500, 500],
        cells: [14, 14],
        field: coefficients.map(|d| (d * FIELD_STEPS).round() as i8).collect(),
        warp_y: AxisWarp { knots, hinted },
        ..Weights::default()
    }
}

fn malformed(change: impl FnOnce(&mut Weights)) -> bool {
    let mut weights = square();
    change(&mut weights);
    matches!(GridFit::new(&weights, SCALE), Err(Error::Malformed(_)))
}

#[test]
fn weights_that_contradict_each_other_are_malformed() {
    assert!(!malformed(|_| ()), "the unchanged weights are a model");
    assert!(!malformed(|w| *w = Weights::default()), "a blank glyph is a model");
    assert!(malformed(|w| w.cells = [14, 0]));
    assert!(malformed(|w| w.cells = [13, 14]));
    assert!(malformed(|w| w.field.push(0)));
    assert!(malformed(|w| w.warp_y = AxisWarp::default()), "ink needs a warp in y");
    assert!(malformed(|w| w.warp_y.knots = vec![500, 0]), "knots that descend");
    assert!(malformed(|w| w.warp_y.knots = vec![500, 500]), "knots that coincide");
    assert!(malformed(|w| w.warp_y.hinted.push(0)));
    assert!(malformed(|w| w.warp_x.knots.push(0)));
    assert!(malformed(|w| w.rank = 1));
    assert!(malformed(|w| w.patterns.push(0)));
    assert!(malformed(|w| w.embedding.push(0)));
    assert!(malformed(|w| w.bounds = [500, 0, 0, 500]));
    assert!(malformed(|w| w.bounds = [0, 500, 500, 0]));
}

#[test]
fn a_square_hinted_to_whole_pixels_is_drawn_with_whole_pixels() {
    let model = GridFit::new(&square(), SCALE).unwrap();
    let place = model.placement(10.0).unwrap();
    assert_eq!(place, Placement { left: 0, top: 5, width: 5, height: 5 });
    let mut pixels = vec![0; place.area()];
    model.draw(10.0, place, &mut Scratch::default(), &mut pixels);
    // The spline rounds the corners; edges and the inside are whole.
    for (k, pixel) in pixels.iter().enumerate() {
        let corner = [0, 4].contains(&(k % 5)) && [0, 4].contains(&(k / 5));
        assert!(*pixel >= if corner { 200 } else { 250 }, "pixel {k}: {pixel}");
    }
}

#[test]
fn a_larger_box_than_the_placement_is_drawn_the_same_with_empty_pixels_around() {
    let model = GridFit::new(&square(), SCALE).unwrap();
    let place = Placement { left: -3, top: 8, width: 11, height: 11 };
    let mut pixels = vec![255; place.area()];
    model.draw(10.0, place, &mut Scratch::default(), &mut pixels);
    let inked = pixels.iter().enumerate().filter(|(_, p)| **p > 5).map(|(k, _)| [k % 11, k / 11]);
    assert!(inked.clone().count() == 25 && inked.flatten().all(|k| (3..8).contains(&k)), "{pixels:?}");
}

#[test]
fn nothing_is_moved_beyond_the_trained_sizes() {
    let model = GridFit::new(&square(), SCALE).unwrap();
    let far = |ppem: f32, grid: f32| {
        let hinted: Vec<f32> = model.hinted_knots(1, ppem).collect();
        (hinted[1] - 0.5 * grid).abs()
    };
    // 500 units at 9 ppem are 4.5 pixels, hinted to 5; at 11 ppem 5.5, hinted to 6.
    for (ppem, whole) in [(8.5, 9.0), (9.0, 9.0), (9.4, 9.0), (10.5, 11.0), (11.0, 11.0), (11.4, 11.0)] {
        assert!((far(ppem, whole) - 0.5).abs() < 1e-5, "{ppem} is fitted as {whole}");
    }
    assert_eq!([7.4, 4.0, 11.5, 12.0, 40.0, 2000.0].map(|ppem| far(ppem, ppem)), [0.0; 6]);
}

#[test]
fn small_sizes_have_more_samples() {
    let samples: Vec<usize> = (1..100).map(|s| samples_per_pixel(s as f32)).collect();
    assert!(samples.is_sorted_by(|a, b| a >= b));
    assert!(samples[98] >= 1 && samples[98] < samples[0]);
}

#[test]
fn a_bitmap_beyond_the_limit_is_refused() {
    let weights = Weights { bounds: [-32000, 0, 32000, 500], ..square() };
    let model = GridFit::new(&weights, SCALE).unwrap();
    assert!(model.placement(100.0).is_ok());
    assert!(matches!(model.placement(2000.0), Err(Error::LimitExceeded(_))));
}

/// Points on a side of the pixel that the twin of `half_plane` counts.
const POINTS: i32 = 64;
/// An edge may run along a row of points: half of them count on either side.
const COUNTED: f32 = 0.5 / POINTS as f32 + 1e-3;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn half_plane_is_the_share_of_points_on_the_inner_side(
        value in -1.2f32..1.2, angle in 0.0f32..std::f32::consts::TAU, steepness in 0.05f32..3.0,
    ) {
        let (gx, gy) = (angle.cos() * steepness, angle.sin() * steepness);
        let value = value * steepness;
        let at = |k: i32| (k as f32 + 0.5) / POINTS as f32 - 0.5;
        let inside = (0..POINTS * POINTS).filter(|k| value + gx * at(k % POINTS) + gy * at(k / POINTS) > 0.0);
        let share = inside.count() as f32 / (POINTS * POINTS) as f32;
        // Gradients along an axis are tilted by `MIN_SKEW`, which an edge through the middle of a side shows.
        let bound = COUNTED + MIN_SKEW * 0.5;
        let coverage = half_plane(value, gx, gy);
        prop_assert!((coverage - share).abs() <= bound, "{coverage} for {share}");
        prop_assert!((half_plane(-value, gx, gy) - (1.0 - coverage)).abs() < 1e-6, "the outside is the rest");
    }

    #[test]
    fn half_plane_grows_with_the_field(a in -3.0f32..3.0, b in -3.0f32..3.0, gx in -3.0f32..3.0, gy in -3.0f32..3.0) {
        prop_assert!(half_plane(a.min(b), gx, gy) <= half_plane(a.max(b), gx, gy) + 1e-6);
        prop_assert!((0.0..=1.0).contains(&half_plane(a, gx, gy)));
    }

    #[test]
    fn spline_weights_add_up_to_one_and_their_slopes_to_nothing(t in 0.0f32..=1.0) {
        prop_assert!((spline(t).iter().sum::<f32>() - 1.0).abs() < 1e-6);
        prop_assert!(spline_slope(t).iter().sum::<f32>().abs() < 1e-6);
    }

    #[test]
    fn hinted_knots_ascend_whatever_is_stored(
        hinted in vec(-300i32..300, 2 * 4), ppem in 1.0f32..20.0,
    ) {
        let mut weights = square();
        weights.warp_y.hinted = hinted;
        let model = GridFit::new(&weights, SCALE).unwrap();
        let knots: Vec<f32> = model.hinted_knots(1, ppem).collect();
        prop_assert!(knots[1] - knots[0] >= MIN_KNOT_GAP * 0.999, "{knots:?}");
    }

    #[test]
    fn unwarping_inverts_the_warp(
        gaps in vec((0.01f32..0.3, MIN_KNOT_GAP..4.0), 1..12), start in (-0.5f32..0.5, -9.0f32..9.0), at in 0.0f32..1.0,
    ) {
        let mut knots = vec![start.0];
        let mut hinted = vec![start.1];
        for (plain, pixels) in gaps {
            knots.push(knots[knots.len() - 1] + plain);
            hinted.push(hinted[hinted.len() - 1] + pixels);
        }
        let within = at * (knots.len() - 1) as f32;
        let k = (within as usize).min(knots.len() - 2);
        let mix = |v: &[f32]| v[k] + (v[k + 1] - v[k]) * (within - k as f32);
        let found = unwarp_point(&knots, &hinted, 16.0, mix(&hinted));
        prop_assert!((found - mix(&knots)).abs() < 1e-3, "{found} for {}", mix(&knots));
        let last = knots.len() - 1;
        let beyond = [unwarp_point(&knots, &hinted, 16.0, hinted[0] - 1.6), unwarp_point(&knots, &hinted, 16.0, hinted[last] + 1.6)];
        prop_assert!((beyond[0] - (knots[0] - 0.1)).abs() < 1e-4 && (beyond[1] - (knots[last] + 0.1)).abs() < 1e-4);
    }
}
