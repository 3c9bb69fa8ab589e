//! The verdicts of another report, beside those of this one.

use std::fs;
use std::path::Path;

use nfr_convert::error::Error;

/// The file that has them.
pub(super) const CLAIMS: &str = "claims.csv";

/// Another report's measurements of the paper's claims.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OtherReport {
    /// Its label: scale, epochs, devices.
    pub label: String,
    claims: Vec<[String; 3]>,
}

impl OtherReport {
    /// Reads the claims of a report's directory.
    ///
    /// # Errors
    ///
    /// `Io` if the file cannot be read, or is no table of claims.
    pub fn read(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(CLAIMS);
        let text = fs::read_to_string(&path).map_err(|e| {
            Error::Io(format!("cannot read {} ({}); name a report's directory", path.display(), e.kind()))
        })?;
        Self::parsed(&text).ok_or_else(|| {
            Error::Io(format!("{} is no table of claims; write the report again", path.display()))
        })
    }

    fn parsed(text: &str) -> Option<Self> {
        let (label, table) = text.strip_prefix("# ")?.split_once('\n')?;
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let claim = |record: Result<csv::StringRecord, csv::Error>| {
            let record = record.ok()?;
            Some([record.get(0)?.to_owned(), record.get(1)?.to_owned(), record.get(2)?.to_owned()])
        };
        let claims = reader.records().map(claim).collect::<Option<Vec<_>>>()?;
        Some(Self { label: label.to_owned(), claims })
    }

    /// What it measured of a claim, and its verdict.
    pub fn claim(&self, statement: &str) -> Option<(&str, &str)> {
        let found = self.claims.iter().find(|claim| claim[0] == statement)?;
        Some((&found[1], &found[2]))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_claims_of_a_report_are_read_and_other_files_refused() {
        let directory = tempfile::tempdir().unwrap();
        let read = |text: &str| {
            fs::write(directory.path().join(CLAIMS), text).unwrap();
            OtherReport::read(directory.path())
        };
        let other = read("# published scale\nclaim,measured,verdict\n\"a, b\",1e-4,holds\n").unwrap();
        assert_eq!(other.label, "published scale");
        assert_eq!(other.claim("a, b"), Some(("1e-4", "holds")));
        assert_eq!(other.claim("c"), None);
        for text in ["", "claim,measured,verdict\n", "# label\nclaim\nalone\n"] {
            assert!(
                matches!(read(text), Err(Error::Io(why)) if why.contains("no table of claims")),
                "{text}"
            );
        }
        assert!(
            OtherReport::read(&directory.path().join("none"))
                .unwrap_err()
                .to_string()
                .contains("cannot read")
        );
    }
}
