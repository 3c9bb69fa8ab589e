//! Glyphs that the teacher can draw: one that it cannot must not end the conversion of all others.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::conversion::{Progress, Stage};
use crate::error::Error;
use crate::options::Options;
use crate::parallel;
use crate::teacher::TeacherAt;

/// The most glyphs that one message lists.
const GLYPHS_LISTED: usize = 3;

/// Draws every selected glyph at every size. Returns those that can be drawn, and the others, about which it warns.
///
/// # Errors
///
/// That of the first glyph, if none can be drawn; `NoSuchGlyph` for a glyph that the font does not have.
pub(super) fn readable(
    sizes: &[&[TeacherAt]],
    options: &Options,
    progress: &dyn Progress,
) -> Result<(Vec<u16>, Vec<u16>), Error> {
    let checked = parallel::map(&options.gids, options.jobs, |gid| {
        // A font may find a panic in what reads it.
        let drawn = catch_unwind(AssertUnwindSafe(|| {
            let mut sizes = sizes.iter().copied().flatten();
            sizes.try_for_each(|at| {
                let outline = at.hinted(*gid)?;
                outline.rasterize().map(drop).map_err(|e| e.of_glyph(*gid, at.ppem()))
            })
        }));
        progress.worked(Stage::Reading);
        match drawn {
            Ok(Ok(())) => Ok(None),
            Ok(Err(error @ Error::NoSuchGlyph(_))) => Err(error),
            Ok(Err(error)) => Ok(Some(error)),
            Err(_) => Ok(Some(Error::Malformed(format!(
                "skrifa panics on glyph {gid}; leave it out, or repair the font"
            )))),
        }
    })?;
    let (mut good, mut bad) = (Vec::new(), Vec::new());
    for (gid, error) in options.gids.iter().zip(checked) {
        match error {
            None => good.push(*gid),
            Some(error) => bad.push((*gid, error)),
        }
    }
    if good.is_empty()
        && let Some((_, error)) = bad.first()
    {
        return Err(error.clone());
    }
    if !bad.is_empty() {
        let listed: Vec<String> =
            bad.iter().take(GLYPHS_LISTED).map(|(_, error)| error.to_string()).collect();
        let more = bad.len().saturating_sub(GLYPHS_LISTED);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        progress.warn(&format!("left without a model: {}{more}", listed.join("; ")));
    }
    Ok((good, bad.into_iter().map(|(gid, _)| gid).collect()))
}
