use proptest::collection::vec;
use proptest::prelude::*;
use zeno::{Command, Mask, Origin, PathBuilder};

use super::*;

/// Places along x and y, in units.
type Polygon = [Vec<i32>; 2];

/// One coordinate of a vertex: which kind of place, and a number that says which one.
type Pick = (u8, u32);

/// A coordinate within `0..=length`: anywhere, on a pixel's border, on the far one, where the vertex before it is, a
/// few units from there, or on either side of a pixel's border.
fn place((kind, raw): Pick, before: i32, length: i32) -> i32 {
    let anywhere = (raw % (length as u32 + 1)) as i32;
    let at = match kind {
        0..=2 => anywhere,
        3 => anywhere >> SHIFT << SHIFT,
        4 => length,
        5 => before,
        6 => before + raw as i32 % 7 - 3,
        _ => (anywhere >> SHIFT << SHIFT) + raw as i32 % 3 - 1,
    };
    at.clamp(0, length)
}

/// Up to three polygons in a bitmap of some width and height.
fn scene(sides: std::ops::Range<usize>) -> impl Strategy<Value = ([usize; 2], Vec<Polygon>)> {
    let vertex = || ((0u8..8, any::<u32>()), (0u8..8, any::<u32>()));
    let polygons = vec(vec(vertex(), sides), 1..3);
    ((1usize..20, 1usize..12), polygons).prop_map(|((width, height), polygons)| {
        let [right, bottom] = [width, height].map(|pixels| pixels as i32 * UNIT);
        let placed = |vertices: Vec<(Pick, Pick)>| {
            let mut polygon = Polygon::default();
            let (mut x, mut y) = (0, 0);
            for (across, down) in vertices {
                (x, y) = (place(across, x, right), place(down, y, bottom));
                polygon[0].push(x);
                polygon[1].push(y);
            }
            polygon
        };
        ([width, height], polygons.into_iter().map(placed).collect())
    })
}

fn drawn(area: &mut Area, [width, height]: [usize; 2], polygons: &[Polygon]) -> Vec<u8> {
    let mut pixels = vec![77; width * height];
    area.start(width, height);
    polygons.iter().for_each(|[x, y]| area.polygon::<false>(x, y));
    area.finish(width, &mut pixels);
    pixels
}

/// The same bitmap, some columns at a time.
fn drawn_in_strips([width, height]: [usize; 2], polygons: &[Polygon], strip: usize) -> Vec<u8> {
    let (mut area, mut pixels) = (Area::default(), vec![77; width * height]);
    for column in (0..width).step_by(strip) {
        area.start(strip.min(width - column), height);
        for [x, y] in polygons {
            let x: Vec<i32> = x.iter().map(|x| x - column as i32 * UNIT).collect();
            area.polygon::<true>(&x, y);
        }
        area.finish(width, &mut pixels[column..]);
    }
    pixels
}

/// The same bitmap, filled by zeno, whose y goes up.
fn drawn_by_zeno([width, height]: [usize; 2], polygons: &[Polygon]) -> Vec<u8> {
    let mut path: Vec<Command> = Vec::new();
    let point = |(x, y): (&i32, &i32)| [*x, height as i32 * UNIT - y].map(|v| v as f32 / UNIT as f32);
    for [x, y] in polygons {
        let mut points = x.iter().zip(y).map(point);
        path.move_to(points.next().unwrap_or_default());
        points.for_each(|point| _ = path.line_to(point));
        path.close();
    }
    let mut mask = Mask::new(path.as_slice());
    mask.origin(Origin::BottomLeft).size(width as u32, height as u32).render().0
}

/// What of a polygon is on one side of an upright or level line.
fn clipped(polygon: &[[f64; 2]], axis: usize, at: f64, above: bool) -> Vec<[f64; 2]> {
    let depth = |p: [f64; 2]| if above { p[axis] - at } else { at - p[axis] };
    let mut out = Vec::new();
    for (k, &b) in polygon.iter().enumerate() {
        let a = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (from, to) = (depth(a), depth(b));
        if (from < 0.0) != (to < 0.0) {
            let t = from / (from - to);
            out.push([0, 1].map(|k| if k == axis { at } else { a[k] + (b[k] - a[k]) * t }));
        }
        if to >= 0.0 {
            out.push(b);
        }
    }
    out
}

/// What a polygon covers of a pixel: of the polygon, cut to the pixel's square, the area as a share of it. A polygon
/// that winds around a point twice covers it twice.
fn share([x, y]: &Polygon, column: usize, row: usize) -> f64 {
    let point = |(x, y): (&i32, &i32)| [f64::from(*x), f64::from(*y)].map(|v| v / f64::from(UNIT));
    let mut cut: Vec<[f64; 2]> = x.iter().zip(y).map(point).collect();
    for (axis, first) in [(0, column as f64), (1, row as f64)] {
        cut = clipped(&cut, axis, first, true);
        cut = clipped(&cut, axis, first + 1.0, false);
    }
    let next = cut.iter().skip(1).chain(cut.first());
    // With y down, what goes around anticlockwise as seen with y up has a negative area.
    cut.iter().zip(next).map(|(a, b)| a[1] * b[0] - a[0] * b[1]).sum::<f64>() * 0.5
}

/// The longest side that `scene` makes, along x or y, in units.
const LONGEST: f64 = 20.0 * UNIT as f64;

/// How far (units) to the left or down a side may cross a border of pixels: less than one as it is rounded down, and for its
/// reciprocal, which is at most 1 less than 2²⁴ / length, up to 2⁻²⁴ of a number of at most `UNIT` times the length.
const CROSSING: f64 = crossing(LONGEST);

const fn crossing(length: f64) -> f64 {
    1.0 + length / 65536.0
}

/// How far (levels) a pixel may be from 256 times its share. The level is a whole number: one level less at most. A side
/// whose two crossings are a unit too low covers a strip of the pixel too much or too little that is a unit wide: one level.
fn allowed(sides: usize) -> f64 {
    1.0 + CROSSING * sides as f64
}

/// The level for an area: polygons may go around either way, and what they cover more than once is covered.
fn exact_level(share: f64) -> f64 {
    (share.abs() * 256.0).min(255.0)
}

/// Sides that pass through a pixel or touch it, as far as their boxes tell.
fn sides_at([x, y]: &Polygon, column: usize, row: usize) -> usize {
    let near = |k: usize, values: &[i32], pixel: usize| {
        let (a, b) = (values[k], values[(k + values.len() - 1) % values.len()]);
        let first = pixel as i32 * UNIT;
        a.min(b) <= first + UNIT && a.max(b) >= first
    };
    (0..x.len()).filter(|k| near(*k, x, column) && near(*k, y, row)).count()
}

#[test]
fn a_square_is_drawn_where_it_is() {
    let [x, y] = [[1, 3, 3, 1], [1, 1, 3, 3]].map(|at| at.map(|v| v * UNIT / 2 + UNIT).to_vec());
    let pixels = drawn(&mut Area::default(), [4, 4], &[[x, y]]);
    assert_eq!(pixels, [0, 0, 0, 0, 0, 64, 64, 0, 0, 64, 64, 0, 0, 0, 0, 0]);
}

#[test]
fn a_polygon_that_goes_around_anticlockwise_is_filled_too() {
    // A negative area becomes its complement: a whole number of levels is one less.
    let [x, y] = [[1, 1, 3, 3], [1, 3, 3, 1]].map(|at| at.map(|v| v * UNIT / 2 + UNIT).to_vec());
    let pixels = drawn(&mut Area::default(), [4, 4], &[[x, y]]);
    assert_eq!(pixels, [0, 0, 0, 0, 0, 63, 63, 0, 0, 63, 63, 0, 0, 0, 0, 0]);
}

#[test]
fn the_whole_bitmap_is_filled_by_its_border() {
    for size in [[1, 1], [7, 2], [8, 3], [9, 1], [16, 5], [300, 40]] {
        let [right, bottom] = size.map(|pixels| pixels as i32 * UNIT);
        let border = [vec![0, 0, right, right], vec![0, bottom, bottom, 0]];
        let backwards = border.clone().map(|at| at.into_iter().rev().collect());
        for polygon in [border, backwards] {
            let pixels = drawn(&mut Area::default(), size, &[polygon]);
            assert!(pixels.iter().all(|level| *level == 255), "{size:?}");
        }
    }
}

#[test]
fn a_large_triangle_has_half_the_ink_of_its_box() {
    let size = [2000, 1500];
    let [right, bottom] = size.map(|pixels| pixels as i32 * UNIT);
    let pixels = drawn(&mut Area::default(), size, &[[vec![0, 0, right], vec![0, bottom, bottom]]]);
    let ink = pixels.iter().map(|pixel| f64::from(*pixel)).sum::<f64>();
    // The diagonal passes through so many pixels and halves them; as many of the others are inside as outside.
    let passed = 2000 + 1500 - 500;
    let inside = (size[0] * size[1] - passed) / 2;
    let exact = inside as f64 * 255.0 + passed as f64 * 0.5 * 256.0;
    // As `allowed`, for this length.
    let each = 1.0 + crossing(right.into());
    assert!((ink - exact).abs() < passed as f64 * each, "{ink} for {exact}");
}

#[test]
fn nothing_is_drawn_of_no_points_one_or_two() {
    for count in 0..3 {
        let polygon = [[5, 1300, 0], [10, 900, 0]].map(|at| at[..count].to_vec());
        assert_eq!(drawn(&mut Area::default(), [4, 3], &[polygon]), [0; 12]);
    }
}

/// Twice the area of a pixel.
const FULL: i32 = 2 * UNIT * UNIT;

/// What `block_coverage` does, for one pixel.
fn coverage(area: i32) -> u8 {
    let levels = i64::from(area) * 256;
    let down = levels.div_euclid(FULL.into());
    let level = if down < 0 { -1 - down } else { down };
    level.min(255) as u8
}

#[test]
fn coverage_is_the_share_rounded_down() {
    for area in 0..=FULL {
        let exact = f64::from(area) / f64::from(FULL) * 256.0;
        assert_eq!(coverage(area), exact.floor().min(255.0) as u8, "{area}");
        // Anticlockwise: a share of whole levels is one level less.
        assert_eq!(coverage(-area), (exact.ceil() - 1.0).max(0.0) as u8, "{area}");
    }
    let beyond = [FULL + 1, 2 * FULL, -FULL - 1, i32::MAX, i32::MIN];
    assert_eq!(beyond.map(coverage), [255; 5]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn pixels_are_those_of_zeno((size, polygons) in scene(1..8)) {
        let pixels = drawn(&mut Area::default(), size, &polygons);
        prop_assert_eq!(pixels, drawn_by_zeno(size, &polygons));
    }

    #[test]
    fn pixels_are_what_the_polygons_cover((size, polygons) in scene(3..8)) {
        let pixels = drawn(&mut Area::default(), size, &polygons);
        for (k, level) in pixels.iter().enumerate() {
            let (column, row) = (k % size[0], k / size[0]);
            let share = polygons.iter().map(|p| share(p, column, row)).sum::<f64>();
            let sides = polygons.iter().map(|p| sides_at(p, column, row)).sum();
            let exact = exact_level(share);
            prop_assert!(
                (f64::from(*level) - exact).abs() <= allowed(sides),
                "{level} for {exact} in column {column} of row {row}, {sides} sides"
            );
        }
    }

    #[test]
    fn pixels_of_a_triangle_are_off_by_three_levels_at_most((size, polygons) in scene(3..4)) {
        let pixels = drawn(&mut Area::default(), size, &polygons[..1]);
        for (k, level) in pixels.iter().enumerate() {
            let exact = exact_level(share(&polygons[0], k % size[0], k / size[0]));
            // It passes each of a pixel's four borders twice at most, there and back. Both crossings are rounded in the same
            // direction, so that one makes it larger and the other one smaller, each by half a level or little more.
            let allowed = 1.0 + 4.0 * 0.5 * CROSSING;
            prop_assert!((f64::from(*level) - exact).abs() <= allowed, "{level} for {exact} in pixel {k}");
        }
    }

    #[test]
    fn strips_put_together_are_the_whole((size, polygons) in scene(1..8), strip in 1usize..20) {
        let whole = drawn(&mut Area::default(), size, &polygons);
        prop_assert_eq!(drawn_in_strips(size, &polygons, strip), whole);
    }

    #[test]
    fn memory_that_was_used_before_draws_the_same_and_is_left_blank(
        scenes in vec(scene(1..8), 1..5),
    ) {
        let mut area = Area::default();
        for (size, polygons) in &scenes {
            let pixels = drawn(&mut area, *size, polygons);
            prop_assert!(area.blocks.iter().all(|b| b.cover == [0; LANES] && b.area == [0; LANES]));
            prop_assert_eq!(&pixels, &drawn(&mut Area::default(), *size, polygons));
        }
    }

    #[test]
    fn the_order_of_polygons_does_not_matter((size, mut polygons) in scene(1..8)) {
        let pixels = drawn(&mut Area::default(), size, &polygons);
        polygons.reverse();
        prop_assert_eq!(drawn(&mut Area::default(), size, &polygons), pixels);
    }

    #[test]
    fn eight_levels_at_once_are_eight_levels(sums: [i32; LANES], near in vec(-FULL..2 * FULL, LANES)) {
        prop_assert_eq!(block_coverage(i32x8::new(sums)), sums.map(coverage));
        let near: [i32; LANES] = std::array::from_fn(|k| near[k]);
        prop_assert_eq!(block_coverage(i32x8::new(near)), near.map(coverage));
    }

    #[test]
    fn rows_are_summed_as_their_pixels_are(
        rows in vec(vec(block(), 3), 1..5), above in vec(any::<i32>(), 24), width in 17usize..=24,
    ) {
        let columns = |cover: &[i32; LANES]| Columns { cover: i32x8::new(*cover), coverage: None };
        let mut columns: Vec<Columns> = above.as_chunks::<LANES>().0.iter().map(columns).collect();
        let mut covers = above;
        for changes in rows {
            let mut blocks = changes.clone();
            let mut pixels = vec![0; width];
            write_row(&mut blocks, &mut columns, &mut pixels);
            for (k, pixel) in pixels.iter().enumerate() {
                let Block { cover, area } = &changes[k / LANES];
                let (cover, area) = (cover[k % LANES], area[k % LANES]);
                let sum = (covers[k] << (SHIFT + 1)).wrapping_add(area);
                prop_assert_eq!(*pixel, coverage(sum), "pixel {}", k);
                covers[k] = covers[k].wrapping_add(cover);
                prop_assert_eq!(columns[k / LANES].cover.to_array()[k % LANES], covers[k]);
            }
            for Block { cover, area } in blocks {
                prop_assert_eq!([cover, area], [[0; LANES]; 2]);
            }
        }
    }
}

/// A block, which is often empty.
fn block() -> impl Strategy<Value = Block> {
    let lanes = || prop::array::uniform8(any::<i32>());
    let nothing = || Just([0; LANES]);
    (prop_oneof![lanes(), nothing()], prop_oneof![lanes(), nothing()])
        .prop_map(|(cover, area)| Block { cover, area })
}

#[test]
fn the_specification_names_the_units() {
    let page = include_str!("../../../spec/nfrt.md");
    for words in [
        format!("in units of 1/{UNIT} pixel"),
        format!("· strength · {UNIT}) + "),
        format!("is {} times the covers", 2 * UNIT),
        format!("m = sum >> {LEVEL_BITS}"),
        format!("⌊{RECIPROCAL} / "),
    ] {
        assert!(page.contains(&words), "spec/nfrt.md does not say {words:?}");
    }
}
