//! The work file of a conversion: what is learnt already, so that an interrupted conversion can be
//! resumed. All random numbers depend on the seed and the glyph only, so that the font comes out the same, byte for byte.
//!
//! The file is a heading and [records], each of one kind of result. A record that was not written to its end is ignored.
//!
//! [records]: crate::records

use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::error::Error;
use crate::options::Options;
use crate::records::{append_record, split_record};
use nfr::internals::model::gridfit::{Scale, Weights};
use nfr::internals::table::{FNV_BASIS, codec, fnv1a};

/// Begins the file; a key of 8 bytes follows.
const MAGIC: &[u8; 14] = b"nfr partial 4\n";
/// What the work files of all versions begin with.
const ANY_MAGIC: &[u8] = b"nfr partial ";

/// Results of outline models are written this often: they come by the hundred, and a lost second is learnt again in one.
const WRITE_INTERVAL: Duration = Duration::from_secs(1);

/// A kind of result that the file keeps for a glyph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub(super) enum Kind {
    /// The encoded weights of a trained field.
    Field = 0,
    /// The tracks of an outline, or that it cannot have any.
    Fit = 1,
    /// The encoded message of an outline model and its weights.
    Encoding = 2,
    /// The errors of a model.
    Measurement = 3,
}

impl Kind {
    fn of(byte: u8) -> Option<Self> {
        [Self::Field, Self::Fit, Self::Encoding, Self::Measurement]
            .into_iter()
            .find(|kind| *kind as u8 == byte)
    }
}

/// The work file.
#[derive(Debug)]
pub struct Partial {
    path: PathBuf,
    key: u64,
    writer: Mutex<Writer>,
    /// What the file held for each glyph.
    found: HashMap<(Kind, u16), Vec<u8>>,
    /// Where the work file of another conversion was kept.
    kept_aside: Option<PathBuf>,
}

#[derive(Debug)]
struct Writer {
    /// Opened by the first record if the file did not exist.
    file: Option<File>,
    /// Records that are not written yet.
    pending: Vec<u8>,
    written: Instant,
    has_fields: bool,
}

impl Writer {
    fn new() -> Self {
        Self { file: None, pending: Vec::new(), written: Instant::now(), has_fields: false }
    }
}

/// A hash of everything that the models depend on: this version, the input and the options, except the number of
/// threads and whether outlines are dropped.
fn key(input: &[u8], options: &Options) -> u64 {
    let options = Options { jobs: 1, drop_outlines: false, ..options.clone() };
    let text = format!("{} {options:?}", env!("CARGO_PKG_VERSION"));
    fnv1a(fnv1a(FNV_BASIS, text.as_bytes()), input)
}

impl Partial {
    /// Prepares the work file of a conversion. It is created when the first glyphs are ready. With `resume`, the glyphs
    /// of an earlier conversion in it are used. Without, the work file of a conversion of another font or with other options is
    /// kept aside.
    ///
    /// # Errors
    ///
    /// `Io` without `resume` if the file has glyphs of this conversion or is no work file, with it if it belongs to another
    /// conversion, and if it cannot be read or moved.
    pub fn open(path: &Path, input: &[u8], options: &Options, resume: bool) -> Result<Self, Error> {
        let mut partial = Self {
            path: path.to_owned(),
            key: key(input, options),
            writer: Mutex::new(Writer::new()),
            found: HashMap::new(),
            kept_aside: None,
        };
        let name = path.display();
        if !resume {
            partial.make_way()?;
            return Ok(partial);
        }
        let mut file = match OpenOptions::new().read(true).write(true).open(path) {
            Ok(file) => file,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(partial),
            Err(e) => return Err(partial.failed("read", &e)),
        };
        partial.lock(&file)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(|e| partial.failed("read", &e))?;
        let whole = match partial.read(&bytes) {
            Some(whole) => whole,
            // Cut off inside its heading: nothing is lost.
            None if partial.heading().starts_with(&bytes) => 0,
            None => {
                return Err(Error::Io(format!(
                    "{name} belongs to a conversion of another font, with other options or by another version; \
                     repeat those, or delete it"
                )));
            }
        };
        if whole == 0 {
            file.set_len(0)
                .and_then(|()| file.rewind())
                .and_then(|()| file.write_all(&partial.heading()))
                .map_err(|e| partial.failed("write", &e))?;
        } else {
            // A record that was cut off is overwritten.
            file.set_len(whole as u64)
                .and_then(|()| file.seek(SeekFrom::End(0)))
                .map_err(|e| partial.failed("write", &e))?;
        }
        partial.writer().file = Some(file);
        Ok(partial)
    }

    /// Moves the file of another conversion away, and removes one without glyphs.
    fn make_way(&mut self) -> Result<(), Error> {
        let bytes = match std::fs::read(&self.path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
            Err(e) => return Err(self.failed("read", &e)),
        };
        let is_empty = self.heading().starts_with(&bytes) || self.read(&bytes).is_some();
        let name = self.path.display();
        if is_empty && self.found.is_empty() {
            return std::fs::remove_file(&self.path).map_err(|e| self.failed("delete", &e));
        }
        if !self.found.is_empty() {
            return Err(Error::Io(format!(
                "{name} holds an unfinished conversion; go on with it with --resume, or delete it"
            )));
        }
        if !bytes.starts_with(ANY_MAGIC) {
            return Err(Error::Io(format!(
                "{name} is no work file of nfr-convert and is in its place; move it away, or choose another output"
            )));
        }
        // Its own hash makes the name: no other file that was kept aside has it.
        let mut aside = self.path.clone().into_os_string();
        aside.push(format!(".{:016x}", fnv1a(FNV_BASIS, &bytes)));
        std::fs::rename(&self.path, &aside).map_err(|e| self.failed("move", &e))?;
        self.kept_aside = Some(aside.into());
        Ok(())
    }

    /// Where the work file of another conversion was kept, if there was one in this one's place.
    pub fn kept_aside(&self) -> Option<&Path> {
        self.kept_aside.as_deref()
    }

    /// The number of glyphs of which the file held a result.
    pub fn found(&self) -> usize {
        self.found.keys().map(|(_, gid)| gid).collect::<HashSet<_>>().len()
    }

    /// Whether the file holds trained fields, which take long to train again.
    pub fn has_fields(&self) -> bool {
        self.writer().has_fields || self.found.keys().any(|(kind, _)| *kind == Kind::Field)
    }

    /// Deletes the file once the font is written, or if a failure would come again.
    ///
    /// # Errors
    ///
    /// `Io` if that fails.
    pub fn remove(&self) -> Result<(), Error> {
        let mut writer = self.writer();
        writer.pending.clear();
        // Some systems do not delete open files.
        if writer.file.take().is_none() {
            return Ok(());
        }
        std::fs::remove_file(&self.path).map_err(|e| self.failed("delete", &e))
    }

    /// Writes what is ready and not yet in the file, and tells whether the file exists then. For a program that is about to end.
    ///
    /// # Errors
    ///
    /// `Io` if it cannot be written.
    pub fn flush(&self) -> Result<bool, Error> {
        let mut writer = self.writer();
        self.write(&mut writer)?;
        Ok(writer.file.is_some())
    }

    /// The weights of some fields, if all of them are there.
    pub(super) fn weights(&self, gids: &[u16], scale: Scale) -> Result<Option<Vec<Weights>>, Error> {
        let found = gids.iter().map(|gid| self.kept(Kind::Field, *gid));
        let Some(found) = found.collect::<Option<Vec<_>>>() else {
            return Ok(None);
        };
        let decode = |(bytes, gid): (&[u8], &u16)| {
            codec::decode(bytes, scale).map_err(|damage| {
                let damage = damage.of((*gid).into());
                Error::Io(format!("{} is damaged ({damage}); delete it", self.path.display()))
            })
        };
        found.into_iter().zip(gids).map(decode).collect::<Result<_, _>>().map(Some)
    }

    /// Appends the weights of some fields and waits until they are on the disk.
    pub(super) fn append<'w>(
        &self,
        glyphs: impl Iterator<Item = (u16, &'w Weights)>,
        scale: Scale,
    ) -> Result<(), Error> {
        let mut payload = vec![Kind::Field as u8];
        for (gid, weights) in glyphs {
            append_glyph(&mut payload, gid, &codec::encode(weights, scale)?);
        }
        let mut writer = self.writer();
        writer.has_fields = true;
        append_record(&mut writer.pending, &payload);
        self.write(&mut writer)
    }

    /// A result that the file held.
    pub(super) fn kept(&self, kind: Kind, gid: u16) -> Option<&[u8]> {
        self.found.get(&(kind, gid)).map(Vec::as_slice)
    }

    /// Keeps a result. It is in the file a second later, if others follow, or after [`Partial::flush`].
    pub(super) fn keep(&self, kind: Kind, gid: u16, result: &[u8]) -> Result<(), Error> {
        let mut payload = vec![kind as u8];
        append_glyph(&mut payload, gid, result);
        let mut writer = self.writer();
        append_record(&mut writer.pending, &payload);
        if writer.written.elapsed() < WRITE_INTERVAL { Ok(()) } else { self.write(&mut writer) }
    }

    fn write(&self, writer: &mut Writer) -> Result<(), Error> {
        if writer.pending.is_empty() {
            return Ok(());
        }
        let file = match writer.file.as_mut() {
            Some(file) => file,
            None => writer.file.insert(self.create()?),
        };
        file.write_all(&writer.pending)
            .and_then(|()| file.sync_data())
            .map_err(|e| self.failed("write", &e))?;
        writer.pending.clear();
        writer.written = Instant::now();
        Ok(())
    }

    fn writer(&self) -> MutexGuard<'_, Writer> {
        self.writer.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn create(&self) -> Result<File, Error> {
        let file = OpenOptions::new().write(true).create_new(true).open(&self.path);
        let mut file = file.map_err(|e| self.failed("write", &e))?;
        self.lock(&file)?;
        file.write_all(&self.heading()).map_err(|e| self.failed("write", &e))?;
        Ok(file)
    }

    fn heading(&self) -> Vec<u8> {
        [MAGIC.as_slice(), &self.key.to_be_bytes()].concat()
    }

    /// Reads the records and returns where the last whole one ends; `None` without the heading.
    fn read(&mut self, bytes: &[u8]) -> Option<usize> {
        let mut rest = bytes.strip_prefix(self.heading().as_slice())?;
        while let Some((payload, after)) = split_record(rest) {
            let kind = payload.split_first().and_then(|(kind, glyphs)| Some((Kind::of(*kind)?, glyphs)));
            if let Some((kind, mut glyphs)) = kind {
                while let Some((gid, result, more)) = split_glyph(glyphs) {
                    self.found.insert((kind, gid), result.to_vec());
                    glyphs = more;
                }
            }
            rest = after;
        }
        Some(bytes.len() - rest.len())
    }

    fn lock(&self, file: &File) -> Result<(), Error> {
        match file.try_lock() {
            Err(std::fs::TryLockError::WouldBlock) => Err(Error::Io(format!(
                "{} is being written by another conversion; wait for it, or choose another output",
                self.path.display()
            ))),
            // Some file systems cannot lock; two conversions then are not kept apart.
            Ok(()) | Err(std::fs::TryLockError::Error(_)) => Ok(()),
        }
    }

    fn failed(&self, to: &str, e: &io::Error) -> Error {
        Error::Io(format!(
            "cannot {to} {}, which keeps the glyphs that are ready ({e}); make room, or choose another output",
            self.path.display()
        ))
    }
}

fn append_glyph(payload: &mut Vec<u8>, gid: u16, result: &[u8]) {
    payload.extend(gid.to_be_bytes());
    payload.extend((result.len() as u32).to_be_bytes());
    payload.extend(result);
}

/// The first glyph of a payload, its result, and the bytes after it.
fn split_glyph(bytes: &[u8]) -> Option<(u16, &[u8], &[u8])> {
    let (gid, rest) = bytes.split_first_chunk()?;
    let (length, rest) = rest.split_first_chunk()?;
    let (result, rest) = rest.split_at_checked(u32::from_be_bytes(*length) as usize)?;
    Some((u16::from_be_bytes(*gid), result, rest))
}
