//! What the hints ask of a renderer that draws in black and white: FreeType's drop-out control, which fills gaps in thin strokes
//! (TrueType's `SCANCTRL` and `SCANTYPE`).

use alloc::vec::Vec;

use read_fonts::FontData;

use crate::error::Error;

/// A mode of drop-out control, as bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Dropout(u8);

impl Dropout {
    const ENABLED: u8 = 1;
    const SMART: u8 = 2;
    const STUBS: u8 = 4;

    /// A mode. `smart` centres the pixel that fills a gap, and `stubs` fills gaps at the ends of strokes, too.
    pub fn new(smart: bool, stubs: bool) -> Self {
        Self(Self::ENABLED | if smart { Self::SMART } else { 0 } | if stubs { Self::STUBS } else { 0 })
    }

    /// Whether gaps are filled.
    pub fn is_enabled(self) -> bool {
        self.0 & Self::ENABLED != 0
    }

    /// Whether the pixel that fills a gap is the one at its centre.
    pub fn is_smart(self) -> bool {
        self.0 & Self::SMART != 0
    }

    /// Whether gaps at the ends of strokes are filled.
    pub fn fills_stubs(self) -> bool {
        self.0 & Self::STUBS != 0
    }
}

/// The mode of each size, and of the glyphs that ask for another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DropoutModes<'a> {
    ranges: &'a [[u8; 3]],
    exceptions: &'a [[u8; 7]],
}

/// A glyph that asks for another mode than most glyphs do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DropoutException {
    /// The glyph.
    pub gid: u16,
    /// The first size in pixels per em.
    pub first_ppem: u16,
    /// The last one.
    pub last_ppem: u16,
    /// The mode.
    pub mode: Dropout,
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_be_bytes([bytes[at], bytes[at + 1]])
}

impl<'a> DropoutModes<'a> {
    /// Reads the modes that begin at `at`.
    pub(super) fn parse(data: FontData<'a>, at: usize) -> Result<Self, Error> {
        let ends = || Error::MalformedModels { what: "ends before its drop-out modes do", offset: at };
        let list = |at: usize, width: usize| {
            let count = data.read_at::<u16>(at).map_err(|_| ends())?;
            let bytes = data.as_bytes().get(at + 2..).and_then(|rest| rest.get(..usize::from(count) * width));
            bytes.ok_or_else(ends)
        };
        let ranges = list(at, 3)?;
        let exceptions = list(at + 2 + ranges.len(), 7)?;
        Ok(Self { ranges: ranges.as_chunks().0, exceptions: exceptions.as_chunks().0 })
    }

    /// The last size of each range, in pixels per em, and the mode of most glyphs there. The first range begins at the first size of
    /// the models.
    pub fn ranges(&self) -> impl Iterator<Item = (u16, Dropout)> + 'a {
        self.ranges.iter().map(|range| (u16_at(range, 0), Dropout(range[2])))
    }

    /// The glyphs that have another mode at some sizes.
    pub fn exceptions(&self) -> impl Iterator<Item = DropoutException> + 'a {
        self.exceptions.iter().map(|bytes| DropoutException {
            gid: u16_at(bytes, 0),
            first_ppem: u16_at(bytes, 2),
            last_ppem: u16_at(bytes, 4),
            mode: Dropout(bytes[6]),
        })
    }

    /// The mode of a glyph at a size; none outside of the sizes of the models.
    pub fn mode(&self, gid: u32, ppem: u16) -> Option<Dropout> {
        let is_there = |exception: &DropoutException| {
            u32::from(exception.gid) == gid && (exception.first_ppem..=exception.last_ppem).contains(&ppem)
        };
        let of_glyph = self.exceptions().find(is_there).map(|exception| exception.mode);
        of_glyph.or_else(|| self.ranges().find(|(last, _)| ppem <= *last).map(|(_, mode)| mode))
    }

    /// Appends modes to a table.
    pub fn write(ranges: &[(u16, Dropout)], exceptions: &[DropoutException], table: &mut Vec<u8>) {
        table.extend((ranges.len() as u16).to_be_bytes());
        for (last, mode) in ranges {
            table.extend(last.to_be_bytes());
            table.push(mode.0);
        }
        table.extend((exceptions.len() as u16).to_be_bytes());
        for exception in exceptions {
            let DropoutException { gid, first_ppem, last_ppem, mode } = exception;
            table.extend([gid, first_ppem, last_ppem].into_iter().flat_map(|number| number.to_be_bytes()));
            table.push(mode.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_read_as_they_were_written_and_no_shorter() {
        let [simple, smart] = [Dropout::new(false, false), Dropout::new(true, true)];
        let ranges = [(12, Dropout::default()), (20, simple), (64, smart)];
        let exceptions = [(7, 10, 11, smart), (7, 12, 12, simple), (300, 64, 64, Dropout::default())]
            .map(|(gid, first_ppem, last_ppem, mode)| DropoutException { gid, first_ppem, last_ppem, mode });
        let mut table = alloc::vec![1; 3];
        DropoutModes::write(&ranges, &exceptions, &mut table);
        let modes = DropoutModes::parse(FontData::new(&table), 3).expect("modes");
        assert!(modes.ranges().eq(ranges) && modes.exceptions().eq(exceptions));
        let expected = [
            (7, 9, Dropout::default()),
            (7, 11, smart),
            (7, 12, simple),
            (8, 12, Dropout::default()),
            (8, 64, smart),
        ];
        for (gid, ppem, mode) in expected {
            assert_eq!(modes.mode(gid, ppem), Some(mode), "glyph {gid} at {ppem} ppem");
        }
        assert_eq!(modes.mode(300, 64), Some(Dropout::default()));
        assert_eq!(modes.mode(8, 65), None);
        assert!(smart.is_enabled() && smart.is_smart() && smart.fills_stubs());
        assert!(!Dropout::default().is_enabled() && !simple.is_smart() && !simple.fills_stubs());
        for length in 3..table.len() {
            assert!(DropoutModes::parse(FontData::new(&table[..length]), 3).is_err(), "{length} bytes");
        }
    }
}
