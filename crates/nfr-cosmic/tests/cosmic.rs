//! Text of cosmic-text, drawn from models.
#![allow(clippy::unwrap_used)]

mod samples;

use cosmic_text::{
    Attrs, Buffer, CacheKey, CacheKeyFlags, Color, FontSystem, SubpixelBin, SwashCache, SwashContent,
    SwashImage,
};
use nfr::{DrawOptions, Error, Font, Rasterizer};
use nfr_cosmic::{NeuralFonts, RgbaCanvas};

use samples::{NEURAL, ORIGINAL, buffer, glyph_of, system, with_table};

const SIZES: [f32; 5] = [9.0, 11.0, 13.5, 16.0, 30.0];
const WIDTH: u32 = 400;
const BLACK: Color = Color::rgb(0, 0, 0);

fn as_it_is(attrs: Attrs<'_>) -> Attrs<'_> {
    attrs
}

fn keys(buffer: &Buffer) -> Vec<CacheKey> {
    let runs = buffer.layout_runs();
    runs.flat_map(|run| run.glyphs.iter().map(|glyph| glyph.physical((0.0, 0.0), 1.0).cache_key)).collect()
}

/// Black text on white, as [`NeuralFonts::draw`] draws it.
fn picture(neural: &mut NeuralFonts, buffer: &mut Buffer, fonts: &mut FontSystem) -> Vec<u8> {
    let mut pixels = vec![255; 4 * WIDTH as usize * 60];
    let mut canvas = RgbaCanvas::new(&mut pixels, WIDTH).with_origin(3, 2);
    neural.draw(buffer, fonts, &mut SwashCache::new(), BLACK, &mut canvas);
    pixels
}

/// The same as `Buffer::draw` draws it, with the images of a cache.
fn picture_from(cache: &mut SwashCache, buffer: &mut Buffer, fonts: &mut FontSystem) -> Vec<u8> {
    use nfr_cosmic::Canvas;
    let mut pixels = vec![255; 4 * WIDTH as usize * 60];
    let mut canvas = RgbaCanvas::new(&mut pixels, WIDTH).with_origin(3, 2);
    buffer
        .draw(fonts, cache, BLACK, |x, y, width, height, color| canvas.rectangle(x, y, width, height, color));
    pixels
}

fn parts(image: SwashImage) -> (SwashContent, [i32; 4], Vec<u8>) {
    let placement = image.placement;
    let box_ = [placement.left, placement.top, placement.width as i32, placement.height as i32];
    (image.content, box_, image.data)
}

#[test]
fn images_are_the_librarys_own_pixels() {
    let (mut fonts, mut neural) = (system(&NEURAL), NeuralFonts::new());
    let mut rasterizer = Rasterizer::new(&Font::new(NEURAL.as_slice()).unwrap());
    let (mut compared, mut offsets) = (0, 0);
    for size in SIZES {
        let buffer = buffer(&mut fonts, "bad cabbage, hail a gleaming cliff", size, as_it_is);
        for key in keys(&buffer).into_iter().filter(|key| key.glyph_id != glyph_of(&NEURAL, ',')) {
            let options = DrawOptions::new(size).with_offset([key.x_bin.as_float(), 0.0]);
            let Ok(own) = rasterizer.render(key.glyph_id.into(), options) else { continue };
            let (content, placement, pixels) = parts(neural.image(&mut fonts, key).unwrap());
            let at = [
                own.placement.left,
                own.placement.top,
                own.placement.width as i32,
                own.placement.height as i32,
            ];
            assert_eq!((content, placement, pixels), (SwashContent::Mask, at, own.pixels), "{key:?}");
            compared += 1;
            offsets += usize::from(key.x_bin != SubpixelBin::Zero);
        }
    }
    assert!(compared > 100 && offsets > 50, "{compared} {offsets}");
    assert!(neural.problems().is_empty());
}

#[test]
fn a_filled_cache_draws_what_the_canvas_shows() {
    let (mut fonts, mut neural) = (system(&NEURAL), NeuralFonts::new());
    for size in SIZES {
        let mut buffer = buffer(&mut fonts, "Hidden models: 12 glyphs", size, as_it_is);
        let mut cache = SwashCache::new();
        neural.fill(&mut buffer, &mut fonts, &mut cache);
        let filled = picture_from(&mut cache, &mut buffer, &mut fonts);
        assert!(filled == picture(&mut neural, &mut buffer, &mut fonts), "{size}");
        assert!(filled != picture_from(&mut SwashCache::new(), &mut buffer, &mut fonts), "{size}");
    }
}

#[test]
fn the_canvas_shows_the_coverage_at_its_place() {
    let (mut fonts, mut neural) = (system(&NEURAL), NeuralFonts::new());
    let mut buffer = buffer(&mut fonts, "k", 16.0, as_it_is);
    let pixels = picture(&mut neural, &mut buffer, &mut fonts);
    let baseline = buffer.layout_runs().next().unwrap().line_y as i32;
    let own = Rasterizer::new(&Font::new(NEURAL.as_slice()).unwrap())
        .render(glyph_of(&NEURAL, 'k').into(), 16.0)
        .unwrap();
    let mut expected = vec![255; pixels.len()];
    for (y, row) in own.rows().enumerate() {
        for (x, coverage) in row.iter().enumerate() {
            let x = (own.placement.left + 3) as usize + x;
            let y = (baseline - own.placement.top + 2) as usize + y;
            expected[4 * (y * WIDTH as usize + x)..][..3].fill(255 - coverage);
        }
    }
    assert!(pixels == expected);
}

#[test]
fn swash_draws_what_has_no_model() {
    let mut neural = NeuralFonts::new();
    // Letters without models among others, a font without any, and text that asks for unhinted or slanted glyphs.
    for (font, text, flags) in [
        (&NEURAL, "xyz", CacheKeyFlags::empty()),
        (&ORIGINAL, "abc", CacheKeyFlags::empty()),
        (&NEURAL, "abc", CacheKeyFlags::DISABLE_HINTING),
        (&NEURAL, "abc", CacheKeyFlags::FAKE_ITALIC),
    ] {
        neural.clear();
        let mut fonts = system(font);
        let mut buffer = buffer(&mut fonts, text, 14.0, |attrs| attrs.cache_key_flags(flags));
        assert!(
            keys(&buffer).into_iter().all(|key| neural.image(&mut fonts, key).is_none()),
            "{text} {flags:?}"
        );
        let swash = picture_from(&mut SwashCache::new(), &mut buffer, &mut fonts);
        assert!(picture(&mut neural, &mut buffer, &mut fonts) == swash, "{text} {flags:?}");
        assert!(swash.contains(&0) && neural.problems().is_empty());
    }
}

#[test]
fn a_pixel_font_is_drawn_at_whole_pixels() {
    let (mut fonts, mut neural) = (system(&NEURAL), NeuralFonts::new());
    let key = keys(&buffer(&mut fonts, "g", 16.0, as_it_is))[0];
    let mut image = |x_bin, flags| parts(neural.image(&mut fonts, CacheKey { x_bin, flags, ..key }).unwrap());
    let whole = image(SubpixelBin::Zero, CacheKeyFlags::empty());
    assert_eq!(image(SubpixelBin::One, CacheKeyFlags::PIXEL_FONT), whole);
    let mut next = image(SubpixelBin::Two, CacheKeyFlags::PIXEL_FONT);
    next.1[0] -= 1;
    assert_eq!(next, whole);
    assert_ne!(image(SubpixelBin::One, CacheKeyFlags::empty()), whole);
}

#[test]
fn coloured_glyphs_stay_coloured() {
    let a = glyph_of(&NEURAL, 'a');
    // COLR, version 0: one base glyph with one layer, in the colour of the text.
    let words = [0, 1, 0, 14, 0, 20, 1, a, 0, 1, a, 0xFFFF];
    let font =
        with_table(&NEURAL, b"COLR", |colr| *colr = words.into_iter().flat_map(u16::to_be_bytes).collect());
    let (mut fonts, mut neural) = (system(&font), NeuralFonts::new());
    let keys = keys(&buffer(&mut fonts, "ab", 16.0, as_it_is));
    let drawn: Vec<bool> = keys.into_iter().map(|key| neural.image(&mut fonts, key).is_some()).collect();
    assert_eq!(drawn, [false, true]);
    assert!(neural.problems().is_empty());
}

#[test]
fn damaged_and_stale_models_are_reported_once_and_left_to_swash() {
    let damaged = with_table(&NEURAL, b"Nfrt", |table| {
        let end = table.len();
        table[end / 2..end].iter_mut().for_each(|byte| *byte ^= 0x5A);
    });
    let unreadable = with_table(&NEURAL, b"Nfrt", |table| table.truncate(30));
    let stale = with_table(&NEURAL, b"hmtx", |hmtx| {
        hmtx.chunks_mut(4).for_each(|metrics| metrics[1] ^= 1);
    });
    for font in [damaged, unreadable, stale.clone()] {
        let (mut fonts, mut neural) = (system(&font), NeuralFonts::new());
        let mut buffer = buffer(&mut fonts, "abcdef abcdef", 14.0, as_it_is);
        let drawn = picture(&mut neural, &mut buffer, &mut fonts);
        assert!(drawn == picture_from(&mut SwashCache::new(), &mut buffer, &mut fonts));
        assert_eq!(neural.problems().len(), 1);
    }
    let (mut fonts, mut neural) = (system(&stale), NeuralFonts::new());
    let key = keys(&buffer(&mut fonts, "a", 14.0, as_it_is))[0];
    assert!(neural.image(&mut fonts, key).is_none());
    assert_eq!(neural.problems()[0].font, key.font_id);
    assert_eq!(neural.problems()[0].error, Error::StaleModel(key.glyph_id.into()));
}

#[test]
fn sizes_that_nothing_can_be_drawn_at_are_left_to_swash() {
    let (mut fonts, mut neural) = (system(&NEURAL), NeuralFonts::new());
    let key = keys(&buffer(&mut fonts, "a", 14.0, as_it_is))[0];
    for size in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e9] {
        let key = CacheKey { font_size_bits: size.to_bits(), ..key };
        assert!(neural.image(&mut fonts, key).is_none());
    }
}
