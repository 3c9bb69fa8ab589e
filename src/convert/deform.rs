//! The first guess of the deformation: what the warp leaves of the points' moves, as a few patterns whose
//! strength changes with the size.

use crate::model::gridfit::{DEFORM_NODES, GridAxis};

/// Patterns and their strengths.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Deformation {
    /// Patterns one after the other, each `DEFORM_NODES`² values of at most 1, bottom row first.
    pub(super) patterns: Vec<Vec<f32>>,
    /// For each pattern, its strength in pixels at each size.
    pub(super) strengths: Vec<Vec<f32>>,
}

const NODES: usize = DEFORM_NODES * DEFORM_NODES;
/// How much neighbouring nodes are held together, in points.
const SMOOTHNESS: f64 = 0.02;
/// Rounds of the power iteration; the strongest pattern need not be exact.
const ROUNDS: usize = 24;

/// Finds up to `most` patterns that explain `left[size][point]` (pixels) at the points' plain positions (em).
/// The search ends when the mean square that is left is below `good_enough` (pixels²) at every size.
pub(super) fn fit(
    points: &[[f32; 2]],
    mut left: Vec<Vec<f64>>,
    grid: [GridAxis; 2],
    most: usize,
    good_enough: f64,
) -> Deformation {
    let mut found = Deformation::default();
    if points.is_empty() || left.is_empty() {
        return found;
    }
    let hats: Vec<[(usize, f64); 4]> = points.iter().map(|p| hat(*p, grid)).collect();
    let factor = cholesky(normal_matrix(&hats));
    for _ in 0..most {
        let worst = left.iter().map(|row| energy(row)).fold(0.0, f64::max);
        if worst < good_enough * points.len() as f64 {
            break;
        }
        let Some(along_points) = strongest(&left) else { break };
        let mut nodes = vec![0.0; NODES];
        for (hat, value) in hats.iter().zip(&along_points) {
            hat.iter().for_each(|(node, weight)| nodes[*node] += weight * value);
        }
        solve(&factor, &mut nodes);
        let fitted: Vec<f64> =
            hats.iter().map(|h| h.iter().map(|(node, w)| nodes[*node] * w).sum()).collect();
        let norm: f64 = fitted.iter().map(|v| v * v).sum();
        let largest = nodes.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        if norm <= 0.0 || largest <= 0.0 {
            break;
        }
        let strengths: Vec<f64> =
            left.iter().map(|row| row.iter().zip(&fitted).map(|(a, b)| a * b).sum::<f64>() / norm).collect();
        for (row, strength) in left.iter_mut().zip(&strengths) {
            row.iter_mut().zip(&fitted).for_each(|(value, f)| *value -= strength * f);
        }
        found.patterns.push(nodes.iter().map(|v| (v / largest) as f32).collect());
        found.strengths.push(strengths.iter().map(|s| (s * largest) as f32).collect());
    }
    found
}

fn energy(row: &[f64]) -> f64 {
    row.iter().map(|v| v * v).sum()
}

/// The direction that explains most, by power iteration. A size counts by its energy squared, so that the
/// patterns see to the worst sizes first: a glyph may move in its own way at a single size.
fn strongest(rows: &[Vec<f64>]) -> Option<Vec<f64>> {
    let mut vector = rows.iter().max_by(|a, b| energy(a).total_cmp(&energy(b)))?.clone();
    for _ in 0..ROUNDS {
        let norm = energy(&vector).sqrt();
        if norm <= 1e-9 {
            return None;
        }
        vector.iter_mut().for_each(|v| *v /= norm);
        let mut next = vec![0.0; vector.len()];
        for row in rows {
            let strength: f64 = row.iter().zip(&vector).map(|(a, b)| a * b).sum::<f64>() * energy(row);
            next.iter_mut().zip(row).for_each(|(sum, v)| *sum += strength * v);
        }
        vector = next;
    }
    Some(vector)
}

/// The four nodes around a point and their bilinear weights.
fn hat(point: [f32; 2], grid: [GridAxis; 2]) -> [(usize, f64); 4] {
    let [(column, tx), (row, ty)] = [0, 1].map(|k| grid[k].locate_node(point[k]));
    let (tx, ty) = (f64::from(tx), f64::from(ty));
    let at = row * DEFORM_NODES + column;
    [
        (at, (1.0 - tx) * (1.0 - ty)),
        (at + 1, tx * (1.0 - ty)),
        (at + DEFORM_NODES, (1.0 - tx) * ty),
        (at + DEFORM_NODES + 1, tx * ty),
    ]
}

fn normal_matrix(hats: &[[(usize, f64); 4]]) -> Vec<f64> {
    let mut matrix = vec![0.0; NODES * NODES];
    for hat in hats {
        for (a, wa) in hat {
            hat.iter().for_each(|(b, wb)| matrix[a * NODES + b] += wa * wb);
        }
    }
    for node in 0..NODES {
        // A trace of its own weight keeps the matrix definite.
        matrix[node * NODES + node] += SMOOTHNESS * 1e-2;
        let right = (node % DEFORM_NODES + 1 < DEFORM_NODES).then_some(node + 1);
        let above = (node + DEFORM_NODES < NODES).then_some(node + DEFORM_NODES);
        for other in [right, above].into_iter().flatten() {
            matrix[node * NODES + node] += SMOOTHNESS;
            matrix[other * NODES + other] += SMOOTHNESS;
            matrix[node * NODES + other] -= SMOOTHNESS;
            matrix[other * NODES + node] -= SMOOTHNESS;
        }
    }
    matrix
}

/// Lower Cholesky factor of a symmetric positive definite matrix.
fn cholesky(mut matrix: Vec<f64>) -> Vec<f64> {
    for j in 0..NODES {
        for i in j..NODES {
            let dot: f64 = (0..j).map(|k| matrix[i * NODES + k] * matrix[j * NODES + k]).sum();
            let rest = matrix[i * NODES + j] - dot;
            matrix[i * NODES + j] =
                if i == j { rest.max(1e-12).sqrt() } else { rest / matrix[j * NODES + j] };
        }
    }
    matrix
}

fn solve(factor: &[f64], right: &mut [f64]) {
    for i in 0..NODES {
        let dot: f64 = (0..i).map(|k| factor[i * NODES + k] * right[k]).sum();
        right[i] = (right[i] - dot) / factor[i * NODES + i];
    }
    for i in (0..NODES).rev() {
        let dot: f64 = (i + 1..NODES).map(|k| factor[k * NODES + i] * right[k]).sum();
        right[i] = (right[i] - dot) / factor[i * NODES + i];
    }
}
