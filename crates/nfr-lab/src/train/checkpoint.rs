//! Trainings on disk: the state that an interrupted one resumes from, and the result of a finished one.
//!
//! A checkpoint is one file that is replaced as a whole. It has four [records](nfr_convert::records): a heading with the
//! key of the training, the network, the optimiser, and the history.

use std::fs;
use std::io;
use std::path::PathBuf;

use burn::store::ModuleRecord;
use burn::tensor::Bytes;

use super::{Epoch, TrainableNetwork, Training};
use crate::files;
use nfr::internals::table::{FNV_BASIS, fnv1a};
use nfr_convert::error::Error;
use nfr_convert::records::{append_record, split_record};

/// Begins the heading; a key of 8 bytes follows.
const MAGIC: &[u8; 10] = b"nfr lab 2\n";
/// Bytes of a number in the heading and the history.
const NUMBER: usize = 8;
/// Bytes of an epoch in the file.
const EPOCH: usize = 3 * NUMBER;

/// Where a training is kept.
#[derive(Debug, Clone)]
pub struct Checkpoint {
    path: PathBuf,
    key: u64,
    resume: bool,
}

impl Checkpoint {
    /// A checkpoint file for a training that `description` determines: settings, seed, and training samples.
    ///
    /// # Errors
    ///
    /// `Io` if the file is there and `resume` is false.
    pub fn new(path: PathBuf, description: &[u8], resume: bool) -> Result<Self, Error> {
        if !resume && path.exists() {
            return Err(Error::Io(format!(
                "{} holds a training; go on with it, or use it if it is finished, with --resume, or choose another \
                 directory with --out",
                path.display()
            )));
        }
        Ok(Self { key: fnv1a(FNV_BASIS, description), path, resume })
    }

    /// The training that the file holds, or a new one of `network`.
    ///
    /// # Errors
    ///
    /// `Io` for a file that cannot be read or is of another training, `Malformed` for a damaged one.
    pub fn begin<L: TrainableNetwork>(&self, network: L) -> Result<Training<L>, Error> {
        let bytes = match fs::read(&self.path) {
            Ok(bytes) if self.resume => bytes,
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(self.unreadable(&e)),
            _ => return Ok(Training::new(network)),
        };
        let path = self.path.display();
        let damaged = || Error::Io(format!("{path} is damaged; delete it and train again"));
        let mut rest = bytes.as_slice();
        let mut record = || {
            let (payload, after) = split_record(rest)?;
            rest = after;
            Some(payload)
        };
        let records = [record(), record(), record(), record()];
        let [Some(heading), Some(weights), Some(optimizer), Some(history)] = records else {
            return Err(damaged());
        };
        if !rest.is_empty() {
            return Err(damaged());
        }
        if heading != self.heading() {
            return Err(Error::Io(format!(
                "{path} is of a training with other settings; repeat those, or choose another directory with --out"
            )));
        }
        let mut training = Training::new(network);
        let record =
            ModuleRecord::from_bytes(Bytes::from_bytes_vec(weights.to_vec())).map_err(|_| damaged())?;
        training.network = training.network.try_load_record(record).map_err(|_| damaged())?;
        training.optimizer = training
            .optimizer
            .from_bytes(Bytes::from_bytes_vec(optimizer.to_vec()))
            .map_err(|_| damaged())?;
        training.history = history.chunks_exact(EPOCH).map(read_epoch).collect();
        Ok(training)
    }

    /// Writes the training as it is by now; the file appears whole or not at all.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be written.
    pub fn save<L: TrainableNetwork>(&self, training: &Training<L>) -> Result<(), Error> {
        let failed =
            |e: &dyn std::fmt::Display| Error::Io(format!("cannot write {} ({e})", self.path.display()));
        let weights = training.network.clone().into_record().into_bytes().map_err(|e| failed(&e))?;
        let optimizer = training.optimizer.into_bytes().map_err(|e| failed(&e))?;
        let history: Vec<u8> = training.history.iter().flat_map(written_epoch).collect();
        let mut bytes = Vec::new();
        for payload in [&self.heading()[..], &weights[..], &optimizer[..], &history] {
            append_record(&mut bytes, payload);
        }
        files::write(&self.path, &bytes)
    }

    fn heading(&self) -> Vec<u8> {
        [MAGIC.as_slice(), &self.key.to_be_bytes()].concat()
    }

    fn unreadable(&self, error: &io::Error) -> Error {
        Error::Io(format!("cannot read {} ({})", self.path.display(), error.kind()))
    }
}

fn written_epoch(epoch: &Epoch) -> impl Iterator<Item = u8> {
    [epoch.rate, epoch.loss, epoch.seconds].into_iter().flat_map(f64::to_be_bytes)
}

fn read_epoch(bytes: &[u8]) -> Epoch {
    let mut numbers =
        bytes.chunks_exact(NUMBER).map(|number| f64::from_be_bytes(number.try_into().unwrap_or_default()));
    let mut next = || numbers.next().unwrap_or_default();
    Epoch { rate: next(), loss: next(), seconds: next() }
}
