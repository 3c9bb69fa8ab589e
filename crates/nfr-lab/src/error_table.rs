//! Tables of errors, a row for each glyph and size, and their files.

use std::collections::BTreeMap;

use super::statistics::Summary;
use nfr_convert::error::Error;

/// The columns of the files.
const HEADER: [&str; 8] = ["model", "font", "glyph", "side", "ppem", "mse", "mae", "bad16"];

/// The error of one glyph at one size.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorRow {
    /// The model or method that drew the glyph.
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
    /// The fields in the order of [`HEADER`].
    fn record(&self) -> [String; 8] {
        let Self { model, font, glyph, side, ppem, mse, mae, bad16 } = self;
        let numbers = [mse, mae, bad16].map(f64::to_string);
        let [mse, mae, bad16] = numbers;
        [model.clone(), font.clone(), code_point(*glyph), side.to_string(), ppem.to_string(), mse, mae, bad16]
    }
}

/// A character as tables write it: `U+0061`.
pub fn code_point(character: char) -> String {
    format!("U+{:04X}", u32::from(character))
}

/// A table of comma-separated values (RFC 4180, but lines end in LF).
///
/// # Errors
///
/// `Io` for a record with another number of fields than the header's.
pub fn csv_table<const N: usize>(
    header: [&str; N],
    records: impl IntoIterator<Item = [String; N]>,
) -> Result<String, Error> {
    let failed = |e: &dyn std::fmt::Display| Error::Io(format!("a table cannot be written ({e})"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).map_err(|e| failed(&e))?;
    for record in records {
        writer.write_record(record).map_err(|e| failed(&e))?;
    }
    let bytes = writer.into_inner().map_err(|e| failed(&e))?;
    String::from_utf8(bytes).map_err(|e| failed(&e))
}

/// The rows as a table of comma-separated values under a header: model, font, glyph (as U+0061), side in pixels,
/// pixels per em, mse, mae, bad16. Numbers are written with all digits.
///
/// # Errors
///
/// As [`csv_table`].
pub fn write_csv(rows: &[ErrorRow]) -> Result<String, Error> {
    csv_table(HEADER, rows.iter().map(ErrorRow::record))
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
    fn a_table_comes_back_as_it_was() {
        let rows = [row("field", 20, 1.0 / 3.0), row("a,\"b\"", 63, 0.0)];
        let table = write_csv(&rows).unwrap();
        assert!(table.contains("\nfield,Liberation Sans,U+00E9,20,17,0.3333333333333333,"), "{table}");
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        assert_eq!(reader.headers().unwrap(), HEADER.as_slice());
        for (row, record) in rows.iter().zip(reader.records()) {
            let record = record.unwrap();
            assert_eq!(&record, row.record().as_slice());
            assert_eq!([&record[5], &record[6]].map(|v| v.parse::<f64>().unwrap()), [row.mse, row.mae]);
        }
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
