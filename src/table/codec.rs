//! One glyph's weights as bytes: what can be predicted is, and the rest is coded with odds that fit its contexts.
//!
//! Writing and reading are the same functions: a coder that writes is given the weights, one that reads fills them
//! in. `spec/nfrt.md` describes the order.

use alloc::vec;
use alloc::vec::Vec;

use super::contexts::{
    CLIPPED, COEFFICIENT, COUNT, EMBEDDING, INK, LEAST, Model, PATTERN, PLACE, UNITS, class,
};
use super::priors::PRIOR;
use super::range::Encoder;
use super::range::{Coder, Decoder, End};
use super::warp;
use crate::error::Damage;
use crate::model::gridfit::{DEFORM_NODES, FIELD_LIMIT, FIELD_STEPS, PADDING, Scale, Weights};

/// The most cells of a field along an axis.
pub const MAX_CELLS: u8 = 64;
/// The most knots of an axis.
pub const MAX_KNOTS: u8 = crate::model::gridfit::MAX_KNOTS as u8;
/// The highest rank of a deformation.
pub const MAX_RANK: u8 = 16;

/// A coefficient that is clipped outside, and what stands for coefficients beyond the grid.
const CLIP: i32 = -((FIELD_LIMIT * FIELD_STEPS) as i32);
/// The least coefficient that rounding leaves.
const LEAST_COEFFICIENT: i32 = -127;
/// A cell's usual edge and the grid's border, in 1/10000 em: they predict the number of cells.
const USUAL_CELL: i64 = 340;
const BORDER: i64 = (2.0 * PADDING * 10_000.0) as i64;
// As the specification has them.
const _: () = assert!(CLIP == -92 && BORDER == 600);

/// The parts of a coded model, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// Counts, knots and the box.
    Header,
    /// Hinted positions.
    Warp,
    /// The field's coefficients.
    Field,
    /// The deformation's patterns.
    Patterns,
    /// The weights of the patterns at each size.
    Embedding,
}

fn damaged(what: &'static str) -> Damage {
    Damage::Malformed(what)
}

/// More of something than the format allows. What cannot be counted, as it is below 0, counts as 0.
fn too_large(what: &'static str, count: i32, limit: i32) -> Damage {
    let [count, limit] = [count, limit].map(|number| u64::try_from(number).unwrap_or(0));
    Damage::TooLarge { what, count, limit }
}

/// Whether a model is larger than readers accept.
pub fn exceeds_limits(weights: &Weights) -> bool {
    let knots = [&weights.warp_x, &weights.warp_y].map(|w| w.knots.len());
    weights.cells.iter().any(|c| *c > MAX_CELLS)
        || knots.iter().any(|k| *k > usize::from(MAX_KNOTS))
        || weights.rank > MAX_RANK
}

/// Turns weights into bytes.
///
/// # Errors
///
/// As [`decode`], for weights that it would refuse.
pub fn encode(weights: &Weights, scale: Scale) -> Result<Vec<u8>, Damage> {
    let mut model = Model::new(Encoder::new(), &PRIOR);
    code(&mut model, &mut weights.clone(), scale, |_, _| ())?;
    Ok(model.coder.finish())
}

/// Why [`decode_within`] gives no weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// The bytes are damaged.
    Damage(Damage),
    /// The weights would take so many bytes.
    Memory(usize),
}

impl From<Damage> for Failure {
    fn from(damage: Damage) -> Self {
        Self::Damage(damage)
    }
}

/// Reads weights back.
///
/// # Errors
///
/// `Malformed` for bytes that end early or contradict themselves, `TooLarge` for a model that is larger than the format
/// allows.
pub fn decode(bytes: &[u8], scale: Scale) -> Result<Weights, Damage> {
    decode_within(bytes, scale, usize::MAX).map_err(|failure| match failure {
        Failure::Damage(damage) => damage,
        Failure::Memory(_) => damaged("is larger than memory"),
    })
}

/// Reads weights back if they take up to `limit` bytes as [`GridFit`](crate::model::gridfit::GridFit) keeps them. Of
/// larger ones, only the header is read.
///
/// # Errors
///
/// As [`decode`], and `Memory`.
pub fn decode_within(bytes: &[u8], scale: Scale, limit: usize) -> Result<Weights, Failure> {
    let mut model = Model::new(Decoder::new(bytes), &PRIOR);
    let mut weights = Weights::default();
    header(&mut model, &mut weights, scale)?;
    let memory = memory(&weights, scale);
    if memory > limit {
        return Err(Failure::Memory(memory));
    }
    body(&mut model, &mut weights, scale, |_, _| ())?;
    finish(model.coder)?;
    Ok(weights)
}

/// The bytes that weights with such a header take as floating-point numbers.
fn memory(weights: &Weights, scale: Scale) -> usize {
    let coefficients = weights.cells.iter().map(|cells| usize::from(*cells) + 2).product::<usize>();
    let knots = weights.warp_x.knots.len() + weights.warp_y.knots.len();
    let rank = usize::from(weights.rank);
    let patterns = rank * DEFORM_NODES * DEFORM_NODES;
    (coefficients + patterns + (knots + rank) * scale.sizes()) * size_of::<f32>()
}

fn finish(coder: Decoder<'_>) -> Result<(), Damage> {
    coder.finish().map_err(|end| match end {
        End::Early => damaged("ends early"),
        End::Late => damaged("has bytes left over"),
    })
}

/// Refuses to go on behind the end.
///
/// # Errors
///
/// `Malformed` if the coder is behind the end.
pub fn check<C: Coder>(coder: &C) -> Result<(), Damage> {
    if coder.is_spent() { Err(damaged("ends early")) } else { Ok(()) }
}

/// Codes a glyph's weights; calls `after` behind each section.
///
/// # Errors
///
/// As [`decode`].
pub fn code<C: Coder>(
    model: &mut Model<'_, C>,
    weights: &mut Weights,
    scale: Scale,
    mut after: impl FnMut(Section, &mut C),
) -> Result<(), Damage> {
    header(model, weights, scale)?;
    after(Section::Header, &mut model.coder);
    body(model, weights, scale, after)
}

/// Codes what follows the header.
fn body<C: Coder>(
    model: &mut Model<'_, C>,
    weights: &mut Weights,
    scale: Scale,
    mut after: impl FnMut(Section, &mut C),
) -> Result<(), Damage> {
    if weights.cells == [0, 0] {
        return Ok(());
    }
    for axis in [&mut weights.warp_x, &mut weights.warp_y] {
        warp::code(model, axis, scale)?;
    }
    after(Section::Warp, &mut model.coder);
    field(model, weights)?;
    after(Section::Field, &mut model.coder);
    patterns(model, weights)?;
    after(Section::Patterns, &mut model.coder);
    embedding(model, weights, scale)?;
    after(Section::Embedding, &mut model.coder);
    Ok(())
}

/// Counts, knots and the box.
fn header<C: Coder>(model: &mut Model<'_, C>, weights: &mut Weights, scale: Scale) -> Result<(), Damage> {
    let inked = model.flag(INK, [0; 3], !weights.field.is_empty());
    if inked {
        let counts = [weights.warp_x.knots.len(), weights.warp_y.knots.len(), usize::from(weights.rank)];
        let mut at = 0;
        let counts = counts.map(|count| {
            at += 1;
            model.signed(COUNT, [at - 1, 0, 0], count as i32)
        });
        let limits = [MAX_KNOTS, MAX_KNOTS, MAX_RANK].map(i32::from);
        for ((count, limit), what) in counts.iter().zip(limits).zip(["knots in x", "knots in y", "patterns"])
        {
            if !(0..=limit).contains(count) {
                return Err(too_large(what, *count, limit));
            }
        }
        weights.rank = counts[2] as u8;
        knots(model, &mut weights.warp_x.knots, counts[0] as usize)?;
        knots(model, &mut weights.warp_y.knots, counts[1] as usize)?;
    }
    bounds(model, weights)?;
    if !inked {
        return Ok(());
    }
    for (axis, cells) in weights.cells.iter_mut().enumerate() {
        let span = i64::from(weights.bounds[axis + 2]) - i64::from(weights.bounds[axis]);
        let usual = ((span * 10_000 / i64::from(scale.units_per_em()) + BORDER) / USUAL_CELL)
            .clamp(1, i64::from(MAX_CELLS)) as i32;
        let coded = model.signed(COUNT, [3 + axis, 0, 0], i32::from(*cells) - usual).wrapping_add(usual);
        if !(1..=i32::from(MAX_CELLS)).contains(&coded) {
            return Err(too_large("cells along an axis", coded, MAX_CELLS.into()));
        }
        *cells = coded as u8;
    }
    check(&model.coder)
}

fn knots<C: Coder>(model: &mut Model<'_, C>, knots: &mut Vec<i16>, count: usize) -> Result<(), Damage> {
    knots.resize(count, 0);
    let mut before = 0;
    for (k, knot) in knots.iter_mut().enumerate() {
        let step = i32::from(*knot) - before;
        before = match k {
            0 => model.signed(UNITS, [0; 3], step),
            _ => before.saturating_add_unsigned(model.positive(UNITS, [1, 0, 0], step as u32)),
        };
        *knot = i16::try_from(before).map_err(|_| damaged("has a knot outside the em"))?;
    }
    Ok(())
}

/// The box, against the outermost knots or, in an axis without any, its lower edge.
fn bounds<C: Coder>(model: &mut Model<'_, C>, weights: &mut Weights) -> Result<(), Damage> {
    let Weights { bounds, warp_x, warp_y, .. } = weights;
    for (axis, warp) in [warp_x, warp_y].into_iter().enumerate() {
        let ends = warp.knots.first().zip(warp.knots.last());
        let mut below = ends.map_or(0, |(first, _)| i32::from(*first));
        for (edge, context) in [axis, axis + 2].into_iter().zip(if ends.is_some() { [2, 3] } else { [4, 5] })
        {
            let coded = model.signed(UNITS, [context, 0, 0], i32::from(bounds[edge]) - below);
            let coded = coded.wrapping_add(below);
            bounds[edge] = i16::try_from(coded).map_err(|_| damaged("has a box outside the em"))?;
            below = ends.map_or(coded, |(_, last)| i32::from(*last));
        }
    }
    check(&model.coder)
}

/// Where a row or column lies: the first, the second, inside, the last but one, the last.
fn edge(at: usize, count: usize) -> usize {
    match at {
        0 | 1 => at,
        _ if at + 1 == count => 4,
        _ if at + 2 == count => 3,
        _ => 2,
    }
}

fn field<C: Coder>(model: &mut Model<'_, C>, weights: &mut Weights) -> Result<(), Damage> {
    let [width, height] = weights.cells.map(|cells| usize::from(cells) + 2);
    weights.field.resize(width * height, 0);
    // With a border to the left, to the right and below.
    let stride = width + 2;
    let mut values = vec![CLIP; stride * (height + 1)];
    let mut errors = vec![0i32; stride * (height + 1)];
    let level = |value: i32| class(value, [-110, -91, -60, -25, 10, 50]);
    let pattern = |is: [bool; 4]| is.iter().rev().fold(0, |all, is| 2 * all + usize::from(*is));
    for (row, coefficients) in weights.field.chunks_exact_mut(width).enumerate() {
        check(&model.coder)?;
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
            let place = edge(row, height) * 5 + edge(column, width);
            let value =
                if model.flag(CLIPPED, [pattern(near.map(|v| v == CLIP)), levels, place], value == CLIP) {
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

/// The class of a number's size, with two more limits for large ones.
fn size(value: i32) -> usize {
    class(value.abs(), [1, 3, 6, 12])
}

fn patterns<C: Coder>(model: &mut Model<'_, C>, weights: &mut Weights) -> Result<(), Damage> {
    const N: usize = DEFORM_NODES;
    let patterns = &mut weights.patterns;
    patterns.resize(usize::from(weights.rank) * N * N, 0);
    for at in 0..patterns.len() {
        let (row, column) = (at / N % N, at % N);
        if column == 0 {
            check(&model.coder)?;
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

fn embedding<C: Coder>(model: &mut Model<'_, C>, weights: &mut Weights, scale: Scale) -> Result<(), Damage> {
    let (rank, sizes) = (usize::from(weights.rank), scale.sizes());
    let jumps = warp::jumps(&weights.warp_y, scale);
    let embedding = &mut weights.embedding;
    embedding.resize(rank * sizes, 0);
    let size = |value: i32| class(value.abs(), [1, 3, 5, 9, 16]);
    let sign = |value: i32| class(value, [-8, -2, 0, 3, 9]);
    for pattern in 0..rank {
        check(&model.coder)?;
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

/// Turns lists of places, one number for each size, into bytes.
pub fn encode_places(lists: &[&[i8]]) -> Vec<u8> {
    let mut model = Model::new(Encoder::new(), &PRIOR);
    for list in lists {
        places(&mut model, &mut list.to_vec());
    }
    model.coder.finish()
}

/// Reads `count` lists of places back, one after the other.
///
/// # Errors
///
/// `Malformed` for bytes that end early or late.
pub fn decode_places(bytes: &[u8], count: usize, sizes: usize) -> Result<Vec<i8>, Damage> {
    let mut model = Model::new(Decoder::new(bytes), &PRIOR);
    let mut lists = vec![0; count * sizes];
    for list in lists.chunks_exact_mut(sizes) {
        if model.coder.is_spent() {
            return Err(damaged("ends early"));
        }
        places(&mut model, list);
    }
    finish(model.coder)?;
    Ok(lists)
}

fn places<C: Coder>(model: &mut Model<'_, C>, list: &mut [i8]) {
    let (mut before, mut step) = (0i32, 0i32);
    for place in list {
        let context = class(before, [0, 1]) * 3 + class(step, [0, 1]);
        step = model.signed(PLACE, [context, 0, 0], i32::from(*place) - before);
        *place = before.wrapping_add(step) as i8;
        before = i32::from(*place);
    }
}
