//! One model of one glyph of one font: the paper's experiments on memorising.

use super::dataset::{CharGlyph, Dataset};
use super::evaluation::{ClassAccuracy, Evaluation};
use super::experiment::Experiment;
use super::implicit::Implicit;
use super::network_training::{TrainedNetwork, train_implicit, train_masked};
use super::network_variant::{Ablation, GRID_FIT, NetworkVariant};
use super::truth::TruthSize;
use nfr::{Font, Rasterizer};
use nfr_convert::error::Error;
use nfr_convert::{Options, Progress, Shape, convert};

/// Trains a network on a glyph, or takes a finished training from its checkpoint.
///
/// # Errors
///
/// As the truth's and the checkpoint's.
pub fn train(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyph: CharGlyph,
    model: &NetworkVariant,
) -> Result<Evaluation, Error> {
    match model {
        NetworkVariant::Implicit(without) => {
            implicit(context, dataset, glyph, without).map(|(evaluation, _)| evaluation)
        }
        NetworkVariant::Masked => masked(context, dataset, glyph),
    }
}

/// Trains an implicit network on a glyph, and returns the network too.
///
/// # Errors
///
/// As [`train`].
pub fn implicit(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyph: CharGlyph,
    without: &[Ablation],
) -> Result<(Evaluation, Implicit), Error> {
    let settings = &context.settings;
    let name = NetworkVariant::Implicit(without.to_vec()).name();
    let config = without.iter().fold(settings.implicit, |config, part| part.apply(config));
    let schedule = settings.implicit_schedule(config);
    let samples = dataset.samples(glyph.1, None)?;
    let code = format!("u{:04x}", u32::from(glyph.0));
    let description = format!("{config:?} {schedule:?}");
    let checkpoint = context.checkpoint(&[&name, &dataset.name, &code], &description, &samples)?;
    let label = format!("{name} {} {:?}", dataset.name, glyph.0);
    let on_epoch = |done| (context.on_progress)(&label, done, schedule.rates.len());
    let sizes = samples.len();
    let TrainedNetwork { network, history, drawn } =
        train_implicit(samples, sizes, config, &schedule, &context.device, checkpoint.as_ref(), &on_epoch)?;
    let evaluation = Evaluation { history, ..Evaluation::new(&name, dataset, glyph, drawn)? };
    Ok((
        Evaluation {
            class_accuracy: Some(ClassAccuracy::new(&evaluation.truth, &evaluation.drawn)?),
            ..evaluation
        },
        network,
    ))
}

fn masked(context: &Experiment<'_>, dataset: &Dataset, glyph: CharGlyph) -> Result<Evaluation, Error> {
    let settings = &context.settings;
    let name = NetworkVariant::Masked.name();
    let schedule = settings.masked_schedule();
    let samples = dataset.samples(glyph.1, None)?;
    let code = format!("u{:04x}", u32::from(glyph.0));
    let description = format!("{:?} {schedule:?}", settings.masked_widths);
    let checkpoint = context.checkpoint(&[&name, &dataset.name, &code], &description, &samples)?;
    let label = format!("{name} {} {:?}", dataset.name, glyph.0);
    let on_epoch = |done| (context.on_progress)(&label, done, schedule.rates.len());
    let widths = &settings.masked_widths;
    let TrainedNetwork { history, drawn, .. } =
        train_masked(&samples, widths, &schedule, &context.device, checkpoint.as_ref(), &on_epoch)?;
    Ok(Evaluation { history, ..Evaluation::new(&name, dataset, glyph, drawn)? })
}

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// A font of grid-fit fields for some glyphs of a dataset, trained at the sizes of its truth.
///
/// # Errors
///
/// As [`convert`].
pub fn grid_fit_font(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyphs: &[CharGlyph],
) -> Result<Vec<u8>, Error> {
    let ppem = dataset.truth.sizes.iter().map(|size| size.ppem);
    let (first, last) = (ppem.clone().min().unwrap_or(1), ppem.max().unwrap_or(1));
    let mut gids: Vec<u16> = glyphs.iter().map(|(_, gid)| *gid).collect();
    gids.sort_unstable();
    gids.dedup();
    let options = Options {
        gids,
        ppem: first..=last,
        jobs: context.jobs,
        compose: false,
        shape: Shape::Field,
        ..Options::default()
    };
    Ok(convert(&dataset.data, &options, &Silent)?.font)
}

/// Our own model of some glyphs: a grid-fit field with the default options, and the bytes that each takes.
///
/// # Errors
///
/// As [`convert`] and the renderer's.
pub fn grid_fit(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyphs: &[CharGlyph],
) -> Result<Vec<(Evaluation, usize)>, Error> {
    let file = grid_fit_font(context, dataset, glyphs)?;
    let font = Font::new(file)?;
    let mut rasterizer = Rasterizer::new(&font);
    let evaluation = |glyph: &CharGlyph| {
        let draw =
            |size: &TruthSize| Ok(size.square(&rasterizer.render(glyph.1.into(), f32::from(size.ppem))?));
        let drawn = dataset.truth.sizes.iter().map(draw).collect::<Result<Vec<_>, Error>>()?;
        Ok((Evaluation::new(GRID_FIT, dataset, *glyph, drawn)?, font.model_len(glyph.1.into())?))
    };
    glyphs.iter().map(evaluation).collect()
}
