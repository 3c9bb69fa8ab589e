//! Files of experiments: each appears whole or not at all.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

use nfr_convert::error::Error;
use nfr_convert::temporary::beside;

/// Writes a file, and the directories that it is in. A full disk leaves what was there, and no part of the new file.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let written = directory.map_or(Ok(()), fs::create_dir_all).and_then(|()| {
        let mut file = beside(path)?;
        file.write_all(bytes)?;
        // Some file systems say only here that they are full.
        file.as_file().sync_all()?;
        file.persist(path).map(drop).map_err(|e| e.error)
    });
    written.map_err(|e| {
        let advice = match e.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
                "make room there, and go on with --resume"
            }
            _ => "choose a place that you may write to",
        };
        Error::Io(format!("cannot write {} ({}); {advice}", path.display(), e.kind()))
    })
}
