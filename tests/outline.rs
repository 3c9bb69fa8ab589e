//! Plain outlines, which are drawn for glyphs without models, against a twin that only counts samples.

use nfr::{Bitmap, DrawOptions, Font, MissingModel, Rasterizer};
use read_fonts::model;
use read_fonts::model::glyph::outline::{DrawMemory, UnscaledOutlineSink};
use read_fonts::tables::glyf::PointFlags;
use read_fonts::types::GlyphId;

use crate::samples::{bytes, without_models};

/// Samples of a pixel along each axis.
const SAMPLES: i32 = 32;
/// Levels that a pixel may be off: the samples of a side may count half a row of samples too much, 4 levels; a level is
/// rounded down; and where a side crosses the borders of pixels is rounded down to 1/256 pixel.
const TOLERANCE: u8 = 6;

/// The contours of an outline: points in font units, and whether each is on the curve.
#[derive(Default)]
struct Contours(Vec<Vec<([i32; 2], bool)>>);

impl UnscaledOutlineSink for Contours {
    fn start_contour(&mut self) {
        self.0.push(Vec::new());
    }

    fn point(&mut self, x: i32, y: i32, flags: PointFlags) {
        self.0.last_mut().unwrap().push(([x, y], flags.is_on_curve()));
    }

    fn end_contour(&mut self) {}
}

/// The sides of a glyph's outline in pixels. Points are rounded to 1/64 pixel, and curves are cut into as many pieces as
/// FreeType cuts them into.
fn sides(font: &Font, glyph: u32, ppem: f32, offset: [f32; 2]) -> Vec<[[f32; 2]; 2]> {
    let file = model::Font::new(font.data().to_vec(), 0).unwrap();
    let mut contours = Contours::default();
    let outline = file.outline_glyphs().get(GlyphId::new(glyph)).unwrap();
    outline.draw_unscaled(DrawMemory::default(), &mut contours).unwrap();
    let scale =
        (f64::from((ppem * 64.0).round()) * 65536.0 / f64::from(font.units_per_em())).round() / 65536.0;
    let mut sides = Vec::new();
    for contour in contours.0 {
        let mut points: Vec<([i32; 2], bool)> = Vec::new();
        for (at, on_curve) in contour.iter().chain(contour.first()) {
            let at = at.map(|units| (f64::from(units) * scale).round() as i32);
            if let Some((before, false)) = points.last().filter(|_| !on_curve) {
                points.push(([0, 1].map(|k| (before[k] + at[k]) / 2), true));
            }
            points.push((at, *on_curve));
        }
        // The first point is at the end again.
        points.pop();
        let first = points.iter().position(|(_, on_curve)| *on_curve).unwrap();
        points.rotate_left(first);
        points.push(points[0]);
        let pixels = |k: usize| [0, 1].map(|axis| points[k].0[axis] as f32 / 64.0 + offset[axis]);
        let mut k = 0;
        while k + 1 < points.len() {
            if points[k + 1].1 {
                sides.push([pixels(k), pixels(k + 1)]);
                k += 1;
            } else {
                sides.extend(pieces([pixels(k), pixels(k + 1), pixels(k + 2)]));
                k += 2;
            }
        }
    }
    sides
}

/// The sides of a curve. It is halved, and its halves are, until the second difference is at most 1/4 pixel, or in the
/// units of 1/256 pixel less than 65.
fn pieces([a, b, c]: [[f32; 2]; 3]) -> Vec<[[f32; 2]; 2]> {
    let bend = [0, 1].map(|k| (a[k] + c[k] - 2.0 * b[k]).abs() * 256.0);
    let mut count = 1.0;
    while bend[0].max(bend[1]) / (count * count) >= 65.0 {
        count *= 2.0;
    }
    let at = |piece: u16| {
        let t = f32::from(piece) / count;
        [0, 1].map(|k| (1.0 - t) * (1.0 - t) * a[k] + 2.0 * t * (1.0 - t) * b[k] + t * t * c[k])
    };
    (0..count as u16).map(|piece| [at(piece), at(piece + 1)]).collect()
}

/// How often the outline goes around a point.
fn winding(sides: &[[[f32; 2]; 2]], [x, y]: [f32; 2]) -> i32 {
    let crossing = |[a, b]: &[[f32; 2]; 2]| {
        let up = a[1] <= y && b[1] > y;
        let down = b[1] <= y && a[1] > y;
        let at = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        if (up || down) && at > x { i32::from(up) - i32::from(down) } else { 0 }
    };
    sides.iter().map(crossing).sum()
}

fn compare(font: &Font, glyph: u32, ppem: f32, offset: [f32; 2]) -> Bitmap {
    let options = DrawOptions::new(ppem).with_offset(offset);
    let mut rasterizer = Rasterizer::new(font).with_missing_model(MissingModel::Outline);
    let bitmap = rasterizer.render(glyph, options).unwrap();
    let sides = sides(font, glyph, ppem, offset);
    let place = bitmap.placement;
    // One pixel more around it, which has to be empty.
    for row in -1..=place.height as i32 {
        for column in -1..=place.width as i32 {
            let inside = (0..place.height as i32).contains(&row) && (0..place.width as i32).contains(&column);
            let drawn =
                if inside { bitmap.pixels[row as usize * place.width as usize + column as usize] } else { 0 };
            let sample = |k: i32| (k as f32 + 0.5) / SAMPLES as f32;
            let hits = (0..SAMPLES * SAMPLES).filter(|k| {
                let x = (place.left + column) as f32 + sample(k % SAMPLES);
                let y = (place.top - row) as f32 - sample(k / SAMPLES);
                winding(&sides, [x, y]) != 0
            });
            let expected = (hits.count() as i32 * 256 / (SAMPLES * SAMPLES)).min(255) as u8;
            assert!(
                drawn.abs_diff(expected) <= TOLERANCE,
                "glyph {glyph} at {ppem} ppem, row {row}, column {column}: {drawn} for {expected}"
            );
        }
    }
    bitmap
}

#[test]
fn an_outline_is_filled_as_its_samples_say() {
    let font = Font::new(without_models(&bytes("serif"))).unwrap();
    for character in ['g', '@', 'W', 'é'] {
        let glyph = font.glyph_for_char(character).unwrap();
        for (ppem, offset) in [(9.0, [0.0; 2]), (16.5, [0.25, -0.4]), (31.0, [7.5, 0.0])] {
            let bitmap = compare(&font, glyph, ppem, offset);
            assert!(!bitmap.pixels.is_empty(), "{character} at {ppem} ppem");
        }
    }
}

#[test]
fn an_outline_that_is_drawn_in_strips_is_the_one_that_is_not() {
    // Bitmaps of more than a million pixels are drawn in strips; every pixel of the small one is a share of the large one's.
    let font = Font::new(without_models(&bytes("serif"))).unwrap();
    let glyph = font.glyph_for_char('@').unwrap();
    let mut rasterizer = Rasterizer::new(&font).with_missing_model(MissingModel::Outline);
    let large = rasterizer.render(glyph, 1600.0).unwrap();
    assert!(large.placement.area() > 1 << 20);
    let small = rasterizer.render(glyph, 100.0).unwrap();
    let mean = |bitmap: &Bitmap| bitmap.pixels.iter().map(|level| f64::from(*level)).sum::<f64>() / 255.0;
    let ratio = mean(&large) / mean(&small) / 256.0;
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
    for (row, levels) in large.rows().enumerate().step_by(97) {
        for (column, level) in levels.iter().enumerate().step_by(31) {
            let at = |x: usize| (large.placement.left + x as i32).div_euclid(16) - small.placement.left;
            let (x, y) =
                (at(column), small.placement.top - (large.placement.top - row as i32 - 1).div_euclid(16) - 1);
            let inside = small.pixels[y as usize * small.placement.width as usize + x as usize];
            assert!(!matches!((inside, level), (0, 128..) | (255, ..128)), "row {row}, column {column}");
        }
    }
}
