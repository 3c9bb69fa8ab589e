use super::*;

/// An outline of so many contours with 20 points each, in font units that look like a glyph's.
fn outline(contours: u16) -> OutlinePoints {
    let count = contours * 20;
    let coordinate = |k: u16, by: u16| (k.wrapping_mul(by) % 1500) as i16 - 300;
    OutlinePoints {
        coordinates: [211, 97].map(|by| (0..count).map(|k| coordinate(k, by)).collect()),
        on_curve: (0..count).map(|k| k % 3 != 1).collect(),
        ends: (1..=contours).map(|k| k * 20).collect(),
        is_unfit: false,
    }
}

/// How many of some changed outlines have the hash of the one that was changed.
fn unnoticed(changed: &[OutlinePoints]) -> usize {
    let hash = outline(3).hash(600);
    changed.iter().filter(|outline| outline.hash(600) == hash).count()
}

fn changed(change: impl FnOnce(&mut OutlinePoints)) -> OutlinePoints {
    let mut points = outline(3);
    change(&mut points);
    assert_ne!(points, outline(3));
    points
}

#[test]
fn the_hash_is_the_one_that_tables_have() {
    // FNV-1a's offset basis, 0x811C9DC5, and an advance width of 0, folded.
    let empty = 0x811C_9DC5u32.wrapping_mul(16_777_619);
    assert_eq!(u32::from(OutlinePoints::default().hash(0)), empty & 0xFFFF ^ empty >> 16);
    let point = OutlinePoints {
        coordinates: [vec![1], vec![-2]],
        on_curve: vec![true],
        ends: vec![1],
        is_unfit: false,
    };
    let numbers = [1u32, 0xFFFE, 1, 1, 600];
    let hash = numbers.iter().fold(0x811C_9DC5u32, |hash, v| (hash ^ v).wrapping_mul(16_777_619));
    assert_eq!(u32::from(point.hash(600)), hash & 0xFFFF ^ hash >> 16);
}

#[test]
fn any_other_coordinate_flag_or_end_of_a_contour_is_another_hash() {
    let mut all = Vec::new();
    for at in 0..outline(3).len() {
        all.push(changed(|points| points.on_curve[at] ^= true));
        for axis in 0..2 {
            for by in [-256, -64, -10, -2, -1, 1, 2, 3, 16, 100, 1000] {
                all.push(changed(|points| points.coordinates[axis][at] += by));
            }
        }
    }
    for contour in 0..3 {
        for by in 1..10 {
            all.push(changed(|points| points.ends[contour] += by));
            all.push(changed(|points| points.ends[contour] -= by));
        }
    }
    assert_eq!(unnoticed(&all), 0, "of {} changes", all.len());
    let hash = outline(3).hash(600);
    assert!((0..2048).all(|advance| advance == 600 || outline(3).hash(advance) != hash), "an advance width");
}

#[test]
fn another_order_of_points_axes_or_contours_is_another_hash() {
    let mut all = vec![
        changed(|points| points.coordinates.reverse()),
        changed(|points| _ = points.ends.pop()),
        changed(|points| points.ends.push(60)),
        changed(|points| *points = outline(2)),
        changed(|points| *points = outline(4)),
        OutlinePoints::default(),
    ];
    for at in 1..outline(3).len() {
        all.push(changed(|points| {
            points.coordinates.iter_mut().for_each(|axis| axis.swap(at - 1, at));
            points.on_curve.swap(at - 1, at);
        }));
    }
    assert_eq!(unnoticed(&all), 0, "of {} changes", all.len());
}

#[test]
fn one_in_65536_changes_goes_unnoticed() {
    let base = outline(3);
    let (mut points, mut tried, mut same) = (base.clone(), 0usize, 0usize);
    for at in 0..base.len() {
        for value in (i16::MIN..i16::MAX).step_by(16) {
            points.coordinates[1][at] = value;
            tried += usize::from(points != base);
            same += usize::from(points != base && points.hash(600) == base.hash(600));
        }
        points.clone_from(&base);
    }
    assert!(same <= 2 * tried / 65536, "{same} of {tried}");
}

#[test]
fn an_outline_that_16_bits_do_not_hold_is_unfit() {
    let with = |x: i32, y: i32, flags: PointFlags| {
        let mut points = OutlinePoints::default();
        points.point(x, y, flags);
        points.end_contour();
        points
    };
    let points = with(-32768, 32767, PointFlags::off_curve_quad());
    assert_eq!(
        (points.coordinates, points.on_curve, points.ends),
        ([vec![-32768], vec![32767]], vec![false], vec![1])
    );
    assert!(!points.is_unfit);
    assert!(with(32768, 0, PointFlags::on_curve()).is_unfit);
    assert!(with(0, -32769, PointFlags::on_curve()).is_unfit);
    assert!(with(0, 0, PointFlags::off_curve_cubic()).is_unfit);
    let mut many = OutlinePoints::default();
    (0..65_535).for_each(|_| many.point(0, 0, PointFlags::on_curve()));
    many.end_contour();
    assert!(!many.is_unfit);
    many.point(0, 0, PointFlags::on_curve());
    many.end_contour();
    assert!(many.is_unfit);
}
