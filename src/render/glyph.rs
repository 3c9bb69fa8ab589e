//! A glyph that is ready to draw: one model, several at places of their own, or a network.

use std::sync::Arc;

use super::draw::{Scratch, draw, draw_one};
use super::{Bitmap, Placement, Setting};
use crate::error::Error;
use crate::model::compose::Origin;
use crate::model::gridfit::{GridFit, MAX_SIDE, Scale};
use crate::model::network::Network;

/// One glyph, decoded and ready to draw: at any size, or, if it is a network, at those that it was trained for.
#[derive(Debug, Clone)]
pub struct Glyph(Kind);

#[derive(Debug, Clone)]
enum Kind {
    Parts(Vec<(Arc<GridFit>, Origin)>),
    Network(Arc<Network>),
}

impl Glyph {
    /// A glyph that has a model of its own.
    pub fn of_model(model: Arc<GridFit>, scale: Scale) -> Self {
        Self(Kind::Parts(vec![(model, Origin::zero(scale))]))
    }

    /// A glyph that is put together from others' models.
    pub fn of_parts(parts: Vec<(Arc<GridFit>, Origin)>) -> Self {
        Self(Kind::Parts(parts))
    }

    /// A glyph that a network draws.
    pub fn of_network(network: Network) -> Self {
        Self(Kind::Network(Arc::new(network)))
    }

    /// The network that draws the glyph, if one does.
    pub fn network(&self) -> Option<&Network> {
        match &self.0 {
            Kind::Parts(_) => None,
            Kind::Network(network) => Some(network),
        }
    }

    /// The first part's model, to be shared with other glyphs.
    pub(super) fn model(&self) -> Option<Arc<GridFit>> {
        match &self.0 {
            Kind::Parts(parts) => parts.first().map(|(model, _)| model.clone()),
            Kind::Network(_) => None,
        }
    }

    /// Where the bitmap lies at a size in pixels per em, or at a [`Setting`].
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for a size that is not a positive number or a pen too far off, `LimitExceeded` for a
    /// bitmap that would be too large, `Unsupported` for a size that the glyph's network was not trained for, or
    /// a network with the pen between pixels.
    pub fn placement(&self, setting: impl Into<Setting>) -> Result<Placement, Error> {
        let setting = setting.into().checked()?;
        let parts = match &self.0 {
            Kind::Parts(parts) => parts,
            Kind::Network(network) => return network.placement(setting),
        };
        let mut whole = Placement::default();
        for (model, origin) in parts {
            whole = union(whole, model.placement_at(setting.ppem, place(origin, setting))?);
        }
        if whole.width > MAX_SIDE || whole.height > MAX_SIDE {
            return Err(Error::LimitExceeded(format!(
                "a bitmap of {}×{} pixels at {} ppem",
                whole.width, whole.height, setting.ppem
            )));
        }
        Ok(whole)
    }

    /// Draws coverage 0–255 into `pixels`, top row first, `placement.width` bytes a row. Bytes beyond the
    /// bitmap are left alone. Once `scratch` has grown, nothing is allocated, but a network allocates each time.
    ///
    /// # Errors
    ///
    /// As `placement`, and `InvalidParameter` for a buffer that is too small.
    pub fn render_into(
        &self,
        setting: impl Into<Setting>,
        scratch: &mut Scratch,
        pixels: &mut [u8],
    ) -> Result<Placement, Error> {
        let setting = setting.into();
        if let Kind::Parts(parts) = &self.0
            && let [(model, origin)] = parts.as_slice()
        {
            let setting = setting.checked()?;
            return draw_one(model, setting.ppem, place(origin, setting), scratch, pixels);
        }
        let placement = self.placement(setting)?;
        let pixels = buffer_for(placement, pixels)?;
        self.draw(setting, placement, scratch, pixels)?;
        Ok(placement)
    }

    /// Draws into a new bitmap.
    ///
    /// # Errors
    ///
    /// As `placement`.
    pub fn render(&self, setting: impl Into<Setting>) -> Result<Bitmap, Error> {
        let setting = setting.into();
        let placement = self.placement(setting)?;
        let mut pixels = vec![0; placement.area()];
        self.draw(setting, placement, &mut Scratch::default(), &mut pixels)?;
        Ok(Bitmap { placement, pixels })
    }

    fn draw(
        &self,
        setting: Setting,
        placement: Placement,
        scratch: &mut Scratch,
        pixels: &mut [u8],
    ) -> Result<(), Error> {
        match &self.0 {
            Kind::Parts(parts) => {
                let parts = parts.iter().map(|(model, origin)| (&**model, place(origin, setting)));
                draw(&parts, setting.ppem, placement, scratch, pixels);
                Ok(())
            }
            Kind::Network(network) => network.draw(setting.ppem, pixels),
        }
    }

    /// The memory that the models or the network take, in bytes. A model that several glyphs share counts in each of
    /// them.
    pub fn memory(&self) -> usize {
        match &self.0 {
            Kind::Parts(parts) => parts.iter().map(|(model, origin)| model.memory() + origin.memory()).sum(),
            Kind::Network(network) => network.memory(),
        }
    }
}

/// Where a part stands, from the pixel that the pen is given from.
fn place(origin: &Origin, setting: Setting) -> [f32; 2] {
    let at = origin.at(setting.ppem);
    [0, 1].map(|axis| at[axis] + setting.pen[axis])
}

/// The box around two bitmaps; one without pixels takes no room.
pub fn union(a: Placement, b: Placement) -> Placement {
    match (a.area(), b.area()) {
        (0, _) => return b,
        (_, 0) => return a,
        _ => {}
    }
    let right = |p: Placement| i64::from(p.left) + i64::from(p.width);
    let bottom = |p: Placement| i64::from(p.top) - i64::from(p.height);
    let (left, top) = (a.left.min(b.left), a.top.max(b.top));
    let length = |length: i64| u32::try_from(length).unwrap_or(u32::MAX);
    Placement {
        left,
        top,
        width: length(right(a).max(right(b)) - i64::from(left)),
        height: length(i64::from(top) - bottom(a).min(bottom(b))),
    }
}

/// The part of a caller's buffer that a bitmap takes.
pub(super) fn buffer_for(placement: Placement, pixels: &mut [u8]) -> Result<&mut [u8], Error> {
    let have = pixels.len();
    pixels.get_mut(..placement.area()).ok_or_else(|| {
        Error::InvalidParameter(format!(
            "a buffer of {have} bytes for a bitmap of {}×{}; ask for the placement first",
            placement.width, placement.height
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Placement = Placement { left: -1, top: 2, width: 2, height: 2 };
    const B: Placement = Placement { left: 0, top: 3, width: 2, height: 2 };

    #[test]
    fn the_union_holds_both_boxes_and_ignores_empty_ones() {
        let empty = Placement { left: 50, top: 50, ..Placement::default() };
        assert_eq!(union(A, B), Placement { left: -1, top: 3, width: 3, height: 3 });
        assert_eq!((union(A, empty), union(empty, B)), (A, B));
    }
}
