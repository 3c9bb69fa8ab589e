//! A font whose glyphs are drawn by networks that were trained elsewhere.

use std::collections::BTreeSet;

use super::assemble::{assemble, outline_hash};
use super::open::{has_models, open};
use super::select::glyph_count;
use crate::error::Error;
use nfr::internals::render::head_units;
use nfr::internals::table::{self, GlyphNetwork, Header};

/// Writes a font that carries networks instead of hints, and all outlines as they are. `data` is a TrueType font's file,
/// or a collection of which it is number `index`; `networks` are in ascending order of their glyphs. Of `about`, the
/// target, the seed and the training's numbers count; sizes and hash are those of the networks and the font.
///
/// # Errors
///
/// As [`open`] and [`assemble`]; `Unsupported` for a font that has models already, `MissingGlyph` for a network of a
/// glyph that the font does not have, `InvalidParameter` for no networks, or for ones that are out of order or contradict
/// themselves, `LimitExceeded` for ones that readers would refuse.
pub fn with_networks(
    data: &[u8],
    index: u32,
    networks: &[GlyphNetwork],
    about: &Header,
) -> Result<Vec<u8>, Error> {
    let font = open(data, index)?;
    if has_models(&font) {
        return Err(Error::Unsupported(
            "the font already carries an 'Nfrt' table; put the networks into the original font".into(),
        ));
    }
    let glyphs = glyph_count(&font)?;
    if let Some(missing) = networks.iter().find(|network| u32::from(network.gid) >= glyphs) {
        return Err(Error::MissingGlyph(missing.gid));
    }
    let sizes = || networks.iter().flat_map(|network| &network.weights.sizes).map(|size| size.ppem);
    let (Some(first_ppem), Some(last_ppem)) = (sizes().min(), sizes().max()) else {
        return Err(Error::InvalidParameter("no networks, or none that has sizes; pass one at least".into()));
    };
    let header = Header {
        first_ppem,
        last_ppem,
        outline_hash: outline_hash(&font)?,
        outlines_dropped: false,
        ..*about
    };
    let (table, _) = table::write(&header, &[], &[], networks, header.scale(head_units(&font)?))?;
    assemble(&font, &table, &BTreeSet::new())
}
