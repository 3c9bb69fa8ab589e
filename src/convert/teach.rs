//! Lessons: everything that one glyph's model learns from, drawn once.

use crate::convert::teacher::{Teacher, TeacherAt};
use crate::error::Error;
use crate::render::Bitmap;
use crate::render::outline::Outline;

/// One glyph as the teacher shows it.
#[derive(Debug, Clone)]
pub struct Lesson {
    /// The glyph.
    pub gid: u16,
    /// The plain outline in em.
    pub outline: Outline,
    /// What the glyph's hint program did wrong, if anything.
    pub complaint: Option<String>,
    /// The hinted glyph at each size, in the order of the sizes.
    pub sizes: Vec<HintedGlyph>,
}

/// One glyph hinted for one size.
#[derive(Debug, Clone)]
pub struct HintedGlyph {
    /// Pixels per em.
    pub ppem: u16,
    /// The hinted outline's coordinates in pixels, corresponding to those of the plain outline.
    pub points: Vec<[f32; 2]>,
    /// Its exact coverage.
    pub bitmap: Bitmap,
}

/// Draws the lesson of one glyph.
///
/// # Errors
///
/// As the teacher's, and `Unsupported` if the hint programs change the number of points.
pub fn lesson(teacher: &Teacher<'_>, sizes: &[TeacherAt<'_, '_>], gid: u16) -> Result<Lesson, Error> {
    let outline = teacher.unhinted_em(gid)?;
    let mut complaint = None;
    let sizes = sizes
        .iter()
        .map(|at| {
            let (hinted, wrong) = at.hinted_or_complaint(gid)?;
            complaint = complaint.take().or(wrong);
            let bitmap = hinted.rasterize();
            if hinted.points.len() != outline.points.len() {
                return Err(Error::Unsupported(format!(
                    "the hint program of glyph {gid} changes its outline's structure at {} ppem; leave the glyph out",
                    at.ppem()
                )));
            }
            Ok(HintedGlyph { ppem: at.ppem(), points: hinted.points, bitmap })
        })
        .collect::<Result<_, _>>()?;
    Ok(Lesson { gid, outline, complaint, sizes })
}
