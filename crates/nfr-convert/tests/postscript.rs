//! Fonts with PostScript outlines are converted as those with TrueType outlines are.

use nfr::{Font, Rasterizer, Target};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::ppem::PpemList;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Conversion, Error, Hinter, Options, Quality, convert};
use read_fonts::{FontRef, TableProvider};

use crate::samples::{Warnings, gid, gids, table, with_tables};

/// The error that outline models of printable ASCII have at most, over all sizes, at the default quality: `figures` says 0.00036.
const MAX_MAE: f64 = 0.0005;
/// The same at quality 100: 0.00029.
const MAX_MAE_EXACT: f64 = 0.0004;
/// The bytes that a model takes at most at the default quality, for smooth and for mono: 122.
const MAX_BYTES: usize = 140;
/// The error of the few glyphs of the small fonts at the default quality: 0.0008.
const MAX_MAE_SMALL: f64 = 0.0009;

fn cantarell() -> Vec<u8> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/Cantarell-Regular.otf")).unwrap()
}

/// One of the fonts that `postscript/make.py` makes.
fn small(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/tests/postscript/{name}.otf", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Converts all glyphs of a small font, or those of a text, and expects no warning but that a font is variable.
fn converted(data: &[u8], text: Option<&str>, target: Target) -> Conversion {
    let options = Options { target, ..Options::default() };
    converted_with(data, text, options)
}

fn converted_with(data: &[u8], text: Option<&str>, options: Options) -> Conversion {
    let all = || (0..FontRef::new(data).unwrap().maxp().unwrap().num_glyphs()).collect();
    let gids = text.map_or_else(all, |text| gids(data, text));
    let options = Options { gids, ..options };
    let warnings = Warnings::default();
    let conversion = convert(data, &options, &warnings).unwrap();
    let variable = "the font is variable; its default instance is converted";
    let is_variable = FontRef::new(data).unwrap().fvar().is_ok();
    assert_eq!(*warnings.0.lock().unwrap(), if is_variable { vec![variable] } else { vec![] });
    conversion
}

/// The errors of the models and of the unhinted outlines.
fn errors(original: &[u8], conversion: &Conversion) -> [f64; 2] {
    let pair = FontPair::open(original, 0, &conversion.font).unwrap();
    let gids: Vec<u16> = conversion.glyphs.iter().map(|glyph| glyph.gid).collect();
    let report = pair.report(["", ""], &gids, &PpemList::from(8..=64), 1).unwrap();
    [report.totals.neural.figures.mae, report.totals.unhinted.figures.mae]
}

#[test]
fn the_models_of_a_postscript_font_draw_what_its_hints_draw() {
    let data = cantarell();
    let ascii: String = (' '..='~').collect();
    let exact = Quality::new(100.0).unwrap();
    for (target, quality, most) in [
        (Target::Smooth, Quality::default(), MAX_MAE),
        (Target::Mono, Quality::default(), MAX_MAE),
        (Target::Smooth, exact, MAX_MAE_EXACT),
    ] {
        let options = Options { target, ..Options::default().with_quality(quality) };
        let conversion = converted_with(&data, Some(&ascii), options);
        let [neural, unhinted] = errors(&data, &conversion);
        assert!(neural < most && unhinted > 15.0 * neural, "{target}: {neural}, unhinted {unhinted}");
        let bytes = conversion.glyphs.iter().map(|glyph| glyph.bytes).sum::<usize>() / ascii.len();
        assert!(quality == exact || bytes < MAX_BYTES, "{target}: {bytes} bytes a glyph");
    }
}

#[test]
fn an_autohinted_postscript_font_is_learnt_as_well() {
    let data = cantarell();
    let ascii: String = (' '..='~').collect();
    let options = Options { hinter: Hinter::Auto, ..Options::default() };
    let [neural, unhinted] = errors(&data, &converted_with(&data, Some(&ascii), options));
    assert!(neural < MAX_MAE && unhinted > 15.0 * neural, "{neural}, unhinted {unhinted}");
}

#[test]
fn accents_put_together_cid_keyed_fonts_and_cff2_are_converted() {
    for name in ["seac", "cid", "cff2"] {
        let data = small(name);
        let [neural, unhinted] = errors(&data, &converted(&data, None, Target::Smooth));

        assert!(neural < MAX_MAE_SMALL && unhinted > 0.005, "{name}: {neural}, unhinted {unhinted}");
    }
}

#[test]
fn the_converted_font_is_a_truetype_font_with_the_other_tables_and_glyph_names() {
    let data = cantarell();
    let conversion = converted(&data, Some("aé"), Target::Smooth);
    let (original, font) = (FontRef::new(&data).unwrap(), FontRef::new(&conversion.font).unwrap());
    assert_eq!(conversion.font[..4], [0, 1, 0, 0]);
    assert!(font.cff().is_err() && font.glyf().is_ok());
    for tag in [b"GSUB", b"GPOS", b"GDEF", b"cmap", b"name", b"OS/2"] {
        assert_eq!(table(&data, tag), table(&conversion.font, tag));
    }
    let names = |font| nfr_convert::select::glyph_names(font).unwrap();
    assert_eq!(names(&original), names(&font));
    let (maxp, head, loca) = (font.maxp().unwrap(), font.head().unwrap(), font.loca(None).unwrap());
    assert!(maxp.max_points().unwrap() > 50 && maxp.num_glyphs() == original.maxp().unwrap().num_glyphs());
    let (ours, theirs) = (font.hmtx().unwrap(), original.hmtx().unwrap());
    for gid in 0..u32::from(maxp.num_glyphs()) {
        assert_eq!(ours.advance(gid.into()), theirs.advance(gid.into()), "{gid}");
        let glyph = loca.get_glyf(gid.into(), &font.glyf().unwrap()).unwrap();
        let left = glyph.map_or(0, |glyph| glyph.x_min());
        assert_eq!(ours.side_bearing(gid.into()), Some(left), "{gid}");
        assert!(head.x_min() <= left, "{gid}");
    }
}

#[test]
fn contours_turn_as_those_of_truetype_do() {
    let data = cantarell();
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    let outline = teacher.unhinted_em(gid(&data, 'l')).unwrap();
    let area: f32 = outline.segments().iter().map(|[a, b]| a[0] * b[1] - b[0] * a[1]).sum();
    assert!(area < 0.0, "the ink of 'l' is to the left of its contour");
}

#[test]
fn quality_100_puts_every_point_where_the_hints_put_it() {
    let data = cantarell();
    let options = Options { gids: gids(&data, "ag8"), ..Options::default() };
    let options = options.with_quality(Quality::new(100.0).unwrap());
    let conversion = convert(&data, &options, &Warnings::default()).unwrap();
    let pair = FontPair::open(&data, 0, &conversion.font).unwrap();
    let found = pair.verify(["", ""], &options.gids, &PpemList::from(8..=64), 1).unwrap();
    assert_eq!(found.failures(0), Vec::<String>::new());
}

#[test]
fn a_glyph_whose_charstring_is_damaged_is_named_and_the_others_are_converted() {
    let data = small("seac");
    let mut cff = table(&data, b"CFF ");
    // The accented glyph's last operands and `endchar`: another number of operands is none that FreeType or skrifa takes.
    let at = cff.windows(3).rposition(|bytes| bytes == [247, 86, 14]).unwrap();
    cff[at..at + 3].copy_from_slice(&[139, 139, 10]);
    let damaged = with_tables(&data, &[(b"CFF ", cff)]);
    let options = Options { gids: vec![1, 2, 3], ppem: 12..=13, ..Options::default() };
    let warnings = Warnings::default();
    let conversion = convert(&damaged, &options, &warnings).unwrap();
    assert_eq!(conversion.left_out, [2]);
    let told = warnings.0.lock().unwrap().join("\n");
    assert!(told.contains("left without a model") && told.contains("glyph 2"), "{told}");
    let font = Font::new(conversion.font).unwrap();
    assert!(Rasterizer::new(&font).render(1, 12.0).unwrap().placement.area() > 0);
}

#[test]
fn damage_to_the_table_is_an_error_and_no_panic() {
    let data = small("cid");
    let cff = table(&data, b"CFF ");
    for at in 0..cff.len() {
        let mut damaged = cff.clone();
        damaged[at] ^= 0xFF;
        let damaged = with_tables(&data, &[(b"CFF ", damaged)]);
        let options = Options { gids: vec![1, 2], ppem: 12..=12, ..Options::default() };
        let _ = convert(&damaged, &options, &Warnings::default());
    }
    for len in [0, 4, 20, cff.len() / 2] {
        let cut = with_tables(&data, &[(b"CFF ", cff[..len].to_vec())]);
        let options = Options { gids: vec![1, 2], ppem: 12..=12, ..Options::default() };
        assert!(convert(&cut, &options, &Warnings::default()).is_err(), "{len}");
    }
}

#[test]
fn a_postscript_font_without_hints_is_refused() {
    let data = small("unhinted");
    let error = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).err().unwrap();
    assert!(
        matches!(&error, Error::Unsupported(text) if text.contains("no horizontal stem hints")),
        "{error}"
    );
}
