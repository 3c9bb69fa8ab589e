//! Glyphs that hint programs put together: their outlines are other pictures before the programs run.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::warnings::glyphs_text;
use crate::conversion::Progress;
use crate::error::Error;
use crate::options::Options;
use crate::parallel;
use crate::teacher::{Teacher, TeacherAt};

/// A size in pixels per em at which fitting to the grid moves points by a small part of an em only.
const LARGE_PPEM: u16 = 256;
/// A program that moves a point farther than this (em) at the large size changes what the glyph looks like. In 250 hinted fonts,
/// fitting to the grid moves points by less than 0.04 em at that size.
const FAR: f32 = 0.1;

/// Warns of the glyphs whose unhinted outlines look different. Fonts that FreeType knows as tricky are refused before.
pub(super) fn warn_of_assembled(
    teacher: &Teacher,
    options: &Options,
    progress: &dyn Progress,
) -> Result<(), Error> {
    // Programs that fail at this size have been run at the learned ones.
    let Ok(at) = teacher.at(LARGE_PPEM) else { return Ok(()) };
    // A font may find a panic in what reads it.
    let checked = parallel::map(&options.gids, options.jobs, |gid| {
        Ok(catch_unwind(AssertUnwindSafe(|| moves_far(teacher, &at, *gid))).unwrap_or_default())
    })?;
    let far: Vec<u16> =
        options.gids.iter().zip(checked).filter(|(_, far)| *far).map(|(gid, _)| *gid).collect();
    if far.is_empty() {
        return Ok(());
    }
    let (first, last) = (options.ppem.start(), options.ppem.end());
    progress.warn(&format!(
        "hint programs move points of {} by more than a tenth of an em at all sizes, as where they put a glyph together; outside of \
         {first}–{last} ppem, and in programs that know no models, their unhinted outlines are drawn, which look different",
        glyphs_text(&far)
    ));
    Ok(())
}

/// Whether hinting moves a point far. False for a glyph that cannot be drawn, and for one whose contours hinting changes.
fn moves_far(teacher: &Teacher, at: &TeacherAt, gid: u16) -> bool {
    let (Ok(hinted), Ok(plain)) = (at.hinted(gid), teacher.unhinted_em(gid)) else { return false };
    let apart = |(hinted, plain): (&[f32; 2], &[f32; 2])| {
        [0, 1].iter().any(|axis| (hinted[*axis] / f32::from(LARGE_PPEM) - plain[*axis]).abs() > FAR)
    };
    hinted.has_contours_of(&plain) && hinted.points.iter().zip(&plain.points).any(apart)
}
