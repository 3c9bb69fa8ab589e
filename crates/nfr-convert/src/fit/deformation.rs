//! The initial fit of the deformation: a low-rank approximation of the points' residual moves after the warp. Each
//! pattern has a strength for each size; patterns and strengths are fitted by alternating least squares.

use nfr::internals::model::gridfit::{DEFORM_NODES, GridAxis};

/// Patterns and their strengths.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Deformation {
    /// Patterns of `DEFORM_NODES`² values of at most 1, bottom row first.
    pub(super) patterns: Vec<Vec<f32>>,
    /// For each pattern, its strength in pixels at each size.
    pub(super) strengths: Vec<Vec<f32>>,
}

const NODES: usize = DEFORM_NODES * DEFORM_NODES;
/// The weight of neighbouring nodes' differences, as a share of the weight of all points.
const SMOOTHNESS: f64 = 1e-4;
/// Rounds of the power iteration that begins a pattern, and of the alternating least squares that follow.
const ROUNDS: usize = 12;

/// The residual move of one point at one size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Displacement {
    /// Where the renderer evaluates the deformation, in em.
    pub(super) at: [f32; 2],
    /// In pixels, downwards.
    pub(super) by: f64,
}

/// Fits up to `most` patterns to `moves[size][point]`, until the mean squared residual is below `max_residual`
/// (pixels²) at every size.
pub(super) fn fit(
    moves: &[Vec<Displacement>],
    grid: [GridAxis; 2],
    most: usize,
    max_residual: f64,
) -> Deformation {
    let mut found = Deformation::default();
    let hats: Vec<Vec<Hat>> = moves.iter().map(|row| row.iter().map(|s| hat(s.at, grid)).collect()).collect();
    let mut residuals: Vec<Vec<f64>> = moves.iter().map(|row| row.iter().map(|s| s.by).collect()).collect();
    for _ in 0..most {
        let worst = residuals.iter().map(|row| energy(row) / row.len().max(1) as f64).fold(0.0, f64::max);
        if worst < max_residual {
            break;
        }
        // A size's weight is its residual, so that the worst sizes are fitted first: hinting may deform a glyph at a
        // single size.
        let importance: Vec<f64> = residuals.iter().map(|row| energy(row)).collect();
        let Some(along_points) = principal_direction(&residuals, &importance) else { break };
        let mut strengths: Vec<f64> = residuals.iter().map(|row| dot(row, &along_points)).collect();
        let mut nodes = vec![0.0; NODES];
        for _ in 0..ROUNDS {
            nodes = best_nodes(&hats, &residuals, &strengths, &importance);
            for ((strength, hats), row) in strengths.iter_mut().zip(&hats).zip(&residuals) {
                let fitted: Vec<f64> = hats.iter().map(|h| value(h, &nodes)).collect();
                *strength = dot(row, &fitted) / energy(&fitted).max(1e-12);
            }
        }
        let largest = nodes.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        if largest <= 0.0 {
            break;
        }
        for ((row, hats), strength) in residuals.iter_mut().zip(&hats).zip(&strengths) {
            row.iter_mut().zip(hats).for_each(|(residual, hat)| *residual -= strength * value(hat, &nodes));
        }
        found.patterns.push(nodes.iter().map(|v| (v / largest) as f32).collect());
        found.strengths.push(strengths.iter().map(|s| (s * largest) as f32).collect());
    }
    found
}

/// The four nodes around a point and their bilinear weights.
type Hat = [(usize, f64); 4];

fn value(hat: &Hat, nodes: &[f64]) -> f64 {
    hat.iter().map(|(node, weight)| nodes[*node] * weight).sum()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The pattern with the least squared residual for given strengths.
fn best_nodes(hats: &[Vec<Hat>], residuals: &[Vec<f64>], strengths: &[f64], importance: &[f64]) -> Vec<f64> {
    let (mut matrix, mut right) = (vec![0.0; NODES * NODES], vec![0.0; NODES]);
    let mut weight = 0.0;
    for (((hats, row), strength), importance) in hats.iter().zip(residuals).zip(strengths).zip(importance) {
        for (hat, by) in hats.iter().zip(row) {
            for (a, wa) in hat {
                right[*a] += importance * strength * by * wa;
                let scale = importance * strength * strength * wa;
                hat.iter().for_each(|(b, wb)| matrix[a * NODES + b] += scale * wb);
            }
            weight += importance * strength * strength;
        }
    }
    add_smoothness(&mut matrix, SMOOTHNESS * weight.max(1e-12));
    cholesky(&mut matrix);
    solve(&matrix, &mut right);
    right
}

fn energy(row: &[f64]) -> f64 {
    row.iter().map(|v| v * v).sum()
}

/// The first principal direction of the rows, by power iteration.
fn principal_direction(rows: &[Vec<f64>], importance: &[f64]) -> Option<Vec<f64>> {
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

/// Adds a penalty on the differences of neighbouring nodes, and a hundredth of it on the nodes themselves, so that nodes
/// without points are determined too (Tikhonov regularisation).
fn add_smoothness(matrix: &mut [f64], penalty: f64) {
    for node in 0..NODES {
        matrix[node * NODES + node] += penalty * 1e-2;
        let right = (node % DEFORM_NODES + 1 < DEFORM_NODES).then_some(node + 1);
        let above = (node + DEFORM_NODES < NODES).then_some(node + DEFORM_NODES);
        for other in [right, above].into_iter().flatten() {
            matrix[node * NODES + node] += penalty;
            matrix[other * NODES + other] += penalty;
            matrix[node * NODES + other] -= penalty;
            matrix[other * NODES + node] -= penalty;
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

    /// The mean squared residual at the worst size.
    fn worst_residual(found: &Deformation, moves: &[Vec<f64>]) -> f64 {
        let residuals = moves.iter().enumerate().map(|(size, row)| {
            let squares = points().into_iter().zip(row).map(|(point, moved)| {
                let each = found.patterns.iter().zip(&found.strengths).map(|(pattern, strength)| {
                    let nodes: Vec<f64> = pattern.iter().map(|v| f64::from(*v)).collect();
                    value(&hat(point, grid()), &nodes) * f64::from(strength[size])
                });
                (moved - each.sum::<f64>()).powi(2)
            });
            squares.sum::<f64>() / row.len() as f64
        });
        residuals.fold(0.0, f64::max)
    }

    fn displacements(moves: &[Vec<f64>]) -> Vec<Vec<Displacement>> {
        let row = |row: &Vec<f64>| {
            points().into_iter().zip(row).map(|(at, by)| Displacement { at, by: *by }).collect()
        };
        moves.iter().map(row).collect()
    }

    /// Moves of two smooth components whose strengths change with the size.
    fn two_components() -> Vec<Vec<f64>> {
        let components = |p: &[f32; 2]| [f64::from(p[0]), f64::from(p[0] * p[1]) - 0.1];
        (0..9)
            .map(|size| {
                let strengths = [0.8 * f64::from(size % 3) - 0.5, 1.5 - 0.3 * f64::from(size)];
                points()
                    .iter()
                    .map(|p| components(p)[0] * strengths[0] + components(p)[1] * strengths[1])
                    .collect()
            })
            .collect()
    }

    #[test]
    fn two_patterns_explain_moves_of_two_components() {
        let moves = two_components();
        let found = fit(&displacements(&moves), grid(), 8, 1e-4);
        assert!(found.patterns.len() >= 2);
        assert!(worst_residual(&found, &moves) <= 1e-4);
        let two = fit(&displacements(&moves), grid(), 2, 0.0);
        assert!(worst_residual(&two, &moves) <= 1e-3, "{}", worst_residual(&two, &moves));
    }

    #[test]
    fn patterns_are_no_more_than_asked_for_and_no_larger_than_one() {
        let found = fit(&displacements(&two_components()), grid(), 1, 0.0);
        assert_eq!(found.patterns.len(), 1);
        assert!(found.patterns[0].iter().all(|v| v.abs() <= 1.0));
    }

    #[test]
    fn points_that_do_not_move_need_no_pattern() {
        let unmoved = displacements(&vec![vec![0.0; 60]; 3]);
        assert_eq!(fit(&unmoved, grid(), 8, 0.01), Deformation::default());
        assert_eq!(fit(&unmoved, grid(), 8, 0.0), Deformation::default());
        assert_eq!(fit(&vec![Vec::new(); 3], grid(), 8, 0.0), Deformation::default());
        assert_eq!(fit(&[], grid(), 8, 0.0), Deformation::default());
    }
}
