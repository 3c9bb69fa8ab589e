//! Which points of a hinted cubic path are which of the unhinted one: skrifa leaves out a line whose two ends are one point, and
//! hinting can put two points in one place.

use super::super::outline::Outline;
use super::outline::{Contour, Segment, contours};

/// Where hinting puts the points of `plain`, which is in font units; `scale` is pixels in a font unit. None if the paths are not
/// of one outline.
pub(super) fn hinted_points(plain: &Outline, hinted: &Outline, scale: f32) -> Option<Vec<[f32; 2]>> {
    if plain.has_contours_of(hinted) {
        return Some(hinted.points.clone());
    }
    let (theirs, ours) = (contours(hinted.commands()), contours(plain.commands()));
    if ours.len() != theirs.len() {
        return None;
    }
    let mut points: Vec<[f32; 2]> = plain.points.iter().map(|p| p.map(|v| v * scale)).collect();
    for (ours, theirs) in ours.iter().zip(&theirs) {
        place_contour(ours, theirs, &hinted.points, &mut points)?;
    }
    Some(points)
}

/// Puts the points of a contour where those of the hinted one are. `points` has them scaled.
fn place_contour(
    ours: &Contour,
    theirs: &Contour,
    hinted: &[[f32; 2]],
    points: &mut [[f32; 2]],
) -> Option<()> {
    let (our_runs, our_curves) = runs(ours);
    let (their_runs, their_curves) = runs(theirs);
    if our_curves.len() != their_curves.len() {
        return None;
    }
    let start = hinted[theirs.start];
    points[ours.start] = start;
    let mut last = start;
    for (index, (ours, theirs)) in our_runs.iter().zip(&their_runs).enumerate() {
        // The line that closes a contour is left out if it ends where the contour begins.
        let closes_at = (index == our_curves.len()).then_some(start);
        let scaled: Vec<[f32; 2]> = ours.iter().map(|point| points[*point]).collect();
        let drawn: Vec<[f32; 2]> = theirs.iter().map(|point| hinted[*point]).collect();
        for (point, place) in ours.iter().zip(lines(&scaled, last, &drawn, closes_at)?) {
            points[*point] = place;
        }
        if let (Some(ours), Some(theirs)) = (our_curves.get(index), their_curves.get(index)) {
            for (point, place) in ours.iter().zip(theirs) {
                points[*point] = hinted[*place];
            }
            last = hinted[theirs[2]];
        }
    }
    Some(())
}

/// The lines before, between and behind the curves of a contour, by their ends; and the curves.
fn runs(contour: &Contour) -> (Vec<Vec<usize>>, Vec<[usize; 3]>) {
    let (mut runs, mut curves) = (vec![Vec::new()], Vec::new());
    for segment in &contour.segments {
        match segment {
            Segment::Line(end) => {
                if let Some(run) = runs.last_mut() {
                    run.push(*end);
                }
            }
            Segment::Curve(points) => {
                curves.push(*points);
                runs.push(Vec::new());
            }
        }
    }
    (runs, curves)
}

/// Where the ends of lines are, of which only some are drawn: those that are left out are where the line before ends, or where
/// the contour begins. Of all ways to match them, the one that moves the points least. None if more are drawn than there are.
fn lines(
    scaled: &[[f32; 2]],
    before: [f32; 2],
    drawn: &[[f32; 2]],
    closes_at: Option<[f32; 2]>,
) -> Option<Vec<[f32; 2]>> {
    let left_out = scaled.len().checked_sub(drawn.len())?;
    if left_out == 0 {
        return Some(drawn.to_vec());
    }
    let last = |used: usize| if used == 0 { before } else { drawn[used - 1] };
    // For a point that is left out behind `used` lines, its place and the cost.
    let omit = |point: usize, used: usize| {
        let own = last(used);
        let end = closes_at.filter(|_| used == drawn.len()).unwrap_or(own);
        let costs = [own, end].map(|place| (place, distance(scaled[point], place)));
        if costs[1].1 < costs[0].1 { costs[1] } else { costs[0] }
    };
    // costs[point][left out so far]: the least cost of the points before.
    let mut costs = vec![vec![f32::INFINITY; left_out + 1]; scaled.len() + 1];
    costs[0][0] = 0.0;
    for point in 0..scaled.len() {
        for omitted in 0..=left_out.min(point) {
            let (cost, used) = (costs[point][omitted], point - omitted);
            if let Some(place) = drawn.get(used) {
                let matched = cost + distance(scaled[point], *place);
                costs[point + 1][omitted] = costs[point + 1][omitted].min(matched);
            }
            if omitted < left_out && used <= drawn.len() {
                let skipped = cost + omit(point, used).1;
                costs[point + 1][omitted + 1] = costs[point + 1][omitted + 1].min(skipped);
            }
        }
    }
    let mut places = vec![[0.0; 2]; scaled.len()];
    let mut omitted = left_out;
    for point in (0..scaled.len()).rev() {
        let matched = point.checked_sub(omitted).and_then(|used| drawn.get(used));
        let cost = costs[point + 1][omitted];
        match matched {
            Some(place) if costs[point][omitted] + distance(scaled[point], *place) <= cost => {
                places[point] = *place;
            }
            _ => {
                omitted = omitted.checked_sub(1)?;
                places[point] = omit(point, point.checked_sub(omitted)?).0;
            }
        }
    }
    Some(places)
}

fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).abs()
}

#[cfg(test)]
mod tests {
    use skrifa::PathSink;

    use super::*;

    fn path(points: &[[f32; 2]]) -> Outline {
        let mut path = Outline::default();
        path.move_to(points[0][0], points[0][1]);
        for [x, y] in &points[1..] {
            path.line_to(*x, *y);
        }
        path.close();
        path
    }

    #[test]
    fn a_line_that_hinting_shrinks_to_a_point_has_both_ends_there() {
        let plain = path(&[[0.0, 0.0], [100.0, 0.0], [100.0, 10.0], [100.0, 500.0], [0.0, 500.0]]);
        // Hinting puts the second and the third point in one place.
        let hinted = path(&[[0.0, 0.0], [1.0, 0.0], [1.0, 5.0], [0.0, 5.0]]);
        let points = hinted_points(&plain, &hinted, 0.01);
        assert_eq!(points, Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 5.0], [0.0, 5.0]]));
    }

    #[test]
    fn a_last_point_on_the_first_one_is_there() {
        let plain = path(&[[0.0, 0.0], [100.0, 0.0], [100.0, 500.0], [0.0, 10.0]]);
        let hinted = path(&[[0.0, 0.0], [1.0, 0.0], [1.0, 5.0]]);
        let points = hinted_points(&plain, &hinted, 0.01);
        assert_eq!(points, Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 5.0], [0.0, 0.0]]));
    }

    #[test]
    fn another_outline_is_not_matched() {
        let plain = path(&[[0.0, 0.0], [100.0, 0.0], [100.0, 500.0]]);
        let more = path(&[[0.0, 0.0], [1.0, 0.0], [1.0, 5.0], [2.0, 0.0]]);
        assert_eq!(hinted_points(&plain, &more, 0.01), None);
        assert_eq!(hinted_points(&plain, &Outline::default(), 0.01), None);
    }
}
