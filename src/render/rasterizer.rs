//! Drawing many glyphs: decoded models are kept in a cache whose size the caller sets.

use alloc::vec::Vec;
use core::ops::Range;

use super::decoder::Decoder;
use super::font::Font;
use super::glyph::{Flattened, Glyph, fresh};
use super::mono::paint::Mono;
use super::outline::draw_plain;
use super::scratch::Scratch;
use crate::bitmap::{Bitmap, BitmapRef, Canvas};
use crate::error::Error;
use crate::limits::{Limits, MissingModel};
use crate::model::outline::scale_of;
use crate::number::mul_fixed;
use crate::options::DrawOptions;
use crate::placement::Placement;
use crate::table::outline::sizes_for;

/// Decoded models take up to this many bytes unless the caller says otherwise: about 700 fields.
const DEFAULT_CACHE: usize = 8 << 20;

/// Draws a font's glyphs, one thread at a time. Decoded models are kept, and working memory is reused: a glyph that is in
/// the cache is drawn without allocating.
///
/// All ways of drawing grey coverage give the same pixels. Their errors are the same, too: `NoSuchGlyph` for a glyph that
/// the font does not have, `MissingModel` for one without a model (see [`Self::with_missing_model`]), `MalformedModel` or
/// `ModelTooLarge` for a damaged one, `InvalidSize` or `InvalidOffset` for [`DrawOptions`] out of range, `BitmapTooLarge`,
/// `DecodedTooLarge` or `TooMuchWork` for what is beyond the [`Limits`], for glyphs that a field draws
/// `FieldsNotBuilt`, and for those that a network draws `NetworksNotBuilt`, `NetworkSize` and `NetworkOffset`.
#[derive(Debug)]
pub struct Rasterizer {
    decoder: Decoder,
    missing: MissingModel,
    cache: Cache,
    pub(super) scratch: Scratch,
    /// Of drawing in black and white.
    pub(super) mono: Mono,
    /// The bitmap that [`Self::draw`] lends.
    pixels: Vec<u8>,
}

const _: () = {
    const fn sendable<T: Send + Sync + 'static>() {}
    sendable::<Rasterizer>();
};

impl Rasterizer {
    /// A rasterizer with a cache of 8 MiB and the default limits. A glyph without a model is an error.
    pub fn new(font: &Font) -> Self {
        Self {
            decoder: Decoder::new(font, Limits::default()),
            missing: MissingModel::default(),
            cache: Cache { limit: DEFAULT_CACHE, ..Cache::default() },
            scratch: Scratch::default(),
            mono: Mono::default(),
            pixels: Vec::new(),
        }
    }

    /// Keeps decoded models of at most `bytes` bytes, and always at least the last one.
    #[must_use]
    pub fn with_cache(mut self, bytes: usize) -> Self {
        self.cache = Cache { limit: bytes, ..Cache::default() };
        self
    }

    /// Sets what drawing a glyph may take.
    #[must_use]
    pub fn with_limits(mut self, limits: Limits) -> Self {
        self.decoder.set_limits(limits);
        // What is decoded already was held to other limits.
        self.cache = Cache { limit: self.cache.limit, ..Cache::default() };
        self
    }

    /// Chooses what is drawn for a glyph that the font has, but no model of.
    #[must_use]
    pub fn with_missing_model(mut self, missing: MissingModel) -> Self {
        self.missing = missing;
        self
    }

    /// The font that is drawn.
    pub fn font(&self) -> &Font {
        self.decoder.font()
    }

    /// Where a glyph's bitmap lies.
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them, but for `TooMuchWork`.
    pub fn placement(&mut self, glyph: u32, options: impl Into<DrawOptions>) -> Result<Placement, Error> {
        let mut placement = Placement::default();
        self.draw_with(glyph, options.into(), |found| {
            placement = found;
            Ok(None)
        })?;
        Ok(placement)
    }

    /// The hinted advance width in pixels, as the teacher's interpreter gives it: a whole number at the trained sizes, and
    /// [`Font::advance`] at others and for glyphs whose models do not know it (fields, networks, missing models).
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph`, `InvalidSize`, and those of a damaged model.
    pub fn hinted_advance(&mut self, glyph: u32, ppem: f32) -> Result<f32, Error> {
        DrawOptions::new(ppem).checked()?;
        let size = self.decoder.font().scale().at(ppem);
        let more = match self.cache.get(&mut self.decoder, glyph, DrawOptions::new(ppem)) {
            Ok(entry) => entry.decoded.hinted_advance(&size),
            Err(Error::MissingModel(missing)) if missing == glyph => None,
            Err(error) => return Err(error),
        };
        let font = self.decoder.font();
        let Some(more) = more else { return Ok(font.advance(glyph, ppem)) };
        let scaled =
            mul_fixed(font.advance_units(glyph).into(), scale_of(size.trained_ppem, font.units_per_em()));
        Ok((((scaled + 32) >> 6) + i32::from(more)) as f32)
    }

    /// The hinted left side bearing in pixels: how far the leftmost point of the outline is from the glyph's origin, control
    /// points included, in steps of 1/64. It is the one of `hmtx`, linear in the size, for glyphs without an outline and for
    /// those whose models do not know it (fields, networks, missing models).
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph`, `InvalidSize`, `BitmapTooLarge`, and those of a damaged model.
    pub fn hinted_side_bearing(&mut self, glyph: u32, ppem: f32) -> Result<f32, Error> {
        DrawOptions::new(ppem).checked()?;
        let left = match self.cache.get(&mut self.decoder, glyph, DrawOptions::new(ppem)) {
            Ok(entry) => entry.decoded.left(ppem, &mut self.scratch)?,
            Err(Error::MissingModel(missing)) if missing == glyph => None,
            Err(error) => return Err(error),
        };
        Ok(left.map_or_else(|| self.font().side_bearing(glyph, ppem), |left| left as f32 / 64.0))
    }

    /// Draws a glyph into a buffer of the rasterizer's own, and lends it until the next drawing.
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them.
    pub fn draw(&mut self, glyph: u32, options: impl Into<DrawOptions>) -> Result<BitmapRef<'_>, Error> {
        let mut pixels = core::mem::take(&mut self.pixels);
        let drawn = self.draw_with(glyph, options.into(), |placement| {
            if pixels.len() < placement.area() {
                pixels.resize(placement.area(), 0);
            }
            Canvas::new(placement, &mut pixels, placement.width as usize).map(Some)
        });
        self.pixels = pixels;
        let placement = drawn?.unwrap_or_default();
        Ok(BitmapRef::new(placement, &self.pixels[..placement.area()]))
    }

    /// Draws a glyph into a new bitmap.
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them.
    pub fn render(&mut self, glyph: u32, options: impl Into<DrawOptions>) -> Result<Bitmap, Error> {
        let mut pixels = Vec::new();
        let placement = self.draw_with(glyph, options.into(), fresh(&mut pixels))?.unwrap_or_default();
        Ok(Bitmap { placement, pixels })
    }

    /// Draws a glyph's coverage, 0–255, into `pixels`: top row first, rows `pitch` bytes apart. Bytes beside and behind
    /// the bitmap are left alone.
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them, and `BufferTooSmall`, which tells the placement; nothing is drawn then. Where the
    /// buffer is still to be found, as in an atlas, [`Self::render_with`] needs one call only.
    pub fn render_into(
        &mut self,
        glyph: u32,
        options: impl Into<DrawOptions>,
        pixels: &mut [u8],
        pitch: usize,
    ) -> Result<Placement, Error> {
        self.render_with(glyph, options, |_| Some((pixels, pitch))).map(Option::unwrap_or_default)
    }

    /// Draws a glyph into the buffer that `room` gives for its placement, whose rows are so many bytes apart. If `room`
    /// gives none, nothing is drawn and `None` is returned.
    ///
    /// ```
    /// # let font = nfr::Font::new(include_bytes!("../../spec/vectors/sans.ttf").as_slice())?;
    /// let mut rasterizer = nfr::Rasterizer::new(&font);
    /// let (mut atlas, width) = (vec![0; 256 * 64], 256);
    /// let mut next = 0;
    /// for character in "nfr".chars().filter_map(|c| font.glyph_for_char(c)) {
    ///     let drawn = rasterizer.render_with(character, 24.0, |placement| {
    ///         let x = next;
    ///         next += placement.width as usize + 1;
    ///         (next <= width).then(|| (&mut atlas[x..], width))
    ///     })?;
    ///     assert!(drawn.is_some(), "the atlas is full");
    /// }
    /// # Ok::<(), nfr::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them, and `BufferTooSmall`.
    pub fn render_with<'b>(
        &mut self,
        glyph: u32,
        options: impl Into<DrawOptions>,
        room: impl FnOnce(Placement) -> Option<(&'b mut [u8], usize)>,
    ) -> Result<Option<Placement>, Error> {
        self.draw_with(glyph, options.into(), |placement| {
            let Some((pixels, pitch)) = room(placement) else { return Ok(None) };
            Canvas::new(placement, pixels, pitch).map(Some)
        })
    }

    pub(super) fn draw_with<'b>(
        &mut self,
        glyph: u32,
        options: DrawOptions,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        match Source::of(&mut self.cache, &mut self.decoder, self.missing, glyph, options)? {
            Source::Model(entry) => {
                let before = entry.kept.memory();
                let drawn = entry.decoded.draw_kept(&mut entry.kept, options, &mut self.scratch, room);
                let after = entry.kept.memory();
                if after != before {
                    self.cache.resize(before, after);
                }
                drawn
            }
            Source::Blank => {
                options.checked()?;
                room(Placement::default())?;
                Ok(Some(Placement::default()))
            }
            Source::Plain => self.draw_plain(glyph, options, room),
        }
    }

    /// What a glyph is drawn from.
    pub(super) fn source(&mut self, glyph: u32, options: DrawOptions) -> Result<Source<'_>, Error> {
        Source::of(&mut self.cache, &mut self.decoder, self.missing, glyph, options)
    }

    pub(super) fn limits(&self) -> &Limits {
        self.decoder.limits()
    }

    /// Draws the outline that the font has for a glyph.
    fn draw_plain<'b>(
        &mut self,
        glyph: u32,
        options: DrawOptions,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        draw_plain(self.decoder.font(), glyph, options, self.decoder.limits(), &mut self.scratch, room)
    }
}

/// What a glyph is drawn from.
pub(super) enum Source<'c> {
    Model(&'c mut Entry),
    /// Nothing: it has no model.
    Blank,
    /// The outline that the font has for it.
    Plain,
}

impl<'c> Source<'c> {
    fn of(
        cache: &'c mut Cache,
        decoder: &mut Decoder,
        missing: MissingModel,
        glyph: u32,
        options: DrawOptions,
    ) -> Result<Self, Error> {
        match cache.get(decoder, glyph, options) {
            Ok(entry) if options.hinting || entry.decoded.has_outline() => Ok(Self::Model(entry)),
            Err(error @ Error::MissingModel(absent)) if absent == glyph && options.hinting => match missing {
                MissingModel::Error => Err(error),
                MissingModel::Blank => Ok(Self::Blank),
                MissingModel::Outline => Ok(Self::Plain),
            },
            Err(error) if !matches!(error, Error::MissingModel(absent) if absent == glyph) => Err(error),
            Ok(_) | Err(_) => Ok(Self::Plain),
        }
    }
}

/// Decoded models, the least recently used of which make room.
#[derive(Debug, Default)]
struct Cache {
    limit: usize,
    bytes: usize,
    clock: u64,
    /// For each glyph of the font, its index in `entries` plus 1; 0 for one that is not cached.
    indices: Vec<u16>,
    entries: Vec<Entry>,
}

#[derive(Debug)]
pub(super) struct Entry {
    glyph: u32,
    /// When it was last asked for.
    used: u64,
    decoded: Glyph,
    /// What its last drawing leaves for the next one.
    kept: Flattened,
}

impl Entry {
    /// The decoded glyph.
    pub(super) fn glyph(&self) -> &Glyph {
        &self.decoded
    }

    fn memory(&self) -> usize {
        self.decoded.memory() + self.kept.memory()
    }
}

impl Cache {
    /// The glyph, decoded for a size.
    fn get(&mut self, decoder: &mut Decoder, glyph: u32, options: DrawOptions) -> Result<&mut Entry, Error> {
        self.clock += 1;
        let at = match self.find(glyph) {
            Some(at) if self.entries.get(at).is_some_and(|entry| entry.decoded.has_size(options)) => at,
            // Whoever asks for another size may ask for more of them.
            Some(at) => {
                self.remove(at);
                self.load(decoder, glyph, 0..decoder.font().scale().sizes())?
            }
            None => {
                let size = options.size(decoder.font().scale());
                self.load(decoder, glyph, sizes_for(size.index))?
            }
        };
        let entry = self.entries.get_mut(at).ok_or(Error::NoSuchGlyph(glyph))?;
        entry.used = self.clock;
        Ok(entry)
    }

    fn find(&self, glyph: u32) -> Option<usize> {
        usize::from(*self.indices.get(glyph as usize)?).checked_sub(1)
    }

    fn load(&mut self, decoder: &mut Decoder, glyph: u32, sizes: Range<usize>) -> Result<usize, Error> {
        let decoded =
            decoder.glyph_with(glyph, sizes, |part| self.entries[self.find(part)?].decoded.model())?;
        let bytes = decoded.memory();
        while self.bytes + bytes > self.limit && !self.entries.is_empty() {
            self.evict();
        }
        self.bytes += bytes;
        self.entries.push(Entry { glyph, used: self.clock, decoded, kept: Flattened::default() });
        if self.indices.len() <= glyph as usize {
            self.indices.resize(glyph as usize + 1, 0);
        }
        self.indices[glyph as usize] = self.entries.len() as u16;
        Ok(self.entries.len() - 1)
    }

    /// Counts an entry that has grown from one size in bytes to another.
    fn resize(&mut self, before: usize, after: usize) {
        self.bytes = self.bytes + after - before;
        while self.bytes > self.limit && self.entries.len() > 1 {
            self.evict();
        }
    }

    fn evict(&mut self) {
        let ages = self.entries.iter().enumerate();
        if let Some((oldest, _)) = ages.min_by_key(|(_, entry)| entry.used) {
            self.remove(oldest);
        }
    }

    fn remove(&mut self, at: usize) {
        let entry = self.entries.swap_remove(at);
        self.bytes -= entry.memory();
        self.indices[entry.glyph as usize] = 0;
        if let Some(moved) = self.entries.get(at) {
            self.indices[moved.glyph as usize] = at as u16 + 1;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
