//! A font with its cache, and what went wrong when it was drawn.

use core::cell::{Cell, RefCell};
use core::fmt;

use nfr::{BitmapRef, DrawOptions, Error, Font, MissingModel, MonoBitmapRef, Rasterizer};

/// What is drawn for a character that the font lacks, and for a glyph without a model. A damaged model is skipped in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Missing {
    /// The font's glyph 0, `.notdef`, a box in most fonts.
    #[default]
    Notdef,
    /// Nothing. A character that the font lacks has no width, a glyph without a model keeps its own.
    Skip,
    /// The glyph's plain outline, without hinting; for a character that the font lacks `.notdef`.
    Outline,
}

/// Why a character was not drawn as it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The font's character map does not have it.
    NotInFont,
    /// Its glyph cannot be drawn.
    Glyph(Error),
}

/// What went wrong first.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Problem {
    /// The character.
    pub character: char,
    /// Why it was not drawn.
    pub reason: Reason,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let code = u32::from(self.character);
        match self.reason {
            Reason::NotInFont => write!(f, "the font does not have the character U+{code:04X}"),
            Reason::Glyph(error) => write!(f, "the character U+{code:04X} was not drawn: {error}"),
        }
    }
}

impl core::error::Error for Problem {}

/// A font with its cache of decoded models. [`Style`](crate::Style)s refer to it, one after the other or several at once, on one thread.
#[derive(Debug)]
pub struct Face {
    rasterizer: RefCell<Rasterizer>,
    missing: Missing,
    problem: Cell<Option<Problem>>,
}

impl Face {
    /// Decoded models take up to this many bytes, unless a rasterizer with another cache is given.
    pub const CACHE: usize = 8 << 10;

    /// A face with a cache of [`Face::CACHE`] bytes.
    pub fn new(font: &Font) -> Self {
        Self::from_rasterizer(Rasterizer::new(font).with_cache(Self::CACHE))
    }

    /// A face that draws with a rasterizer: with its cache and its [`Limits`](nfr::Limits).
    pub fn from_rasterizer(rasterizer: Rasterizer) -> Self {
        Self { rasterizer: RefCell::new(rasterizer), missing: Missing::default(), problem: Cell::new(None) }
            .with_missing(Missing::default())
    }

    /// Chooses what is drawn for a character that the font lacks, and for a glyph without a model.
    #[must_use]
    pub fn with_missing(self, missing: Missing) -> Self {
        let model = match missing {
            Missing::Notdef | Missing::Skip => MissingModel::Error,
            Missing::Outline => MissingModel::Outline,
        };
        let rasterizer = self.rasterizer.into_inner().with_missing_model(model);
        Self { rasterizer: RefCell::new(rasterizer), missing, ..self }
    }

    /// What went wrong first since the last [`Face::forget_problem`], for drawing text has no errors of its own. What is wrong is
    /// not drawn, and the rest of the text is.
    pub fn problem(&self) -> Option<Problem> {
        self.problem.get()
    }

    /// Makes [`Face::problem`] ready for the next one.
    pub fn forget_problem(&self) {
        self.problem.set(None);
    }

    /// The font that is drawn.
    pub fn font(&self) -> Font {
        self.rasterizer.borrow().font().clone()
    }

    /// The glyph that stands for a character; none for one that is skipped.
    pub(crate) fn glyph(&self, character: char) -> Option<u32> {
        let rasterizer = self.rasterizer.borrow();
        let found = rasterizer.font().glyph_for_char(character);
        if found.is_none() {
            self.note(character, Reason::NotInFont);
        }
        let skipped = self.missing == Missing::Skip;
        let glyph = found.or((!skipped).then_some(0))?;
        let has_model = rasterizer.font().has_model(glyph);
        if has_model || self.missing != Missing::Notdef {
            return Some(glyph);
        }
        self.note(character, Reason::Glyph(Error::MissingModel(glyph)));
        Some(0)
    }

    /// The hinted advance width in whole pixels.
    pub(crate) fn advance(&self, character: char, glyph: u32, ppem: f32) -> i32 {
        let mut rasterizer = self.rasterizer.borrow_mut();
        let advance = rasterizer.hinted_advance(glyph, ppem).unwrap_or_else(|error| {
            self.note(character, Reason::Glyph(error));
            if is_size(ppem) { rasterizer.font().advance(glyph, ppem) } else { 0.0 }
        });
        rounded(advance)
    }

    /// Draws a glyph, and gives what `take` makes of it; none if it cannot be drawn.
    pub(crate) fn draw<T>(
        &self,
        character: char,
        glyph: u32,
        ppem: f32,
        take: impl FnOnce(BitmapRef<'_>) -> T,
    ) -> Option<T> {
        let mut rasterizer = self.rasterizer.borrow_mut();
        self.noted(character, rasterizer.draw(glyph, ppem).map(take))
    }

    /// The same in black and white.
    pub(crate) fn draw_mono<T>(
        &self,
        character: char,
        glyph: u32,
        ppem: f32,
        take: impl FnOnce(MonoBitmapRef<'_>) -> T,
    ) -> Option<T> {
        let mut rasterizer = self.rasterizer.borrow_mut();
        self.noted(character, rasterizer.draw_mono(glyph, ppem).map(take))
    }

    fn noted<T>(&self, character: char, drawn: Result<T, Error>) -> Option<T> {
        drawn.map_err(|error| self.note(character, Reason::Glyph(error))).ok()
    }

    fn note(&self, character: char, reason: Reason) {
        if self.problem.get().is_none() {
            self.problem.set(Some(Problem { character, reason }));
        }
    }
}

/// Whether text of a size can be drawn.
pub(crate) fn is_size(ppem: f32) -> bool {
    ppem > 0.0 && ppem <= DrawOptions::MAX_PPEM
}

/// The nearest whole number; `core` has no `round`.
pub(crate) fn rounded(number: f32) -> i32 {
    (number + if number < 0.0 { -0.5 } else { 0.5 }) as i32
}
