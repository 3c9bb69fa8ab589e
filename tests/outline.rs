//! Plain outlines, which are drawn for glyphs without models, against a twin that only counts samples.
#![allow(clippy::unwrap_used)]

mod samples;

use nfr::{Bitmap, DrawOptions, Font, MissingModel, Rasterizer};
use read_fonts::model;
use read_fonts::model::glyph::outline::{DrawMemory, DrawOptions as OutlineOptions, PathElement};
use read_fonts::types::GlyphId;

use samples::{bytes, without_models};

/// Samples of a pixel along each axis.
const SAMPLES: i32 = 32;
/// Levels that a pixel may be off: a row of samples is 8 levels of a pixel that a level side crosses, and a curve's sides
/// are off by a 128th of a pixel, 2 levels.
const TOLERANCE: u8 = 10;

/// The sides of a glyph's outline in pixels, with curves in very short pieces.
fn sides(font: &model::Font, glyph: u32, ppem: f32, offset: [f32; 2]) -> Vec<[[f32; 2]; 2]> {
    let mut path: Vec<PathElement> = Vec::new();
    let outline = font.outline_glyphs().get(GlyphId::new(glyph)).unwrap();
    outline.draw(&OutlineOptions::new().with_ppem(Some(ppem)), DrawMemory::default(), &mut path).unwrap();
    let (mut sides, mut start, mut at) = (Vec::new(), [0.0; 2], [0.0; 2]);
    let moved = |x: f32, y: f32| [x + offset[0], y + offset[1]];
    for element in path {
        match element {
            PathElement::MoveTo { x, y } => (start, at) = (moved(x, y), moved(x, y)),
            PathElement::LineTo { x, y } => {
                sides.push([at, moved(x, y)]);
                at = moved(x, y);
            }
            PathElement::QuadTo { cx0, cy0, x, y } => {
                let (a, b, c) = (at, moved(cx0, cy0), moved(x, y));
                for piece in 1..=16u8 {
                    let t = f32::from(piece) / 16.0;
                    let curve =
                        |k: usize| (1.0 - t) * (1.0 - t) * a[k] + 2.0 * t * (1.0 - t) * b[k] + t * t * c[k];
                    let next = [curve(0), curve(1)];
                    sides.push([at, next]);
                    at = next;
                }
            }
            PathElement::CurveTo { .. } => panic!("no cubic curve in TrueType"),
            PathElement::Close => {
                sides.push([at, start]);
                at = start;
            }
        }
    }
    sides
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
    let file = model::Font::new(font.data().to_vec(), 0).unwrap();
    let sides = sides(&file, glyph, ppem, offset);
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
            let expected = (hits.count() as i32 * 255 / (SAMPLES * SAMPLES)) as u8;
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
