//! The part of the page that people type into: a text of their own, and a search for glyphs, at any size that was compared.

use maud::{Markup, PreEscaped, html};
use serde::Serialize;

use super::bitmaps::{images, sizes_to_carry};
use crate::compare::diff::Sources;
use crate::compare::report::Report;
use crate::error::Error;

/// What of a font the page needs to set text.
pub struct TextFont<'f> {
    /// The characters of the compared glyphs, ascending.
    pub characters: &'f [(char, u16)],
    /// Font units in an em.
    pub units_per_em: u16,
    /// The sizes that were compared, in pixels per em, ascending.
    pub sizes: &'f [u16],
    /// The text that the page begins with.
    pub first_text: &'f str,
    /// The advance of a glyph in font units.
    pub advance: &'f dyn Fn(u16) -> f32,
}

/// The data that `page.js` reads.
#[derive(Serialize)]
struct Data<'d> {
    units: u16,
    sizes: Vec<u16>,
    glyphs: Vec<GlyphData<'d>>,
    /// Characters, as code points, and the indices of their glyphs in `glyphs`.
    characters: Vec<(u32, usize)>,
    /// The images of each size.
    images: Vec<Vec<String>>,
}

#[derive(Serialize)]
struct GlyphData<'d> {
    gid: u16,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'d str>,
    advance: f32,
    /// The mean absolute error over all sizes that were compared.
    mae: f64,
}

/// The controls, empty canvases, and the data.
pub(super) fn explorer(report: &Report, sources: Sources<'_>, font: &TextFont<'_>) -> Result<Markup, Error> {
    let data = data(report, sources, font)?;
    let first = data.sizes.iter().position(|size| *size >= 12).unwrap_or(0);
    let left_out = font.sizes.len() - data.sizes.len();
    // A name may be anything: it must not end the element.
    let json =
        serde_json::to_string(&data).map_err(|e| Error::Malformed(e.to_string()))?.replace('<', "\\u003c");
    Ok(html! {
        section #explorer {
            h2 { "Your text" }
            noscript { p { "This part needs JavaScript; the rest of the page does not." } }
            p.controls {
                label for="text" { "Text" }
                input #text type="text" value=(font.first_text) spellcheck="false" autocomplete="off";
                label for="size" { "Size" }
                input #size type="range" min="0" max=(data.sizes.len().saturating_sub(1)) value=(first);
                output #ppem for="size" {}
                label for="zoom" { "Enlarged" }
                select #zoom {
                    @for zoom in [1, 2, 3, 4, 6, 8] { option value=(zoom) selected[zoom == 2] { (zoom) "×" } }
                }
            }
            @if left_out > 0 {
                p.hint { "With so many glyphs, the page has " (data.sizes.len()) " of the " (font.sizes.len()) " sizes that were compared." }
            }
            div.scroll {
                table.lines {
                    @for (kind, name) in [("hinted", "hinted"), ("neural", "neural"), ("unhinted", "unhinted")] {
                        tr { th scope="row" class=(kind) { (name) } td { canvas data-kind=(kind) role="img" {} } }
                    }
                }
            }
            p #missing role="status" {}
            p.hint { "Each character stands for one glyph, with the advance width of the font: no kerning, ligatures or other layout." }
            h2 { "Find a glyph" }
            p.controls {
                label for="search" { "Character, U+XXXX, glyph name or number" }
                input #search type="search" spellcheck="false" autocomplete="off";
            }
            p #found role="status" {}
            div.scroll { table #results.glyphs hidden {
                thead { tr { @for name in ["glyph", "hinted", "neural", "unhinted", "difference"] { th scope="col" { (name) } } } }
                tbody {}
            } }
        }
        script #data type="application/json" { (PreEscaped(json)) }
        script { (PreEscaped(include_str!("page.js"))) }
    })
}

fn data<'d>(report: &'d Report, sources: Sources<'_>, font: &TextFont<'_>) -> Result<Data<'d>, Error> {
    let mut glyphs: Vec<GlyphData<'_>> = report
        .by_glyph
        .iter()
        .map(|glyph| GlyphData {
            gid: glyph.gid,
            name: glyph.name.as_deref(),
            advance: (font.advance)(glyph.gid),
            mae: (glyph.compared.neural.figures.mae * 1e5).round() / 1e5,
        })
        .collect();
    glyphs.sort_unstable_by_key(|glyph| glyph.gid);
    let gids: Vec<u16> = glyphs.iter().map(|glyph| glyph.gid).collect();
    let index = |(c, gid): &(char, u16)| Some((u32::from(*c), gids.binary_search(gid).ok()?));
    let characters = font.characters.iter().filter_map(index).collect();
    let sizes = sizes_to_carry(font.sizes, gids.len());
    let images = sizes.iter().map(|ppem| images(sources, &gids, *ppem)).collect::<Result<_, Error>>()?;
    Ok(Data { units: font.units_per_em, sizes, glyphs, characters, images })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::compare::diff::{GlyphTally, Tallies};
    use crate::compare::report::ReportHeader;
    use crate::compare::source::{BitmapSource, SizedSource};
    use nfr::Bitmap;

    struct Blank;

    impl BitmapSource for Blank {
        fn at(&self, _: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
            Ok(Box::new(Blank))
        }
    }

    impl SizedSource for Blank {
        fn bitmap(&mut self, _: u16) -> Result<Bitmap, Error> {
            Ok(Bitmap::default())
        }
    }

    /// The page's part for the glyphs 5 and 3, the second of which has a name that would end a script.
    fn markup(sizes: &[u16]) -> String {
        let mut tallies = Tallies::default();
        for gid in [3, 5] {
            tallies.by_glyph.insert(gid, GlyphTally::default());
        }
        let header = ReportHeader {
            original: "a.ttf".into(),
            neural: "b.ttf".into(),
            target: "smooth".into(),
            hinter: "font".into(),
            ppem: "12".into(),
            glyphs: 2,
            table_bytes: 1,
            bytes_per_glyph: 1.0,
        };
        let name = |gid| (gid == 3).then(|| "</script>".to_owned());
        let report = Report::new(header, &tallies, |gid| (name(gid), None));
        let font = TextFont {
            characters: &[('a', 5), ('b', 3), ('c', 9)],
            units_per_em: 1000,
            sizes,
            first_text: "ab",
            advance: &|gid| f32::from(gid) * 100.0,
        };
        let sources = Sources { truth: &Blank, neural: &Blank, unhinted: &Blank };
        explorer(&report, sources, &font).unwrap().into_string()
    }

    fn data(markup: &str) -> serde_json::Value {
        let (_, after) = markup.split_once(r#"<script id="data" type="application/json">"#).unwrap();
        serde_json::from_str(after.split_once("</script>").unwrap().0).unwrap()
    }

    #[test]
    fn the_data_has_glyphs_in_order_and_only_their_characters() {
        let data = data(&markup(&[12, 13]));
        assert_eq!(data["units"], 1000);
        assert_eq!(data["sizes"], serde_json::json!([12, 13]));
        let glyphs = serde_json::json!([
            { "gid": 3, "name": "</script>", "advance": 300.0, "mae": 0.0 },
            { "gid": 5, "advance": 500.0, "mae": 0.0 },
        ]);
        assert_eq!(data["glyphs"], glyphs);
        assert_eq!(data["characters"], serde_json::json!([[97, 1], [98, 0]]));
        assert_eq!(data["images"].as_array().unwrap().len(), 2);
    }

    #[test]
    fn a_name_does_not_end_the_data() {
        assert_eq!(markup(&[12]).matches("</script>").count(), 2);
    }

    #[test]
    fn the_slider_begins_near_twelve_and_ends_at_the_last_size() {
        assert!(markup(&[9, 11, 13, 20]).contains(r#"type="range" min="0" max="3" value="2""#));
        assert!(markup(&[9]).contains(r#"type="range" min="0" max="0" value="0""#));
    }

    #[test]
    fn the_script_has_no_end_tag_in_it() {
        assert!(!include_str!("page.js").contains("</"));
    }
}
