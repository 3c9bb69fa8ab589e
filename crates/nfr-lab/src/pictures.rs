//! Pictures of square bitmaps for the report: ink black on white, each pixel enlarged to a square.

use image::imageops::replace;
use image::{Rgb, RgbImage};

use super::SquareBitmap;
use super::pixel_error::bitmap;
use nfr_convert::compare::picture::{LabelFont, blank, coverage, difference, enlarged};
use nfr_convert::error::Error;

/// The line around a box, one pixel wide.
const EDGE: Rgb<u8> = Rgb([205; 3]);
/// White space between bitmaps, and around the picture, in pixels.
const GAP: u32 = 8;
const MARGIN: u32 = 12;

/// A model's picture of a glyph, and what it should be.
#[derive(Debug, Clone, Copy)]
pub struct PredictionRow<'c> {
    /// The text at the left, such as the model and the size.
    pub label: &'c str,
    /// The model's picture.
    pub prediction: &'c SquareBitmap,
    /// The hinted bitmap of the same size.
    pub truth: &'c SquareBitmap,
}

/// A row of bitmaps under a common label.
#[derive(Debug, Clone)]
pub struct BitmapRow<'s> {
    /// The text at the left.
    pub label: &'s str,
    /// The bitmaps, of any sizes.
    pub squares: Vec<&'s SquareBitmap>,
}

/// Rows of prediction, error and truth, each pixel `zoom`×`zoom`. The error is red where the prediction is too dark
/// and blue where it is too light, as [`difference`] draws it.
///
/// # Errors
///
/// `InvalidParameter` if a prediction and its truth differ in size; `LimitExceeded` for a picture that is too large.
pub fn prediction_rows(font: &LabelFont, rows: &[PredictionRow<'_>], zoom: u32) -> Result<RgbImage, Error> {
    let tiles = |row: &PredictionRow<'_>| {
        let error = signed_error(row.prediction, row.truth)?;
        let tiles = [ink(row.prediction)?, error, ink(row.truth)?].map(|tile| boxed(&enlarged(&tile, zoom)));
        Ok(TileRow { label: font.line(row.label, zoom)?, tiles: tiles.into() })
    };
    let rows = rows.iter().map(tiles).collect::<Result<Vec<_>, Error>>()?;
    let headings = ["model", "error", "truth"].map(|heading| font.line(heading, zoom));
    table(&headings.into_iter().collect::<Result<Vec<_>, _>>()?, &rows)
}

/// Rows of bitmaps in boxes, under the columns' headings, each pixel `zoom`×`zoom`.
///
/// # Errors
///
/// `InvalidParameter` for a bitmap with a wrong number of pixels; `LimitExceeded` for a picture that is too large.
pub fn bitmap_rows(
    font: &LabelFont,
    headings: &[&str],
    rows: &[BitmapRow<'_>],
    zoom: u32,
) -> Result<RgbImage, Error> {
    let tiles = |row: &BitmapRow<'_>| {
        let tiles = row.squares.iter().map(|square| Ok(boxed(&enlarged(&ink(square)?, zoom))));
        Ok(TileRow { label: font.line(row.label, zoom)?, tiles: tiles.collect::<Result<_, Error>>()? })
    };
    let rows = rows.iter().map(tiles).collect::<Result<Vec<_>, Error>>()?;
    let headings = headings.iter().map(|heading| font.line(heading, zoom)).collect::<Result<Vec<_>, _>>()?;
    table(&headings, &rows)
}

/// One glyph at many sizes, a row for each model, under the sizes in pixels; after so many `columns` all rows go on
/// below. The rows' bitmaps of one column have one size.
///
/// # Errors
///
/// `InvalidParameter` for a bitmap with a wrong number of pixels; `LimitExceeded` for a picture that is too large.
pub fn size_series(
    font: &LabelFont,
    models: &[BitmapRow<'_>],
    columns: usize,
    zoom: u32,
) -> Result<RgbImage, Error> {
    let count = models.iter().map(|model| model.squares.len()).max().unwrap_or(0);
    let mut blocks = Vec::new();
    for start in (0..count).step_by(columns.max(1)) {
        let end = start + columns.max(1);
        let longest = models.iter().map(|model| model.slice(start, end)).max_by_key(|slice| slice.len());
        let headings =
            longest.unwrap_or_default().iter().map(|square| font.line(&square.side.to_string(), zoom));
        let headings = headings.collect::<Result<Vec<_>, _>>()?;
        let tiles = |model: &BitmapRow<'_>| {
            let tiles = model.slice(start, end).iter().map(|square| Ok(enlarged(&ink(square)?, zoom)));
            Ok(TileRow { label: font.line(model.label, zoom)?, tiles: tiles.collect::<Result<_, Error>>()? })
        };
        let rows = models.iter().map(tiles).collect::<Result<Vec<_>, Error>>()?;
        blocks.push(table(&headings, &rows)?);
    }
    let width = blocks.iter().map(RgbImage::width).max().unwrap_or(1);
    let height = blocks.iter().map(|block| u64::from(block.height())).sum::<u64>().max(1);
    let mut picture = blank(width.into(), height)?;
    let mut y = 0;
    for block in &blocks {
        replace(&mut picture, block, 0, y);
        y += i64::from(block.height());
    }
    Ok(picture)
}

/// A picture with a line of text below it.
///
/// # Errors
///
/// `LimitExceeded` for a picture that becomes too large; as [`LabelFont::line`].
pub fn captioned(font: &LabelFont, picture: &RgbImage, caption: &str) -> Result<RgbImage, Error> {
    let caption = font.line(caption, 1)?;
    let width = picture.width().max(caption.width() + 2 * MARGIN);
    let mut whole = blank(width.into(), u64::from(picture.height() + caption.height() + MARGIN))?;
    replace(&mut whole, picture, 0, 0);
    replace(&mut whole, &caption, MARGIN.into(), picture.height().into());
    Ok(whole)
}

impl<'s> BitmapRow<'s> {
    /// The bitmaps from `start` to before `end`, as far as there are any.
    fn slice(&self, start: usize, end: usize) -> &[&'s SquareBitmap] {
        let count = self.squares.len();
        &self.squares[start.min(count)..end.min(count)]
    }
}

/// A row of finished tiles.
struct TileRow {
    label: RgbImage,
    tiles: Vec<RgbImage>,
}

/// Tiles in rows and columns: labels at the left, headings above, every tile at the bottom of its row.
fn table(headings: &[RgbImage], rows: &[TileRow]) -> Result<RgbImage, Error> {
    let columns = rows.iter().map(|row| row.tiles.len()).max().unwrap_or(0).max(headings.len());
    let tiles = |column: usize| rows.iter().filter_map(move |row| row.tiles.get(column));
    let widths: Vec<u32> = (0..columns)
        .map(|column| tiles(column).chain(headings.get(column)).map(RgbImage::width).max().unwrap_or(0))
        .collect();
    let heights: Vec<u32> = rows
        .iter()
        .map(|row| row.tiles.iter().chain([&row.label]).map(RgbImage::height).max().unwrap_or(0))
        .collect();
    let label_width = rows.iter().map(|row| row.label.width()).max().unwrap_or(0);
    let head = headings.iter().map(RgbImage::height).max().map_or(0, |height| height + GAP);
    let sum = |lengths: &[u32]| lengths.iter().map(|&length| u64::from(length + GAP)).sum::<u64>();
    let width = u64::from(2 * MARGIN + label_width) + sum(&widths);
    let mut picture = blank(width, u64::from(2 * MARGIN + head) + sum(&heights))?;

    let start = i64::from(MARGIN + label_width + GAP);
    let step = |at: &mut i64, &length: &u32| {
        let this = *at;
        *at += i64::from(length + GAP);
        Some(this)
    };
    let lefts: Vec<i64> = widths.iter().scan(start, step).collect();
    let tops: Vec<i64> = heights.iter().scan(i64::from(MARGIN + head), step).collect();
    let middle = |width: u32, tile: &RgbImage| i64::from((width - tile.width()) / 2);
    for ((heading, &left), &width) in headings.iter().zip(&lefts).zip(&widths) {
        replace(&mut picture, heading, left + middle(width, heading), MARGIN.into());
    }
    for ((row, &top), &height) in rows.iter().zip(&tops).zip(&heights) {
        let lowered = |tile: &RgbImage| i64::from(height - tile.height());
        replace(&mut picture, &row.label, MARGIN.into(), top + lowered(&row.label) / 2);
        for ((tile, &left), &width) in row.tiles.iter().zip(&lefts).zip(&widths) {
            replace(&mut picture, tile, left + middle(width, tile), top + lowered(tile));
        }
    }
    Ok(picture)
}

/// A bitmap as a picture.
fn ink(square: &SquareBitmap) -> Result<RgbImage, Error> {
    let SquareBitmap { side, pixels } = square;
    if side.checked_mul(*side) != Some(pixels.len()) {
        return Err(Error::InvalidParameter(format!(
            "a bitmap of {side} pixels a side has {} pixels; give it {side}×{side}",
            pixels.len()
        )));
    }
    let bitmap = bitmap(square);
    coverage(&bitmap, &bitmap.placement)
}

fn signed_error(prediction: &SquareBitmap, truth: &SquareBitmap) -> Result<RgbImage, Error> {
    if (prediction.side, prediction.pixels.len()) != (truth.side, truth.pixels.len()) {
        return Err(Error::InvalidParameter(format!(
            "a picture of {} pixels a side cannot be shown against one of {}; draw both at one size",
            prediction.side, truth.side
        )));
    }
    let truth = bitmap(truth);
    difference(&truth, &bitmap(prediction), &truth.placement)
}

/// A tile with a line around it.
fn boxed(tile: &RgbImage) -> RgbImage {
    let mut around = RgbImage::from_pixel(tile.width() + 2, tile.height() + 2, EDGE);
    replace(&mut around, tile, 1, 1);
    around
}

#[cfg(test)]
mod tests;
