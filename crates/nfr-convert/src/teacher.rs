//! The teacher: skrifa's hinted and unhinted outlines, filled with exact area coverage by zeno.
//!
//! skrifa falls back silently in several places. Here the interpreter is asked for explicitly, and whatever
//! would make it do something else than run the font's own programs at the size asked for is an error.

use read_fonts::{FontRef, TableProvider};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{
    DrawSettings, Engine, HintingInstance, HintingOptions, OutlineGlyphCollection, OutlineGlyphFormat,
    SmoothMode, Target as SkrifaTarget,
};
use skrifa::{GlyphId, MetadataProvider};

use crate::error::Error;
use crate::outline::Outline;
use nfr::internals::model::Target;

/// The largest size that the teacher draws, in pixels per em.
pub const MAX_PPEM: f32 = 1024.0;

/// A hinted font as the source of truth.
pub struct Teacher<'a> {
    outlines: OutlineGlyphCollection<'a>,
    target: Target,
    units_per_em: u16,
}

impl<'a> Teacher<'a> {
    /// Takes the font as a teacher.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a variable font, a font without TrueType outlines, or one without hint programs.
    pub fn new(font: &FontRef<'a>, target: Target) -> Result<Self, Error> {
        let outlines = font.outline_glyphs();
        match outlines.format() {
            Some(OutlineGlyphFormat::Glyf) => {}
            Some(_) => {
                return Err(Error::Unsupported(
                    "the outlines are PostScript (CFF), not TrueType; convert them to a hinted TrueType font first"
                        .into(),
                ));
            }
            None => {
                return Err(Error::Unsupported(
                    "the font has no 'glyf' outlines; pass a TrueType font".into(),
                ));
            }
        }
        if font.fvar().is_ok() {
            return Err(Error::Unsupported(
                "the font is variable; make a static instance first (fonttools varLib.instancer)".into(),
            ));
        }
        if font.fpgm().is_err() && font.prep().is_err() {
            return Err(Error::Unsupported(
                "the font has no hint programs ('fpgm', 'prep'), so there is nothing to learn; pass a hinted font"
                    .into(),
            ));
        }
        let units_per_em = font
            .head()
            .map_err(|e| Error::Malformed(format!("table 'head' cannot be read ({e})")))?
            .units_per_em();
        Ok(Self { outlines, target, units_per_em })
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> u16 {
        self.units_per_em
    }

    /// What this teacher hints for.
    pub fn target(&self) -> Target {
        self.target
    }

    /// Sets the interpreter up for one size: runs `fpgm` and `prep`. If the font switches hinting off at this
    /// size, [`TeacherAt::is_hinted`] tells, and what it shows is the plain outline, as in other renderers.
    ///
    /// # Errors
    ///
    /// `Malformed` if a program fails.
    pub fn at(&self, ppem: u16) -> Result<TeacherAt<'_, 'a>, Error> {
        check_ppem(f32::from(ppem))?;
        let options = HintingOptions { engine: Engine::Interpreter, target: skrifa_target(self.target) };
        let size = Size::new(f32::from(ppem));
        let hinting =
            HintingInstance::new(&self.outlines, size, LocationRef::default(), options).map_err(|e| {
                Error::Malformed(format!("the font's 'fpgm' or 'prep' program fails at {ppem} ppem ({e})"))
            })?;
        let hinting = hinting.is_enabled().then_some(hinting);
        Ok(TeacherAt { teacher: self, hinting, ppem })
    }

    /// The plain scaled outline, at any size.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph that the font does not have, `Malformed` for one that cannot be drawn.
    pub fn unhinted(&self, gid: u16, ppem: f32) -> Result<Outline, Error> {
        check_ppem(ppem)?;
        self.draw(gid, DrawSettings::unhinted(Size::new(ppem), LocationRef::default()), ppem)
    }

    /// The plain outline in em.
    ///
    /// # Errors
    ///
    /// As `unhinted`.
    pub fn unhinted_em(&self, gid: u16) -> Result<Outline, Error> {
        // Unscaled font units are exact; a scaled outline is rounded to 26.6 pixels.
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        let mut outline = self.draw(gid, settings, f32::from(self.units_per_em))?;
        outline.scale(1.0 / f32::from(self.units_per_em));
        Ok(outline)
    }

    fn draw(&self, gid: u16, settings: DrawSettings<'_>, ppem: f32) -> Result<Outline, Error> {
        let glyph = self.outlines.get(GlyphId::from(gid)).ok_or(Error::MissingGlyph(gid))?;
        let mut outline = Outline::default();
        glyph
            .draw(settings, &mut outline)
            .map_err(|e| Error::Malformed(format!("glyph {gid} cannot be drawn at {ppem} ppem ({e})")))?;
        Ok(outline)
    }
}

/// The teacher at one size.
pub struct TeacherAt<'t, 'a> {
    teacher: &'t Teacher<'a>,
    hinting: Option<HintingInstance>,
    ppem: u16,
}

impl TeacherAt<'_, '_> {
    /// The size in pixels per em.
    pub fn ppem(&self) -> u16 {
        self.ppem
    }

    /// Whether the font wants hinting at this size; its `prep` program can switch it off.
    pub fn is_hinted(&self) -> bool {
        self.hinting.is_some()
    }

    /// The hinted outline.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph that the font does not have, `Malformed` if it cannot be drawn.
    pub fn hinted(&self, gid: u16) -> Result<Outline, Error> {
        self.hinted_or_complaint(gid).map(|(outline, _)| outline)
    }

    /// The hinted outline, and what went wrong in the glyph's program if anything did. Interpreters carry on
    /// with what such a program has done so far, and so does this one.
    ///
    /// # Errors
    ///
    /// As `hinted`.
    pub fn hinted_or_complaint(&self, gid: u16) -> Result<(Outline, Option<String>), Error> {
        let ppem = f32::from(self.ppem);
        let Some(hinting) = &self.hinting else { return Ok((self.teacher.unhinted(gid, ppem)?, None)) };
        match self.teacher.draw(gid, DrawSettings::hinted(hinting, true), ppem) {
            Ok(outline) => Ok((outline, None)),
            Err(error @ Error::MissingGlyph(_)) => Err(error),
            Err(error) => {
                let outline = self.teacher.draw(gid, DrawSettings::hinted(hinting, false), ppem)?;
                Ok((outline, Some(format!("{error}; other renderers ignore that, and so does the model"))))
            }
        }
    }
}

fn check_ppem(ppem: f32) -> Result<(), Error> {
    if ppem > 0.0 && ppem <= MAX_PPEM {
        return Ok(());
    }
    Err(Error::InvalidParameter(format!("{ppem} ppem is outside 0–{MAX_PPEM}")))
}

/// The settings under which skrifa equals FreeType's default render.
fn skrifa_target(target: Target) -> SkrifaTarget {
    let smooth =
        |mode| SkrifaTarget::Smooth { mode, symmetric_rendering: true, preserve_linear_metrics: false };
    match target {
        Target::Smooth => smooth(SmoothMode::Normal),
        Target::Mono => SkrifaTarget::Mono,
        Target::Lcd => smooth(SmoothMode::Lcd),
    }
}
