//! Decoding glyphs.

use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::font::Font;
use super::glyph::{Drawn, Glyph, Outlines, SharedModel};
use super::stored_outline::Memory;
use crate::error::Error;
use crate::limits::Limits;
#[cfg(feature = "fields")]
use crate::model::compose::Origin;
use crate::model::compose::Part;
#[cfg(feature = "fields")]
use crate::model::gridfit::GridFit;
#[cfg(feature = "networks")]
use crate::network::Network;
use crate::table::outline::Advances;
use crate::table::outline_hash;

/// Decodes a font's glyphs, and keeps what composed glyphs share.
#[derive(Debug)]
pub struct Decoder {
    font: Font,
    limits: Limits,
    /// The offsets that the parts of composed glyphs share; decoded with the first composed glyph.
    offsets: Option<Vec<i8>>,
    /// What outlines share.
    memory: Memory,
}

impl Decoder {
    /// A decoder for a font's glyphs.
    pub fn new(font: &Font, limits: Limits) -> Self {
        Self { font: font.clone(), limits, offsets: None, memory: Memory::default() }
    }

    /// The font whose glyphs are decoded.
    pub fn font(&self) -> &Font {
        &self.font
    }

    pub(super) fn limits(&self) -> &Limits {
        &self.limits
    }

    pub(super) fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
    }

    /// Decodes a glyph at all sizes.
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph`, `MissingModel`; `MalformedModel` or `ModelTooLarge` if its bytes are damaged, `DecodedTooLarge`,
    /// `StaleModel`, `NetworksNotBuilt`.
    pub fn glyph(&mut self, glyph: u32) -> Result<Glyph, Error> {
        self.glyph_with(glyph, 0..self.font.scale().sizes(), |_| None)
    }

    /// Decodes a glyph, at some sizes at least, the first of which begins a section. `known` gives the models that are decoded
    /// already, for the parts of composed glyphs.
    pub(super) fn glyph_with(
        &mut self,
        glyph: u32,
        sizes: Range<usize>,
        known: impl Fn(u32) -> Option<SharedModel>,
    ) -> Result<Glyph, Error> {
        if glyph >= self.font.glyph_count() {
            return Err(Error::NoSuchGlyph(glyph));
        }
        let (table, limits) = (self.font.table()?, self.limits);
        table.check_glyph(glyph)?;
        let (font, memory) = (&self.font, &mut self.memory);
        let mut outline = |part: u32| match known(part) {
            Some(SharedModel::Outline(model)) if model.has_sizes(&sizes) && !table.is_composed(part) => {
                Ok(model)
            }
            _ => font.outline_model(part, sizes.clone(), &limits, memory).map(Arc::new),
        };
        let drawn = if table.is_network(glyph) {
            self::network(&table, glyph, &limits)?
        } else if table.outlines().find(glyph).is_some() {
            let (parts, advances) = if table.is_composed(glyph) {
                let (parts, advances) = self.font.outline_parts(glyph)?;
                let placed = parts.into_iter().map(|part| Ok((outline(part.gid.into())?, part)));
                (placed.collect::<Result<Vec<_>, Error>>()?, advances)
            } else {
                (vec![(outline(glyph)?, Part::default())], Advances::OfFirstPart)
            };
            let advances = match advances {
                Advances::Rounded => Vec::new(),
                Advances::OfFirstPart => {
                    parts.first().map_or(Vec::new(), |(model, _)| model.weights.advances.clone())
                }
                Advances::Own(advances) => advances,
            };
            Drawn::Outlines(Outlines { parts, advances })
        } else {
            fields(&self.font, glyph, &limits, &mut self.offsets, known)?
        };
        let decoded = Glyph::new(glyph, limits, drawn);
        limits.check_decoded(glyph, decoded.memory())?;
        Ok(decoded)
    }
}

#[cfg(feature = "networks")]
fn network(table: &crate::table::Table<'_>, glyph: u32, limits: &Limits) -> Result<Drawn, Error> {
    let weights = table.network(glyph, limits.decoded_bytes)?;
    Network::new(weights).map(|network| Drawn::Network(Arc::new(network))).map_err(|damage| damage.of(glyph))
}

#[cfg(not(feature = "networks"))]
fn network(_: &crate::table::Table<'_>, glyph: u32, _: &Limits) -> Result<Drawn, Error> {
    Err(Error::NetworksNotBuilt(glyph))
}

#[cfg(feature = "fields")]
fn fields(
    font: &Font,
    glyph: u32,
    limits: &Limits,
    part_offsets: &mut Option<Vec<i8>>,
    known: impl Fn(u32) -> Option<SharedModel>,
) -> Result<Drawn, Error> {
    let (table, scale) = (font.table()?, font.scale());
    let model = |part: u32| match known(part) {
        Some(SharedModel::Field(model)) => Ok(model),
        _ => {
            let weights = table.weights(part, scale, limits.decoded_bytes)?;
            GridFit::new(&weights, scale).map(Arc::new).map_err(|damage| damage.of(part))
        }
    };
    if !table.is_composed(glyph) {
        return Ok(Drawn::Fields(vec![(model(glyph)?, Origin::default())]));
    }
    let offsets = match part_offsets.take() {
        Some(offsets) => offsets,
        None => table.part_offsets(glyph, scale, limits.decoded_bytes)?,
    };
    let parts = table.parts(glyph, scale, &offsets);
    *part_offsets = Some(offsets);
    let placed = parts?.into_iter().map(|part| {
        let origin = Origin::new(&part, scale).map_err(|damage| damage.of(glyph))?;
        Ok((model(part.gid.into())?, origin))
    });
    Ok(Drawn::Fields(placed.collect::<Result<_, Error>>()?))
}

#[cfg(not(feature = "fields"))]
fn fields(
    _: &Font,
    glyph: u32,
    _: &Limits,
    _: &mut Option<Vec<i8>>,
    _: impl Fn(u32) -> Option<SharedModel>,
) -> Result<Drawn, Error> {
    Err(Error::FieldsNotBuilt(glyph))
}

impl Font {
    /// Whether the outlines in this font are the ones that the models were trained from. Reads all of them. Where they were dropped,
    /// there is nothing that could differ.
    pub fn outlines_match(&self) -> bool {
        if self.outlines_dropped() {
            return true;
        }
        let is_same = self
            .glyf()
            .is_some_and(|glyf| outline_hash(self.units_per_em(), glyf) == self.header().outline_hash);
        // Other bytes may stand for the same outlines, as after compression to WOFF2. Outline models know theirs.
        is_same || self.outline_models_match()
    }

    /// Whether all models are outline models, and each belongs to the outline that the font has.
    fn outline_models_match(&self) -> bool {
        let Ok(table) = self.table() else { return false };
        let mut decoder = Decoder::new(self, Limits::default());
        self.modelled_glyphs().all(|glyph| {
            table.outlines().find(glyph).is_some()
                && !matches!(decoder.glyph_with(glyph, 0..1, |_| None), Err(Error::StaleModel(_)))
        })
    }

    /// Decodes a glyph, with the default limits.
    pub(crate) fn decode(&self, glyph: u32) -> Result<Glyph, Error> {
        Decoder::new(self, Limits::default()).glyph(glyph)
    }
}
