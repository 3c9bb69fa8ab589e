//! A font as a data set: the file, and the ground truth of its glyphs.

use std::path::{Path, PathBuf};

use read_fonts::FontRef;

use super::SquareBitmap;
use super::samples::TrainingSample;
use super::truth::Truth;
use nfr_convert::compare::picture::LabelFont;
use nfr_convert::error::Error;
use nfr_convert::open::{open, owned};

/// The sides that the ground truth has at the published scale.
pub const SIDES: std::ops::RangeInclusive<usize> = 20..=63;

/// A font and its truth.
pub struct Dataset {
    /// The file's name without its ending.
    pub name: String,
    /// The file.
    pub data: Vec<u8>,
    /// The bitmaps to learn.
    pub truth: Truth,
}

/// Pairs a character with its glyph.
pub type CharGlyph = (char, u16);

impl Dataset {
    /// Opens fonts that share the sizes of their truths. The glyphs of `set` have to fit the box.
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
        let dataset = |((path, data), truth): ((PathBuf, Vec<u8>), Truth)| Self {
            name: Self::stem(&path),
            data,
            truth: truth.at_sides(sides),
        };
        Ok(files.into_iter().zip(truths).map(dataset).collect())
    }

    /// Opens one font.
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
    pub fn glyphs(&self, text: &str) -> Result<Vec<CharGlyph>, Error> {
        Self::glyphs_of(&open(&self.data, 0)?, text)
    }

    /// The font for labels of pictures.
    ///
    /// # Errors
    ///
    /// `Malformed` if it cannot be read.
    pub fn label_font(&self) -> Result<LabelFont, Error> {
        LabelFont::new(&open(&self.data, 0)?)
    }

    /// A glyph's bitmaps at all sizes, as samples.
    ///
    /// # Errors
    ///
    /// As [`Truth::hinted`].
    pub fn samples(&self, gid: u16, weight: Option<f64>) -> Result<Vec<TrainingSample>, Error> {
        let sample = |size| Ok(TrainingSample { size, weight, truth: self.truth.hinted(gid, size)? });
        (0..self.truth.sizes.len()).map(sample).collect()
    }

    /// A glyph's bitmaps at all sizes.
    ///
    /// # Errors
    ///
    /// As [`Truth::hinted`].
    pub fn squares(&self, gid: u16) -> Result<Vec<SquareBitmap>, Error> {
        (0..self.truth.sizes.len()).map(|size| self.truth.hinted(gid, size)).collect()
    }

    /// The glyphs of a text's characters in a font.
    ///
    /// # Errors
    ///
    /// As `glyphs`.
    pub fn glyphs_of(font: &FontRef<'_>, text: &str) -> Result<Vec<CharGlyph>, Error> {
        let font = owned(font)?;
        let charmap = font.charmap();
        let glyph = |character: char| {
            let gid = charmap.map_unicode(character).and_then(|gid| u16::try_from(gid.to_u32()).ok());
            gid.map(|gid| (character, gid)).ok_or_else(|| {
                Error::InvalidParameter(format!(
                    "the font has no glyph for {character:?} (U+{:04X}); leave it out",
                    u32::from(character)
                ))
            })
        };
        text.chars().map(glyph).collect()
    }

    /// A font's name: that of its file without the ending.
    pub fn stem(path: &Path) -> String {
        // Without commas, the name is the same in tables, where these separate fields, and in paths.
        path.file_stem().map_or_else(|| "font".into(), |stem| stem.to_string_lossy().replace(',', "-"))
    }
}
