//! The models as integers: what each stores, and how it evaluates.

pub mod compose;
pub mod contour;
pub mod gridfit;
pub mod network;

use std::fmt;
use std::str::FromStr;

/// What the teacher hinted for, which the model therefore reproduces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Target {
    /// Hinting in y for grey antialiasing (FreeType's `FT_LOAD_TARGET_NORMAL`).
    #[default]
    Smooth,
    /// Hinting in x and y, drawn with grey coverage (`FT_LOAD_TARGET_MONO`).
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
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Target {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        [Self::Smooth, Self::Mono, Self::Lcd]
            .into_iter()
            .find(|target| target.name() == name)
            .ok_or_else(|| format!("unknown target {name:?}; use smooth, mono or lcd"))
    }
}
