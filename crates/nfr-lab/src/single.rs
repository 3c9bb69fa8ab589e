//! One model of one glyph of one font: the paper's experiments on memorising.

use super::Square;
use super::bench::{Bench, Glyph, Subject};
use super::classes::rounded;
use super::error::{ErrorRow, PixelError, pixel_error};
use super::implicit::{Implicit, ImplicitConfig};
use super::learn::{self, Learnt};
use super::train::Epoch;
use super::truth::TruthSize;
use nfr::{Font, Rasterizer};
use nfr_convert::error::Error;
use nfr_convert::{Options, Progress, convert};

/// What is left out of the implicit network or its training.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ablation {
    /// The frequency encoding: places and sizes are seen as they are.
    Frequencies,
    /// The memorisation adaptations: batches mix bitmaps, drawing uses running statistics.
    Memorisation,
    /// The residual additions.
    Residuals,
    /// The size as an input, as in the published code for one weight.
    Size,
}

impl Ablation {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Frequencies, Self::Memorisation, Self::Residuals, Self::Size];

    /// The name on the command line, and in tables after "without".
    pub fn name(self) -> &'static str {
        match self {
            Self::Frequencies => "frequencies",
            Self::Memorisation => "memorisation",
            Self::Residuals => "residuals",
            Self::Size => "size",
        }
    }

    /// The network without it.
    pub fn apply(self, config: ImplicitConfig) -> ImplicitConfig {
        match self {
            Self::Frequencies => ImplicitConfig { frequencies: false, ..config },
            Self::Memorisation => ImplicitConfig { memorisation: false, ..config },
            Self::Residuals => ImplicitConfig { residual: false, ..config },
            Self::Size => ImplicitConfig { size: false, ..config },
        }
    }
}

impl std::str::FromStr for Ablation {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|ablation| ablation.name() == name);
        found
            .ok_or_else(|| format!("unknown part {name:?}; use frequencies, memorisation, residuals or size"))
    }
}

/// Which model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Model {
    /// The implicit network, without some parts.
    Implicit(Vec<Ablation>),
    /// The masked network.
    Masked,
}

impl Model {
    /// The name in tables and paths.
    pub fn name(&self) -> String {
        match self {
            Self::Masked => "masked".into(),
            Self::Implicit(without) if without.is_empty() => "implicit".into(),
            Self::Implicit(without) => {
                let parts: Vec<&str> = without.iter().map(|ablation| ablation.name()).collect();
                format!("implicit without {}", parts.join(" and "))
            }
        }
    }
}

/// The grid-fit field's name in tables.
pub const GRID_FIT: &str = "grid-fit";

/// What a model makes of one glyph.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The model's name.
    pub model: String,
    /// The font's name.
    pub font: String,
    /// The character.
    pub glyph: char,
    /// The epochs of its training; none for our own model.
    pub history: Vec<Epoch>,
    /// Its bitmap for each size.
    pub drawn: Vec<Square>,
    /// The true ones.
    pub truth: Vec<Square>,
    /// How wrong it is at each size.
    pub rows: Vec<ErrorRow>,
    /// Of a network that chooses classes, what its choices are worth.
    pub choices: Option<Choices>,
}

/// How many pixels of a network's bitmaps have the right class, and what being right would give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choices {
    /// Pixels of all bitmaps.
    pub pixels: usize,
    /// Those in a wrong class.
    pub wrong: usize,
    /// The mean squared error over all sizes against the right classes, which is what the network is asked for.
    pub mse: f64,
    /// That of the right classes against the truth: what rounding takes.
    pub rounding: f64,
}

impl Choices {
    /// Counts the choices of a network that drew these bitmaps of the true ones.
    ///
    /// # Errors
    ///
    /// As [`pixel_error`].
    pub fn new(truth: &[Square], drawn: &[Square]) -> Result<Self, Error> {
        let (mut pixels, mut wrong, mut mse, mut rounding) = (0, 0, 0.0, 0.0);
        for (truth, drawn) in truth.iter().zip(drawn) {
            let right = rounded(truth);
            pixels += right.pixels.len();
            wrong += right.pixels.iter().zip(&drawn.pixels).filter(|(right, drawn)| right != drawn).count();
            mse += pixel_error(&right, drawn)?.mse;
            rounding += pixel_error(truth, &right)?.mse;
        }
        let sizes = truth.len().max(1) as f64;
        Ok(Self { pixels, wrong, mse: mse / sizes, rounding: rounding / sizes })
    }
}

impl Outcome {
    /// Measures bitmaps, one for each size of the subject's truth.
    ///
    /// # Errors
    ///
    /// As [`pixel_error`] and [`Subject::squares`].
    pub fn new(model: &str, subject: &Subject, glyph: Glyph, drawn: Vec<Square>) -> Result<Self, Error> {
        let truth = subject.squares(glyph.1)?;
        let rows = measure(model, subject, glyph.0, &truth, &drawn)?;
        Ok(Self {
            rows,
            model: model.to_owned(),
            font: subject.name.clone(),
            glyph: glyph.0,
            history: Vec::new(),
            choices: None,
            drawn,
            truth,
        })
    }

    /// The mean squared error over all sizes.
    pub fn mse(&self) -> f64 {
        self.rows.iter().map(|row| row.mse).sum::<f64>() / self.rows.len().max(1) as f64
    }

    /// The mean absolute error over all sizes.
    pub fn mae(&self) -> f64 {
        self.rows.iter().map(|row| row.mae).sum::<f64>() / self.rows.len().max(1) as f64
    }

    /// Seconds that its training took, in epochs that this or earlier runs trained.
    pub fn seconds(&self) -> f64 {
        self.history.iter().map(|epoch| epoch.seconds).sum()
    }
}

/// Measures a model's bitmaps against the true ones, a row for each size of the subject's truth.
///
/// # Errors
///
/// As [`pixel_error`].
pub fn measure(
    model: &str,
    subject: &Subject,
    glyph: char,
    truth: &[Square],
    drawn: &[Square],
) -> Result<Vec<ErrorRow>, Error> {
    let row = |((size, truth), drawn): ((&TruthSize, &Square), &Square)| {
        let PixelError { mse, mae, bad16 } = pixel_error(truth, drawn)?;
        let (model, font) = (model.to_owned(), subject.name.clone());
        Ok(ErrorRow { model, font, glyph, side: size.side, ppem: size.ppem, mse, mae, bad16 })
    };
    subject.truth.sizes.iter().zip(truth).zip(drawn).map(row).collect()
}

/// Trains a network on a glyph, or takes a training that is there already.
///
/// # Errors
///
/// As the truth's and the checkpoint's.
pub fn train(bench: &Bench<'_>, subject: &Subject, glyph: Glyph, model: &Model) -> Result<Outcome, Error> {
    match model {
        Model::Implicit(without) => implicit(bench, subject, glyph, without).map(|(outcome, _)| outcome),
        Model::Masked => masked(bench, subject, glyph),
    }
}

/// Trains an implicit network on a glyph, and gives it too.
///
/// # Errors
///
/// As [`train`].
pub fn implicit(
    bench: &Bench<'_>,
    subject: &Subject,
    glyph: Glyph,
    without: &[Ablation],
) -> Result<(Outcome, Implicit), Error> {
    let settings = &bench.settings;
    let name = Model::Implicit(without.to_vec()).name();
    let config = without.iter().fold(settings.implicit, |config, part| part.apply(config));
    let course = settings.implicit_course(config);
    let samples = subject.samples(glyph.1, None)?;
    let code = format!("u{:04x}", u32::from(glyph.0));
    let described = format!("{config:?} {course:?}");
    let checkpoint = bench.checkpoint(&[&name, &subject.name, &code], &described, &samples)?;
    let label = format!("{name} {} {:?}", subject.name, glyph.0);
    let tell = |done| (bench.tell)(&label, done, course.rates.len());
    let sizes = samples.len();
    let Learnt { network, history, drawn } =
        learn::implicit(samples, sizes, config, &course, &bench.device, checkpoint.as_ref(), &tell)?;
    let outcome = Outcome { history, ..Outcome::new(&name, subject, glyph, drawn)? };
    Ok((Outcome { choices: Some(Choices::new(&outcome.truth, &outcome.drawn)?), ..outcome }, network))
}

fn masked(bench: &Bench<'_>, subject: &Subject, glyph: Glyph) -> Result<Outcome, Error> {
    let settings = &bench.settings;
    let name = Model::Masked.name();
    let course = settings.masked_course();
    let samples = subject.samples(glyph.1, None)?;
    let code = format!("u{:04x}", u32::from(glyph.0));
    let described = format!("{:?} {course:?}", settings.masked_widths);
    let checkpoint = bench.checkpoint(&[&name, &subject.name, &code], &described, &samples)?;
    let label = format!("{name} {} {:?}", subject.name, glyph.0);
    let tell = |done| (bench.tell)(&label, done, course.rates.len());
    let widths = &settings.masked_widths;
    let Learnt { history, drawn, .. } =
        learn::masked(&samples, widths, &course, &bench.device, checkpoint.as_ref(), &tell)?;
    Ok(Outcome { history, ..Outcome::new(&name, subject, glyph, drawn)? })
}

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// A font of grid-fit fields for some glyphs of a subject, trained at the sizes of its truth.
///
/// # Errors
///
/// As [`convert`].
pub fn grid_fit_font(bench: &Bench<'_>, subject: &Subject, glyphs: &[Glyph]) -> Result<Vec<u8>, Error> {
    let ppem = subject.truth.sizes.iter().map(|size| size.ppem);
    let (first, last) = (ppem.clone().min().unwrap_or(1), ppem.max().unwrap_or(1));
    let mut gids: Vec<u16> = glyphs.iter().map(|(_, gid)| *gid).collect();
    gids.sort_unstable();
    gids.dedup();
    let options =
        Options { gids, ppem: first..=last, jobs: bench.jobs, compose: false, ..Options::default() };
    Ok(convert(&subject.data, &options, &Silent)?.font)
}

/// Our own model of some glyphs: a grid-fit field with the default options, and the bytes that each takes.
///
/// # Errors
///
/// As [`convert`] and the renderer's.
pub fn grid_fit(
    bench: &Bench<'_>,
    subject: &Subject,
    glyphs: &[Glyph],
) -> Result<Vec<(Outcome, usize)>, Error> {
    let file = grid_fit_font(bench, subject, glyphs)?;
    let font = Font::new(file)?;
    let mut rasterizer = Rasterizer::new(&font);
    let outcome = |glyph: &Glyph| {
        let draw =
            |size: &TruthSize| Ok(size.square(&rasterizer.render(glyph.1.into(), f32::from(size.ppem))?));
        let drawn = subject.truth.sizes.iter().map(draw).collect::<Result<Vec<_>, Error>>()?;
        Ok((Outcome::new(GRID_FIT, subject, *glyph, drawn)?, font.model_len(glyph.1.into())?))
    };
    glyphs.iter().map(outcome).collect()
}
