//! Options that several tools share.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use super::files::read;
use nfr::Target;
use nfr_convert::select::{
    CodePoints, GlyphIds, GlyphNames, Selected, Selection, missing_characters, missing_text,
};
use nfr_convert::{Hinter, Shape};
use read_fonts::FontRef;

const HEADING: &str = "Glyphs (all that is given adds up)";

/// Reads the name of a target.
///
/// # Errors
///
/// A sentence for any other word.
pub fn target(name: &str) -> Result<Target, String> {
    Target::from_name(name).ok_or_else(|| format!("unknown target {name:?}; use smooth, mono or lcd"))
}

/// Reads the name of a hinter.
///
/// # Errors
///
/// A sentence for any other word.
pub fn hinter(name: &str) -> Result<Hinter, String> {
    Hinter::from_name(name).ok_or_else(|| format!("unknown hinter {name:?}; use font or auto"))
}

/// Reads the name of a shape.
///
/// # Errors
///
/// A sentence for any other word.
pub fn shape(name: &str) -> Result<Shape, String> {
    match name {
        "auto" => Ok(Shape::Auto),
        "outline" => Ok(Shape::Outline),
        "field" => Ok(Shape::Field),
        _ => Err("use auto, outline or field".into()),
    }
}

/// Which glyphs; all that is given adds up.
#[derive(Debug, Clone, Args)]
pub struct SelectionArgs {
    /// The characters of a text
    #[arg(long, help_heading = HEADING, value_name = "TEXT", allow_hyphen_values = true)]
    text: Option<String>,
    /// The characters of a text file in UTF-8
    #[arg(long, help_heading = HEADING, value_name = "FILE")]
    text_file: Option<PathBuf>,
    /// Code points, as in CSS: U+20-7E,U+E9,U+4??
    #[arg(long, help_heading = HEADING, value_name = "LIST")]
    unicodes: Option<CodePoints>,
    /// Glyph numbers, as in 3,5-9
    #[arg(long, help_heading = HEADING, value_name = "LIST")]
    gids: Option<GlyphIds>,
    /// Glyph names, as in a,eacute
    #[arg(long, help_heading = HEADING, value_name = "LIST")]
    glyphs: Option<GlyphNames>,
    /// Fail where the font lacks a character that is asked for, or a glyph cannot be converted, instead of warning
    #[arg(long, help_heading = HEADING)]
    pub strict: bool,
}

impl SelectionArgs {
    /// The glyphs of a font that are selected, ascending; an empty selection stands for `all`. `warn` is told of characters that the
    /// font lacks.
    ///
    /// # Errors
    ///
    /// A text file that cannot be read, a selection that has no glyph, and with `--strict` a character that the font lacks.
    pub fn resolve(
        &self,
        font: &FontRef<'_>,
        all: impl IntoIterator<Item = u16>,
        warn: impl FnOnce(&str),
    ) -> Result<Vec<u16>, Failure> {
        let Selected { gids, missing } = self.selection()?.resolve(font, all)?;
        if !missing.is_empty() {
            if self.strict {
                return Err(missing_characters(&missing).into());
            }
            warn(&format!("warning: {}", missing_text(&missing)));
        }
        Ok(gids)
    }

    /// The glyphs that shapers put in the place of the selected characters before layout.
    ///
    /// # Errors
    ///
    /// A text file, or a font, that cannot be read.
    pub fn shaped_glyphs(&self, font: &FontRef<'_>) -> Result<Vec<u16>, Failure> {
        Ok(self.selection()?.shaped_glyphs(font)?)
    }

    /// Whether nothing is selected, which stands for everything.
    pub fn is_empty(&self) -> bool {
        self.text.is_none()
            && self.text_file.is_none()
            && self.unicodes.is_none()
            && self.gids.is_none()
            && self.glyphs.is_none()
    }

    /// Reads the text file and puts all together.
    ///
    /// # Errors
    ///
    /// A text file that cannot be read.
    pub fn selection(&self) -> Result<Selection, Failure> {
        let from_file = self.text_file.as_deref().map(read_text).transpose()?;
        let text = match (&self.text, from_file) {
            (Some(text), Some(more)) => Some(format!("{text}{more}")),
            (text, more) => text.clone().or(more),
        };
        Ok(Selection {
            text,
            unicodes: self.unicodes.clone().unwrap_or_default(),
            gids: self.gids.clone().unwrap_or_default(),
            names: self.glyphs.clone().unwrap_or_default(),
        })
    }
}

fn read_text(path: &Path) -> Result<String, Failure> {
    String::from_utf8(read(path)?).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        Failure::failed(format!("{}: not UTF-8 at byte {at}; save the text as UTF-8", path.display()))
    })
}

/// As many threads as the machine has cores.
pub(super) fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A number of threads, at least one.
pub(super) fn jobs(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|&jobs| jobs > 0).ok_or_else(|| "write a number of threads, 1 or more".into())
}
