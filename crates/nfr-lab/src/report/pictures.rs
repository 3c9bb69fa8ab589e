//! The report's pictures.

use super::super::Square;
use super::super::interpolation::Interpolation;
use super::super::output::{COLUMNS, between};
use super::super::pictures::{Comparison, Strip, cascade, noted, strips, triptychs};
use super::super::resize::{Method, shrunk};
use super::super::single::Outcome;
use super::figures::models;
use super::{Figure, Part, Section};
use nfr_convert::compare::html::escape;
use nfr_convert::error::Error;

/// How much pictures of single bitmaps are enlarged, and how much cascades are.
const ZOOM: u32 = 5;
const CASCADE_ZOOM: u32 = 3;

/// All pictures.
pub(super) fn sections(part: &Part<'_>) -> Result<Vec<Section>, Error> {
    let mut all = vec![side_by_side(part)?, cascades(part)?, bitmaps(part)?];
    all.push(family(part, "Between two weights", "weights", &part.findings.weights)?);
    all.push(family(part, "Between two typefaces", "styles", &part.findings.styles)?);
    all.push(stored(part)?);
    Ok(all)
}

/// A picture, with a line that says at which scale it was made.
fn png(part: &Part<'_>, file: String, picture: &[u8], caption: impl Into<String>) -> Result<Figure, Error> {
    Ok(Figure { file, bytes: noted(picture, part.bench.settings.kind())?, caption: caption.into() })
}

/// A model's outcome on the first font.
fn find<'p>(part: &'p Part<'_>, model: &str, glyph: char) -> Option<&'p Outcome> {
    let font = part.font();
    part.findings.outcomes.iter().find(|one| one.model == model && one.font == font && one.glyph == glyph)
}

fn side_by_side(part: &Part<'_>) -> Result<Section, Error> {
    let mut figures = Vec::new();
    let sizes = part.plan.fonts[0].truth.sizes.len();
    for (what, size) in [("small", 0), ("large", sizes.saturating_sub(2))] {
        let outcomes: Vec<&Outcome> = part
            .plan
            .ablated
            .chars()
            .flat_map(|glyph| models().into_iter().filter_map(move |model| find(part, &model, glyph)))
            .collect();
        let labels: Vec<String> = outcomes.iter().map(|one| format!("{} {}", one.glyph, one.model)).collect();
        let rows: Vec<Comparison<'_>> = outcomes
            .iter()
            .zip(&labels)
            .filter_map(|(one, label)| {
                Some(Comparison { label, prediction: one.drawn.get(size)?, truth: one.truth.get(size)? })
            })
            .collect();
        let side = rows.first().map_or(0, |row| row.truth.side);
        let bytes = triptychs(&rows, if side > 40 { 3 } else { ZOOM })?;
        let caption = format!(
            "{}, boxes of {side}×{side} pixels: what the model draws, its error (red too dark, blue too light), the truth.",
            part.font()
        );
        figures.push(png(part, format!("triptychs-{what}.png"), &bytes, caption)?);
    }
    Ok(Section { title: "Prediction, error, truth", text: String::new(), figures })
}

fn cascades(part: &Part<'_>) -> Result<Section, Error> {
    let mut figures = Vec::new();
    for glyph in part.plan.ablated.chars() {
        let outcomes: Vec<&Outcome> = models().iter().filter_map(|model| find(part, model, glyph)).collect();
        let Some(first) = outcomes.first() else { continue };
        let mut rows = vec![Strip { label: "truth", squares: first.truth.iter().collect() }];
        rows.extend(
            outcomes.iter().map(|one| Strip { label: &one.model, squares: one.drawn.iter().collect() }),
        );
        let code = u32::from(glyph);
        let bytes = cascade(&rows, COLUMNS, CASCADE_ZOOM)?;
        figures.push(png(
            part,
            format!("cascade-u{code:04x}.png"),
            &bytes,
            format!("{}: {glyph}", part.font()),
        )?);
    }
    Ok(Section { title: "Cascades over all sizes", text: String::new(), figures })
}

fn bitmaps(part: &Part<'_>) -> Result<Section, Error> {
    let subject = part.plan.all_sizes;
    let mut rows: Vec<(String, Vec<Square>)> = Vec::new();
    let mut hinting: Vec<(String, Vec<Square>)> = Vec::new();
    for (glyph, gid) in subject.glyphs(part.plan.ablated)? {
        let mut squares = vec![subject.truth.hinted(gid, 0)?];
        for method in Method::ALL {
            squares.push(shrunk(&subject.truth, gid, 0, method)?.0);
        }
        rows.push((glyph.to_string(), squares));
        hinting.push((glyph.to_string(), vec![subject.truth.hinted(gid, 0)?, subject.truth.plain(gid, 0)?]));
    }
    let mut headings = vec!["hinted"];
    headings.extend(Method::ALL.map(Method::name));
    let wrong: Vec<(String, Vec<Square>)> = part
        .findings
        .wrong_pixel
        .iter()
        .map(|one| (one.glyph.to_string(), vec![one.truth.clone(), one.wrong.clone()]))
        .collect();
    let side = subject.truth.sizes.first().map_or(0, |size| size.side);
    let figure = |file: &str, headings: &[&str], rows: &[(String, Vec<Square>)], caption: String| {
        let rows: Vec<Strip<'_>> =
            rows.iter().map(|(label, squares)| Strip { label, squares: squares.iter().collect() }).collect();
        png(part, file.into(), &strips(headings, &rows, ZOOM)?, caption)
    };
    let font = part.font();
    Ok(Section {
        title: "Bitmaps without models",
        text: String::new(),
        figures: vec![
            figure(
                "resizing.png",
                &headings,
                &rows,
                format!("{font}, s = {side}: hinted, and shrunk from the largest."),
            )?,
            figure("hinting.png", &["hinted", "unhinted"], &hinting, format!("{font}, s = {side}."))?,
            figure(
                "wrong-pixel.png",
                &["truth", "wrong"],
                &wrong,
                format!("{font}, s = {side}: one pixel of ink gone."),
            )?,
        ],
    })
}

fn family(
    part: &Part<'_>,
    title: &'static str,
    experiment: &str,
    all: &[Interpolation],
) -> Result<Section, Error> {
    let mut figures = Vec::new();
    let mut table = String::new();
    for one in all {
        let bytes = between(one)?;
        let real = one.between.iter().any(|drawing| drawing.truth.is_some());
        let code = u32::from(one.glyph);
        let caption = format!(
            "{}: the first font as it is, what lies half-way between the two (by the implicit network's interpolated \
             latent vector, by our two models interpolated, the same with snapped knots{}), the last font as it is.",
            one.glyph,
            if real { ", and the real font" } else { "" }
        );
        figures.push(png(part, format!("{experiment}-u{code:04x}.png"), &bytes, caption)?);
        for drawing in one.ends.iter().chain(&one.between) {
            let mse = drawing.mse().map_or_else(|| "no truth".into(), |mse| format!("{mse:.2e}"));
            let [glyph, of] = [one.glyph.to_string(), drawing.of.clone()].map(|text| escape(&text));
            table += &format!("<tr><td>{glyph}<td>{of}<td>{}<td>{mse}</tr>\n", drawing.name);
        }
    }
    let text =
        format!("<table>\n<tr><th>character<th>compared with<th>drawn by<th>mse</tr>\n{table}</table>");
    Ok(Section { title, text, figures })
}

fn stored(part: &Part<'_>) -> Result<Section, Error> {
    let mut table = String::new();
    for one in &part.findings.stored {
        let (mse, mae) = (one.outcome.mse(), one.outcome.mae());
        table += &format!(
            "<tr><td>{}<td>{}<td>{}<td>{mse:.3e}<td>{:.3e}<td>{mae:.4}</tr>\n",
            escape(&one.glyph.to_string()),
            one.bits,
            one.bytes,
            one.before
        );
    }
    let ours = part.findings.grid_fit_bytes.iter().sum::<usize>() as f64;
    let text = format!(
        "<p>A trained implicit network in the table <code>Nfrt</code>, drawn by the library's usual call, which draws the \
         hinted glyph's box alone: errors, before it was stored too, are without what it draws beside the glyph. Our own \
         models take {:.0} bytes a character.</p>\n<table>\n<tr><th>character<th>bits<th>bytes<th>mse<th>mse before\
         <th>mae</tr>\n{table}</table>",
        ours / part.findings.grid_fit_bytes.len().max(1) as f64
    );
    Ok(Section { title: "The network in a font", text, figures: Vec::new() })
}
