//! Two font files that belong together: the hinted original, and the neural font made from it.

use std::collections::HashMap;

use read_fonts::FontRef;
use skrifa::GlyphId;

use super::diff::{Sources, compare_watched};
use super::points::Compared;
use super::report::{Report, ReportHeader};
use super::source::{Hinted, Neural, Unhinted, patient};
use super::verification::{NoPoints, NotCompared, Subject, Verification};
use super::watched::{Watch, Watched};
use crate::assemble::outline_hash;
use crate::error::Error;
use crate::open::{open, owned};
use crate::options::Hinter;
use crate::parallel;
use crate::ppem::PpemList;
use crate::select::{glyph_count, glyph_names};
use crate::teacher::Teacher;
use crate::teacher::UnhintedOutlines;
use nfr::Font;
use nfr::internals::{Decoder, Glyph};

/// An original and the neural font made from it, checked to belong together.
pub struct FontPair<'a> {
    original: FontRef<'a>,
    neural_file: FontRef<'a>,
    font: Font,
    teacher: Teacher,
    watched: Watched,
}

impl<'a> FontPair<'a> {
    /// Opens both files. The original is hinted as the neural font's certificate says. `index` counts the fonts of the original, should that be a collection.
    ///
    /// # Errors
    ///
    /// As [`open`], [`Font::new`] and [`Teacher::new`]; `InvalidParameter` if the neural font's outlines
    /// are not those that its models were trained from.
    pub fn open(original: &'a [u8], index: u32, neural: &'a [u8]) -> Result<Self, Error> {
        let pair = Self::open_edited(original, index, neural)?;
        let modelled: Vec<u16> =
            pair.font.modelled_glyphs().filter_map(|glyph| u16::try_from(glyph).ok()).collect();
        // Other bytes may stand for the same outlines.
        if !pair.font.outlines_match() && pair.check_outlines(&modelled).is_err() {
            return Err(Error::InvalidParameter(
                "the neural font's outlines were changed after its models were trained; convert it again"
                    .into(),
            ));
        }
        Ok(pair)
    }

    /// Opens both files as [`FontPair::open`] does, and a neural font whose outlines were changed, too.
    ///
    /// # Errors
    ///
    /// As [`open`], [`Font::new`] and [`Teacher::new`]; `InvalidParameter` if outlines were dropped and those of the original are
    /// not the ones that the models were trained from.
    pub fn open_edited(original: &'a [u8], index: u32, neural: &'a [u8]) -> Result<Self, Error> {
        let font = Font::new(neural.to_vec()).map_err(|e| about("the neural font", e.into()))?;
        let hinter = hinter_of(&font)?;
        Self::open_taught(original, index, neural, hinter)
    }

    /// Opens both files as [`FontPair::open_edited`] does, the neural one without a look at which hinter its certificate names.
    ///
    /// # Errors
    ///
    /// As [`FontPair::open_edited`].
    pub(crate) fn open_taught(
        original: &'a [u8],
        index: u32,
        neural: &'a [u8],
        hinter: Hinter,
    ) -> Result<Self, Error> {
        let neural_file = open(neural, 0).map_err(|e| about("the neural font", e))?;
        let font = Font::new(neural.to_vec()).map_err(|e| about("the neural font", e.into()))?;
        let original = open(original, index).map_err(|e| about("the original font", e))?;
        let teacher = Teacher::with_hinter(&original, font.target(), hinter)
            .map_err(|e| about("the original font", e))?;
        if font.outlines_dropped()
            && outline_hash(&teacher.true_type(&original)?)? != nfr::internals::header(&font).outline_hash
        {
            return Err(Error::InvalidParameter(
                "the outlines of the original font are not those that the models were trained from; pass the \
                 font that the neural one was converted from"
                    .into(),
            ));
        }
        Ok(Self { original, neural_file, font, teacher, watched: Watched::default() })
    }

    /// Tells how far each comparison is.
    #[must_use]
    pub fn watched_by(self, watch: Watch) -> Self {
        Self { watched: Watched::by(watch), ..self }
    }

    pub(super) fn watched(&self) -> &Watched {
        &self.watched
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
    /// `InvalidParameter` naming the first that has not, or if the fonts have not the same number of glyphs.
    pub fn check_outlines(&self, gids: &[u16]) -> Result<(), Error> {
        // Without them, the hash of the original's has been checked.
        if self.font.outlines_dropped() {
            return Ok(());
        }
        let (ours, theirs) = (glyph_count(&self.original)?, self.font.glyph_count());
        if ours != theirs {
            return Err(Error::InvalidParameter(format!(
                "the original font has {ours} glyphs and the neural one {theirs}; pass the font that the neural one was \
                 converted from"
            )));
        }
        let outlines = UnhintedOutlines::new(&self.neural_file)?;
        for &gid in gids {
            let plain = self.teacher.unhinted_em(gid)?;
            if !matches!(outlines.em(gid), Ok(outline) if outline.points == plain.points) {
                return Err(Error::InvalidParameter(format!(
                    "glyph {gid}{} is not the same in the two fonts; pass the font that the neural one was converted from",
                    self.other_name(gid)?
                )));
            }
        }
        Ok(())
    }

    /// A glyph's names in the two fonts if they differ, which tells of another order of glyphs.
    fn other_name(&self, gid: u16) -> Result<String, Error> {
        let (ours, theirs) = (glyph_names(&self.original)?, glyph_names(&self.neural_file)?);
        Ok(match (ours.get(&gid), theirs.get(&gid)) {
            (Some(ours), Some(theirs)) if ours != theirs => {
                format!(
                    " ('{ours}' in the original font, '{theirs}' in the neural one: their order of glyphs differs)"
                )
            }
            _ => String::new(),
        })
    }

    /// Bytes of the `Nfrt` table for each glyph in it.
    pub fn bytes_per_glyph(&self) -> f64 {
        self.font.table_len() as f64 / self.font.modelled_glyphs().count().max(1) as f64
    }

    /// Compares glyphs at sizes and adds the errors up. `names` are the two files' paths, original first.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph without a model, and as [`FontPair::check_outlines`] and [`compare`](super::diff::compare).
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
            hinter: self.teacher.hinter().name().to_owned(),
            ppem: ppem.to_string(),
            glyphs: gids.len(),
            table_bytes: self.font.table_len(),
            bytes_per_glyph: self.bytes_per_glyph(),
        };
        let tallies = self.with_sources(gids, |sources| {
            compare_watched(sources, gids, ppem.sizes(), jobs, &self.watched)
        })?;
        Ok(Report::new(header, &tallies, self.labels()?))
    }

    /// Compares the hinted points, advance widths and left side bearings of glyphs at sizes with those of the original. `names` are
    /// the two files' paths, original first. Glyphs that have no points are told.
    ///
    /// # Errors
    ///
    /// Those of a damaged model, and as [`FontPair::check_outlines`] for the glyphs that have points, and [`Teacher::at`].
    pub fn verify(
        &self,
        names: [&str; 2],
        gids: &[u16],
        ppem: &PpemList,
        jobs: usize,
    ) -> Result<Verification, Error> {
        let subject = Subject {
            original: names[0].to_owned(),
            neural: names[1].to_owned(),
            target: self.font.target().name().to_owned(),
            ppem: ppem.to_string(),
            glyphs: gids.len(),
        };
        let (mut glyphs, mut not_compared) = (Vec::new(), Vec::new());
        let mut decoder = Decoder::new(&self.font, patient());
        for &gid in gids {
            match self.outlines_of(gid, &mut decoder)? {
                Ok(glyph) => glyphs.push((gid, glyph)),
                Err(reason) => not_compared.push(NotCompared { gid, reason }),
            }
        }
        self.check_outlines(&glyphs.iter().map(|(gid, _)| *gid).collect::<Vec<_>>())?;
        let sizes = ppem.sizes().iter().map(|ppem| self.teacher.at(*ppem)).collect::<Result<Vec<_>, _>>()?;
        let compared =
            Compared { teacher: &self.teacher, sizes: &sizes, font: &self.font, limits: patient() };
        self.watched.begin(glyphs.len());
        let tallies = parallel::map(&glyphs, jobs, |(gid, glyph)| {
            compared.glyph(*gid, glyph).inspect(|_| self.watched.done(1))
        })?;
        Ok(Verification::new(subject, &tallies, not_compared, self.labels()?))
    }

    /// A glyph that outlines draw, or why there are none.
    fn outlines_of(&self, gid: u16, decoder: &mut Decoder) -> Result<Result<Glyph, NoPoints>, Error> {
        let table = nfr::internals::table(&self.font)?;
        if table.is_network(gid.into()) {
            return Ok(Err(NoPoints::Network));
        }
        if table.outlines().find(gid.into()).is_none() {
            let reason = if table.contains(gid.into()) { NoPoints::Field } else { NoPoints::NoModel };
            return Ok(Err(reason));
        }
        match decoder.glyph(gid.into()) {
            Ok(glyph) => Ok(Ok(glyph)),
            Err(nfr::Error::StaleModel(_)) => Ok(Err(NoPoints::Stale)),
            Err(error) => Err(error.into()),
        }
    }

    /// The characters of these glyphs, ascending, each with its glyph. `gids` are in ascending order.
    ///
    /// # Errors
    ///
    /// `Malformed` if the original's table directory cannot be read.
    pub fn characters(&self, gids: &[u16]) -> Result<Vec<(char, u16)>, Error> {
        let font = owned(&self.original)?;
        let pair = |(code, gid): (u32, GlyphId)| {
            let gid = u16::try_from(gid.to_u32()).ok().filter(|gid| gids.binary_search(gid).is_ok())?;
            Some((char::from_u32(code)?, gid))
        };
        let mut characters: Vec<(char, u16)> = font.charmap().unicodes().filter_map(pair).collect();
        characters.sort_unstable();
        characters.dedup_by_key(|(character, _)| *character);
        Ok(characters)
    }

    /// The name and the first character of each glyph.
    fn labels(&self) -> Result<impl Fn(u16) -> (Option<String>, Option<char>) + use<>, Error> {
        let mut characters = HashMap::new();
        for (code, gid) in owned(&self.original)?.charmap().unicodes() {
            if let Some(character) = char::from_u32(code) {
                characters.entry(gid.to_u32()).or_insert(character);
            }
        }
        let names = glyph_names(&self.original)?;
        Ok(move |gid: u16| (names.get(&gid).cloned(), characters.get(&gid.into()).copied()))
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

/// The hinter that a neural font has learnt from: that of its certificate, or the font's own hints if it has none.
///
/// # Errors
///
/// If the table cannot be read.
pub fn hinter_of(font: &Font) -> Result<Hinter, Error> {
    let table = nfr::internals::table(font)?;
    Ok(table.certificate().map_or(Hinter::Font, |certificate| Hinter::of_teacher(certificate.teacher)))
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
