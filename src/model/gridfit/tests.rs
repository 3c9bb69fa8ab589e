use proptest::collection::vec;
use proptest::prelude::*;

use super::*;
use crate::model::grid::spline;
use crate::render::Scratch;

const SCALE: Scale = match Scale::new(1000, 8, 11) {
    Some(scale) => scale,
    None => unreachable!(),
};

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
    matches!(GridFit::new(&weights, SCALE), Err(Damage::Malformed(_)))
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
    let most = MAX_KNOTS as i16 + 1;
    assert!(malformed(
        |w| w.warp_x = AxisWarp { knots: (0..most).collect(), hinted: vec![0; 4 * most as usize] }
    ));
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
    model.draw(10.0, place, &mut Scratch::default(), &mut pixels).unwrap();
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
    model.draw(10.0, place, &mut Scratch::default(), &mut pixels).unwrap();
    let inked = pixels.iter().enumerate().filter(|(_, p)| **p > 5).map(|(k, _)| [k % 11, k / 11]);
    assert!(inked.clone().count() == 25 && inked.flatten().all(|k| (3..8).contains(&k)), "{pixels:?}");
}

#[test]
fn nothing_is_hinted_at_sizes_that_are_not_trained() {
    let model = GridFit::new(&square(), SCALE).unwrap();
    let far = |ppem: f32, grid: f32| {
        let hinted: Vec<f32> = model.hinted_knots(1, &SCALE.at(ppem)).collect();
        (hinted[1] - 0.5 * grid).abs()
    };
    // 500 units at 9 ppem are 4.5 pixels, hinted to 5; at 11 ppem 5.5, hinted to 6.
    for (ppem, whole) in [(8.5, 9.0), (9.0, 9.0), (9.4, 9.0), (10.5, 11.0), (11.0, 11.0), (11.4, 11.0)] {
        assert!((far(ppem, whole) - 0.5).abs() < 1e-5, "{ppem} is fitted as {whole}");
    }
    assert_eq!([7.4, 4.0, 11.5, 12.0, 40.0, 2000.0].map(|ppem| far(ppem, ppem)), [0.0; 6]);
}

#[test]
fn a_bitmap_beyond_the_limit_is_refused() {
    let weights = Weights { bounds: [-32000, 0, 32000, 500], ..square() };
    let model = GridFit::new(&weights, SCALE).unwrap();
    assert!(model.placement(100.0).is_ok());
    assert!(matches!(model.placement(2000.0), Err(Error::BitmapTooLarge { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn spline_weights_add_up_to_one(t in 0.0f32..=1.0) {
        prop_assert!((spline(t).iter().sum::<f32>() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn hinted_knots_ascend_whatever_is_stored(
        hinted in vec(-300i32..300, 2 * 4), ppem in 1.0f32..20.0,
    ) {
        let mut weights = square();
        weights.warp_y.hinted = hinted;
        let model = GridFit::new(&weights, SCALE).unwrap();
        let knots: Vec<f32> = model.hinted_knots(1, &SCALE.at(ppem)).collect();
        prop_assert!(knots[1] - knots[0] >= MIN_KNOT_GAP * 0.999, "{knots:?}");
    }
}
