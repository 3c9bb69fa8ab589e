//! Files of experiments: each appears whole or not at all.

use std::fs;
use std::io::Write;
use std::path::Path;

use nfr_convert::error::Error;
use nfr_convert::temporary::beside;

/// Writes a file, and the directories that it is in.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let written = directory.map_or(Ok(()), fs::create_dir_all).and_then(|()| {
        let mut file = beside(path)?;
        file.write_all(bytes)?;
        file.persist(path).map(drop).map_err(|e| e.error)
    });
    written.map_err(|e| {
        Error::Io(format!(
            "cannot write {} ({}); choose a place that you may write to",
            path.display(),
            e.kind()
        ))
    })
}
