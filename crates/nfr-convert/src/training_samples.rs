//! Training samples: a glyph's hinted outline and bitmap at each size.

use crate::error::Error;
use crate::teacher::{Outline, Teacher, TeacherAt};
use nfr::Bitmap;
use nfr::internals::table::Dropout;

/// The training samples of one glyph.
#[derive(Debug, Clone)]
pub struct GlyphSamples {
    /// The glyph.
    pub gid: u16,
    /// The unhinted outline in em.
    pub outline: Outline,
    /// The first error of the glyph's hint program, if it fails at any size.
    pub hint_error: Option<String>,
    /// Whether hinting changes the contours at any size ([`Outline::has_contours_of`]).
    pub contours_change: bool,
    /// One sample for each size, ascending.
    pub sizes: Vec<TrainingSample>,
}

/// One glyph at one size.
#[derive(Debug, Clone)]
pub struct TrainingSample {
    /// Pixels per em.
    pub ppem: u16,
    /// The hinted outline's coordinates in pixels, in the order of those of the unhinted outline. Where hinting changes the
    /// contours, they are the unhinted ones.
    pub points: Vec<[f32; 2]>,
    /// The hinted advance width in whole pixels; none where it is not known.
    pub advance: Option<i32>,
    /// What the hints ask of a renderer in black and white.
    pub dropout: Dropout,
    /// The exact coverage of the hinted outline.
    pub bitmap: Bitmap,
    /// Whether hinting was predicted from other sizes, not drawn by the teacher.
    pub predicted: bool,
}

impl GlyphSamples {
    /// The unhinted glyph at sizes larger than the hinted ones, where the model has to follow the outline.
    pub(super) fn larger_sizes(&self) -> Result<Vec<TrainingSample>, Error> {
        let last = self.sizes.last().map_or(0, |size| size.ppem);
        let unhinted = |ppem: u16| {
            let points: Vec<_> = self.outline.points.iter().map(|p| p.map(|v| v * f32::from(ppem))).collect();
            let bitmap = self.outline.with_points(&points)?.rasterize()?;
            Ok(TrainingSample {
                ppem,
                points,
                advance: None,
                dropout: Dropout::default(),
                bitmap,
                predicted: false,
            })
        };
        [last + last.div_ceil(2), last * 2].map(unhinted).into_iter().collect()
    }

    /// Draws the samples of one glyph.
    ///
    /// # Errors
    ///
    /// As the teacher's and [`Outline::rasterize`]; `Unsupported` if a composite puts a point outside the range of 16 bits.
    pub fn draw(teacher: &Teacher, sizes: &[TeacherAt], gid: u16) -> Result<Self, Error> {
        let outline = teacher.unhinted_em(gid)?;
        let units = f32::from(teacher.units_per_em());
        let outside = |v: &f32| !(f32::from(i16::MIN)..=f32::from(i16::MAX)).contains(&(v * units));
        if let Some(v) = outline.points.iter().flatten().find(|v| outside(v)) {
            return Err(Error::Unsupported(format!(
                "glyph {gid} has a point {} font units from its origin, which does not fit 16 bits; leave the glyph out",
                v * units
            )));
        }
        let (mut hint_error, mut contours_change) = (None, false);
        let sizes = sizes
            .iter()
            .map(|at| {
                let (hinted, error) = at.hinted_with_error(gid)?;
                hint_error = hint_error.take().or(error);
                let bitmap = hinted.rasterize()?;
                let advance = hinted.advance.map(|pixels| pixels.round() as i32);
                let dropout = hinted.dropout;
                let points = if hinted.has_contours_of(&outline) {
                    hinted.points
                } else {
                    contours_change = true;
                    outline.points.iter().map(|p| p.map(|v| v * f32::from(at.ppem()))).collect()
                };
                Ok(TrainingSample { ppem: at.ppem(), points, advance, dropout, bitmap, predicted: false })
            })
            .collect::<Result<_, Error>>()?;
        Ok(Self { gid, outline, hint_error, contours_change, sizes })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use read_fonts::types::Tag;
    use read_fonts::{FontRef, TableProvider};
    use write_fonts::FontBuilder;

    use super::*;
    use crate::fixtures::{SIZES, glyph_samples};
    use nfr::Target;

    #[test]
    fn there_is_a_sample_for_every_size_with_a_point_for_each_point_of_the_outline() {
        let (glyphs, _) = glyph_samples("g% ", Target::Smooth);
        for samples in &glyphs {
            assert!(samples.sizes.iter().map(|s| s.ppem).eq(SIZES));
            assert!(samples.sizes.iter().all(|s| s.points.len() == samples.outline.points.len()));
            assert_eq!(samples.hint_error, None);
        }
        assert!(glyphs[0].sizes.iter().all(|s| s.bitmap.placement.area() > 0));
        assert!(glyphs[2].outline.points.is_empty() && glyphs[2].sizes[0].bitmap == Bitmap::default());
    }

    #[test]
    fn smooth_hinting_moves_points_up_and_down_only() {
        let (glyphs, _) = glyph_samples("gR", Target::Smooth);
        for (samples, size) in glyphs.iter().flat_map(|l| l.sizes.iter().map(move |s| (l, s))) {
            let unhinted = samples.outline.points.iter().map(|p| p.map(|v| v * f32::from(size.ppem)));
            // Scaled points are rounded to 1/64 pixel, and implied ones lie between two of them.
            let moved = unhinted.zip(&size.points).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f32::max);
            assert!(moved <= 1.0 / 32.0, "{moved} pixels at {} ppem", size.ppem);
        }
    }

    #[test]
    fn a_glyph_whose_program_fails_is_drawn_as_far_as_it_got_with_the_error() {
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
        let samples = GlyphSamples::draw(&teacher, &sizes, 36).unwrap();
        assert!(samples.hint_error.is_some_and(|c| c.contains("glyph 36")));
        assert!(samples.sizes[0].bitmap.placement.area() > 0);
    }

    #[test]
    fn a_composite_with_points_outside_of_16_bits_is_refused() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSans-Regular.ttf");
        let data = std::fs::read(path).unwrap();
        let original = FontRef::new(&data).unwrap();
        let mut glyf = original.table_data(Tag::new(b"glyf")).unwrap().as_bytes().to_vec();
        let at = original.loca(None).unwrap().get_raw(37).unwrap() as usize;
        // OpenType 1.9, "glyf": glyph 36 at x = 32767; its arguments are words and offsets.
        let composite = [0xFF, 0xFF, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 36, 0x7F, 0xFF, 0, 0];
        glyf[at..at + composite.len()].copy_from_slice(&composite);
        let mut builder = FontBuilder::new();
        builder.add_raw(Tag::new(b"glyf"), glyf).copy_missing_tables(original);
        let altered = builder.build();
        let teacher = Teacher::new(&FontRef::new(&altered).unwrap(), Target::Smooth).unwrap();
        let error = GlyphSamples::draw(&teacher, &[], 37).err().unwrap();
        assert!(matches!(&error, Error::Unsupported(text) if text.contains("16 bits")), "{error}");
    }

    #[test]
    fn a_glyph_that_the_font_does_not_have_is_refused() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSans-Regular.ttf");
        let data = std::fs::read(path).unwrap();
        let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
        assert_eq!(
            GlyphSamples::draw(&teacher, &[], u16::MAX).err(),
            Some(Error::NoSuchGlyph(u16::MAX.into()))
        );
    }
}
