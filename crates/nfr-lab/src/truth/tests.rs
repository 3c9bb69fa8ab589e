//! The rule and its bitmaps, against FreeType.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::rc::Rc;

use freetype::face::LoadFlag;
use freetype::{Face, RenderMode};
use nfr_convert::compare::picture::check_close;
use nfr_convert::open::owned;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

use super::*;

/// As between the teacher and FreeType: the two cut curves at different places.
const RASTERISER_DIFFERENCE: u8 = 16;
/// Where two contours overlap in a pixel, the parts of it that they cover add up: two equal halves to a whole instead of
/// a half. FreeType works such pixels out more finely in glyphs that are marked as overlapping, as Roboto's are.
const OVERLAP_DIFFERENCE: u8 = 128;

fn font(name: &str) -> Vec<u8> {
    fs::read(format!("{}/../../fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn glyphs(font: &FontRef<'_>, set: &str) -> Vec<(char, u16)> {
    let font = owned(font).unwrap();
    set.chars().map(|c| (c, font.charmap().map_unicode(c).unwrap().to_u32() as u16)).collect()
}

fn gids(glyphs: &[(char, u16)]) -> Vec<u16> {
    glyphs.iter().map(|(_, gid)| *gid).collect()
}

/// The box of FreeType's hinted metrics, in pixels.
fn freetype_bounds(face: &Face, gids: &[u16], point_size: u32, resolution: u32) -> [i32; 4] {
    face.set_char_size(0, point_size as isize * 64, resolution, resolution).unwrap();
    gids.iter().fold([0; 4], |all, &gid| {
        face.load_glyph(gid.into(), LoadFlag::TARGET_NORMAL | LoadFlag::NO_BITMAP).unwrap();
        let metrics = face.glyph().metrics();
        let (left, top) = (metrics.horiBearingX / 64, metrics.horiBearingY / 64);
        let (right, bottom) = (left + metrics.width / 64, top - metrics.height / 64);
        [all[0].min(left as i32), all[1].min(bottom as i32), all[2].max(right as i32), all[3].max(top as i32)]
    })
}

/// The rule once more, asking FreeType at every step.
fn freetype_search(face: &Face, gids: &[u16], side: i32) -> (u32, u32) {
    let fits = |point_size, resolution| {
        let [x_min, y_min, x_max, y_max] = freetype_bounds(face, gids, point_size, resolution);
        x_max - x_min <= side && y_max - y_min <= side
    };
    let point_size = (1..).find(|&size| !fits(size, 72)).unwrap() - 1;
    let resolution = (73..).find(|&resolution| !fits(point_size, resolution)).unwrap() - 1;
    (point_size, resolution)
}

#[test]
fn the_sizes_and_bitmaps_are_those_that_freetype_finds() {
    let ascii: String = ('!'..='~').collect();
    for (name, set, bound) in [
        ("LiberationSans-Regular", "abcdefghijklmnopqrstuvwxyz", RASTERISER_DIFFERENCE),
        ("LiberationSerif-Regular", ascii.as_str(), RASTERISER_DIFFERENCE),
        ("DejaVuSans", "abcdefghijklmnopqrstuvwxyz", RASTERISER_DIFFERENCE),
        ("Roboto_700Bold", "abcdefghijklmnopqrstuvwxyz", OVERLAP_DIFFERENCE),
    ] {
        let data = font(name);
        let file = FontRef::new(&data).unwrap();
        let gids = gids(&glyphs(&file, set));
        let truth = Truth::new(&file, &gids, 20..=63).unwrap();
        assert!(truth.sizes.iter().map(|size| size.side).eq(20..=63));
        let face = freetype::Library::init().unwrap().new_memory_face(Rc::new(data.clone()), 0).unwrap();
        for (index, size) in truth.sizes.iter().enumerate() {
            let found = freetype_search(&face, &gids, size.side as i32);
            assert_eq!((size.point_size, size.resolution), found, "{name}, {}", size.side);
            assert_eq!(size.bounds, freetype_bounds(&face, &gids, found.0, found.1), "{name}, {}", size.side);
            assert_eq!(face.size_metrics().unwrap().x_ppem, size.ppem);
            for &gid in &gids {
                face.load_glyph(gid.into(), LoadFlag::TARGET_NORMAL | LoadFlag::NO_BITMAP).unwrap();
                let slot = face.glyph();
                slot.render_glyph(RenderMode::Normal).unwrap();
                let name = format!("{name}, glyph {gid} in {}", size.side);
                let (ours, theirs) = (truth.bitmap(gid, index).unwrap(), bitmap(slot));
                assert_eq!(ours.placement, theirs.placement, "{name}");
                check_close(&name, &theirs, ours, bound).unwrap();
            }
        }
    }
}

/// FreeType's bitmap.
fn bitmap(slot: &freetype::GlyphSlot) -> Bitmap {
    let bitmap = slot.bitmap();
    let (width, height) = (bitmap.width() as u32, bitmap.rows() as u32);
    let placement = Placement { left: slot.bitmap_left(), top: slot.bitmap_top(), width, height };
    let rows = bitmap.buffer().chunks(bitmap.pitch().max(1) as usize);
    Bitmap { placement, pixels: rows.flat_map(|row| row[..width as usize].to_vec()).collect() }
}

fn size(side: usize, bounds: [i32; 4]) -> TruthSize {
    TruthSize { side, point_size: 1, resolution: 72, ppem: 1, bounds }
}

#[test]
fn a_bitmap_stands_right_of_the_origin_and_above_the_baseline() {
    // The box reaches 1 left of the origin and 2 above the baseline; the bitmap starts 1 right and 1 above.
    let placement = Placement { left: 1, top: 1, width: 1, height: 2 };
    let bitmap = Bitmap { placement, pixels: vec![7, 8] };
    let size = size(4, [-1, -1, 2, 2]);
    assert_eq!((size.origin(), size.corner(&placement)), ([1, 2], [2, 1]));
    let rows = [[0, 0, 0, 0], [0, 0, 7, 0], [0, 0, 8, 0], [0, 0, 0, 0]];
    assert_eq!(size.square(&bitmap).pixels, rows.concat());
}

#[test]
fn what_sticks_out_of_the_box_is_cut_off() {
    let placement = Placement { left: -1, top: 3, width: 3, height: 3 };
    let bitmap = Bitmap { placement, pixels: (1..=9).collect() };
    assert_eq!(size(2, [0, 0, 2, 2]).square(&bitmap).pixels, [5, 6, 8, 9]);
}

#[test]
fn hints_make_a_difference_and_every_hinted_glyph_is_whole() {
    let data = font("LiberationSans-Regular");
    let file = FontRef::new(&data).unwrap();
    let set = gids(&glyphs(&file, "go"));
    let truth = Truth::new(&file, &set, 20..=22).unwrap();
    assert!(truth.warnings.is_empty());
    for (index, gid) in (0..3).flat_map(|index| set.iter().map(move |gid| (index, *gid))) {
        let ink = |pixels: &[u8]| pixels.iter().map(|&p| u64::from(p)).sum::<u64>();
        let square = truth.hinted(gid, index).unwrap();
        assert_eq!(ink(&square.pixels), ink(&truth.bitmap(gid, index).unwrap().pixels));
        assert_ne!(square, truth.plain(gid, index).unwrap());
    }
}

#[test]
fn a_set_without_ink_and_a_box_that_nothing_fits_are_refused() {
    let data = font("LiberationSans-Regular");
    let file = FontRef::new(&data).unwrap();
    let refusal = |set: &str, side| {
        Truth::new(&file, &gids(&glyphs(&file, set)), side..=side).err().unwrap().to_string()
    };
    assert!(refusal("", 20).contains("no glyph of the set has ink"));
    assert!(refusal(" ", 20).contains("no glyph of the set has ink"));
    assert!(refusal("g", 0).contains("larger box"));
    assert!(refusal(".", 2000).contains("smaller box"));
}

#[test]
fn a_glyph_or_a_size_that_is_not_there_is_named() {
    let data = font("LiberationSans-Regular");
    let truth = Truth::new(&FontRef::new(&data).unwrap(), &[68], 20..=20).unwrap();
    assert!(truth.hinted(69, 0).unwrap_err().to_string().contains("glyph 69"));
    assert!(truth.hinted(68, 1).unwrap_err().to_string().contains("size 1"));
}

#[test]
fn a_font_that_allows_sizes_between_pixels_is_rounded_with_a_warning() {
    let data = font("LiberationSans-Regular");
    let original = FontRef::new(&data).unwrap();
    let head_tag = Tag::new(b"head");
    let mut head = original.table_data(head_tag).unwrap().as_bytes().to_vec();
    // The flags are the 16 bits from byte 16.
    head[17] &= !8;
    let mut builder = FontBuilder::new();
    builder.add_raw(head_tag, head).copy_missing_tables(original);
    let altered = builder.build();
    let truth = Truth::new(&FontRef::new(&altered).unwrap(), &[68], 20..=20).unwrap();
    assert!(truth.warnings.iter().any(|warning| warning.contains("nearest whole sizes")));
}

#[test]
fn a_stored_truth_is_whole_replaces_the_last_one_and_spares_other_files() {
    let data = font("LiberationSans-Regular");
    let file = FontRef::new(&data).unwrap();
    let set = glyphs(&file, "ag");
    let truth = Truth::new(&file, &gids(&set), 20..=21).unwrap();
    let parent = tempfile::tempdir().unwrap();
    let place = parent.path().join("truth");
    store(&truth, "Sans", &set, &place).unwrap();
    store(&truth, "Sans", &set, &place).unwrap();
    assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(place.join("manifest.json")).unwrap()).unwrap();
    assert_eq!((&manifest["font"], &manifest["set"]), (&"Sans".into(), &"ag".into()));
    let size = &manifest["sizes"][1];
    assert_eq!((&size["side"], &size["ppem"]), (&21.into(), &truth.sizes[1].ppem.into()));
    assert_eq!(size["files"]["U+0067"], "21/u0067.png");
    let picture = image::open(place.join("21/u0067.png")).unwrap().into_luma8();
    let ink: Vec<u8> = picture.into_raw().iter().map(|grey| 255 - grey).collect();
    assert_eq!(ink, truth.hinted(set[1].1, 1).unwrap().pixels);

    fs::write(parent.path().join("letter"), b"dear").unwrap();
    let error = store(&truth, "Sans", &set, parent.path()).unwrap_err().to_string();
    assert!(error.contains("other files"), "{error}");
}
