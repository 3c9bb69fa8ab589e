//! A glyph that is ready to draw: one model, several as the parts of a composed glyph, or a network.

use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

use super::draw::{Scratch, draw, draw_one};
use super::font::Font;
use crate::bitmap::{Bitmap, Canvas};
use crate::error::Error;
use crate::limits::{Budget, Limits};
use crate::model::compose::Origin;
use crate::model::gridfit::GridFit;
use crate::model::sizes::HintedSize;
#[cfg(feature = "networks")]
use crate::network::Network;
use crate::options::DrawOptions;
use crate::placement::{Placement, union};

/// One glyph, decoded and ready to draw.
#[derive(Debug, Clone)]
pub struct Glyph {
    glyph: u32,
    limits: Limits,
    drawn: Drawn,
}

/// What a glyph is drawn from.
#[derive(Debug, Clone)]
enum Drawn {
    Parts(Vec<(Arc<GridFit>, Origin)>),
    #[cfg(feature = "networks")]
    Network(Arc<Network>),
}

impl Glyph {
    /// A glyph that is composed of models, each with its origin, with the default limits.
    pub fn of_models(parts: Vec<(Arc<GridFit>, Origin)>) -> Self {
        Self { glyph: 0, limits: Limits::default(), drawn: Drawn::Parts(parts) }
    }

    /// A glyph that a network draws, with limits that fit any network.
    #[cfg(feature = "networks")]
    pub fn of_network(network: Network) -> Self {
        let limits = Limits { decoded_bytes: usize::MAX, work: u64::MAX, ..Limits::default() };
        Self { glyph: 0, limits, drawn: Drawn::Network(Arc::new(network)) }
    }

    /// The first part's model, to be shared with other glyphs.
    pub(super) fn model(&self) -> Option<Arc<GridFit>> {
        match &self.drawn {
            Drawn::Parts(parts) => parts.first().map(|(model, _)| model.clone()),
            #[cfg(feature = "networks")]
            Drawn::Network(_) => None,
        }
    }

    /// The network that draws the glyph, if one does.
    #[cfg(feature = "networks")]
    pub fn network(&self) -> Option<&Network> {
        match &self.drawn {
            Drawn::Parts(_) => None,
            Drawn::Network(network) => Some(network),
        }
    }

    /// Where the bitmap lies.
    ///
    /// # Errors
    ///
    /// `InvalidSize` or `InvalidOffset`, `BitmapTooLarge`; for a network `NetworkSize` or `NetworkOffset`.
    pub fn placement(&self, options: impl Into<DrawOptions>) -> Result<Placement, Error> {
        let options = options.into().checked()?;
        let placement = match &self.drawn {
            Drawn::Parts(parts) => {
                let mut whole = Placement::default();
                for (model, origin) in parts {
                    let size = model.scale().at(options.ppem);
                    whole = union(whole, model.placement_at(&size, position(origin, &size, options))?);
                }
                whole
            }
            #[cfg(feature = "networks")]
            Drawn::Network(network) => network.placement(self.glyph, options)?,
        };
        self.limits.check_sides(placement.width, placement.height)?;
        Ok(placement)
    }

    /// Draws into a new bitmap.
    ///
    /// # Errors
    ///
    /// As `placement`, and `TooMuchWork`.
    pub fn render(&self, options: impl Into<DrawOptions>) -> Result<Bitmap, Error> {
        self.render_with(options, &mut Scratch::default())
    }

    /// Draws into a new bitmap, with working memory that drawing reuses.
    ///
    /// # Errors
    ///
    /// As `render`.
    pub fn render_with(
        &self,
        options: impl Into<DrawOptions>,
        scratch: &mut Scratch,
    ) -> Result<Bitmap, Error> {
        let mut pixels = Vec::new();
        let placement = self.draw(options.into(), scratch, fresh(&mut pixels))?.unwrap_or_default();
        Ok(Bitmap { placement, pixels })
    }

    /// Draws coverage 0–255 into the canvas that `room` gives for the bitmap's placement; if it gives none, nothing is
    /// drawn, and `None` is returned.
    pub(super) fn draw<'b>(
        &self,
        options: DrawOptions,
        scratch: &mut Scratch,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        let options = options.checked()?;
        let room = |placement: Placement| {
            self.limits.check_sides(placement.width, placement.height)?;
            room(placement)
        };
        let mut budget = Budget::new(self.glyph, &self.limits);
        match &self.drawn {
            Drawn::Parts(parts) => self.draw_parts(parts, options, scratch, &mut budget, room),
            #[cfg(feature = "networks")]
            Drawn::Network(network) => network.draw(self.glyph, options, &mut budget, room),
        }
    }

    fn draw_parts<'b>(
        &self,
        parts: &[(Arc<GridFit>, Origin)],
        options: DrawOptions,
        scratch: &mut Scratch,
        budget: &mut Budget,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        let size = match parts.first() {
            Some((model, _)) => model.scale().at(options.ppem),
            None => return Ok(room(Placement::default())?.map(|_| Placement::default())),
        };
        if let [(model, origin)] = parts
            && !model.is_empty()
        {
            return draw_one(model, &size, position(origin, &size, options), scratch, budget, room);
        }
        let placement = self.placement(options)?;
        let Some(mut canvas) = room(placement)? else { return Ok(None) };
        budget.spend(placement.area() as u64)?;
        let parts = parts.iter().map(|(model, origin)| (&**model, position(origin, &size, options)));
        draw(&parts, &size, placement, scratch, &mut canvas, budget)?;
        Ok(Some(placement))
    }

    /// The memory that the models or the network take, in bytes. A model that several glyphs share counts in each of
    /// them.
    pub fn memory(&self) -> usize {
        match &self.drawn {
            Drawn::Parts(parts) => parts.iter().map(|(model, origin)| model.memory() + origin.memory()).sum(),
            #[cfg(feature = "networks")]
            Drawn::Network(network) => network.memory(),
        }
    }
}

/// Room for a bitmap in an empty vector.
pub(super) fn fresh<'b>(
    pixels: &'b mut Vec<u8>,
) -> impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error> {
    move |placement| {
        *pixels = vec![0; placement.area()];
        Canvas::new(placement, pixels, placement.width as usize).map(Some)
    }
}

/// The position of a part's origin in pixels.
fn position(origin: &Origin, size: &HintedSize, options: DrawOptions) -> [f32; 2] {
    let at = origin.at(size);
    [0, 1].map(|axis| at[axis] + options.offset[axis])
}

/// Decodes a font's glyphs, and keeps what composed glyphs share.
#[derive(Debug)]
pub struct Decoder {
    font: Font,
    limits: Limits,
    /// The offsets that the parts of composed glyphs share; decoded with the first composed glyph.
    offsets: Option<Vec<i8>>,
}

impl Decoder {
    /// A decoder for a font's glyphs.
    pub fn new(font: &Font, limits: Limits) -> Self {
        Self { font: font.clone(), limits, offsets: None }
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

    /// Decodes a glyph.
    ///
    /// # Errors
    ///
    /// `NoSuchGlyph`, `MissingModel`; `MalformedModel` or `ModelTooLarge` if its bytes are damaged, `DecodedTooLarge`,
    /// `NetworksNotBuilt`.
    pub fn glyph(&mut self, glyph: u32) -> Result<Glyph, Error> {
        self.glyph_with(glyph, |_| None)
    }

    /// Decodes a glyph. `known` gives the models that are decoded already, for the parts of composed glyphs.
    pub(super) fn glyph_with(
        &mut self,
        glyph: u32,
        known: impl Fn(u32) -> Option<Arc<GridFit>>,
    ) -> Result<Glyph, Error> {
        if glyph >= self.font.glyph_count() {
            return Err(Error::NoSuchGlyph(glyph));
        }
        let (table, scale, limits) = (self.font.table()?, self.font.scale(), self.limits);
        table.check_glyph(glyph)?;
        let model = |part: u32| match known(part) {
            Some(model) => Ok(model),
            None => {
                let weights = table.weights(part, scale, limits.decoded_bytes)?;
                GridFit::new(&weights, scale).map(Arc::new).map_err(|damage| damage.of(part))
            }
        };
        let drawn = if table.is_network(glyph) {
            self::network(&table, glyph, &limits)?
        } else if table.is_composed(glyph) {
            let offsets = match self.offsets.take() {
                Some(offsets) => offsets,
                None => table.part_offsets(glyph, scale, limits.decoded_bytes)?,
            };
            let parts = table.parts(glyph, scale, &offsets);
            self.offsets = Some(offsets);
            let placed = parts?.into_iter().map(|part| {
                let origin = Origin::new(&part, scale).map_err(|damage| damage.of(glyph))?;
                Ok((model(part.gid.into())?, origin))
            });
            Drawn::Parts(placed.collect::<Result<_, Error>>()?)
        } else {
            Drawn::Parts(vec![(model(glyph)?, Origin::default())])
        };
        let decoded = Glyph { glyph, limits, drawn };
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

impl Font {
    /// Decodes a glyph, with the default limits.
    pub(crate) fn decode(&self, glyph: u32) -> Result<Glyph, Error> {
        Decoder::new(self, Limits::default()).glyph(glyph)
    }
}
