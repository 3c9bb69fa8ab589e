//! A font with PostScript outlines is converted and used with the tools, as a person would.

use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

use crate::common::{Directory, nfr, nfr_convert};

const CANTARELL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/Cantarell-Regular.otf");

#[test]
fn a_postscript_font_goes_through_all_tools() {
    let directory = Directory::new();
    let font = directory.name("out.ttf");
    let summary = nfr_convert(&["--text", "Hag", "--ppem", "10-20", CANTARELL, &font]).succeeds().stdout;
    assert!(summary.contains("PostScript hints are left out"), "{summary}");
    let diff = nfr(&["diff", CANTARELL, &font, "--ppem", "10-20", "--fail-on", "mae>0.003"]).succeeds();
    assert!(diff.stdout.contains("unhinted"), "{}", diff.stdout);
    let verified = nfr(&["verify", CANTARELL, &font]).succeeds().stdout;
    assert!(verified.contains("certificate   holds"), "{verified}");
    assert!(
        nfr(&["render", &font, "--text", "g", "--ppem", "12", "--json"]).succeeds().stdout.contains("pixels")
    );
    // Names of glyphs are kept, and more glyphs can be added.
    let more = directory.name("more.ttf");
    nfr_convert(&["--glyphs", "eacute", "--into", &font, CANTARELL, &more]).succeeds();
    nfr(&["diff", CANTARELL, &more, "--glyphs", "eacute", "--ppem", "12"]).succeeds();
}

#[test]
fn a_font_whose_cff_table_is_cut_off_is_an_error_and_writes_nothing() {
    let directory = Directory::new();
    let data = std::fs::read(CANTARELL).unwrap();
    let mut builder = FontBuilder::new();
    builder.add_raw(Tag::new(b"CFF "), vec![1, 0, 4, 1]);
    builder.copy_missing_tables(FontRef::new(&data).unwrap());
    let (input, output) = (directory.write("cut.otf", &builder.build()), directory.name("out.ttf"));
    nfr_convert(&["--text", "a", &input, &output]).fails_with(&["cut.otf"]);
    assert_eq!(directory.files(), ["cut.otf"]);
}
