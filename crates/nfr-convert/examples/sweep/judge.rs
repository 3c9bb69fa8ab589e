//! Errors of the converted glyphs, as the library draws them, against the hinted bitmaps of skrifa and of FreeType.

use std::error::Error;
use std::ops::RangeInclusive;
use std::rc::Rc;

use freetype::face::LoadFlag;
use nfr::{Font, Rasterizer, Target};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::open::open;
use nfr_convert::teacher::Teacher;
use serde::Serialize;

use crate::choice::Chosen;
use crate::freetype_bitmap::freetype_bitmap;
use crate::warnings::Warnings;

/// A model with this much more error than the unhinted outline, in levels of 255 for a mean pixel, looks worse; less is not seen. The
/// converter warns by the same measure.
const VISIBLE_LEVELS: f64 = 0.125;

/// The face that was converted.
pub(crate) struct Original<'d> {
    pub(crate) data: &'d [u8],
    pub(crate) index: u32,
    /// The same without flags that would make FreeType draw otherwise.
    pub(crate) for_freetype: &'d Rc<Vec<u8>>,
}

/// The errors of a face.
#[derive(Serialize)]
pub(crate) struct Judged {
    pixels: u64,
    #[serde(flatten)]
    mae: Errors,
    /// Why FreeType draws a glyph not at all, if there is one. Its figures leave such glyphs out.
    freetype_error: Option<String>,
    /// The glyph and size with the largest mean absolute error of the model against skrifa.
    worst: Option<At>,
    /// Those of the model against FreeType.
    worst_freetype: Option<At>,
    /// Glyphs whose models are visibly farther from the hinted bitmaps than the unhinted outlines, over all sizes.
    worse: Vec<Worse>,
}

/// Mean absolute errors, 0..1, over glyphs and sizes.
#[derive(Serialize, Clone, Copy)]
struct Errors {
    /// The models against skrifa, and against FreeType.
    neural: f64,
    neural_freetype: f64,
    /// The unhinted outlines against skrifa, and against FreeType.
    unhinted: f64,
    unhinted_freetype: f64,
    /// skrifa, the teacher, against FreeType.
    teacher_freetype: f64,
}

/// One glyph at one size.
#[derive(Serialize, Clone, Copy)]
struct At {
    #[serde(flatten)]
    glyph: Chosen,
    ppem: u16,
    mae: f64,
}

#[derive(Serialize)]
struct Worse {
    #[serde(flatten)]
    glyph: Chosen,
    /// The judge: skrifa or FreeType.
    judge: &'static str,
    neural: f64,
    unhinted: f64,
    /// Whether a warning of the converter is about the glyph.
    warned: bool,
}

/// Sums of the same five comparisons as [`Errors`] has.
#[derive(Default, Clone, Copy)]
struct Compared {
    neural: Sums,
    neural_freetype: Sums,
    unhinted: Sums,
    unhinted_freetype: Sums,
    teacher_freetype: Sums,
}

impl Compared {
    fn merge(&mut self, other: &Self) {
        self.neural.merge(&other.neural);
        self.neural_freetype.merge(&other.neural_freetype);
        self.unhinted.merge(&other.unhinted);
        self.unhinted_freetype.merge(&other.unhinted_freetype);
        self.teacher_freetype.merge(&other.teacher_freetype);
    }

    fn errors(&self) -> Errors {
        Errors {
            neural: self.neural.mae(),
            neural_freetype: self.neural_freetype.mae(),
            unhinted: self.unhinted.mae(),
            unhinted_freetype: self.unhinted_freetype.mae(),
            teacher_freetype: self.teacher_freetype.mae(),
        }
    }
}

/// Draws and compares the glyphs at the sizes.
pub(crate) fn judge(
    original: &Original<'_>,
    converted: Vec<u8>,
    glyphs: &[Chosen],
    target: Target,
    sizes: RangeInclusive<u16>,
    warnings: &Warnings,
) -> Result<Judged, Box<dyn Error>> {
    let teacher = Teacher::new(&open(original.data, original.index)?, target)?;
    let index = isize::try_from(original.index)?;
    let face = freetype::Library::init()?.new_memory_face(Rc::clone(original.for_freetype), index)?;
    let flags = if target == Target::Mono { LoadFlag::TARGET_MONO } else { LoadFlag::TARGET_NORMAL };
    let font = Font::new(converted)?;
    let mut rasterizer = Rasterizer::new(&font);
    let mut all = vec![Compared::default(); glyphs.len()];
    let (mut worst, mut worst_freetype, mut freetype_error) = (None, None, None);
    for ppem in sizes {
        let at = teacher.at(ppem)?;
        for (glyph, all) in glyphs.iter().zip(&mut all) {
            let truth = at.hinted(glyph.gid)?.rasterize()?;
            let neural = rasterizer.render(glyph.gid.into(), f32::from(ppem))?;
            let unhinted = teacher.unhinted(glyph.gid, f32::from(ppem))?.rasterize()?;
            let mut one = Compared {
                neural: Sums::of(&truth, &neural),
                unhinted: Sums::of(&truth, &unhinted),
                ..Compared::default()
            };
            match freetype_bitmap(&face, glyph.gid, ppem, flags) {
                Ok(theirs) => {
                    one.neural_freetype.add(&theirs, &neural);
                    one.unhinted_freetype.add(&theirs, &unhinted);
                    one.teacher_freetype.add(&theirs, &truth);
                }
                Err(error) => {
                    let text = || format!("glyph {} at {ppem} ppem: {error}", glyph.gid);
                    freetype_error.get_or_insert_with(text);
                }
            }
            note(&mut worst, *glyph, ppem, one.neural.mae());
            note(&mut worst_freetype, *glyph, ppem, one.neural_freetype.mae());
            all.merge(&one);
        }
    }
    let worse = glyphs.iter().zip(&all).flat_map(|(glyph, sums)| worse(*glyph, sums, warnings)).collect();
    let mut sums = Compared::default();
    all.iter().for_each(|one| sums.merge(one));
    let pixels = sums.neural.figures().pixels;
    Ok(Judged { pixels, mae: sums.errors(), freetype_error, worst, worst_freetype, worse })
}

/// Keeps the larger error.
fn note(worst: &mut Option<At>, glyph: Chosen, ppem: u16, mae: f64) {
    if mae > worst.map_or(0.0, |worst| worst.mae) {
        *worst = Some(At { glyph, ppem, mae });
    }
}

/// By which judges the model of a glyph is worse than its unhinted outline.
fn worse(glyph: Chosen, sums: &Compared, warnings: &Warnings) -> Vec<Worse> {
    let by_skrifa = ("skrifa", &sums.neural, &sums.unhinted);
    let by_freetype = ("FreeType", &sums.neural_freetype, &sums.unhinted_freetype);
    let is_worse = |(_, neural, unhinted): &(_, &Sums, &Sums)| {
        let visible = VISIBLE_LEVELS * neural.figures().pixels as f64;
        neural.absolute() as f64 > unhinted.absolute() as f64 + visible
    };
    let judges = [by_skrifa, by_freetype].into_iter().filter(is_worse);
    let told = judges.map(|(judge, neural, unhinted)| Worse {
        glyph,
        judge,
        neural: neural.mae(),
        unhinted: unhinted.mae(),
        warned: warnings.name(glyph.gid),
    });
    told.collect()
}
