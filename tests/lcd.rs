//! Coverage of subpixels, against grey bitmaps and a filter that is written out. crates/nfr-convert/tests/lcd.rs compares with
//! FreeType.

use nfr::{
    Bitmap, DrawOptions, Error, Lcd, LcdBitmap, LcdFilter, Limits, MissingModel, Placement, Rasterizer,
    SubpixelOrder,
};

use crate::samples::{bytes, font, without_models};

/// Outlines, fields with hints in y and in both axes.
const FONTS: [&str; 4] = ["outline", "outline-mono", "sans", "mono"];
const FILTERS: [LcdFilter; 4] =
    [LcdFilter::Shifted, LcdFilter::Unfiltered, LcdFilter::Light, LcdFilter::Fir5];
const PPEM: [f32; 4] = [9.0, 16.4, 31.0, 70.0];
const OFFSETS: [[f32; 2]; 3] = [[0.0; 2], [0.25, -0.5], [-1000.0, 1024.0]];
/// Levels that a pixel's coverage may differ from the mean of its subpixels', in a bitmap and on average over it: curves are cut
/// into more pieces for these. A subpixel too few or too many would be 85.
const FINER_CURVES: u8 = 32;
const FINER_ON_AVERAGE: usize = 4;

/// Calls `f` with a rasterizer, a glyph with and one without parts, and how they are drawn.
fn for_all(mut f: impl FnMut(&mut Rasterizer, u32, DrawOptions)) {
    for name in FONTS {
        let font = font(name);
        let mut rasterizer = Rasterizer::new(&font);
        for glyph in "gé".chars().map(|c| font.glyph_for_char(c).unwrap()) {
            for (ppem, offset) in PPEM.into_iter().flat_map(|ppem| OFFSETS.map(|offset| (ppem, offset))) {
                f(&mut rasterizer, glyph, DrawOptions::new(ppem).with_offset(offset));
            }
        }
    }
}

/// Where a pixel is stored that is counted from the origin, x to the right and y down.
fn index(place: Placement, [x, y]: [i32; 2]) -> Option<usize> {
    let [column, row] = [x - place.left, y + place.top];
    let inside = (0..place.width as i32).contains(&column) && (0..place.height as i32).contains(&row);
    inside.then_some(row as usize * place.width as usize + column as usize)
}

/// The coverage of a pixel.
fn grey(bitmap: &Bitmap, at: [i32; 2]) -> u8 {
    index(bitmap.placement, at).map_or(0, |at| bitmap.pixels[at])
}

/// The coverage of a subpixel: all of them counted through, along the axis that they lie along.
fn subpixel(bitmap: &LcdBitmap, is_vertical: bool, along: i32, across: i32) -> u32 {
    let (pixel, channel) = (along.div_euclid(3), along.rem_euclid(3) as usize);
    let [x, y] = if is_vertical { [across, pixel] } else { [pixel, across] };
    let found = index(bitmap.placement, [x, y]);
    found.map_or(0, |at| bitmap.pixels[at][channel].into())
}

#[test]
fn a_channel_is_the_glyph_moved_by_a_third_of_a_pixel() {
    for_all(|rasterizer, glyph, options| {
        // Further than that no glyph can be moved by hand.
        if options.offset()[1] > 1000.0 {
            return;
        }
        for (order, toward) in [(SubpixelOrder::Rgb, [1.0, 0.0]), (SubpixelOrder::VerticalRgb, [0.0, -1.0])] {
            let drawn = rasterizer.render_lcd(glyph, options, Lcd::new(order)).unwrap();
            for (channel, thirds) in [21.0, 0.0, -21.0].into_iter().enumerate() {
                let [x, y] = [0, 1].map(|axis| options.offset()[axis] + toward[axis] * thirds / 64.0);
                let moved = rasterizer.render(glyph, options.with_offset([x, y])).unwrap();
                let plane = drawn.pixels.iter().map(|pixel| pixel[channel]).collect();
                let plane = Bitmap { placement: drawn.placement, pixels: plane };
                for at in pixels(&plane).chain(pixels(&moved)) {
                    assert_eq!(grey(&plane, at), grey(&moved, at), "glyph {glyph}, {options:?}");
                }
            }
        }
    });
}

/// The pixels of a bitmap, counted from the origin, x to the right and y down.
fn pixels(bitmap: &Bitmap) -> impl Iterator<Item = [i32; 2]> + use<> {
    let place = bitmap.placement;
    let rows = -place.top..place.height as i32 - place.top;
    rows.flat_map(move |y| (place.left..place.left + place.width as i32).map(move |x| [x, y]))
}

#[test]
fn the_subpixels_of_a_pixel_cover_together_what_the_pixel_covers() {
    for_all(|rasterizer, glyph, options| {
        let whole = rasterizer.render(glyph, options).unwrap();
        for order in [SubpixelOrder::Rgb, SubpixelOrder::VerticalRgb] {
            let lcd = Lcd::new(order).with_filter(LcdFilter::Unfiltered);
            let drawn = rasterizer.render_lcd(glyph, options, lcd).unwrap();
            assert!(drawn.pixels.iter().any(|[r, g, b]| r != g || g != b));
            let means = drawn.pixels.iter().map(|p| (p.iter().map(|v| u32::from(*v)).sum::<u32>() / 3) as u8);
            let means = Bitmap { placement: drawn.placement, pixels: means.collect() };
            let off = |at| grey(&whole, at).abs_diff(grey(&means, at));
            let most = pixels(&whole).chain(pixels(&means)).map(off).max();
            assert!(most <= Some(FINER_CURVES), "glyph {glyph}, {options:?}: {most:?} levels");
            let sum: u32 = pixels(&means).map(|at| u32::from(off(at))).sum();
            assert!(
                sum as usize <= FINER_ON_AVERAGE * means.pixels.len(),
                "glyph {glyph}, {options:?}: {sum} levels"
            );
        }
    });
}

#[test]
fn filters_weigh_the_subpixels_around_one() {
    for_all(|rasterizer, glyph, options| {
        for (order, is_vertical) in [(SubpixelOrder::Rgb, false), (SubpixelOrder::VerticalRgb, true)] {
            let lcd = Lcd::new(order);
            let bare = lcd.with_filter(LcdFilter::Unfiltered);
            let bare = rasterizer.render_lcd(glyph, options, bare).unwrap();
            let filters = [(LcdFilter::Light, [0, 85, 86, 85, 0]), (LcdFilter::Fir5, [8, 77, 86, 77, 8])];
            for (filter, weights) in filters {
                let drawn = rasterizer.render_lcd(glyph, options, lcd.with_filter(filter)).unwrap();
                let place = drawn.placement;
                let [columns, rows] = [place.left..place.left + place.width as i32, 0..place.height as i32];
                let rows = rows.start - place.top..rows.end - place.top;
                let (along, across) = if is_vertical { (rows, columns) } else { (columns, rows) };
                for across in across {
                    // A subpixel outside of the bitmap shows nothing.
                    for at in along.start * 3 - 2..along.end * 3 + 2 {
                        let near = (-2..=2).map(|k| subpixel(&bare, is_vertical, at + k, across));
                        let sum: u32 = near.zip(weights).map(|(level, weight)| level * weight).sum();
                        let level = subpixel(&drawn, is_vertical, at, across);
                        assert_eq!(level, sum >> 8, "glyph {glyph}, {options:?}, {lcd:?}");
                    }
                }
            }
        }
    });
}

#[test]
fn a_panel_whose_blue_comes_first_has_the_channels_the_other_way_round() {
    for_all(|rasterizer, glyph, options| {
        for filter in FILTERS {
            for (order, reversed) in [
                (SubpixelOrder::Rgb, SubpixelOrder::Bgr),
                (SubpixelOrder::VerticalRgb, SubpixelOrder::VerticalBgr),
            ] {
                let [there, back] = [order, reversed].map(|order| {
                    rasterizer.render_lcd(glyph, options, Lcd::new(order).with_filter(filter)).unwrap()
                });
                assert_eq!(there.placement, back.placement);
                assert!(there.pixels.iter().zip(&back.pixels).all(|([r, g, b], back)| [*b, *g, *r] == *back));
            }
        }
    });
}

#[test]
fn what_cannot_be_drawn_is_the_error_that_grey_drawing_gives() {
    let font = font("outline");
    let (g, space) = (font.glyph_for_char('g').unwrap(), font.glyph_for_char(' '));
    for lcd in FILTERS.map(|filter| Lcd::default().with_filter(filter)) {
        let mut rasterizer = Rasterizer::new(&font);
        assert_eq!(rasterizer.draw_lcd(g, 0.0, lcd), Err(Error::InvalidSize(0.0)));
        let far = DrawOptions::new(16.0).with_offset([1024.5, 0.0]);
        assert_eq!(rasterizer.draw_lcd(g, far, lcd), Err(Error::InvalidOffset(1024.5)));
        assert_eq!(rasterizer.draw_lcd(99_999, 16.0, lcd), Err(Error::NoSuchGlyph(99_999)));
        if let Some(space) = space {
            assert_eq!(rasterizer.render_lcd(space, 16.0, lcd), Ok(LcdBitmap::default()));
        }
        let mut limits = Limits::default();
        limits.bitmap_side = 10;
        let drawn = rasterizer.with_limits(limits).render_lcd(g, 16.0, lcd);
        assert!(matches!(drawn, Err(Error::BitmapTooLarge { limit: 10, .. })), "{drawn:?}");
        let bare = nfr::Font::new(without_models(&bytes("outline"))).unwrap();
        let drawn = Rasterizer::new(&bare).render_lcd(g, 16.0, lcd);
        assert_eq!(drawn, Err(Error::MissingModel(g)));
        let mut blank = Rasterizer::new(&bare).with_missing_model(MissingModel::Blank);
        assert_eq!(blank.render_lcd(g, 16.0, lcd), Ok(LcdBitmap::default()));
    }
}

#[cfg(feature = "networks")]
#[test]
fn a_network_has_no_subpixels() {
    let font = font("network");
    let a = font.glyph_for_char('a').unwrap();
    for lcd in FILTERS.map(|filter| Lcd::default().with_filter(filter)) {
        let drawn = Rasterizer::new(&font).render_lcd(a, 20.0, lcd);
        assert_eq!(drawn, Err(Error::NetworkSubpixels(a)));
    }
}
