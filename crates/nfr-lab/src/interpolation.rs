//! The experiment on families: one network for several weights, evaluated at a weight that it was not trained on.

use super::SquareBitmap;
use super::dataset::{CharGlyph, Dataset};
use super::error_table::ErrorRow;
use super::evaluation::measure;
use super::experiment::Experiment;
use super::family::{FamilyMember, FamilyTask, GridFitPair};
use super::train::Epoch;
use super::train::result::{TrainingOrigin, TrainingResult};
use nfr_convert::error::Error;

/// An interpolated glyph, or one of the two ends.
#[derive(Debug, Clone)]
pub struct Rendering {
    /// The model or method that drew it.
    pub name: String,
    /// The font that it should be like.
    pub of: String,
    /// Its bitmap for each size.
    pub drawn: Vec<SquareBitmap>,
    /// The real ones, where there is such a font.
    pub truth: Option<Vec<SquareBitmap>>,
    /// Its errors at each size, where the real bitmaps are known.
    pub rows: Vec<ErrorRow>,
}

impl Rendering {
    /// The mean squared error over all sizes, where it is known.
    pub fn mse(&self) -> Option<f64> {
        (!self.rows.is_empty())
            .then(|| self.rows.iter().map(|row| row.mse).sum::<f64>() / self.rows.len() as f64)
    }
}

/// The result of an experiment on a family for one character.
#[derive(Debug, Clone)]
pub struct Interpolation {
    /// The character.
    pub glyph: char,
    /// The network's epochs.
    pub history: Vec<Epoch>,
    /// Where and how it was trained.
    pub origin: TrainingOrigin,
    /// The network's bitmaps of the fonts that it was trained on.
    pub ends: Vec<Rendering>,
    /// The bitmaps between the first and the last of them.
    pub between: Vec<Rendering>,
}

/// The names of what is drawn between, in tables.
pub mod names {
    /// The paper's network, from the interpolated latent vector.
    pub const IMPLICIT: &str = "implicit";
    /// Our models, interpolated in the same way.
    pub const GRID_FIT: &str = "grid-fit";
    /// The same, with knots that stand on whole pixels in both models put on whole pixels.
    pub const SNAPPED: &str = "grid-fit snapped";
    /// The mean of the two true bitmaps.
    pub const BITMAPS: &str = "mean of bitmaps";
    /// The true bitmaps of the lighter font.
    pub const FIRST: &str = "first font as it is";
    /// The true bitmaps of the bolder font.
    pub const LAST: &str = "last font as it is";
}

/// The target of an interpolation.
#[derive(Clone, Copy)]
pub struct InterpolationTarget<'s> {
    /// Its name in tables.
    pub name: &'s str,
    /// Its place between the first member and the last, 0 to 1.
    pub share: f64,
    /// The real font, if there is one, with the same sizes.
    pub real: Option<&'s Dataset>,
}

/// Trains one network on a character of all members, or takes the result that is kept: its bitmaps of each member at all sizes,
/// then those between the first and the last.
///
/// # Errors
///
/// As [`FamilyTask::new`] and [`Experiment::result`].
pub fn trained(
    context: &Experiment<'_>,
    experiment: &str,
    members: &[FamilyMember<'_>],
    share: f64,
    glyph: char,
) -> Result<TrainingResult, Error> {
    let task = FamilyTask::new(context, experiment, members, share, glyph)?;
    context.result(&task.path(), task.files.as_ref(), task.epochs(), |checkpoint| {
        let family = task.train(checkpoint)?;
        let mut drawn = Vec::new();
        for number in 0..members.len() {
            drawn.extend(family.member(number)?);
        }
        drawn.extend(family.between(0, members.len() - 1, share)?);
        Ok(TrainingResult { origin: family.origin, history: family.history, drawn })
    })
}

/// Trains one network on a character of all members, or takes its result, and measures what it draws of them and between the
/// first and the last.
///
/// # Errors
///
/// As [`trained`] and [`GridFitPair::train`].
pub fn interpolate(
    context: &Experiment<'_>,
    experiment: &str,
    members: &[FamilyMember<'_>],
    target: InterpolationTarget<'_>,
    glyph: char,
) -> Result<Interpolation, Error> {
    let (Some(first), Some(last)) = (members.first(), members.last()) else {
        return Err(Error::InvalidParameter("a family needs two fonts".into()));
    };
    let result = trained(context, experiment, members, target.share, glyph)?;
    let sizes = result.drawn.len() / (members.len() + 1);
    let part = |number: usize| result.drawn[number * sizes..][..sizes].to_vec();
    let glyph_of = |dataset: &Dataset| dataset.glyphs(glyph.encode_utf8(&mut [0; 4]));
    let truth = |dataset: &Dataset| -> Result<Vec<SquareBitmap>, Error> {
        glyph_of(dataset)?.first().map_or(Ok(Vec::new()), |glyph: &CharGlyph| dataset.squares(glyph.1))
    };
    let measured = |name: &str, drawn: Vec<SquareBitmap>, of: &str, real: Option<&Dataset>| {
        let truth = real.map(truth).transpose()?;
        let rows = match (real, &truth) {
            (Some(dataset), Some(truth)) => measure(name, dataset, glyph, truth, &drawn)?,
            _ => Vec::new(),
        };
        Ok::<_, Error>(Rendering { name: name.to_owned(), of: of.to_owned(), drawn, truth, rows })
    };
    let end = |(number, member): (usize, &FamilyMember<'_>)| {
        measured(names::IMPLICIT, part(number), &member.dataset.name, Some(member.dataset))
    };
    let ends = members.iter().enumerate().map(end).collect::<Result<_, _>>()?;
    let fits = GridFitPair::train(context, [first.dataset, last.dataset], glyph)?;
    let (lighter, bolder) = (truth(first.dataset)?, truth(last.dataset)?);
    let mean = lighter.iter().zip(&bolder).map(|(a, b)| mixed(a, b, target.share)).collect();
    let drawings = [
        (names::IMPLICIT, part(members.len())),
        (names::GRID_FIT, fits.between(first.dataset, target.share, false)?),
        (names::SNAPPED, fits.between(first.dataset, target.share, true)?),
        (names::BITMAPS, mean),
        (names::FIRST, lighter),
        (names::LAST, bolder),
    ];
    let between = drawings.into_iter().map(|(name, drawn)| measured(name, drawn, target.name, target.real));
    Ok(Interpolation {
        glyph,
        ends,
        between: between.collect::<Result<_, _>>()?,
        history: result.history,
        origin: result.origin,
    })
}

fn mixed(a: &SquareBitmap, b: &SquareBitmap, share: f64) -> SquareBitmap {
    let pixel = |(a, b): (&u8, &u8)| (f64::from(*a) * (1.0 - share) + f64::from(*b) * share).round() as u8;
    SquareBitmap { side: a.side, pixels: a.pixels.iter().zip(&b.pixels).map(pixel).collect() }
}
