//! Coverage of subpixels against FreeType's, from fonts that are converted for the target `lcd`.

use std::rc::Rc;
use std::sync::LazyLock;

use crate::freetype_bitmap::rendered;
use freetype::face::LoadFlag;
use freetype::{Face, Matrix, RenderMode, Vector};
use nfr::{Bitmap, Font, Lcd, LcdBitmap, LcdFilter, Placement, Rasterizer, SubpixelOrder, Target};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::{Options, convert};

use crate::samples::{FONTS, Silent, ascii, font, gid, gids};

/// The mean absolute difference of a channel's coverage, of all glyphs and sizes. The models of default quality differ by
/// 0.0002 from the hints at these sizes; the rest is what the rasterisers differ by.
const TOLERANCE: f64 = 0.0004;
const PPEM: [u32; 7] = [9, 10, 11, 12, 14, 16, 24];

fn load(face: &Face, gid: u16, ppem: u32) {
    face.set_pixel_sizes(0, ppem).unwrap();
    face.load_glyph(gid.into(), LoadFlag::NO_BITMAP | LoadFlag::TARGET_LCD).unwrap();
}

/// One channel of a bitmap of ours.
fn channel(bitmap: &LcdBitmap, channel: usize) -> Bitmap {
    Bitmap { placement: bitmap.placement, pixels: bitmap.pixels.iter().map(|pixel| pixel[channel]).collect() }
}

/// The fonts, and what they are converted to.
static CONVERTED: LazyLock<Vec<(Vec<u8>, Font)>> = LazyLock::new(|| {
    let converted = FONTS.map(|name| {
        let original = font(name);
        let gids = gids(&original, &ascii());
        let options = Options { gids, target: Target::Lcd, ..Options::default() };
        let font = Font::new(convert(&original, &options, &Silent).unwrap().font).unwrap();
        (original, font)
    });
    converted.into()
});

/// Compares a channel of all ASCII glyphs with the one that `reference` gives.
fn compare(lcd: Lcd, reference: impl Fn(&Face, u16, u32) -> [Bitmap; 3]) {
    for (name, (original, font)) in FONTS.into_iter().zip(&*CONVERTED) {
        let mut rasterizer = Rasterizer::new(font);
        let face = freetype::Library::init().unwrap().new_memory_face(Rc::new(original.clone()), 0).unwrap();
        let mut sums: [Sums; 3] = Default::default();
        for (character, ppem) in ascii().chars().flat_map(|c| PPEM.map(|ppem| (c, ppem))) {
            let gid = gid(original, character);
            let theirs = reference(&face, gid, ppem);
            let ours = rasterizer.render_lcd(gid.into(), ppem as f32, lcd).unwrap();
            for (k, theirs) in theirs.iter().enumerate() {
                sums[k].add(theirs, &channel(&ours, k));
            }
        }
        for (k, sums) in sums.iter().enumerate() {
            assert!(sums.mae() <= TOLERANCE, "{name}, channel {k} of {lcd:?}: {}", sums.mae());
        }
    }
}

#[test]
fn shifted_coverage_is_that_of_freetypes_default_build() {
    compare(Lcd::default(), |face, gid, ppem| {
        load(face, gid, ppem);
        let drawn = rendered(face, RenderMode::Lcd).unwrap();
        [0, 1, 2].map(|k| Bitmap {
            placement: Placement { width: drawn.placement.width / 3, ..drawn.placement },
            pixels: drawn.pixels.iter().skip(k).step_by(3).copied().collect(),
        })
    });
}

#[test]
fn shifted_coverage_of_subpixels_one_above_the_other_is_freetypes_too() {
    compare(Lcd::new(SubpixelOrder::VerticalRgb), |face, gid, ppem| {
        load(face, gid, ppem);
        let drawn = rendered(face, RenderMode::LcdV).unwrap();
        let width = drawn.placement.width.max(1) as usize;
        [0, 1, 2].map(|k| Bitmap {
            placement: Placement { height: drawn.placement.height / 3, ..drawn.placement },
            pixels: drawn.pixels.chunks(width).skip(k).step_by(3).flatten().copied().collect(),
        })
    });
}

/// FreeType's coverage of subpixels, drawn three times as wide and filtered here as it filters them (`ftlcdfil.c`).
fn filtered(face: &Face, gid: u16, ppem: u32, weights: [u32; 5]) -> [Bitmap; 3] {
    let one = 0x10000;
    let mut wide = Matrix { xx: 3 * one, xy: 0, yx: 0, yy: one };
    face.set_transform(&mut wide, &mut Vector { x: 0, y: 0 });
    load(face, gid, ppem);
    let samples = rendered(face, RenderMode::Normal).unwrap();
    let place = samples.placement;
    let (left, right) = (place.left - 2, place.left + place.width as i32 + 2);
    let (first, end) = (left.div_euclid(3), (right + 2).div_euclid(3));
    let placement = Placement { left: first, width: end.abs_diff(first), ..place };
    let sample = |row: usize, x: i32| match usize::try_from(x - place.left) {
        Ok(x) if x < place.width as usize => u32::from(samples.pixels[row * place.width as usize + x]),
        _ => 0,
    };
    [0, 1, 2].map(|k| {
        let levels = (0..place.height as usize).flat_map(|row| {
            (first..end).map(move |x| {
                let near = (-2..=2).map(|far| sample(row, 3 * x + k + far));
                (near.zip(weights).map(|(level, weight)| level * weight).sum::<u32>() >> 8) as u8
            })
        });
        Bitmap { placement, pixels: levels.collect() }
    })
}

#[test]
fn filtered_coverage_is_that_of_freetypes_filters() {
    for (filter, weights) in [(LcdFilter::Light, [0, 85, 86, 85, 0]), (LcdFilter::Fir5, [8, 77, 86, 77, 8])] {
        let lcd = Lcd::default().with_filter(filter);
        compare(lcd, |face, gid, ppem| filtered(face, gid, ppem, weights));
    }
}
