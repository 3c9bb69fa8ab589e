//! Metrics of a line of text.

use read_fonts::tables::os2::SelectionFlags;
use read_fonts::{FontRef, TableProvider};

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
    pub(super) fn new(font: &FontRef<'_>, ppem: f32) -> Self {
        let Ok(units_per_em) = font.head().map(|head| head.units_per_em()) else { return Self::default() };
        let scale = ppem / f32::from(units_per_em);
        let [ascent, descent, line_gap] = line(font).map(|units| units as f32 * scale);
        let [underline_position, underline_thickness] = match font.post() {
            Ok(post) => [post.underline_position(), post.underline_thickness()]
                .map(|units| f32::from(units.to_i16()) * scale),
            Err(_) => UNDERLINE.map(|em| em * ppem),
        };
        Self { ascent, descent, line_gap, underline_position, underline_thickness }
    }
}

/// Ascent, descent and line gap in font units.
fn line(font: &FontRef<'_>) -> [i32; 3] {
    let hhea = font.hhea().ok().map(|hhea| {
        [hhea.ascender(), hhea.descender(), hhea.line_gap()].map(|units| i32::from(units.to_i16()))
    });
    let os2 = font.os2().ok();
    let typo = os2
        .as_ref()
        .map(|os2| [os2.s_typo_ascender(), os2.s_typo_descender(), os2.s_typo_line_gap()].map(i32::from));
    let has_height = |line: &[i32; 3]| line[0] != 0 || line[1] != 0;
    let wants_typo =
        os2.as_ref().is_some_and(|os2| os2.fs_selection().contains(SelectionFlags::USE_TYPO_METRICS));
    let asked_for = typo.filter(|_| wants_typo);
    let clipping = os2.map(|os2| [i32::from(os2.us_win_ascent()), -i32::from(os2.us_win_descent()), 0]);
    let named = asked_for.or(hhea.filter(has_height)).or(typo.filter(has_height));
    named.or(clipping).or(hhea).unwrap_or_default()
}
