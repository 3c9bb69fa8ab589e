//! Coding of the grid offsets that the parts of composed glyphs share.

use alloc::vec;
use alloc::vec::Vec;

use super::context_model::{ContextModel, class};
use super::damage::malformed_end;
use super::elements::GRID_OFFSET;
use super::priors::PRIOR;
use super::range::{Coder, Decoder, Encoder};
use crate::error::Damage;

/// Encodes lists of grid offsets, one number for each size.
pub fn encode(lists: &[&[i8]]) -> Vec<u8> {
    let mut model = ContextModel::new(Encoder::new(), &PRIOR);
    for list in lists {
        code(&mut model, &mut list.to_vec());
    }
    model.coder.finish()
}

/// Decodes `count` lists of grid offsets, one after the other.
///
/// # Errors
///
/// `Malformed` for bytes that end early or late.
pub fn decode(bytes: &[u8], count: usize, sizes: usize) -> Result<Vec<i8>, Damage> {
    let mut model = ContextModel::new(Decoder::new(bytes), &PRIOR);
    let mut lists = vec![0; count * sizes];
    for list in lists.chunks_exact_mut(sizes) {
        model.check()?;
        code(&mut model, list);
    }
    model.coder.finish().map_err(malformed_end)?;
    Ok(lists)
}

fn code<C: Coder>(model: &mut ContextModel<'_, C>, list: &mut [i8]) {
    let (mut before, mut step) = (0i32, 0i32);
    for offset in list {
        let context = class(before, [0, 1]) * 3 + class(step, [0, 1]);
        step = model.signed(GRID_OFFSET, [context, 0, 0], i32::from(*offset) - before);
        *offset = before.wrapping_add(step) as i8;
        before = i32::from(*offset);
    }
}
