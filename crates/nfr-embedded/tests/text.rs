//! Text on embedded-graphics' displays beside the library's own bitmaps.

use std::collections::BTreeMap;
use std::convert::Infallible;

use embedded_graphics::Drawable;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::pixelcolor::{BinaryColor, Gray8, GrayColor, PixelColor, Rgb565, RgbColor};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::renderer::TextRenderer;
use embedded_graphics::text::{Baseline, Text};
use nfr::{Bitmap, BitmapRef, Font, Rasterizer};
use nfr_embedded::{Blend, Depth, Face, pack};

const WIDTH: i32 = 64;
const HEIGHT: i32 = 48;

/// A display that remembers the colour of each pixel that was written, and fails a test that writes outside.
struct Display<C> {
    pixels: BTreeMap<(i32, i32), C>,
}

impl<C: PixelColor> Display<C> {
    fn new() -> Self {
        Self { pixels: BTreeMap::new() }
    }

    fn at(&self, x: i32, y: i32, ground: C) -> C {
        self.pixels.get(&(x, y)).copied().unwrap_or(ground)
    }
}

impl<C> Dimensions for Display<C> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::zero(), Size::new(WIDTH as u32, HEIGHT as u32))
    }
}

impl<C: PixelColor> DrawTarget for Display<C> {
    type Color = C;
    type Error = Infallible;

    /// Pixels outside are left out, which embedded-graphics asks of displays.
    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let area = self.bounding_box();
        let seen = pixels.into_iter().filter(|Pixel(point, _)| area.contains(*point));
        self.pixels.extend(seen.map(|Pixel(point, colour)| ((point.x, point.y), colour)));
        Ok(())
    }
}

fn font() -> Font {
    Font::new(include_bytes!("../fonts/ascii.nfr.ttf").as_slice()).expect("a converted font")
}

/// The coverage of a line by the library itself: hinted advance widths, shared pixels added. `baseline` is the last row above it.
fn expected(text: &str, ppem: f32, left: i32, baseline: i32) -> Vec<u8> {
    expected_of(text, ppem, [left, baseline], |rasterizer, glyph| {
        rasterizer.render(glyph, ppem).expect("a bitmap")
    })
}

/// The same of bitmaps that `render` gives.
fn expected_of(
    text: &str,
    ppem: f32,
    [left, baseline]: [i32; 2],
    render: impl Fn(&mut Rasterizer, u32) -> Bitmap,
) -> Vec<u8> {
    let font = font();
    let mut rasterizer = Rasterizer::new(&font);
    let mut coverage = vec![0u8; (WIDTH * HEIGHT) as usize];
    let mut pen = left;
    for glyph in text.chars().filter_map(|character| font.glyph_for_char(character)) {
        let bitmap = render(&mut rasterizer, glyph);
        for (row, y) in bitmap.rows().zip(baseline + 1 - bitmap.placement.top..) {
            for (level, x) in row.iter().zip(pen + bitmap.placement.left..) {
                if (0..WIDTH).contains(&x) && (0..HEIGHT).contains(&y) {
                    let pixel = &mut coverage[(y * WIDTH + x) as usize];
                    *pixel = pixel.saturating_add(*level);
                }
            }
        }
        pen += rasterizer.hinted_advance(glyph, ppem).expect("an advance width").round() as i32;
    }
    coverage
}

/// Compares every pixel of a display.
fn assert_shows<C: Blend + std::fmt::Debug>(display: &Display<C>, coverage: &[u8], text: C, ground: C) {
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let level = coverage[(y * WIDTH + x) as usize];
            assert_eq!(display.at(x, y, ground), ground.blend(text, level), "at {x}, {y}");
        }
    }
}

#[test]
fn pixels_are_those_of_the_library_with_and_without_a_background() {
    let font = font();
    let face = Face::new(&font);
    for (line, ppem) in [("Magic", 12.0), ("jf/%W", 10.0), ("rTy", 17.3), ("fjf", 24.0), ("", 12.0)] {
        let coverage = expected(line, ppem, 3, 30);
        let style = face.style(ppem, Gray8::WHITE, Gray8::BLACK);
        for style in [style, style.with_background(Gray8::BLACK)] {
            let mut display = Display::new();
            let Ok(next) = Text::new(line, Point::new(3, 30), style).draw(&mut display);
            assert_shows(&display, &coverage, Gray8::WHITE, Gray8::BLACK);
            assert_eq!(
                next,
                style.measure_string(line, Point::new(3, 30), Baseline::Alphabetic).next_position
            );
        }
    }
    assert_eq!(face.problem(), None);
}

#[test]
fn colours_are_mixed() {
    let font = font();
    let face = Face::new(&font);
    let coverage = expected("Ag8", 14.0, 2, 20);
    let (text, ground) = (Rgb565::YELLOW, Rgb565::BLUE);
    let mut display = Display::new();
    let Ok(_) = Text::new("Ag8", Point::new(2, 20), face.style(14.0, text, ground)).draw(&mut display);
    assert_shows(&display, &coverage, text, ground);
}

#[test]
fn two_colours_are_drawn_in_black_and_white_without_gaps() {
    let font = font();
    let face = Face::new(&font);
    // At this size half coverage loses strokes of the hinted outlines.
    let (line, ppem, at) = ("%&W@8", 10.0, [1, 20]);
    let coverage = expected_of(line, ppem, at, |rasterizer, glyph| {
        let bitmap = rasterizer.render_mono(glyph, ppem).expect("a bitmap");
        let level = |x, y| if bitmap.is_black(x, y) { 255 } else { 0 };
        let (width, height) = (bitmap.placement.width, bitmap.placement.height);
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| level(x, y))).collect();
        Bitmap { placement: bitmap.placement, pixels }
    });
    let style = face.style(ppem, BinaryColor::On, BinaryColor::Off);
    let mut display = Display::new();
    let Ok(_) = Text::new(line, Point::new(at[0], at[1]), style).draw(&mut display);
    assert_shows(&display, &coverage, BinaryColor::On, BinaryColor::Off);
    assert_eq!(display.pixels.len(), coverage.iter().filter(|level| **level > 0).count());
    let at_half = expected(line, ppem, at[0], at[1]).iter().filter(|level| **level >= 128).count();
    assert!(display.pixels.len() > at_half, "{} pixels, {at_half} at half coverage", display.pixels.len());
    assert_eq!(face.problem(), None);
}

#[test]
fn text_is_clipped_at_every_side_of_the_display() {
    let font = font();
    let face = Face::new(&font);
    for (x, y) in [(-9, 20), (60, 20), (5, 3), (5, 52), (-40, 20), (200, 20), (5, -300)] {
        for background in [false, true] {
            let plain = face.style(20.0, Gray8::WHITE, Gray8::BLACK);
            let style = if background { plain.with_background(Gray8::BLACK) } else { plain };
            let mut display = Display::new();
            let Ok(_) = Text::new("Wgj", Point::new(x, y), style).draw(&mut display);
            assert_shows(&display, &expected("Wgj", 20.0, x, y), Gray8::WHITE, Gray8::BLACK);
        }
    }
    let far = face.style(20.0, Gray8::WHITE, Gray8::BLACK);
    let Ok(next) =
        far.draw_string("ab", Point::new(i32::MAX - 3, 9), Baseline::Alphabetic, &mut Display::new());
    assert_eq!(next.x, i32::MAX);
}

#[test]
fn baselines_are_those_of_embedded_graphics_own_fonts() {
    use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
    let font = font();
    let face = Face::new(&font);
    let own = MonoTextStyle::new(&FONT_6X10, Gray8::WHITE);
    let mut display = Display::new();
    let Ok(_) = Text::new("H", Point::new(0, 20), own).draw(&mut display);
    let own_last = display.pixels.iter().filter(|(_, colour)| colour.luma() > 0).map(|(at, _)| at.1).max();
    let style = face.style(12.0, Gray8::WHITE, Gray8::BLACK);
    let mut display = Display::new();
    let Ok(_) = Text::new("H", Point::new(0, 20), style).draw(&mut display);
    assert_eq!((own_last, display.pixels.keys().map(|at| at.1).max()), (Some(20), Some(20)));

    let top = |baseline| style.measure_string("H", Point::new(0, 100), baseline).bounding_box.top_left.y;
    let height = style.measure_string("H", Point::zero(), Baseline::Top).bounding_box.size.height as i32;
    assert_eq!((top(Baseline::Top), top(Baseline::Bottom)), (100, 101 - height));
    assert_eq!(top(Baseline::Middle), 100 - (height - 1) / 2);
    assert!(style.line_height() as i32 >= height);
}

#[test]
fn decorations_and_whitespace_are_as_wide_as_the_text() {
    let font = font();
    let face = Face::new(&font);
    let style = face.style(12.0, Gray8::WHITE, Gray8::BLACK).with_underline().with_strikethrough();
    let mut display = Display::new();
    let Ok(next) = Text::new("  ", Point::new(4, 20), style).draw(&mut display);
    let rows: Vec<i32> = display.pixels.keys().filter(|at| at.0 == 4).map(|at| at.1).collect();
    assert_eq!(rows.len(), 2, "{rows:?}");
    assert!(rows[0] < 20 && rows[1] > 20, "{rows:?}");
    assert_eq!(display.pixels.len() as i32, 2 * (next.x - 4));

    let mut display = Display::new();
    let filled = face.style(12.0, Gray8::WHITE, Gray8::BLACK).with_background(Gray8::new(9));
    let Ok(next) = filled.draw_whitespace(5, Point::new(1, 0), Baseline::Top, &mut display);
    let height = filled.measure_string("", Point::zero(), Baseline::Top).bounding_box.size.height;
    assert_eq!((next.x, display.pixels.len()), (6, 5 * height as usize));
}

#[test]
fn packed_rows_begin_at_bytes_and_the_first_pixel_is_the_highest() {
    let font = font();
    let mut rasterizer = Rasterizer::new(&font);
    let glyph = font.glyph_for_char('m').expect("a glyph");
    let bitmap = rasterizer.draw(glyph, 13.0).expect("a bitmap");
    for depth in [Depth::One, Depth::Two, Depth::Four, Depth::Eight] {
        let mut packed = vec![0xA5; 400];
        let length = pack(bitmap, depth, &mut packed).expect("room");
        assert_eq!(length, depth.row_bytes(bitmap.placement.width) * bitmap.placement.height as usize);
        assert!(packed[length..].iter().all(|byte| *byte == 0xA5));
        assert_eq!(packed[..length], packed_slowly(bitmap, depth), "{depth:?}");
        let small = pack(bitmap, depth, &mut packed[..length - 1]).expect_err("too small");
        assert_eq!((small.needed, small.length), (length, length - 1));
    }
}

/// The same bit by bit.
fn packed_slowly(bitmap: BitmapRef<'_>, depth: Depth) -> Vec<u8> {
    let most = ((1u32 << depth.bits()) - 1) as f32;
    let row = |row: &[u8]| {
        let levels = row.iter().map(|level| (f32::from(*level) / 255.0 * most).round() as u32);
        let bits = levels.flat_map(|level| (0..depth.bits()).rev().map(move |bit| level >> bit & 1));
        let mut bits: Vec<u32> = bits.collect();
        bits.resize(bits.len().next_multiple_of(8), 0);
        bits.chunks(8).map(|byte| byte.iter().fold(0, |sum, bit| sum << 1 | *bit as u8)).collect::<Vec<u8>>()
    };
    bitmap.rows().flat_map(row).collect()
}
