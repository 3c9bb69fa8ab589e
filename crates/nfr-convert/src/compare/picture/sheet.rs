//! Bitmaps in rows and columns, with labels.

use image::{RgbImage, imageops};

use super::label::LabelFont;
use super::raster::{blank, coverage, enclosing, enlarged};
use crate::error::Error;
use nfr::{Bitmap, Placement};

/// White space around and between everything, in pixels.
const MARGIN: u64 = 12;

/// One row of a sheet: a label, and bitmaps on one baseline.
#[derive(Debug, Clone)]
pub struct SheetRow {
    /// The text at the left.
    pub label: String,
    /// One bitmap a column.
    pub bitmaps: Vec<Bitmap>,
}

/// Draws rows of bitmaps under the columns' headings, which may be none, each pixel `zoom`×`zoom`.
///
/// # Errors
///
/// `LimitExceeded` if the picture would be too large; as [`LabelFont::line`].
pub fn sheet(font: &LabelFont, headings: &[&str], rows: &[SheetRow], zoom: u32) -> Result<RgbImage, Error> {
    let (line_height, label_baseline) = LabelFont::line_height(zoom);
    let headings = headings.iter().map(|text| font.line(text, zoom)).collect::<Result<Vec<_>, _>>()?;
    let labels = rows.iter().map(|row| font.line(&row.label, zoom)).collect::<Result<Vec<_>, _>>()?;
    let zoomed = |length: u32| u64::from(length) * u64::from(zoom);

    let column_count = rows.iter().map(|row| row.bitmaps.len()).max().unwrap_or(0);
    // All rows of a column share their origin, so that sizes can be compared.
    let columns: Vec<(Placement, u64)> = (0..column_count)
        .map(|i| {
            let frame = enclosing(rows.iter().filter_map(|row| row.bitmaps.get(i)));
            (frame, zoomed(frame.width).max(headings.get(i).map_or(0, |heading| heading.width().into())))
        })
        .collect();
    let row_frames: Vec<Placement> = rows.iter().map(|row| enclosing(&row.bitmaps)).collect();
    let row_height = |frame: &Placement| zoomed(frame.height).max(line_height.into());

    let label_width = labels.iter().map(RgbImage::width).max().unwrap_or(0);
    let first_column = MARGIN * 2 + u64::from(label_width);
    let width = columns.iter().fold(first_column, |sum, (_, width)| sum + MARGIN + width);
    let first_row = MARGIN + if headings.is_empty() { 0 } else { u64::from(line_height) + MARGIN };
    let height = row_frames.iter().fold(first_row, |sum, frame| sum + row_height(frame) + MARGIN);
    let mut picture = blank(width, height)?;

    let lefts: Vec<i64> = columns
        .iter()
        .scan(first_column, |x, (_, width)| Some(std::mem::replace(x, *x + width + MARGIN) as i64))
        .collect();
    for (heading, &x) in headings.iter().zip(&lefts) {
        imageops::replace(&mut picture, heading, x, MARGIN as i64);
    }
    let mut y = first_row as i64;
    for ((row, label), frame) in rows.iter().zip(&labels).zip(&row_frames) {
        let baseline = y + i64::from(frame.top) * i64::from(zoom);
        imageops::replace(&mut picture, label, MARGIN as i64, (baseline - i64::from(label_baseline)).max(y));
        for ((bitmap, &x), (column, _)) in row.bitmaps.iter().zip(&lefts).zip(&columns) {
            let place = bitmap.placement;
            if place.area() > 0 {
                let left = x + (i64::from(place.left) - i64::from(column.left)) * i64::from(zoom);
                let top = baseline - i64::from(place.top) * i64::from(zoom);
                imageops::replace(&mut picture, &enlarged(&coverage(bitmap, &place)?, zoom), left, top);
            }
        }
        y += (row_height(frame) + MARGIN) as i64;
    }
    Ok(picture)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use read_fonts::FontRef;

    use super::*;
    use crate::compare::picture::png;

    fn label_font() -> LabelFont {
        let sans = include_bytes!("../../../fonts/LiberationSans-Regular.ttf");
        LabelFont::new(&FontRef::new(sans).unwrap()).unwrap()
    }

    #[test]
    fn a_sheet_has_room_for_everything_at_its_zoom() {
        let placement = Placement { left: 0, top: 20, width: 10, height: 20 };
        let bitmap = Bitmap { placement, pixels: vec![255; 200] };
        let row =
            |label: &str| SheetRow { label: label.into(), bitmaps: vec![bitmap.clone(), bitmap.clone()] };
        let font = label_font();
        for zoom in [1, 4] {
            let label =
                ["8", "9"].map(|label| font.line(label, zoom).unwrap().width()).into_iter().max().unwrap();
            let picture = sheet(&font, &[], &[row("8"), row("9")], zoom).unwrap();
            let margins = [4, 3].map(|count| count * MARGIN as u32);
            let expected = (margins[0] + label + 2 * 10 * zoom, margins[1] + 2 * 20 * zoom);
            assert_eq!(picture.dimensions(), expected);
        }
    }

    #[test]
    fn a_sheet_without_glyphs_is_a_small_white_picture() {
        let row = SheetRow { label: String::new(), bitmaps: vec![Bitmap::default()] };
        let picture = sheet(&label_font(), &[], &[row], 1).unwrap();
        assert!(png(&picture).is_ok() && picture.pixels().all(|pixel| pixel.0 == [255; 3]));
    }
}
