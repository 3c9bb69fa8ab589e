//! Where the points of `glyf` are among those of the path that skrifa draws: a path begins with a point on the curve and has
//! implied points, which lie half-way between two control points.

use std::iter::once;
use std::ops::Range;

/// For each point, its index among the points of the path; none for a point of a contour that is not drawn. `count` is the number
/// of points in the path. None if the path is not that of these contours.
pub(crate) fn places(
    on_curve: &[bool],
    contours: &[Range<usize>],
    count: usize,
) -> Option<Vec<Option<usize>>> {
    [1, 2, 3].into_iter().find_map(|least| {
        let mut places = vec![None; on_curve.len()];
        let mut at = 0;
        for contour in contours.iter().filter(|contour| contour.len() >= least) {
            for point in path(&on_curve[contour.clone()]) {
                if let Some(point) = point {
                    places[contour.start + point].get_or_insert(at);
                }
                at += 1;
            }
        }
        (at == count).then_some(places)
    })
}

/// The points of a contour in the order of its path; none for one that is implied.
fn path(on_curve: &[bool]) -> Vec<Option<usize>> {
    let count = on_curve.len();
    let (start, order): (Option<usize>, Vec<usize>) = match on_curve {
        [true, ..] => (Some(0), (1..count).collect()),
        [.., true] => (Some(count - 1), (0..count - 1).collect()),
        _ => (None, (0..count).collect()),
    };
    let mut path: Vec<Option<usize>> = once(start).collect();
    let mut control = None;
    for point in order {
        match (control, on_curve[point]) {
            (None, true) => path.push(Some(point)),
            (Some(_), true) => {
                path.extend([control, Some(point)]);
                control = None;
            }
            (None, false) => control = Some(point),
            (Some(_), false) => {
                path.extend([control, None]);
                control = Some(point);
            }
        }
    }
    if control.is_some() {
        path.extend([control, start]);
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn implied_points_are_counted_and_have_no_place() {
        // On, off, off, on, then a contour of one point, which is not drawn.
        let on_curve = [true, false, false, true, true];
        let places = places(&on_curve, &[0..4, 4..5], 5);
        assert_eq!(places, Some(vec![Some(0), Some(1), Some(3), Some(4), None]));
    }

    #[test]
    fn a_path_of_another_number_of_points_is_not_that_of_the_contours() {
        let contours = [0..3, 3..6];
        assert_eq!(places(&[true; 6], &contours, 7), None);
    }
}
