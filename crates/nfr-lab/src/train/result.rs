//! The result of a finished training as a small file: what it drew and how it went, without the network.
//!
//! A result can be copied from machine to machine: it has the key of its training, which settings, seed and bitmaps determine, and
//! says on which device it was made. The file has four [records](nfr_convert::records): a heading with the key, a description in
//! JSON, the history, and the bitmaps, packed with zstd.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Epoch;
use super::epochs::{read_histories, written_histories};
use crate::SquareBitmap;
use crate::accelerator::Accelerator;
use crate::files;
use nfr_convert::error::Error;
use nfr_convert::records::{append_record, records};

/// Begins the heading; a key of 8 bytes follows.
const MAGIC: &[u8; 17] = b"nfr lab result 1\n";
/// zstd's level: results are written once.
const LEVEL: i32 = 19;
/// Bitmaps have at most so many pixels in all.
const MAX_PIXELS: usize = 1 << 26;

/// A finished training without its network.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingResult {
    /// Where and how it was trained.
    pub origin: TrainingOrigin,
    /// Its epochs.
    pub history: Vec<Epoch>,
    /// The network's bitmaps, in the order of the training's experiment.
    pub drawn: Vec<SquareBitmap>,
}

/// Where and how a network was trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrainingOrigin {
    /// The device.
    pub device: String,
    /// Whether its times say anything.
    pub timed: bool,
    /// Floating-point operations of the matrix products of all its steps.
    pub operations: u64,
    /// Networks that were trained in lockstep, this one included: times are a share of theirs.
    #[serde(default = "alone")]
    pub together: usize,
}

fn alone() -> usize {
    1
}

impl TrainingOrigin {
    /// A training of so many operations on a device, of so many networks in lockstep.
    pub fn new(accelerator: &Accelerator, operations: u64, together: usize) -> Self {
        Self { device: accelerator.to_string(), timed: accelerator.is_timed(), operations, together }
    }
}

#[derive(Serialize, Deserialize)]
struct Description {
    origin: TrainingOrigin,
    sides: Vec<usize>,
}

/// Where the result of a training is kept.
#[derive(Debug, Clone)]
pub struct ResultFile {
    path: PathBuf,
    key: u64,
}

impl ResultFile {
    /// The file of a training with this key.
    pub fn new(path: PathBuf, key: u64) -> Self {
        Self { path, key }
    }

    /// The file's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The result, if there is one.
    ///
    /// # Errors
    ///
    /// `Io` for a file that cannot be read, is damaged, or is of another training.
    pub fn read(&self) -> Result<Option<TrainingResult>, Error> {
        let path = self.path.display();
        let bytes = match fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(Error::Io(format!("cannot read {path} ({})", e.kind()))),
        };
        let damaged = || Error::Io(format!("{path} is damaged; delete it and train again"));
        let [heading, description, history, pixels] = records(&bytes).ok_or_else(damaged)?;
        if heading != self.heading() {
            return Err(Error::Io(format!(
                "{path} is of a training with other settings; repeat those, or choose another directory with --out"
            )));
        }
        decoded(description, history, pixels).map(Some).ok_or_else(damaged)
    }

    /// Writes a result; the file appears whole or not at all.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be written.
    pub fn write(&self, result: &TrainingResult) -> Result<(), Error> {
        let failed =
            |e: &dyn std::fmt::Display| Error::Io(format!("cannot write {} ({e})", self.path.display()));
        let description = Description {
            origin: result.origin.clone(),
            sides: result.drawn.iter().map(|square| square.side).collect(),
        };
        let description = serde_json::to_vec(&description).map_err(|e| failed(&e))?;
        let history = written_histories(std::slice::from_ref(&result.history));
        let pixels: Vec<u8> = result.drawn.iter().flat_map(|square| square.pixels.iter().copied()).collect();
        let pixels = zstd::bulk::compress(&pixels, LEVEL).map_err(|e| failed(&e))?;
        let mut bytes = Vec::new();
        for payload in [&self.heading(), &description, &history, &pixels] {
            append_record(&mut bytes, payload);
        }
        files::write(&self.path, &bytes)
    }

    fn heading(&self) -> Vec<u8> {
        [MAGIC.as_slice(), &self.key.to_be_bytes()].concat()
    }
}

fn decoded(description: &[u8], history: &[u8], pixels: &[u8]) -> Option<TrainingResult> {
    let Description { origin, sides } = serde_json::from_slice(description).ok()?;
    let mut count = 0usize;
    for side in &sides {
        count = count.checked_add(side.checked_mul(*side)?)?;
    }
    if count > MAX_PIXELS {
        return None;
    }
    let pixels = zstd::bulk::decompress(pixels, count).ok().filter(|pixels| pixels.len() == count)?;
    let mut rest = pixels.as_slice();
    let square = |side: usize| {
        let (pixels, after) = rest.split_at(side * side);
        rest = after;
        SquareBitmap { side, pixels: pixels.to_vec() }
    };
    let drawn = sides.into_iter().map(square).collect();
    Some(TrainingResult { origin, history: read_histories(history, 1)?.pop()?, drawn })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn result() -> TrainingResult {
        let square = |side: usize| SquareBitmap { side, pixels: (0..side * side).map(|k| k as u8).collect() };
        TrainingResult {
            origin: TrainingOrigin {
                device: "a card".into(),
                timed: true,
                operations: u64::MAX,
                together: 7,
            },
            history: vec![Epoch { rate: 1e-3, loss: f64::INFINITY, seconds: 0.25 }; 3],
            drawn: vec![square(20), square(3)],
        }
    }

    #[test]
    fn a_result_comes_back_as_it_was_and_of_no_other_training() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("made/result");
        let file = ResultFile::new(path.clone(), 7);
        assert_eq!(file.read(), Ok(None));
        file.write(&result()).unwrap();
        assert_eq!(file.read(), Ok(Some(result())));
        let other = ResultFile::new(path, 8).read().unwrap_err().to_string();
        assert!(other.contains("other settings"), "{other}");
    }

    #[test]
    fn damage_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let file = ResultFile::new(directory.path().join("result"), 7);
        file.write(&result()).unwrap();
        let bytes = fs::read(file.path()).unwrap();
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 4;
            fs::write(file.path(), damaged).unwrap();
            assert!(file.read().is_err(), "byte {at}");
            fs::write(file.path(), &bytes[..at]).unwrap();
            assert!(file.read().is_err(), "cut off at {at}");
        }
        // Whole records with contents that contradict each other.
        let description = |sides: &str| {
            format!(r#"{{"origin":{{"device":"","timed":true,"operations":0}},"sides":{sides}}}"#)
        };
        for sides in ["[2]", "[1,18446744073709551615]", "[4294967296,4294967296]", "[9000]"] {
            let mut bytes = Vec::new();
            let pixels = zstd::bulk::compress(&[0; 3], 1).unwrap();
            for payload in [&file.heading(), description(sides).as_bytes(), &[], &pixels] {
                append_record(&mut bytes, payload);
            }
            fs::write(file.path(), bytes).unwrap();
            assert!(file.read().is_err(), "{sides}");
        }
    }
}
