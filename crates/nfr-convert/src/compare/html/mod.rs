//! A comparison as one web page that needs nothing beside itself.

mod bitmaps;
mod chart;
mod explorer;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::diff::Sources;
use super::picture::{DIFFERENCE_GAIN, coverage, difference, enclosing, png, text_line};
use super::report::{ComparedErrors, GlyphErrors, Report, glyph_count_text};
use super::source::BitmapSource;
use crate::error::Error;
use chart::{Series, line_chart};
use explorer::explorer;

pub use explorer::TextFont;

/// The glyphs that are shown enlarged.
const WORST_SHOWN: usize = 24;
/// An enlarged glyph is about this large, in CSS pixels, and no pixel is larger than `MAX_ZOOM`.
const GLYPH_SIZE: u32 = 170;
const MAX_ZOOM: u32 = 12;
/// How much the sample text is enlarged.
const TEXT_ZOOM: u32 = 2;

/// The text that the page shows.
pub struct SampleText<'s> {
    /// Its glyphs.
    pub gids: &'s [u16],
    /// The sizes to show it at, in pixels per em.
    pub sizes: &'s [u16],
    /// The advance of a glyph at a size, both in pixels.
    pub advance: &'s dyn Fn(u16, u16) -> f32,
}

/// Writes the page.
///
/// # Errors
///
/// As the sources', and `LimitExceeded` for pictures that would be too large.
pub fn page(
    report: &Report,
    sources: Sources<'_>,
    text: &SampleText<'_>,
    font: &TextFont<'_>,
) -> Result<String, Error> {
    let header = &report.header;
    let title = format!("{} against {}", header.neural, header.original);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(include_str!("page.css"))) }
            }
            body {
                h1 { (title) }
                p {
                    (glyph_count_text(header.glyphs)) " at " (header.ppem) " ppem, hinted for " (header.target)
                    @if header.hinter == "auto" { " by skrifa's autohinter" } "; "
                    (header.table_bytes) " bytes of models, " (format!("{:.1}", header.bytes_per_glyph)) " per glyph."
                }
                (error_table(report))
                (explorer(report, sources, font)?)
                (error_by_size(report))
                (worst_glyphs(report, sources)?)
                (text_lines(sources, text)?)
            }
        }
    };
    Ok(page.into_string())
}

fn error_table(report: &Report) -> Markup {
    let all = (report.header.ppem.clone(), &report.totals);
    let bands =
        report.bands.iter().map(|band| (format!("{}–{}", band.first_ppem, band.last_ppem), &band.compared));
    html! {
        h2 { "Error against the hinted bitmaps" }
        div.scroll {
            table {
                tr { @for name in ["ppem", "", "mae", "rmse", "max", "bad16", "exact"] { th { (name) } } }
                @for (sizes, compared) in std::iter::once(all).chain(bands) {
                    @for (name, errors) in [("neural", &compared.neural), ("unhinted", &compared.unhinted)] {
                        tr class=(name) {
                            td { (sizes) }
                            td { (name) }
                            @for value in [errors.figures.mae, errors.figures.rmse, errors.figures.max] {
                                td { (format!("{value:.5}")) }
                            }
                            @for share in [errors.figures.bad16, errors.figures.exact] {
                                td { (format!("{:.2} %", 100.0 * share)) }
                            }
                        }
                    }
                }
            }
        }
        p { "mae, rmse and max in units of full coverage; bad16 is the share of pixels off by more than 16/255." }
    }
}

fn error_by_size(report: &Report) -> Markup {
    let series = |class, mae: &dyn Fn(&ComparedErrors) -> f64| Series {
        class,
        points: report.by_ppem.iter().map(|s| (f64::from(s.first_ppem), mae(&s.compared))).collect(),
    };
    let lines = [
        series("unhinted", &|compared| compared.unhinted.figures.mae),
        series("neural", &|compared| compared.neural.figures.mae),
    ];
    html! {
        h2 {
            "Mean absolute error by size: " span.neural { "neural" } ", " span.unhinted { "unhinted" }
        }
        (line_chart(&lines, "ppem"))
    }
}

fn worst_glyphs(report: &Report, sources: Sources<'_>) -> Result<Markup, Error> {
    let glyphs = report.by_glyph.iter().take(WORST_SHOWN).filter(|glyph| glyph.worst_ppem > 0);
    let rows = glyphs.map(|glyph| worst_row(glyph, sources)).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        h2 { "Worst glyphs, each at its worst size" }
        p {
            "The difference is that of the neural bitmap from the hinted one, " (DIFFERENCE_GAIN)
            " times as strong: red is too dark, blue too light."
        }
        div.scroll {
            table.glyphs {
                tr { @for name in ["glyph", "neural", "hinted", "unhinted", "difference"] { th { (name) } } }
                @for row in rows { (row) }
            }
        }
    })
}

fn worst_row(glyph: &GlyphErrors, sources: Sources<'_>) -> Result<Markup, Error> {
    let draw =
        |source: &dyn BitmapSource| source.at(glyph.worst_ppem).and_then(|mut at| at.bitmap(glyph.gid));
    let (truth, neural, unhinted) = (draw(sources.truth)?, draw(sources.neural)?, draw(sources.unhinted)?);
    let frame = enclosing([&truth, &neural, &unhinted]);
    let zoom = (GLYPH_SIZE / frame.width.max(frame.height).max(1)).clamp(1, MAX_ZOOM);
    let pictures = [
        coverage(&neural, &frame)?,
        coverage(&truth, &frame)?,
        coverage(&unhinted, &frame)?,
        difference(&truth, &neural, &frame)?,
    ];
    let classes = ["coverage", "coverage", "coverage", "difference"];
    Ok(html! {
        tr {
            td {
                (glyph.title()) br; (glyph.worst_ppem) " ppem" br;
                "mae " (format!("{:.4}", glyph.compared.neural.figures.mae)) " over all sizes"
            }
            @for (picture, class) in pictures.iter().zip(classes) { td { (inline_image(picture, class, zoom)?) } }
        }
    })
}

fn text_lines(sources: Sources<'_>, text: &SampleText<'_>) -> Result<Markup, Error> {
    let mut rows = Vec::new();
    for &ppem in text.sizes {
        let named = [("neural", sources.neural), ("hinted", sources.truth), ("unhinted", sources.unhinted)];
        let lines = named.into_iter().map(|(_, source)| {
            text_line(source.at(ppem)?.as_mut(), text.gids, |gid| (text.advance)(gid, ppem))
        });
        let lines = lines.collect::<Result<Vec<_>, Error>>()?;
        let frame = enclosing(&lines);
        for ((name, _), line) in named.iter().zip(&lines) {
            rows.push((ppem, *name, inline_image(&coverage(line, &frame)?, "coverage", TEXT_ZOOM)?));
        }
    }
    Ok(html! {
        h2 { "Text at the sizes compared" }
        div.scroll {
            table.lines {
                @for (ppem, name, picture) in rows {
                    tr { td { (ppem) " ppem" } td { (name) } td { (picture) } }
                }
            }
        }
    })
}

/// A picture inside the page, enlarged by the browser.
fn inline_image(picture: &RgbImage, class: &str, zoom: u32) -> Result<Markup, Error> {
    let source = format!("data:image/png;base64,{}", STANDARD.encode(png(picture)?));
    Ok(
        html! { img class=(class) width=(picture.width() * zoom) height=(picture.height() * zoom) alt="" src=(source); },
    )
}
