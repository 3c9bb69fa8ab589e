//! The messages of the outline models: the hints of a glyph, the parts of a composed one, a shared track, and a list of grid
//! offsets. Writing and reading are the same functions. `spec/nfrt.md` describes the order.

use alloc::vec::Vec;
use core::ops::Range;

use super::corrections::Corrections;
use super::positions::{self, Axis, Choose, Referred};
use super::rules::Scaling;
use super::sections::{self, Owner};
use super::shared::{Shared, Source};
use super::structure;
use crate::error::Damage;
use crate::model::outline::{AxisHints, OutlinePoints, OutlineWeights, scale_of};
use crate::model::sizes::Scale;
use crate::number::mul_fixed;
use crate::table::context_model::{ContextModel, class};
use crate::table::damage::{malformed, malformed_end, too_large};
use crate::table::elements::{ADVANCE, MESSAGE, OUTLINE_GRID_OFFSET, UNUSUAL};
use crate::table::priors::OUTLINE_PRIOR;
use crate::table::range::{Coder, Decoder, Encoder};

/// The most moves of an axis: tracks times sizes.
const MAX_MOVES: usize = 1 << 17;
/// The most points times sizes of a glyph with corrections.
pub const MAX_CORRECTED: usize = 1 << 16;

/// What is known of a glyph before its message is read.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// The outline.
    pub points: &'a OutlinePoints,
    /// The advance width in font units.
    pub advance: u16,
    /// Units and sizes.
    pub scale: Scale,
    /// The font's shared tracks.
    pub shared: Shared<'a>,
}

/// The sources of the tracks of both axes.
pub type Sources = [Vec<Source>; 2];

/// Encodes the hints of a glyph. `choose` may change moves.
///
/// # Errors
///
/// As [`decode`], for hints that it would refuse.
pub fn encode(
    known: &Known<'_>,
    weights: &mut OutlineWeights,
    sources: &Sources,
    choose: Choose<'_>,
) -> Result<Vec<u8>, Damage> {
    let mut model = ContextModel::new(Encoder::new(), &OUTLINE_PRIOR);
    code(&mut model, known, weights, &mut sources.clone(), 0..known.scale.sizes(), choose)?;
    Ok(model.coder.finish())
}

/// Decodes the hints of a glyph at some sizes, the first of which begins a section, and where its tracks come from. `memory` is
/// working memory.
///
/// # Errors
///
/// `Stale` if they are not those of this outline; `Malformed` for bytes that end early or contradict themselves, `TooLarge` for
/// more than the format allows.
pub fn decode(
    bytes: &[u8],
    known: &Known<'_>,
    sizes: Range<usize>,
    memory: &mut Vec<u16>,
) -> Result<(OutlineWeights, Sources), Damage> {
    let mut model = ContextModel::with_memory(Decoder::new(bytes), &OUTLINE_PRIOR, core::mem::take(memory));
    let (mut weights, mut sources) = (OutlineWeights::default(), Sources::default());
    let decoded = code(&mut model, known, &mut weights, &mut sources, sizes, &mut |_| 0);
    *memory = model.into_memory();
    decoded.map(|()| (weights, sources))
}

/// Whether a message is that of a composed glyph.
pub fn is_composed(bytes: &[u8]) -> bool {
    // The kind is the first thing in a message, so that the initial probabilities do.
    let mut coder = Decoder::new(bytes);
    let mut bit = |known: usize| coder.bit(OUTLINE_PRIOR.probability(MESSAGE, known), false);
    let high = usize::from(bit(1));
    2 * high + usize::from(bit(2 + high)) == COMPOSED
}

/// The kinds of messages.
const HINTS: usize = 0;
pub(super) const COMPOSED: usize = 1;

/// Codes 16 bits that nothing predicts.
pub(super) fn raw<C: Coder>(model: &mut ContextModel<'_, C>, value: u16) -> u16 {
    (0..16).rev().fold(0, |known, bit| {
        let bit = model.coder.bit(crate::table::range::ONE / 2, value >> bit & 1 == 1);
        known << 1 | u16::from(bit)
    })
}

/// Codes a glyph's hints at some sizes, a writer at all of them. A reader's `weights` and `sources` are empty.
///
/// # Errors
///
/// As [`decode`].
pub fn code<C: Coder>(
    model: &mut ContextModel<'_, C>,
    known: &Known<'_>,
    weights: &mut OutlineWeights,
    sources: &mut Sources,
    sizes: Range<usize>,
    choose: Choose<'_>,
) -> Result<(), Damage> {
    let Known { points, scale, .. } = *known;
    if model.bits(MESSAGE, 0, 2, HINTS) != HINTS {
        return Err(malformed("is not that of an outline"));
    }
    let hash = points.hash(known.advance);
    if raw(model, hash) != hash {
        return Err(Damage::Stale);
    }
    let OutlineWeights { axes, advances } = weights;
    for axis in [1, 0] {
        let (hints, sources) = (&mut axes[axis], &mut sources[axis]);
        if model.flag(UNUSUAL, [axis, 0, 0], !hints.levels.is_empty()) {
            structure::code(model, points, scale, axis, hints, sources, &known.shared)?;
            check_moves(hints.levels.len(), scale)?;
            hints.first_size = sizes.start;
            hints.moves.resize(hints.levels.len() * sizes.len(), 0);
        }
    }
    let has_advances = model.flag(UNUSUAL, [2, 0, 0], advances.iter().any(|advance| *advance != 0));
    advances.resize(if has_advances { sizes.end } else { 0 }, 0);
    let mut corrected = [0, 1].map(|axis| Corrections::new(axis, &axes[axis], points.len(), C::WRITES));
    for axis in &mut corrected {
        axis.is_used = model.flag(UNUSUAL, [3 + axis.axis, 0, 0], axis.is_used);
        if axis.is_used && points.len() * scale.sizes() > MAX_CORRECTED {
            return Err(too_large(
                "corrected points",
                points.len() as i32,
                (MAX_CORRECTED / scale.sizes()) as i32,
            ));
        }
    }
    for (hints, corrected) in axes.iter_mut().zip(&corrected) {
        hints.is_hinted = !hints.levels.is_empty() || corrected.is_used;
    }
    let mut referred = sources.each_ref().map(|sources| Referred { sources, moves: Vec::new() });
    for ((axis, hints), referred) in axes.iter_mut().enumerate().zip(&mut referred) {
        if C::WRITES {
            referred.moves.resize(hints.moves.len(), 0);
        }
        let moves = if C::WRITES { &mut referred.moves } else { &mut hints.moves };
        shared_moves(model, known, axis, referred.sources, sizes.clone(), moves)?;
    }
    let is_coded = has_advances
        || corrected.iter().any(|axis| axis.is_used)
        || sources.iter().flatten().any(|source| source.is_coded());
    let message = (Owner::Glyph, is_coded);
    sections::code(model, message, scale.sizes(), sizes.clone(), |model, section| {
        let mut tracks = [0, 1].map(|axis| Axis::new(axis, &referred[axis]));
        corrected.iter_mut().for_each(Corrections::restart);
        let mut before = [0; 2];
        for size in section {
            model.check()?;
            let scaling = scaling_at(scale, size);
            let scale = scaling.factor;
            for axis in [1, 0] {
                let AxisHints { levels, moves, .. } = &mut axes[axis];
                let at = (size - sizes.start) * levels.len();
                let Some(moves) = moves.get_mut(at..at + levels.len()) else { continue };
                tracks[axis].code(model, size, scaling, levels, moves, choose);
            }
            if let Some(advance) = advances.get_mut(size) {
                let context = advance_context(known.advance, scale, &axes[0], size, before);
                let step = model.signed(ADVANCE, [context, 0, 0], i32::from(*advance) - before[0]);
                *advance = before[0].wrapping_add(step) as i8;
                before = [(*advance).into(), before[0]];
            }
            for corrected in corrected.iter_mut().filter(|axis| axis.is_used) {
                corrected.code(model, size, &mut axes[corrected.axis])?;
            }
        }
        Ok(())
    })?;
    for (axis, corrected) in axes.iter_mut().zip(corrected) {
        if !C::WRITES {
            axis.corrections = corrected.list;
        }
    }
    Ok(())
}

fn check_moves(tracks: usize, scale: Scale) -> Result<(), Damage> {
    if tracks * scale.sizes() <= MAX_MOVES {
        return Ok(());
    }
    Err(too_large("moves of tracks", (tracks * scale.sizes()) as i32, MAX_MOVES as i32))
}

/// Puts the moves of what tracks refer to into `moves`: at each size those of all tracks. The model lends its memory, as nothing is
/// coded any more of what has been coded so far.
fn shared_moves<C: Coder>(
    model: &mut ContextModel<'_, C>,
    known: &Known<'_>,
    axis: usize,
    sources: &[Source],
    sizes: Range<usize>,
    moves: &mut [i16],
) -> Result<(), Damage> {
    for (track, source) in sources.iter().enumerate() {
        if let Source::Same(number) | Source::Near(number) = *source {
            let shared =
                model.lend(|memory| (known.shared.moves)(axis, number.into(), sizes.clone(), memory))?;
            if shared.len() < sizes.len() {
                return Err(malformed("refers to no shared track"));
            }
            for (moves, shared) in moves.chunks_exact_mut(sources.len()).zip(shared) {
                moves[track] = shared;
            }
        }
    }
    Ok(())
}

/// The context of a hinted advance width: the direction that the rightmost track's move takes the rounded width to, and the two
/// widths before.
fn advance_context(advance: u16, scale: i32, x: &AxisHints, size: usize, before: [i32; 2]) -> usize {
    let plain = mul_fixed(advance.into(), scale);
    let moved = x.moves_at(size).last().map_or(0, |moved| i32::from(*moved));
    let rounded = |position: i32| position.wrapping_add(32) >> 6;
    let edge = rounded(plain.wrapping_add(moved)).wrapping_sub(rounded(plain));
    class(edge, [0, 1]) * 9 + class(before[0], [0, 1]) * 3 + class(before[1], [0, 1])
}

/// Encodes the moves of a shared track.
///
/// # Errors
///
/// None that a writer can meet.
pub fn encode_shared(level: i16, moves: &[i16], scale: Scale) -> Result<Vec<u8>, Damage> {
    let mut model = ContextModel::new(Encoder::new(), &OUTLINE_PRIOR);
    code_shared(&mut model, level, &mut moves.to_vec(), scale, 0..scale.sizes())?;
    Ok(model.coder.finish())
}

/// Codes the moves of a shared track at some sizes, a writer at all of them; a reader's `moves` are empty.
///
/// # Errors
///
/// As [`decode_shared`].
pub fn code_shared<C: Coder>(
    model: &mut ContextModel<'_, C>,
    level: i16,
    moves: &mut Vec<i16>,
    scale: Scale,
    sizes: Range<usize>,
) -> Result<(), Damage> {
    sections::code(model, (Owner::SharedTrack, true), scale.sizes(), sizes, |model, section| {
        let scales = section.map(|size| (size, scaling_at(scale, size)));
        positions::code_shared(model, level, scales, moves);
        model.check()
    })
}

/// Decodes the moves of a shared track at some sizes, the first of which begins a section. `memory` is working memory.
///
/// # Errors
///
/// `Malformed` for bytes that end early or late.
pub fn decode_shared(
    bytes: &[u8],
    level: i16,
    scale: Scale,
    sizes: Range<usize>,
    memory: &mut Vec<u16>,
) -> Result<Vec<i16>, Damage> {
    let mut model = ContextModel::with_memory(Decoder::new(bytes), &OUTLINE_PRIOR, core::mem::take(memory));
    let mut moves = Vec::with_capacity(sizes.len());
    let decoded = code_shared(&mut model, level, &mut moves, scale, sizes);
    *memory = model.into_memory();
    decoded.map(|()| moves)
}

/// Encodes a list of grid offsets.
pub fn encode_list(list: &[i8]) -> Vec<u8> {
    let mut model = ContextModel::new(Encoder::new(), &OUTLINE_PRIOR);
    code_list(&mut model, &mut list.to_vec());
    model.coder.finish()
}

/// Decodes a list of grid offsets.
///
/// # Errors
///
/// `Malformed` for bytes that end early or late.
pub fn decode_list(bytes: &[u8], sizes: usize) -> Result<Vec<i8>, Damage> {
    let mut model = ContextModel::new(Decoder::new(bytes), &OUTLINE_PRIOR);
    let mut list = alloc::vec![0; sizes];
    code_list(&mut model, &mut list);
    model.coder.finish().map_err(malformed_end)?;
    Ok(list)
}

/// Codes a list of grid offsets.
pub fn code_list<C: Coder>(model: &mut ContextModel<'_, C>, list: &mut [i8]) {
    let mut before = [0i32; 2];
    for offset in list {
        let context = class(before[0], [0, 1]) * 3 + class(before[1], [0, 1]);
        let step = model.signed(OUTLINE_GRID_OFFSET, [context, 0, 0], i32::from(*offset) - before[0]);
        *offset = before[0].wrapping_add(step) as i8;
        before = [(*offset).into(), before[0]];
    }
}

/// The scale of a font's trained size in pixels per em, as hints count on.
pub fn scale_at(scale: Scale, size: usize) -> i32 {
    scale_of(scale.ppem_of(size) as f32, scale.units_per_em())
}

fn scaling_at(scale: Scale, size: usize) -> Scaling {
    Scaling { factor: scale_at(scale, size), rounds_down: scale.is_postscript() }
}

#[cfg(test)]
mod tests;
