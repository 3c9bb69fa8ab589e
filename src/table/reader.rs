//! Reading the table: nothing is copied until a glyph is asked for.

use alloc::vec::Vec;

use read_fonts::FontData;
use read_fonts::types::BigEndian;

use super::certificate::Certificate;
use super::composed::ComposedGlyphs;
use super::dropout::DropoutModes;
use super::gids::{Gids, find, outside};
use super::header::{
    BLOCK, CERTIFICATE, DROPOUT, HEADER_LEN, Header, MAJOR_VERSION, MAX_GRID_OFFSET_BYTES, NETWORKS,
    OUTLINE_MODELS, OUTLINES_DROPPED,
};
use super::network_index::NetworkIndex;
use super::outline::{self, OutlineIndex};
use super::{codec, part_offsets};
use crate::constants::MAX_TRAINED_PPEM;
use crate::error::Error;
use crate::model::compose::Part;
use crate::model::gridfit::Weights;
use crate::model::sizes::Scale;
use crate::network;
use crate::target::Target;

/// An `Nfrt` table, borrowed from the font's bytes.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    header: Header,
    len: usize,
    gids: &'a [BigEndian<u16>],
    /// The length of each packed model.
    lengths: &'a [BigEndian<u16>],
    /// Where the models of each block begin.
    blocks: &'a [BigEndian<u32>],
    composed: ComposedGlyphs<'a>,
    networks: NetworkIndex<'a>,
    outlines: OutlineIndex<'a>,
    flags: u8,
    /// Where the certificate and the modes of drop-out control begin, which are read when they are asked for.
    rest: (FontData<'a>, usize),
    payload: &'a [u8],
}

/// The table ends before what begins at `offset`.
fn truncated(offset: usize) -> Error {
    Error::MalformedModels { what: "ends early", offset }
}

impl<'a> Table<'a> {
    /// Reads the header and finds the arrays.
    ///
    /// # Errors
    ///
    /// `MalformedModels` for bytes that contradict themselves, `UnknownVersion` for a version from the future.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, Error> {
        let data = FontData::new(bytes);
        let u8_at = |at| data.read_at::<u8>(at).map_err(|_| truncated(at));
        let u16_at = |at| data.read_at::<u16>(at).map_err(|_| truncated(at));
        let u32_at = |at| data.read_at::<u32>(at).map_err(|_| truncated(at));
        let u64_at = |at| Ok::<u64, Error>(u64::from(u32_at(at)?) << 32 | u64::from(u32_at(at + 4)?));
        let major = u16_at(0)?;
        if major != MAJOR_VERSION {
            return Err(Error::UnknownVersion { major });
        }
        let target = match u8_at(4)? {
            0 => Target::Smooth,
            1 => Target::Mono,
            2 => Target::Lcd,
            _ => return Err(Error::MalformedModels { what: "names an unknown target", offset: 4 }),
        };
        let header = Header {
            target,
            first_ppem: u16_at(6)?,
            last_ppem: u16_at(8)?,
            outline_hash: u64_at(12)?,
            outlines_dropped: u8_at(5)? & OUTLINES_DROPPED != 0,
            origin: Header::origin_of(u8_at(5)?),
            seed: u64_at(20)?,
            steps: u16_at(32)?,
            knots: u8_at(34)?,
            rank: u8_at(35)?,
            cell: u16_at(36)?,
            glyph_count: u16_at(38)?,
        };
        if header.first_ppem == 0
            || header.first_ppem > header.last_ppem
            || header.last_ppem > MAX_TRAINED_PPEM
        {
            return Err(Error::MalformedModels { what: "claims impossible sizes", offset: 6 });
        }
        let count = usize::from(u16_at(10)?);
        let payload_len = u32_at(28)? as usize;
        let gids_at = HEADER_LEN;
        let lengths_at = gids_at + 2 * count;
        let blocks_at = lengths_at + 2 * count;
        let payload_at = blocks_at + 4 * count.div_ceil(BLOCK);
        let composed_at = payload_at.checked_add(payload_len).ok_or_else(|| truncated(payload_at))?;
        let (composed, networks_at) = ComposedGlyphs::parse(data, composed_at)?;
        let flags = u8_at(5)?;
        let (networks, outlines_at) = match flags & NETWORKS {
            0 => (NetworkIndex::default(), networks_at),
            _ => NetworkIndex::parse(data, networks_at)?,
        };
        let (outlines, certificate_at) = match flags & OUTLINE_MODELS {
            0 => (OutlineIndex::default(), outlines_at),
            _ => OutlineIndex::parse(data, outlines_at)?,
        };
        let table = Self {
            header,
            len: bytes.len(),
            gids: data.read_array(gids_at..lengths_at).map_err(|_| truncated(gids_at))?,
            lengths: data.read_array(lengths_at..blocks_at).map_err(|_| truncated(lengths_at))?,
            blocks: data.read_array(blocks_at..payload_at).map_err(|_| truncated(blocks_at))?,
            payload: bytes.get(payload_at..composed_at).ok_or_else(|| truncated(payload_at))?,
            composed,
            networks,
            outlines,
            flags,
            rest: (data, certificate_at),
        };
        Ok(table)
    }

    /// What the conversion was asked for.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The table's length in bytes.
    pub fn table_len(&self) -> usize {
        self.len
    }

    /// The glyphs that can be drawn, ascending: with a model of their own, composed of others, or with
    /// a network.
    pub fn gids(&self) -> Gids<'a> {
        Gids::new([self.gids, self.composed.gids(), self.networks.gids()], self.outlines.ranges())
    }

    /// The glyphs that have a network, ascending.
    pub fn network_gids(&self) -> Gids<'a> {
        Gids::new([&[], &[], self.networks.gids()], &[])
    }

    /// The outline models.
    pub fn outlines(&self) -> &OutlineIndex<'a> {
        &self.outlines
    }

    /// What the conversion said of its result, if it did.
    pub fn certificate(&self) -> Option<Certificate<'a>> {
        self.read_rest().ok()?.0
    }

    /// What the hints ask of a renderer in black and white, if the table says it.
    pub fn dropout(&self) -> Option<DropoutModes<'a>> {
        self.read_rest().ok()?.1
    }

    /// Checks what is read when it is asked for, and only then.
    ///
    /// # Errors
    ///
    /// `MalformedModels` if the certificate or the modes of drop-out control are damaged.
    pub fn check(&self) -> Result<(), Error> {
        self.read_rest().map(|_| ())
    }

    fn read_rest(&self) -> Result<(Option<Certificate<'a>>, Option<DropoutModes<'a>>), Error> {
        let (data, mut at) = self.rest;
        let mut certificate = None;
        if self.flags & CERTIFICATE != 0 {
            let (found, end) = Certificate::parse(data, at, self.gids().len())?;
            (certificate, at) = (Some(found), end);
        }
        let dropout = if self.flags & DROPOUT == 0 { None } else { Some(DropoutModes::parse(data, at)?) };
        Ok((certificate, dropout))
    }

    /// The glyphs that have a field of their own, ascending.
    pub fn field_gids(&self) -> Gids<'a> {
        Gids::new([self.gids, &[], &[]], &[])
    }

    /// Whether a glyph can be drawn.
    pub fn contains(&self, gid: u32) -> bool {
        self.find(gid).is_some()
            || self.composed.find(gid).is_some()
            || self.is_network(gid)
            || self.outlines.find(gid).is_some()
    }

    /// Whether a glyph is composed of the models of others.
    pub fn is_composed(&self, gid: u32) -> bool {
        self.composed.find(gid).is_some() || self.outlines.glyph(gid).is_ok_and(outline::is_composed)
    }

    /// Whether a glyph has a network.
    pub fn is_network(&self, gid: u32) -> bool {
        self.networks.find(gid).is_some()
    }

    /// Checks that a glyph is drawn in one way only.
    ///
    /// # Errors
    ///
    /// `MissingModel` if the glyph is not in the table, `MalformedModel` if it is there in two ways.
    pub fn check_glyph(&self, gid: u32) -> Result<(), Error> {
        let ways = [
            self.find(gid).is_some(),
            self.composed.find(gid).is_some(),
            self.is_network(gid),
            self.outlines.find(gid).is_some(),
        ];
        match ways.into_iter().filter(|way| *way).count() {
            0 => Err(Error::MissingModel(gid)),
            1 => Ok(()),
            _ => Err(Error::MalformedModel { glyph: gid, what: "is in the table twice" }),
        }
    }

    fn find(&self, gid: u32) -> Option<usize> {
        find(self.gids, gid)
    }

    /// A glyph's packed model.
    fn packed(&self, gid: u32) -> Result<&'a [u8], Error> {
        let index = self.find(gid).ok_or(Error::MissingModel(gid))?;
        let block = index / BLOCK;
        let before: usize =
            self.lengths[block * BLOCK..index].iter().map(|length| usize::from(length.get())).sum();
        let start = (self.blocks[block].get() as usize).saturating_add(before);
        let end = start.saturating_add(self.lengths[index].get().into());
        self.payload.get(start..end).ok_or(outside(gid))
    }

    /// The bytes that a glyph's packed model or its network takes, or the list of its parts.
    ///
    /// # Errors
    ///
    /// `MissingModel`, or `MalformedModel` for an entry that points nowhere.
    pub fn model_len(&self, gid: u32) -> Result<usize, Error> {
        if self.outlines.find(gid).is_some() {
            return self.outlines.glyph(gid).map(<[u8]>::len);
        }
        match (self.networks.find(gid), self.composed.find(gid)) {
            (Some(index), _) => self.networks.packed(index).map(<[u8]>::len),
            (None, Some(index)) => self.composed.len_of(index),
            (None, None) => self.packed(gid).map(<[u8]>::len),
        }
    }

    /// Unpacks one glyph's weights, which may take up to `limit` bytes.
    ///
    /// # Errors
    ///
    /// `MissingModel` if the glyph has no model of its own, `MalformedModel` or `ModelTooLarge` if its bytes are
    /// damaged, `DecodedTooLarge`.
    pub fn weights(&self, gid: u32, scale: Scale, limit: usize) -> Result<Weights, Error> {
        codec::decode_within(self.packed(gid)?, scale, limit).map_err(|failure| match failure {
            codec::Failure::Damage(damage) => damage.of(gid),
            codec::Failure::Memory(bytes) => Error::DecodedTooLarge { glyph: gid, bytes, limit },
        })
    }

    /// Decodes the grid offsets that the parts of composed glyphs share, one list after the other. `gid` is the glyph that
    /// they are needed for.
    ///
    /// # Errors
    ///
    /// `MalformedModel` or `ModelTooLarge` if they are damaged, `DecodedTooLarge` if they take more than `limit` bytes.
    pub fn part_offsets(&self, gid: u32, scale: Scale, limit: usize) -> Result<Vec<i8>, Error> {
        let (count, sizes) = (self.composed.grid_offset_count(), scale.sizes());
        let bytes = count * sizes;
        if bytes > MAX_GRID_OFFSET_BYTES {
            let (count, limit) = (bytes as u64, MAX_GRID_OFFSET_BYTES as u64);
            return Err(Error::ModelTooLarge { glyph: gid, what: "offsets of parts", count, limit });
        }
        if bytes > limit {
            return Err(Error::DecodedTooLarge { glyph: gid, bytes, limit });
        }
        let packed = self.composed.packed_grid_offsets();
        part_offsets::decode(packed, count, sizes).map_err(|damage| damage.of(gid))
    }

    /// The parts of a composed glyph, each of which is a glyph that has a model of its own. `offsets` are this table's
    /// [`Self::part_offsets`].
    ///
    /// # Errors
    ///
    /// `MissingModel` if the glyph is not composed, `MalformedModel` or `ModelTooLarge` if its bytes are damaged.
    pub fn parts(&self, gid: u32, scale: Scale, offsets: &[i8]) -> Result<Vec<Part>, Error> {
        self.composed.parts(gid, self.gids, offsets, scale.sizes())
    }

    /// A glyph's network.
    ///
    /// # Errors
    ///
    /// `MissingModel` if the glyph has none, `MalformedModel` or `ModelTooLarge` if its bytes are damaged,
    /// `DecodedTooLarge` if it takes more than `limit` bytes.
    #[cfg(feature = "networks")]
    pub fn network(&self, gid: u32, limit: usize) -> Result<network::NetworkWeights, Error> {
        let packed = self.packed_network(gid)?;
        let bytes = network::Head::parse(packed).map_err(|damage| damage.of(gid))?.0.memory();
        if bytes > limit {
            return Err(Error::DecodedTooLarge { glyph: gid, bytes, limit });
        }
        network::decode(packed).map_err(|damage| damage.of(gid))
    }

    /// How the weights of a glyph's network are stored.
    ///
    /// # Errors
    ///
    /// As [`Self::network`].
    pub fn precision(&self, gid: u32) -> Result<network::Precision, Error> {
        network::precision(self.packed_network(gid)?).map_err(|damage| damage.of(gid))
    }

    /// The bytes of a glyph's network.
    ///
    /// # Errors
    ///
    /// `MissingModel` if the glyph has none, `MalformedModel` for one that lies outside the table.
    pub fn packed_network(&self, gid: u32) -> Result<&'a [u8], Error> {
        self.networks.packed(self.networks.find(gid).ok_or(Error::MissingModel(gid))?)
    }
}
