//! The error of a model under work against its lesson.

use crate::error::Error;
use crate::teach::{HintedGlyph, Lesson};
use nfr::internals::Scratch;
use nfr::internals::model::gridfit::GridFit;
use nfr::{Bitmap, Placement};

/// Sizes below this count more, in proportion: they have few pixels, and text is read at them.
const SMALL: f32 = 32.0;
/// What changes at all sizes is judged at every second one, in turn: neighbouring sizes tell much the same.
const SHARES: usize = 2;

/// What a pixel of the box beyond the teacher's adds to the error, in levels: rows that are nearly blank are not worth
/// having.
const BEYOND: u32 = 4;

/// The sizes that a change is judged at, each of which stands for so many.
pub(super) struct Sample {
    sizes: Vec<usize>,
    each: f64,
}

pub(super) struct Judge {
    /// The hinted sizes, then some plain ones.
    sizes: Vec<HintedGlyph>,
    scratch: Scratch,
    pixels: Vec<u8>,
}

impl Judge {
    pub(super) fn new(lesson: &Lesson) -> Result<Self, Error> {
        let sizes = lesson.sizes.iter().cloned().chain(lesson.beyond()?).collect();
        Ok(Self { sizes, scratch: Scratch::default(), pixels: Vec::new() })
    }

    /// One size.
    pub(super) fn at(size: usize) -> Sample {
        Sample { sizes: vec![size], each: 1.0 }
    }

    /// Those sizes that count of a round's share.
    pub(super) fn share(&self, round: usize, counts: impl Fn(usize) -> bool) -> Sample {
        let sizes = (round % SHARES..self.sizes.len()).step_by(SHARES).filter(|size| counts(*size));
        Sample { sizes: sizes.collect(), each: SHARES as f64 }
    }

    /// The summed error, in pixels; anything above `limit` once it is clear that it is above.
    pub(super) fn error(&mut self, model: &GridFit, sample: &Sample, limit: f64) -> Result<f64, Error> {
        let mut sum = 0.0;
        for &size in &sample.sizes {
            sum += self.at_size(model, size)? * sample.each;
            if sum > limit {
                break;
            }
        }
        Ok(sum)
    }

    fn at_size(&mut self, model: &GridFit, size: usize) -> Result<f64, Error> {
        let HintedGlyph { ppem, bitmap, .. } = &self.sizes[size];
        let ppem = f32::from(*ppem);
        let place = model.placement(ppem)?;
        self.pixels.resize(place.area(), 0);
        model.draw(ppem, place, &mut self.scratch, &mut self.pixels)?;
        let rows = self.pixels.chunks_exact(place.width.max(1) as usize).zip(0..);
        let within = rows.map(|(row, j)| row_error(row, bitmap, place.left, place.top - 1 - j)).sum::<u32>();
        let weight = f64::from((SMALL / ppem).max(1.0)) / 255.0;
        let beyond = (place.area() - common(place, bitmap.placement)) as u32 * BEYOND;
        Ok(f64::from(within + outside(bitmap, place) + beyond) * weight)
    }
}

/// The number of pixels that two places have in common.
fn common(a: Placement, b: Placement) -> usize {
    let right = (a.left + a.width as i32).min(b.left + b.width as i32);
    let bottom = (a.top - a.height as i32).max(b.top - b.height as i32);
    let [width, height] = [right - a.left.max(b.left), a.top.min(b.top) - bottom];
    width.max(0) as usize * height.max(0) as usize
}

/// The summed difference of one row, whose pixels are those above `y` from `left` on, in levels.
fn row_error(row: &[u8], truth: &Bitmap, left: i32, y: i32) -> u32 {
    let place = truth.placement;
    let ink = |row: &[u8]| row.iter().map(|v| u32::from(*v)).sum::<u32>();
    let j = place.top - 1 - y;
    if j < 0 || j >= place.height as i32 {
        return ink(row);
    }
    let wanted = &truth.pixels[j as usize * place.width as usize..][..place.width as usize];
    // The columns that both have.
    let before = usize::try_from(place.left - left).unwrap_or(0).min(row.len());
    let skipped = usize::try_from(left - place.left).unwrap_or(0).min(wanted.len());
    let (wanted, both) = (&wanted[skipped..], &row[before..]);
    let common = both.len().min(wanted.len());
    let differences = both.iter().zip(wanted).map(|(a, b)| u32::from(a.abs_diff(*b)));
    ink(&row[..before]) + differences.sum::<u32>() + ink(&both[common..])
}

/// What the teacher's bitmap has outside a place, in levels.
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
