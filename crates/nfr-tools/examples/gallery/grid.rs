//! A word with enlarged pixels: a row for each renderer, a column for each font and size.

use std::error::Error;
use std::ops::{Range, RangeInclusive};

use image::imageops::{self, FilterType};
use image::{GrayImage, Luma};

use crate::ink::blank;
use crate::renderer::{NAMES, Renderer};
use crate::sheet::{MARGIN, Sheet, WIDTH};
use crate::typeface::Typeface;

/// The column of the renderers' names, the least space between columns, that between rows, and the height of the headings.
const NAMES_WIDTH: usize = 70;
const GAP: usize = 12;
const ROW_GAP: usize = 10;
const HEADINGS: usize = 24;
/// From a caption's top to the middle of its letters.
const CAPTION_MIDDLE: usize = 8;
/// Room around a word's origin, in em: to the right, above and below, and to the left.
const ROOM: (usize, usize, usize) = (8, 2, 1);

/// A word in the four ways, on papers of equal size with the baseline in the same row.
struct Cell {
    heading: String,
    papers: Vec<GrayImage>,
    columns: Range<u32>,
}

/// Draws the word at these fonts and sizes, each with its heading, enlarged as much as fits.
pub(crate) fn draw(
    sheet: &mut Sheet,
    cells: &[(&Typeface<'_>, u16, String)],
    word: &str,
    zooms: RangeInclusive<usize>,
    top: usize,
) -> Result<(), Box<dyn Error>> {
    let largest = cells.iter().map(|(_, ppem, _)| *ppem).max().unwrap_or(0);
    let cells =
        cells.iter().map(|(typeface, ppem, heading)| Cell::new(typeface, *ppem, word, largest, heading));
    let cells = cells.collect::<Result<Vec<_>, _>>()?;
    let width: usize = cells.iter().map(|cell| cell.columns.len()).sum();
    let room = WIDTH - 2 * MARGIN - NAMES_WIDTH;
    let fits = |zoom: &usize| width * zoom + (cells.len() - 1) * GAP <= room;
    let Some(zoom) = zooms.rev().find(fits) else {
        return Err(
            format!("{word:?} has {width} pixels at all sizes together; choose a shorter --word").into()
        );
    };
    let gap = (room - width * zoom) / (cells.len() - 1).max(1);
    let rows = covering(cells.iter().flat_map(|cell| &cell.papers).flat_map(|paper| ink(paper).map(|p| p.1)));
    let height = rows.len() * zoom;
    let mut left = MARGIN + NAMES_WIDTH;
    for cell in &cells {
        sheet.caption(&format!("{}, {zoom}\u{d7}", cell.heading), left, top)?;
        for (row, paper) in cell.papers.iter().enumerate() {
            let y = top + HEADINGS + row * (height + ROW_GAP);
            sheet.grow(y + height)?;
            let part = imageops::crop_imm(
                paper,
                cell.columns.start,
                rows.start,
                cell.columns.len() as u32,
                rows.len() as u32,
            );
            let [w, h] = [cell.columns.len() * zoom, height].map(|side| side as u32);
            let enlarged = imageops::resize(&part.to_image(), w, h, FilterType::Nearest);
            imageops::replace(&mut sheet.picture, &enlarged, left as i64, y as i64);
        }
        left += cell.columns.len() * zoom + gap;
    }
    for (row, name) in NAMES.iter().enumerate() {
        let middle = top + HEADINGS + row * (height + ROW_GAP) + height / 2;
        sheet.caption(name, MARGIN, middle - CAPTION_MIDDLE.min(middle))?;
    }
    Ok(())
}

impl Cell {
    /// Papers have room for `largest` pixels per em.
    fn new(
        typeface: &Typeface<'_>,
        ppem: u16,
        word: &str,
        largest: u16,
        heading: &str,
    ) -> Result<Self, Box<dyn Error>> {
        let shaped = typeface.shape(word)?;
        let [right, above, left] = [ROOM.0, ROOM.1, ROOM.2].map(|em| em * usize::from(largest));
        let mut papers = Vec::new();
        for mut renderer in Renderer::all(typeface, ppem)? {
            let mut paper = blank(left + right, 2 * above)?;
            let all = 0..(left + right) as i64;
            renderer.line(shaped.glyphs(), &mut paper, [left as i64, above as i64], &all)?;
            papers.push(paper);
        }
        let columns = covering(papers.iter().flat_map(|paper| ink(paper).map(|p| p.0)));
        Ok(Self { heading: heading.to_owned(), papers, columns })
    }
}

/// The columns and rows with ink.
fn ink(paper: &GrayImage) -> impl Iterator<Item = (Range<u32>, Range<u32>)> {
    let dark = paper.enumerate_pixels().filter(|(_, _, Luma([light]))| *light < 255);
    dark.map(|(x, y, _)| (x..x + 1, y..y + 1))
}

/// The range from the first start to the last end.
fn covering(ranges: impl IntoIterator<Item = Range<u32>>) -> Range<u32> {
    let cover = |a: Range<u32>, b: Range<u32>| a.start.min(b.start)..a.end.max(b.end);
    ranges.into_iter().reduce(cover).unwrap_or_default()
}
