use proptest::collection::vec;
use proptest::prelude::*;

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

/// How far (levels) a pixel may be from 255 times its share: half a level for rounding to whole ones, and for each
/// side that passes through it up to a quarter, as its crossings of pixel borders are rounded to whole units: half of
/// 1/512 pixel along a border is 1/1024 of a pixel's area.
fn allowed(sides: usize) -> f64 {
    0.53 + 0.25 * sides as f64
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
    let [x, y] = [[1, 1, 3, 3], [1, 3, 3, 1]].map(|at| at.map(|v| v * UNIT / 2 + UNIT).to_vec());
    let pixels = drawn(&mut Area::default(), [4, 4], &[[x.clone(), y.clone()]]);
    assert_eq!(pixels, [0, 0, 0, 0, 0, 64, 64, 0, 0, 64, 64, 0, 0, 0, 0, 0]);
    let backwards = [x, y].map(|at| at.into_iter().rev().collect());
    assert_eq!(drawn(&mut Area::default(), [4, 4], &[backwards]), [0; 16]);
}

#[test]
fn the_whole_bitmap_is_filled_by_its_border() {
    for size in [[1, 1], [7, 2], [8, 3], [9, 1], [16, 5], [300, 40]] {
        let [right, bottom] = size.map(|pixels| pixels as i32 * UNIT);
        let border = [vec![0, 0, right, right], vec![0, bottom, bottom, 0]];
        assert!(drawn(&mut Area::default(), size, &[border]).iter().all(|level| *level == 255), "{size:?}");
    }
}

#[test]
fn a_large_triangle_has_half_the_ink_of_its_box() {
    let size = [2000, 1500];
    let [right, bottom] = size.map(|pixels| pixels as i32 * UNIT);
    let pixels = drawn(&mut Area::default(), size, &[[vec![0, 0, right], vec![0, bottom, bottom]]]);
    let ink = pixels.iter().map(|pixel| f64::from(*pixel) / 255.0).sum::<f64>();
    let half = (size[0] * size[1]) as f64 / 2.0;
    // What the diagonal passes through, at half a level.
    assert!((ink - half).abs() < 3500.0 * 0.5 / 255.0, "{ink} for {half}");
}

#[test]
fn nothing_is_drawn_of_no_points_one_or_two() {
    for count in 0..3 {
        let polygon = [[5, 1300, 0], [10, 900, 0]].map(|at| at[..count].to_vec());
        assert_eq!(drawn(&mut Area::default(), [4, 3], &[polygon]), [0; 12]);
    }
}

/// What `block_coverage` does, for one pixel.
fn coverage(sum: i32) -> u8 {
    let share = (sum >> 5).clamp(0, FULL >> 5);
    ((share - (share >> 8) + 32) >> 6) as u8
}

#[test]
fn coverage_is_the_nearest_to_the_exact_share() {
    for sum in 0..=FULL {
        let exact = f64::from(sum) / f64::from(FULL) * 255.0;
        assert!((f64::from(coverage(sum)) - exact).abs() <= 0.53, "{sum}");
    }
    assert_eq!([coverage(-1), coverage(i32::MIN), coverage(FULL + 1), coverage(i32::MAX)], [0, 0, 255, 255]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn pixels_are_what_the_polygons_cover((size, polygons) in scene(3..8)) {
        let pixels = drawn(&mut Area::default(), size, &polygons);
        for (k, level) in pixels.iter().enumerate() {
            let (column, row) = (k % size[0], k / size[0]);
            let share = polygons.iter().map(|p| share(p, column, row)).sum::<f64>();
            let sides = polygons.iter().map(|p| sides_at(p, column, row)).sum();
            let exact = share.clamp(0.0, 1.0) * 255.0;
            prop_assert!(
                (f64::from(*level) - exact).abs() <= allowed(sides),
                "{level} for {exact} in column {column} of row {row}, {sides} sides"
            );
        }
    }

    #[test]
    fn pixels_of_a_triangle_are_off_by_a_level_at_most((size, polygons) in scene(3..4)) {
        let pixels = drawn(&mut Area::default(), size, &polygons[..1]);
        for (k, level) in pixels.iter().enumerate() {
            let exact = share(&polygons[0], k % size[0], k / size[0]).clamp(0.0, 1.0) * 255.0;
            prop_assert!((f64::from(*level) - exact).abs() <= 1.0, "{level} for {exact} in pixel {k}");
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
    fn a_row_is_summed_as_its_pixels_are(
        changes in vec((any::<i32>(), any::<i32>()), 24), above in vec(any::<i32>(), 24), width in 17usize..=24,
    ) {
        let at = |k: usize| changes[k];
        let mut blocks: Vec<Block> = (0..3)
            .map(|b| Block {
                cover: std::array::from_fn(|k| at(b * LANES + k).0),
                area: std::array::from_fn(|k| at(b * LANES + k).1),
            })
            .collect();
        let mut sums: Vec<i32x8> =
            above.as_chunks::<LANES>().0.iter().map(|chunk| i32x8::new(*chunk)).collect();
        let mut pixels = vec![0; width];
        write_row(&mut blocks, &mut sums, &mut pixels);
        for (k, pixel) in pixels.iter().enumerate() {
            let sum = above[k].wrapping_add(changes[k].0);
            prop_assert_eq!(sums[k / LANES].to_array()[k % LANES], sum);
            prop_assert_eq!(*pixel, coverage((sum << (SHIFT + 1)).wrapping_sub(changes[k].1)), "pixel {}", k);
        }
    }

    #[test]
    fn numbers_are_rounded_to_the_nearest_whole_one(v in -4_194_304.0f32..4_194_304.0) {
        prop_assert_eq!(crate::number::round(v), v.round_ties_even() as i32);
    }
}

#[test]
fn the_specification_names_the_units() {
    let page = include_str!("../../../spec/nfrt.md");
    for words in [
        format!("in units of 1/{UNIT} pixel"),
        format!("· strength · {UNIT}) + "),
        format!("A pixel's sum is {}\ntimes the cover", 2 * UNIT),
        format!("clamp(sum >> 5, 0, {})", FULL >> 5),
    ] {
        assert!(page.contains(&words), "spec/nfrt.md does not say {words:?}");
    }
}
