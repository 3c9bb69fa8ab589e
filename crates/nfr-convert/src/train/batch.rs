//! The training samples of a chunk of glyphs as tensors, which stay the same through all steps.
//!
//! The sizes are split into `GROUPS` groups, one of which is the batch of a step. Rows and columns of subpixel samples are
//! listed once for each glyph and size; the samples refer to them by index.

use burn::tensor::{Device, Int, Tensor, TensorData};

use super::coverage::{SLOPE_REACH, samples_per_pixel};
use crate::error::Error;
use crate::fit::Parameters;
use crate::training_samples::{GlyphSamples, TrainingSample};
use nfr::Placement;
use nfr::internals::model::gridfit::{DEFORM_NODES, GridAxis, GridFit};

/// Groups of sizes. Each is spread over the whole range.
pub(super) const GROUPS: usize = 8;

/// The size of padding lines.
const PADDING_PPEM: f32 = 1.0;
/// Pixels around the model's box that are part of the loss.
const BORDER: u32 = 1;

/// Lines (rows or columns) of samples along one axis, all glyphs after each other, padded to the same count.
pub(super) struct SampleLines {
    /// Sample positions in pixels `[lines]`.
    pub(super) at: Tensor<1>,
    /// Half the reach of the slope in pixels `[lines]`.
    pub(super) reach: Tensor<1>,
    /// Pixels per em `[lines]`.
    pub(super) ppem: Tensor<1>,
    /// Unhinted knot positions in em and the distance to the next, zero after the last: `[lines, knots]`.
    pub(super) knots: Tensor<2>,
    pub(super) gaps: Tensor<2>,
    /// Which hinted position belongs to each knot of each line `[lines · knots]`.
    pub(super) hinted: Tensor<1, Int>,
    /// Which hinted position is each line's last `[lines]`.
    pub(super) last: Tensor<1, Int>,
    /// Grid geometry of each line's glyph `[lines]`.
    pub(super) origin: Tensor<1>,
    pub(super) cells_per_em: Tensor<1>,
    pub(super) cells: Tensor<1>,
    /// Which size of which glyph `[lines]`.
    pub(super) size: Tensor<1, Int>,
    /// The number of lines of each glyph, padding included.
    pub(super) count: usize,
    /// The number of knots, padding included; 0 where the axis is not warped.
    pub(super) knot_count: usize,
}

/// Subpixel samples near edges and the pixels that consist of them.
pub(super) struct SubpixelSamples {
    pub(super) row: Tensor<1, Int>,
    /// The index of each sample's column in the field and in the deformation that are evaluated along x.
    pub(super) column: Tensor<1>,
    pub(super) nodes: Tensor<1>,
    pub(super) origin: Tensor<1>,
    pub(super) cells_per_em: Tensor<1>,
    pub(super) cells: Tensor<1>,
    /// Deformation nodes per em.
    pub(super) nodes_per_em: Tensor<1>,
    pub(super) per_ppem: Tensor<1>,
    pub(super) samples_per_em: Tensor<1>,
    /// −1 where the teacher's pixel is empty, 1 where it is full, 0 between.
    pub(super) side: Tensor<1>,
    /// 1 where every sample of a pixel has to be on the pixel's side, 0 where the pixel is partly covered.
    pub(super) certain: Tensor<1>,
    /// Runs of samples `(first, pixels, samples in a pixel)`.
    pub(super) runs: Vec<(usize, usize, usize)>,
    /// The teacher's coverage, 0..1.
    pub(super) target: Tensor<1>,
}

/// One group of sizes of a chunk.
pub(super) struct SizeGroup {
    pub(super) columns: SampleLines,
    pub(super) rows: SampleLines,
    pub(super) samples: SubpixelSamples,
}

/// Dimensions of a chunk's tensors, padding included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) glyphs: usize,
    pub(super) sizes: usize,
    /// Spline coefficients along x and y.
    pub(super) coefficients: [usize; 2],
    /// Knots along x and y.
    pub(super) knots: [usize; 2],
    pub(super) rank: usize,
}

impl Extent {
    pub(super) fn of(parameters: &[Parameters], sizes: usize) -> Self {
        let most = |f: &dyn Fn(&Parameters) -> usize| parameters.iter().map(f).max().unwrap_or(0);
        Self {
            glyphs: parameters.len(),
            sizes,
            coefficients: [0, 1].map(|k| most(&|p| p.cells[k] + 2)),
            // `unwarp` needs two knots, so that one knot is padded to two.
            knots: [0, 1].map(|k| match most(&|p| p.knots[k].len()) {
                1 => 2,
                knots => knots,
            }),
            rank: most(&|p| p.rank),
        }
    }
}

pub(super) fn floats(values: Vec<f32>, device: &Device) -> Tensor<1> {
    let count = values.len();
    Tensor::from_data(TensorData::new(values, [count]), device)
}

pub(super) fn ints(values: Vec<i32>, device: &Device) -> Tensor<1, Int> {
    let count = values.len();
    Tensor::from_data(TensorData::new(values, [count]), device)
}

#[derive(Default)]
struct LineLists {
    at: Vec<f32>,
    reach: Vec<f32>,
    ppem: Vec<f32>,
    knots: Vec<f32>,
    gaps: Vec<f32>,
    hinted: Vec<i32>,
    last: Vec<i32>,
    grid: Vec<GridAxis>,
    size: Vec<i32>,
}

#[derive(Default)]
struct SampleLists {
    row: Vec<i32>,
    column: Vec<f32>,
    nodes: Vec<f32>,
    glyph: Vec<usize>,
    ppem: Vec<f32>,
    side: Vec<f32>,
    certain: Vec<f32>,
    target: Vec<f32>,
}

/// A pixel near an edge: where its samples' lines begin, and the teacher's coverage.
struct Pixel {
    glyph: usize,
    ppem: f32,
    column: usize,
    row: usize,
    target: f32,
}

impl SizeGroup {
    /// The tensors of group `group` of a chunk's glyphs.
    pub(super) fn new(
        glyphs: &[GlyphSamples],
        parameters: &[Parameters],
        models: &[GridFit],
        units: f32,
        extent: Extent,
        group: usize,
        device: &Device,
    ) -> Result<Self, Error> {
        let mut lines = [vec![Vec::new(); glyphs.len()], vec![Vec::new(); glyphs.len()]];
        let mut pixels: Vec<Pixel> = Vec::new();
        for (glyph, (samples, model)) in glyphs.iter().zip(models).enumerate() {
            for (size, sample) in samples.sizes.iter().enumerate().skip(group).step_by(GROUPS) {
                let ppem = f32::from(sample.ppem);
                let place = widened(model.placement(ppem)?);
                let n = samples_per_pixel(ppem);
                let (first_column, first_row) = (lines[0][glyph].len(), lines[1][glyph].len());
                for i in 0..place.width as usize * n {
                    lines[0][glyph].push((size, ppem, place.left as f32 + (i as f32 + 0.5) / n as f32));
                }
                for j in 0..place.height as usize * n {
                    lines[1][glyph].push((size, ppem, place.top as f32 - (j as f32 + 0.5) / n as f32));
                }
                for (i, j, target) in near_edges(sample, place) {
                    let (column, row) = (first_column + i * n, first_row + j * n);
                    pixels.push(Pixel { glyph, ppem, column, row, target });
                }
            }
        }
        let grids: Vec<[GridAxis; 2]> = parameters
            .iter()
            .map(|p| {
                [0, 1].map(|k| {
                    GridAxis::new(
                        f32::from(p.bounds[k]) / units,
                        f32::from(p.bounds[k + 2]) / units,
                        p.cells[k].max(1),
                    )
                })
            })
            .collect();
        let tensors = |axis: usize| {
            let count = lines[axis].iter().map(Vec::len).max().unwrap_or(0);
            let mut lists = LineLists::default();
            for (glyph, parameters) in parameters.iter().enumerate() {
                for k in 0..count {
                    let padding = (0, PADDING_PPEM, 0.0);
                    let line = lines[axis][glyph].get(k).copied().unwrap_or(padding);
                    lists.push(axis, glyph, parameters, units, extent, line, grids[glyph][axis]);
                }
            }
            lists.tensors(count, extent.knots[axis], device)
        };
        let [columns, rows] = [tensors(0), tensors(1)];
        let samples = sample_tensors(pixels, &columns, &rows, &grids, extent, device);
        Ok(Self { columns, rows, samples })
    }
}

impl LineLists {
    #[allow(clippy::too_many_arguments)]
    fn push(
        &mut self,
        axis: usize,
        glyph: usize,
        parameters: &Parameters,
        units: f32,
        extent: Extent,
        (size, ppem, at): (usize, f32, f32),
        grid: GridAxis,
    ) {
        let n = samples_per_pixel(ppem) as f32;
        self.at.push(at);
        self.reach.push(SLOPE_REACH / n);
        self.ppem.push(ppem);
        self.grid.push(grid);
        self.size.push((glyph * extent.sizes + size) as i32);
        let own = &parameters.knots[axis];
        let last = own.len().saturating_sub(1);
        let em = |k: usize| own.get(k).map_or(0.0, |v| f32::from(*v) / units);
        let base = (glyph * extent.sizes + size) * extent.knots[axis];
        for k in 0..extent.knots[axis] {
            self.knots.push(em(k.min(last)));
            self.gaps.push(if k < last { em(k + 1) - em(k) } else { 0.0 });
            self.hinted.push((base + k.min(last)) as i32);
        }
        self.last.push((base + last) as i32);
    }

    fn tensors(self, count: usize, knot_count: usize, device: &Device) -> SampleLines {
        let lines = self.at.len();
        let grid = |f: &dyn Fn(&GridAxis) -> f32| floats(self.grid.iter().map(f).collect(), device);
        let (origin, cells_per_em, cells) =
            (grid(&|g| g.origin), grid(&|g| g.cells_per_em), grid(&|g| g.cells as f32));
        let table = |mut values: Vec<f32>| {
            values.resize(lines * knot_count.max(1), 0.0);
            floats(values, device).reshape([lines, knot_count.max(1)])
        };
        SampleLines {
            at: floats(self.at, device),
            reach: floats(self.reach, device),
            ppem: floats(self.ppem, device),
            knots: table(self.knots),
            gaps: table(self.gaps),
            hinted: ints(self.hinted, device),
            last: ints(self.last, device),
            origin,
            cells_per_em,
            cells,
            size: ints(self.size, device),
            count,
            knot_count,
        }
    }
}

/// A box with a border, where the model learns empty pixels.
fn widened(place: Placement) -> Placement {
    if place.area() == 0 {
        return place;
    }
    Placement {
        left: place.left - BORDER as i32,
        top: place.top + BORDER as i32,
        width: place.width + 2 * BORDER,
        height: place.height + 2 * BORDER,
    }
}

/// Pixels of a box whose neighbourhood in the teacher's bitmap is not uniform: column, row, coverage.
fn near_edges(sample: &TrainingSample, place: Placement) -> Vec<(usize, usize, f32)> {
    let truth = &sample.bitmap;
    let coverage = |x: i32, y: i32| {
        let (i, j) = (x - truth.placement.left, truth.placement.top - 1 - y);
        let inside =
            i >= 0 && j >= 0 && i < truth.placement.width as i32 && j < truth.placement.height as i32;
        if inside { truth.pixels[j as usize * truth.placement.width as usize + i as usize] } else { 0 }
    };
    let mut pixels = Vec::new();
    for j in 0..place.height as i32 {
        for i in 0..place.width as i32 {
            let (x, y) = (place.left + i, place.top - 1 - j);
            let centre = coverage(x, y);
            let uniform = (centre == 0 || centre == 255)
                && (-1..=1).all(|dy| (-1..=1).all(|dx| coverage(x + dx, y + dy) == centre));
            if !uniform {
                pixels.push((i as usize, j as usize, f32::from(centre) / 255.0));
            }
        }
    }
    pixels
}

/// Coverage this close to 0 or 1 is empty or full for the penalty on saturated samples.
const NEARLY: f32 = 0.02;

fn sample_tensors(
    mut pixels: Vec<Pixel>,
    columns: &SampleLines,
    rows: &SampleLines,
    grids: &[[GridAxis; 2]],
    extent: Extent,
    device: &Device,
) -> SubpixelSamples {
    pixels.sort_by_key(|p| samples_per_pixel(p.ppem));
    let mut lists = SampleLists::default();
    let mut runs: Vec<(usize, usize, usize)> = Vec::new();
    for pixel in &pixels {
        let n = samples_per_pixel(pixel.ppem);
        match runs.last_mut() {
            Some(run) if run.2 == n * n => run.1 += 1,
            _ => runs.push((lists.row.len(), 1, n * n)),
        }
        let side = match pixel.target {
            t if t < NEARLY => -1.0,
            t if t > 1.0 - NEARLY => 1.0,
            _ => 0.0,
        };
        lists.target.push(pixel.target);
        for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
            let column = pixel.glyph * columns.count + pixel.column + i;
            lists.row.push((pixel.glyph * rows.count + pixel.row + j) as i32);
            lists.column.push((column * extent.coefficients[1]) as f32);
            lists.nodes.push((column * DEFORM_NODES) as f32);
            lists.glyph.push(pixel.glyph);
            lists.ppem.push(pixel.ppem);
            lists.side.push(side);
            lists.certain.push(if side != 0.0 || n == 1 { 1.0 } else { 0.0 });
        }
    }
    let grid =
        |f: &dyn Fn(&GridAxis) -> f32| floats(lists.glyph.iter().map(|g| f(&grids[*g][1])).collect(), device);
    let nodes_per_em = |g: &GridAxis| g.cells_per_em / g.cells as f32 * (DEFORM_NODES - 1) as f32;
    SubpixelSamples {
        origin: grid(&|g| g.origin),
        cells_per_em: grid(&|g| g.cells_per_em),
        cells: grid(&|g| g.cells as f32),
        nodes_per_em: grid(&nodes_per_em),
        row: ints(lists.row, device),
        column: floats(lists.column, device),
        nodes: floats(lists.nodes, device),
        per_ppem: floats(lists.ppem.iter().map(|s| 1.0 / s).collect(), device),
        samples_per_em: floats(lists.ppem.iter().map(|s| s * samples_per_pixel(*s) as f32).collect(), device),
        side: floats(lists.side, device),
        certain: floats(lists.certain, device),
        runs,
        target: floats(lists.target, device),
    }
}
