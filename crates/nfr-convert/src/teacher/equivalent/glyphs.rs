//! The glyphs of `glyf` as bytes, in which components and programs can be replaced (OpenType 1.9, "glyf" and "loca").

use std::ops::Range;

use read_fonts::tables::glyf::CompositeGlyphFlags as Flags;
use read_fonts::tables::loca::Loca;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};

use crate::strip::component_size;

/// numberOfContours and the bounding box, five 16-bit numbers.
const HEADER_BYTES: usize = 10;

/// The tables with the glyphs of a font.
pub(super) struct Glyphs<'a> {
    glyf: &'a [u8],
    loca: Loca<'a>,
    pub(super) count: u16,
}

impl<'a> Glyphs<'a> {
    pub(super) fn of(font: &FontRef<'a>) -> Option<Self> {
        let glyf = font.data_for_tag(Tag::new(b"glyf"))?.as_bytes();
        let (loca, count) = (font.loca(None).ok()?, font.maxp().ok()?.num_glyphs());
        Some(Self { glyf, loca, count })
    }

    /// The bytes of a glyph, if `loca` puts them into `glyf`.
    pub(super) fn bytes(&self, gid: u16) -> Option<&'a [u8]> {
        let offset = |index: usize| self.loca.get_raw(index).and_then(|offset| usize::try_from(offset).ok());
        let index = usize::from(gid);
        self.glyf.get(offset(index)?..offset(index + 1)?)
    }

    /// A glyph; `None` without an outline, or for a damaged one.
    pub(super) fn get(&self, gid: u16) -> Option<GlyphBytes<'a>> {
        (gid < self.count).then(|| GlyphBytes::read(self.bytes(gid)?)).flatten()
    }
}

/// A glyph, and where in its bytes is what can be replaced.
pub(super) struct GlyphBytes<'a> {
    data: &'a [u8],
    /// The components, if it is a composite, with the places of their ids.
    pub(super) components: Vec<(usize, u16)>,
    /// The program, behind two bytes with its length.
    program: Range<usize>,
}

impl<'a> GlyphBytes<'a> {
    fn read(data: &'a [u8]) -> Option<Self> {
        let contours = word(data, 0)? as i16;
        match usize::try_from(contours) {
            Ok(contours) => {
                let program = program_at(data, HEADER_BYTES + 2 * contours)?;
                Some(Self { data, components: Vec::new(), program })
            }
            Err(_) => Self::read_composite(data),
        }
    }

    fn read_composite(data: &'a [u8]) -> Option<Self> {
        let (mut at, mut components, mut has_program) = (HEADER_BYTES, Vec::new(), false);
        loop {
            let flags = Flags::from_bits_truncate(word(data, at)?);
            if flags.contains(Flags::GID_IS_24_BIT) {
                return None;
            }
            components.push((at + 2, word(data, at + 2)?));
            at += 2 + component_size(flags);
            has_program |= flags.contains(Flags::WE_HAVE_INSTRUCTIONS);
            if !flags.contains(Flags::MORE_COMPONENTS) {
                break;
            }
        }
        let program = if has_program { program_at(data, at)? } else { data.len()..data.len() };
        Some(Self { data, components, program })
    }

    pub(super) fn is_composite(&self) -> bool {
        !self.components.is_empty()
    }

    pub(super) fn program(&self) -> &'a [u8] {
        &self.data[self.program.clone()]
    }

    /// The glyph with other components, and with a program that begins with another one. `None` if it gets too long.
    pub(super) fn with(&self, components: &[u16], prefix: &[u8]) -> Option<Vec<u8>> {
        let mut data = self.data.to_vec();
        for ((at, _), gid) in self.components.iter().zip(components) {
            data[*at..*at + 2].copy_from_slice(&gid.to_be_bytes());
        }
        if !prefix.is_empty() && !self.program.is_empty() {
            let start = self.program.start;
            let length = u16::try_from(prefix.len() + self.program.len()).ok()?;
            data[start - 2..start].copy_from_slice(&length.to_be_bytes());
            data.splice(start..start, prefix.iter().copied());
        }
        Some(data)
    }
}

fn word(data: &[u8], at: usize) -> Option<u16> {
    data.get(at..)?.first_chunk().map(|bytes| u16::from_be_bytes(*bytes))
}

/// Where a program is that begins with its length. A glyph without contours can end before it.
fn program_at(data: &[u8], at: usize) -> Option<Range<usize>> {
    let Some(length) = word(data, at) else { return (at >= data.len()).then_some(data.len()..data.len()) };
    let program = at + 2..at + 2 + usize::from(length);
    (program.end <= data.len()).then_some(program)
}
