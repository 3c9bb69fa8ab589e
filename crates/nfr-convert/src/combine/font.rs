//! A converted font, opened for its table, for its other tables and for its outlines.

use nfr::Font;
use nfr::internals::table::Table;
use read_fonts::FontRef;
use skrifa::font::Font as OutlineFont;

use crate::error::Error;
use crate::input::open::{open, owned};

/// A converted font.
pub(super) struct ConvertedFont<'f> {
    pub(super) file: FontRef<'f>,
    pub(super) font: Font,
    /// For its outlines.
    pub(super) copy: OutlineFont,
}

impl<'f> ConvertedFont<'f> {
    /// Opens it.
    ///
    /// # Errors
    ///
    /// Those of [`open`] and [`Font::new`].
    pub(super) fn open(data: &'f [u8]) -> Result<Self, Error> {
        let file = open(data, 0)?;
        Ok(Self { font: Font::new(data.to_vec())?, copy: owned(&file)?, file })
    }

    /// Its `Nfrt` table.
    pub(super) fn table(&self) -> Result<Table<'_>, Error> {
        Ok(nfr::internals::table(&self.font)?)
    }

    /// Its glyphs that have outline models, ascending.
    pub(super) fn outline_gids(&self) -> Result<Vec<u16>, Error> {
        let table = self.table()?;
        Ok(table.gids().filter(|gid| table.outlines().find((*gid).into()).is_some()).collect())
    }
}
