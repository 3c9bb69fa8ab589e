//! The table for people and the JSON.

use std::fmt::Write;

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// The last rows: a name, and the name that its time is divided by.
const RATIOS: [(&str, &str); 4] =
    [("nfr", "fontdue"), ("nfr", "skrifa_zeno"), ("nfr_open", "skrifa_cold"), ("nfr_next", "skrifa_zeno")];

/// The width of the names.
const NAMES: usize = 22;
/// The width of a size's column.
const COLUMN: usize = 9;

/// What was measured at a size.
pub(super) struct Measured {
    pub(super) ppem: u16,
    /// Names and microseconds a glyph.
    pub(super) times: Vec<(&'static str, f64)>,
}

impl Measured {
    fn ratio(&self, (ours, theirs): (&str, &str)) -> f64 {
        let time = |name| self.times.iter().find(|time| time.0 == name).map_or(f64::NAN, |time| time.1);
        time(ours) / time(theirs)
    }
}

/// One object: the size, and the times to the nanosecond.
impl Serialize for Measured {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1 + self.times.len()))?;
        map.serialize_entry("ppem", &self.ppem)?;
        for (name, time) in &self.times {
            map.serialize_entry(name, &((time * 1e3).round() / 1e3))?;
        }
        map.end()
    }
}

/// A row for each name, with what it stands for, and for each ratio; a column for each size.
pub(super) fn for_people(rows: &[(&str, &str)], sizes: &[Measured]) -> String {
    let mut text = String::new();
    let columns = sizes.iter().map(|size| format!("{:>COLUMN$}", size.ppem));
    let _ = writeln!(text, "{:NAMES$}{}", "ppem", columns.collect::<String>());
    for (row, (name, about)) in rows.iter().enumerate() {
        let columns = sizes.iter().map(|size| format!("{:>COLUMN$.2}", size.times[row].1));
        let _ = writeln!(text, "{name:NAMES$}{}  {about}", columns.collect::<String>());
    }
    text.push('\n');
    for (ours, theirs) in RATIOS {
        let columns = sizes.iter().map(|size| format!("{:>COLUMN$.2}", size.ratio((ours, theirs))));
        let name = format!("{ours} / {theirs}");
        let _ = writeln!(text, "{name:NAMES$}{}", columns.collect::<String>());
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn measured(ppem: u16, nfr: f64) -> Measured {
        let times = [nfr, 20.0, 160.0, 0.5, 4.0, 32.0];
        let names = ["nfr", "nfr_next", "nfr_open", "fontdue", "skrifa_zeno", "skrifa_cold"];
        Measured { ppem, times: names.into_iter().zip(times).collect() }
    }

    #[test]
    fn the_table_ends_with_ratios() {
        let sizes = [measured(12, 1.0), measured(16, 2.0)];
        let rows: Vec<_> = sizes[0].times.iter().map(|(name, _)| (*name, "note")).collect();
        let table = for_people(&rows, &sizes);
        let words: Vec<String> =
            table.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        assert_eq!(words[..2], ["ppem 12 16", "nfr 1.00 2.00 note"]);
        let ratios = [
            "nfr / fontdue 2.00 4.00",
            "nfr / skrifa_zeno 0.25 0.50",
            "nfr_open / skrifa_cold 5.00 5.00",
            "nfr_next / skrifa_zeno 5.00 5.00",
        ];
        assert_eq!(words[words.len() - RATIOS.len()..], ratios);
    }

    #[test]
    fn the_json_has_the_size_and_every_time() {
        let json = serde_json::to_value(measured(12, 0.123_456)).unwrap();
        assert_eq!((&json["ppem"], &json["nfr"]), (&12.into(), &0.123.into()));
        assert_eq!(json.as_object().unwrap().len(), 7);
    }
}
