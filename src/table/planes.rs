//! Coding of a model's arrays: the field's coefficients, the deformation's patterns, and their weights.

use alloc::vec;

use super::context_model::{ContextModel, class};
use super::elements::{CLIPPED, COEFFICIENT, EMBEDDING, LEAST, PATTERN};
use super::range::Coder;
use super::warp;
use crate::error::Damage;
use crate::model::grid::DEFORM_NODES;
use crate::model::gridfit::{FIELD_LIMIT, FIELD_STEPS, Weights};
use crate::model::sizes::Scale;

/// A coefficient at the lower limit of the field, and the value that coefficients outside the grid are taken to have.
const CLIP: i32 = -((FIELD_LIMIT * FIELD_STEPS) as i32);
/// The least value of a coefficient.
const LEAST_COEFFICIENT: i32 = -127;
// As the specification has it.
const _: () = assert!(CLIP == -92);

/// The context of a row or column: the first, the second, inside, the last but one, the last.
fn edge(at: usize, count: usize) -> usize {
    match at {
        0 | 1 => at,
        _ if at + 1 == count => 4,
        _ if at + 2 == count => 3,
        _ => 2,
    }
}

/// Codes the field's coefficients. They are predicted by the median edge detector of LOCO-I (JPEG-LS).
pub(super) fn field<C: Coder>(model: &mut ContextModel<'_, C>, weights: &mut Weights) -> Result<(), Damage> {
    let [width, height] = weights.cells.map(|cells| usize::from(cells) + 2);
    weights.field.resize(width * height, 0);
    // With a border to the left, to the right and below.
    let stride = width + 2;
    let mut values = vec![CLIP; stride * (height + 1)];
    let mut errors = vec![0i32; stride * (height + 1)];
    let level = |value: i32| class(value, [-110, -91, -60, -25, 10, 50]);
    let pattern = |is: [bool; 4]| is.iter().rev().fold(0, |all, is| 2 * all + usize::from(*is));
    for (row, coefficients) in weights.field.chunks_exact_mut(width).enumerate() {
        model.check()?;
        for (column, coefficient) in coefficients.iter_mut().enumerate() {
            let at = (row + 1) * stride + column + 1;
            let around = [at - 1, at - stride, at - stride - 1, at - stride + 1];
            let near = around.map(|at| values[at]);
            let [left, below, corner, right] = near;
            let predicted = (left + below - corner).clamp(left.min(below), left.max(below));
            let missed = around.map(|at| errors[at]);
            let missed = (2 * missed[0] + 2 * missed[1] + missed[2] + missed[3]) / 6;
            let levels = level(left) * 7 + level(below);
            let value = i32::from(*coefficient);
            let position = edge(row, height) * 5 + edge(column, width);
            let value =
                if model.flag(CLIPPED, [pattern(near.map(|v| v == CLIP)), levels, position], value == CLIP) {
                    CLIP
                } else if model.flag(
                    LEAST,
                    [
                        pattern(near.map(|v| v <= LEAST_COEFFICIENT)),
                        levels,
                        class(missed, [2, 4, 8, 12, 18, 26, 36, 50]),
                    ],
                    value == LEAST_COEFFICIENT,
                ) {
                    LEAST_COEFFICIENT
                } else {
                    let steep = (left - corner).abs().max((below - corner).abs()).max((right - below).abs());
                    let contexts = [
                        class(missed, [1, 3, 6, 10, 15, 22, 30]) * 5 + class(right - below, [-30, -6, 7, 31]),
                        levels,
                        level(predicted) * 6 + class(steep, [4, 10, 20, 40, 70]),
                    ];
                    predicted.wrapping_add(model.signed(COEFFICIENT, contexts, value - predicted))
                };
            *coefficient = value as i8;
            values[at] = i32::from(*coefficient);
            errors[at] = if value == CLIP { 0 } else { (values[at] - predicted).abs() };
        }
    }
    Ok(())
}

/// The context of a number's absolute value.
fn size(value: i32) -> usize {
    class(value.abs(), [1, 3, 6, 12])
}

/// Codes the patterns of the deformation.
pub(super) fn patterns<C: Coder>(
    model: &mut ContextModel<'_, C>,
    weights: &mut Weights,
) -> Result<(), Damage> {
    const N: usize = DEFORM_NODES;
    let patterns = &mut weights.patterns;
    patterns.resize(usize::from(weights.rank) * N * N, 0);
    for at in 0..patterns.len() {
        let (row, column) = (at / N % N, at % N);
        if column == 0 {
            model.check()?;
        }
        let near = |there: bool, back: usize| if there { i32::from(patterns[at - back]) } else { 0 };
        let left = near(column > 0, 1);
        let below = near(row > 0, N);
        let right = near(row > 0 && column < N - 1, N - 1);
        let before = near(at >= N * N, N * N);
        let sign = |value: i32| class(value, [-8, -2, 0, 1, 3]);
        let rim = |at: usize| at.min(N - 1 - at).min(2);
        let large = usize::from(size(before) + size(right) > 1);
        let contexts = [
            size(left) * 5 + size(below),
            sign(left) * 6 + sign(below),
            rim(row) * 3 + rim(column) + 9 * large,
        ];
        patterns[at] = model.signed(PATTERN, contexts, patterns[at].into()) as i8;
    }
    Ok(())
}

/// Codes the weight of each pattern at each size, against that at the size before.
pub(super) fn embedding<C: Coder>(
    model: &mut ContextModel<'_, C>,
    weights: &mut Weights,
    scale: Scale,
) -> Result<(), Damage> {
    let (rank, sizes) = (usize::from(weights.rank), scale.sizes());
    let jumps = warp::jumps(&weights.warp_y, scale);
    let embedding = &mut weights.embedding;
    embedding.resize(rank * sizes, 0);
    let size = |value: i32| class(value.abs(), [1, 3, 5, 9, 16]);
    let sign = |value: i32| class(value, [-8, -2, 0, 3, 9]);
    for pattern in 0..rank {
        model.check()?;
        for (s, jump) in jumps.iter().enumerate() {
            let value = |back: usize, pattern: usize| match s.checked_sub(back) {
                Some(s) => i32::from(embedding[s * rank + pattern]),
                None => 0,
            };
            let (before, earlier) = (value(1, pattern), value(2, pattern));
            let other = if pattern > 0 { value(0, pattern - 1) - value(1, pattern - 1) } else { 0 };
            let contexts = [
                sign(earlier - before) * 6 + sign(before),
                class((before - earlier).abs(), [1, 3, 5, 9]) * 5 + class(*jump, [4, 10, 18, 26]),
                size(other) * 6 + size(before),
            ];
            let coded = model.signed(EMBEDDING, contexts, value(0, pattern) - before);
            embedding[s * rank + pattern] = before.wrapping_add(coded) as i8;
        }
    }
    Ok(())
}
