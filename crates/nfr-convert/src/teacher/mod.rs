//! The teacher: skrifa's hinted and unhinted outlines, filled with exact area coverage by zeno.
//!
//! skrifa falls back silently in several places. Here the interpreter is requested explicitly, and whatever
//! would make it do something else than run the font's own programs at the requested size is an error. Fonts without programs,
//! and others where that is asked for, are hinted by skrifa's autohinter instead ([`Hinter::Auto`]).
//!
//! Where skrifa's interpreter and FreeType's follow different rules, the hinted outlines are those of an equivalent copy of
//! the font, on which skrifa gives what FreeType gives on the font itself (`equivalent`, and `docs/upstream.md`).

mod equivalent;
mod outline;
mod postscript;
pub(crate) mod unhinted;

use std::sync::{Arc, OnceLock};

use read_fonts::tables::glyf::{Glyph, is_hint_reliant};
use read_fonts::{FontRef, ReadError, TableProvider};
use skrifa::font::Font;
use skrifa::{HintEngine, HintOptions, OutlineSource, RasterTarget, ScaleError, ScalerFont, ScalerSource};

use crate::error::Error;
use crate::input::open::owned;
use crate::input::ppem::MAX_TEACHER_PPEM;
use crate::options::Hinter;
use equivalent::Equivalent;
use nfr::Target;
use nfr::internals::model::sizes::Origin;
use postscript::PostScript;
use unhinted::{draw, glyf_of, undrawable};

pub use outline::Outline;
pub(crate) use unhinted::UnhintedOutlines;

/// A hinted font as ground truth. It keeps a copy of the font, and may be used from several threads.
pub struct Teacher {
    unhinted: UnhintedOutlines,
    /// The font whose hints are run. Behind the font's own glyphs it may have more.
    hinted: Font,
    /// The TrueType copy of a font with PostScript outlines.
    postscript: Option<Arc<PostScript>>,
    uncertain: Vec<u16>,
    hinter: Hinter,
    raster: RasterTarget,
}

impl Teacher {
    /// Takes the font as a teacher, with its own hints.
    ///
    /// # Errors
    ///
    /// As [`Teacher::with_hinter`].
    pub fn new(font: &FontRef<'_>, target: Target) -> Result<Self, Error> {
        Self::with_hinter(font, target, Hinter::Font)
    }

    /// Takes the font as a teacher. One with PostScript outlines gets a TrueType copy, whose points the outlines have then
    /// ([`Self::true_type`]). Of a variable one, the default instance is taken.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a variable TrueType font, a font without outlines, one without hints if those are to be run, or one that
    /// FreeType calls tricky, whose outlines are only parts of glyphs before its programs put them together; `Malformed` if its
    /// size of an em is not one that OpenType allows.
    pub fn with_hinter(font: &FontRef<'_>, target: Target, hinter: Hinter) -> Result<Self, Error> {
        let unhinted = UnhintedOutlines::new(font)?;
        match unhinted.table() {
            Some(OutlineSource::Glyf) => Self::of_true_type(font, unhinted, target, hinter),
            Some(OutlineSource::Cff | OutlineSource::Cff2) => {
                let postscript = PostScript::new(font, hinter)?;
                Ok(Self {
                    unhinted: UnhintedOutlines::new(&copy_of(&postscript)?)?,
                    hinted: owned(font)?,
                    postscript: Some(Arc::new(postscript)),
                    uncertain: Vec::new(),
                    hinter,
                    raster: raster_target(target, hinter)?,
                })
            }
            _ => Err(Error::Unsupported(
                "the font has no outlines in 'glyf', 'CFF ' or 'CFF2'; pass a hinted TrueType or OpenType font".into(),
            )),
        }
    }

    fn of_true_type(
        font: &FontRef<'_>,
        unhinted: UnhintedOutlines,
        target: Target,
        hinter: Hinter,
    ) -> Result<Self, Error> {
        if font.fvar().is_ok() {
            return Err(Error::Unsupported(
                "the font is variable; name an instance (--instance, --axis), or make one first (fonttools varLib.instancer)"
                    .into(),
            ));
        }
        if is_hint_reliant(font) {
            return Err(Error::Unsupported(
                "the font's hint programs put its glyphs together from parts (FreeType calls such fonts tricky); without them, as \
                 beyond the learned sizes, its outlines are no glyphs; keep the font as it is"
                    .into(),
            ));
        }
        let raster = raster_target(target, hinter)?;
        if hinter == Hinter::Auto {
            let hinted = unhinted.font().clone();
            return Ok(Self { unhinted, hinted, postscript: None, uncertain: Vec::new(), hinter, raster });
        }
        if !has_glyph_programs(font)? {
            return Err(Error::Unsupported(
                "the font's glyphs have no hint programs, so there is nothing to learn; pass a hinted font, or let skrifa's \
                 autohinter hint it (--hinter auto)"
                    .into(),
            ));
        }
        let Equivalent { font: copy, uncertain } = Equivalent::of(font)?;
        let hinted = copy.unwrap_or_else(|| unhinted.font().clone());
        Ok(Self { unhinted, hinted, postscript: None, uncertain, hinter, raster })
    }

    /// The font whose outlines models move: `font`, which is the one that this teacher was made of, or its TrueType copy.
    ///
    /// # Errors
    ///
    /// `Malformed` if the copy cannot be read.
    pub fn true_type<'t>(&'t self, font: &FontRef<'t>) -> Result<FontRef<'t>, Error> {
        self.postscript.as_ref().map_or_else(|| Ok(font.clone()), |postscript| copy_of(postscript))
    }

    /// Whether the font has PostScript outlines.
    pub fn is_postscript(&self) -> bool {
        self.postscript.is_some()
    }

    /// Where the models' outlines and hints come from.
    pub(crate) fn origin(&self) -> Origin {
        match (self.is_postscript(), self.hinter) {
            (false, _) => Origin::TrueType,
            (true, Hinter::Auto) => Origin::Cubic,
            (true, Hinter::Font) => Origin::PostScript,
        }
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> u16 {
        self.unhinted.units_per_em()
    }

    /// What hints its glyphs.
    pub fn hinter(&self) -> Hinter {
        self.hinter
    }

    /// The composite glyphs, ascending, that FreeType may hint otherwise: a program in them reads what another one wrote, in a
    /// way that skrifa does not follow.
    pub fn uncertain(&self) -> &[u16] {
        &self.uncertain
    }

    /// Sets the hinter up for one size: the interpreter runs `fpgm` and `prep`. If the font switches hinting off at this
    /// size, [`TeacherAt::is_hinted`] is false, and its outlines are unhinted, as in other renderers.
    ///
    /// # Errors
    ///
    /// `Malformed` if a program fails.
    pub fn at(&self, ppem: u16) -> Result<TeacherAt, Error> {
        check_ppem(f32::from(ppem))?;
        let source = glyf_of(self.hinted.clone());
        let (scaler, engine) = match self.hinter {
            Hinter::Font => (interpreter(source, ppem, self.raster, OnHintError::Fail), HintEngine::TrueType),
            Hinter::Auto => (autohinter(source, ppem, self.raster), HintEngine::Auto),
        };
        if let Some(e) = scaler.hinting_error() {
            return Err(Error::Malformed(format!(
                "the font's 'fpgm' or 'prep' program fails at {ppem} ppem ({e}); leave the size out, or repair the font"
            )));
        }
        let engine = if self.postscript.is_some() && engine == HintEngine::TrueType {
            HintEngine::PostScript
        } else {
            engine
        };
        if scaler.hint_engine() != Some(engine) {
            return Err(Error::Unsupported(format!(
                "skrifa does not hint the font as asked for ({}) at {ppem} ppem; pass a hinted TrueType font",
                self.hinter
            )));
        }
        Ok(TeacherAt {
            strict: scaler,
            lenient: OnceLock::new(),
            postscript: self.postscript.clone(),
            glyphs: self.unhinted.font().num_glyphs(),
            ppem,
            raster: self.raster,
        })
    }

    /// The unhinted outline at any size.
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph` for a glyph that the font does not have, `Malformed` for one that cannot be drawn.
    pub fn unhinted(&self, gid: u16, ppem: f32) -> Result<Outline, Error> {
        check_ppem(ppem)?;
        self.check(gid)?;
        self.unhinted.at(gid, ppem)
    }

    /// The unhinted outline in em.
    ///
    /// # Errors
    ///
    /// As `unhinted`.
    pub fn unhinted_em(&self, gid: u16) -> Result<Outline, Error> {
        self.check(gid)?;
        self.unhinted.em(gid)
    }

    /// Whether the glyph has a TrueType outline.
    fn check(&self, gid: u16) -> Result<(), Error> {
        self.postscript.as_ref().map_or(Ok(()), |postscript| postscript.check(gid))
    }
}

fn copy_of(postscript: &PostScript) -> Result<FontRef<'_>, Error> {
    FontRef::new(&postscript.true_type)
        .map_err(|e| Error::Malformed(format!("the font has no TrueType copy that can be read ({e})")))
}

/// The teacher at one size.
pub struct TeacherAt {
    strict: ScalerFont,
    /// Created for the first glyph whose program fails, which most fonts do not have.
    lenient: OnceLock<ScalerFont>,
    postscript: Option<Arc<PostScript>>,
    /// The number of the font's own glyphs.
    glyphs: u32,
    ppem: u16,
    raster: RasterTarget,
}

impl TeacherAt {
    /// The size in pixels per em.
    pub fn ppem(&self) -> u16 {
        self.ppem
    }

    /// Whether the font wants hinting at this size; its `prep` program can switch it off.
    pub fn is_hinted(&self) -> bool {
        self.strict.is_hinted()
    }

    /// The hinted outline.
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph` for a glyph that the font does not have, `Malformed` if it cannot be drawn.
    pub fn hinted(&self, gid: u16) -> Result<Outline, Error> {
        self.hinted_with_error(gid).map(|(outline, _)| outline)
    }

    /// The hinted outline, and the error of the glyph's hint program if it fails. The teacher keeps what the program has
    /// done up to the error. So do other renderers, but not for every error: FreeType goes on after an instruction whose
    /// point does not exist.
    ///
    /// # Errors
    ///
    /// As `hinted`.
    pub fn hinted_with_error(&self, gid: u16) -> Result<(Outline, Option<String>), Error> {
        if u32::from(gid) >= self.glyphs {
            return Err(Error::NoSuchGlyph(gid.into()));
        }
        let ppem = f32::from(self.ppem);
        match draw(&self.strict, gid) {
            Ok(outline) => match &self.postscript {
                Some(postscript) => Ok((postscript.hinted(gid, outline, ppem)?, None)),
                None => Ok((outline, None)),
            },
            Err(e @ ScaleError::Hinting(_)) => {
                let lenient = self.lenient.get_or_init(|| {
                    interpreter(
                        glyf_of(self.strict.font().clone()),
                        self.ppem,
                        self.raster,
                        OnHintError::Keep,
                    )
                });
                let outline = draw(lenient, gid).map_err(|e| undrawable(gid, Some(ppem), &e))?;
                let hint_error = format!(
                    "the hint program of glyph {gid} fails at {ppem} ppem ({e}); the model learns what it has done up to \
                     there, and renderers that go on after the failing instruction may draw the glyph differently"
                );
                Ok((outline, Some(hint_error)))
            }
            Err(e) => Err(undrawable(gid, Some(ppem), &e)),
        }
    }
}

fn check_ppem(ppem: f32) -> Result<(), Error> {
    if ppem > 0.0 && ppem <= f32::from(MAX_TEACHER_PPEM) {
        return Ok(());
    }
    Err(Error::InvalidParameter(format!("{ppem} ppem is outside 0–{MAX_TEACHER_PPEM}; choose other sizes")))
}

/// The treatment of a glyph whose hint program fails.
#[derive(Clone, Copy, PartialEq)]
enum OnHintError {
    /// Drawing fails.
    Fail,
    /// The points stay where the program left them.
    Keep,
}

/// The font's own programs for one size, with the settings under which skrifa equals FreeType's default render.
/// FreeType 2.13 ignores `gasp`; skrifa calls that classic ClearType.
fn interpreter(
    font: impl Into<ScalerSource>,
    ppem: u16,
    target: RasterTarget,
    on_error: OnHintError,
) -> ScalerFont {
    let options = HintOptions::interpreter()
        .with_target(target)
        .with_classic_cleartype(true)
        .with_symmetric_rendering(true)
        .with_preserve_linear_metrics(false)
        .with_pedantic(on_error == OnHintError::Fail);
    ScalerFont::hinted(font, f32::from(ppem), options)
}

/// skrifa's autohinter at one size. It has no settings but the target, and reads no programs that can fail.
fn autohinter(font: impl Into<ScalerSource>, ppem: u16, target: RasterTarget) -> ScalerFont {
    ScalerFont::hinted(font, f32::from(ppem), HintOptions::auto().with_target(target))
}

/// Whether any glyph has a hint program. Without one no point is moved, whatever `fpgm` and `prep` do: many fonts without hints have a
/// `prep` of seven bytes, which switches drop-out control on.
fn has_glyph_programs(font: &FontRef<'_>) -> Result<bool, Error> {
    let unreadable = |tag: &str, e: ReadError| {
        Error::Malformed(format!("table '{tag}' cannot be read ({e}); repair the font"))
    };
    let glyphs = font.maxp().map_err(|e| unreadable("maxp", e))?.num_glyphs();
    let loca = font.loca(None).map_err(|e| unreadable("loca", e))?;
    let glyf = font.glyf().map_err(|e| unreadable("glyf", e))?;
    Ok((0..u32::from(glyphs)).any(|glyph| match loca.get_glyf(glyph.into(), &glyf) {
        Ok(Some(Glyph::Simple(simple))) => !simple.instructions().is_empty(),
        Ok(Some(Glyph::Composite(composite))) => {
            composite.instructions().is_some_and(|program| !program.is_empty())
        }
        _ => false,
    }))
}

/// skrifa's name of a target. Smooth, the autohinter's "light" moves points up and down only and keeps the spacing, as the
/// interpreter does; its "normal" fits stems to whole columns, too.
fn raster_target(target: Target, hinter: Hinter) -> Result<RasterTarget, Error> {
    match target {
        Target::Smooth if hinter == Hinter::Auto => Ok(RasterTarget::Light),
        Target::Smooth => Ok(RasterTarget::Normal),
        Target::Mono => Ok(RasterTarget::Mono),
        Target::Lcd => Ok(RasterTarget::Lcd),
        other => Err(Error::Unsupported(format!("there is no teacher for the target {other}"))),
    }
}
