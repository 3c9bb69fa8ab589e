//! All experiments of the paper's evaluation, one after the other, and their results.

use std::time::Instant;

use super::SquareBitmap;
use super::dataset::{CharGlyph, Dataset};
use super::error_table::ErrorRow;
use super::evaluation::{Evaluation, measure};
use super::experiment::Experiment;
use super::family::{FamilyMember, STYLES, WEIGHTS};
use super::implicit::Implicit;
use super::interpolation::{Interpolation, InterpolationTarget, interpolate};
use super::memorisation::{grid_fit, kept, train};
use super::network_variant::{Ablation, NetworkVariant};
use super::pixel_error::pixel_error;
use super::resize::{Method, shrunk, single_wrong_pixel};
use super::stored_network::{cropped, network_weights, render_stored, stored_font};
use nfr::internals::network::Precision;
use nfr_convert::error::Error;

/// The fonts and characters of a study.
pub struct StudyPlan<'s> {
    /// The three fonts of the comparison, the first of which also has the other experiments.
    pub fonts: &'s [Dataset],
    /// Every size of the first font's truth, for what needs no training.
    pub all_sizes: &'s Dataset,
    /// The characters that all models learn.
    pub glyphs: &'s str,
    /// Those of them that are trained first, and shown in pictures.
    pub shown: &'s str,
    /// The characters of the ablations.
    pub ablated: &'s str,
    /// The characters that are stored in a font.
    pub stored: &'s str,
    /// A lighter and a bolder weight, with the sizes in common.
    pub weights: [FamilyMember<'s>; 2],
    /// The weight between them.
    pub between: &'s Dataset,
    /// The characters of the experiment on weights.
    pub weighted: &'s str,
    /// Two typefaces, with the sizes in common.
    pub styles: [FamilyMember<'s>; 2],
    /// The characters of the experiment on typefaces.
    pub styled: &'s str,
}

/// A glyph that a font draws with the paper's network.
#[derive(Debug, Clone)]
pub struct StoredResult {
    /// The character.
    pub glyph: char,
    /// Bits of a weight.
    pub bits: u8,
    /// Bytes of the network in the table.
    pub bytes: usize,
    /// The renderer's bitmaps, against the truth.
    pub evaluation: Evaluation,
    /// The mean squared error of what the network drew before it was stored, in the glyph's box, which is what fonts draw.
    pub mse_before: f64,
}

/// The effect of one wrong pixel on a bitmap.
#[derive(Debug, Clone)]
pub struct WrongPixel {
    /// The character.
    pub glyph: char,
    /// The true bitmap.
    pub truth: SquareBitmap,
    /// The same with one pixel of ink gone.
    pub wrong: SquareBitmap,
    /// Column and row of that pixel.
    pub at: [usize; 2],
    /// Its mean squared error.
    pub mse: f64,
}

/// The results of a study.
#[derive(Debug, Clone, Default)]
pub struct StudyResults {
    /// Masked network, implicit network and grid-fit field, for each font and character.
    pub evaluations: Vec<Evaluation>,
    /// Bytes of each grid-fit field.
    pub grid_fit_bytes: Vec<usize>,
    /// The implicit network without one part, on the first font.
    pub ablations: Vec<Evaluation>,
    /// One network for two weights.
    pub weights: Vec<Interpolation>,
    /// One network for two typefaces.
    pub styles: Vec<Interpolation>,
    /// Networks in fonts.
    pub stored: Vec<StoredResult>,
    /// The largest bitmap, shrunk, against the hinted ones: the model is the method.
    pub resized: Vec<ErrorRow>,
    /// Unhinted bitmaps against hinted ones.
    pub unhinted: Vec<ErrorRow>,
    /// One wrong pixel in the smallest bitmap of some characters.
    pub wrong_pixel: Vec<WrongPixel>,
}

/// The place between two weights or typefaces that is drawn.
pub const SHARE: f64 = 0.5;

/// The name of unhinted bitmaps in tables.
pub const UNHINTED: &str = "unhinted";

impl StudyPlan<'_> {
    /// The results of what is finished, with our own models of the same glyphs beside it. Nothing is trained but these.
    ///
    /// # Errors
    ///
    /// As the experiments'.
    pub fn results(&self, context: &Experiment<'_>) -> Result<StudyResults, Error> {
        // With no time left, what is not finished stays so.
        let context =
            Experiment { resume: true, deadline: Some(Instant::now()), unfinished: true, ..context.clone() };
        let mut results = StudyResults::default();
        self.memorised(&context, &mut results)?;
        let weights = |glyph: char| {
            let target =
                InterpolationTarget { name: &self.between.name, share: SHARE, real: Some(self.between) };
            interpolate(&context, WEIGHTS, &self.weights, target, glyph)
        };
        results.weights = finished(self.weighted.chars().map(weights))?;
        let styles = |glyph: char| {
            let target = InterpolationTarget { name: "between the typefaces", share: SHARE, real: None };
            interpolate(&context, STYLES, &self.styles, target, glyph)
        };
        results.styles = finished(self.styled.chars().map(styles))?;
        self.compare_bitmaps(&mut results)?;
        self.store(&context, &mut results)?;
        Ok(results)
    }

    fn memorised(&self, context: &Experiment<'_>, results: &mut StudyResults) -> Result<(), Error> {
        let models = [NetworkVariant::Implicit(Vec::new()), NetworkVariant::Masked];
        let mut networks = Vec::new();
        for dataset in self.fonts {
            let glyphs = dataset.glyphs(self.glyphs)?;
            let mut known = Vec::new();
            for model in &models {
                let evaluated = glyphs.iter().map(|glyph| train(context, dataset, *glyph, model));
                let evaluated = finished(evaluated)?;
                known.extend(evaluated.iter().map(|one| one.glyph));
                networks.extend(evaluated);
            }
            let ours: Vec<CharGlyph> =
                glyphs.into_iter().filter(|(character, _)| known.contains(character)).collect();
            if ours.is_empty() {
                continue;
            }
            for (evaluation, bytes) in grid_fit(context, dataset, &ours)? {
                results.evaluations.push(evaluation);
                results.grid_fit_bytes.push(bytes);
            }
        }
        results.evaluations.extend(networks);
        let glyphs = self.fonts[0].glyphs(self.ablated)?;
        for part in Ablation::ALL {
            let model = NetworkVariant::Implicit(vec![part]);
            let evaluated = glyphs.iter().map(|glyph| train(context, &self.fonts[0], *glyph, &model));
            results.ablations.extend(finished(evaluated)?);
        }
        Ok(())
    }

    /// Bitmaps without any model: resized ones, unhinted ones, and ones with a wrong pixel.
    fn compare_bitmaps(&self, results: &mut StudyResults) -> Result<(), Error> {
        let dataset = self.all_sizes;
        let sizes = 0..dataset.truth.sizes.len();
        for (glyph, gid) in dataset.glyphs(self.glyphs)? {
            let truth = dataset.squares(gid)?;
            let plain = sizes.clone().map(|size| dataset.truth.plain(gid, size));
            let plain = plain.collect::<Result<Vec<_>, _>>()?;
            results.unhinted.extend(measure(UNHINTED, dataset, glyph, &truth, &plain)?);
            for method in Method::ALL {
                let small = sizes.clone().map(|size| shrunk(&dataset.truth, gid, size, method));
                let small = small.map(|shrunk| Ok(shrunk?.0)).collect::<Result<Vec<_>, Error>>()?;
                results.resized.extend(measure(method.name(), dataset, glyph, &truth, &small)?);
            }
        }
        for (glyph, gid) in dataset.glyphs(self.ablated)? {
            let truth = dataset.truth.hinted(gid, 0)?;
            let (wrong, at) = single_wrong_pixel(&truth);
            let mse = pixel_error(&truth, &wrong)?.mse;
            results.wrong_pixel.extend(at.map(|at| WrongPixel { glyph, truth, wrong, at, mse }));
        }
        Ok(())
    }

    /// Networks in fonts, of those characters whose networks are kept here.
    fn store(&self, context: &Experiment<'_>, results: &mut StudyResults) -> Result<(), Error> {
        let dataset = &self.fonts[0];
        for glyph in dataset.glyphs(self.stored)? {
            if let Some((before, network)) = kept(context, dataset, glyph)? {
                results.stored.extend(store(context, dataset, glyph, &network, &before)?);
            }
        }
        Ok(())
    }
}

/// What is finished of some experiments.
fn finished<T>(all: impl Iterator<Item = Result<T, Error>>) -> Result<Vec<T>, Error> {
    all.filter(|one| !matches!(one, Err(Error::TimeLimit))).collect()
}

/// Stores a network with 16-bit and with 8-bit weights in a font, and draws it from there.
///
/// # Errors
///
/// As [`network_weights`], [`stored_font`] and [`render_stored`].
pub fn store(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyph: CharGlyph,
    network: &Implicit,
    before: &Evaluation,
) -> Result<[StoredResult; 2], Error> {
    let weights = network_weights(network, context.settings.implicit, dataset, glyph)?;
    let visible = cropped(&weights.sizes, &before.drawn);
    let mse_before = Evaluation::new(&before.model, dataset, glyph, visible)?.mse();
    let one = |precision: Precision| {
        let file = stored_font(dataset, &[(glyph, weights.clone())], precision, context.settings.seed)?;
        let (squares, bytes) = render_stored(&file, dataset, glyph)?;
        let bits = precision.bits();
        let evaluation = Evaluation::new(&format!("implicit at {bits} bits"), dataset, glyph, squares)?;
        Ok::<_, Error>(StoredResult { glyph: glyph.0, bits, bytes, evaluation, mse_before })
    };
    Ok([one(Precision::Sixteen)?, one(Precision::Eight)?])
}
