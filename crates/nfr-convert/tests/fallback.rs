//! A glyph without a model, drawn from its unhinted outline, against zeno.

use nfr::{DrawOptions, Font, MissingModel, Rasterizer};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::teacher::Teacher;
use read_fonts::FontRef;

use crate::samples::{FONTS, converted, font, gid};

/// The mean absolute difference of a pixel's coverage over all bitmaps of a font. zeno cuts curves into fewer pieces:
/// single pixels of thin curves are off by some 16 levels, as they are between zeno and FreeType (tests/teacher.rs).
/// tests/outline.rs of nfr holds every pixel to exact samples.
const TOLERANCE: f64 = 0.002;

#[test]
fn a_glyph_that_has_no_model_is_drawn_as_zeno_fills_its_outline() {
    for name in FONTS {
        let original = font(name);
        let font = Font::new(converted(&original, ".", 0).font).unwrap();
        let mut rasterizer = Rasterizer::new(&font).with_missing_model(MissingModel::Outline);
        let teacher = Teacher::new(&FontRef::new(&original).unwrap(), font.target()).unwrap();
        let mut sums = Sums::default();
        let offsets = [[0.0; 2], [0.25, 0.0], [0.5, 0.5], [-0.75, 3.0], [1000.5, -0.1]];
        for (ppem, offset) in
            [0.7, 8.0, 16.5, 64.0, 300.0].into_iter().flat_map(|ppem| offsets.map(|at| (ppem, at)))
        {
            for character in ['g', 'é', '@', '8', ' '] {
                let glyph = gid(&original, character);
                assert!(!font.has_model(glyph.into()));
                let mut unhinted = teacher.unhinted(glyph, ppem).unwrap();
                unhinted.translate(offset);
                let unhinted = unhinted.rasterize().unwrap();
                let options = DrawOptions::new(ppem).with_offset(offset);
                let drawn = rasterizer.render(glyph.into(), options).unwrap();
                sums.add(&unhinted, &drawn);
            }
        }
        assert!(sums.mae() <= TOLERANCE, "{name}: {}", sums.mae());
        assert!(rasterizer.render(gid(&original, '.').into(), 16.0).is_ok());
    }
}
