//! Trainings on disk: the state that an interrupted one resumes from, and the result of a finished one.
//!
//! A checkpoint is one file that is replaced as a whole. It has four [records](nfr_convert::records): a heading with the
//! key of the training, the network, the optimiser, and the histories.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use burn::store::ModuleRecord;
use burn::tensor::Bytes;

use super::epochs::{read_histories, written_histories};
use super::{TrainableNetwork, Training};
use crate::files;
use nfr_convert::error::Error;
use nfr_convert::records::{append_record, records};

/// Begins the heading; a key of 8 bytes follows.
const MAGIC: &[u8; 10] = b"nfr lab 2\n";

/// Where a training is kept.
#[derive(Debug, Clone)]
pub struct Checkpoint {
    path: PathBuf,
    key: u64,
}

impl Checkpoint {
    /// The checkpoint file of a training with this key.
    pub fn new(path: PathBuf, key: u64) -> Self {
        Self { path, key }
    }

    /// The file's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The training that the file holds, or a new one of `network`.
    ///
    /// # Errors
    ///
    /// `Io` for a file that cannot be read or is of another training, `Malformed` for a damaged one.
    pub fn begin<L: TrainableNetwork>(&self, network: L) -> Result<Training<L>, Error> {
        let bytes = match fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Training::new(network)),
            Err(e) => return Err(self.unreadable(&e)),
        };
        let path = self.path.display();
        let damaged = || Error::Io(format!("{path} is damaged; delete it and train again"));
        let [heading, weights, optimizer, histories] = records(&bytes).ok_or_else(damaged)?;
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
        training.histories = read_histories(histories, training.network.networks()).ok_or_else(damaged)?;
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
        let histories = written_histories(&training.histories);
        let mut bytes = Vec::new();
        for payload in [&self.heading()[..], &weights[..], &optimizer[..], &histories] {
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
