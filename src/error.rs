//! What can go wrong: a variant for each cause, with the values that tell it.

use core::fmt;

use crate::constants::{MAX_OFFSET, MAX_PPEM};
use crate::placement::Placement;

/// Why a font cannot be opened or a glyph cannot be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The bytes do not begin as an OpenType font or a collection of fonts does.
    NotAFont,
    /// The file holds `count` fonts, and none with this index (counted from 0).
    NoSuchFont {
        /// The index that was asked for.
        index: u32,
        /// The fonts in the file.
        count: u32,
    },
    /// A table that every font needs is absent.
    MissingTable {
        /// The table's tag.
        tag: [u8; 4],
    },
    /// A table of the font lies outside the file or cannot be read.
    MalformedTable {
        /// The table's tag.
        tag: [u8; 4],
    },
    /// `unitsPerEm` in the table `head` is outside 16–16384 (OpenType 1.9, "head").
    UnitsPerEm(u16),
    /// The font has no table `Nfrt`: it was not converted.
    NotConverted,
    /// The table `Nfrt` has a version that this release does not read.
    UnknownVersion {
        /// The table's major version.
        major: u16,
    },
    /// The table `Nfrt` contradicts its own format.
    MalformedModels {
        /// What is wrong.
        what: &'static str,
        /// Where, in bytes from the beginning of the table.
        offset: usize,
    },
    /// The bytes of a glyph's model contradict their own format.
    MalformedModel {
        /// The glyph.
        glyph: u32,
        /// What is wrong.
        what: &'static str,
    },
    /// A glyph's model asks for more of something than the format allows.
    ModelTooLarge {
        /// The glyph.
        glyph: u32,
        /// What there is too much of.
        what: &'static str,
        /// How much the model asks for.
        count: u64,
        /// How much the format allows.
        limit: u64,
    },
    /// The font has not as many glyphs as when its models were made: glyphs were taken out or added, so that the models' numbers stand
    /// for other glyphs.
    Renumbered {
        /// The glyphs of the font that was converted.
        models: u32,
        /// The glyphs that this font has.
        font: u32,
    },
    /// A glyph's outline or advance width is not the one that its model was made for.
    StaleModel(u32),
    /// The font has no glyph with this number.
    NoSuchGlyph(u32),
    /// The font has this glyph, but no model of it. [`MissingModel`](crate::MissingModel) chooses what is drawn then.
    MissingModel(u32),
    /// The glyph's outline cannot be read.
    MalformedOutline(u32),
    /// A field draws this glyph, and this build of the crate lacks the feature `fields`.
    FieldsNotBuilt(u32),
    /// A network draws this glyph, and this build of the crate lacks the feature `networks`.
    NetworksNotBuilt(u32),
    /// The network that draws this glyph was not trained for this size.
    NetworkSize {
        /// The glyph.
        glyph: u32,
        /// The size, in pixels per em.
        ppem: f32,
    },
    /// A network draws this glyph, and it draws at whole pixels only.
    NetworkOffset {
        /// The glyph.
        glyph: u32,
        /// The subpixel offset that was asked for.
        offset: [f32; 2],
    },
    /// A network draws this glyph, and it has no coverage of subpixels.
    NetworkSubpixels(u32),
    /// A size that is not above 0 and at most [`DrawOptions::MAX_PPEM`](crate::DrawOptions::MAX_PPEM).
    InvalidSize(f32),
    /// A subpixel offset beyond [`DrawOptions::MAX_OFFSET`](crate::DrawOptions::MAX_OFFSET), or not a number.
    InvalidOffset(f32),
    /// The caller's buffer does not hold the bitmap.
    BufferTooSmall {
        /// The bitmap that was to be drawn.
        placement: Placement,
        /// The bytes between the beginnings of two rows.
        pitch: usize,
        /// The bytes of the buffer.
        length: usize,
    },
    /// The bitmap has a side longer than [`Limits::bitmap_side`](crate::Limits::bitmap_side).
    BitmapTooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The limit, in pixels.
        limit: u32,
    },
    /// The decoded glyph takes more memory than [`Limits::decoded_bytes`](crate::Limits::decoded_bytes).
    DecodedTooLarge {
        /// The glyph.
        glyph: u32,
        /// The bytes that it takes.
        bytes: usize,
        /// The limit, in bytes.
        limit: usize,
    },
    /// Drawing the glyph takes more steps than [`Limits::work`](crate::Limits::work).
    TooMuchWork {
        /// The glyph.
        glyph: u32,
        /// The steps that it takes.
        work: u64,
        /// The limit.
        limit: u64,
    },
}

/// A tag as text; bytes that are not printable ASCII become `?`.
struct Tag([u8; 4]);

impl fmt::Display for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| match byte {
            b' '..=b'~' => write!(f, "{}", char::from(*byte)),
            _ => f.write_str("?"),
        })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotAFont => f.write_str("the bytes are no OpenType font"),
            Self::NoSuchFont { index, count } => {
                write!(f, "font index {index} in a file of {count} font{}", if count == 1 { "" } else { "s" })
            }
            Self::MissingTable { tag } => write!(f, "the font has no table '{}'", Tag(tag)),
            Self::MalformedTable { tag } => {
                write!(f, "table '{}' is truncated or cannot be read", Tag(tag))
            }
            Self::UnitsPerEm(units) => {
                write!(f, "table 'head' claims {units} units per em, 16–16384 are allowed")
            }
            Self::NotConverted => f.write_str("the font has no table 'Nfrt'"),
            Self::UnknownVersion { major } => {
                write!(f, "table 'Nfrt' has version {major}, this program reads version 2")
            }
            Self::MalformedModels { what, offset } => write!(f, "table 'Nfrt' {what} at byte {offset}"),
            Self::MalformedModel { glyph, what } => write!(f, "the model of glyph {glyph} {what}"),
            Self::ModelTooLarge { glyph, what, count, limit } => {
                write!(f, "the model of glyph {glyph} has {count} {what}, {limit} are allowed")
            }
            Self::Renumbered { models, font } => write!(
                f,
                "the models in 'Nfrt' are those of a font with {models} glyphs, and this one has {font}: glyphs were renumbered after \
                 the conversion"
            ),
            Self::StaleModel(glyph) => {
                write!(
                    f,
                    "the outline or the advance width of glyph {glyph} was changed after its model was made"
                )
            }
            Self::NoSuchGlyph(glyph) => write!(f, "the font has no glyph {glyph}"),
            Self::MissingModel(glyph) => write!(f, "glyph {glyph} has no model in this font"),
            Self::MalformedOutline(glyph) => write!(f, "the outline of glyph {glyph} cannot be read"),
            Self::FieldsNotBuilt(glyph) => write!(
                f,
                "glyph {glyph} is drawn by a field, and this program was built without nfr's feature `fields`"
            ),
            Self::NetworksNotBuilt(glyph) => write!(
                f,
                "glyph {glyph} is drawn by a network, and this program was built without nfr's feature `networks`"
            ),
            Self::NetworkSize { glyph, ppem } => {
                write!(f, "the network of glyph {glyph} was not trained for {ppem} ppem")
            }
            Self::NetworkOffset { glyph, offset: [x, y] } => write!(
                f,
                "a subpixel offset of {x}, {y} pixels for glyph {glyph}, whose network draws at whole pixels"
            ),
            Self::NetworkSubpixels(glyph) => {
                write!(f, "glyph {glyph} is drawn by a network, which has no coverage of subpixels")
            }
            Self::InvalidSize(ppem) => {
                write!(f, "{ppem} ppem is outside 0–{MAX_PPEM}")
            }
            Self::InvalidOffset(offset) => {
                write!(f, "a subpixel offset of {offset} pixels is outside -{MAX_OFFSET}–{MAX_OFFSET}")
            }
            Self::BufferTooSmall { placement: Placement { width, height, .. }, pitch, length } => write!(
                f,
                "a buffer of {length} bytes with rows {pitch} bytes apart for a bitmap of {width}×{height}"
            ),
            Self::BitmapTooLarge { width, height, limit } => {
                write!(f, "a bitmap of {width}×{height} pixels, {limit} a side are allowed")
            }
            Self::DecodedTooLarge { glyph, bytes, limit } => {
                write!(f, "glyph {glyph} takes {bytes} bytes decoded, {limit} are allowed")
            }
            Self::TooMuchWork { glyph, work, limit } => {
                write!(f, "drawing glyph {glyph} takes {work} steps, {limit} are allowed")
            }
        }
    }
}

impl core::error::Error for Error {}

/// What is wrong with the bytes of a model, where it is not known yet which glyph they belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Damage {
    /// They contradict their own format; the text goes on after "the model".
    Malformed(&'static str),
    /// They belong to another outline.
    Stale,
    /// They ask for more of something than the format allows.
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// How much they ask for.
        count: u64,
        /// How much the format allows.
        limit: u64,
    },
}

impl Damage {
    /// The error that tells which glyph is damaged.
    pub fn of(self, glyph: u32) -> Error {
        match self {
            Self::Malformed(what) => Error::MalformedModel { glyph, what },
            Self::Stale => Error::StaleModel(glyph),
            Self::TooLarge { what, count, limit } => Error::ModelTooLarge { glyph, what, count, limit },
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn a_tag_that_is_no_text_does_not_spoil_the_message() {
        let text = Error::MalformedTable { tag: *b"a\0\xffz" }.to_string();
        assert!(text.contains("'a??z'"), "{text}");
    }
}
