//! `nfr bake` as a person calls it; what it writes is read by FreeType, read-fonts, image, serde_json and a C compiler, and compared with
//! what the library draws.

use std::fs;
use std::process::Command;

use crate::baked::{Drawn, Expected, Strike, TEXT, freetype_strike, neural};
use crate::common::{Directory, nfr, nfr_convert, sans_with};
use image::GenericImageView;
use read_fonts::tables::bitmap::{BitmapContent, BitmapMetrics};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use serde_json::Value;
use write_fonts::FontBuilder;
use write_fonts::tables::cmap::Cmap;

const DEPTHS: [u8; 4] = [1, 2, 4, 8];

/// Bakes the converted font into a file of a new directory.
fn bake(name: &str, more: &[&str]) -> (Directory, String) {
    let directory = Directory::new();
    let output = directory.name(name);
    nfr(&[&["bake", neural(), &output], more].concat()).succeeds();
    (directory, output)
}

#[test]
fn freetype_and_read_fonts_find_the_librarys_bitmaps_in_the_font() {
    for bits in DEPTHS {
        let (_directory, output) = bake("out.ttf", &["--ppem", "8,12,16,40", "--bits", &bits.to_string()]);
        let data = fs::read(&output).unwrap();
        let face = freetype::Library::init().unwrap().new_memory_face(data.clone(), 0).unwrap();
        let mut expected = Expected::new(neural());
        for ppem in [8, 12, 16, 40] {
            let strike = expected.strike(ppem, bits);
            assert!(strike.len() > 30);
            face.set_pixel_sizes(0, ppem.into()).unwrap();
            let gids = strike.keys().copied();
            assert_eq!(freetype_strike(&face, gids), strike, "FreeType, {ppem} ppem, {bits} bits");
            assert_eq!(read_fonts_strike(&data, ppem), strike, "read-fonts, {ppem} ppem, {bits} bits");
        }
    }
}

/// What read-fonts finds in EBLC and EBDT.
fn read_fonts_strike(data: &[u8], ppem: u16) -> Strike {
    let font = FontRef::new(data).unwrap();
    let (eblc, ebdt) = (font.eblc().unwrap(), font.ebdt().unwrap());
    let size = eblc.bitmap_sizes().iter().find(|size| u16::from(size.ppem_y()) == ppem).unwrap();
    let gids = size.start_glyph_index().to_u32()..=size.end_glyph_index().to_u32();
    let located = gids.filter_map(|gid| {
        let location = size.location(eblc.offset_data(), gid.into()).ok()?;
        (!location.is_empty()).then_some((gid, location))
    });
    located
        .map(|(gid, location)| {
            let bitmap = ebdt.data(&location).unwrap();
            let BitmapMetrics::Small(metrics) = bitmap.metrics else { panic!("big metrics") };
            let BitmapContent::Data(_, bytes) = bitmap.content else { panic!("a composite") };
            let width = usize::from(metrics.width);
            let origin = (metrics.bearing_x.get().into(), metrics.bearing_y.get().into());
            let levels = crate::baked::unpacked(bytes, size.bit_depth(), width * usize::from(metrics.height));
            (gid, Drawn::new(levels, width, origin, metrics.advance.into()))
        })
        .collect()
}

#[test]
fn the_other_tables_stay_and_checksums_are_right() {
    let (_directory, output) = bake("out.ttf", &["--ppem", "12"]);
    let (before, after) = (fs::read(neural()).unwrap(), fs::read(&output).unwrap());
    let (before, after) = (FontRef::new(&before).unwrap(), FontRef::new(&after).unwrap());
    for record in before.table_directory().table_records() {
        let [old, new] =
            [&before, &after].map(|font| font.table_data(record.tag()).unwrap().as_bytes().to_vec());
        // What `head` says of the whole file differs.
        let adjustment = if record.tag() == Tag::new(b"head") { 8..12 } else { 0..0 };
        for (at, (old, new)) in old.iter().zip(&new).enumerate().filter(|(at, _)| !adjustment.contains(at)) {
            assert_eq!(old, new, "byte {at} of {}", record.tag());
        }
        assert_eq!(old.len(), new.len());
    }
    assert_eq!(after.table_directory().num_tables(), before.table_directory().num_tables() + 2);
    let sum = |bytes: &[u8]| {
        let word = |chunk: &[u8]| {
            chunk.iter().enumerate().fold(0, |word, (at, byte)| word | u32::from(*byte) << (24 - 8 * at))
        };
        bytes.chunks(4).map(word).fold(0, u32::wrapping_add)
    };
    assert_eq!(sum(&fs::read(&output).unwrap()), 0xb1b0_afba);
    for record in
        after.table_directory().table_records().iter().filter(|record| record.tag() != Tag::new(b"head"))
    {
        assert_eq!(sum(after.table_data(record.tag()).unwrap().as_bytes()), record.checksum());
    }
    // The models still draw.
    nfr(&["render", &output, "--text", "A", "--ppem", "12", "--json"]).succeeds();
}

#[test]
fn lines_are_as_high_as_the_fonts_and_baking_again_replaces() {
    let (directory, output) = bake("out.ttf", &["--ppem", "12,20"]);
    let again = directory.name("again.ttf");
    // Which sizes stand for others, too.
    let (data, mut scaled) = (fs::read(&output).unwrap(), FontBuilder::new());
    scaled.add_raw(Tag::new(b"EBSC"), vec![0, 2, 0, 0, 0, 0, 0, 0]);
    let output =
        directory.write("scaled.ttf", &scaled.copy_missing_tables(FontRef::new(&data).unwrap()).build());
    let run = nfr(&["bake", &output, &again, "--ppem", "16", "--bits", "4"]).succeeds();
    assert!(run.stderr.contains("bitmaps already (EBLC, EBDT, EBSC); they are replaced"), "{}", run.stderr);
    assert!(run.stdout.contains("EBLC") && run.stdout.contains("EBDT"), "{}", run.stdout);
    let data = fs::read(again).unwrap();
    let font = FontRef::new(&data).unwrap();
    assert!(font.table_data(Tag::new(b"EBSC")).is_none());
    let eblc = font.eblc().unwrap();
    let [size] = eblc.bitmap_sizes() else { panic!("{} sizes", eblc.num_sizes()) };
    let expected = Expected::new(neural()).strike(16, 4);
    let extreme = |value: fn(&Drawn) -> Option<i32>| {
        let values: Vec<i32> = expected.values().filter_map(value).collect();
        (*values.iter().min().unwrap(), *values.iter().max().unwrap())
    };
    let (left, top) = (extreme(Drawn::left), extreme(Drawn::top));
    let bottom = extreme(Drawn::bottom);
    // Liberation Sans: 1854 above and 434 below of 2048.
    let line = (size.hori.ascender(), size.hori.descender());
    assert_eq!(line, (14, -3));
    assert_eq!(i32::from(size.hori.min_origin_sb()), left.0);
    assert_eq!(i32::from(size.hori.max_before_bl()), top.1);
    assert_eq!(i32::from(size.hori.min_after_bl()), bottom.0);
    assert_eq!((size.ppem_x(), size.bit_depth()), (16, 4));
}

#[test]
fn a_font_of_strikes_alone_is_a_bitmap_font() {
    for (name, more) in [("out.otb", &[][..]), ("out.ttf", &["--strikes-only"])] {
        let (_directory, output) = bake(name, &[&["--ppem", "12"], more].concat());
        let data = fs::read(&output).unwrap();
        assert!(data.len() < fs::read(neural()).unwrap().len() / 2);
        let face = freetype::Library::init().unwrap().new_memory_face(data, 0).unwrap();
        assert!(face.has_fixed_sizes() && !face.is_scalable());
        face.select_size(0).unwrap();
        let strike = Expected::new(neural()).strike(12, 8);
        assert_eq!(freetype_strike(&face, strike.keys().copied()), strike);
    }
    nfr(&["bake", neural(), "out.bdf", "--ppem", "12", "--strikes-only"])
        .rejects_usage(&["--strikes-only", "ttf"]);
}

#[test]
fn freetype_reads_bdf_files_with_the_librarys_bitmaps() {
    for bits in DEPTHS {
        let (directory, _) =
            bake("out.bdf", &["--ppem", "12,33", "--bits", &bits.to_string(), "--text", TEXT]);
        assert_eq!(directory.files(), ["out_12.bdf", "out_33.bdf"]);
        let mut expected = Expected::new(neural());
        for ppem in [12, 33] {
            let data = fs::read(directory.path(&format!("out_{ppem}.bdf"))).unwrap();
            let face = freetype::Library::init().unwrap().new_memory_face(data.clone(), 0).unwrap();
            assert_eq!(face.family_name().unwrap(), "Liberation Sans");
            face.set_pixel_sizes(0, ppem.into()).unwrap();
            let strike = expected.characters(ppem, bits, TEXT);
            let glyphs = strike.keys().map(|code| face.get_char_index(*code as usize).unwrap());
            let read = freetype_strike(&face, glyphs);
            assert!(read.into_values().eq(strike.values().cloned()), "{ppem} ppem, {bits} bits");
            let text = String::from_utf8(data).unwrap();
            let depth = if bits > 1 { format!(" {bits}") } else { String::new() };
            let aring = "STARTCHAR eacute\nENCODING 233\nSWIDTH 556 0\nDWIDTH ";
            let size = format!("\nSIZE {ppem} 72 72{depth}\n");
            for part in
                ["STARTFONT 2.1\n", "\nFONT_ASCENT ", "\nFONT_DESCENT ", "\nDEFAULT_CHAR 32\n", aring, &size]
            {
                assert!(text.contains(part), "{part:?} is not in {text}");
            }
        }
    }
}

/// A converted font of A, the glyph of which is Greek's capital alpha, too, and .notdef.
fn with_two_characters_of_a_glyph(directory: &Directory) -> String {
    let mappings = [('A', 36), ('\u{391}', 36), ('B', 37)].map(|(c, gid): (char, u32)| (c, gid.into()));
    let cmap = write_fonts::dump_table(&Cmap::from_mappings(mappings).unwrap()).unwrap();
    let original = directory.write("in.ttf", &sans_with(&[b"cmap"], &[(b"cmap", &cmap)]));
    let output = directory.name("converted.ttf");
    nfr_convert(&["--quiet", "--ppem", "10-12", "--text", "A", "--gids", "3", &original, &output]).succeeds();
    output
}

#[test]
fn without_a_selection_a_glyph_stands_for_all_of_its_characters() {
    let directory = Directory::new();
    let (font, output) = (with_two_characters_of_a_glyph(&directory), directory.name("out.bdf"));
    let lines = |more: &[&str], prefix: &str| -> Vec<String> {
        nfr(&[&["bake", &font, &output, "--ppem", "12", "--bits", "4"], more].concat()).succeeds();
        let text = fs::read_to_string(&output).unwrap();
        text.lines().filter_map(|line| Some(line.strip_prefix(prefix)?.to_owned())).collect()
    };
    assert_eq!(lines(&[], "STARTCHAR "), [".notdef", "A", "uni0391", "space"]);
    assert_eq!(lines(&[], "ENCODING "), ["0", "65", "913", "-1"]);
    assert_eq!((lines(&[], "DEFAULT_CHAR "), lines(&[], "CHARS ")), (vec!["0".into()], vec!["4".into()]));
    assert_eq!(lines(&["--glyphs", "A"], "ENCODING "), ["65", "913"]);
    // A selected character is all that its glyph stands for.
    assert_eq!(lines(&["--text", "\u{391}"], "ENCODING "), ["913"]);
    assert_eq!(lines(&["--text", "\u{391}"], "DEFAULT_CHAR "), ["913"]);
    let output = directory.name("both.c");
    let run = nfr(&["bake", &font, &output, "--ppem", "12"]).succeeds();
    assert!(run.stderr.contains("both lacks 2 glyphs"), "{}", run.stderr);
    let read: Strike =
        printed(&directory, "both", false).lines().skip(1).map(crate::baked::printed_glyph).collect();
    assert_eq!(read, Expected::new(&font).characters(12, 4, "A\u{391}"));
    assert_eq!(fs::read_to_string(output).unwrap().matches("/* U+").count(), 1);
}

#[test]
fn an_atlas_has_the_librarys_bitmaps_where_its_description_says() {
    for bits in [4, 8] {
        let (directory, output) = bake("out.png", &["--ppem", "16", "--bits", &bits.to_string()]);
        assert_eq!(directory.files(), ["out.json", "out.png"]);
        let picture = image::open(&output).unwrap();
        assert_eq!(picture.color(), image::ColorType::L8);
        let json: Value = serde_json::from_slice(&fs::read(directory.path("out.json")).unwrap()).unwrap();
        assert_eq!(
            (&json["font"], &json["image"], &json["ppem"]),
            (&"Liberation Sans".into(), &"out.png".into(), &16.into())
        );
        assert_eq!(
            (json["width"].as_u64().unwrap(), json["height"].as_u64().unwrap()),
            (picture.width().into(), picture.height().into())
        );
        let font = Expected::new(neural()).font;
        assert_eq!(json["line"]["ascent"].as_f64().unwrap() as f32, font.line_metrics(16.0).ascent);
        let mut strike = Strike::new();
        let mut covered = vec![false; (picture.width() * picture.height()) as usize];
        for glyph in json["glyphs"].as_array().unwrap() {
            let number = |key: &str| glyph[key].as_i64().unwrap() as i32;
            let [x, y, width, height] = ["x", "y", "width", "height"].map(|key| number(key) as u32);
            let view = picture.view(x, y, width, height);
            let scale = 255 / ((1u16 << bits) - 1) as u8;
            let levels = view.pixels().map(|(_, _, pixel)| pixel.0[0] / scale).collect();
            // Glyphs are a pixel apart.
            for (x, y) in
                (y..=y + height).flat_map(|y| (x..=x + width).map(move |x| (x, y))).filter(|_| width > 0)
            {
                let at = (y * picture.width() + x) as usize;
                assert!(covered.get(at).is_none_or(|covered| !covered), "two glyphs at {x}, {y}");
                covered.get_mut(at).into_iter().for_each(|covered| *covered = true);
            }
            let gid = number("gid") as u32;
            let advance = glyph["hinted_advance"].as_f64().unwrap() as i32;
            assert_eq!(glyph["advance"].as_f64().unwrap() as f32, font.advance(gid, 16.0));
            strike.insert(gid, Drawn::new(levels, width as usize, (number("left"), number("top")), advance));
        }
        assert_eq!(strike, Expected::new(neural()).strike(16, bits));
        let eacute =
            json["glyphs"].as_array().unwrap().iter().find(|glyph| glyph["name"] == "eacute").unwrap();
        assert_eq!(eacute["characters"], serde_json::json!(["é"]));
    }
}

/// What the C program prints for a font.
fn printed(directory: &Directory, symbol: &str, large: bool) -> String {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/lvgl");
    let program = directory.name("print");
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Wno-unused-function", "-Werror", "-I"])
        .args([
            &format!("{source}/stub"),
            "-I",
            &directory.name("."),
            &format!("{source}/print.c"),
            "-o",
            &program,
        ])
        .args([
            format!("-DFONT={symbol}"),
            format!("-DFILE_NAME=\"{symbol}.c\""),
            format!("-DLV_FONT_FMT_TXT_LARGE={}", u8::from(large)),
        ])
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    String::from_utf8(Command::new(program).output().unwrap().stdout).unwrap()
}

#[test]
fn a_c_program_finds_the_librarys_bitmaps_in_a_font_for_lvgl() {
    for bits in DEPTHS {
        let (directory, _) =
            bake("a-font.c", &["--ppem", "12,16", "--bits", &bits.to_string(), "--text", TEXT]);
        assert_eq!(directory.files(), ["a-font_12.c", "a-font_16.c"]);
        for ppem in [12, 16] {
            let symbol = format!("a_font_{ppem}");
            fs::rename(directory.path(&format!("a-font_{ppem}.c")), directory.path(&format!("{symbol}.c")))
                .unwrap();
            let text = printed(&directory, &symbol, false);
            let mut lines = text.lines();
            // Ascent and descent are 0.905 and 0.212 em; at 12 ppem the bar reaches as far down as the line.
            let head = if ppem == 12 { "14 3" } else { "17 3" };
            assert_eq!(lines.next().unwrap(), format!("{head} {bits}"));
            let read: Strike = lines.map(crate::baked::printed_glyph).collect();
            assert_eq!(
                read,
                Expected::new(neural()).characters(ppem, bits, TEXT),
                "{ppem} ppem, {bits} bits"
            );
        }
    }
}

#[test]
fn a_font_that_is_too_large_for_lvgls_small_fields_says_what_it_needs() {
    let directory = Directory::new();
    let output = directory.name("large.c");
    let run = nfr(&["bake", neural(), &output, "--ppem", "300", "--text", "AŒ"]).succeeds();
    assert!(run.stderr.contains("large needs LV_FONT_FMT_TXT_LARGE"), "{}", run.stderr);
    assert!(run.stderr.contains("300 ppem: the models were trained for 8-64 ppem"), "{}", run.stderr);
    let read: Strike =
        printed(&directory, "large", true).lines().skip(1).map(crate::baked::printed_glyph).collect();
    assert_eq!(read, Expected::new(neural()).characters(300, 4, "AŒ"));
}
