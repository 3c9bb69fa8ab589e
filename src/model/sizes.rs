//! The sizes that a font's models are trained for.

use crate::constants::MAX_TRAINED_PPEM;

/// Where the outlines and the hints of a font's models come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Origin {
    /// TrueType outlines.
    #[default]
    TrueType,
    /// Cubic curves that are quadratic ones now, with hints for quadratic ones, such as an autohinter's. At hinted sizes curves become shorter
    /// lines.
    Cubic,
    /// The same with the hints of PostScript outlines: points follow the tracks of the levels beside theirs, and hinted coordinates are
    /// rounded down.
    PostScript,
}

/// Units and trained sizes, which are the same for all glyphs of a font. Every whole size from the first to the last is
/// a trained one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scale {
    units_per_em: u16,
    first_ppem: u16,
    last_ppem: u16,
    whole_sizes: bool,
    origin: Origin,
}

impl Scale {
    /// Font units in an em, 16 to 16384, and the smallest and the largest trained size in pixels per em, 1 to
    /// [`MAX_TRAINED_PPEM`]. `None` for anything else.
    pub const fn new(units_per_em: u16, first_ppem: u16, last_ppem: u16) -> Option<Self> {
        let units_fit = units_per_em >= 16 && units_per_em <= 16384;
        let sizes_fit = first_ppem >= 1 && first_ppem <= last_ppem && last_ppem <= MAX_TRAINED_PPEM;
        if units_fit && sizes_fit {
            Some(Self { units_per_em, first_ppem, last_ppem, whole_sizes: false, origin: Origin::TrueType })
        } else {
            None
        }
    }

    /// The same with hinted sizes that are whole along x too, if the font wants that: bit 3 of `head.flags`, "force ppem to
    /// integer values" (OpenType 1.9, `head`).
    #[must_use]
    pub const fn with_whole_sizes(self, whole_sizes: bool) -> Self {
        Self { whole_sizes, ..self }
    }

    /// The same for outlines and hints of another origin.
    #[must_use]
    pub const fn with_origin(self, origin: Origin) -> Self {
        Self { origin, ..self }
    }

    /// Where the outlines and the hints come from.
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// Whether the hints were those of PostScript outlines.
    pub fn is_postscript(&self) -> bool {
        self.origin == Origin::PostScript
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> u16 {
        self.units_per_em
    }

    /// The smallest trained size in pixels per em.
    pub fn first_ppem(&self) -> u16 {
        self.first_ppem
    }

    /// The largest trained size in pixels per em.
    pub fn last_ppem(&self) -> u16 {
        self.last_ppem
    }

    /// The number of trained sizes.
    pub fn sizes(&self) -> usize {
        usize::from(self.last_ppem - self.first_ppem) + 1
    }

    /// A trained size in pixels per em, by its index.
    pub fn ppem_of(&self, size: usize) -> usize {
        usize::from(self.first_ppem) + size
    }

    /// How a size is hinted: as the nearest whole one, halves upwards, whose pixel positions are taken over, so that
    /// edges are as crisp. What is not hinted, as x for smooth targets, has the size itself, unless the font wants whole
    /// sizes. Nothing is hinted at a size that rounds to none of the trained ones.
    pub fn at(&self, ppem: f32) -> HintedSize {
        let whole = (ppem + 0.5) as usize;
        if (usize::from(self.first_ppem)..=usize::from(self.last_ppem)).contains(&whole) {
            let index = whole - usize::from(self.first_ppem);
            let trained_ppem = whole as f32;
            let ppem = if self.whole_sizes { trained_ppem } else { ppem };
            HintedSize { ppem, index, trained_ppem, strength: 1.0 }
        } else {
            HintedSize::plain(ppem)
        }
    }
}

/// A size, and the trained size whose grid-fitting it takes.
#[derive(Debug, Clone, Copy)]
pub struct HintedSize {
    /// The size of what is not hinted, in pixels per em.
    pub ppem: f32,
    /// The index of the trained size whose displacements are used.
    pub index: usize,
    /// That trained size in pixels per em; `ppem` where nothing is hinted.
    pub trained_ppem: f32,
    /// The factor of displacements: 1, or 0 where nothing is hinted.
    pub strength: f32,
}

impl HintedSize {
    /// A size at which nothing is hinted.
    pub fn plain(ppem: f32) -> Self {
        Self { ppem, index: 0, trained_ppem: ppem, strength: 0.0 }
    }
}
