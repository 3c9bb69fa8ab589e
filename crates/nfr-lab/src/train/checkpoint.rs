//! Trainings on disk: what an interrupted one goes on from, and what a finished one left.
//!
//! A checkpoint is one file that is replaced as a whole: a heading with the key of what is trained, then network,
//! optimiser and history, each after its length, and a checksum.

use std::fs;
use std::io;
use std::path::PathBuf;

use burn::store::ModuleRecord;
use burn::tensor::Bytes;

use super::{Epoch, Learner, Run};
use crate::files;
use nfr::internals::table::{FNV_BASIS, fnv1a};
use nfr_convert::error::Error;

/// Begins the file; a key of 8 bytes follows.
const MAGIC: &[u8; 10] = b"nfr lab 1\n";
/// Bytes of a number in the file: lengths, the key, the checksum.
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
    /// A checkpoint file for a training that `described` determines: settings, seed, and what is learnt.
    ///
    /// # Errors
    ///
    /// `Io` if the file is there and `resume` is not asked for.
    pub fn new(path: PathBuf, described: &[u8], resume: bool) -> Result<Self, Error> {
        if !resume && path.exists() {
            return Err(Error::Io(format!(
                "{} holds a training; go on with it, or use it if it is finished, with --resume, or choose another \
                 directory with --out",
                path.display()
            )));
        }
        Ok(Self { key: fnv1a(FNV_BASIS, described), path, resume })
    }

    /// The training that the file holds, or a new one of `network`.
    ///
    /// # Errors
    ///
    /// `Io` for a file that cannot be read or is of another training, `Malformed` for a damaged one.
    pub fn begin<L: Learner>(&self, network: L) -> Result<Run<L>, Error> {
        let bytes = match fs::read(&self.path) {
            Ok(bytes) if self.resume => bytes,
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(self.unreadable(&e)),
            _ => return Ok(Run::new(network)),
        };
        let shown = self.path.display();
        let damaged = || Error::Io(format!("{shown} is damaged; delete it and train again"));
        let Some((body, sum)) = bytes.split_last_chunk::<NUMBER>() else { return Err(damaged()) };
        if fnv1a(FNV_BASIS, body) != u64::from_be_bytes(*sum) {
            return Err(damaged());
        }
        let rest = body.strip_prefix(MAGIC).and_then(|rest| rest.strip_prefix(&self.key.to_be_bytes()));
        let mut rest = rest.ok_or_else(|| {
            Error::Io(format!(
                "{shown} is of a training with other settings; repeat those, or choose another directory with --out"
            ))
        })?;
        let mut part = || {
            let (length, after) = rest.split_first_chunk::<NUMBER>()?;
            let (part, after) = after.split_at_checked(usize::try_from(u64::from_be_bytes(*length)).ok()?)?;
            rest = after;
            Some(part)
        };
        let parts = [part(), part(), part()];
        let [Some(weights), Some(optimizer), Some(history)] = parts else { return Err(damaged()) };
        let mut run = Run::new(network);
        let record =
            ModuleRecord::from_bytes(Bytes::from_bytes_vec(weights.to_vec())).map_err(|_| damaged())?;
        run.network = run.network.try_load_record(record).map_err(|_| damaged())?;
        run.optimizer =
            run.optimizer.from_bytes(Bytes::from_bytes_vec(optimizer.to_vec())).map_err(|_| damaged())?;
        run.history = history.chunks_exact(EPOCH).map(read_epoch).collect();
        Ok(run)
    }

    /// Writes the training as it is by now; the file appears whole or not at all.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be written.
    pub fn save<L: Learner>(&self, run: &Run<L>) -> Result<(), Error> {
        let failed =
            |e: &dyn std::fmt::Display| Error::Io(format!("cannot write {} ({e})", self.path.display()));
        let weights = run.network.clone().into_record().into_bytes().map_err(|e| failed(&e))?;
        let optimizer = run.optimizer.into_bytes().map_err(|e| failed(&e))?;
        let history: Vec<u8> = run.history.iter().flat_map(written_epoch).collect();
        let mut bytes = [MAGIC.as_slice(), &self.key.to_be_bytes()].concat();
        for part in [&weights[..], &optimizer[..], &history] {
            bytes.extend((part.len() as u64).to_be_bytes());
            bytes.extend_from_slice(part);
        }
        bytes.extend(fnv1a(FNV_BASIS, &bytes).to_be_bytes());
        files::write(&self.path, &bytes)
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
