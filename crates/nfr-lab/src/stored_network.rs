//! The paper's network in a font: stored in `Nfrt`, and drawn by the renderer.

use burn::nn::Linear;
use burn::tensor::Tensor;

use super::SquareBitmap;
use super::dataset::{CharGlyph, Dataset};
use super::implicit::{Implicit, ImplicitConfig};
use super::network_font::{pack, with_networks};
use super::tensors::{fetch, values};
use super::truth::TruthSize;
use nfr::internals::network::Precision;
use nfr::internals::network::{Architecture, CONDITIONED, Dense, NetworkSize, NetworkWeights, Norm};
use nfr::internals::table::Header;
use nfr::{Font, Limits, Rasterizer};
use nfr_convert::error::Error;

/// The layout that a font stores, from the network's configuration.
///
/// # Errors
///
/// `Unsupported` for a network whose drawing needs more than its weights and the bitmap's size: one for a family, or one
/// without the memorisation adaptations.
pub fn architecture(config: ImplicitConfig) -> Result<Architecture, Error> {
    let refuse = |what: &str| Err(Error::Unsupported(format!("a network {what} cannot be stored in a font")));
    if config.weight {
        return refuse("that is told the weight");
    }
    if !config.memorisation {
        return refuse("without the memorisation adaptations");
    }
    let width = |width: usize| {
        u16::try_from(width).map_err(|_| Error::LimitExceeded(format!("a layer of {width} features")))
    };
    let conditioned = |of: usize| if config.size { width(of) } else { Ok(0) };
    Ok(Architecture {
        width: width(config.width)?,
        latent: conditioned(config.latent)?,
        encoder: conditioned(config.encoder)?,
        frequencies: config.frequencies,
        residual: config.residual,
    })
}

/// A trained network's numbers as the table stores them.
///
/// # Errors
///
/// As [`architecture`], and for a box or a glyph beyond the table's limits.
pub fn network_weights(
    network: &Implicit,
    config: ImplicitConfig,
    dataset: &Dataset,
    glyph: CharGlyph,
) -> Result<NetworkWeights, Error> {
    let architecture = architecture(config)?;
    let (encoder, trunk, from_latent, output) = network.layers();
    let conditioned = |k: usize| {
        let at = CONDITIONED.iter().position(|layer| *layer == k)?;
        from_latent.get(at)
    };
    let trunk = trunk.iter().enumerate().map(|(k, layer)| dense(layer, conditioned(k)));
    let layers = encoder.iter().map(|layer| dense(layer, None)).chain(trunk).chain([dense(output, None)]);
    let norms = network
        .norms()
        .iter()
        .map(|norm| Ok(Norm { gamma: numbers(norm.gamma.val())?, beta: numbers(norm.beta.val())? }));
    let stored = NetworkWeights {
        architecture,
        sizes: (0..dataset.truth.sizes.len()).map(|k| size(dataset, glyph, k)).collect::<Result<_, _>>()?,
        dense: layers.collect::<Result<_, _>>()?,
        norms: norms.collect::<Result<_, Error>>()?,
    };
    stored.check()?;
    Ok(stored)
}

fn size(dataset: &Dataset, (_, gid): CharGlyph, index: usize) -> Result<NetworkSize, Error> {
    let (size, bitmap) = (&dataset.truth.sizes[index], dataset.truth.bitmap(gid, index)?);
    let place = bitmap.placement;
    let [left, top] = size.corner(&place);
    let byte = |value: i64| {
        u8::try_from(value).map_err(|_| {
            Error::LimitExceeded(format!("a box of {} pixels is too large to be stored", size.side))
        })
    };
    let place = [left.into(), top.into(), place.width.into(), place.height.into()];
    let [left, top, width, height] = place.map(byte);
    let origin = size.origin().map(|coordinate| coordinate as i16);
    Ok(NetworkSize {
        ppem: size.ppem,
        side: byte(size.side as i64)?,
        origin,
        crop: [left?, top?, width?, height?],
    })
}

/// A layer; the rows of its share of the latent vector come last, as those of concatenated inputs.
fn dense(layer: &Linear, from_latent: Option<&Linear>) -> Result<Dense, Error> {
    let [inputs, outputs] = layer.weight.dims();
    let mut dense = Dense {
        inputs,
        outputs,
        weights: numbers(layer.weight.val())?,
        bias: layer.bias.as_ref().map_or_else(|| Ok(vec![0.0; outputs]), |bias| numbers(bias.val()))?,
    };
    if let Some(share) = from_latent {
        dense.inputs += share.weight.dims()[0];
        dense.weights.extend(numbers(share.weight.val())?);
    }
    Ok(dense)
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Result<Vec<f32>, Error> {
    let count = tensor.dims().iter().product();
    values(&fetch(tensor)?, count)
}

/// A network's bitmaps as a font shows them: blank outside the box of the hinted glyph, which is what is drawn.
pub fn cropped(sizes: &[NetworkSize], drawn: &[SquareBitmap]) -> Vec<SquareBitmap> {
    let crop = |(size, square): (&NetworkSize, &SquareBitmap)| {
        let [left, top, width, height] = size.crop.map(usize::from);
        let mut pixels = vec![0; square.pixels.len()];
        for row in top..top + height {
            let line = row * square.side + left..row * square.side + left + width;
            pixels[line.clone()].copy_from_slice(&square.pixels[line]);
        }
        SquareBitmap { side: square.side, pixels }
    };
    sizes.iter().zip(drawn).map(crop).collect()
}

/// A font that draws some glyphs of a dataset with networks.
///
/// # Errors
///
/// As [`pack`] and [`with_networks`].
pub fn stored_font(
    dataset: &Dataset,
    networks: &[(CharGlyph, NetworkWeights)],
    precision: Precision,
    seed: u64,
) -> Result<Vec<u8>, Error> {
    let packed = networks.iter().map(|((_, gid), weights)| pack(*gid, weights, precision));
    let mut networks = packed.collect::<Result<Vec<_>, _>>()?;
    networks.sort_by_key(|network| network.gid);
    networks.dedup_by_key(|network| network.gid);
    with_networks(&dataset.data, 0, &networks, &Header { seed, ..Header::default() })
}

/// The bitmaps that a font with networks draws at the sizes of its dataset's truth, through the library's call that
/// draws any model, and the bytes that its network takes. Boxes of one size in pixels per em show the same bitmap.
///
/// # Errors
///
/// As the renderer's.
pub fn render_stored(
    file: &[u8],
    dataset: &Dataset,
    (_, gid): CharGlyph,
) -> Result<(Vec<SquareBitmap>, usize), Error> {
    let font = Font::new(file.to_vec())?;
    // The networks are our own, and may be as wide as the paper's.
    let mut limits = Limits::default();
    (limits.decoded_bytes, limits.work) = (usize::MAX, u64::MAX);
    let mut rasterizer = Rasterizer::new(&font).with_limits(limits);
    let square = |size: &TruthSize| Ok(size.square(&rasterizer.render(gid.into(), f32::from(size.ppem))?));
    let squares = dataset.truth.sizes.iter().map(square).collect::<Result<_, Error>>()?;
    Ok((squares, font.model_len(gid.into())?))
}
