//! The distortion of a model: the error of its bitmaps against the training samples.

use crate::error::Error;
use crate::training_samples::{GlyphSamples, TrainingSample};
use nfr::internals::Scratch;
use nfr::internals::model::gridfit::GridFit;
use nfr::{Bitmap, Placement};

/// The weight of a size below this is this over the size: small sizes have few pixels, and text is read at them.
const SMALL_PPEM: f32 = 32.0;
/// A weight that changes all sizes is measured at every second one, alternating between rounds: the errors at
/// neighbouring sizes are alike.
const STRIDE: usize = 2;
/// The penalty of a pixel of the model's box that is outside of the sample's, in 1/255 of full coverage, so that nearly
/// blank rows go.
const OUTSIDE_PENALTY: u32 = 4;

/// The sizes that a change is measured at.
pub(super) struct SizeSubset {
    sizes: Vec<usize>,
    /// The number of sizes that each of them stands for.
    weight: f64,
}

impl SizeSubset {
    /// One size.
    pub(super) fn one(size: usize) -> Self {
        Self { sizes: vec![size], weight: 1.0 }
    }
}

pub(super) struct Distortion {
    /// The hinted sizes, then some larger, unhinted ones.
    sizes: Vec<TrainingSample>,
    scratch: Scratch,
    pixels: Vec<u8>,
}

impl Distortion {
    pub(super) fn new(samples: &GlyphSamples) -> Result<Self, Error> {
        let sizes = samples.sizes.iter().cloned().chain(samples.larger_sizes()?).collect();
        Ok(Self { sizes, scratch: Scratch::default(), pixels: Vec::new() })
    }

    /// The sizes of a round that a weight influences.
    pub(super) fn subset(&self, round: usize, is_influenced: impl Fn(usize) -> bool) -> SizeSubset {
        let sizes = (round % STRIDE..self.sizes.len()).step_by(STRIDE).filter(|size| is_influenced(*size));
        SizeSubset { sizes: sizes.collect(), weight: STRIDE as f64 }
    }

    /// The summed error in pixels. The sum ends early once it is above `limit`.
    pub(super) fn error(&mut self, model: &GridFit, subset: &SizeSubset, limit: f64) -> Result<f64, Error> {
        let mut sum = 0.0;
        for &size in &subset.sizes {
            sum += self.at_size(model, size)? * subset.weight;
            if sum > limit {
                break;
            }
        }
        Ok(sum)
    }

    fn at_size(&mut self, model: &GridFit, size: usize) -> Result<f64, Error> {
        let TrainingSample { ppem, bitmap, .. } = &self.sizes[size];
        let ppem = f32::from(*ppem);
        let place = model.placement(ppem)?;
        self.pixels.resize(place.area(), 0);
        model.draw(ppem, place, &mut self.scratch, &mut self.pixels)?;
        let rows = self.pixels.chunks_exact(place.width.max(1) as usize).zip(0..);
        let within = rows.map(|(row, j)| row_error(row, bitmap, place.left, place.top - 1 - j)).sum::<u32>();
        let weight = f64::from((SMALL_PPEM / ppem).max(1.0)) / 255.0;
        let penalty = (place.area() - common(place, bitmap.placement)) as u32 * OUTSIDE_PENALTY;
        Ok(f64::from(within + outside(bitmap, place) + penalty) * weight)
    }
}

/// The number of pixels that two boxes have in common.
fn common(a: Placement, b: Placement) -> usize {
    let right = (a.left + a.width as i32).min(b.left + b.width as i32);
    let bottom = (a.top - a.height as i32).max(b.top - b.height as i32);
    let [width, height] = [right - a.left.max(b.left), a.top.min(b.top) - bottom];
    width.max(0) as usize * height.max(0) as usize
}

/// The summed difference of the row of pixels above `y`, from `left` on, in 1/255 of full coverage.
fn row_error(row: &[u8], truth: &Bitmap, left: i32, y: i32) -> u32 {
    let place = truth.placement;
    let ink = |row: &[u8]| row.iter().map(|v| u32::from(*v)).sum::<u32>();
    let j = place.top - 1 - y;
    if j < 0 || j >= place.height as i32 {
        return ink(row);
    }
    let expected = &truth.pixels[j as usize * place.width as usize..][..place.width as usize];
    // The columns that both have.
    let before = usize::try_from(place.left - left).unwrap_or(0).min(row.len());
    let skipped = usize::try_from(left - place.left).unwrap_or(0).min(expected.len());
    let (expected, both) = (&expected[skipped..], &row[before..]);
    let common = both.len().min(expected.len());
    let differences = both.iter().zip(expected).map(|(a, b)| u32::from(a.abs_diff(*b)));
    ink(&row[..before]) + differences.sum::<u32>() + ink(&both[common..])
}

/// The coverage of the sample's bitmap outside of a box, in 1/255.
fn outside(truth: &Bitmap, place: Placement) -> u32 {
    let theirs = truth.placement;
    let mut sum = 0;
    for (row, y) in
        truth.pixels.chunks_exact(theirs.width.max(1) as usize).zip((0..).map(|j| theirs.top - 1 - j))
    {
        let inside = y < place.top && y >= place.top - place.height as i32;
        for (v, x) in row.iter().zip(theirs.left..) {
            if !(inside && x >= place.left && x < place.left + place.width as i32) {
                sum += u32::from(*v);
            }
        }
    }
    sum
}
