//! One model of one glyph of one font: the paper's experiments on memorising.

use super::dataset::{CharGlyph, Dataset};
use super::evaluation::{ClassAccuracy, Evaluation};
use super::experiment::Experiment;
use super::guard::guarded;
use super::implicit::{Implicit, ImplicitConfig};
use super::lockstep::{can_join, train_in_lockstep};
use super::network_training::{TrainedNetwork, TrainingRun, train_implicit, train_masked};
use super::network_variant::{Ablation, GRID_FIT, NetworkVariant};
use super::samples::TrainingSample;
use super::train::checkpoint::Checkpoint;
use super::train::files::TrainingFiles;
use super::train::result::{TrainingOrigin, TrainingResult};
use super::train::{Training, TrainingSchedule};
use super::truth::TruthSize;
use nfr::internals::table::{FNV_BASIS, fnv1a};
use nfr::{Font, Rasterizer};
use nfr_convert::error::Error;
use nfr_convert::{Options, Progress, Shape, convert};

/// The result of training a network on a glyph, or the one that is kept.
///
/// # Errors
///
/// As the truth's and [`Experiment::result`].
pub fn trained(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyph: CharGlyph,
    model: &NetworkVariant,
) -> Result<TrainingResult, Error> {
    let task = Task::new(context, dataset, glyph, model)?;
    let path = task.path();
    context.result(&path, task.files.as_ref(), task.schedule.rates.len(), |checkpoint| match model {
        NetworkVariant::Implicit(_) => Ok(with_network(context, task.implicit(context, checkpoint)?).0),
        NetworkVariant::Masked => {
            let (widths, samples) = (&context.settings.masked_widths, &task.samples);
            let trained =
                task.run(context, checkpoint, |run| train_masked(samples, widths, &task.schedule, run))?;
            Ok(with_network(context, trained).0)
        }
    })
}

/// Trains a network on a glyph, or takes its result, and measures its bitmaps.
///
/// # Errors
///
/// As [`trained`].
pub fn train(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyph: CharGlyph,
    model: &NetworkVariant,
) -> Result<Evaluation, Error> {
    let result = trained(context, dataset, glyph, model)?;
    evaluated(dataset, glyph, model, result)
}

/// A network that has to learn a glyph of a font, and whether it is kept beside its result.
#[derive(Clone)]
pub struct Member<'d> {
    /// The font.
    pub dataset: &'d Dataset,
    /// The glyph.
    pub glyph: CharGlyph,
    /// The network.
    pub model: NetworkVariant,
    /// Whether the network is kept.
    pub keep_network: bool,
}

/// Whether a network can learn in lockstep with others, and its training is not finished.
///
/// # Errors
///
/// As the truth's and the files'.
pub fn is_waiting(context: &Experiment<'_>, member: &Member<'_>) -> Result<bool, Error> {
    let Member { dataset, glyph, model, .. } = member;
    let task = Task::new(context, dataset, *glyph, model)?;
    let joins =
        matches!(model, NetworkVariant::Implicit(_)) && can_join(&context.settings.implicit, &task.config);
    Ok(joins && context.finished(&task.path(), task.files.as_ref())?.is_none())
}

/// Trains the networks of waiting members in lockstep, and keeps what each has come to. Says whether they are finished; if not, the
/// same members go on from there.
///
/// # Errors
///
/// As [`trained`]. The time limit is none.
pub fn train_together(context: &Experiment<'_>, members: &[Member<'_>]) -> Result<bool, Error> {
    let mut tasks = Vec::new();
    for member in members {
        tasks.push(Task::new(context, member.dataset, member.glyph, &member.model)?);
    }
    let Some(first) = tasks.first() else { return Ok(true) };
    if context.is_late() {
        return Ok(false);
    }
    let keys: String =
        tasks.iter().flat_map(|task| &task.files).map(|f| format!("{:016x}", f.key())).collect();
    let name = format!("{:016x}", fnv1a(FNV_BASIS, keys.as_bytes()));
    let files = context.files(&["together", &name], &keys, &[])?;
    let checkpoint = files.as_ref().map(TrainingFiles::checkpoint);
    let label = format!("{} networks in lockstep, from {} on", tasks.len(), first.label);
    let on_epoch = |done| (context.on_progress)(&label, done, first.schedule.rates.len());
    let (device, layout) = (&context.device(), context.accelerator.layout());
    let (checkpoint, deadline) = (checkpoint.as_ref(), context.deadline);
    let run = TrainingRun { device, layout, checkpoint, deadline, on_epoch: &on_epoch };
    let of_networks: Vec<_> = tasks.iter().map(|task| (task.samples.clone(), task.config)).collect();
    let trained = guarded(|| train_in_lockstep(&of_networks, &first.schedule, run))?;
    let mut finished = true;
    for ((task, member), one) in tasks.iter().zip(members).zip(trained) {
        let keeping = context.keeping_networks(member.keep_network);
        let epochs = task.schedule.rates.len();
        if let (Some(files), true) = (&task.files, member.keep_network && one.history.len() >= epochs) {
            files.checkpoint().save(&Training::of(one.network, one.history.clone()))?;
        }
        let origin = TrainingOrigin::new(&context.accelerator, one.operations, members.len());
        let result = TrainingResult { origin, history: one.history, drawn: one.drawn };
        finished &= keeping.keep(task.files.as_ref(), epochs, &result)?;
    }
    if let (Some(files), true) = (files, finished) {
        files.discard()?;
    }
    Ok(finished)
}

/// Trains an implicit network on a glyph, or goes on from its checkpoint, and returns the network too.
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
    let model = NetworkVariant::Implicit(without.to_vec());
    let task = Task::new(context, dataset, glyph, &model)?;
    let checkpoint = task.files.as_ref().map(TrainingFiles::checkpoint);
    let trained = guarded(|| task.implicit(context, checkpoint.as_ref()))?;
    let (result, network) = with_network(context, trained);
    let finished = result.history.len() >= task.schedule.rates.len();
    match &task.files {
        Some(files) if finished => files.finish(&result, true)?,
        Some(files) => files.leave(&result)?,
        None => (),
    }
    if !finished {
        return Err(Error::TimeLimit);
    }
    Ok((evaluated(dataset, glyph, &model, result)?, network))
}

/// A finished implicit network whose checkpoint is kept, and what it draws.
///
/// # Errors
///
/// As [`implicit`].
pub fn kept(
    context: &Experiment<'_>,
    dataset: &Dataset,
    glyph: CharGlyph,
) -> Result<Option<(Evaluation, Implicit)>, Error> {
    let task = Task::new(context, dataset, glyph, &NetworkVariant::Implicit(Vec::new()))?;
    let Some(files) = &task.files else { return Ok(None) };
    if !files.checkpoint().path().exists() || files.finished(&[])?.is_none() {
        return Ok(None);
    }
    implicit(context, dataset, glyph, &[]).map(Some)
}

/// A training of a network on a glyph.
struct Task<'t> {
    model: String,
    font: &'t str,
    /// The character, as in paths.
    code: String,
    config: ImplicitConfig,
    schedule: TrainingSchedule,
    samples: Vec<TrainingSample>,
    files: Option<TrainingFiles>,
    label: String,
}

impl<'t> Task<'t> {
    fn new(
        context: &Experiment<'_>,
        dataset: &'t Dataset,
        glyph: CharGlyph,
        model: &NetworkVariant,
    ) -> Result<Self, Error> {
        let settings = &context.settings;
        let parts = match model {
            NetworkVariant::Implicit(parts) => parts.as_slice(),
            NetworkVariant::Masked => &[],
        };
        let config = parts.iter().fold(settings.implicit, |config, part| part.apply(config));
        let (schedule, layers) = match model {
            NetworkVariant::Implicit(_) => (settings.implicit_schedule(config), format!("{config:?}")),
            NetworkVariant::Masked => (settings.masked_schedule(), format!("{:?}", settings.masked_widths)),
        };
        let samples = dataset.samples(glyph.1, None)?;
        let (model, code) = (model.name(), format!("u{:04x}", u32::from(glyph.0)));
        let description = format!("{layers} {schedule:?}");
        let files = context.files(&[&model, &dataset.name, &code], &description, &samples)?;
        let label = format!("{model} {} {:?}", dataset.name, glyph.0);
        Ok(Self { model, font: &dataset.name, code, config, schedule, samples, files, label })
    }

    fn path(&self) -> [&str; 3] {
        [&self.model, self.font, &self.code]
    }

    fn run<R>(
        &self,
        context: &Experiment<'_>,
        checkpoint: Option<&Checkpoint>,
        train: impl FnOnce(TrainingRun<'_>) -> R,
    ) -> R {
        let on_epoch = |done| (context.on_progress)(&self.label, done, self.schedule.rates.len());
        let device = &context.device();
        let layout = context.accelerator.layout();
        train(TrainingRun { device, layout, checkpoint, deadline: context.deadline, on_epoch: &on_epoch })
    }

    fn implicit(
        &self,
        context: &Experiment<'_>,
        checkpoint: Option<&Checkpoint>,
    ) -> Result<TrainedNetwork<Implicit>, Error> {
        let samples = self.samples.clone();
        let sizes = samples.len();
        self.run(context, checkpoint, |run| train_implicit(samples, sizes, self.config, &self.schedule, run))
    }
}

/// A finished training as its result and its network.
pub(super) fn with_network<N>(context: &Experiment<'_>, trained: TrainedNetwork<N>) -> (TrainingResult, N) {
    let TrainedNetwork { network, history, operations, drawn } = trained;
    let origin = TrainingOrigin::new(&context.accelerator, operations, 1);
    (TrainingResult { origin, history, drawn }, network)
}

/// Measures the bitmaps of a training's result.
fn evaluated(
    dataset: &Dataset,
    glyph: CharGlyph,
    model: &NetworkVariant,
    result: TrainingResult,
) -> Result<Evaluation, Error> {
    let evaluation = Evaluation::new(&model.name(), dataset, glyph, result.drawn)?;
    let class_accuracy = match model {
        NetworkVariant::Implicit(_) => Some(ClassAccuracy::new(&evaluation.truth, &evaluation.drawn)?),
        NetworkVariant::Masked => None,
    };
    Ok(Evaluation { history: result.history, origin: Some(result.origin), class_accuracy, ..evaluation })
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
