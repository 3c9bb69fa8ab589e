//! Lessons: everything that one glyph's model learns from, drawn once.

use crate::error::Error;
use crate::outline::Outline;
use crate::teacher::{Teacher, TeacherAt};
use nfr::Bitmap;

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
    /// Whether this is what other sizes suggest, not what the teacher shows.
    pub predicted: bool,
}

impl Lesson {
    /// The plain glyph at sizes beyond the hinted ones, where the model has to follow the outline.
    ///
    /// # Errors
    ///
    /// As [`Outline::rasterize`].
    pub(super) fn beyond(&self) -> Result<Vec<HintedGlyph>, Error> {
        let last = self.sizes.last().map_or(0, |size| size.ppem);
        let plain = |ppem: u16| {
            let points: Vec<_> = self.outline.points.iter().map(|p| p.map(|v| v * f32::from(ppem))).collect();
            let bitmap = self.outline.with_points(&points)?.rasterize()?;
            Ok(HintedGlyph { ppem, points, bitmap, predicted: false })
        };
        [last + last.div_ceil(2), last * 2].map(plain).into_iter().collect()
    }
}

/// Draws the lesson of one glyph.
///
/// # Errors
///
/// As the teacher's and [`Outline::rasterize`]; `Unsupported` if the hint programs change the number of points, or if
/// components put points where 16 bits do not reach.
pub fn lesson(teacher: &Teacher, sizes: &[TeacherAt], gid: u16) -> Result<Lesson, Error> {
    let outline = teacher.unhinted_em(gid)?;
    let units = f32::from(teacher.units_per_em());
    let far = |v: &f32| !(f32::from(i16::MIN)..=f32::from(i16::MAX)).contains(&(v * units));
    if let Some(v) = outline.points.iter().flatten().find(|v| far(v)) {
        return Err(Error::Unsupported(format!(
            "glyph {gid} has a point {} font units from its origin, which does not fit 16 bits; leave the glyph out",
            v * units
        )));
    }
    let mut complaint = None;
    let sizes = sizes
        .iter()
        .map(|at| {
            let (hinted, wrong) = at.hinted_or_complaint(gid)?;
            complaint = complaint.take().or(wrong);
            let bitmap = hinted.rasterize()?;
            if hinted.points.len() != outline.points.len() {
                return Err(Error::Unsupported(format!(
                    "the hint program of glyph {gid} changes its outline's structure at {} ppem; leave the glyph out",
                    at.ppem()
                )));
            }
            Ok(HintedGlyph { ppem: at.ppem(), points: hinted.points, bitmap, predicted: false })
        })
        .collect::<Result<_, _>>()?;
    Ok(Lesson { gid, outline, complaint, sizes })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use read_fonts::FontRef;
    use read_fonts::types::Tag;
    use write_fonts::FontBuilder;

    use super::*;
    use crate::samples::{SIZES, lessons};
    use nfr::Target;

    #[test]
    fn a_lesson_has_every_size_with_a_point_for_each_point_of_the_outline() {
        let (lessons, _) = lessons("g% ", Target::Smooth);
        for lesson in &lessons {
            assert!(lesson.sizes.iter().map(|s| s.ppem).eq(SIZES));
            assert!(lesson.sizes.iter().all(|s| s.points.len() == lesson.outline.points.len()));
            assert_eq!(lesson.complaint, None);
        }
        assert!(lessons[0].sizes.iter().all(|s| s.bitmap.placement.area() > 0));
        assert!(lessons[2].outline.points.is_empty() && lessons[2].sizes[0].bitmap == Bitmap::default());
    }

    #[test]
    fn smooth_hinting_moves_points_up_and_down_only() {
        let (lessons, _) = lessons("gR", Target::Smooth);
        for (lesson, size) in lessons.iter().flat_map(|l| l.sizes.iter().map(move |s| (l, s))) {
            let plain = lesson.outline.points.iter().map(|p| p.map(|v| v * f32::from(size.ppem)));
            // Scaled points are rounded to 1/64 pixel, and implied ones lie between two of them.
            let moved = plain.zip(&size.points).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f32::max);
            assert!(moved <= 1.0 / 32.0, "{moved} pixels at {} ppem", size.ppem);
        }
    }

    #[test]
    fn a_glyph_whose_program_fails_is_taught_as_far_as_it_got_with_a_complaint() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSans-Regular.ttf");
        let data = std::fs::read(path).unwrap();
        let original = FontRef::new(&data).unwrap();
        // Without `fpgm` the functions that glyph programs call are not defined. This `prep` does nothing:
        // PUSHB[0] 1, POP.
        let mut builder = FontBuilder::new();
        builder.add_raw(Tag::new(b"prep"), vec![0xB0, 1, 0x21]).add_raw(Tag::new(b"fpgm"), Vec::new());
        builder.copy_missing_tables(original);
        let broken = builder.build();
        let teacher = Teacher::new(&FontRef::new(&broken).unwrap(), Target::Smooth).unwrap();
        let sizes = [teacher.at(16).unwrap()];
        let lesson = lesson(&teacher, &sizes, 36).unwrap();
        assert!(lesson.complaint.is_some_and(|c| c.contains("glyph 36")));
        assert!(lesson.sizes[0].bitmap.placement.area() > 0);
    }

    #[test]
    fn a_glyph_that_the_font_does_not_have_is_missing() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSans-Regular.ttf");
        let data = std::fs::read(path).unwrap();
        let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
        assert_eq!(lesson(&teacher, &[], u16::MAX).err(), Some(Error::MissingGlyph(u16::MAX)));
    }
}
