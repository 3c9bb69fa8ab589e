use super::*;
use crate::limits::Limits;
use crate::model::contour::{Polygons, Tracer};
use crate::model::grid::GridAxis;
use crate::model::gridfit::{AxisWarp, FIELD_STEPS, Weights};
use crate::model::sizes::Scale;

const SCALE: Scale = match Scale::new(1000, 8, 11) {
    Some(scale) => scale,
    None => unreachable!(),
};

/// A ring in a box of 600 × 700 units with its lower left corner at `corner`, the middle of which is hinted upwards,
/// with a deformation.
fn ring(corner: [i16; 2]) -> GridFit {
    let bounds = [corner[0], corner[1], corner[0] + 600, corner[1] + 700];
    let em = bounds.map(|units| f32::from(units) / 1000.0);
    let grid = [0, 1].map(|k| GridAxis::new(em[k], em[k + 2], 20));
    let centre = |axis: usize, k: usize| grid[axis].origin + (k as f32 - 0.5) / grid[axis].cells_per_em;
    let value = |x: f32, y: f32| {
        let far = ((x - (em[0] + em[2]) / 2.0) / 0.3).hypot((y - (em[1] + em[3]) / 2.0) / 0.35);
        (0.2 - (far - 0.8).abs()) * 0.3
    };
    let field = (0..22 * 22).map(|k| value(centre(0, k % 22), centre(1, k / 22)).clamp(-0.06, 0.06));
    let knots = vec![bounds[1], bounds[1] + 300, bounds[3]];
    let plain = |ppem: i32| knots.iter().map(move |k| i32::from(*k) * ppem * 32 / 1000);
    let hinted = (8..=11).flat_map(|ppem| plain(ppem).zip([0, 9, 3]).map(|(h, more)| h + more)).collect();
    let weights = Weights {
        bounds,
        cells: [20, 20],
        field: field.map(|d| (d * FIELD_STEPS).round() as i8).collect(),
        warp_y: AxisWarp { knots: knots.clone(), hinted },
        rank: 2,
        patterns: (0..128).map(|k| (k % 8 * 2) as i8).collect(),
        embedding: vec![4, 0, -7, 3, 0, 0, 5, 2],
        ..Weights::default()
    };
    GridFit::new(&weights, SCALE).unwrap()
}

type Placed<'a> = (&'a GridFit, [f32; 2]);

fn placement(models: &[Placed<'_>], ppem: f32) -> Placement {
    let placements =
        models.iter().map(|(model, origin)| model.placement_at(&SCALE.at(ppem), *origin).unwrap());
    placements.fold(Placement::default(), union)
}

fn drawn<const MOST: usize>(models: &[Placed<'_>], ppem: f32, place: Placement) -> Vec<u8> {
    let mut pixels = vec![99; place.area()];
    let mut canvas = Canvas::new(place, &mut pixels, place.width as usize).unwrap();
    let (mut scratch, mut budget) = (Scratch::default(), Budget::unlimited());
    draw_in_strips::<MOST>(
        &models.iter().copied(),
        &SCALE.at(ppem),
        [1; 2],
        place,
        &mut scratch,
        &mut canvas,
        &mut budget,
    )
    .unwrap();
    pixels
}

#[test]
fn strips_put_together_are_the_whole() {
    let (one, two) = (ring([-40, -200]), ring([300, 100]));
    let models = [(&one, [0.3, 0.7]), (&two, [-1.2, 0.1])];
    // Sizes whose outlines are kept, and one whose outline is traced each time.
    for ppem in [1.0, 9.0, 10.4, 30.0, 200.0] {
        let place = placement(&models, ppem);
        let whole = drawn::<STRIP>(&models, ppem, place);
        assert!(whole.contains(&255) || ppem < 9.0);
        assert_eq!(drawn::<1>(&models, ppem, place), whole, "{ppem} ppem, column by column");
        assert_eq!(drawn::<50>(&models, ppem, place), whole, "{ppem} ppem");
        assert_eq!(drawn::<2000>(&models, ppem, place), whole, "{ppem} ppem");
    }
}

#[test]
fn a_bitmap_that_needs_strips_is_the_sum_of_its_columns() {
    let model = ring([0, 0]);
    let place = placement(&[(&model, [0.0; 2])], 2000.0);
    assert!(place.area() > STRIP && place.area() < 2 * STRIP, "two strips");
    let two = drawn::<STRIP>(&[(&model, [0.0; 2])], 2000.0, place);
    assert!(two == drawn::<{ 2 * STRIP }>(&[(&model, [0.0; 2])], 2000.0, place));
}

#[test]
fn models_drawn_together_are_the_sum_of_each_alone() {
    let (one, two) = (ring([0, 0]), ring([350, 250]));
    for ppem in [8.0, 10.7, 40.0] {
        for origin in [[0.0, 0.0], [0.4, -0.3], [12.25, 3.0]] {
            let [first, second] = [(&one, [0.1, 0.2]), (&two, origin)];
            let place = placement(&[first, second], ppem);
            let [a, b] = [first, second].map(|model| drawn::<STRIP>(&[model], ppem, place));
            let both = drawn::<STRIP>(&[first, second], ppem, place);
            for ((a, b), both) in a.iter().zip(&b).zip(&both) {
                // Each of the three is rounded to whole levels.
                assert!(both.abs_diff(a.saturating_add(*b)) <= 1, "{both} for {a} and {b} at {ppem} ppem");
            }
            let own = placement(&[second], ppem);
            let alone = drawn::<STRIP>(&[second], ppem, own);
            let (left, up) = ((own.left - place.left) as usize, (place.top - own.top) as usize);
            let rows = b.chunks(place.width as usize).skip(up);
            for (row, alone) in rows.zip(alone.chunks(own.width as usize)) {
                assert_eq!(&row[left..][..alone.len()], alone, "in a larger bitmap as in its own");
            }
        }
    }
}

#[test]
fn a_model_moved_by_whole_pixels_is_drawn_the_same_elsewhere() {
    let model = ring([-100, 30]);
    let at = |origin: [f32; 2]| {
        let place = placement(&[(&model, origin)], 9.0);
        (place, drawn::<STRIP>(&[(&model, origin)], 9.0, place))
    };
    let (place, pixels) = at([0.25, -0.5]);
    let (moved, there) = at([7.25, -3.5]);
    assert_eq!(pixels, there);
    assert_eq!(moved, Placement { left: place.left + 7, top: place.top - 3, ..place });
}

#[test]
fn a_scratch_that_was_used_before_draws_the_same() {
    let models = [ring([0, 0]), ring([350, 250])];
    let mut scratch = Scratch::default();
    for (k, ppem) in [9.0, 300.0, 1.0, 10.0, 128.0, 8.0, 11.4].into_iter().enumerate() {
        let model = &models[k % 2];
        let place = model.placement(ppem).unwrap();
        let mut pixels = vec![99; place.area()];
        model.draw(ppem, place, &mut scratch, &mut pixels).unwrap();
        assert!(pixels == drawn::<STRIP>(&[(model, [0.0; 2])], ppem, place), "{ppem} ppem");
    }
}

#[test]
fn a_placement_that_does_not_hold_the_model_is_an_error() {
    let (model, mut scratch) = (ring([0, 0]), Scratch::default());
    let place = model.placement(30.0).unwrap();
    let mut pixels = vec![7; place.area()];
    for small in [
        Placement { width: place.width - 1, ..place },
        Placement { height: place.height - 1, ..place },
        Placement { left: place.left + 1, ..place },
        Placement { top: place.top - 1, ..place },
        Placement::default(),
    ] {
        let error = model.draw(30.0, small, &mut scratch, &mut pixels).unwrap_err();
        assert!(matches!(error, Error::BufferTooSmall { .. }), "{small:?}: {error}");
    }
    let error = model.draw(30.0, place, &mut scratch, &mut pixels[1..]).unwrap_err();
    assert!(matches!(error, Error::BufferTooSmall { .. }), "{error}");
    assert!(pixels.iter().all(|pixel| *pixel == 7), "nothing was drawn");
}

#[test]
fn a_drawing_that_exceeds_its_budget_leaves_nothing_in_the_scratch() {
    let (one, two) = (ring([0, 0]), ring([350, 250]));
    let models = [(&one, [0.0; 2]), (&two, [0.0; 2])];
    for ppem in [30.0, 1500.0] {
        let place = placement(&models, ppem);
        let mut pixels = vec![0; place.area()];
        let mut scratch = Scratch::default();
        // Enough for the first model and not for the second.
        let polygons =
            one.polygons(ppem, &mut Tracer::default(), &mut Polygons::default()).at[0].len() as u64;
        let sides = u64::from(place.width + place.height);
        let limits = Limits { work: polygons * sides * 3 / 2, ..Limits::default() };
        let mut canvas = Canvas::new(place, &mut pixels, place.width as usize).unwrap();
        let given_up = draw(
            &models.iter().copied(),
            &SCALE.at(ppem),
            [1; 2],
            place,
            &mut scratch,
            &mut canvas,
            &mut Budget::new(5, &limits),
        );
        assert!(matches!(given_up, Err(Error::TooMuchWork { glyph: 5, .. })), "{given_up:?}");
        let own = one.placement(ppem).unwrap();
        let mut pixels = vec![0; own.area()];
        one.draw(ppem, own, &mut scratch, &mut pixels).unwrap();
        assert!(pixels == drawn::<STRIP>(&[(&one, [0.0; 2])], ppem, own), "{ppem} ppem");
    }
}
