//! Bitmaps in rows and columns, with labels.

use super::canvas::{Canvas, enclosing};
use super::letters;
use crate::error::Error;
use nfr::{Bitmap, Placement};

/// White space around and between everything, in pixels.
const MARGIN: u64 = 12;
/// From this enlargement on, labels are enlarged twice, to match.
const ZOOM_OF_LARGE_LABELS: u32 = 3;

/// One row of a sheet: a label, and bitmaps on one baseline.
#[derive(Debug, Clone)]
pub struct Row {
    /// What stands at the left.
    pub label: String,
    /// One bitmap a column.
    pub cells: Vec<Bitmap>,
}

/// Draws rows of bitmaps under the columns' headings, which may be none, each pixel `zoom`×`zoom`.
///
/// # Errors
///
/// `LimitExceeded` if the picture would be too large.
pub fn sheet(headings: &[&str], rows: &[Row], zoom: u32) -> Result<Canvas, Error> {
    let label_zoom = if zoom >= ZOOM_OF_LARGE_LABELS { 2 } else { 1 };
    let label_width = |label: &str| u64::from(letters::width(label, label_zoom));
    let label_height = u64::from(letters::LETTER_HEIGHT * label_zoom);
    let zoomed = |length: u32| u64::from(length) * u64::from(zoom);

    let column_count = rows.iter().map(|row| row.cells.len()).max().unwrap_or(0);
    // All rows of a column share their pen, so that sizes can be compared.
    let columns: Vec<(Placement, u64)> = (0..column_count)
        .map(|i| {
            let frame = enclosing(rows.iter().filter_map(|row| row.cells.get(i)));
            (frame, zoomed(frame.width).max(headings.get(i).map_or(0, |heading| label_width(heading))))
        })
        .collect();
    let row_frames: Vec<Placement> = rows.iter().map(|row| enclosing(&row.cells)).collect();
    let row_height = |frame: &Placement| zoomed(frame.height).max(label_height);

    let labels = rows.iter().map(|row| label_width(&row.label)).max().unwrap_or(0);
    let width = columns.iter().fold(MARGIN * 2 + labels, |sum, (_, width)| sum + MARGIN + width);
    let head = if headings.is_empty() { 0 } else { label_height + MARGIN };
    let height = row_frames.iter().fold(MARGIN + head, |sum, frame| sum + row_height(frame) + MARGIN);
    let mut canvas = Canvas::new(width, height)?;

    let mut y = MARGIN;
    let starts = columns.iter().scan(MARGIN * 2 + labels, |x, (_, width)| {
        let start = *x;
        *x += width + MARGIN;
        Some(start as i64)
    });
    let starts: Vec<i64> = starts.collect();
    for (heading, &x) in headings.iter().zip(&starts) {
        letters::draw(&mut canvas, x, y as i64, label_zoom, heading);
    }
    y += head;
    for (row, frame) in rows.iter().zip(&row_frames) {
        let baseline = y as i64 + i64::from(frame.top) * i64::from(zoom);
        let label_top = (baseline - label_height as i64).max(y as i64);
        letters::draw(&mut canvas, MARGIN as i64, label_top, label_zoom, &row.label);
        for ((cell, &x), (column, _)) in row.cells.iter().zip(&starts).zip(&columns) {
            canvas.draw(cell, x - i64::from(column.left) * i64::from(zoom), baseline, zoom);
        }
        y += row_height(frame) + MARGIN;
    }
    Ok(canvas)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_sheet_has_room_for_everything_at_its_zoom() {
        let placement = Placement { left: 0, top: 20, width: 10, height: 20 };
        let cell = Bitmap { placement, pixels: vec![255; 200] };
        let row = |label: &str| Row { label: label.into(), cells: vec![cell.clone(), cell.clone()] };
        let size = |canvas: Canvas| (u64::from(canvas.width()), u64::from(canvas.height()));
        let small = size(sheet(&[], &[row("8"), row("9")], 1).unwrap());
        assert_eq!(small, (4 * MARGIN + 6 + 20, 3 * MARGIN + 40));
        let large = size(sheet(&[], &[row("8"), row("9")], 4).unwrap());
        assert_eq!(large, (4 * MARGIN + 12 + 80, 3 * MARGIN + 160));
    }

    #[test]
    fn a_sheet_without_glyphs_is_a_small_white_picture() {
        assert!(
            sheet(&[], &[Row { label: String::new(), cells: vec![Bitmap::default()] }], 1)
                .unwrap()
                .png()
                .is_ok()
        );
    }
}
