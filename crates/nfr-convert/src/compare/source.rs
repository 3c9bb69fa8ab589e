//! Where bitmaps come from: the hinted teacher, its unhinted outline, or the models.

use std::collections::BTreeMap;

use crate::error::Error;
use crate::teacher::{Teacher, TeacherAt};
use nfr::internals::{Decoder, Glyph, Scratch};
use nfr::{Bitmap, Font, Limits};

/// A source of bitmaps at any size, for several threads.
pub trait BitmapSource: Sync {
    /// Prepares one size, in pixels per em.
    ///
    /// # Errors
    ///
    /// As the source's own.
    fn at(&self, ppem: u16) -> Result<Box<dyn SizedSource + '_>, Error>;
}

/// A source at one size.
pub trait SizedSource {
    /// Draws a glyph.
    ///
    /// # Errors
    ///
    /// As the source's own.
    fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error>;
}

/// A font's hinted outlines, filled: the truth.
pub struct Hinted<'t>(pub &'t Teacher);

impl BitmapSource for Hinted<'_> {
    fn at(&self, ppem: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
        Ok(Box::new(self.0.at(ppem)?))
    }
}

impl SizedSource for TeacherAt {
    fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
        self.hinted(gid)?.rasterize()
    }
}

/// A font's outlines as they are, filled without hints.
pub struct Unhinted<'t>(pub &'t Teacher);

impl BitmapSource for Unhinted<'_> {
    fn at(&self, ppem: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
        Ok(Box::new(UnhintedAt { teacher: self.0, ppem: ppem.into() }))
    }
}

struct UnhintedAt<'t> {
    teacher: &'t Teacher,
    ppem: f32,
}

impl SizedSource for UnhintedAt<'_> {
    fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
        self.teacher.unhinted(gid, self.ppem)?.rasterize()
    }
}

/// Limits for a tool, which need not answer at once: one of the paper's networks may take its time.
pub(super) fn patient() -> Limits {
    let mut limits = Limits::default();
    (limits.decoded_bytes, limits.work) = (1 << 30, u64::MAX);
    limits
}

/// Models, decoded once for all sizes.
pub struct Neural(BTreeMap<u16, Glyph>);

impl Neural {
    /// Decodes the models of the glyphs.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph without a model, `Malformed` for a damaged one.
    pub fn new(font: &Font, gids: &[u16]) -> Result<Self, Error> {
        let mut decoder = Decoder::new(font, patient());
        let glyphs = gids.iter().map(|&gid| Ok((gid, decoder.glyph(gid.into())?)));
        Ok(Self(glyphs.collect::<Result<_, Error>>()?))
    }
}

impl BitmapSource for Neural {
    fn at(&self, ppem: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
        Ok(Box::new(NeuralAt { glyphs: &self.0, ppem: ppem.into(), scratch: Scratch::default() }))
    }
}

struct NeuralAt<'n> {
    glyphs: &'n BTreeMap<u16, Glyph>,
    ppem: f32,
    scratch: Scratch,
}

impl SizedSource for NeuralAt<'_> {
    fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
        let glyph = self.glyphs.get(&gid).ok_or(Error::MissingGlyph(gid))?;
        Ok(glyph.render_with(self.ppem, &mut self.scratch)?)
    }
}
