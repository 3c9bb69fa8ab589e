//! Writing the table.

mod outlines;

use std::collections::{HashMap, HashSet};

use nfr::internals::model::compose::{Composed, Origin};
use nfr::internals::model::gridfit::{Scale, Weights};
use nfr::internals::table::composed::{COUNTS_AT, NO_GRID_OFFSETS};
use nfr::internals::table::{
    BLOCK, CERTIFICATE, Certificate, CertifiedErrors, DROPOUT, Dropout, DropoutException, DropoutModes,
    HEADER_LEN, Header, MAJOR_VERSION, MAX_GRID_OFFSET_BYTES, MAX_PARTS, MINOR_VERSION,
    NETWORK_MINOR_VERSION, NETWORKS, OUTLINES_DROPPED, codec, part_offsets,
};

use crate::error::Error;

pub(crate) use outlines::{Messages, OutlineTable, write_outlines};

/// No packed model is longer than this: the table stores lengths in 16 bits.
const MAX_MODEL_BYTES: usize = u16::MAX as usize;

/// Offsets of the header's fields that networks change.
const MINOR_VERSION_AT: usize = 2;
const FLAGS_AT: usize = 5;

/// One glyph for the table.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphModel {
    /// The glyph.
    pub gid: u16,
    /// Its weights.
    pub weights: Weights,
}

/// One glyph's network for the table.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphNetwork {
    /// The glyph.
    pub gid: u16,
    /// Its head, and its numbers in a zstd frame, see [`network`](nfr::internals::network). They are written as they are.
    pub bytes: Vec<u8>,
}

/// Writes a table. `models`, `composed` and `networks` are in ascending order of their glyphs, and every part has a
/// model. Returns the table and the length of each packed model.
///
/// # Errors
///
/// `LimitExceeded` for a model or parts that readers would refuse, or for networks of more than 4 GiB, `InvalidParameter`
/// for a part without a model or with the wrong number of grid-fitted offsets, or for a network of a glyph that is there already.
pub fn write(
    header: &Header,
    models: &[GlyphModel],
    composed: &[Composed],
    networks: &[GlyphNetwork],
    scale: Scale,
) -> Result<(Vec<u8>, Vec<usize>), Error> {
    let packed = models.iter().map(|m| pack(m, scale)).collect::<Result<Vec<_>, _>>()?;
    let mut out = Vec::with_capacity(HEADER_LEN + 5 * models.len());
    put_header(&mut out, header, models.len(), packed.iter().map(Vec::len).sum());
    out.resize(HEADER_LEN, 0);
    out.extend(models.iter().flat_map(|m| m.gid.to_be_bytes()));
    out.extend(packed.iter().flat_map(|bytes| (bytes.len() as u16).to_be_bytes()));
    let mut start = 0u32;
    for block in packed.chunks(BLOCK) {
        out.extend(start.to_be_bytes());
        start += block.iter().map(|bytes| bytes.len() as u32).sum::<u32>();
    }
    out.extend(packed.iter().flatten());
    put_composed(&mut out, models, composed, scale)?;
    if !networks.is_empty() {
        let others: HashSet<u16> =
            models.iter().map(|m| m.gid).chain(composed.iter().map(|g| g.gid)).collect();
        put_networks(&mut out, &others, networks)?;
    }
    Ok((out, packed.iter().map(Vec::len).collect()))
}

/// The header of a table without fields and networks.
pub(crate) fn write_header(header: &Header) -> Vec<u8> {
    let mut out = Vec::with_capacity(HEADER_LEN);
    put_header(&mut out, header, 0, 0);
    out.resize(HEADER_LEN, 0);
    out
}

/// The flags of a table.
pub(crate) fn flags_mut(table: &mut [u8]) -> &mut u8 {
    &mut table[FLAGS_AT]
}

/// Appends a certificate to a table, with the errors of all of its glyphs, in ascending order.
pub(crate) fn write_certificate(
    table: &mut Vec<u8>,
    certificate: &Certificate<'_>,
    errors: impl IntoIterator<Item = CertifiedErrors>,
) {
    table[FLAGS_AT] |= CERTIFICATE;
    certificate.write(errors, table);
}

/// Adds a glyph's mode of drop-out control at a size to those of other glyphs and of its smaller sizes.
pub(crate) fn add_exception(exceptions: &mut Vec<DropoutException>, gid: u16, ppem: u16, mode: Dropout) {
    match exceptions.last_mut() {
        Some(last) if (last.gid, last.last_ppem + 1, last.mode) == (gid, ppem, mode) => last.last_ppem = ppem,
        _ => exceptions.push(DropoutException { gid, first_ppem: ppem, last_ppem: ppem, mode }),
    }
}

/// Appends the modes of drop-out control to a table that has its certificate already.
pub(crate) fn write_dropout(table: &mut Vec<u8>, ranges: &[(u16, Dropout)], exceptions: &[DropoutException]) {
    table[FLAGS_AT] |= DROPOUT;
    DropoutModes::write(ranges, exceptions, table);
}

fn pack(model: &GlyphModel, scale: Scale) -> Result<Vec<u8>, Error> {
    let too_large = || {
        let gid = model.gid;
        Error::LimitExceeded(format!(
            "the model of glyph {gid} is too large to store; train fewer sizes, or fewer knots and patterns"
        ))
    };
    if codec::exceeds_limits(&model.weights) {
        return Err(too_large());
    }
    let bytes = codec::encode(&model.weights, scale)?;
    if bytes.len() <= MAX_MODEL_BYTES { Ok(bytes) } else { Err(too_large()) }
}

fn put_header(out: &mut Vec<u8>, header: &Header, glyphs: usize, payload: usize) {
    out.extend(MAJOR_VERSION.to_be_bytes());
    out.extend(MINOR_VERSION.to_be_bytes());
    let flag = |is_set: bool, flag: u8| if is_set { flag } else { 0 };
    let flags = flag(header.outlines_dropped, OUTLINES_DROPPED) | header.origin_flags();
    out.extend([header.target_number(), flags]);
    out.extend(header.first_ppem.to_be_bytes());
    out.extend(header.last_ppem.to_be_bytes());
    out.extend((glyphs as u16).to_be_bytes());
    out.extend(header.outline_hash.to_be_bytes());
    out.extend(header.seed.to_be_bytes());
    out.extend((payload as u32).to_be_bytes());
    out.extend(header.steps.to_be_bytes());
    out.extend([header.knots, header.rank]);
    out.extend(header.cell.to_be_bytes());
    out.extend(header.glyph_count.to_be_bytes());
    debug_assert_eq!(out.len(), COUNTS_AT);
}

/// Appends the composed glyphs and fills their counts in.
fn put_composed(
    out: &mut Vec<u8>,
    models: &[GlyphModel],
    composed: &[Composed],
    scale: Scale,
) -> Result<(), Error> {
    let mut lists: Vec<&[i8]> = Vec::new();
    let mut known: HashMap<&[i8], u16> = HashMap::new();
    let (mut ends, mut parts, mut count) = (Vec::new(), Vec::new(), 0u32);
    for glyph in composed {
        if glyph.parts.len() > MAX_PARTS {
            let (gid, parts) = (glyph.gid, glyph.parts.len());
            return Err(Error::LimitExceeded(format!(
                "glyph {gid} has {parts} parts, {MAX_PARTS} are allowed; leave it out"
            )));
        }
        for part in &glyph.parts {
            Origin::new(part, scale).map_err(|_| {
                Error::InvalidParameter(format!("a part of glyph {} lacks grid-fitted offsets", glyph.gid))
            })?;
            let model = models.binary_search_by_key(&part.gid, |m| m.gid).map_err(|_| {
                let (gid, part) = (glyph.gid, part.gid);
                Error::InvalidParameter(format!("glyph {gid} has glyph {part} as a part, which has no model"))
            })?;
            let grid_offsets =
                part.grid_offsets.each_ref().map(|grid_offsets| match grid_offsets.as_slice() {
                    [] => NO_GRID_OFFSETS,
                    list => *known.entry(list).or_insert_with(|| {
                        lists.push(list);
                        (lists.len() - 1) as u16
                    }),
                });
            parts.extend((model as u16).to_be_bytes());
            parts.extend(part.offset.into_iter().flat_map(i16::to_be_bytes));
            parts.extend(grid_offsets.into_iter().flat_map(u16::to_be_bytes));
            count += 1;
        }
        ends.extend(count.to_be_bytes());
    }
    if lists.len() >= usize::from(NO_GRID_OFFSETS) || lists.len() * scale.sizes() > MAX_GRID_OFFSET_BYTES {
        return Err(Error::LimitExceeded(format!(
            "{} lists of parts' offsets; convert fewer glyphs",
            lists.len()
        )));
    }
    let packed = part_offsets::encode(&lists);
    let mut counts = Vec::with_capacity(HEADER_LEN - COUNTS_AT);
    counts.extend((composed.len() as u16).to_be_bytes());
    counts.extend((lists.len() as u16).to_be_bytes());
    counts.extend(count.to_be_bytes());
    counts.extend((packed.len() as u32).to_be_bytes());
    out[COUNTS_AT..HEADER_LEN].copy_from_slice(&counts);
    out.extend(composed.iter().flat_map(|glyph| glyph.gid.to_be_bytes()));
    out.extend(ends);
    out.extend(parts);
    out.extend(packed);
    Ok(())
}

/// Appends the networks, none of which is of a glyph in `others`, and says in the header that they are there.
fn put_networks(out: &mut Vec<u8>, others: &HashSet<u16>, networks: &[GlyphNetwork]) -> Result<(), Error> {
    let mut last = None;
    for network in networks {
        if others.contains(&network.gid) || last >= Some(network.gid) {
            return Err(Error::InvalidParameter(format!(
                "the network of glyph {} is out of order, or the glyph is in the table already",
                network.gid
            )));
        }
        last = Some(network.gid);
    }
    let (mut ends, mut payload) = (Vec::new(), Vec::<u8>::new());
    for network in networks {
        payload.extend(&network.bytes);
        let end = u32::try_from(payload.len()).map_err(|_| {
            Error::LimitExceeded("networks of more than 4 GiB; store fewer, or narrower ones".into())
        })?;
        ends.extend(end.to_be_bytes());
    }
    out[MINOR_VERSION_AT..][..2].copy_from_slice(&NETWORK_MINOR_VERSION.to_be_bytes());
    out[FLAGS_AT] |= NETWORKS;
    out.extend((networks.len() as u16).to_be_bytes());
    out.extend(networks.iter().flat_map(|network| network.gid.to_be_bytes()));
    out.extend(ends);
    out.extend(payload);
    Ok(())
}
