//! The parts that all charts share: headings, a legend above the drawing, colours, and errors.

use std::fmt::Display;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use nfr_convert::error::Error;

/// The texts above a chart.
#[derive(Debug, Clone, Copy)]
pub struct Headings<'h> {
    /// The chart's contents, in one short line.
    pub title: &'h str,
    /// On what scale, and whatever else a reader must know; broken into lines as needed.
    pub subtitle: &'h str,
}

/// The errors of one model or variant, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorSeries {
    /// Its name, in the legend.
    pub name: String,
    /// Its errors.
    pub values: Vec<f64>,
}

/// A part of an SVG drawing.
pub(super) type Area<'s> = DrawingArea<SVGBackend<'s>, Shift>;

/// Okabe and Ito's colours, which people with any colour vision can tell apart; the palest last.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x00, 0x00, 0x00),
    RGBColor(0xf0, 0xe4, 0x42),
];
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
pub(super) const FAINT: RGBColor = RGBColor(0x66, 0x66, 0x66);
pub(super) const GRID: RGBColor = RGBColor(0xe2, 0xe2, 0xe2);

/// The width of every chart, in CSS pixels.
const WIDTH: u32 = 860;
/// The edge around everything.
const MARGIN: i32 = 14;
/// Sizes of letters. plotters divides sizes by 1.24.
const TITLE: f64 = 21.0;
const TEXT: f64 = 16.0;
const LINE: i32 = 18;
/// The mean width of a letter of the text, and what a legend's sign takes.
const LETTER: f64 = 7.2;
const SIGN: i32 = 30;

/// The colour of the series with this index.
pub(super) fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// The style of text in charts.
pub(super) fn text(colour: RGBColor, horizontal: HPos) -> TextStyle<'static> {
    let mut style = TextStyle::from(("sans-serif", TEXT).into_font()).pos(Pos::new(horizontal, VPos::Center));
    style.color = colour.to_backend_color();
    style
}

/// A failure of the drawing library, which has no reason to fail.
pub(super) fn failed(error: impl Display) -> Error {
    Error::LimitExceeded(format!("the chart cannot be drawn ({error}); draw fewer values"))
}

/// Draws a chart with room of this height for the drawing, below the headings and the legend.
pub(super) fn chart(
    headings: &Headings<'_>,
    legend: &[&str],
    height: u32,
    draw: impl FnOnce(&Area<'_>) -> Result<(), Error>,
) -> Result<String, Error> {
    let lines = wrapped(headings.subtitle, (f64::from(WIDTH as i32 - 2 * MARGIN) / LETTER) as usize);
    let signs = sign_positions(legend);
    let rows = signs.last().map_or(0, |(_, row)| row + 1);
    let head = MARGIN + 28 + LINE * (lines.len() as i32 + rows) + 8;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, head as u32 + height)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let title =
            TextStyle::from(("sans-serif", TITLE)).color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
        root.draw_text(headings.title, &title, (MARGIN, MARGIN + 9)).map_err(failed)?;
        let line_at = |line: i32| MARGIN + 28 + LINE * line + LINE / 2;
        for (line, content) in (0..).zip(&lines) {
            let at = (MARGIN, line_at(line));
            root.draw_text(content, &text(FAINT, HPos::Left), at).map_err(failed)?;
        }
        for (index, (name, (x, row))) in legend.iter().zip(signs).enumerate() {
            let y = line_at(lines.len() as i32 + row) + 4;
            let sign = Rectangle::new([(x, y - 5), (x + 18, y + 5)], colour(index).filled());
            root.draw(&sign).map_err(failed)?;
            root.draw_text(name, &text(INK, HPos::Left), (x + 24, y)).map_err(failed)?;
        }
        draw(&root.margin(head, 6, MARGIN, MARGIN))?;
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

/// The positions of the legend's signs: x, and the row.
fn sign_positions(legend: &[&str]) -> Vec<(i32, i32)> {
    let (mut x, mut row) = (MARGIN, 0);
    let place = |name: &&str| {
        let width = SIGN + (name.chars().count() as f64 * LETTER) as i32 + 18;
        if x > MARGIN && x + width > WIDTH as i32 - MARGIN {
            (x, row) = (MARGIN, row + 1);
        }
        let at = (x, row);
        x += width;
        at
    };
    legend.iter().map(place).collect()
}

/// A text in lines of at most so many letters, broken between words.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_broken_between_words() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert!(wrapped("", 7).is_empty());
    }

    #[test]
    fn a_legend_that_is_too_long_goes_on_below() {
        let name = "m".repeat(50);
        let rows: Vec<i32> = sign_positions(&[&name, &name, &name]).into_iter().map(|(_, row)| row).collect();
        assert_eq!(rows, [0, 0, 1]);
    }
}
