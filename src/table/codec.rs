//! One glyph's weights as bytes, before compression: small residuals against what can be predicted.

use crate::error::Error;
use crate::model::gridfit::{AxisWarp, DEFORM_NODES, Scale, WARP_STEPS, Weights};

/// The most cells of a field along an axis.
pub const MAX_CELLS: u8 = 64;
/// The most knots of an axis.
pub const MAX_KNOTS: u8 = 32;
/// The highest rank of a deformation.
pub const MAX_RANK: u8 = 16;

/// How a knot's hinted positions are predicted, size after size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Predictor {
    /// The nearest whole pixel.
    Snap = 0,
    /// The nearest whole pixel, off by as much as at the size before.
    SnapAgain = 1,
    /// The plain position, off by as much as at the size before.
    MoveAgain = 2,
    /// As far above the knot below as the plain positions are.
    Ride = 3,
}

const PREDICTORS: [Predictor; 4] =
    [Predictor::Snap, Predictor::SnapAgain, Predictor::MoveAgain, Predictor::Ride];

/// Predicts the position of knot `k` at size `s` from those before it in `known` (size-major).
fn predict(how: Predictor, knots: &[i16], known: &[i32], scale: Scale, s: usize, k: usize) -> i32 {
    let count = knots.len();
    // In integers: 2·knot·ppem·steps/units, rounded by adding one half.
    let units = i64::from(scale.units_per_em);
    let scaled = |font_units: i64, steps: i64, s: usize| {
        let product = font_units * scale.ppem_of(s) as i64 * steps;
        (2 * product + units).div_euclid(2 * units) as i32
    };
    let steps = WARP_STEPS as i64;
    let knot = i64::from(knots[k]);
    let snap = |s: usize| scaled(knot, 1, s).wrapping_mul(steps as i32);
    match how {
        Predictor::SnapAgain if s > 0 => {
            snap(s).wrapping_add(known[(s - 1) * count + k].wrapping_sub(snap(s - 1)))
        }
        Predictor::MoveAgain if s > 0 => {
            let before = known[(s - 1) * count + k].wrapping_sub(scaled(knot, steps, s - 1));
            scaled(knot, steps, s).wrapping_add(before)
        }
        Predictor::Ride if k > 0 => {
            known[s * count + k - 1].wrapping_add(scaled(knot - i64::from(knots[k - 1]), steps, s))
        }
        _ => snap(s),
    }
}

/// Predicts a field coefficient from the ones to the left and below (the median edge detector of LOCO-I).
fn predict_field(field: &[i8], stride: usize, at: usize) -> i8 {
    let (column, row) = (at % stride, at / stride);
    let left = if column > 0 { i32::from(field[at - 1]) } else { 0 };
    let below = if row > 0 { i32::from(field[at - stride]) } else { left };
    let left = if column > 0 { left } else { below };
    let corner = if column > 0 && row > 0 { i32::from(field[at - stride - 1]) } else { left };
    (left + below - corner).clamp(left.min(below), left.max(below)) as i8
}

#[cfg(feature = "convert")]
fn zigzag(v: i32) -> u32 {
    ((v << 1) ^ (v >> 31)) as u32
}

fn unzigzag(v: u32) -> i32 {
    (v >> 1) as i32 ^ -((v & 1) as i32)
}

/// Whether a model is larger than readers accept.
#[cfg(feature = "convert")]
pub(super) fn exceeds_limits(weights: &Weights) -> bool {
    let knots = [&weights.warp_x, &weights.warp_y].map(|w| w.knots.len());
    weights.cells.iter().any(|c| *c > MAX_CELLS)
        || knots.iter().any(|k| *k > usize::from(MAX_KNOTS))
        || weights.rank > MAX_RANK
}

/// Turns weights into bytes. Their lengths fit each other and the limits of this module.
#[cfg(feature = "convert")]
pub fn encode(weights: &Weights, scale: Scale) -> Vec<u8> {
    let mut out = vec![
        weights.cells[0],
        weights.cells[1],
        weights.rank,
        weights.warp_x.knots.len() as u8,
        weights.warp_y.knots.len() as u8,
    ];
    if weights.field.is_empty() {
        return out;
    }
    for warp in [&weights.warp_x, &weights.warp_y] {
        let mut before = 0;
        for knot in &warp.knots {
            put_varint(&mut out, zigzag(i32::from(*knot) - before));
            before = i32::from(*knot);
        }
        let residuals: Vec<(Predictor, Vec<u32>)> =
            (0..warp.knots.len()).map(|k| best_prediction(warp, scale, k)).collect();
        out.extend(residuals.iter().map(|(how, _)| *how as u8));
        for residual in residuals.iter().flat_map(|(_, residuals)| residuals) {
            put_varint(&mut out, *residual);
        }
    }
    let stride = usize::from(weights.cells[0]) + 2;
    for (at, value) in weights.field.iter().enumerate() {
        let residual = value.wrapping_sub(predict_field(&weights.field, stride, at));
        out.push(zigzag(i32::from(residual)) as u8);
    }
    let signed = weights.patterns.iter().chain(&weights.embedding);
    out.extend(signed.map(|v| zigzag(i32::from(*v)) as u8));
    out
}

/// The predictor whose residuals of knot `k` have the fewest bits, and those residuals.
#[cfg(feature = "convert")]
fn best_prediction(warp: &AxisWarp, scale: Scale, k: usize) -> (Predictor, Vec<u32>) {
    let count = warp.knots.len();
    let residuals = |how: Predictor| -> Vec<u32> {
        (0..scale.sizes())
            .map(|s| {
                let predicted = predict(how, &warp.knots, &warp.hinted, scale, s, k);
                zigzag(warp.hinted[s * count + k].wrapping_sub(predicted))
            })
            .collect()
    };
    let bits =
        |residuals: &[u32]| residuals.iter().map(|r| 33 - r.saturating_add(1).leading_zeros()).sum::<u32>();
    PREDICTORS
        .into_iter()
        .map(|how| (how, residuals(how)))
        .min_by_key(|(_, residuals)| bits(residuals))
        .unwrap_or((Predictor::Snap, Vec::new()))
}

#[cfg(feature = "convert")]
fn put_varint(out: &mut Vec<u8>, mut value: u32) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn byte(&mut self) -> Result<u8, Error> {
        Ok(self.take(1)?[0])
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let (head, tail) = self.0.split_at_checked(count).ok_or_else(|| damaged("ends early"))?;
        self.0 = tail;
        Ok(head)
    }

    fn varint(&mut self) -> Result<u32, Error> {
        let mut value = 0u32;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7F).checked_shl(shift).unwrap_or(0);
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(damaged("holds a number that is too long"))
    }

    fn signed(&mut self, count: usize) -> Result<Vec<i8>, Error> {
        Ok(self.take(count)?.iter().map(|v| unzigzag(u32::from(*v)) as i8).collect())
    }
}

fn damaged(what: &str) -> Error {
    Error::Malformed(format!("a glyph's model {what}; convert the font again"))
}

/// Reads weights back. `bounds` is the outline's box in font units, which the table keeps elsewhere.
///
/// # Errors
///
/// `Malformed` for bytes that end early or contradict themselves, `LimitExceeded` for a model that is larger
/// than any converter makes.
pub fn decode(bytes: &[u8], bounds: [i16; 4], scale: Scale) -> Result<Weights, Error> {
    let mut bytes = Bytes(bytes);
    let cells = [bytes.byte()?, bytes.byte()?];
    let rank = bytes.byte()?;
    let knots = [bytes.byte()?, bytes.byte()?];
    if cells.iter().any(|c| *c > MAX_CELLS) || knots.iter().any(|k| *k > MAX_KNOTS) || rank > MAX_RANK {
        return Err(Error::LimitExceeded(format!(
            "a glyph's model has {}×{} cells, {}+{} knots and rank {rank}",
            cells[0], cells[1], knots[0], knots[1]
        )));
    }
    if cells == [0, 0] {
        return Ok(Weights { bounds, ..Weights::default() });
    }
    let warp_x = decode_warp(&mut bytes, knots[0], scale)?;
    let warp_y = decode_warp(&mut bytes, knots[1], scale)?;
    let stride = usize::from(cells[0]) + 2;
    let mut field = bytes.signed(stride * (usize::from(cells[1]) + 2))?;
    for at in 0..field.len() {
        field[at] = field[at].wrapping_add(predict_field(&field, stride, at));
    }
    let patterns = bytes.signed(usize::from(rank) * DEFORM_NODES * DEFORM_NODES)?;
    let embedding = bytes.signed(usize::from(rank) * scale.sizes())?;
    if !bytes.0.is_empty() {
        return Err(damaged("has bytes left over"));
    }
    Ok(Weights { bounds, cells, field, warp_x, warp_y, rank, patterns, embedding })
}

fn decode_warp(bytes: &mut Bytes<'_>, count: u8, scale: Scale) -> Result<AxisWarp, Error> {
    let count = usize::from(count);
    let mut knots = Vec::with_capacity(count);
    let mut before = 0i32;
    for _ in 0..count {
        before = before.wrapping_add(unzigzag(bytes.varint()?));
        knots.push(i16::try_from(before).map_err(|_| damaged("has a knot outside the em"))?);
    }
    let predictors = bytes
        .take(count)?
        .iter()
        .map(|how| {
            PREDICTORS.get(usize::from(*how)).copied().ok_or_else(|| damaged("names an unknown predictor"))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut hinted = vec![0i32; count * scale.sizes()];
    for (k, how) in predictors.into_iter().enumerate() {
        for s in 0..scale.sizes() {
            let predicted = predict(how, &knots, &hinted, scale, s, k);
            hinted[s * count + k] = predicted.wrapping_add(unzigzag(bytes.varint()?));
        }
    }
    Ok(AxisWarp { knots, hinted })
}
