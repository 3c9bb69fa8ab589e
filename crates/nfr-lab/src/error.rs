//! How wrong a picture of a glyph is, and tables of that.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::Square;
use nfr::{Bitmap, Placement};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::error::Error;

/// The columns of the tables.
const HEADER: &str = "model,font,glyph,side,ppem,mse,mae,bad16";

/// The error of a picture against the truth, over all pixels of the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelError {
    /// Mean squared error with coverage 0..1, the paper's measure.
    pub mse: f64,
    /// Mean absolute error with coverage 0..1.
    pub mae: f64,
    /// Share of pixels off by more than 16/255.
    pub bad16: f64,
}

/// Measures a picture against the truth.
///
/// # Errors
///
/// `InvalidParameter` if the two differ in size.
pub fn pixel_error(truth: &Square, other: &Square) -> Result<PixelError, Error> {
    if (truth.side, truth.pixels.len()) != (other.side, other.pixels.len()) {
        return Err(Error::InvalidParameter(format!(
            "a picture of {} pixels a side cannot be measured against one of {}; draw both at one size",
            other.side, truth.side
        )));
    }
    let figures = Sums::of(&bitmap(truth), &bitmap(other)).figures();
    Ok(PixelError { mse: figures.rmse * figures.rmse, mae: figures.mae, bad16: figures.bad16 })
}

/// The whole box as a bitmap, the pen in the lower left corner.
pub(super) fn bitmap(square: &Square) -> Bitmap {
    let side = square.side as u32;
    let placement = Placement { left: 0, top: side as i32, width: side, height: side };
    Bitmap { placement, pixels: square.pixels.clone() }
}

/// The error of one glyph at one size.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorRow {
    /// What drew the glyph. No commas or line breaks, as in `font`.
    pub model: String,
    /// The font's name.
    pub font: String,
    /// The character that was drawn.
    pub glyph: char,
    /// Pixels along a side of the box.
    pub side: usize,
    /// Pixels per em.
    pub ppem: u16,
    /// Mean squared error, 0..1.
    pub mse: f64,
    /// Mean absolute error, 0..1.
    pub mae: f64,
    /// Share of pixels off by more than 16/255.
    pub bad16: f64,
}

impl ErrorRow {
    /// The fields that [`write_csv`] writes, in the order of its header.
    fn line(&self) -> String {
        let Self { model, font, glyph, side, ppem, mse, mae, bad16 } = self;
        format!("{model},{font},U+{:04X},{side},{ppem},{mse},{mae},{bad16}", u32::from(*glyph))
    }

    fn parse(line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let [model, font, glyph, side, ppem, mse, mae, bad16] = fields[..] else { return None };
        let code = u32::from_str_radix(glyph.strip_prefix("U+")?, 16).ok()?;
        let number = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
        Some(Self {
            model: model.into(),
            font: font.into(),
            glyph: char::from_u32(code)?,
            side: side.parse().ok()?,
            ppem: ppem.parse().ok()?,
            mse: number(mse)?,
            mae: number(mae)?,
            bad16: number(bad16)?,
        })
    }
}

/// The rows as a table of comma-separated values under a header: model, font, glyph (as U+0061), side in pixels,
/// pixels per em, mse, mae, bad16. Numbers come back from [`read_csv`] exactly.
///
/// # Errors
///
/// `InvalidParameter` for a name with a comma or a line break.
pub fn write_csv(rows: &[ErrorRow]) -> Result<String, Error> {
    let mut table = format!("{HEADER}\n");
    for row in rows {
        if let Some(name) = [&row.model, &row.font].into_iter().find(|name| name.contains([',', '\n', '\r']))
        {
            return Err(Error::InvalidParameter(format!(
                "the name {name:?} has a comma or a line break, which tables cannot hold; choose another"
            )));
        }
        let _ = writeln!(table, "{}", row.line());
    }
    Ok(table)
}

/// Reads a table that [`write_csv`] made.
///
/// # Errors
///
/// `InvalidParameter`, naming the line that is not as `write_csv` writes it.
pub fn read_csv(table: &str) -> Result<Vec<ErrorRow>, Error> {
    let wrong = |line: usize, expected: &str| {
        Error::InvalidParameter(format!("line {line} of the error table is not {expected}; measure again"))
    };
    let mut lines = table.lines();
    if lines.next() != Some(HEADER) {
        return Err(wrong(1, HEADER));
    }
    let row = |(line, text)| ErrorRow::parse(text).ok_or_else(|| wrong(line, "a row with eight good fields"));
    (2..).zip(lines).map(row).collect()
}

/// What is typical of some numbers, and how far they spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// How many there are.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, of these very numbers (divided by their count).
    pub deviation: f64,
    /// The smallest, the quartiles and the largest; the middle one is the median.
    pub quartiles: [f64; 5],
}

impl Summary {
    /// Summarises numbers; `None` without any.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count as f64;
        let at = |part| quantile(&values, part);
        let quartiles = [at(0.0)?, at(0.25)?, at(0.5)?, at(0.75)?, at(1.0)?];
        Some(Self { count, mean, deviation: variance.sqrt(), quartiles })
    }

    /// The middle of the numbers.
    pub fn median(&self) -> f64 {
        self.quartiles[2]
    }
}

/// The value below which a part (0..1) of ascending numbers lies, straight between the two nearest. `None` without
/// any numbers.
pub fn quantile(ascending: &[f64], part: f64) -> Option<f64> {
    let place = part.clamp(0.0, 1.0) * ascending.len().checked_sub(1)? as f64;
    let (low, high) = (ascending[place.floor() as usize], ascending[place.ceil() as usize]);
    Some(low + (high - low) * place.fract())
}

/// Summarises the mean squared errors of the rows that share a key, such as `|row| (row.model.clone(), row.side)`;
/// keys ascending.
pub fn summaries<K: Ord>(rows: &[ErrorRow], key: impl Fn(&ErrorRow) -> K) -> BTreeMap<K, Summary> {
    let mut groups: BTreeMap<K, Vec<f64>> = BTreeMap::new();
    for row in rows {
        groups.entry(key(row)).or_default().push(row.mse);
    }
    groups.into_iter().filter_map(|(key, values)| Some((key, Summary::of(values)?))).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn row(model: &str, side: usize, mse: f64) -> ErrorRow {
        let (model, font) = (model.into(), "Liberation Sans".into());
        ErrorRow { model, font, glyph: 'é', side, ppem: 17, mse, mae: 0.1 + 0.2, bad16: 0.0 }
    }

    #[test]
    fn every_pixel_of_the_box_counts() {
        let truth = Square { side: 2, pixels: vec![0, 255, 100, 0] };
        let other = Square { side: 2, pixels: vec![0, 0, 116, 17] };
        let error = pixel_error(&truth, &other).unwrap();
        // Off by 255, 16 and 17 levels in three of four pixels.
        let squared = (255.0 * 255.0 + 16.0 * 16.0 + 17.0 * 17.0) / 4.0 / 255.0 / 255.0;
        assert!((error.mse - squared).abs() < 1e-15);
        assert!((error.mae - 288.0 / 4.0 / 255.0).abs() < 1e-15);
        assert_eq!(error.bad16, 0.5);
    }

    #[test]
    fn pictures_of_two_sizes_are_not_compared() {
        let square = |side| Square { side, pixels: vec![0; side * side] };
        let error = pixel_error(&square(2), &square(3)).unwrap_err().to_string();
        assert!(error.contains("one of 2"), "{error}");
    }

    #[test]
    fn a_table_comes_back_as_it_was() {
        let rows = [row("field", 20, 1.0 / 3.0), row("grid", 63, 0.0)];
        let table = write_csv(&rows).unwrap();
        assert!(table.contains("\nfield,Liberation Sans,U+00E9,20,17,0.3333333333333333,"), "{table}");
        assert_eq!(read_csv(&table).unwrap(), rows);
    }

    #[test]
    fn a_name_with_a_comma_and_a_damaged_line_are_named() {
        assert!(write_csv(&[row("a,b", 20, 0.0)]).unwrap_err().to_string().contains("a,b"));
        let table = write_csv(&[row("field", 20, 0.5)]).unwrap();
        for (damaged, line) in [
            (table.replace("U+00E9", "U+D800"), "line 2"),
            (table.replace(",0.5,", ",NaN,"), "line 2"),
            (table.replace(",17,", ","), "line 2"),
            (table.replace("mse", "rmse"), "line 1"),
        ] {
            let error = read_csv(&damaged).unwrap_err().to_string();
            assert!(error.contains(line), "{error}");
        }
    }

    #[test]
    fn a_summary_is_that_of_the_textbook() {
        // Mean 5, squared deviations 9+1+1+1+0+0+4+16 = 32 over 8 values.
        let summary = Summary::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert_eq!((summary.count, summary.mean, summary.deviation, summary.median()), (8, 5.0, 2.0, 4.5));
        // Places 0, 1.75, 3.5, 5.25 and 7 of the list.
        assert_eq!(summary.quartiles, [2.0, 4.0, 4.5, 5.5, 9.0]);
        assert_eq!(Summary::of([]), None);
        assert_eq!(Summary::of([3.0]).unwrap().quartiles, [3.0; 5]);
    }

    #[test]
    fn rows_are_summarised_by_what_is_asked_for() {
        let rows = [row("grid", 21, 3.0), row("field", 20, 1.0), row("grid", 20, 5.0)];
        let by_model = summaries(&rows, |row| row.model.clone());
        assert!(
            by_model.iter().map(|(model, s)| (model.as_str(), s.mean)).eq([("field", 1.0), ("grid", 4.0)])
        );
        let by_side = summaries(&rows, |row| row.side);
        assert!(by_side.iter().map(|(side, s)| (*side, s.count)).eq([(20, 2), (21, 1)]));
    }
}
