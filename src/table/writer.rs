//! Writing the table.

use super::{
    HEADER_LEN, Header, MAJOR_VERSION, MAX_DICTIONARY_BYTES, MAX_MODEL_BYTES, MINOR_VERSION, ZSTD_MAGIC,
    codec,
};
use crate::error::Error;
use crate::model::Target;
use crate::model::gridfit::{Scale, Weights};

/// zstd's strongest level: models are packed once and are small.
const LEVEL: i32 = 22;
/// Dictionary sizes to try. What a dictionary costs has to come back in the models.
const DICTIONARY_SIZES: [usize; 5] = [1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14];

/// One glyph for the table.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphModel {
    /// The glyph.
    pub gid: u16,
    /// Its weights.
    pub weights: Weights,
}

fn packing(e: &std::io::Error) -> Error {
    Error::Io(format!("zstd cannot pack the models: {e}"))
}

/// Writes a table. `models` are in ascending order of their glyphs. Returns the table and the length of each
/// packed model.
///
/// # Errors
///
/// `LimitExceeded` for a model that readers would refuse, `Io` if zstd fails.
pub fn write(header: &Header, models: &[GlyphModel], scale: Scale) -> Result<(Vec<u8>, Vec<usize>), Error> {
    let plain: Vec<Vec<u8>> = models.iter().map(|m| plain(m, scale)).collect::<Result<_, _>>()?;
    let mut best = (Vec::new(), pack(&plain, &[])?);
    let total = |(dictionary, packed): &(Vec<u8>, Vec<Vec<u8>>)| {
        dictionary.len() + packed.iter().map(Vec::len).sum::<usize>()
    };
    for size in DICTIONARY_SIZES.into_iter().filter(|s| *s <= MAX_DICTIONARY_BYTES) {
        // Too few models for a dictionary are no failure: they are packed without one.
        let Ok(dictionary) = zstd::dict::from_samples(&plain, size) else { continue };
        let packed = pack(&plain, &dictionary)?;
        let candidate = (dictionary, packed);
        if total(&candidate) < total(&best) {
            best = candidate;
        }
    }
    let (dictionary, packed) = best;
    let mut out = Vec::with_capacity(HEADER_LEN + 14 * models.len() + dictionary.len());
    put_header(&mut out, header, models.len(), dictionary.len(), packed.iter().map(Vec::len).sum());
    out.extend(models.iter().flat_map(|m| m.gid.to_be_bytes()));
    out.extend(models.iter().flat_map(|m| m.weights.bounds).flat_map(i16::to_be_bytes));
    let mut end = 0u32;
    for model in &packed {
        end += model.len() as u32;
        out.extend(end.to_be_bytes());
    }
    out.extend_from_slice(&dictionary);
    out.extend(packed.iter().flatten());
    Ok((out, packed.iter().map(Vec::len).collect()))
}

fn plain(model: &GlyphModel, scale: Scale) -> Result<Vec<u8>, Error> {
    let too_large = || {
        let gid = model.gid;
        Error::LimitExceeded(format!(
            "the model of glyph {gid} is too large to store; train fewer sizes, or fewer knots and patterns"
        ))
    };
    if codec::exceeds_limits(&model.weights) {
        return Err(too_large());
    }
    let bytes = codec::encode(&model.weights, scale);
    if bytes.len() <= MAX_MODEL_BYTES { Ok(bytes) } else { Err(too_large()) }
}

fn put_header(out: &mut Vec<u8>, header: &Header, glyphs: usize, dictionary: usize, payload: usize) {
    let target = match header.target {
        Target::Smooth => 0u8,
        Target::Mono => 1,
        Target::Lcd => 2,
    };
    out.extend(MAJOR_VERSION.to_be_bytes());
    out.extend(MINOR_VERSION.to_be_bytes());
    out.extend([target, 0]);
    out.extend(header.first_ppem.to_be_bytes());
    out.extend(header.last_ppem.to_be_bytes());
    out.extend((glyphs as u16).to_be_bytes());
    out.extend(header.outline_hash.to_be_bytes());
    out.extend(header.seed.to_be_bytes());
    out.extend((dictionary as u32).to_be_bytes());
    out.extend((payload as u32).to_be_bytes());
    out.extend(header.steps.to_be_bytes());
    out.extend([header.knots, header.rank]);
    out.extend(header.cell.to_be_bytes());
    out.extend([header.skipped, 0]);
    debug_assert_eq!(out.len(), HEADER_LEN);
}

/// Packs each model on its own, without zstd's magic number, checksum and dictionary number.
fn pack(plain: &[Vec<u8>], dictionary: &[u8]) -> Result<Vec<Vec<u8>>, Error> {
    use zstd::zstd_safe::CParameter;
    let mut compressor =
        zstd::bulk::Compressor::with_dictionary(LEVEL, dictionary).map_err(|e| packing(&e))?;
    for parameter in [CParameter::ChecksumFlag(false), CParameter::DictIdFlag(false)] {
        compressor.set_parameter(parameter).map_err(|e| packing(&e))?;
    }
    plain
        .iter()
        .map(|bytes| {
            let frame = compressor.compress(bytes).map_err(|e| packing(&e))?;
            let body = frame.strip_prefix(&ZSTD_MAGIC).unwrap_or(&frame);
            Ok(body.to_vec())
        })
        .collect()
}
