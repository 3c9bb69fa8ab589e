//! The first guess of the deformation: what the warp leaves of the points' moves, as a few patterns whose
//! strength changes with the size.

use nfr::internals::model::gridfit::{DEFORM_NODES, GridAxis};

/// Patterns and their strengths.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Deformation {
    /// Patterns one after the other, each `DEFORM_NODES`² values of at most 1, bottom row first.
    pub(super) patterns: Vec<Vec<f32>>,
    /// For each pattern, its strength in pixels at each size.
    pub(super) strengths: Vec<Vec<f32>>,
}

const NODES: usize = DEFORM_NODES * DEFORM_NODES;
/// How much neighbouring nodes are held together, as a share of the weight of all points.
const SMOOTHNESS: f64 = 1e-4;
/// Rounds of the power iteration that begins a pattern, and of the refinement that follows.
const ROUNDS: usize = 12;

/// One point at one size: where the renderer looks the deformation up (em), and by how much it has to move
/// the look-up (pixels).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    pub(super) at: [f32; 2],
    pub(super) by: f64,
}

/// Finds up to `most` patterns that explain `samples[size][point]`. The search ends when the mean square that
/// is left is below `good_enough` (pixels²) at every size.
pub(super) fn fit(
    samples: &[Vec<Sample>],
    grid: [GridAxis; 2],
    most: usize,
    good_enough: f64,
) -> Deformation {
    let mut found = Deformation::default();
    let hats: Vec<Vec<Hat>> =
        samples.iter().map(|row| row.iter().map(|s| hat(s.at, grid)).collect()).collect();
    let mut left: Vec<Vec<f64>> = samples.iter().map(|row| row.iter().map(|s| s.by).collect()).collect();
    for _ in 0..most {
        let worst = left.iter().map(|row| energy(row) / row.len().max(1) as f64).fold(0.0, f64::max);
        if worst < good_enough {
            break;
        }
        // A size counts by what is left at it, so that the patterns see to the worst sizes first: a glyph may
        // move in its own way at a single size.
        let importance: Vec<f64> = left.iter().map(|row| energy(row)).collect();
        let Some(along_points) = strongest(&left, &importance) else { break };
        let mut strengths: Vec<f64> = left.iter().map(|row| dot(row, &along_points)).collect();
        let mut nodes = vec![0.0; NODES];
        for _ in 0..ROUNDS {
            nodes = best_nodes(&hats, &left, &strengths, &importance);
            for ((strength, hats), row) in strengths.iter_mut().zip(&hats).zip(&left) {
                let fitted: Vec<f64> = hats.iter().map(|h| value(h, &nodes)).collect();
                *strength = dot(row, &fitted) / energy(&fitted).max(1e-12);
            }
        }
        let largest = nodes.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        if largest <= 0.0 {
            break;
        }
        for ((row, hats), strength) in left.iter_mut().zip(&hats).zip(&strengths) {
            row.iter_mut().zip(hats).for_each(|(left, hat)| *left -= strength * value(hat, &nodes));
        }
        found.patterns.push(nodes.iter().map(|v| (v / largest) as f32).collect());
        found.strengths.push(strengths.iter().map(|s| (s * largest) as f32).collect());
    }
    found
}

/// The four nodes around a place and their bilinear weights.
type Hat = [(usize, f64); 4];

fn value(hat: &Hat, nodes: &[f64]) -> f64 {
    hat.iter().map(|(node, weight)| nodes[*node] * weight).sum()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The pattern that explains most with given strengths, by least squares.
fn best_nodes(hats: &[Vec<Hat>], left: &[Vec<f64>], strengths: &[f64], importance: &[f64]) -> Vec<f64> {
    let (mut matrix, mut right) = (vec![0.0; NODES * NODES], vec![0.0; NODES]);
    let mut weight = 0.0;
    for (((hats, row), strength), importance) in hats.iter().zip(left).zip(strengths).zip(importance) {
        for (hat, by) in hats.iter().zip(row) {
            for (a, wa) in hat {
                right[*a] += importance * strength * by * wa;
                let scale = importance * strength * strength * wa;
                hat.iter().for_each(|(b, wb)| matrix[a * NODES + b] += scale * wb);
            }
            weight += importance * strength * strength;
        }
    }
    hold_together(&mut matrix, SMOOTHNESS * weight.max(1e-12));
    cholesky(&mut matrix);
    solve(&matrix, &mut right);
    right
}

fn energy(row: &[f64]) -> f64 {
    row.iter().map(|v| v * v).sum()
}

/// The direction that explains most, by power iteration.
fn strongest(rows: &[Vec<f64>], importance: &[f64]) -> Option<Vec<f64>> {
    let mut vector = rows.iter().max_by(|a, b| energy(a).total_cmp(&energy(b)))?.clone();
    for _ in 0..ROUNDS {
        let norm = energy(&vector).sqrt();
        if norm <= 1e-9 {
            return None;
        }
        vector.iter_mut().for_each(|v| *v /= norm);
        let mut next = vec![0.0; vector.len()];
        for (row, importance) in rows.iter().zip(importance) {
            let strength = dot(row, &vector) * importance;
            next.iter_mut().zip(row).for_each(|(sum, v)| *sum += strength * v);
        }
        vector = next;
    }
    Some(vector)
}

fn hat(point: [f32; 2], grid: [GridAxis; 2]) -> Hat {
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

/// Adds a pull between neighbouring nodes, and a trace of one towards zero, so that nodes without points
/// are determined too.
fn hold_together(matrix: &mut [f64], pull: f64) {
    for node in 0..NODES {
        matrix[node * NODES + node] += pull * 1e-2;
        let right = (node % DEFORM_NODES + 1 < DEFORM_NODES).then_some(node + 1);
        let above = (node + DEFORM_NODES < NODES).then_some(node + DEFORM_NODES);
        for other in [right, above].into_iter().flatten() {
            matrix[node * NODES + node] += pull;
            matrix[other * NODES + other] += pull;
            matrix[node * NODES + other] -= pull;
            matrix[other * NODES + node] -= pull;
        }
    }
}

/// Turns a symmetric positive definite matrix into its lower Cholesky factor.
fn cholesky(matrix: &mut [f64]) {
    for j in 0..NODES {
        for i in j..NODES {
            let dot: f64 = (0..j).map(|k| matrix[i * NODES + k] * matrix[j * NODES + k]).sum();
            let rest = matrix[i * NODES + j] - dot;
            matrix[i * NODES + j] =
                if i == j { rest.max(1e-12).sqrt() } else { rest / matrix[j * NODES + j] };
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> [GridAxis; 2] {
        [GridAxis::new(0.0, 0.6, 18), GridAxis::new(-0.2, 0.7, 27)]
    }

    fn points() -> Vec<[f32; 2]> {
        (0..60)
            .map(|k| [0.6 * ((k * 7) % 60) as f32 / 60.0, -0.2 + 0.9 * ((k * 13) % 60) as f32 / 60.0])
            .collect()
    }

    /// Mean square of the worst size that patterns leave of moves.
    fn worst_left(found: &Deformation, moves: &[Vec<f64>]) -> f64 {
        let left = moves.iter().enumerate().map(|(size, row)| {
            let squares = points().into_iter().zip(row).map(|(point, moved)| {
                let each = found.patterns.iter().zip(&found.strengths).map(|(pattern, strength)| {
                    let nodes: Vec<f64> = pattern.iter().map(|v| f64::from(*v)).collect();
                    value(&hat(point, grid()), &nodes) * f64::from(strength[size])
                });
                (moved - each.sum::<f64>()).powi(2)
            });
            squares.sum::<f64>() / row.len() as f64
        });
        left.fold(0.0, f64::max)
    }

    fn samples(moves: &[Vec<f64>]) -> Vec<Vec<Sample>> {
        let row =
            |row: &Vec<f64>| points().into_iter().zip(row).map(|(at, by)| Sample { at, by: *by }).collect();
        moves.iter().map(row).collect()
    }

    /// Moves of two smooth kinds whose strengths change with the size.
    fn two_kinds() -> Vec<Vec<f64>> {
        let kinds = |p: &[f32; 2]| [f64::from(p[0]), f64::from(p[0] * p[1]) - 0.1];
        (0..9)
            .map(|size| {
                let strengths = [0.8 * f64::from(size % 3) - 0.5, 1.5 - 0.3 * f64::from(size)];
                points().iter().map(|p| kinds(p)[0] * strengths[0] + kinds(p)[1] * strengths[1]).collect()
            })
            .collect()
    }

    #[test]
    fn two_patterns_explain_moves_of_two_kinds() {
        let moves = two_kinds();
        let found = fit(&samples(&moves), grid(), 8, 1e-4);
        assert!(found.patterns.len() >= 2);
        assert!(worst_left(&found, &moves) <= 1e-4);
        let two = fit(&samples(&moves), grid(), 2, 0.0);
        assert!(worst_left(&two, &moves) <= 1e-3, "{}", worst_left(&two, &moves));
    }

    #[test]
    fn patterns_are_no_more_than_asked_for_and_no_larger_than_one() {
        let found = fit(&samples(&two_kinds()), grid(), 1, 0.0);
        assert_eq!(found.patterns.len(), 1);
        assert!(found.patterns[0].iter().all(|v| v.abs() <= 1.0));
    }

    #[test]
    fn points_that_do_not_move_need_no_pattern() {
        let still = samples(&vec![vec![0.0; 60]; 3]);
        assert_eq!(fit(&still, grid(), 8, 0.01), Deformation::default());
        assert_eq!(fit(&still, grid(), 8, 0.0), Deformation::default());
        assert_eq!(fit(&vec![Vec::new(); 3], grid(), 8, 0.0), Deformation::default());
        assert_eq!(fit(&[], grid(), 8, 0.0), Deformation::default());
    }
}
