//! One network for several weights of a family, or for several typefaces, and its bitmaps between them.

use burn::tensor::Tensor;
use burn::tensor::activation::softmax;
use read_fonts::TableProvider;

use super::SquareBitmap;
use super::classes::CLASSES;
use super::dataset::{CharGlyph, Dataset};
use super::experiment::Experiment;
use super::gridfit_interpolation::interpolate_weights;
use super::implicit::{Implicit, Pixels, Statistics};
use super::memorisation::grid_fit_font;
use super::network_training::{TrainedNetwork, train_implicit};
use super::samples::ImplicitSamples;
use super::tensors::values;
use super::train::Epoch;
use super::truth::TruthSize;
use nfr::Font;
use nfr::internals::Glyph;
use nfr::internals::model::compose::Origin;
use nfr::internals::model::gridfit::{GridFit, Scale};
use nfr_convert::error::Error;
use nfr_convert::open::open;

/// A font of a family, and the condition that stands for it.
pub struct FamilyMember<'s> {
    /// The font.
    pub dataset: &'s Dataset,
    /// Its weight, or its place among typefaces.
    pub weight: f64,
}

/// `usWeightClass` of a font in thousands: 0.4 is regular, 0.7 bold.
///
/// # Errors
///
/// `Malformed` for a font without a table 'OS/2'.
pub fn weight_of(data: &[u8]) -> Result<f64, Error> {
    let os2 =
        open(data, 0)?.os2().map_err(|e| Error::Malformed(format!("table 'OS/2' cannot be read ({e})")))?;
    Ok(f64::from(os2.us_weight_class()) / 1000.0)
}

/// A trained network of a family.
pub struct FamilyNetwork {
    network: Implicit,
    set: ImplicitSamples,
    /// The number of sizes.
    sizes: usize,
    /// Its epochs.
    pub history: Vec<Epoch>,
}

/// Trains one network on a glyph of all members, whose truths share their sizes. `name` is that of the experiment.
///
/// # Errors
///
/// As the truth's and the checkpoint's; `InvalidParameter` for a member without the character.
pub fn train(
    context: &Experiment<'_>,
    name: &str,
    members: &[FamilyMember<'_>],
    glyph: char,
) -> Result<FamilyNetwork, Error> {
    let settings = &context.settings;
    let config = settings.family;
    let schedule = settings.implicit_schedule(config);
    let mut samples = Vec::new();
    for member in members {
        let gid = glyph_of(member.dataset, glyph)?.1;
        samples.extend(member.dataset.samples(gid, Some(member.weight))?);
    }
    let sizes = samples.len() / members.len().max(1);
    let code = format!("u{:04x}", u32::from(glyph));
    let checkpoint = context.checkpoint(&[name, &code], &format!("{config:?} {schedule:?}"), &samples)?;
    let label = format!("{name} {glyph:?}");
    let on_epoch = |done| (context.on_progress)(&label, done, schedule.rates.len());
    let TrainedNetwork { network, history, .. } = train_implicit(
        samples.clone(),
        sizes,
        config,
        &schedule,
        &context.device,
        checkpoint.as_ref(),
        &on_epoch,
    )?;
    Ok(FamilyNetwork {
        network,
        set: ImplicitSamples::new(samples, sizes, config, &context.device),
        sizes,
        history,
    })
}

impl FamilyNetwork {
    /// The network's bitmap at each size for the member with this number.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a device whose numbers cannot be read.
    pub fn member(&self, number: usize) -> Result<Vec<SquareBitmap>, Error> {
        self.draw(number, |_, pixels| {
            pixels.weights.clone().map(|weights| self.network.weight_latents(weights))
        })
    }

    /// The network's bitmap at each size from the latent vector a share `t` of the way from one member's to
    /// another's.
    ///
    /// # Errors
    ///
    /// As [`Self::member`].
    pub fn between(&self, from: usize, to: usize, t: f64) -> Result<Vec<SquareBitmap>, Error> {
        let latents = |number: usize, size: usize| {
            let (pixels, _) = self.set.batch(&[number * self.sizes + size]);
            pixels.weights.map(|weights| self.network.weight_latents(weights))
        };
        self.draw(from, |size, _| Some(latents(from, size)? * (1.0 - t) + latents(to, size)? * t))
    }

    fn draw(
        &self,
        number: usize,
        of_weights: impl Fn(usize, &Pixels) -> Option<Tensor<2>>,
    ) -> Result<Vec<SquareBitmap>, Error> {
        let square = |size: usize| {
            let (pixels, _) = self.set.batch(&[number * self.sizes + size]);
            let latents = of_weights(size, &pixels);
            expected_coverage(self.network.forward_from(&pixels, latents, Statistics::Batch))
        };
        (0..self.sizes).map(square).collect()
    }
}

/// The bitmap of expected coverage for scores `[side², classes]`: the mean of the classes' levels, each as likely as
/// it is. The paper's code draws families so, and single weights from the likeliest class.
fn expected_coverage(scores: Tensor<2>) -> Result<SquareBitmap, Error> {
    let [pixels, _] = scores.dims();
    let device = scores.device();
    let levels: Vec<f32> = (0..CLASSES).map(|class| class as f32 * 255.0 / (CLASSES - 1) as f32).collect();
    let levels = Tensor::<1>::from_floats(levels.as_slice(), &device).unsqueeze::<2>();
    let coverage = (softmax(scores, 1) * levels).sum_dim(1).into_data();
    let pixels = values::<f32>(&coverage, pixels)?;
    Ok(SquareBitmap {
        side: pixels.len().isqrt(),
        pixels: pixels.into_iter().map(|v| v.round() as u8).collect(),
    })
}

/// The glyph of a character.
fn glyph_of(dataset: &Dataset, glyph: char) -> Result<CharGlyph, Error> {
    dataset.glyphs(glyph.encode_utf8(&mut [0; 4]))?.pop().ok_or(Error::MissingGlyph(0))
}

/// Our own models of a glyph of two fonts, and what lies between them.
pub struct GridFitPair {
    files: [Vec<u8>; 2],
    gids: [u16; 2],
}

impl GridFitPair {
    /// Trains both models.
    ///
    /// # Errors
    ///
    /// As [`grid_fit_font`]'s; `InvalidParameter` for a font without the character.
    pub fn train(context: &Experiment<'_>, ends: [&Dataset; 2], glyph: char) -> Result<Self, Error> {
        let glyphs = [glyph_of(ends[0], glyph)?, glyph_of(ends[1], glyph)?];
        let files =
            [grid_fit_font(context, ends[0], &glyphs[..1])?, grid_fit_font(context, ends[1], &glyphs[1..])?];
        Ok(Self { files, gids: glyphs.map(|(_, gid)| gid) })
    }

    /// The bitmaps a share `t` of the way from the first model to the second, in boxes of `dataset`'s truth. `snap`
    /// puts knots that both models have on whole pixels on whole pixels.
    ///
    /// # Errors
    ///
    /// As the renderer's.
    pub fn between(&self, dataset: &Dataset, t: f64, snap: bool) -> Result<Vec<SquareBitmap>, Error> {
        let (a, scale) = self.weights(0)?;
        let (b, _) = self.weights(1)?;
        let model = GridFit::new(&interpolate_weights(&a, &b, t, scale, snap), scale)?;
        let glyph = Glyph::of_models(vec![(model.into(), Origin::default())]);
        let draw = |size: &TruthSize| Ok(size.square(&glyph.render(f32::from(size.ppem))?));
        dataset.truth.sizes.iter().map(draw).collect()
    }

    fn weights(&self, end: usize) -> Result<(nfr::internals::model::gridfit::Weights, Scale), Error> {
        let font = Font::new(self.files[end].clone())?;
        let scale = nfr::internals::scale(&font);
        Ok((nfr::internals::table(&font)?.weights(self.gids[end].into(), scale, usize::MAX)?, scale))
    }
}
