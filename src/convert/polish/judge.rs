//! The error of a model under work against its lesson, over the pixels that a change can reach.

use crate::convert::teach::{HintedGlyph, Lesson};
use crate::error::Error;
use crate::model::gridfit::{GridFit, SLOPE_REACH, Scratch};
use crate::render::{Bitmap, Placement};

/// Sizes below this count more, in proportion: they have few pixels, and text is read at them.
const SMALL: f32 = 32.0;
/// What a sample's surroundings add to the pixels that a change reaches.
const MARGIN: f32 = SLOPE_REACH + 0.05;

/// What changes at all sizes is judged at every second one, in turn: neighbouring sizes tell much the same.
const SHARES: usize = 2;

/// What has to be drawn again for a change.
pub(super) enum Regions {
    /// A whole bitmap, whose box may change.
    Whole(usize),
    /// Parts of bitmaps (size and place), each of which stands for so many.
    Parts(Vec<(usize, Placement)>, f64),
}

pub(super) struct Judge {
    /// The hinted sizes, then some plain ones.
    sizes: Vec<HintedGlyph>,
    scratch: Scratch,
    pixels: Vec<u8>,
}

impl Judge {
    pub(super) fn new(lesson: &Lesson) -> Self {
        let sizes = lesson.sizes.iter().cloned().chain(lesson.beyond()).collect();
        Self { sizes, scratch: Scratch::default(), pixels: Vec::new() }
    }

    fn ppem(&self, size: usize) -> f32 {
        f32::from(self.sizes[size].ppem)
    }

    /// What hinted positions between `low` and `high` (pixels) along an axis can change at one size.
    pub(super) fn between(
        &self,
        model: &GridFit,
        size: usize,
        axis: usize,
        low: f32,
        high: f32,
    ) -> Result<Regions, Error> {
        let mut part = model.placement(self.ppem(size))?;
        cut(&mut part, axis, low, high);
        Ok(Regions::Parts(vec![(size, part)], 1.0))
    }

    /// What the plain ranges `reach` (em, for each axis) can change, at those sizes that count. Each round looks
    /// at its share of the sizes.
    pub(super) fn around(
        &self,
        model: &GridFit,
        reach: [[f32; 2]; 2],
        round: usize,
        counts: impl Fn(usize) -> bool,
    ) -> Result<Regions, Error> {
        let mut parts = Vec::with_capacity(self.sizes.len());
        for size in (round % SHARES..self.sizes.len()).step_by(SHARES).filter(|size| counts(*size)) {
            let ppem = self.ppem(size);
            let mut part = model.placement(ppem)?;
            for (axis, [low, high]) in reach.into_iter().enumerate() {
                let [low, high] = model.hinted_range(axis, ppem, low, high);
                cut(&mut part, axis, low, high);
            }
            if part.area() > 0 {
                parts.push((size, part));
            }
        }
        Ok(Regions::Parts(parts, SHARES as f64))
    }

    /// The summed error over the regions, in pixels; anything above `limit` once it is clear that it is above.
    pub(super) fn error(&mut self, model: &GridFit, regions: &Regions, limit: f64) -> Result<f64, Error> {
        match regions {
            Regions::Whole(size) => {
                let place = model.placement(self.ppem(*size))?;
                let within = self.part(model, *size, place);
                Ok((within + outside(&self.sizes[*size].bitmap, place)) * self.weight(*size))
            }
            Regions::Parts(parts, count) => {
                let mut sum = 0.0;
                for &(size, part) in parts {
                    sum += self.part(model, size, part) * self.weight(size) * count;
                    if sum > limit {
                        break;
                    }
                }
                Ok(sum)
            }
        }
    }

    fn weight(&self, size: usize) -> f64 {
        f64::from((SMALL / self.ppem(size)).max(1.0)) / 255.0
    }

    /// The summed error of a part of a bitmap, in levels.
    fn part(&mut self, model: &GridFit, size: usize, part: Placement) -> f64 {
        self.pixels.clear();
        self.pixels.resize(part.area(), 0);
        model.draw(self.ppem(size), part, &mut self.scratch, &mut self.pixels);
        let truth = &self.sizes[size].bitmap;
        let width = part.width as usize;
        let rows = self.pixels.chunks_exact(width.max(1)).zip(0..);
        let sum: u32 = rows.map(|(row, j)| row_error(row, truth, part.left, part.top - 1 - j)).sum();
        f64::from(sum)
    }
}

/// Cuts a place to the pixels between two positions along an axis, and a margin.
fn cut(part: &mut Placement, axis: usize, low: f32, high: f32) {
    let (low, high) = ((low - MARGIN).floor() as i32, (high + MARGIN).ceil() as i32);
    if axis == 0 {
        let right = high.min(part.left + part.width as i32);
        part.left = low.max(part.left);
        part.width = (right - part.left).max(0) as u32;
    } else {
        let bottom = low.max(part.top - part.height as i32);
        part.top = high.min(part.top);
        part.height = (part.top - bottom).max(0) as u32;
    }
}

/// The summed difference of one row, whose pixels are those above `y` from `left` on.
fn row_error(row: &[u8], truth: &Bitmap, left: i32, y: i32) -> u32 {
    let place = truth.placement;
    let j = place.top - 1 - y;
    if j < 0 || j >= place.height as i32 {
        return row.iter().map(|v| u32::from(*v)).sum();
    }
    let width = place.width as usize;
    let wanted = &truth.pixels[j as usize * width..(j as usize + 1) * width];
    let differ = |(v, i): (&u8, i32)| {
        let want = usize::try_from(i).ok().and_then(|i| wanted.get(i)).copied().unwrap_or(0);
        u32::from(v.abs_diff(want))
    };
    row.iter().zip(left - place.left..).map(differ).sum()
}

/// What the teacher's bitmap has outside a place, in levels.
fn outside(truth: &Bitmap, place: Placement) -> f64 {
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
    f64::from(sum)
}
