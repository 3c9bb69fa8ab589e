//! Neural font rendering: hinted bitmaps from small implicit models, with no bytecode interpreter.
//!
//! A converted font carries a model for each glyph in a table `Nfrt`. [`Font`] opens it, [`Rasterizer`] draws it.
//!
//! ```
//! # static BYTES: &[u8] = include_bytes!("../spec/vectors/sans.ttf");
//! let font = nfr::Font::new(BYTES)?;
//! let mut rasterizer = nfr::Rasterizer::new(&font);
//! let glyph = font.glyph_for_char('a').unwrap_or(0);
//! for row in rasterizer.draw(glyph, 11.0)?.rows() {
//!     println!("{}", row.iter().map(|level| [' ', '.', 'o', '#'][usize::from(*level) / 64]).collect::<String>());
//! }
//! # Ok::<(), nfr::Error>(())
//! ```

#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

extern crate alloc;
#[cfg(all(feature = "std", not(test)))]
extern crate std;

mod bitmap;
mod constants;
mod error;
mod lcd;
mod limits;
mod model;
mod mono;
mod network;
mod number;
mod options;
mod placement;
mod render;
mod table;
mod target;

pub use bitmap::{Bitmap, BitmapRef};
pub use error::Error;
pub use lcd::{Lcd, LcdBitmap, LcdBitmapRef, LcdFilter, SubpixelOrder};
pub use limits::{Limits, MissingModel};
pub use mono::{MonoBitmap, MonoBitmapRef};
pub use options::DrawOptions;
pub use placement::Placement;
pub use render::{Font, LineMetrics, Rasterizer};
pub use target::Target;

/// What the converter shares with the renderer. No promises: anything in here may change in any release.
#[doc(hidden)]
pub mod internals {
    pub use crate::error::Damage;
    pub use crate::number::mul_fixed;
    pub use crate::placement::union;
    pub use crate::render::{
        Decoder, Font, Glyph, HintedOutline, Scratch, components, head_units, open, recode_outlines,
    };

    use crate::Error;
    use model::gridfit::Scale;
    use table::{Header, Table};

    /// The models.
    pub mod model {
        pub use crate::model::{compose, contour, grid, hinting, outline, sizes};

        /// The grid-fit model.
        pub mod gridfit {
            pub use crate::constants::{MAX_PPEM, MAX_SIDE, MAX_TRAINED_PPEM};
            pub use crate::model::grid::*;
            pub use crate::model::gridfit::*;
            pub use crate::model::sizes::*;
        }
    }

    /// The paper's network.
    pub mod network {
        pub use crate::network::*;
    }

    /// The table.
    pub mod table {
        pub use crate::table::*;
        pub use read_fonts::types::BigEndian;
    }

    /// What the conversion was asked for.
    pub fn header(font: &Font) -> &Header {
        font.header()
    }

    /// The `Nfrt` table.
    ///
    /// # Errors
    ///
    /// If the bytes are not those any more that the font was opened with.
    pub fn table(font: &Font) -> Result<Table<'_>, Error> {
        font.table()
    }

    /// Units and sizes of all models.
    pub fn scale(font: &Font) -> Scale {
        font.scale()
    }

    /// Decodes a glyph with the default limits.
    ///
    /// # Errors
    ///
    /// As [`Decoder::glyph`].
    pub fn decode(font: &Font, glyph: u32) -> Result<Glyph, Error> {
        font.decode(glyph)
    }
}

/// Runs the examples of README as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
