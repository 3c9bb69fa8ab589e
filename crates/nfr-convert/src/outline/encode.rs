//! Encoding all outline models of a font.

use std::ops::Range;

use nfr::internals::model::gridfit::Scale;
use nfr::internals::model::outline::Interpolation;
use nfr::internals::table::BigEndian;
use nfr::internals::table::outline::{self, Known, Question, Shared, Sources};

use super::fit::{FittedOutline, add_corrections, error, fit};
use super::kept::Encoded;
use super::samples::OutlineSamples;
use super::sharing::{SharedTracks, tracks};
use crate::error::Error;
use crate::options::Fidelity;
use crate::parallel;

/// Moves that are tried around the wanted one, in 1/64 pixel.
const REACH: i32 = 8;
/// The factor of a bit's price with which fitting finds fewer tracks.
const FEWER_TRACKS: f64 = 2.0;

/// The messages of the outline models of a font.
#[derive(Debug, Clone, Default)]
pub(crate) struct EncodedOutlines {
    /// One for each glyph, in their order.
    pub(crate) glyphs: Vec<Vec<u8>>,
    /// Along x and y: the level of each shared track, and its message.
    pub(crate) shared: [Vec<(i16, Vec<u8>)>; 2],
}

/// Where encoded outlines are kept, by their numbers.
pub(crate) trait Store: Sync {
    /// One that was encoded before.
    fn kept(&self, number: usize) -> Option<Encoded>;

    /// Keeps one.
    fn keep(&self, number: usize, encoded: &Encoded) -> Result<(), Error>;
}

/// Encodes outlines; their moves become those that are written. Of those that `store` has, samples need no hinted positions.
pub(crate) fn encode(
    glyphs: &[(OutlineSamples, u16)],
    outlines: &mut [FittedOutline],
    scale: Scale,
    fidelity: Fidelity,
    jobs: usize,
    store: &dyn Store,
) -> Result<EncodedOutlines, Error> {
    let shared = [0, 1].map(|axis| SharedTracks::find(outlines, axis, fidelity));
    let units_per_em = scale.units_per_em();
    let levels = shared.each_ref().map(|tracks| {
        tracks.0.iter().map(|track| BigEndian::from(track.level)).collect::<Vec<BigEndian<i16>>>()
    });
    let all: Vec<_> = glyphs.iter().zip(&*outlines).enumerate().collect();
    let encoded = parallel::map(&all, jobs, |(number, ((samples, advance), outline))| {
        if let Some(encoded) = store.kept(*number) {
            return Ok(encoded);
        }
        let moves = |axis: usize, number: usize, sizes: Range<usize>, _: &mut Vec<u16>| {
            Ok(shared[axis].0[number].moves[sizes].to_vec())
        };
        let known = Known {
            points: &samples.points,
            advance: *advance,
            scale,
            shared: Shared { levels: [&levels[0], &levels[1]], moves: &moves },
        };
        let encoded = |outline: &FittedOutline| {
            let sources: Sources = [0, 1].map(|axis| {
                let tracks = tracks(outline, axis);
                tracks.map(|track| shared[axis].source(&track, units_per_em, fidelity)).collect()
            });
            encode_glyph(&known, samples, outline, &sources, fidelity)
        };
        let own = encoded(outline)?;
        if fidelity.is_exact() || samples.interpolation(1) == Interpolation::Level {
            store.keep(*number, &own)?;
            return Ok(own);
        }
        let total = |(bytes, weights): &Encoded| {
            error(weights, samples, units_per_em, fidelity)
                + fidelity.error_per_bit() * 8.0 * bytes.len() as f64
        };
        let mut least = total(&own);
        let mut best = own;
        // More tracks can take fewer bits than the corrections that they make needless, and the other way round.
        for tried in [Fidelity::EXACT, fidelity.with_dearer_bits(FEWER_TRACKS)] {
            let other = encoded(&fit(samples, units_per_em, tried, fidelity))?;
            let sum = total(&other);
            if sum < least {
                (best, least) = (other, sum);
            }
        }
        store.keep(*number, &best)?;
        Ok(best)
    })?;
    let mut messages = Vec::with_capacity(encoded.len());
    for (outline, (bytes, weights)) in outlines.iter_mut().zip(encoded) {
        outline.weights = weights;
        messages.push(bytes);
    }
    let [x, y] = shared.map(|tracks| {
        let message = |t: super::sharing::SharedTrack| {
            Ok::<_, Error>((t.level, outline::encode_shared(t.level, &t.moves, scale)?))
        };
        tracks.0.into_iter().map(message).collect::<Result<Vec<_>, Error>>()
    });
    Ok(EncodedOutlines { glyphs: messages, shared: [x?, y?] })
}

/// A glyph's message, and the weights that it has.
fn encode_glyph(
    known: &Known<'_>,
    samples: &OutlineSamples,
    outline: &FittedOutline,
    sources: &Sources,
    fidelity: Fidelity,
) -> Result<Encoded, Error> {
    let mut weights = outline.weights.clone();
    let costs = &outline.costs;
    let bytes = outline::encode(known, &mut weights, sources, &mut |question| {
        choose(question, costs[question.axis][question.track][question.size], fidelity)
    })?;
    add_corrections(&mut weights, samples, known.scale.units_per_em(), fidelity);
    if weights.axes.iter().all(|hints| hints.corrections.is_empty()) {
        return Ok((bytes, weights));
    }
    let bytes = outline::encode(known, &mut weights, sources, &mut |question| question.wanted.into())?;
    Ok((bytes, weights))
}

/// The move with the least sum of error and bits: the wanted one, or a candidate near it. `cost` is the error, in pixels, of
/// 1/64 pixel.
fn choose(question: &Question<'_>, cost: f64, fidelity: Fidelity) -> i32 {
    let wanted = i32::from(question.wanted);
    if fidelity.is_exact() {
        return wanted;
    }
    let total = |moved: i32| {
        let mut bits = 0.0;
        (question.price)(moved, &mut |probability| bits -= (f64::from(probability) / 4096.0).log2());
        f64::from(moved.abs_diff(wanted)) * cost + fidelity.error_per_bit() * bits
    };
    let near = question.candidates.iter().copied().filter(|moved| (moved - wanted).abs() <= REACH);
    let tried = near.chain([wanted]).map(|moved| (moved, total(moved)));
    tried.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(wanted, |(moved, _)| moved)
}
