//! Two font files that belong together: the hinted original, and the neural font made from it.

use std::collections::HashMap;

use read_fonts::FontRef;

use super::diff::{Sources, compare};
use super::report::{Report, ReportHeader};
use super::source::{Hinted, Neural, Unhinted};
use crate::assemble::outline_hash;
use crate::error::Error;
use crate::open::{open, owned};
use crate::ppem::PpemList;
use crate::select::glyph_names;
use crate::teacher::Teacher;
use crate::teacher::UnhintedOutlines;
use nfr::Font;

/// An original and the neural font made from it, checked to belong together.
pub struct FontPair<'a> {
    original: FontRef<'a>,
    neural_file: FontRef<'a>,
    font: Font,
    teacher: Teacher,
}

impl<'a> FontPair<'a> {
    /// Opens both files. `index` counts the fonts of the original, should that be a collection.
    ///
    /// # Errors
    ///
    /// As [`open`], [`Font::new`] and [`Teacher::new`]; `InvalidParameter` if the neural font's outlines
    /// are not those that its models were trained from.
    pub fn open(original: &'a [u8], index: u32, neural: &'a [u8]) -> Result<Self, Error> {
        let neural_file = open(neural, 0).map_err(|e| about("the neural font", e))?;
        let font = Font::new(neural.to_vec()).map_err(|e| about("the neural font", e.into()))?;
        let original = open(original, index).map_err(|e| about("the original font", e))?;
        let teacher = Teacher::new(&original, font.target()).map_err(|e| about("the original font", e))?;
        if !font.outlines_match() {
            return Err(Error::InvalidParameter(
                "the neural font's outlines were changed after its models were trained; convert it again"
                    .into(),
            ));
        }
        if font.outlines_dropped() && outline_hash(&original)? != nfr::internals::header(&font).outline_hash {
            return Err(Error::InvalidParameter(
                "the outlines of the original font are not those that the models were trained from; pass the \
                 font that the neural one was converted from"
                    .into(),
            ));
        }
        Ok(Self { original, neural_file, font, teacher })
    }

    /// The neural font.
    pub fn font(&self) -> &Font {
        &self.font
    }

    /// The original's file.
    pub fn original(&self) -> &FontRef<'a> {
        &self.original
    }

    /// The hinted original.
    pub fn teacher(&self) -> &Teacher {
        &self.teacher
    }

    /// Checks that glyphs have the same outlines in both fonts, if both have them.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` naming the first that has not.
    pub fn check_outlines(&self, gids: &[u16]) -> Result<(), Error> {
        // Without them, the hash of the original's has been checked.
        if self.font.outlines_dropped() {
            return Ok(());
        }
        let outlines = UnhintedOutlines::new(&self.neural_file)?;
        for &gid in gids {
            let plain = self.teacher.unhinted_em(gid)?;
            if !matches!(outlines.em(gid), Ok(outline) if outline.points == plain.points) {
                return Err(Error::InvalidParameter(format!(
                    "glyph {gid} is not the same in the two fonts; pass the font that the neural one was converted from"
                )));
            }
        }
        Ok(())
    }

    /// Bytes of the `Nfrt` table for each glyph in it.
    pub fn bytes_per_glyph(&self) -> f64 {
        self.font.table_len() as f64 / self.font.modelled_glyphs().count().max(1) as f64
    }

    /// Compares glyphs at sizes and adds the errors up. `names` are the two files' paths, original first.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph without a model, and as [`FontPair::check_outlines`] and [`compare`].
    pub fn report(
        &self,
        names: [&str; 2],
        gids: &[u16],
        ppem: &PpemList,
        jobs: usize,
    ) -> Result<Report, Error> {
        let header = ReportHeader {
            original: names[0].to_owned(),
            neural: names[1].to_owned(),
            target: self.font.target().name().to_owned(),
            ppem: ppem.to_string(),
            glyphs: gids.len(),
            table_bytes: self.font.table_len(),
            bytes_per_glyph: self.bytes_per_glyph(),
        };
        let tallies = self.with_sources(gids, |sources| compare(sources, gids, ppem.sizes(), jobs))?;
        let mut characters = HashMap::new();
        for (code, gid) in owned(&self.original)?.charmap().unicodes() {
            if let Some(character) = char::from_u32(code) {
                characters.entry(gid.to_u32()).or_insert(character);
            }
        }
        let names = glyph_names(&self.original)?;
        let label = |gid: u16| (names.get(&gid).cloned(), characters.get(&gid.into()).copied());
        Ok(Report::new(header, &tallies, label))
    }

    /// Calls `f` with the three sources of bitmaps of these glyphs: hinted, neural and unhinted.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph without a model, and as [`FontPair::check_outlines`] and `f`.
    pub fn with_sources<T>(
        &self,
        gids: &[u16],
        f: impl FnOnce(Sources<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let neural = Neural::new(&self.font, gids)?;
        self.check_outlines(gids)?;
        f(Sources { truth: &Hinted(&self.teacher), neural: &neural, unhinted: &Unhinted(&self.teacher) })
    }
}

/// Adds to an error which of the two fonts it is about.
fn about(font: &str, error: Error) -> Error {
    match error {
        Error::Malformed(what) => Error::Malformed(format!("{font}: {what}")),
        Error::Unsupported(what) => Error::Unsupported(format!("{font}: {what}")),
        Error::InvalidParameter(what) => Error::InvalidParameter(format!("{font}: {what}")),
        other => other,
    }
}
