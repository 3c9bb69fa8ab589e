//! Fonts with PostScript outlines (`CFF `, and `CFF2` at its default instance): a TrueType font of the same shapes, whose outlines
//! models move, and where the hints put its points.

mod align;
mod curve;
mod outline;
mod tables;
mod whole;

use read_fonts::ps::cff::CffFontRef;
use read_fonts::ps::charstring::CommandSink;
use read_fonts::types::{Fixed, GlyphId, Tag};
use read_fonts::{FontRef, TableProvider};

use super::outline::Outline;
use super::unhinted::UnhintedOutlines;
use crate::error::Error;
use crate::options::Hinter;
use align::hinted_points;
use nfr::internals::table::Dropout;
use outline::QuadraticGlyph;

/// A PostScript font and its TrueType copy.
pub(super) struct PostScript {
    units_per_em: u16,
    /// The TrueType font.
    pub(super) true_type: Vec<u8>,
    /// The glyphs; for one that cannot be drawn, why not.
    glyphs: Vec<Result<QuadraticGlyph, Error>>,
}

impl PostScript {
    /// Converts a font with PostScript outlines.
    ///
    /// # Errors
    ///
    /// `Malformed` or `LimitExceeded` for tables that cannot be read or written, `Unsupported` without hints that are to be run. Of glyphs that cannot
    /// be drawn, [`Self::check`] tells.
    pub(super) fn new(font: &FontRef<'_>, hinter: Hinter) -> Result<Self, Error> {
        if hinter == Hinter::Font && !has_stem_hints(font) {
            return Err(Error::Unsupported(
                "the font's glyphs have no horizontal stem hints, so there is nothing to learn; pass a hinted font, or let \
                 skrifa's autohinter hint it (--hinter auto)"
                    .into(),
            ));
        }
        let unhinted = UnhintedOutlines::new(font)?;
        let units_per_em = unhinted.units_per_em();
        let count =
            font.maxp().map_err(|e| Error::Malformed(format!("table 'maxp' cannot be read ({e})")))?;
        let glyphs: Vec<_> = (0..count.num_glyphs())
            .map(|gid| {
                let cubic = unhinted.units(gid)?;
                QuadraticGlyph::new(cubic, units_per_em)
                    .map_err(|what| Error::Unsupported(format!("glyph {gid} {what}; leave the glyph out")))
            })
            .collect();
        let blank = QuadraticGlyph::default();
        let readable: Vec<&QuadraticGlyph> =
            glyphs.iter().map(|glyph| glyph.as_ref().unwrap_or(&blank)).collect();
        Ok(Self { units_per_em, true_type: tables::true_type(font, &readable)?, glyphs })
    }

    /// Whether the glyph has become a TrueType glyph.
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph`, `Malformed` for a charstring that cannot be drawn, `Unsupported` for one that does not fit `glyf`.
    pub(super) fn check(&self, gid: u16) -> Result<(), Error> {
        self.glyph(gid).map(|_| ())
    }

    fn glyph(&self, gid: u16) -> Result<&QuadraticGlyph, Error> {
        match self.glyphs.get(usize::from(gid)) {
            Some(Ok(glyph)) => Ok(glyph),
            Some(Err(error)) => Err(error.clone()),
            None => Err(Error::NoSuchGlyph(gid.into())),
        }
    }

    /// The hinted outline with quadratic curves, which is filled as the cubic one that skrifa has drawn. If its points cannot be
    /// told from each other, it is the cubic one.
    pub(super) fn hinted(&self, gid: u16, cubic: Outline, ppem: f32) -> Result<Outline, Error> {
        let glyph = self.glyph(gid)?;
        let scale = ppem / f32::from(self.units_per_em);
        let points = hinted_points(&glyph.cubic, &cubic, scale);
        let Some(points) = points else { return Ok(cubic) };
        let mut outline = glyph.outline(&points, scale.into());
        outline.advance = cubic.advance;
        // FreeType fills gaps in outlines of any kind, and only TrueType's programs ask for other modes.
        outline.dropout = Dropout::new(false, false);
        Ok(outline.filled_as(&cubic))
    }
}

/// The outlines' table, if they are PostScript ones.
fn outline_table<'a>(font: &FontRef<'a>) -> Option<&'a [u8]> {
    let table = |tag| font.table_data(Tag::new(tag));
    table(b"CFF2").or_else(|| table(b"CFF ")).map(|data| data.as_bytes())
}

/// Whether any glyph has a horizontal stem hint. Without one no point is moved.
fn has_stem_hints(font: &FontRef<'_>) -> bool {
    let Some(data) = outline_table(font) else { return false };
    let units = font.head().map_or(1000, |head| head.units_per_em());
    let Ok(cff) = CffFontRef::new(data, 0, Some(units.into())) else { return false };
    (0..cff.num_glyphs()).map(GlyphId::new).any(|gid| {
        let mut stems = Stems(false);
        let subfont = cff.subfont_index(gid).and_then(|index| cff.subfont(index, &[]).ok());
        // What a damaged glyph has before the damage counts.
        subfont.is_some_and(|subfont| {
            let _ = cff.evaluate_charstring(&subfont, gid, &[], &mut stems);
            stems.0
        })
    })
}

/// Whether there was a horizontal stem hint.
struct Stems(bool);

impl CommandSink for Stems {
    fn move_to(&mut self, _x: Fixed, _y: Fixed) {}
    fn line_to(&mut self, _x: Fixed, _y: Fixed) {}
    fn curve_to(&mut self, _ax: Fixed, _ay: Fixed, _bx: Fixed, _by: Fixed, _x: Fixed, _y: Fixed) {}
    fn close(&mut self) {}
    fn hstem(&mut self, _y: Fixed, _dy: Fixed) {
        self.0 = true;
    }
}
