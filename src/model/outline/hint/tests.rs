use super::*;
use crate::model::outline::OutlinePoints;
use crate::model::outline::weights::OutlineWeights;
use crate::model::sizes::Origin;

#[test]
fn a_size_is_rounded_to_64ths_of_a_pixel() {
    assert_eq!(scale_of(16.0, 1024), 0x10000);
    assert_eq!(scale_of(16.0 + 0.49 / 64.0, 1024), 0x10000);
    assert_eq!(scale_of(16.0 + 0.51 / 64.0, 1024), 1025 * 0x10000 / 1024);
    assert_eq!(scale_of(10.0, 1000), 41_943, "41943.04");
    assert_eq!(scale_of(9.0, 2048), 0x10000 * 9 / 32);
}

/// A stem of 100 units at x = 0 and 250 units above the baseline, its upper edge hinted at 10 and at 11 ppem, its last point
/// corrected at 11.
fn stem() -> OutlineModel {
    let scale = Scale::new(1000, 10, 11).unwrap();
    let points = OutlinePoints {
        coordinates: [vec![0, 0, 100, 100], vec![0, 250, 250, 0]],
        on_curve: vec![true; 4],
        ends: vec![4],
        is_unfit: false,
    };
    let y = AxisHints {
        is_hinted: true,
        levels: vec![0, 250],
        first_size: 0,
        track_of: vec![0, 1, 1, 0],
        moves: vec![0, 32, 0, 16],
        corrections: vec![Correction { size: 1, point: 3, by: -5 }],
        ..AxisHints::default()
    };
    let weights = OutlineWeights { axes: [AxisHints::default(), y], ..OutlineWeights::default() };
    OutlineModel::new(points, weights, scale, 0..2).unwrap()
}

fn hinted(model: &OutlineModel, ppem: f32) -> [Vec<i32>; 2] {
    let mut points = [vec![9; 7], Vec::new()];
    hint(model, &model.scale.at(ppem), &mut points);
    points.map(|axis| axis.into_iter().map(in_64ths).collect())
}

#[test]
fn tracks_and_corrections_move_points_at_their_size() {
    let model = stem();
    assert_eq!(hinted(&model, 10.0), [vec![0, 0, 64, 64], vec![0, 192, 192, 0]]);
    assert_eq!(hinted(&model, 11.0), [vec![0, 0, 70, 70], vec![0, 192, 192, -5]]);
}

#[test]
fn a_size_between_has_the_hints_of_the_nearest_and_its_own_width() {
    let model = stem();
    let [x, y] = hinted(&model, 10.75);
    assert_eq!(y, hinted(&model, 11.0)[1]);
    // Nothing hints x: 100 units at 10.75 ppem are 68.8/64 pixel.
    assert_eq!(x, [0, 0, 69, 69]);
}

#[test]
fn sizes_are_counted_from_the_first_that_is_decoded() {
    let mut model = stem();
    let expected = hinted(&model, 11.0);
    model.sizes = 1..2;
    model.weights.axes[1].first_size = 1;
    model.weights.axes[1].moves.drain(..2);
    assert_eq!(hinted(&model, 11.0), expected);
    // Points are where the scale puts them at a size that is not decoded.
    assert_eq!(hinted(&model, 10.0)[1], [0, 160, 160, 0]);
}

#[test]
fn a_size_that_was_not_trained_or_not_decoded_is_only_scaled() {
    let mut model = stem();
    assert_eq!(hinted(&model, 20.0)[1], [0, 320, 320, 0]);
    model.sizes = 0..1;
    model.weights.axes[1].moves.truncate(2);
    assert_eq!(hinted(&model, 11.0)[1], [0, 176, 176, 0]);
    assert_eq!(hinted(&model, 10.0)[1], [0, 192, 192, 0]);
}

#[test]
fn coordinates_of_postscript_outlines_are_rounded_down_where_nothing_is_hinted() {
    // 12 ppem of 1000 units: 0.768 of 1/64 pixel for a unit.
    let scale = scale_of(12.0, 1000);
    assert_eq!([100, 102, -100].map(|v| mul_fixed(v, scale)), [77, 78, -77]);
    assert_eq!([100, 102, -100].map(|v| rounded_down(v, scale)), [76, 78, -77]);
    let points = OutlinePoints {
        coordinates: [vec![0, 100, 100], vec![0, 0, 100]],
        on_curve: vec![true; 3],
        ends: vec![3],
        is_unfit: false,
    };
    for (origin, at) in [(Origin::TrueType, 77), (Origin::Cubic, 77), (Origin::PostScript, 76)] {
        let sizes = Scale::new(1000, 12, 12).unwrap().with_origin(origin);
        let model = OutlineModel::new(points.clone(), OutlineWeights::default(), sizes, 0..1).unwrap();
        let mut places = [Vec::new(), Vec::new()];
        hint(&model, &sizes.at(12.0), &mut places);
        assert_eq!(places, [vec![0, 4 * at, 4 * at], vec![0, 0, 4 * at]]);
        // Nothing is hinted at other sizes.
        hint(&model, &sizes.at(24.0), &mut places);
        assert_eq!(places[0][1], 4 * 154);
    }
}
