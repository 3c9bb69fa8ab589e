//! One glyph's weights as bytes: residuals of predictions, coded with context mixing.
//!
//! Writing and reading are the same functions: a coder that writes is given the weights, one that reads fills them in.
//! `spec/nfrt.md` describes the order.

use alloc::vec::Vec;

use super::context_model::ContextModel;
use super::damage::{malformed, malformed_end, too_large};
use super::elements::{COUNT, INK, UNITS};
use super::priors::PRIOR;
use super::range::{Coder, Decoder, Encoder};
use super::{planes, warp};
use crate::error::Damage;
use crate::model::grid::{DEFORM_NODES, PADDING};
use crate::model::gridfit::{self, Weights};
use crate::model::sizes::Scale;

/// The most cells of a field along an axis.
pub const MAX_CELLS: u8 = 64;
/// The most knots of an axis.
pub const MAX_KNOTS: u8 = gridfit::MAX_KNOTS as u8;
/// The highest rank of a deformation.
pub const MAX_RANK: u8 = 16;

/// A cell's usual edge and the grid's border, in 1/10000 em: they predict the number of cells.
const USUAL_CELL: i64 = 340;
const BORDER: i64 = (2.0 * PADDING * 10_000.0) as i64;
// As the specification has it.
const _: () = assert!(BORDER == 600);

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
    let mut model = ContextModel::new(Encoder::new(), &PRIOR);
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
        Failure::Memory(_) => malformed("is larger than memory"),
    })
}

/// Reads weights back if they take up to `limit` bytes as [`GridFit`](crate::model::gridfit::GridFit) keeps them. Of
/// larger ones, only the header is read.
///
/// # Errors
///
/// As [`decode`], and `Memory`.
pub fn decode_within(bytes: &[u8], scale: Scale, limit: usize) -> Result<Weights, Failure> {
    let mut model = ContextModel::new(Decoder::new(bytes), &PRIOR);
    let mut weights = Weights::default();
    header(&mut model, &mut weights, scale)?;
    let memory = memory(&weights, scale);
    if memory > limit {
        return Err(Failure::Memory(memory));
    }
    body(&mut model, &mut weights, scale, |_, _| ())?;
    model.coder.finish().map_err(malformed_end)?;
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

/// Codes a glyph's weights; calls `after` behind each section.
///
/// # Errors
///
/// As [`decode`].
pub fn code<C: Coder>(
    model: &mut ContextModel<'_, C>,
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
    model: &mut ContextModel<'_, C>,
    weights: &mut Weights,
    scale: Scale,
    mut after: impl FnMut(Section, &mut C),
) -> Result<(), Damage> {
    if weights.cells == [0, 0] {
        return Ok(());
    }
    for section in [Section::Warp, Section::Field, Section::Patterns, Section::Embedding] {
        code_section(model, weights, scale, section)?;
        after(section, &mut model.coder);
    }
    Ok(())
}

/// Codes one section; a reader needs the weights of the sections before it. Sections have no contexts in common.
///
/// # Errors
///
/// As [`decode`].
pub fn code_section<C: Coder>(
    model: &mut ContextModel<'_, C>,
    weights: &mut Weights,
    scale: Scale,
    section: Section,
) -> Result<(), Damage> {
    match section {
        Section::Header => header(model, weights, scale),
        Section::Warp => {
            warp::code(model, &mut weights.warp_x, scale)?;
            warp::code(model, &mut weights.warp_y, scale)
        }
        Section::Field => planes::field(model, weights),
        Section::Patterns => planes::patterns(model, weights),
        Section::Embedding => planes::embedding(model, weights, scale),
    }
}

/// Counts, knots and the box.
fn header<C: Coder>(
    model: &mut ContextModel<'_, C>,
    weights: &mut Weights,
    scale: Scale,
) -> Result<(), Damage> {
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
    model.check()
}

fn knots<C: Coder>(
    model: &mut ContextModel<'_, C>,
    knots: &mut Vec<i16>,
    count: usize,
) -> Result<(), Damage> {
    knots.resize(count, 0);
    let mut before = 0;
    for (k, knot) in knots.iter_mut().enumerate() {
        let step = i32::from(*knot) - before;
        before = match k {
            0 => model.signed(UNITS, [0; 3], step),
            _ => before.saturating_add_unsigned(model.positive(UNITS, [1, 0, 0], step as u32)),
        };
        *knot = i16::try_from(before).map_err(|_| malformed("has a knot outside the em"))?;
    }
    Ok(())
}

/// The box, against the outermost knots or, in an axis without any, its lower edge.
fn bounds<C: Coder>(model: &mut ContextModel<'_, C>, weights: &mut Weights) -> Result<(), Damage> {
    let Weights { bounds, warp_x, warp_y, .. } = weights;
    for (axis, warp) in [warp_x, warp_y].into_iter().enumerate() {
        let ends = warp.knots.first().zip(warp.knots.last());
        let mut below = ends.map_or(0, |(first, _)| i32::from(*first));
        for (edge, context) in [axis, axis + 2].into_iter().zip(if ends.is_some() { [2, 3] } else { [4, 5] })
        {
            let coded = model.signed(UNITS, [context, 0, 0], i32::from(bounds[edge]) - below);
            let coded = coded.wrapping_add(below);
            bounds[edge] = i16::try_from(coded).map_err(|_| malformed("has a box outside the em"))?;
            below = ends.map_or(coded, |(_, last)| i32::from(*last));
        }
    }
    model.check()
}
