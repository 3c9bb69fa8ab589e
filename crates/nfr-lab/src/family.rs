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
use super::network_training::{TrainedNetwork, TrainingRun, train_implicit};
use super::samples::{ImplicitSamples, TrainingSample};
use super::tensors::{fetch, values};
use super::train::checkpoint::Checkpoint;
use super::train::files::TrainingFiles;
use super::train::result::TrainingOrigin;
use super::train::{Epoch, TrainingSchedule};
use super::truth::TruthSize;
use nfr::Font;
use nfr::internals::Glyph;
use nfr::internals::model::compose::Origin;
use nfr::internals::model::gridfit::{GridFit, Scale};
use nfr_convert::error::Error;
use nfr_convert::open::open;

/// The name of the experiment on weights, in paths.
pub const WEIGHTS: &str = "weights";
/// The name of the experiment on typefaces.
pub const STYLES: &str = "styles";

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
    /// Where and how it was trained.
    pub origin: TrainingOrigin,
}

/// A training of one network on a glyph of several fonts, whose truths share their sizes.
pub struct FamilyTask<'t> {
    /// The experiment and the character, as in paths.
    path: [String; 2],
    /// The number of sizes.
    pub sizes: usize,
    samples: Vec<TrainingSample>,
    schedule: TrainingSchedule,
    /// Where it is kept.
    pub files: Option<TrainingFiles>,
    context: &'t Experiment<'t>,
}

impl<'t> FamilyTask<'t> {
    /// The training of a character for an experiment with this name, which draws a share of the way from the first member to
    /// the last.
    ///
    /// # Errors
    ///
    /// As the truth's and [`Experiment::files`]; `InvalidParameter` for a member without the character.
    pub fn new(
        context: &'t Experiment<'t>,
        name: &str,
        members: &[FamilyMember<'_>],
        share: f64,
        glyph: char,
    ) -> Result<Self, Error> {
        let settings = &context.settings;
        let schedule = settings.implicit_schedule(settings.family);
        let mut samples = Vec::new();
        for member in members {
            let gid = glyph_of(member.dataset, glyph)?.1;
            samples.extend(member.dataset.samples(gid, Some(member.weight))?);
        }
        let sizes = samples.len() / members.len().max(1);
        let code = format!("u{:04x}", u32::from(glyph));
        let description = format!("{:?} {schedule:?} {share}", settings.family);
        let files = context.files(&[name, &code], &description, &samples)?;
        Ok(Self { path: [name.to_owned(), code], sizes, samples, schedule, files, context })
    }

    /// The name of its directory, part by part.
    pub fn path(&self) -> [&str; 2] {
        self.path.each_ref().map(String::as_str)
    }

    /// The epochs of the whole training.
    pub fn epochs(&self) -> usize {
        self.schedule.rates.len()
    }

    /// Trains the network, or goes on from its checkpoint.
    ///
    /// # Errors
    ///
    /// As [`train_implicit`].
    pub fn train(&self, checkpoint: Option<&Checkpoint>) -> Result<FamilyNetwork, Error> {
        let Self { context, schedule, sizes, .. } = self;
        let (config, device) = (context.settings.family, context.device());
        let label = self.path.join(" ");
        let on_epoch = |done| (context.on_progress)(&label, done, schedule.rates.len());
        let run = TrainingRun {
            device: &device,
            layout: context.accelerator.layout(),
            checkpoint,
            deadline: context.deadline,
            on_epoch: &on_epoch,
        };
        let TrainedNetwork { network, history, operations, .. } =
            train_implicit(self.samples.clone(), *sizes, config, schedule, run)?;
        let origin = TrainingOrigin::new(&context.accelerator, operations, 1);
        let set = ImplicitSamples::new(self.samples.clone(), *sizes, config, run.layout, &device);
        Ok(FamilyNetwork { network, set, sizes: *sizes, history, origin })
    }
}

impl FamilyNetwork {
    /// The network's bitmap at each size for the member with this number.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a device whose numbers cannot be read, `Device` for one that fails.
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
            let scores = self.network.forward_from(&pixels, latents, Statistics::Batch);
            expected_coverage(scores, pixels.count)
        };
        (0..self.sizes).map(square).collect()
    }
}

/// The bitmap of expected coverage for scores `[side² or more, classes]`: the mean of the classes' levels, each as likely as
/// it is. The paper's code draws families so, and single weights from the likeliest class.
fn expected_coverage(scores: Tensor<2>, count: usize) -> Result<SquareBitmap, Error> {
    let [rows, _] = scores.dims();
    let device = scores.device();
    let levels: Vec<f32> = (0..CLASSES).map(|class| class as f32 * 255.0 / (CLASSES - 1) as f32).collect();
    let levels = Tensor::<1>::from_floats(levels.as_slice(), &device).unsqueeze::<2>();
    let coverage = fetch((softmax(scores, 1) * levels).sum_dim(1))?;
    let mut pixels = values::<f32>(&coverage, rows)?;
    pixels.truncate(count);
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
