//! Values that cross the border.

use nfr::{LineMetrics, Placement, Target};

/// What a font's models were made for.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum nfr_target {
    /// None that this release knows, or no font.
    NFR_TARGET_UNKNOWN = 0,
    /// Hinting in y, for grey antialiasing (FT_LOAD_TARGET_NORMAL).
    NFR_TARGET_SMOOTH = 1,
    /// Hinting in x and y, drawn with grey coverage (FT_LOAD_TARGET_MONO).
    NFR_TARGET_MONO = 2,
    /// Hinting for horizontal subpixels, drawn with grey coverage (FT_LOAD_TARGET_LCD).
    NFR_TARGET_LCD = 3,
}

impl From<Target> for nfr_target {
    fn from(target: Target) -> Self {
        match target {
            Target::Smooth => Self::NFR_TARGET_SMOOTH,
            Target::Mono => Self::NFR_TARGET_MONO,
            Target::Lcd => Self::NFR_TARGET_LCD,
            _ => Self::NFR_TARGET_UNKNOWN,
        }
    }
}

/// What is drawn for a glyph that the font has, but no model of. A damaged model is an error in any case.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum nfr_missing_model {
    /// Nothing, and the call returns NFR_MISSING_MODEL, so that the application draws the glyph by other means.
    NFR_MISSING_MODEL_ERROR = 0,
    /// An empty bitmap.
    NFR_MISSING_MODEL_BLANK = 1,
    /// The glyph's plain outline, without hinting.
    NFR_MISSING_MODEL_OUTLINE = 2,
}

/// Where a bitmap lies relative to the glyph's origin, in pixels.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct nfr_placement {
    /// From the origin to the left edge of the left column (FreeType's bitmap_left).
    pub left: i32,
    /// From the baseline up to the top edge of the top row (FreeType's bitmap_top).
    pub top: i32,
    /// Columns; 0 for a glyph without ink.
    pub width: u32,
    /// Rows; 0 for a glyph without ink.
    pub height: u32,
}

impl From<Placement> for nfr_placement {
    fn from(Placement { left, top, width, height }: Placement) -> Self {
        Self { left, top, width, height }
    }
}

/// Metrics of a line of horizontal text in pixels, y up, linear in the size.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct nfr_line_metrics {
    /// From the baseline up to the top of the line.
    pub ascent: f32,
    /// From the baseline up to the bottom of the line, which is below: negative in most fonts.
    pub descent: f32,
    /// What is left free between two lines. Baselines are ascent - descent + line_gap apart.
    pub line_gap: f32,
    /// From the baseline up to the top of the underline: negative in most fonts.
    pub underline_position: f32,
    /// The underline's thickness.
    pub underline_thickness: f32,
}

impl From<LineMetrics> for nfr_line_metrics {
    fn from(line: LineMetrics) -> Self {
        Self {
            ascent: line.ascent,
            descent: line.descent,
            line_gap: line.line_gap,
            underline_position: line.underline_position,
            underline_thickness: line.underline_thickness,
        }
    }
}

/// What drawing a glyph may take, whatever the font file asks for. Begin with nfr_limits_default.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct nfr_limits {
    /// The longest side of a bitmap in pixels: 8192, which is also the most.
    pub bitmap_side: u32,
    /// The memory that a decoded glyph may take, in bytes: 8 MiB. While a model is decoded, up to 1 MiB more is taken for
    /// a moment.
    pub decoded_bytes: usize,
    /// The steps that drawing a glyph may take: 2^28, some tenths of a second. Text takes some thousands a glyph.
    pub work: u64,
}
