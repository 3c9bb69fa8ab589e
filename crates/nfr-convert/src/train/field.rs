//! The differentiable renderer of the training, in burn: the coverage of a whole group's subpixel samples, from the field,
//! the warp and the deformation. The renderer of `nfr` traces the field's zero level and fills it instead.

use burn::tensor::Tensor;

use super::batch::{Extent, SampleLines, SizeGroup, SubpixelSamples};
use super::coverage::{MIN_GRADIENT, MIN_SKEW};
use super::tensors::{ParameterTensors, tensor};
use nfr::internals::model::gridfit::{DEFORM_NODES, MIN_KNOT_GAP};

/// The unhinted coordinates (em) of lines, and the slope of the inverse warp there (em per em).
fn unwarp(lines: &SampleLines, hinted: &Tensor<1>) -> (Tensor<1>, Tensor<1>) {
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
        let outside = (at.clone() - first.clone()).clamp_max(0.0) + (at - last.clone()).clamp_min(0.0);
        start.clone() + inside + outside / lines.ppem.clone()
    };
    let low = point(lines.at.clone() - lines.reach.clone());
    let high = point(lines.at.clone() + lines.reach.clone());
    let slope = (high.clone() - low.clone()) / lines.reach.clone().mul_scalar(2.0) * lines.ppem.clone();
    ((low + high).mul_scalar(0.5), slope)
}

/// The field and the deformation, evaluated along x at each column: B-splines and nodes along y remain.
struct Columns {
    /// Spline coefficients along y `[glyphs · columns · coefficients]`.
    value: Tensor<1>,
    /// The same for the derivative along x.
    slope: Tensor<1>,
    /// The deformation in pixels at its nodes along y `[glyphs · columns · nodes]`.
    deform: Tensor<1>,
}

/// The basis functions of each column, which depend on its position only.
pub(super) struct ColumnBasis {
    value: Tensor<3>,
    slope: Tensor<3>,
    hats: Tensor<3>,
}

pub(super) fn column_basis(columns: &SampleLines, hinted: &Tensor<1>, extent: Extent) -> ColumnBasis {
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

fn contract(
    basis: &ColumnBasis,
    columns: &SampleLines,
    weights: &ParameterTensors,
    extent: Extent,
) -> Columns {
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

fn draw(columns: &Columns, rows: &SampleLines, hinted: &Tensor<1>, samples: &SubpixelSamples) -> Drawn {
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
    // In units of a: an edge at `distance` whose smaller gradient component is `ratio` of the larger.
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

/// The loss of one group: the error of every pixel, and a penalty that gives saturated samples on the wrong side a
/// gradient.
pub(super) fn loss(
    group: &SizeGroup,
    basis: Option<&ColumnBasis>,
    weights: &ParameterTensors,
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
