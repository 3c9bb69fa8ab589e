//! Metrics of a line of text.

use read_fonts::model::Font;

/// Metrics of a line of horizontal text in pixels, y up. They are linear in the size.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct LineMetrics {
    /// From the baseline up to the top of the line.
    pub ascent: f32,
    /// From the baseline up to the bottom of the line, which is below: a negative number in most fonts.
    pub descent: f32,
    /// What is left free between two lines. Baselines are `ascent - descent + line_gap` apart.
    pub line_gap: f32,
    /// From the baseline up to the top of the underline: a negative number in most fonts.
    pub underline_position: f32,
    /// The underline's thickness.
    pub underline_thickness: f32,
}

/// The underline where the font names none, in em: that of PostScript's fonts.
const UNDERLINE: [f32; 2] = [-0.1, 0.05];

impl LineMetrics {
    /// The metrics at a size. A line is that of `OS/2` if the font asks for it, else that of `hhea`, else that of `OS/2`
    /// (OpenType 1.9, "OS/2", fsSelection bit 7); the underline is that of `post`.
    pub(super) fn new(font: &Font, ppem: f32) -> Self {
        let scale = ppem / f32::from(font.units_per_em());
        let line = font.metrics().h_line().unwrap_or_default();
        let [underline_position, underline_thickness] = match font.style_metrics().underline {
            Some(underline) => [underline.position, underline.thickness].map(|units| units.to_f32() * scale),
            None => UNDERLINE.map(|em| em * ppem),
        };
        let pixels = [line.ascender, line.descender, line.line_gap].map(|units| units.to_f32() * scale);
        let [ascent, descent, line_gap] = pixels;
        Self { ascent, descent, line_gap, underline_position, underline_thickness }
    }
}
