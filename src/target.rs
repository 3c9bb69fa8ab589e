//! What fonts are hinted for.

use core::fmt;

/// What the teacher hinted for, which the model therefore reproduces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[non_exhaustive]
pub enum Target {
    /// Hinting in y for grey antialiasing (FreeType's `FT_LOAD_TARGET_NORMAL`).
    #[default]
    Smooth,
    /// Hinting in x and y (`FT_LOAD_TARGET_MONO`), drawn in black and white by
    /// [`Rasterizer::draw_mono`](crate::Rasterizer::draw_mono), or with grey coverage.
    Mono,
    /// Hinting for horizontal subpixels, drawn with grey coverage (`FT_LOAD_TARGET_LCD`).
    Lcd,
}

impl Target {
    /// The name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Mono => "mono",
            Self::Lcd => "lcd",
        }
    }

    /// The target of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Smooth, Self::Mono, Self::Lcd].into_iter().find(|target| target.name() == name)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
