//! Drawing many glyphs: decoded models are kept in a cache whose size the caller sets.

use super::draw::Scratch;
#[cfg(feature = "fallback")]
use super::glyph::buffer_for;
use super::{Bitmap, Font, Glyph, Placement, Setting};
use crate::error::Error;
use crate::table::PartsDecoder;

/// Decoded models take up to this many bytes unless the caller says otherwise: about 700 glyphs.
const DEFAULT_CACHE: usize = 8 << 20;

/// Draws a font's glyphs. A glyph that a network draws is there at the network's sizes only. With the feature
/// `fallback`, a glyph that has no model is drawn from its unhinted outline; without it, such a glyph is
/// [`Error::MissingGlyph`].
pub struct Rasterizer<'a> {
    font: Font<'a>,
    parts: PartsDecoder,
    cache: Cache,
    scratch: Scratch,
}

impl<'a> Rasterizer<'a> {
    /// A rasterizer with a cache of 8 MiB.
    pub fn new(font: &Font<'a>) -> Self {
        Self::with_cache(font, DEFAULT_CACHE)
    }

    /// A rasterizer that keeps decoded models of at most `bytes` bytes, and always at least the last one.
    pub fn with_cache(font: &Font<'a>, bytes: usize) -> Self {
        let cache = Cache { limit: bytes, ..Cache::default() };
        Self { parts: PartsDecoder::default(), font: font.clone(), cache, scratch: Scratch::default() }
    }

    /// The font that is drawn.
    pub fn font(&self) -> &Font<'a> {
        &self.font
    }

    /// Where a glyph's bitmap lies at a size in pixels per em, or at a [`Setting`].
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph without a model (with `fallback`: for one that the font does not have),
    /// `Malformed` for a damaged one, `InvalidParameter` for a size that is not a positive number or a pen too far
    /// off, `LimitExceeded` for a bitmap that would be too large, `Unsupported` for a size that the glyph's network
    /// was not trained for, or a network with the pen between pixels.
    pub fn placement(&mut self, gid: u16, setting: impl Into<Setting>) -> Result<Placement, Error> {
        let setting = setting.into();
        #[cfg(feature = "fallback")]
        if !self.font.has_model(gid) {
            return self.outline(gid, setting).map(|bitmap| bitmap.placement);
        }
        self.cache.get(&self.font, &mut self.parts, gid)?.placement(setting)
    }

    /// Draws a glyph's coverage, 0–255, into `pixels`: top row first, `placement.width` bytes a row. Bytes
    /// beyond the bitmap are left alone. A glyph that is in the cache is drawn without allocating, unless it is a
    /// network: the largest that a table can hold takes 70 MB and a dozen seconds for a bitmap of 128 pixels.
    ///
    /// # Errors
    ///
    /// As `placement`, and `InvalidParameter` for a buffer that is too small.
    pub fn render_into(
        &mut self,
        gid: u16,
        setting: impl Into<Setting>,
        pixels: &mut [u8],
    ) -> Result<Placement, Error> {
        let setting = setting.into();
        #[cfg(feature = "fallback")]
        if !self.font.has_model(gid) {
            let bitmap = self.outline(gid, setting)?;
            buffer_for(bitmap.placement, pixels)?.copy_from_slice(&bitmap.pixels);
            return Ok(bitmap.placement);
        }
        let glyph = self.cache.get(&self.font, &mut self.parts, gid)?;
        glyph.render_into(setting, &mut self.scratch, pixels)
    }

    /// Draws a glyph into a new bitmap.
    ///
    /// # Errors
    ///
    /// As `placement`.
    pub fn render(&mut self, gid: u16, setting: impl Into<Setting>) -> Result<Bitmap, Error> {
        let setting = setting.into();
        let placement = self.placement(gid, setting)?;
        let mut pixels = vec![0; placement.area()];
        self.render_into(gid, setting, &mut pixels)?;
        Ok(Bitmap { placement, pixels })
    }

    #[cfg(feature = "fallback")]
    fn outline(&self, gid: u16, setting: Setting) -> Result<Bitmap, Error> {
        use skrifa::instance::{LocationRef, Size};
        use skrifa::outline::DrawSettings;
        let Setting { ppem, pen } = setting.checked()?;
        let outlines = self.font.outlines();
        let glyph = outlines.get(skrifa::GlyphId::from(gid)).ok_or(Error::MissingGlyph(gid))?;
        let mut outline = super::outline::Outline::default();
        glyph
            .draw(DrawSettings::unhinted(Size::new(ppem), LocationRef::default()), &mut outline)
            .map_err(|e| Error::Malformed(format!("the outline of glyph {gid} cannot be drawn ({e})")))?;
        outline.translate(pen);
        Ok(outline.rasterize())
    }
}

/// Decoded models, the least recently used of which make room.
#[derive(Default)]
struct Cache {
    limit: usize,
    bytes: usize,
    clock: u64,
    /// For each glyph of the font, where it is in `entries`, counted from 1; 0 for one that is not there.
    places: Vec<u32>,
    entries: Vec<Entry>,
}

struct Entry {
    gid: u16,
    /// When it was last asked for.
    used: u64,
    glyph: Glyph,
}

impl Cache {
    fn get(&mut self, font: &Font<'_>, parts: &mut PartsDecoder, gid: u16) -> Result<&Glyph, Error> {
        self.clock += 1;
        let at = match self.find(gid) {
            Some(at) => at,
            None => self.load(font, parts, gid)?,
        };
        let entry = self.entries.get_mut(at).ok_or(Error::MissingGlyph(gid))?;
        entry.used = self.clock;
        Ok(&entry.glyph)
    }

    fn find(&self, gid: u16) -> Option<usize> {
        (*self.places.get(usize::from(gid))? as usize).checked_sub(1)
    }

    fn load(&mut self, font: &Font<'_>, parts: &mut PartsDecoder, gid: u16) -> Result<usize, Error> {
        let known = |gid| self.entries[self.find(gid)?].glyph.model();
        let glyph = font.glyph_with(parts, gid, known)?;
        let bytes = glyph.memory();
        while self.bytes + bytes > self.limit && !self.entries.is_empty() {
            self.evict();
        }
        self.bytes += bytes;
        self.entries.push(Entry { gid, used: self.clock, glyph });
        if self.places.len() <= usize::from(gid) {
            self.places.resize(usize::from(gid) + 1, 0);
        }
        self.places[usize::from(gid)] = self.entries.len() as u32;
        Ok(self.entries.len() - 1)
    }

    fn evict(&mut self) {
        let ages = self.entries.iter().enumerate();
        let Some((oldest, _)) = ages.min_by_key(|(_, entry)| entry.used) else { return };
        let entry = self.entries.swap_remove(oldest);
        self.bytes -= entry.glyph.memory();
        self.places[usize::from(entry.gid)] = 0;
        if let Some(moved) = self.entries.get(oldest) {
            self.places[usize::from(moved.gid)] = oldest as u32 + 1;
        }
    }
}
