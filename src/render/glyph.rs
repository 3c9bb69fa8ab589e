//! A glyph that is ready to draw: one model, several as the parts of a composed glyph, or a network.

mod hinted;

use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

#[cfg(feature = "fields")]
use super::draw::{draw, draw_one};
use super::flatten::Polygons;
use super::outline::{draw_polygons, flatten, leftmost};
use super::scratch::Scratch;
use crate::bitmap::{Bitmap, Canvas};
use crate::error::Error;
use crate::limits::{Budget, Limits};
#[cfg(feature = "fields")]
use crate::model::compose::Origin;
use crate::model::compose::Part;
#[cfg(feature = "fields")]
use crate::model::gridfit::GridFit;
use crate::model::outline::OutlineModel;
use crate::model::sizes::HintedSize;
#[cfg(feature = "networks")]
use crate::network::Network;
use crate::options::DrawOptions;
use crate::placement::Placement;
#[cfg(feature = "fields")]
use crate::placement::union;

pub use hinted::HintedOutline;

/// One glyph, decoded and ready to draw.
#[derive(Debug, Clone)]
pub struct Glyph {
    glyph: u32,
    limits: Limits,
    drawn: Drawn,
}

/// What a glyph is drawn from.
#[derive(Debug, Clone)]
pub(super) enum Drawn {
    /// Outlines, which draw all sizes up to the ones that they are decoded to.
    Outlines(Outlines),
    #[cfg(feature = "fields")]
    Fields(Vec<(Arc<GridFit>, Origin)>),
    #[cfg(feature = "networks")]
    Network(Arc<Network>),
}

/// Outlines that are drawn together.
#[derive(Debug, Clone)]
pub(super) struct Outlines {
    pub(super) parts: Vec<(Arc<OutlineModel>, Part)>,
    /// The hinted advance width at each size, in whole pixels less the scaled one, rounded; empty if all are 0.
    pub(super) advances: Vec<i8>,
}

/// A glyph's outlines at the last size that they were drawn at, as polygons: text is drawn at one size many times, at other
/// positions.
#[derive(Debug, Default)]
pub(super) struct Flattened {
    /// The size, whether it is hinted, and the samples of a pixel along x and y.
    drawn_as: (f32, bool, [i32; 2]),
    polygons: Polygons,
}

impl Flattened {
    /// The memory that it takes, in bytes.
    pub(super) fn memory(&self) -> usize {
        self.polygons.memory()
    }
}

/// Polygons with more vertices are not kept.
const MAX_KEPT: usize = 256;

/// A decoded model that glyphs share.
#[derive(Debug, Clone)]
pub(super) enum SharedModel {
    Outline(Arc<OutlineModel>),
    #[cfg(feature = "fields")]
    Field(Arc<GridFit>),
}

impl Glyph {
    pub(super) fn new(glyph: u32, limits: Limits, drawn: Drawn) -> Self {
        Self { glyph, limits, drawn }
    }

    /// A glyph that is composed of fields, each with its origin, with the default limits.
    #[cfg(feature = "fields")]
    pub fn of_models(parts: Vec<(Arc<GridFit>, Origin)>) -> Self {
        Self::new(0, Limits::default(), Drawn::Fields(parts))
    }

    /// A glyph that is composed of outlines, with the default limits.
    pub fn of_outlines(parts: Vec<(Arc<OutlineModel>, Part)>) -> Self {
        Self::new(0, Limits::default(), Drawn::Outlines(Outlines { parts, advances: Vec::new() }))
    }

    /// A glyph that a network draws, with limits that fit any network.
    #[cfg(feature = "networks")]
    pub fn of_network(network: Network) -> Self {
        let limits = Limits { decoded_bytes: usize::MAX, work: u64::MAX, ..Limits::default() };
        Self { glyph: 0, limits, drawn: Drawn::Network(Arc::new(network)) }
    }

    /// The first part's model, to be shared with other glyphs.
    pub(super) fn model(&self) -> Option<SharedModel> {
        match &self.drawn {
            Drawn::Outlines(outlines) => {
                outlines.parts.first().map(|(model, _)| SharedModel::Outline(model.clone()))
            }
            #[cfg(feature = "fields")]
            Drawn::Fields(parts) => parts.first().map(|(model, _)| SharedModel::Field(model.clone())),
            #[cfg(feature = "networks")]
            Drawn::Network(_) => None,
        }
    }

    /// Whether a size is decoded.
    pub(super) fn has_size(&self, options: DrawOptions) -> bool {
        self.outlines().is_none_or(|outlines| {
            outlines.parts.iter().all(|(model, _)| {
                let size = options.size(model.scale);
                size.strength == 0.0 || model.has_size(size.index)
            })
        })
    }

    /// The outlines that the glyph is drawn from. None for one that fields or a network draw.
    fn outlines(&self) -> Option<&Outlines> {
        match &self.drawn {
            Drawn::Outlines(outlines) => Some(outlines),
            #[cfg(any(feature = "fields", feature = "networks"))]
            _ => None,
        }
    }

    /// Whether it can be drawn without hints. A network cannot.
    pub(super) fn has_outline(&self) -> bool {
        match &self.drawn {
            Drawn::Outlines(_) => true,
            #[cfg(feature = "fields")]
            Drawn::Fields(_) => true,
            #[cfg(feature = "networks")]
            Drawn::Network(_) => false,
        }
    }

    /// How much wider the hinted advance width is than the scaled one, rounded, at a trained size: in whole pixels. None for a
    /// glyph that has no such widths.
    pub(super) fn hinted_advance(&self, size: &HintedSize) -> Option<i8> {
        let outlines = self.outlines().filter(|_| size.strength > 0.0)?;
        Some(outlines.advances.get(size.index).copied().unwrap_or(0))
    }

    /// The leftmost point of its outlines in 1/64 pixel. None for a glyph that has none.
    ///
    /// # Errors
    ///
    /// `BitmapTooLarge` for points that are too far away.
    pub(super) fn left(&self, ppem: f32, scratch: &mut Scratch) -> Result<Option<i32>, Error> {
        match self.outlines().and_then(|outlines| outlines.at(DrawOptions::new(ppem))) {
            Some((size, parts)) => leftmost(parts, &size, scratch),
            None => Ok(None),
        }
    }

    /// The network that draws the glyph, if one does.
    #[cfg(feature = "networks")]
    pub fn network(&self) -> Option<&Network> {
        match &self.drawn {
            Drawn::Network(network) => Some(network),
            _ => None,
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
            Drawn::Outlines(_) => {
                let mut found = Placement::default();
                self.draw(options, &mut Scratch::default(), |placement| {
                    found = placement;
                    Ok(None)
                })?;
                found
            }
            #[cfg(feature = "fields")]
            Drawn::Fields(parts) => {
                let mut whole = Placement::default();
                for (model, origin) in parts {
                    let size = options.size(model.scale());
                    whole = union(whole, model.placement_at(&size, position(origin, &size, options))?);
                }
                whole.stretched(options.sampling.stretch)
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
        self.draw_kept(&mut Flattened::default(), options, scratch, room)
    }

    /// The same. `kept` is what was kept of this glyph when it was drawn before.
    pub(super) fn draw_kept<'b>(
        &self,
        kept: &mut Flattened,
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
            Drawn::Outlines(outlines) => outlines.draw(kept, options, scratch, &mut budget, room),
            #[cfg(feature = "fields")]
            Drawn::Fields(parts) => self.draw_parts(parts, options, scratch, &mut budget, room),
            #[cfg(feature = "networks")]
            Drawn::Network(network) => network.draw(self.glyph, options, &mut budget, room),
        }
    }

    #[cfg(feature = "fields")]
    fn draw_parts<'b>(
        &self,
        parts: &[(Arc<GridFit>, Origin)],
        options: DrawOptions,
        scratch: &mut Scratch,
        budget: &mut Budget,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        let size = match parts.first() {
            Some((model, _)) => options.size(model.scale()),
            None => return Ok(room(Placement::default())?.map(|_| Placement::default())),
        };
        if let [(model, origin)] = parts
            && !model.is_empty()
        {
            let at = position(origin, &size, options);
            return draw_one(model, &size, options.sampling.stretch, at, scratch, budget, room);
        }
        let placement = self.placement(options)?;
        let Some(mut canvas) = room(placement)? else { return Ok(None) };
        budget.spend(placement.area() as u64)?;
        let parts = parts.iter().map(|(model, origin)| (&**model, position(origin, &size, options)));
        draw(&parts, &size, options.sampling.stretch, placement, scratch, &mut canvas, budget)?;
        Ok(Some(placement))
    }

    /// The memory that the models or the network take, in bytes. A model that several glyphs share counts in each of
    /// them.
    pub fn memory(&self) -> usize {
        match &self.drawn {
            Drawn::Outlines(Outlines { parts, advances }) => {
                let parts = parts.iter().map(|(model, part)| model.memory() + part.memory());
                parts.sum::<usize>() + advances.len()
            }
            #[cfg(feature = "fields")]
            Drawn::Fields(parts) => {
                parts.iter().map(|(model, origin)| model.memory() + origin.memory()).sum()
            }
            #[cfg(feature = "networks")]
            Drawn::Network(network) => network.memory(),
        }
    }
}

impl Outlines {
    /// The outlines at a size, with their offsets in 1/64 pixel. None if there are none.
    fn at(
        &self,
        options: DrawOptions,
    ) -> Option<(HintedSize, impl Iterator<Item = (&OutlineModel, [i32; 2])>)> {
        let (first, _) = self.parts.first()?;
        let (size, units) = (options.size(first.scale), first.scale.units_per_em());
        let parts = self.parts.iter().map(move |(model, part)| (&**model, part.offset_at(&size, units)));
        Some((size, parts))
    }

    fn draw<'b>(
        &self,
        kept: &mut Flattened,
        options: DrawOptions,
        scratch: &mut Scratch,
        budget: &mut Budget,
        room: impl FnOnce(Placement) -> Result<Option<Canvas<'b>>, Error>,
    ) -> Result<Option<Placement>, Error> {
        let drawn_as = (options.ppem, options.hinting, options.sampling.stretch);
        if kept.drawn_as == drawn_as {
            return draw_polygons(&kept.polygons, options, scratch, budget, room);
        }
        let Some((size, parts)) = self.at(options) else {
            return Ok(room(Placement::default())?.map(|_| Placement::default()));
        };
        flatten(parts, &size, options.sampling.stretch, scratch, budget)?;
        let polygons = core::mem::take(&mut scratch.polygons);
        if polygons.vertices[0].len() <= MAX_KEPT {
            kept.drawn_as = drawn_as;
            kept.polygons.copy_from(&polygons);
        }
        let drawn = draw_polygons(&polygons, options, scratch, budget, room);
        scratch.polygons = polygons;
        drawn
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
#[cfg(feature = "fields")]
fn position(origin: &Origin, size: &HintedSize, options: DrawOptions) -> [f32; 2] {
    let (at, moved) = (origin.at(size), options.moved());
    [0, 1].map(|axis| at[axis] + moved[axis])
}
