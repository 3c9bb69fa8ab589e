//! What an application uses: ways of drawing, limits, metrics, and what is an error.

use std::sync::Arc;

use nfr::{Bitmap, DrawOptions, Error, Font, Limits, MissingModel, Placement, Rasterizer, Target};

use crate::samples::{bytes, font, table, without_models};

/// Whole and fractional sizes, within the trained range and beyond it.
const PPEM: [f32; 12] = [0.5, 3.0, 7.5, 8.0, 10.9, 11.0, 15.5, 31.9, 50.25, 64.0, 68.0, 256.0];

/// Glyphs with round, straight and slanted parts, composed ones and a blank.
const TEXT: &str = "ag8@W.é ";

fn glyphs(font: &Font) -> Vec<u32> {
    TEXT.chars().map(|c| font.glyph_for_char(c).unwrap()).collect()
}

#[test]
fn all_ways_of_drawing_agree() {
    for name in ["sans", "serif", "mono"] {
        let font = font(name);
        let mut rasterizer = Rasterizer::new(&font);
        for (glyph, ppem) in glyphs(&font).into_iter().flat_map(|glyph| PPEM.map(|ppem| (glyph, ppem))) {
            let options = DrawOptions::new(ppem).with_offset([0.25, -0.5]);
            let bitmap = rasterizer.render(glyph, options).unwrap();
            assert_eq!(bitmap.pixels.len(), bitmap.placement.area());
            assert_eq!(rasterizer.placement(glyph, options), Ok(bitmap.placement));
            assert_eq!(Bitmap::from(rasterizer.draw(glyph, options).unwrap()), bitmap);
            let (width, height) = (bitmap.placement.width as usize, bitmap.placement.height as usize);
            for pitch in [width, width + 5] {
                let mut pixels = vec![7; pitch * height + 3];
                assert_eq!(rasterizer.render_into(glyph, options, &mut pixels, pitch), Ok(bitmap.placement));
                let mut expected = vec![7; pitch * height + 3];
                for (row, drawn) in expected.chunks_mut(pitch.max(1)).zip(bitmap.rows()) {
                    row[..width].copy_from_slice(drawn);
                }
                assert_eq!(pixels, expected, "{name}: glyph {glyph} at {ppem} ppem, rows {pitch} apart");
            }
            let mut atlas = vec![0; 1 << 17];
            let placed = rasterizer.render_with(glyph, options, |placement| {
                assert_eq!(placement, bitmap.placement);
                Some((&mut atlas, width))
            });
            assert_eq!(placed, Ok(Some(bitmap.placement)));
            assert_eq!(atlas[..bitmap.pixels.len()], bitmap.pixels);
        }
    }
}

#[test]
fn nothing_is_drawn_where_there_is_no_room() {
    let font = font("sans");
    let mut rasterizer = Rasterizer::new(&font);
    let glyph = font.glyph_for_char('g').unwrap();
    assert_eq!(rasterizer.render_with(glyph, 20.0, |_| None), Ok(None));
    let placement = rasterizer.placement(glyph, 20.0).unwrap();
    let (width, height) = (placement.width as usize, placement.height as usize);
    for (pitch, length) in
        [(width, width * height - 1), (width - 1, 4000), (width + 1, width * height), (0, 4000)]
    {
        let mut pixels = vec![7; length];
        let error = rasterizer.render_into(glyph, 20.0, &mut pixels, pitch).unwrap_err();
        assert_eq!(error, Error::BufferTooSmall { placement, pitch, length });
        assert!(pixels.iter().all(|pixel| *pixel == 7));
    }
    // The last row needs no more than its pixels.
    let mut pixels = vec![0; (height - 1) * 100 + width];
    assert!(rasterizer.render_into(glyph, 20.0, &mut pixels, 100).is_ok());
    let blank = font.glyph_for_char(' ').unwrap();
    assert_eq!(rasterizer.render_into(blank, 20.0, &mut [], 0), Ok(Placement::default()));
}

#[test]
fn a_font_owns_or_shares_its_bytes() {
    let data = bytes("sans");
    let shared: Arc<[u8]> = data.clone().into();
    let leaked: &'static [u8] = data.clone().leak();
    let fonts = [Font::new(data.clone()), Font::new(leaked), Font::new(shared)];
    let fonts = fonts.map(|font| font.unwrap());
    drop(data);
    let glyph = fonts[0].glyph_for_char('a').unwrap();
    let drawn = fonts.clone().map(|font| Rasterizer::new(&font).render(glyph, 13.0).unwrap());
    assert!(drawn.iter().all(|bitmap| *bitmap == drawn[0]));
    assert!(fonts.iter().all(|font| font.data() == fonts[0].data()));
}

#[test]
fn threads_that_share_a_font_draw_the_same() {
    let font = font("sans");
    let draw = |font: Font| {
        let mut rasterizer = Rasterizer::new(&font);
        let all = glyphs(&font).into_iter().flat_map(|glyph| PPEM.map(|ppem| (glyph, ppem)));
        all.map(|(glyph, ppem)| rasterizer.render(glyph, ppem).unwrap()).collect::<Vec<_>>()
    };
    let alone = draw(font.clone());
    let threads: Vec<_> =
        (0..4).map(|_| font.clone()).map(|font| std::thread::spawn(move || draw(font))).collect();
    for thread in threads {
        assert!(thread.join().unwrap() == alone);
    }
}

#[test]
fn a_cache_of_any_size_draws_the_same() {
    let font = font("sans");
    let draw = |bytes: usize| {
        let mut rasterizer = Rasterizer::new(&font).with_cache(bytes);
        let mut order: Vec<u32> = glyphs(&font);
        order.extend(order.clone().iter().rev());
        let sizes = order.into_iter().flat_map(|glyph| [9.0, 33.0].map(|ppem| (glyph, ppem)));
        sizes.map(|(glyph, ppem)| rasterizer.render(glyph, ppem).unwrap()).collect::<Vec<_>>()
    };
    let unlimited = draw(usize::MAX);
    for bytes in [0, 1, 10_000, 20_000, 50_000] {
        assert!(draw(bytes) == unlimited, "a cache of {bytes} bytes");
    }
}

#[test]
fn sizes_and_offsets_that_make_no_sense_are_errors() {
    let font = font("sans");
    let mut rasterizer = Rasterizer::new(&font);
    let far = DrawOptions::MAX_OFFSET * (1.0 + f32::EPSILON);
    for glyph in glyphs(&font) {
        for ppem in [0.0, -0.0, -1.0, 2049.0, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            let errors = [
                rasterizer.render(glyph, ppem).err(),
                rasterizer.placement(glyph, ppem).err(),
                rasterizer.draw(glyph, ppem).err(),
                rasterizer.render_into(glyph, ppem, &mut [0; 9], 3).err(),
            ];
            for error in errors {
                let is = |size: f32| size == ppem || size.is_nan() && ppem.is_nan();
                assert!(matches!(error, Some(Error::InvalidSize(size)) if is(size)), "{ppem}: {error:?}");
            }
        }
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, far, -far, f32::MAX] {
            for offset in [[bad, 0.0], [0.0, bad]] {
                let error = rasterizer.render(glyph, DrawOptions::new(16.0).with_offset(offset)).err();
                assert!(matches!(error, Some(Error::InvalidOffset(_))), "{offset:?}: {error:?}");
            }
        }
        let most = DrawOptions::MAX_OFFSET;
        for offset in [[most, -most], [-most, most], [f32::MIN_POSITIVE, -0.0]] {
            assert!(rasterizer.render(glyph, DrawOptions::new(16.0).with_offset(offset)).is_ok());
        }
        for ppem in [f32::MIN_POSITIVE, f32::from_bits(1), 1e-10, 0.01, 2048.0] {
            assert!(rasterizer.render(glyph, ppem).is_ok(), "glyph {glyph} at {ppem} ppem");
        }
    }
}

#[test]
fn a_whole_offset_moves_the_placement_and_changes_no_pixel() {
    let font = font("sans");
    let mut rasterizer = Rasterizer::new(&font);
    for glyph in font.modelled_glyphs() {
        for (ppem, [x, y]) in
            [(9.0, [0.0; 2]), (12.3, [0.25, 0.5]), (50.0, [-0.125, 0.0]), (130.0, [0.5, 0.75])]
        {
            let mut at =
                |offset| rasterizer.render(glyph, DrawOptions::new(ppem).with_offset(offset)).unwrap();
            let here = at([x, y]);
            for [right, up] in [[1, 0], [-3, 7], [1023, -1023]] {
                let there = at([x + right as f32, y + up as f32]);
                assert_eq!(there.pixels, here.pixels, "glyph {glyph} at {ppem} ppem");
                let Placement { left, top, .. } = here.placement;
                let moved = Placement { left: left + right, top: top + up, ..here.placement };
                let blank = here.pixels.is_empty();
                assert_eq!(there.placement, if blank { here.placement } else { moved });
            }
        }
    }
}

#[test]
fn a_glyph_that_the_font_does_not_have_is_an_error_whatever_is_drawn_for_missing_models() {
    let font = font("serif");
    for missing in [MissingModel::Error, MissingModel::Blank, MissingModel::Outline] {
        let mut rasterizer = Rasterizer::new(&font).with_missing_model(missing);
        for glyph in [font.glyph_count(), 65_535, 65_536, u32::MAX] {
            assert!(!font.has_model(glyph));
            assert_eq!(rasterizer.render(glyph, 16.0), Err(Error::NoSuchGlyph(glyph)));
            assert_eq!(font.advance(glyph, 16.0), 0.0);
        }
    }
    assert_eq!(font.model_len(9999), Err(Error::MissingModel(9999)));
}

#[test]
fn what_is_drawn_for_a_missing_model_is_chosen_at_run_time() {
    let font = Font::new(without_models(&bytes("serif"))).unwrap();
    assert_eq!(font.modelled_glyphs().len(), 0);
    let (g, blank) = (font.glyph_for_char('g').unwrap(), font.glyph_for_char(' ').unwrap());
    let with = |missing| Rasterizer::new(&font).with_missing_model(missing);
    assert_eq!(Rasterizer::new(&font).render(g, 16.0), Err(Error::MissingModel(g)));
    assert_eq!(with(MissingModel::Blank).render(g, 16.0), Ok(Bitmap::default()));
    assert_eq!(with(MissingModel::Blank).render(g, 0.0), Err(Error::InvalidSize(0.0)));
    let mut outlines = with(MissingModel::Outline);
    let drawn = outlines.render(g, 16.0).unwrap();
    assert!(drawn.pixels.contains(&255) || drawn.pixels.iter().any(|level| *level > 200));
    assert_eq!(Bitmap::from(outlines.draw(g, 16.0).unwrap()), drawn);
    assert_eq!(outlines.placement(g, 16.0), Ok(drawn.placement));
    assert_eq!(outlines.render(blank, 16.0), Ok(Bitmap::default()));
    assert_eq!(outlines.render(g, f32::NAN).map_err(|e| matches!(e, Error::InvalidSize(_))), Err(true));
    let far = DrawOptions::new(16.0).with_offset([f32::INFINITY, 0.0]);
    assert_eq!(outlines.render(g, far), Err(Error::InvalidOffset(f32::INFINITY)));
}

#[test]
fn a_damaged_model_is_an_error_whatever_is_drawn_for_missing_ones() {
    let mut data = bytes("serif");
    let range = table(&data, b"Nfrt");
    let font = Font::new(data.clone()).unwrap();
    let g = font.glyph_for_char('g').unwrap();
    // All packed models become zeros.
    let payload = range.start + 52 + 4 * font.modelled_glyphs().len();
    data[payload + 500..range.end].fill(0);
    let font = Font::new(data).unwrap();
    for missing in [MissingModel::Error, MissingModel::Blank, MissingModel::Outline] {
        let error = Rasterizer::new(&font).with_missing_model(missing).render(g, 16.0).unwrap_err();
        assert!(matches!(error, Error::MalformedModel { .. } | Error::ModelTooLarge { .. }), "{error:?}");
    }
}

#[test]
fn a_glyph_that_is_in_the_table_twice_is_an_error_in_any_order_of_drawing() {
    let mut data = bytes("sans");
    let range = table(&data, b"Nfrt");
    let at = |offset: usize| range.start + offset;
    let number = |data: &[u8], at: usize| u16::from_be_bytes([data[at], data[at + 1]]);
    // The first composed glyph takes the number of a glyph that has a model of its own, which it has as a part.
    let count = usize::from(number(&data, at(10)));
    let payload = u32::from_be_bytes(data[at(28)..at(32)].try_into().unwrap()) as usize;
    let composed = at(52 + 4 * count + 4 * count.div_ceil(64) + payload);
    let twice = number(&data, at(52));
    data[composed..composed + 2].copy_from_slice(&twice.to_be_bytes());
    let font = Font::new(data).unwrap();
    for order in [vec![u32::from(twice)], font.modelled_glyphs().collect::<Vec<_>>()] {
        let mut rasterizer = Rasterizer::new(&font);
        let errors: Vec<_> = order.iter().filter_map(|glyph| rasterizer.render(*glyph, 16.0).err()).collect();
        assert!(
            errors.contains(&Error::MalformedModel { glyph: twice.into(), what: "is in the table twice" })
        );
    }
}

#[test]
fn every_limit_can_be_lowered() {
    let font = font("sans");
    let g = font.glyph_for_char('g').unwrap();
    let with = |change: fn(&mut Limits)| {
        let mut limits = Limits::default();
        change(&mut limits);
        Rasterizer::new(&font).with_limits(limits)
    };
    assert!(with(|_| ()).render(g, 2048.0).is_ok(), "the default limits draw the largest size");
    let mut small = with(|limits| limits.bitmap_side = 20);
    assert!(small.render(g, 16.0).is_ok());
    assert!(matches!(small.render(g, 40.0), Err(Error::BitmapTooLarge { limit: 20, .. })));
    assert!(matches!(small.placement(g, 40.0), Err(Error::BitmapTooLarge { .. })));
    let error = with(|limits| limits.decoded_bytes = 1000).render(g, 16.0).unwrap_err();
    assert!(
        matches!(error, Error::DecodedTooLarge { glyph, bytes, limit: 1000 } if glyph == g && bytes > 1000)
    );
    let mut lazy = with(|limits| limits.work = 20_000);
    assert!(lazy.render(g, 12.0).is_ok());
    assert!(matches!(lazy.render(g, 400.0), Err(Error::TooMuchWork { limit: 20_000, .. })));
    assert!(lazy.render(g, 12.0).is_ok(), "a drawing that was given up does no harm");
    // A limit above the most changes nothing.
    let mut large = with(|limits| limits.bitmap_side = u32::MAX);
    assert_eq!(large.render(g, 16.0), Rasterizer::new(&font).render(g, 16.0));
}

#[test]
fn limits_hold_for_plain_outlines_too() {
    let font = Font::new(without_models(&bytes("serif"))).unwrap();
    let g = font.glyph_for_char('g').unwrap();
    let mut limits = Limits::default();
    (limits.bitmap_side, limits.work) = (100, 20_000);
    let mut rasterizer = Rasterizer::new(&font).with_limits(limits).with_missing_model(MissingModel::Outline);
    assert!(rasterizer.render(g, 16.0).is_ok());
    assert!(matches!(rasterizer.render(g, 400.0), Err(Error::BitmapTooLarge { limit: 100, .. })));
    assert!(matches!(rasterizer.render(g, 100.0), Err(Error::TooMuchWork { .. })));
}

#[test]
fn the_font_tells_what_it_was_made_for() {
    let font = font("serif");
    assert_eq!((font.ppem_range(), font.target(), font.units_per_em()), ((10, 40), Target::Smooth, 2048));
    assert!(font.outlines_match() && !font.outlines_dropped());
    assert!(crate::samples::font("sans").outlines_dropped());
    assert_eq!(crate::samples::font("mono").target(), Target::Mono);
    let all: Vec<u32> = font.modelled_glyphs().collect();
    assert!(all.is_sorted() && all.len() == font.modelled_glyphs().len());
    assert!(all.iter().all(|glyph| font.has_model(*glyph) && font.model_len(*glyph).unwrap() > 0));
    assert!(all.iter().map(|glyph| font.model_len(*glyph).unwrap()).sum::<usize>() < font.table_len());
}

#[test]
fn metrics_are_those_of_the_font_and_linear() {
    let font = font("serif");
    // `hhea`: 1825, -443, 87; `post`: -123, 100, of 2048 units per em; 'a' is 909 units wide.
    let units = |pixels: f32, ppem: f32| (pixels * 2048.0 / ppem).round() as i32;
    for ppem in [9.0, 16.5, 100.0] {
        let line = font.line_metrics(ppem);
        let found =
            [line.ascent, line.descent, line.line_gap, line.underline_position, line.underline_thickness];
        assert_eq!(found.map(|pixels| units(pixels, ppem)), UNITS);
        assert_eq!(units(font.advance(font.glyph_for_char('a').unwrap(), ppem), ppem), 909);
    }
}

#[test]
fn a_line_is_the_one_that_the_font_asks_for() {
    let data = bytes("serif");
    let (hhea, os2) = (table(&data, b"hhea").start, table(&data, b"OS/2").start);
    // `hhea`: ascender, descender, line gap; `OS/2`: fsSelection, and its two lines.
    let zeroed = [hhea + 4..hhea + 8, os2 + 68..os2 + 74, os2 + 74..os2 + 78];
    for (typo, zeros) in [false, true].into_iter().flat_map(|typo| (0..8).map(move |zeros| (typo, zeros))) {
        let mut data = data.clone();
        data[os2 + 63] = if typo { data[os2 + 63] | 0x80 } else { data[os2 + 63] & 0x7f };
        for (_, range) in (0..).zip(&zeroed).filter(|(k, _)| zeros >> k & 1 == 1) {
            data[range.clone()].fill(0);
        }
        let twin = read_fonts::model::Font::new(data.clone(), 0).unwrap().metrics().h_line().unwrap();
        let twin = [twin.ascender, twin.descender, twin.line_gap].map(|units| units.to_f32());
        let line = Font::new(data).unwrap().line_metrics(2048.0);
        assert_eq!([line.ascent, line.descent, line.line_gap], twin, "typographic: {typo}, zeros: {zeros:b}");
    }
}

/// Ascent, descent, line gap, and the underline's position and thickness of Liberation Serif.
const UNITS: [i32; 5] = [1825, -443, 87, -123, 100];

#[test]
fn characters_are_those_of_the_character_map() {
    let font = font("sans");
    let characters: Vec<(char, u32)> = font.characters().collect();
    assert!(characters.iter().all(|(c, glyph)| font.glyph_for_char(*c) == Some(*glyph)));
    assert!(TEXT.chars().all(|c| characters.iter().any(|(other, _)| *other == c)));
    assert_eq!(font.glyph_for_char('\u{1F600}'), None);
}

#[cfg(not(feature = "fields"))]
#[test]
fn a_glyph_of_a_field_says_what_this_build_lacks() {
    for name in ["sans", "mono"] {
        let font = font(name);
        for glyph in "gé".chars().map(|c| font.glyph_for_char(c).unwrap()) {
            let error = Rasterizer::new(&font).render(glyph, 20.0).unwrap_err();
            assert_eq!(error, Error::FieldsNotBuilt(glyph));
            assert!(error.to_string().contains("`fields`"));
        }
    }
}

#[cfg(not(feature = "networks"))]
#[test]
fn a_glyph_of_a_network_says_what_this_build_lacks() {
    let font = font("network");
    let glyph = font.glyph_for_char('a').unwrap();
    assert!(font.has_model(glyph));
    let error = Rasterizer::new(&font).render(glyph, 20.0).unwrap_err();
    assert_eq!(error, Error::NetworksNotBuilt(glyph));
    assert!(error.to_string().contains("`networks`"));
}
