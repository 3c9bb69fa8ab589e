use super::*;
use crate::number::mul_fixed;

#[test]
fn tracks_are_coded_from_the_ends_to_the_middles_of_gaps() {
    let order: Vec<u8> = coding_order(9).iter().map(|(track, _)| *track).collect();
    assert_eq!(order, [0, 8, 4, 2, 6, 1, 3, 5, 7]);
    for count in (0..40).chain([250]) {
        let mut coded = vec![false; count.into()];
        for (track, Neighbours { lower, upper }) in coding_order(count) {
            // The nearest tracks that are coded already, as section 7.5 of the specification names them.
            assert_eq!(lower, (0..track).rev().find(|at| coded[usize::from(*at)]), "{track} of {count}");
            assert_eq!(upper, (track + 1..count).find(|at| coded[usize::from(*at)]), "{track} of {count}");
            coded[usize::from(track)] = true;
        }
        assert!(coded.iter().all(|is| *is));
    }
}

/// The positions that all rules give.
fn positions(rules: &Rules<3>) -> [i32; LANES] {
    let mut positions = rules.lanes.iter().flat_map(|lanes| lanes.to_array());
    core::array::from_fn(|_| positions.next().expect("a lane"))
}

/// The rules of the third and of the fourth of four tracks at 13 pixels per em of 1000 units: a stem 82 units wide between two edges that are known.
#[test]
fn an_edge_of_a_stem_is_on_whole_pixels_or_as_far_from_them_as_the_stem_is_wide() {
    let levels = [0, 332, 414, 729];
    let factor = crate::model::outline::scale_of(13.0, 1000);
    let plain = levels.map(|level| mul_fixed(level.into(), factor));
    assert_eq!(plain, [0, 276, 344, 607]);
    // The highest edge is hinted at 640, which leads the stem's edges to 291 and 363, and the upper one to 384.
    let mut view = View {
        levels: &levels,
        plain: &plain,
        hinted: &[0, 0, 0, 640],
        before: None,
        scaling: Scaling { factor, rounds_down: true },
    };
    let between = Neighbours { lower: Some(0), upper: Some(3) };
    let lower = positions(&view.rules::<3>(1, between, None));
    // 82 units are 68.2 of 1/64 pixel, and 332 are 276.2.
    assert_eq!([lower[0], lower[1], lower[4], lower[5]], [320, 276, 384 - 69, 276]);
    let hinted = [0, 384 - 69, 0, 640];
    view.hinted = &hinted;
    let upper = positions(&view.rules::<3>(2, Neighbours { lower: Some(1), upper: Some(3) }, None));
    assert_eq!([upper[0], upper[5]], [384, 384]);
    // With the lower edge on whole pixels, the upper one is rounded down.
    let hinted = [0, 320, 0, 640];
    view.hinted = &hinted;
    let upper = positions(&view.rules::<3>(2, Neighbours { lower: Some(1), upper: Some(3) }, None));
    assert_eq!((upper[5], upper[9]), (320 + 68, 640 - 263));
    // So it is below one that is not on whole pixels.
    let hinted = [0, 320, 0, 642];
    view.hinted = &hinted;
    let upper = positions(&view.rules::<3>(2, Neighbours { lower: Some(1), upper: Some(3) }, None));
    assert_eq!(upper[9], 642 - 262);
    let hinted = [0, 320, 0, 640];
    view.hinted = &hinted;
    // Hints of TrueType round distances to the nearest.
    view.scaling.rounds_down = false;
    let upper = positions(&view.rules::<3>(2, Neighbours { lower: Some(1), upper: Some(3) }, None));
    assert_eq!([upper[1], upper[4], upper[5], upper[9]], [344, 320 + 64, 320 + 68, 640 - 263]);
}
