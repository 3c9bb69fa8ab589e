//! A text at several sizes, one pixel for a pixel: a column for each renderer, a row for each size.

use std::error::Error;

use nfr_convert::compare::metrics::BAD_DIFFERENCE;

use crate::renderer::{NAMES, Renderer};
use crate::sheet::{MARGIN, Sheet, WIDTH};
use crate::typeface::Typeface;

/// The column of the sizes, and the space between columns.
const SIZES: usize = 22;
const GAP: usize = 12;
const COLUMN: usize = (WIDTH - 2 * MARGIN - SIZES - NAMES.len() * GAP) / NAMES.len();
/// The column that the others are compared with.
const HINTED: usize = 1;
/// The height of the headings, and from a caption's top to its baseline.
const HEADINGS: usize = 24;
const CAPTION_BASELINE: usize = 12;
/// The space between sizes.
const BETWEEN: usize = 9;

fn left(column: usize) -> usize {
    MARGIN + SIZES + GAP + column * (COLUMN + GAP)
}

/// Writes the unit of the sizes and the renderers' names, and returns the row below them.
pub(crate) fn headings(sheet: &mut Sheet, top: usize) -> Result<usize, Box<dyn Error>> {
    sheet.caption("px", MARGIN, top)?;
    for (column, name) in NAMES.iter().enumerate() {
        sheet.caption(name, left(column), top)?;
    }
    Ok(top + HEADINGS)
}

/// Draws the first lines of a text at each size, and returns the row below them.
pub(crate) fn draw(
    sheet: &mut Sheet,
    typeface: &Typeface<'_>,
    text: &str,
    sizes: &[u16],
    most_lines: usize,
    mut top: usize,
) -> Result<usize, Box<dyn Error>> {
    let shaped = typeface.shape(text)?;
    for &ppem in sizes {
        let lines = shaped.lines(COLUMN as i32 * typeface.units_per_em() / i32::from(ppem));
        let lines = &lines[..lines.len().min(most_lines)];
        let metrics = typeface.pair.font().line_metrics(ppem.into());
        let (ascent, descent) = (metrics.ascent.ceil() as usize, (-metrics.descent).ceil() as usize);
        let height = ascent + descent;
        sheet.grow(top + lines.len() * height)?;
        sheet.caption(&ppem.to_string(), MARGIN, (top + ascent).saturating_sub(CAPTION_BASELINE))?;
        for (column, renderer) in Renderer::all(typeface, ppem)?.iter_mut().enumerate() {
            let x = left(column) as i64;
            // What sticks out of a column ends in the gap.
            let columns = x - GAP as i64 / 2..x + (COLUMN + GAP / 2) as i64;
            for (line, baseline) in lines.iter().zip((top + ascent..).step_by(height)) {
                renderer.line(line, &mut sheet.picture, [x, baseline as i64], &columns)?;
            }
        }
        top += lines.len() * height + BETWEEN;
    }
    Ok(top)
}

/// How many pixels of the columns from the row `top` on are not as in that of the hinted text, as a sentence.
pub(crate) fn differences(sheet: &Sheet, top: usize) -> String {
    let of_column = |column: usize| {
        let (mut bad, mut largest) = (0usize, 0u8);
        for y in top as u32..sheet.picture.height() {
            for x in 0..(COLUMN + GAP) as u32 {
                let light = |column| sheet.light((left(column) - GAP / 2) as u32 + x, y);
                let difference = light(column).abs_diff(light(HINTED));
                largest = largest.max(difference);
                bad += usize::from(difference > BAD_DIFFERENCE);
            }
        }
        format!("{} {bad} ({largest})", NAMES[column])
    };
    let columns: Vec<String> = (0..NAMES.len()).filter(|column| *column != HINTED).map(of_column).collect();
    format!(
        "Pixels of the picture off from the hinted ones by more than {BAD_DIFFERENCE} of 255, and the largest difference: {}.",
        columns.join(", ")
    )
}
