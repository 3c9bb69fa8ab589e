//! A font and the neural font made from it.

use std::error::Error;
use std::path::Path;

use nfr_convert::compare::fonts::FontPair;
use read_fonts::TableProvider;
use read_fonts::types::NameId;

use crate::layout::{ShapedText, check_models, shape};

/// The bytes of the two files.
pub(crate) struct FontFiles {
    original: Vec<u8>,
    neural: Vec<u8>,
}

impl FontFiles {
    pub(crate) fn read(original: &Path, neural: &Path) -> Result<Self, Box<dyn Error>> {
        let read =
            |path: &Path| std::fs::read(path).map_err(|e| format!("cannot read {} ({e})", path.display()));
        Ok(Self { original: read(original)?, neural: read(neural)? })
    }

    pub(crate) fn open(&self) -> Result<Typeface<'_>, Box<dyn Error>> {
        Ok(Typeface { pair: FontPair::open(&self.original, 0, &self.neural)? })
    }
}

/// The two fonts.
pub(crate) struct Typeface<'f> {
    pub(crate) pair: FontPair<'f>,
}

impl Typeface<'_> {
    pub(crate) fn units_per_em(&self) -> i32 {
        self.pair.teacher().units_per_em().into()
    }

    /// The font's full name.
    pub(crate) fn name(&self) -> Result<String, Box<dyn Error>> {
        let names = self.pair.original().name()?;
        let mut full = names.name_record().iter().filter(|record| record.name_id() == NameId::FULL_NAME);
        Ok(full.next().ok_or("the font has no name")?.string(names.string_data())?.to_string())
    }

    /// Shapes a text whose glyphs all have models.
    pub(crate) fn shape(&self, text: &str) -> Result<ShapedText, Box<dyn Error>> {
        let shaped = shape(self.pair.original().data().as_bytes(), text)?;
        check_models(&self.pair, text, &shaped)?;
        Ok(shaped)
    }
}
