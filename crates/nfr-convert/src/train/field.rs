//! The grid-fit field in burn: the arithmetic of `model::gridfit`, over a whole group at once.

use burn::tensor::{Device, Tensor, TensorData};

use super::batch::{Extent, Group, Lines, Samples};
use super::beyond::Learnt;
use super::coverage::{MIN_GRADIENT, MIN_SKEW};
use crate::start::Draft;
use nfr::internals::model::gridfit::{
    DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, MIN_KNOT_GAP, PATTERN_STEPS, WARP_STEPS,
};

/// The trained weights of a chunk of glyphs.
#[derive(Clone)]
pub(super) struct Parameters {
    /// Spline coefficients in em `[glyphs, along x, along y]`.
    pub(super) field: Tensor<3>,
    /// Hinted knot positions in pixels for x and y `[glyphs · sizes · knots]`.
    pub(super) hinted: [Tensor<1>; 2],
    /// Deformation patterns `[glyphs, nodes along x, rank · nodes along y]`.
    pub(super) patterns: Tensor<3>,
    /// The size embedding in pixels `[glyphs · sizes, rank]`.
    pub(super) embedding: Tensor<2>,
}

fn tensor<const D: usize>(values: Vec<f32>, shape: [usize; D], device: &Device) -> Tensor<D> {
    Tensor::from_data(TensorData::new(values, shape), device)
}

fn values<const D: usize>(tensor: &Tensor<D>) -> Vec<f32> {
    tensor.clone().into_data().iter::<f32>().collect()
}

/// Values for each knot at each size, laid out as `Parameters::hinted`; `fill` where a glyph has fewer knots.
pub(super) fn hinted_tensors(
    each: &[&[Vec<f32>; 2]],
    drafts: &[Draft],
    extent: Extent,
    fill: f32,
    device: &Device,
) -> [Tensor<1>; 2] {
    [0, 1].map(|axis| {
        let knots = extent.knots[axis];
        let mut all = vec![fill; (extent.glyphs * extent.sizes * knots).max(1)];
        for (g, (values, draft)) in each.iter().zip(drafts).enumerate() {
            let own = draft.knots[axis].len();
            for (k, v) in values[axis].iter().enumerate() {
                all[(g * extent.sizes + k / own) * knots + k % own] = *v;
            }
        }
        let count = all.len();
        tensor(all, [count], device)
    })
}

impl Parameters {
    pub(super) fn from_drafts(drafts: &[Draft], extent: Extent, device: &Device) -> Self {
        let [nx, ny] = extent.coefficients;
        let nodes = DEFORM_NODES;
        let mut field = vec![0.0; extent.glyphs * nx * ny];
        let mut patterns = vec![0.0; extent.glyphs * nodes * extent.rank * nodes];
        let mut embedding = vec![0.0; extent.glyphs * extent.sizes * extent.rank];
        for (g, draft) in drafts.iter().enumerate() {
            let stride = draft.cells[0] + 2;
            for (k, v) in draft.field.iter().enumerate() {
                field[(g * nx + k % stride) * ny + k / stride] = *v;
            }
            for (k, v) in draft.patterns.iter().enumerate() {
                let (r, y, x) = (k / (nodes * nodes), k / nodes % nodes, k % nodes);
                patterns[((g * nodes + x) * extent.rank + r) * nodes + y] = *v;
            }
            for (k, v) in draft.embedding.iter().enumerate() {
                embedding[(g * extent.sizes + k / draft.rank) * extent.rank + k % draft.rank] = *v;
            }
        }
        let hinted = drafts.iter().map(|d| &d.hinted).collect::<Vec<_>>();
        let hinted = hinted_tensors(&hinted, drafts, extent, 0.0, device);
        Self {
            field: tensor(field, [extent.glyphs, nx, ny], device),
            hinted,
            patterns: tensor(patterns, [extent.glyphs, nodes, extent.rank * nodes], device),
            embedding: tensor(embedding, [extent.glyphs * extent.sizes, extent.rank], device),
        }
    }

    /// Writes the weights back.
    pub(super) fn store(&self, drafts: &mut [Draft], extent: Extent) {
        let [nx, ny] = extent.coefficients;
        let nodes = DEFORM_NODES;
        let field = values(&self.field);
        let hinted = [values(&self.hinted[0]), values(&self.hinted[1])];
        let (patterns, embedding) = (values(&self.patterns), values(&self.embedding));
        for (g, draft) in drafts.iter_mut().enumerate() {
            let stride = draft.cells[0] + 2;
            for (k, v) in draft.field.iter_mut().enumerate() {
                *v = field[(g * nx + k % stride) * ny + k / stride];
            }
            for (axis, hinted) in hinted.iter().enumerate() {
                let own = draft.knots[axis].len();
                for (k, v) in draft.hinted[axis].iter_mut().enumerate() {
                    *v = hinted[(g * extent.sizes + k / own) * extent.knots[axis] + k % own];
                }
            }
            for (k, v) in draft.patterns.iter_mut().enumerate() {
                let (r, y, x) = (k / (nodes * nodes), k / nodes % nodes, k % nodes);
                *v = patterns[((g * nodes + x) * extent.rank + r) * nodes + y];
            }
            let rank = draft.rank;
            for (k, v) in draft.embedding.iter_mut().enumerate() {
                *v = embedding[(g * extent.sizes + k / rank) * extent.rank + k % rank];
            }
        }
    }

    /// The weights as they would be stored, with the gradient of the unrounded ones (straight-through). What is not
    /// learnt is not stored either.
    pub(super) fn rounded(&self, learnt: &Learnt) -> Self {
        let hinted = |axis: usize| {
            let plain = &self.hinted[axis];
            let moved = (straight_through(plain, WARP_STEPS) - plain.clone()).detach();
            plain.clone() + moved * learnt.hinted[axis].clone()
        };
        Self {
            field: straight_through(&self.field, FIELD_STEPS),
            hinted: [0, 1].map(hinted),
            patterns: straight_through(&self.patterns, PATTERN_STEPS),
            embedding: straight_through(&self.embedding, EMBEDDING_STEPS),
        }
    }

    /// The weights with knots that ascend, as the renderer takes them: one that hinting puts below the one before
    /// it counts as just above that one.
    pub(super) fn ordered(self, extent: Extent) -> Self {
        let [x, y] = self.hinted;
        let hinted = [ascending(x, extent.knots[0]), ascending(y, extent.knots[1])];
        Self { hinted, ..self }
    }
}

/// The gradient passes to where the knot would be: one that is held up can still find its way.
fn ascending(hinted: Tensor<1>, knots: usize) -> Tensor<1> {
    if knots < 2 {
        return hinted;
    }
    let [count] = hinted.dims();
    let rows = hinted.clone().detach().reshape([count / knots, knots]);
    let mut columns = vec![rows.clone().narrow(1, 0, 1)];
    for k in 1..knots {
        let least = columns[k - 1].clone().add_scalar(MIN_KNOT_GAP);
        columns.push(rows.clone().narrow(1, k, 1).max_pair(least));
    }
    let moved = Tensor::cat(columns, 1).reshape([count]) - hinted.clone().detach();
    hinted + moved
}

fn straight_through<const D: usize>(weights: &Tensor<D>, steps: f32) -> Tensor<D> {
    let plain = weights.clone().detach();
    let error = plain.clone().mul_scalar(steps).round().div_scalar(steps) - plain;
    weights.clone() + error
}

/// Plain coordinates (em) of a set of lines and the slope of the inverse warp (em per em).
fn unwarp(lines: &Lines, hinted: &Tensor<1>) -> (Tensor<1>, Tensor<1>) {
    if lines.knot_count == 0 {
        return (lines.at.clone() / lines.ppem.clone(), lines.ppem.clone().ones_like());
    }
    let shape = lines.knots.dims();
    let [count, knots] = shape;
    let at_knots = hinted.clone().select(0, lines.hinted.clone()).reshape(shape);
    let first = at_knots.clone().narrow(1, 0, 1).reshape([count]);
    let last = hinted.clone().select(0, lines.last.clone());
    let next =
        Tensor::cat(vec![at_knots.clone().narrow(1, 1, knots - 1), last.clone().reshape([count, 1])], 1);
    let gap = (next - at_knots.clone()).clamp_min(MIN_KNOT_GAP);
    let start = lines.knots.clone().narrow(1, 0, 1).reshape([count]);
    let point = |at: Tensor<1>| {
        let within = (at.clone().reshape([count, 1]) - at_knots.clone()) / gap.clone();
        let inside = (within.clamp(0.0, 1.0) * lines.gaps.clone()).sum_dim(1).reshape([count]);
        let beyond = (at.clone() - first.clone()).clamp_max(0.0) + (at - last.clone()).clamp_min(0.0);
        start.clone() + inside + beyond / lines.ppem.clone()
    };
    let low = point(lines.at.clone() - lines.reach.clone());
    let high = point(lines.at.clone() + lines.reach.clone());
    let slope = (high.clone() - low.clone()) / lines.reach.clone().mul_scalar(2.0) * lines.ppem.clone();
    ((low + high).mul_scalar(0.5), slope)
}

/// The columns of a group, contracted: what is left to evaluate along y.
struct Columns {
    /// Spline coefficients along y `[glyphs · columns · coefficients]`.
    value: Tensor<1>,
    /// The same for the derivative along x.
    slope: Tensor<1>,
    /// The deformation in pixels at its nodes along y `[glyphs · columns · nodes]`.
    deform: Tensor<1>,
}

/// The part of a column that only depends on where it lies.
pub(super) struct ColumnBasis {
    value: Tensor<3>,
    slope: Tensor<3>,
    hats: Tensor<3>,
}

pub(super) fn column_basis(columns: &Lines, hinted: &Tensor<1>, extent: Extent) -> ColumnBasis {
    let device = columns.at.device();
    let (x, slope) = unwarp(columns, hinted);
    let lines = extent.glyphs * columns.count;
    let coefficients = extent.coefficients[0];
    let ramp = |count: usize, shift: f32| {
        tensor((0..count).map(|k| k as f32 - shift).collect(), [1, count], &device)
    };
    let u = ((x.clone() - columns.origin.clone()) * columns.cells_per_em.clone())
        .clamp_min(0.0)
        .min_pair(columns.cells.clone());
    let z = u.reshape([lines, 1]) - ramp(coefficients, 0.5);
    let distance = z.clone().abs();
    let outer = (-distance.clone()).add_scalar(1.5).clamp_min(0.0);
    let inner = (-distance).add_scalar(0.5).clamp_min(0.0);
    let value = (outer.clone().square() - inner.clone().square().mul_scalar(3.0)).mul_scalar(0.5);
    let per_em = (columns.cells_per_em.clone() * slope).reshape([lines, 1]);
    let derivative = z.sign() * (inner.mul_scalar(3.0) - outer) * per_em;
    let last = (DEFORM_NODES - 1) as f32;
    let node = ((x - columns.origin.clone()) * columns.cells_per_em.clone() / columns.cells.clone())
        .mul_scalar(last)
        .clamp(0.0, last);
    let hats = (-(node.reshape([lines, 1]) - ramp(DEFORM_NODES, 0.0)).abs()).add_scalar(1.0).clamp_min(0.0);
    let shape = |width: usize| [extent.glyphs, columns.count, width];
    ColumnBasis {
        value: value.reshape(shape(coefficients)),
        slope: derivative.reshape(shape(coefficients)),
        hats: hats.reshape(shape(DEFORM_NODES)),
    }
}

fn contract(basis: &ColumnBasis, columns: &Lines, weights: &Parameters, extent: Extent) -> Columns {
    let lines = extent.glyphs * columns.count;
    let flat = lines * extent.coefficients[1];
    let value = basis.value.clone().matmul(weights.field.clone()).reshape([flat]);
    let slope = basis.slope.clone().matmul(weights.field.clone()).reshape([flat]);
    let each = basis.hats.clone().matmul(weights.patterns.clone());
    let share = weights.embedding.clone().select(0, columns.size.clone());
    let deform = each.reshape([lines, extent.rank, DEFORM_NODES]) * share.reshape([lines, extent.rank, 1]);
    Columns { value, slope, deform: deform.sum_dim(1).reshape([lines * DEFORM_NODES]) }
}

/// Signed distance to the edge in samples (first order) and coverage of every sample.
struct Drawn {
    distance: Tensor<1>,
    coverage: Tensor<1>,
}

fn draw(columns: &Columns, rows: &Lines, hinted: &Tensor<1>, samples: &Samples) -> Drawn {
    let (y, slope) = unwarp(rows, hinted);
    let (y, slope) = (y.select(0, samples.row.clone()), slope.select(0, samples.row.clone()));
    let last = (DEFORM_NODES - 1) as f32;
    let node = ((y.clone() - samples.origin.clone()) * samples.nodes_per_em.clone()).clamp(0.0, last);
    let whole = node.clone().detach().floor().clamp_max(last - 1.0);
    let share = node - whole.clone();
    let at = (whole + samples.nodes.clone()).int();
    let low = columns.deform.clone().select(0, at.clone());
    let high = columns.deform.clone().select(0, at.add_scalar(1));
    let moved = low.clone() + (high - low) * share;
    // Back through the warp, to first order.
    let y = y + moved * samples.per_ppem.clone() * slope.clone();
    let v = ((y - samples.origin.clone()) * samples.cells_per_em.clone())
        .clamp_min(0.0)
        .min_pair(samples.cells.clone());
    let cell = v.clone().detach().floor().min_pair(samples.cells.clone().sub_scalar(1.0));
    let t = v - cell.clone();
    let at = (cell + samples.column.clone()).int();
    let s = (-t.clone()).add_scalar(1.0);
    let w = [
        s.clone().square().mul_scalar(0.5),
        (t.clone() * s).add_scalar(0.5),
        t.clone().square().mul_scalar(0.5),
    ];
    let d = [t.clone().sub_scalar(1.0), t.clone().mul_scalar(-2.0).add_scalar(1.0), t];
    let pick = |from: &Tensor<1>| {
        [0, 1, 2].map(|k| from.clone().select(0, if k == 0 { at.clone() } else { at.clone().add_scalar(k) }))
    };
    let (value, across) = (pick(&columns.value), pick(&columns.slope));
    let dot = |a: &[Tensor<1>; 3], b: &[Tensor<1>; 3]| {
        a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone() + a[2].clone() * b[2].clone()
    };
    let field = dot(&w, &value) * samples.samples_per_em.clone();
    let gx = dot(&w, &across).abs();
    let gy = (dot(&d, &value) * samples.cells_per_em.clone() * slope).abs();
    half_plane(field, gx, gy)
}

fn half_plane(field: Tensor<1>, gx: Tensor<1>, gy: Tensor<1>) -> Drawn {
    let a = gx.clone().max_pair(gy.clone()).clamp_min(MIN_GRADIENT);
    let b = gx.min_pair(gy).max_pair(a.clone().mul_scalar(MIN_SKEW));
    let sign = field.clone().detach().sign();
    let m = field * sign.clone();
    let distance = m.clone() / a.clone();
    let ratio = b / a;
    // Everything over a: an edge at `distance` whose smaller gradient component is `ratio` of the larger.
    let rest = (ratio.clone().add_scalar(1.0).mul_scalar(0.5) - distance.clone()).clamp_min(0.0);
    let corner = rest.square() / ratio.clone().mul_scalar(2.0);
    let straight = (-distance.clone()).add_scalar(0.5);
    let near = distance.clone().lower_equal((-ratio).add_scalar(1.0).mul_scalar(0.5));
    let outside = corner.mask_where(near, straight);
    let coverage = sign.clone() * (-outside).add_scalar(0.5);
    Drawn { distance: distance * sign, coverage: coverage.add_scalar(0.5) }
}

/// Weight of the absolute error beside the squared one.
const ABSOLUTE: f32 = 0.2;
/// Weight of the penalty on samples that are saturated on the wrong side, where coverage has no gradient.
const SATURATED: f32 = 0.02;
/// A sample is saturated from this distance (samples) on.
const SATURATION: f32 = 0.7;
/// The penalty grows no further than this distance (samples).
const FAR: f32 = 8.0;

/// The loss of one group: every pixel's error, and what keeps lost samples findable.
pub(super) fn loss(
    group: &Group,
    basis: Option<&ColumnBasis>,
    weights: &Parameters,
    extent: Extent,
) -> Tensor<1> {
    let own;
    let basis = match basis {
        Some(basis) => basis,
        None => {
            own = column_basis(&group.columns, &weights.hinted[0], extent);
            &own
        }
    };
    let columns = contract(basis, &group.columns, weights, extent);
    let samples = &group.samples;
    let drawn = draw(&columns, &group.rows, &weights.hinted[1], samples);
    let pixels: Vec<Tensor<1>> = samples
        .runs
        .iter()
        .map(|&(first, pixels, each)| {
            let run = drawn.coverage.clone().narrow(0, first, pixels * each);
            if each == 1 { run } else { run.reshape([pixels, each]).mean_dim(1).reshape([pixels]) }
        })
        .collect();
    let error = Tensor::cat(pixels, 0) - samples.target.clone();
    let close = error.clone().abs().mul_scalar(ABSOLUTE) + error.square();
    let lost = drawn.distance.clone().abs().sub_scalar(SATURATION).clamp(0.0, FAR);
    let wrong = (drawn.distance.detach() * samples.side.clone()).lower_equal_elem(0.0).float();
    let count = samples.target.dims()[0] as f32;
    close.sum().div_scalar(count)
        + (lost * wrong * samples.certain.clone()).sum().mul_scalar(SATURATED / count)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod twin;
