//! Pictures of bitmaps for the report, as PNG files: ink black on white, each pixel enlarged to a square.

use image::codecs::png::PngEncoder;
use image::imageops::{FilterType, crop_imm, replace, resize};
use image::{ExtendedColorType, ImageEncoder, Rgb, RgbImage};

use super::Square;
use nfr_convert::compare::picture::{DIFFERENCE_GAIN, Row, sheet};
use nfr_convert::error::Error;

const WHITE: Rgb<u8> = Rgb([255; 3]);
/// The line around a box, one pixel wide.
const EDGE: Rgb<u8> = Rgb([205; 3]);
/// White space between bitmaps, and around the picture, in pixels.
const GAP: u32 = 8;
const MARGIN: u32 = 12;
/// From this enlargement on, labels are enlarged twice, to match; it is what `sheet` takes for that.
const ZOOM_OF_LARGE_LABELS: u32 = 3;
/// No picture has more pixels: what memory and viewers manage at once.
const MAX_PIXELS: u64 = 64_000_000;

/// A model's picture of a glyph, and what it should be.
#[derive(Debug, Clone, Copy)]
pub struct Comparison<'c> {
    /// What stands at the left, such as the model and the size. Small letters, digits, `.`, `-` and `%` are drawn,
    /// capitals as small letters.
    pub label: &'c str,
    /// The model's picture.
    pub prediction: &'c Square,
    /// The hinted bitmap of the same size.
    pub truth: &'c Square,
}

/// A row of bitmaps under a common label.
#[derive(Debug, Clone)]
pub struct Strip<'s> {
    /// What stands at the left, in letters as those of [`Comparison`].
    pub label: &'s str,
    /// The bitmaps, of any sizes.
    pub squares: Vec<&'s Square>,
}

/// Rows of prediction, error and truth, each pixel `zoom`×`zoom`. The error is red where the prediction is too dark
/// and blue where it is too light, [`DIFFERENCE_GAIN`] times as strong as it is.
///
/// # Errors
///
/// `InvalidParameter` if a prediction and its truth differ in size; `LimitExceeded` for a picture that is too large.
pub fn triptychs(rows: &[Comparison<'_>], zoom: u32) -> Result<Vec<u8>, Error> {
    let tiles = |row: &Comparison<'_>| {
        let error = signed_error(row.prediction, row.truth)?;
        let tiles = [ink(row.prediction)?, error, ink(row.truth)?].map(|tile| boxed(&enlarged(&tile, zoom)));
        Ok(Tiles { label: row.label.into(), tiles: tiles.into() })
    };
    let rows = rows.iter().map(tiles).collect::<Result<Vec<_>, Error>>()?;
    png(&table(&["model", "error", "truth"].map(String::from), &rows, zoom)?)
}

/// Rows of bitmaps in boxes, under the columns' headings, each pixel `zoom`×`zoom`.
///
/// # Errors
///
/// `InvalidParameter` for a bitmap with a wrong number of pixels; `LimitExceeded` for a picture that is too large.
pub fn strips(headings: &[&str], rows: &[Strip<'_>], zoom: u32) -> Result<Vec<u8>, Error> {
    let tiles = |row: &Strip<'_>| {
        let tiles = row.squares.iter().map(|square| Ok(boxed(&enlarged(&ink(square)?, zoom))));
        Ok(Tiles { label: row.label.into(), tiles: tiles.collect::<Result<_, Error>>()? })
    };
    let rows = rows.iter().map(tiles).collect::<Result<Vec<_>, Error>>()?;
    let headings: Vec<String> = headings.iter().map(|heading| heading.to_string()).collect();
    png(&table(&headings, &rows, zoom)?)
}

/// One glyph at many sizes, a row for each model, under the sizes in pixels; after so many `columns` all rows go on
/// below. The rows' bitmaps of one column have one size.
///
/// # Errors
///
/// `InvalidParameter` for a bitmap with a wrong number of pixels; `LimitExceeded` for a picture that is too large.
pub fn cascade(models: &[Strip<'_>], columns: usize, zoom: u32) -> Result<Vec<u8>, Error> {
    let count = models.iter().map(|model| model.squares.len()).max().unwrap_or(0);
    let mut blocks = Vec::new();
    for start in (0..count).step_by(columns.max(1)) {
        let end = start + columns.max(1);
        let longest = models.iter().map(|model| piece(model, start, end)).max_by_key(|p| p.len());
        let longest = longest.unwrap_or_default();
        let headings: Vec<String> = longest.iter().map(|square| square.side.to_string()).collect();
        let tiles = |model: &Strip<'_>| {
            let tiles = piece(model, start, end).iter().map(|square| Ok(enlarged(&ink(square)?, zoom)));
            Ok(Tiles { label: model.label.into(), tiles: tiles.collect::<Result<_, Error>>()? })
        };
        let rows = models.iter().map(tiles).collect::<Result<Vec<_>, Error>>()?;
        blocks.push(table(&headings, &rows, zoom)?);
    }
    let width = blocks.iter().map(RgbImage::width).max().unwrap_or(1);
    let height = blocks.iter().map(|block| u64::from(block.height())).sum::<u64>().max(1);
    let mut picture = blank(width.into(), height)?;
    let mut y = 0;
    for block in &blocks {
        replace(&mut picture, block, 0, y);
        y += i64::from(block.height());
    }
    png(&picture)
}

/// A picture with a line of text below it, in letters as those of [`Comparison`].
///
/// # Errors
///
/// `LimitExceeded` for a picture that cannot be read, or that becomes too large.
pub fn noted(picture: &[u8], note: &str) -> Result<Vec<u8>, Error> {
    let picture = image::load_from_memory(picture)
        .map_err(|e| Error::LimitExceeded(format!("a picture cannot be read again ({e})")))?
        .into_rgb8();
    let note = letters(note, 1)?;
    let width = picture.width().max(note.width() + 2 * MARGIN);
    let mut whole = blank(width.into(), u64::from(picture.height() + note.height() + MARGIN))?;
    replace(&mut whole, &picture, 0, 0);
    replace(&mut whole, &note, MARGIN.into(), picture.height().into());
    png(&whole)
}

/// The bitmaps of a row from `start` to before `end`, as far as there are any.
fn piece<'s, 'p>(row: &'p Strip<'s>, start: usize, end: usize) -> &'p [&'s Square] {
    let count = row.squares.len();
    &row.squares[start.min(count)..end.min(count)]
}

/// A row of finished tiles.
struct Tiles {
    label: String,
    tiles: Vec<RgbImage>,
}

/// Tiles in rows and columns: labels at the left, headings above, every tile at the bottom of its row.
fn table(headings: &[String], rows: &[Tiles], zoom: u32) -> Result<RgbImage, Error> {
    let written = |texts: &mut dyn Iterator<Item = &String>| -> Result<Vec<RgbImage>, Error> {
        texts.map(|text| letters(text, zoom)).collect()
    };
    let labels = written(&mut rows.iter().map(|row| &row.label))?;
    let headings = written(&mut headings.iter())?;
    let columns = rows.iter().map(|row| row.tiles.len()).max().unwrap_or(0).max(headings.len());
    let tiles = |column: usize| rows.iter().filter_map(move |row| row.tiles.get(column));
    let widths: Vec<u32> = (0..columns)
        .map(|column| tiles(column).chain(headings.get(column)).map(RgbImage::width).max().unwrap_or(0))
        .collect();
    let heights: Vec<u32> = rows
        .iter()
        .zip(&labels)
        .map(|(row, label)| row.tiles.iter().chain([label]).map(RgbImage::height).max().unwrap_or(0))
        .collect();
    let label_width = labels.iter().map(RgbImage::width).max().unwrap_or(0);
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
    for (((row, label), &top), &height) in rows.iter().zip(&labels).zip(&tops).zip(&heights) {
        let lowered = |tile: &RgbImage| i64::from(height - tile.height());
        replace(&mut picture, label, MARGIN.into(), top + lowered(label) / 2);
        for ((tile, &left), &width) in row.tiles.iter().zip(&lefts).zip(&widths) {
            replace(&mut picture, tile, left + middle(width, tile), top + lowered(tile));
        }
    }
    Ok(picture)
}

/// A text in the letters of the comparison's pictures, without white space around; no pixels for no text.
fn letters(text: &str, zoom: u32) -> Result<RgbImage, Error> {
    let row = Row { label: text.to_lowercase(), cells: Vec::new() };
    let zoom = zoom.clamp(1, ZOOM_OF_LARGE_LABELS);
    let file = sheet(&[], &[row], zoom)?.png()?;
    let picture = image::load_from_memory(&file)
        .map_err(|e| Error::LimitExceeded(format!("the label {text:?} cannot be drawn ({e}); shorten it")))?
        .into_rgb8();
    let inked = |x: u32, y: u32| *picture.get_pixel(x, y) != WHITE;
    let columns = (0..picture.width()).filter(|&x| (0..picture.height()).any(|y| inked(x, y)));
    let (Some(left), Some(right)) = (columns.clone().min(), columns.max()) else {
        return Ok(RgbImage::new(0, 0));
    };
    // The rows stay, so that all labels have one baseline.
    Ok(crop_imm(&picture, left, GAP, right + 1 - left, picture.height() - 2 * GAP).to_image())
}

/// A bitmap as a picture.
fn ink(square: &Square) -> Result<RgbImage, Error> {
    picture(square, |pixel| Rgb([255 - square.pixels[pixel]; 3]))
}

fn signed_error(prediction: &Square, truth: &Square) -> Result<RgbImage, Error> {
    if (prediction.side, prediction.pixels.len()) != (truth.side, truth.pixels.len()) {
        return Err(Error::InvalidParameter(format!(
            "a picture of {} pixels a side cannot be shown against one of {}; draw both at one size",
            prediction.side, truth.side
        )));
    }
    picture(prediction, |pixel| {
        let (ours, truth) = (prediction.pixels[pixel], truth.pixels[pixel]);
        let rest = 255 - (u16::from(ours.abs_diff(truth)) * DIFFERENCE_GAIN).min(255) as u8;
        Rgb(if ours > truth { [255, rest, rest] } else { [rest, rest, 255] })
    })
}

/// A picture of a bitmap's pixels, each in the colour for its index.
fn picture(square: &Square, colour: impl Fn(usize) -> Rgb<u8>) -> Result<RgbImage, Error> {
    let Square { side, pixels } = square;
    if side.checked_mul(*side) != Some(pixels.len()) {
        return Err(Error::InvalidParameter(format!(
            "a bitmap of {side} pixels a side has {} pixels; give it {side}×{side}",
            pixels.len()
        )));
    }
    Ok(RgbImage::from_fn(*side as u32, *side as u32, |x, y| colour(y as usize * side + x as usize)))
}

fn enlarged(tile: &RgbImage, zoom: u32) -> RgbImage {
    resize(tile, tile.width() * zoom.max(1), tile.height() * zoom.max(1), FilterType::Nearest)
}

/// A tile with a line around it.
fn boxed(tile: &RgbImage) -> RgbImage {
    let mut around = RgbImage::from_pixel(tile.width() + 2, tile.height() + 2, EDGE);
    replace(&mut around, tile, 1, 1);
    around
}

fn blank(width: u64, height: u64) -> Result<RgbImage, Error> {
    match (u32::try_from(width), u32::try_from(height)) {
        (Ok(w), Ok(h)) if width * height <= MAX_PIXELS => Ok(RgbImage::from_pixel(w, h, WHITE)),
        _ => Err(Error::LimitExceeded(format!(
            "the picture would have {width}×{height} pixels; show fewer bitmaps, or enlarge less"
        ))),
    }
}

fn png(picture: &RgbImage) -> Result<Vec<u8>, Error> {
    let (width, height) = picture.dimensions();
    let mut file = Vec::new();
    PngEncoder::new(&mut file).write_image(picture, width, height, ExtendedColorType::Rgb8).map_err(|e| {
        Error::LimitExceeded(format!("a picture of {width}×{height} pixels cannot be written ({e})"))
    })?;
    Ok(file)
}

#[cfg(test)]
mod tests;
