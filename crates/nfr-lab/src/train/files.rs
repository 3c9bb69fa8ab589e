//! Where a training is kept: the state that it goes on from, and its result.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::checkpoint::Checkpoint;
use super::result::{ResultFile, TrainingResult};
use nfr::internals::table::{FNV_BASIS, fnv1a};
use nfr_convert::error::Error;

/// The files' names.
const CHECKPOINT: &str = "checkpoint";
const RESULT: &str = "result";
const UNFINISHED: &str = "unfinished";

/// The directory of one training.
#[derive(Debug, Clone)]
pub struct TrainingFiles {
    directory: PathBuf,
    key: u64,
}

impl TrainingFiles {
    /// The directory of a training that `description` determines: settings, seed, and training samples.
    ///
    /// # Errors
    ///
    /// `Io` if a training is kept there and `resume` is false.
    pub fn new(directory: PathBuf, description: &[u8], resume: bool) -> Result<Self, Error> {
        let files = Self { key: fnv1a(FNV_BASIS, description), directory };
        if !resume && (files.checkpoint().path().exists() || files.result().path().exists()) {
            return Err(Error::Io(format!(
                "{} holds a training; go on with it, or use it if it is finished, with --resume, or choose another \
                 directory with --out",
                files.directory.display()
            )));
        }
        Ok(files)
    }

    /// What determines the training.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Deletes the directory, which holds no result.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be deleted.
    pub fn discard(&self) -> Result<(), Error> {
        removed(self.checkpoint().path())?;
        match fs::remove_dir(&self.directory) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => {
                Err(Error::Io(format!("cannot delete {} ({})", self.directory.display(), e.kind())))
            }
            _ => Ok(()),
        }
    }

    /// The state that the training goes on from.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint::new(self.directory.join(CHECKPOINT), self.key)
    }

    fn result(&self) -> ResultFile {
        ResultFile::new(self.directory.join(RESULT), self.key)
    }

    /// The training's result, if it is finished here or in one of other directories, from where it is copied.
    ///
    /// # Errors
    ///
    /// `Io` for a file that cannot be read or written, is damaged, or is of another training.
    pub fn finished(&self, elsewhere: &[PathBuf]) -> Result<Option<TrainingResult>, Error> {
        if let Some(result) = self.result().read()? {
            return Ok(Some(result));
        }
        for directory in elsewhere {
            if let Some(result) = ResultFile::new(directory.join(RESULT), self.key).read()? {
                self.result().write(&result)?;
                return Ok(Some(result));
            }
        }
        Ok(None)
    }

    /// What an unfinished training has come to, here or else in one of other directories.
    ///
    /// # Errors
    ///
    /// As [`Self::finished`].
    pub fn unfinished(&self, elsewhere: &[PathBuf]) -> Result<Option<TrainingResult>, Error> {
        for directory in std::iter::once(&self.directory).chain(elsewhere) {
            if let Some(result) = ResultFile::new(directory.join(UNFINISHED), self.key).read()? {
                return Ok(Some(result));
            }
        }
        Ok(None)
    }

    /// Writes what an unfinished training has come to.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be written.
    pub fn leave(&self, result: &TrainingResult) -> Result<(), Error> {
        ResultFile::new(self.directory.join(UNFINISHED), self.key).write(result)
    }

    /// Writes the result. The network is kept only if it is asked for: a result is some kilobytes, a network of the published
    /// width and its optimiser more than 100 MB.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be written, or the network cannot be deleted.
    pub fn finish(&self, result: &TrainingResult, keep_network: bool) -> Result<(), Error> {
        self.result().write(result)?;
        removed(&self.directory.join(UNFINISHED))?;
        if keep_network {
            return Ok(());
        }
        removed(self.checkpoint().path())
    }
}

fn removed(path: &Path) -> Result<(), Error> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => {
            Err(Error::Io(format!("cannot delete {} ({})", path.display(), e.kind())))
        }
        _ => Ok(()),
    }
}
