//! The output font against its input: what has to stay stays, and the hint programs are gone.

use std::collections::BTreeSet;
use std::rc::Rc;

use freetype::face::LoadFlag;
use nfr::internals::table::TAG as NFRT;
use nfr_convert::assemble::{assemble, hint_bytes};
use read_fonts::tables::compute_checksum;
use read_fonts::tables::glyf::Glyph;
use read_fonts::tables::head::Flags;
use read_fonts::types::{GlyphId, Tag};
use read_fonts::{FontRef, TableProvider};
use skrifa::raw::model::glyph::outline::PathElement;
use skrifa::{DrawMemory, Font, ScalerFont};

/// Stands for the models. An odd length, so that the table has to be padded.
const MODELS: &[u8] = b"models!";
const HINT_TABLES: [&str; 8] = ["fpgm", "prep", "cvt ", "cvar", "hdmx", "VDMX", "LTSH", "DSIG"];
const CHANGED_TABLES: [&str; 6] = ["head", "maxp", "gasp", "loca", "glyf", "Nfrt"];

/// Runs a check on each font in `fonts/` and what becomes of it.
fn for_each_font(check: impl Fn(&str, &[u8], &[u8])) {
    let mut fonts = 0;
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/fonts")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "ttf") {
            let before = std::fs::read(&path).unwrap();
            let after = assemble(&FontRef::new(&before).unwrap(), MODELS, &BTreeSet::new()).unwrap();
            check(&path.display().to_string(), &before, &after);
            fonts += 1;
        }
    }
    assert!(fonts > 0, "no fonts to test with");
}

fn tags(font: &FontRef) -> BTreeSet<String> {
    font.table_directory().table_records().iter().map(|record| record.tag().to_string()).collect()
}

fn table<'a>(font: &FontRef<'a>, tag: &str) -> &'a [u8] {
    font.table_data(Tag::new(tag.as_bytes().try_into().unwrap())).unwrap().as_bytes()
}

/// The program of each glyph.
fn glyph_programs<'a>(font: &FontRef<'a>) -> Vec<&'a [u8]> {
    let (loca, glyf) = (font.loca(None).unwrap(), font.glyf().unwrap());
    (0..font.maxp().unwrap().num_glyphs())
        .map(|gid| match loca.get_glyf(GlyphId::from(gid), &glyf).unwrap() {
            Some(Glyph::Simple(glyph)) => glyph.instructions(),
            Some(Glyph::Composite(glyph)) => glyph.instructions().unwrap_or_default(),
            None => &[],
        })
        .collect()
}

#[test]
fn skrifa_draws_every_glyph_as_before() {
    for_each_font(|name, before, after| {
        let [before, after] = [before, after]
            .map(|data| ScalerFont::force_unhinted(Font::new(data.to_vec(), 0).unwrap(), None));
        let draw = |font: &ScalerFont, gid| {
            let mut path = Vec::<PathElement>::new();
            let metrics =
                font.outline(GlyphId::new(gid)).unwrap().draw(DrawMemory::Scratch, &mut path).unwrap();
            (path, metrics)
        };
        for gid in 0..before.font().num_glyphs() {
            assert_eq!(draw(&before, gid), draw(&after, gid), "{name}, glyph {gid}");
        }
    });
}

#[test]
fn freetype_opens_it_and_loads_the_same_outlines() {
    let library = freetype::Library::init().unwrap();
    for_each_font(|name, before, after| {
        let [before, after] =
            [before, after].map(|data| library.new_memory_face(Rc::new(data.to_vec()), 0).unwrap());
        let load = |face: &freetype::Face, gid| {
            face.load_glyph(gid, LoadFlag::NO_SCALE | LoadFlag::NO_HINTING).unwrap();
            let advance = face.glyph().advance().x;
            // Without points FreeType's arrays are null, which freetype-rs would make slices of.
            if face.glyph().raw().outline.n_points == 0 {
                return (vec![], vec![], vec![], advance);
            }
            let outline = face.glyph().outline().unwrap();
            let points: Vec<_> = outline.points().iter().map(|point| (point.x, point.y)).collect();
            (points, outline.tags().to_vec(), outline.contours().to_vec(), advance)
        };
        assert_eq!(before.num_glyphs(), after.num_glyphs(), "{name}");
        for gid in 0..before.num_glyphs() as u32 {
            assert_eq!(load(&before, gid), load(&after, gid), "{name}, glyph {gid}");
        }
    });
}

#[test]
fn harfrust_shapes_text_to_the_same_glyphs_and_positions() {
    // Kerning, a ligature, a combining mark, and scripts that not every font has.
    let text = "AVATAR To fly: office, affine; e\u{301} x\u{308} 0123 Δοκιμή Проверка שלום";
    for_each_font(|name, before, after| {
        let shape = |data: &[u8]| {
            let font = harfrust::Font::new(data.to_vec(), 0).unwrap();
            let mut buffer = harfrust::Buffer::new();
            buffer.push_str(text);
            buffer.guess_segment_properties();
            let shaper = harfrust::ShaperFont::new(&font);
            harfrust::shape(&shaper, &mut buffer, harfrust::ShapeOptions::new()).unwrap();
            let glyphs = buffer.glyph_infos().iter().map(|info| (info.glyph_id, info.cluster));
            let positions =
                buffer.glyph_positions().iter().map(|p| (p.x_advance, p.y_advance, p.x_offset, p.y_offset));
            glyphs.zip(positions).collect::<Vec<_>>()
        };
        assert!(!shape(before).is_empty());
        assert_eq!(shape(before), shape(after), "{name}");
    });
}

#[test]
fn tables_that_have_no_part_in_hinting_stay_byte_identical() {
    for_each_font(|name, before, after| {
        let [before, after] = [before, after].map(|data| FontRef::new(data).unwrap());
        let mut expected = tags(&before);
        expected.retain(|tag| !HINT_TABLES.contains(&tag.as_str()));
        expected.extend(["Nfrt".into(), "gasp".into()]);
        assert_eq!(tags(&after), expected, "{name}");
        for tag in expected.iter().filter(|tag| !CHANGED_TABLES.contains(&tag.as_str())) {
            assert_eq!(table(&before, tag), table(&after, tag), "{name}, table '{tag}'");
        }
        assert_eq!(after.table_data(NFRT).unwrap().as_bytes(), MODELS);
    });
}

#[test]
fn tables_measured_with_programs_and_signatures_are_left_out() {
    for_each_font(|name, before, after| {
        let mut builder = write_fonts::FontBuilder::new();
        builder.copy_missing_tables(FontRef::new(before).unwrap());
        for tag in HINT_TABLES {
            builder.add_raw(Tag::new(tag.as_bytes().try_into().unwrap()), tag.as_bytes());
        }
        let with_all = builder.build();
        assert_eq!(
            assemble(&FontRef::new(&with_all).unwrap(), MODELS, &BTreeSet::new()).unwrap(),
            after,
            "{name}"
        );
    });
}

#[test]
fn no_program_is_left_and_none_is_announced() {
    for_each_font(|name, before, after| {
        let [before, after] = [before, after].map(|data| FontRef::new(data).unwrap());
        assert!(glyph_programs(&after).iter().all(|program| program.is_empty()), "{name}");

        let [old, new] = [&before, &after].map(|font| table(font, "maxp"));
        // From maxZones on, 14 bytes: 1, and then zeros.
        assert_eq!(new[14..28], [0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], "{name}");
        assert_eq!((&old[..14], &old[28..]), (&new[..14], &new[28..]), "{name}");

        let gasp = after.gasp().unwrap();
        assert_eq!((gasp.version(), gasp.num_ranges()), (1, 1));
        assert_eq!(table(&after, "gasp")[4..], [0xFF, 0xFF, 0x00, 0x0A], "{name}");
    });
}

#[test]
fn head_changes_only_where_it_speaks_of_programs_and_loca() {
    for_each_font(|name, before, after| {
        let [before, after] = [before, after].map(|data| FontRef::new(data).unwrap());
        let cleared =
            Flags::INSTRUCTIONS_MAY_DEPEND_ON_POINT_SIZE | Flags::INSTRUCTIONS_MAY_ALTER_ADVANCE_WIDTH;
        assert!(before.head().unwrap().flags().intersects(cleared), "{name} shows nothing");
        assert_eq!(
            after.head().unwrap().flags().bits(),
            before.head().unwrap().flags().bits() & !cleared.bits(),
            "{name}"
        );
        // checkSumAdjustment, flags, indexToLocFormat.
        let changing = |at: usize| matches!(at, 8..12 | 16..18 | 50..52);
        let others = |font: &FontRef| -> Vec<_> {
            (0..54).filter(|&at| !changing(at)).map(|at| table(font, "head")[at]).collect()
        };
        assert_eq!(others(&before), others(&after), "{name}");
    });
}

#[test]
fn checksums_hold_for_each_table_and_the_file() {
    // OpenType 1.9, "OpenType font file", calculating checksums.
    const FILE_CHECKSUM: u32 = 0xB1B0_AFBA;
    for_each_font(|name, _, after| {
        assert_eq!(compute_checksum(after), FILE_CHECKSUM, "{name}");
        assert_eq!(after.len() % 4, 0, "{name}");
        for record in FontRef::new(after).unwrap().table_directory().table_records() {
            let start = record.offset() as usize;
            assert_eq!(start % 4, 0, "{name}, table '{}'", record.tag());
            let mut data = after[start..start + record.length() as usize].to_vec();
            if record.tag() == Tag::new(b"head") {
                data[8..12].fill(0);
            }
            assert_eq!(compute_checksum(&data), record.checksum(), "{name}, table '{}'", record.tag());
        }
    });
}

#[test]
fn hint_bytes_counts_what_is_taken_out() {
    for_each_font(|name, before, after| {
        let [before, after] = [before, after].map(|data| FontRef::new(data).unwrap());
        let bytes = hint_bytes(&before).unwrap();
        let programs: usize = glyph_programs(&before).iter().map(|program| program.len()).sum();
        assert!(programs > 0, "{name} shows nothing");
        assert_eq!(bytes.glyph_programs, programs, "{name}");
        assert_eq!(bytes.fpgm, table(&before, "fpgm").len(), "{name}");
        assert_eq!(bytes.prep, table(&before, "prep").len(), "{name}");
        assert_eq!(bytes.cvt, table(&before, "cvt ").len(), "{name}");
        assert_eq!(bytes.total(), programs + bytes.fpgm + bytes.prep + bytes.cvt, "{name}");
        assert_eq!(hint_bytes(&after).unwrap().total(), 0, "{name}");
    });
}

#[test]
fn a_font_without_programs_stays_the_same_and_its_models_are_replaced() {
    for_each_font(|name, _, after| {
        let again = assemble(&FontRef::new(after).unwrap(), MODELS, &BTreeSet::new()).unwrap();
        assert_eq!(again, after, "{name}");
        let replaced = assemble(&FontRef::new(after).unwrap(), b"other models", &BTreeSet::new()).unwrap();
        assert_eq!(table(&FontRef::new(&replaced).unwrap(), "Nfrt"), b"other models", "{name}");
    });
}
