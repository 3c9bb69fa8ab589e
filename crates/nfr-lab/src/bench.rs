//! What every experiment has: settings, a device, a place for its files, and fonts with their truths.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use burn::tensor::Device;
use read_fonts::FontRef;
use skrifa::MetadataProvider;

use super::Square;
use super::samples::Sample;
use super::scale::Settings;
use super::train::checkpoint::Checkpoint;
use super::truth::Truth;
use nfr_convert::error::Error;
use nfr_convert::open::open;

/// The sides that the ground truth has at the published scale.
pub const SIDES: std::ops::RangeInclusive<usize> = 20..=63;

/// Where and how experiments run.
pub struct Bench<'b> {
    /// What they run with.
    pub settings: Settings,
    /// Where tensors live, with autodiff.
    pub device: Device,
    /// Trainings that run at once.
    pub jobs: usize,
    /// Where trainings are kept, each in a directory of its own; nowhere without one.
    pub directory: Option<PathBuf>,
    /// Whether trainings that are found there are gone on with.
    pub resume: bool,
    /// Told what is being done: which training, and how many of how many epochs.
    pub tell: &'b (dyn Fn(&str, usize, usize) + Sync),
}

impl Bench<'_> {
    /// The directory of a training.
    pub fn place(&self, path: &[&str]) -> Option<PathBuf> {
        let directory = self.directory.as_ref()?;
        Some(path.iter().fold(directory.clone(), |place, part| place.join(slug(part))))
    }

    /// The checkpoint of a training that `described` and the bitmaps determine.
    ///
    /// # Errors
    ///
    /// As [`Checkpoint::new`].
    pub fn checkpoint(
        &self,
        path: &[&str],
        described: &str,
        samples: &[Sample],
    ) -> Result<Option<Checkpoint>, Error> {
        let Some(place) = self.place(path) else { return Ok(None) };
        let mut key = described.as_bytes().to_vec();
        for sample in samples {
            key.extend(format!("{} {:?} {}", sample.size, sample.weight, sample.truth.side).into_bytes());
            key.extend_from_slice(&sample.truth.pixels);
        }
        Checkpoint::new(place.join("checkpoint"), &key, self.resume).map(Some)
    }

    /// Does something with each item on several threads; the results come in the order of the items. The first
    /// failure ends the work.
    ///
    /// # Errors
    ///
    /// The first item's that failed.
    pub fn each<T: Sync, R: Send>(
        &self,
        items: &[T],
        work: impl Fn(&T) -> Result<R, Error> + Sync,
    ) -> Result<Vec<R>, Error> {
        let next = Mutex::new(0..items.len());
        let results: Vec<Mutex<Option<Result<R, Error>>>> = items.iter().map(|_| Mutex::new(None)).collect();
        let lock = |k: usize| results[k].lock().unwrap_or_else(PoisonError::into_inner);
        std::thread::scope(|scope| {
            for _ in 0..self.jobs.clamp(1, items.len().max(1)) {
                scope.spawn(|| {
                    let take = || next.lock().unwrap_or_else(PoisonError::into_inner).next();
                    while let Some(k) = take() {
                        let result = work(&items[k]);
                        if result.is_err() {
                            *next.lock().unwrap_or_else(PoisonError::into_inner) = 0..0;
                        }
                        *lock(k) = Some(result);
                    }
                });
            }
        });
        let results =
            results.into_iter().map(|cell| cell.into_inner().unwrap_or_else(PoisonError::into_inner));
        results.flatten().collect()
    }
}

/// A name as a part of a path.
fn slug(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '+' { c } else { '-' }).collect()
}

/// A font and its truth.
pub struct Subject {
    /// The file's name without its ending.
    pub name: String,
    /// The file.
    pub data: Vec<u8>,
    /// The bitmaps to learn.
    pub truth: Truth,
}

/// Pairs a character with its glyph.
pub type Glyph = (char, u16);

impl Subject {
    /// Takes fonts that share the sizes of their truths. `sets` are the glyphs that the fit rule looks at.
    ///
    /// # Errors
    ///
    /// As [`open`] and [`Truth::of_family`].
    pub fn family(files: Vec<(PathBuf, Vec<u8>)>, set: &str, sides: &[usize]) -> Result<Vec<Self>, Error> {
        let fonts = files.iter().map(|(_, data)| open(data, 0)).collect::<Result<Vec<FontRef<'_>>, _>>()?;
        let sets = fonts.iter().map(|font| Self::glyphs_of(font, set)).collect::<Result<Vec<_>, _>>()?;
        let gids: Vec<Vec<u16>> = sets.iter().map(|set| set.iter().map(|(_, gid)| *gid).collect()).collect();
        let pairs: Vec<_> = fonts.into_iter().zip(gids.iter().map(Vec::as_slice)).collect();
        let truths = Truth::of_family(&pairs, SIDES)?;
        let subject = |((path, data), truth): ((PathBuf, Vec<u8>), Truth)| Self {
            name: Self::stem(&path),
            data,
            truth: truth.at_sides(sides),
        };
        Ok(files.into_iter().zip(truths).map(subject).collect())
    }

    /// Takes one font.
    ///
    /// # Errors
    ///
    /// As `family`.
    pub fn open(path: PathBuf, data: Vec<u8>, set: &str, sides: &[usize]) -> Result<Self, Error> {
        let mut family = Self::family(vec![(path, data)], set, sides)?;
        family.pop().ok_or_else(|| Error::InvalidParameter("no font is given".into()))
    }

    /// The glyphs of a text's characters.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for a character that the font does not have.
    pub fn glyphs(&self, text: &str) -> Result<Vec<Glyph>, Error> {
        Self::glyphs_of(&open(&self.data, 0)?, text)
    }

    /// A glyph's bitmaps at all sizes, as samples.
    ///
    /// # Errors
    ///
    /// As [`Truth::hinted`].
    pub fn samples(&self, gid: u16, weight: Option<f64>) -> Result<Vec<Sample>, Error> {
        let sample = |size| Ok(Sample { size, weight, truth: self.truth.hinted(gid, size)? });
        (0..self.truth.sizes.len()).map(sample).collect()
    }

    /// A glyph's bitmaps at all sizes.
    ///
    /// # Errors
    ///
    /// As [`Truth::hinted`].
    pub fn squares(&self, gid: u16) -> Result<Vec<Square>, Error> {
        (0..self.truth.sizes.len()).map(|size| self.truth.hinted(gid, size)).collect()
    }

    /// The glyphs of a text's characters in a font.
    ///
    /// # Errors
    ///
    /// As `glyphs`.
    pub fn glyphs_of(font: &FontRef<'_>, text: &str) -> Result<Vec<Glyph>, Error> {
        let charmap = font.charmap();
        let glyph = |character: char| {
            let gid = charmap.map(character).and_then(|gid| u16::try_from(gid.to_u32()).ok());
            gid.map(|gid| (character, gid)).ok_or_else(|| {
                Error::InvalidParameter(format!(
                    "the font has no glyph for {character:?} (U+{:04X}); leave it out",
                    u32::from(character)
                ))
            })
        };
        text.chars().map(glyph).collect()
    }

    /// What a font is called: its file's name without the ending.
    pub fn stem(path: &Path) -> String {
        // Commas separate the fields of tables.
        path.file_stem().map_or_else(|| "font".into(), |stem| stem.to_string_lossy().replace(',', "-"))
    }
}
