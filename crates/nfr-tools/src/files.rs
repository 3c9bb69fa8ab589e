//! Files that tools read and write.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use read_fonts::FontRef;

use super::failure::Failure;
use super::interrupt::uninterrupted;
use nfr::Font;
use nfr_convert::open::{has_models, open};
use nfr_convert::temporary::beside;

/// Reads a whole file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    fs::read(path)
        .map_err(|e| Failure::failed(format!("cannot read {} ({e}); check the path", path.display())))
}

/// Opens a font that carries models, both as a plain font file and to render from.
pub(super) fn open_neural<'a>(path: &Path, data: &'a [u8]) -> Result<(FontRef<'a>, Font), Failure> {
    let file = open(data, 0).map_err(|e| Failure::from(e).at(path.display()))?;
    if !has_models(&file) {
        return Err(Failure::failed(format!(
            "{}: the font has no 'Nfrt' table, so it has no glyph models; make one that has with nfr-convert",
            path.display()
        )));
    }
    let font = Font::new(data.to_vec()).map_err(|e| Failure::from(e).at(path.display()))?;
    Ok((file, font))
}

/// The glyphs of a neural font that have models, ascending.
pub(super) fn modelled(font: &Font) -> Result<Vec<u16>, Failure> {
    Ok(nfr::internals::table(font)?.gids().collect())
}

/// A file to be written at the end of the work. It appears whole or not at all.
#[derive(Debug)]
pub(super) struct Output {
    path: PathBuf,
    destination: Destination,
}

#[derive(Debug, PartialEq)]
enum Destination {
    /// Written beside its place, then renamed into it.
    Regular,
    /// A pipe or a device, which must not be replaced.
    Special,
}

impl Output {
    /// Checks before the work that the file can be written. Nothing is created.
    pub(super) fn new(path: &Path) -> Result<Self, Failure> {
        let (path, destination) = match fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => {
                return Err(Failure::failed(format!(
                    "cannot write {}: it is a directory; name a file",
                    path.display()
                )));
            }
            Ok(metadata) if metadata.is_file() => {
                // A link stays, and what it points to is replaced.
                (fs::canonicalize(path).map_err(|e| unwritable(path, &e))?, Destination::Regular)
            }
            Ok(_) => (path.to_owned(), Destination::Special),
            Err(_) => (path.to_owned(), Destination::Regular),
        };
        let output = Self { path, destination };
        if output.destination == Destination::Regular {
            let _whole = uninterrupted();
            beside(&output.path).map_err(|e| unwritable(&output.path, &e))?;
        }
        Ok(output)
    }

    /// The file beside this one that keeps unfinished work: its name and `.partial`. Pipes and devices have none.
    pub(super) fn partial(&self) -> Option<PathBuf> {
        let mut name = self.path.clone().into_os_string();
        name.push(".partial");
        (self.destination == Destination::Regular).then_some(name.into())
    }

    /// Writes the file.
    pub(super) fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        let result = match self.destination {
            Destination::Special => fs::write(&self.path, bytes),
            Destination::Regular => {
                let _whole = uninterrupted();
                self.replace(bytes)
            }
        };
        result.map_err(|e| unwritable(&self.path, &e))
    }

    fn replace(&self, bytes: &[u8]) -> io::Result<()> {
        beside(&self.path).and_then(|mut file| {
            file.write_all(bytes)?;
            file.as_file().sync_all()?;
            file.persist(&self.path).map(drop).map_err(|e| e.error)
        })
    }
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    Failure::failed(format!(
        "cannot write {} ({}); choose a place that exists and that you may write to",
        path.display(),
        // tempfile adds the name of its temporary file, which tells a user nothing.
        error.kind()
    ))
}

/// Whether two paths lead to the same file.
pub(super) fn same_file(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn entries(directory: &Path) -> usize {
        fs::read_dir(directory).unwrap().count()
    }

    #[test]
    fn preparing_creates_nothing_and_writing_leaves_one_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("out");
        let output = Output::new(&path).unwrap();
        assert_eq!(entries(directory.path()), 0);
        output.write(b"new").unwrap();
        output.write(b"newer").unwrap();
        assert_eq!(
            (fs::read(&path).unwrap().as_slice(), entries(directory.path())),
            (b"newer".as_slice(), 1)
        );
    }

    #[test]
    fn a_place_that_cannot_be_written_is_found_out_at_once() {
        let directory = tempfile::tempdir().unwrap();
        assert!(Output::new(directory.path()).is_err());
        assert!(Output::new(&directory.path().join("no/such")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_are_not_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let (file, link) = (directory.path().join("file"), directory.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        Output::new(&link).unwrap().write(b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(Output::new(Path::new("/dev/null")).unwrap().destination, Destination::Special);
    }
}
