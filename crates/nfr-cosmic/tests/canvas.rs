//! The canvas, beside one that draws pixel by pixel.
#![allow(clippy::unwrap_used)]

use cosmic_text::Color;
use nfr_cosmic::{Canvas, Image, RgbaCanvas};
use proptest::prelude::*;

const SIZE: [i64; 2] = [9, 7];

/// `over` in floating point, with opaque pixels below.
fn blended(below: u8, above: u8, alpha: f64) -> f64 {
    f64::from(below) * (1.0 - alpha) + f64::from(above) * alpha
}

/// The pixels of `before` with `source(x, y)`, a colour and its alpha, over those of a rectangle.
fn naive(
    before: &[u8],
    at: [i32; 2],
    size: [u32; 2],
    source: impl Fn(usize, usize) -> ([u8; 3], f64),
) -> Vec<f64> {
    let mut after: Vec<f64> = before.iter().map(|v| f64::from(*v)).collect();
    for (y, x) in (0..size[1] as usize).flat_map(|y| (0..size[0] as usize).map(move |x| (y, x))) {
        let place = [i64::from(at[0]) + x as i64, i64::from(at[1]) + y as i64];
        if (0..SIZE[0]).contains(&place[0]) && (0..SIZE[1]).contains(&place[1]) {
            let start = 4 * (place[1] * SIZE[0] + place[0]) as usize;
            let (color, alpha) = source(x, y);
            for channel in 0..3 {
                after[start + channel] = blended(before[start + channel], color[channel], alpha);
            }
        }
    }
    after
}

/// Rounding to eight bits of the alpha, of the source and of what is below.
const ROUNDING: f64 = 2.0;

fn check(drawn: &[u8], expected: &[f64]) -> Result<(), TestCaseError> {
    for (drawn, expected) in drawn.iter().zip(expected) {
        prop_assert!((f64::from(*drawn) - expected).abs() <= ROUNDING, "{drawn} for {expected}");
    }
    Ok(())
}

fn places() -> impl Strategy<Value = i32> {
    prop_oneof![-12..12, Just(i32::MIN), Just(i32::MAX)]
}

proptest! {
    #[test]
    fn rectangles_masks_and_pictures_are_clipped_and_blended(
        (x, y, width, height) in (places(), places(), 0u32..14, 0u32..14),
        color: [u8; 4],
        bytes in prop::collection::vec(any::<u8>(), 4 * 14 * 14),
        mut before in prop::collection::vec(any::<u8>(), 4 * 9 * 7),
    ) {
        before.chunks_mut(4).for_each(|pixel| pixel[3] = 255);
        let [red, green, blue, alpha] = color;
        let (rgb, opacity) = ([red, green, blue], f64::from(alpha) / 255.0);
        let color = Color::rgba(red, green, blue, alpha);
        let draw = |draw: &dyn Fn(&mut RgbaCanvas<'_>)| {
            let mut pixels = before.clone();
            draw(&mut RgbaCanvas::new(&mut pixels, SIZE[0] as u32));
            pixels
        };
        let image = Image { width, height, data: &bytes };
        let (at, size) = ([x, y], [width, height]);
        let drawn = draw(&|canvas| canvas.rectangle(x, y, width, height, color));
        check(&drawn, &naive(&before, at, size, |_, _| (rgb, opacity)))?;
        let drawn = draw(&|canvas| canvas.mask(x, y, image, color));
        let index = |x: usize, y: usize| y * width as usize + x;
        check(&drawn, &naive(&before, at, size, |x, y| (rgb, opacity * f64::from(bytes[index(x, y)]) / 255.0)))?;
        let drawn = draw(&|canvas| canvas.picture(x, y, image));
        check(&drawn, &naive(&before, at, size, |x, y| {
            let pixel = &bytes[4 * index(x, y)..][..4];
            ([pixel[0], pixel[1], pixel[2]], f64::from(pixel[3]) / 255.0)
        }))?;
    }
}

/// A number divided by 255, rounded to the nearest.
fn by_255(number: u32) -> u32 {
    (number + 127) / 255
}

proptest! {
    /// Masks are drawn several pixels at a time, which are other ones at each edge and width.
    #[test]
    fn each_pixel_of_a_mask_is_rounded_as_if_it_were_alone(
        canvas in 1usize..40,
        (x, y, width, height) in (-12i32..40, -12i32..12, 0u32..30, 0u32..14),
        colors: [[u8; 4]; 2],
        levels in prop::collection::vec(prop_oneof![Just(0), Just(255), any::<u8>()], 0..30 * 14),
        before in prop::collection::vec(any::<u8>(), 4 * 40 * 7),
    ) {
        let mut before = before[..4 * 7 * canvas].to_vec();
        before.chunks_mut(4).for_each(|pixel| pixel[3] = 255);
        let (mut drawn, mut expected) = (before.clone(), before);
        let mut neural = RgbaCanvas::new(&mut drawn, canvas as u32);
        for color in colors {
            let [red, green, blue, alpha] = color;
            let mask = Image { width, height, data: &levels };
            neural.mask(x, y, mask, Color::rgba(red, green, blue, alpha));
            let premultiplied = [red, green, blue, 255].map(|v| by_255(u32::from(v) * u32::from(alpha)));
            for (index, level) in levels.iter().enumerate().take((width * height) as usize) {
                let place = [x + index as i32 % width as i32, y + index as i32 / width as i32];
                if (0..canvas as i32).contains(&place[0]) && (0..7).contains(&place[1]) {
                    let start = 4 * (place[1] as usize * canvas + place[0] as usize);
                    let level = u32::from(*level);
                    let rest = 255 - by_255(premultiplied[3] * level);
                    for (byte, color) in expected[start..start + 4].iter_mut().zip(premultiplied) {
                        *byte = by_255(color * level + u32::from(*byte) * rest) as u8;
                    }
                }
            }
        }
        prop_assert_eq!(drawn, expected);
    }
}

#[test]
fn no_canvas_is_too_small() {
    let data = [255; 64];
    for (bytes, width) in [(0, 0), (0, 5), (7, 1), (16, 0), (16, 100), (40, 3)] {
        let mut pixels = vec![0; bytes];
        let mut canvas = RgbaCanvas::new(&mut pixels, width).with_origin(i32::MAX, i32::MIN);
        canvas.rectangle(i32::MAX, i32::MIN, u32::MAX, u32::MAX, Color::rgb(1, 2, 3));
        canvas.mask(-1, -1, Image { width: 8, height: 8, data: &data }, Color::rgb(1, 2, 3));
        canvas.picture(0, 0, Image { width: 100, height: 100, data: &data });
    }
    // A mask that lacks data is drawn as far as it goes.
    let mut pixels = [0; 16];
    let mask = Image { width: 2, height: 2, data: &[255; 3] };
    RgbaCanvas::new(&mut pixels, 2).mask(0, 0, mask, Color::rgb(9, 9, 9));
    assert_eq!(pixels, [9, 9, 9, 255, 9, 9, 9, 255, 9, 9, 9, 255, 0, 0, 0, 0]);
}
