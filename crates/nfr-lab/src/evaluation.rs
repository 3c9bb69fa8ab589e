//! A model's bitmaps of a glyph, and how far they are from the ground truth.

use super::SquareBitmap;
use super::classes::rounded;
use super::dataset::{CharGlyph, Dataset};
use super::error_table::ErrorRow;
use super::pixel_error::{PixelError, pixel_error};
use super::train::Epoch;
use super::train::result::TrainingOrigin;
use super::truth::TruthSize;
use nfr_convert::error::Error;

/// A model's bitmaps of one glyph, and their errors.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// The model's name.
    pub model: String,
    /// The font's name.
    pub font: String,
    /// The character.
    pub glyph: char,
    /// The epochs of its training; none for our own model.
    pub history: Vec<Epoch>,
    /// Where and how it was trained; nowhere for our own model.
    pub origin: Option<TrainingOrigin>,
    /// Its bitmap for each size.
    pub drawn: Vec<SquareBitmap>,
    /// The true ones.
    pub truth: Vec<SquareBitmap>,
    /// The errors at each size.
    pub rows: Vec<ErrorRow>,
    /// The accuracy of a network that predicts classes.
    pub class_accuracy: Option<ClassAccuracy>,
}

/// The share of pixels that a network puts into the right class, and the errors of classes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassAccuracy {
    /// Pixels of all bitmaps.
    pub pixels: usize,
    /// Pixels in a wrong class.
    pub wrong: usize,
    /// The mean squared error over all sizes against the right classes, which are the network's targets.
    pub mse: f64,
    /// The mean squared error of the right classes against the truth: the error of rounding.
    pub rounding: f64,
}

impl ClassAccuracy {
    /// Compares a network's bitmaps with the classes of the true ones.
    ///
    /// # Errors
    ///
    /// As [`pixel_error`].
    pub fn new(truth: &[SquareBitmap], drawn: &[SquareBitmap]) -> Result<Self, Error> {
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

impl Evaluation {
    /// Measures bitmaps, one for each size of the dataset's truth.
    ///
    /// # Errors
    ///
    /// As [`pixel_error`] and [`Dataset::squares`].
    pub fn new(
        model: &str,
        dataset: &Dataset,
        glyph: CharGlyph,
        drawn: Vec<SquareBitmap>,
    ) -> Result<Self, Error> {
        let truth = dataset.squares(glyph.1)?;
        let rows = measure(model, dataset, glyph.0, &truth, &drawn)?;
        Ok(Self {
            rows,
            model: model.to_owned(),
            font: dataset.name.clone(),
            glyph: glyph.0,
            history: Vec::new(),
            origin: None,
            class_accuracy: None,
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

    /// Seconds that its training took, in epochs that this or earlier runs trained; none on a device whose times say nothing.
    pub fn seconds(&self) -> Option<f64> {
        let timed = self.origin.as_ref().is_some_and(|origin| origin.timed);
        timed.then(|| self.history.iter().map(|epoch| epoch.seconds).sum())
    }

    /// Floating-point operations a second of its training's matrix products, where times say anything.
    pub fn operations_per_second(&self) -> Option<f64> {
        Some(self.origin.as_ref()?.operations as f64 / self.seconds()?)
    }
}

/// Measures a model's bitmaps against the true ones, a row for each size of the dataset's truth.
///
/// # Errors
///
/// As [`pixel_error`].
pub fn measure(
    model: &str,
    dataset: &Dataset,
    glyph: char,
    truth: &[SquareBitmap],
    drawn: &[SquareBitmap],
) -> Result<Vec<ErrorRow>, Error> {
    let row = |((size, truth), drawn): ((&TruthSize, &SquareBitmap), &SquareBitmap)| {
        let PixelError { mse, mae, bad16 } = pixel_error(truth, drawn)?;
        let (model, font) = (model.to_owned(), dataset.name.clone());
        Ok(ErrorRow { model, font, glyph, side: size.side, ppem: size.ppem, mse, mae, bad16 })
    };
    dataset.truth.sizes.iter().zip(truth).zip(drawn).map(row).collect()
}
