//! A comparison as one web page that needs nothing beside itself.

mod chart;

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::diff::Sources;
use super::picture::{Canvas, DIFFERENCE_GAIN, coverage, difference, enclosing, text_line};
use super::report::{Compared, OfGlyph, Report, glyphs};
use crate::error::Error;
use chart::{Series, line_chart};

/// The glyphs that are shown enlarged.
const WORST_SHOWN: usize = 24;
/// An enlarged glyph is about this large, in CSS pixels, and no pixel is larger than `MAX_ZOOM`.
const GLYPH_SIZE: u32 = 170;
const MAX_ZOOM: u32 = 12;
/// How much the sample text is enlarged.
const TEXT_ZOOM: u32 = 2;

/// The text that the page shows.
pub struct Sample<'s> {
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
pub fn page(report: &Report, sources: Sources<'_>, sample: &Sample<'_>) -> Result<String, Error> {
    let subject = &report.subject;
    let title = format!("{} against {}", subject.neural, subject.original);
    let title = escape(&title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{title}</title>\n<style>\n{}</style>\n\
         <h1>{title}</h1>\n<p>{} at {} ppem, hinted for {}; {} bytes of models, {:.1} per glyph.</p>\n",
        include_str!("page.css"),
        glyphs(subject.glyphs),
        subject.ppem,
        subject.target,
        subject.table_bytes,
        subject.bytes_per_glyph
    );
    html += &figures(report);
    html += &by_size(report);
    html += &worst(report, sources)?;
    html += &text(sources, sample)?;
    Ok(html + "</html>\n")
}

fn figures(report: &Report) -> String {
    let mut html =
        "<h2>Error against the hinted bitmaps</h2>\n<table>\n<tr><th>ppem<th><th>mae<th>rmse<th>max\
                    <th>bad16<th>exact</tr>\n"
            .to_owned();
    let mut add = |sizes: &str, compared: &Compared| {
        for (who, located) in [("neural", &compared.neural), ("unhinted", &compared.unhinted)] {
            let m = &located.figures;
            let _ = writeln!(
                html,
                "<tr class=\"{who}\"><td>{sizes}<td>{who}<td>{:.5}<td>{:.5}<td>{:.5}<td>{:.2} %<td>{:.2} %</tr>",
                m.mae,
                m.rmse,
                m.max,
                100.0 * m.bad16,
                100.0 * m.exact
            );
        }
    };
    add(&report.subject.ppem, &report.totals);
    for band in &report.bands {
        add(&format!("{}–{}", band.first_ppem, band.last_ppem), &band.compared);
    }
    html + "</table>\n<p>mae, rmse and max in units of full coverage; bad16 is the share of pixels off by more than \
            16/255.</p>\n"
}

fn by_size(report: &Report) -> String {
    let series = |class, mae: &dyn Fn(&Compared) -> f64| Series {
        class,
        points: report.by_ppem.iter().map(|s| (f64::from(s.first_ppem), mae(&s.compared))).collect(),
    };
    let lines = [
        series("unhinted", &|compared| compared.unhinted.figures.mae),
        series("neural", &|compared| compared.neural.figures.mae),
    ];
    format!(
        "<h2>Mean absolute error by size: <span class=\"neural\">neural</span>, \
         <span class=\"unhinted\">unhinted</span></h2>\n{}",
        line_chart(&lines, "ppem")
    )
}

fn worst(report: &Report, sources: Sources<'_>) -> Result<String, Error> {
    let mut html = format!(
        "<h2>Worst glyphs, each at its worst size</h2>\n<p>The difference is that of the neural bitmap from the \
         hinted one, {DIFFERENCE_GAIN} times as strong: red is too dark, blue too light.</p>\n<div class=\"scroll\">\
         <table class=\"glyphs\">\n<tr><th>glyph<th>neural<th>hinted<th>unhinted<th>difference</tr>\n"
    );
    for glyph in report.by_glyph.iter().take(WORST_SHOWN).filter(|glyph| glyph.worst_ppem > 0) {
        html += &worst_row(glyph, sources)?;
    }
    Ok(html + "</table></div>\n")
}

fn worst_row(glyph: &OfGlyph, sources: Sources<'_>) -> Result<String, Error> {
    let draw = |source: &dyn super::source::Source| {
        source.at(glyph.worst_ppem).and_then(|mut at| at.bitmap(glyph.gid))
    };
    let (truth, neural, unhinted) = (draw(sources.truth)?, draw(sources.neural)?, draw(sources.unhinted)?);
    let frame = enclosing([&truth, &neural, &unhinted]);
    let zoom = (GLYPH_SIZE / frame.width.max(frame.height).max(1)).clamp(1, MAX_ZOOM);
    let mut html = format!(
        "<tr><td>{}<br>{} ppem<br>mae {:.4} over all sizes",
        escape(&glyph.title()),
        glyph.worst_ppem,
        glyph.compared.neural.figures.mae
    );
    for canvas in [
        coverage(&neural, &frame)?,
        coverage(&truth, &frame)?,
        coverage(&unhinted, &frame)?,
        difference(&truth, &neural, &frame)?,
    ] {
        let _ = write!(html, "<td>{}", image(&canvas, zoom)?);
    }
    Ok(html + "</tr>\n")
}

fn text(sources: Sources<'_>, sample: &Sample<'_>) -> Result<String, Error> {
    let mut html = "<h2>Text</h2>\n<div class=\"scroll\"><table class=\"lines\">\n".to_owned();
    for &ppem in sample.sizes {
        let who = [("neural", sources.neural), ("hinted", sources.truth), ("unhinted", sources.unhinted)];
        let lines = who.map(|(_, source)| {
            text_line(source.at(ppem)?.as_mut(), sample.gids, |gid| (sample.advance)(gid, ppem))
        });
        let [neural, truth, unhinted] = lines;
        let lines = [neural?, truth?, unhinted?];
        let frame = enclosing(&lines);
        for ((who, _), line) in who.iter().zip(&lines) {
            let picture = image(&coverage(line, &frame)?, TEXT_ZOOM)?;
            let _ = writeln!(html, "<tr><td>{ppem} ppem<td>{who}<td>{picture}</tr>");
        }
    }
    Ok(html + "</table></div>\n")
}

/// A picture inside the page, enlarged by the browser.
fn image(canvas: &Canvas, zoom: u32) -> Result<String, Error> {
    let (width, height) = (canvas.width() * zoom, canvas.height() * zoom);
    let png = STANDARD.encode(canvas.png()?);
    Ok(format!("<img width=\"{width}\" height=\"{height}\" alt=\"\" src=\"data:image/png;base64,{png}\">"))
}

/// Replaces the characters that HTML gives a meaning.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
