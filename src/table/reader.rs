//! Reading the table: nothing is copied until a glyph is asked for.

use read_fonts::FontData;
use read_fonts::types::BigEndian;

use super::{
    BLOCK, Gids, HEADER_LEN, Header, MAJOR_VERSION, MAX_SNAP_BYTES, MAX_TRAINED_PPEM, NETWORKS,
    OUTLINES_DROPPED, codec, composed::ComposedGlyphs, network, networks::Networks,
};
use crate::error::Error;
use crate::model::Target;
use crate::model::compose::Part;
use crate::model::gridfit::{Scale, Weights};
use crate::model::network::NetworkWeights;

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
    networks: Networks<'a>,
    payload: &'a [u8],
}

fn truncated() -> Error {
    Error::Malformed("table 'Nfrt' is shorter than it says; convert the font again".into())
}

impl<'a> Table<'a> {
    /// Reads the header and finds the arrays.
    ///
    /// # Errors
    ///
    /// `Malformed` for bytes that contradict themselves, `Unsupported` for a version from the future.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, Error> {
        let data = FontData::new(bytes);
        let u8_at = |at| data.read_at::<u8>(at).map_err(|_| truncated());
        let u16_at = |at| data.read_at::<u16>(at).map_err(|_| truncated());
        let u32_at = |at| data.read_at::<u32>(at).map_err(|_| truncated());
        let u64_at = |at| Ok::<u64, Error>(u64::from(u32_at(at)?) << 32 | u64::from(u32_at(at + 4)?));
        let major = u16_at(0)?;
        if major != MAJOR_VERSION {
            return Err(Error::Unsupported(format!(
                "table 'Nfrt' has version {major}, this program reads version {MAJOR_VERSION}; convert the font again"
            )));
        }
        let target = match u8_at(4)? {
            0 => Target::Smooth,
            1 => Target::Mono,
            2 => Target::Lcd,
            other => return Err(Error::Malformed(format!("table 'Nfrt' names an unknown target {other}"))),
        };
        let header = Header {
            target,
            first_ppem: u16_at(6)?,
            last_ppem: u16_at(8)?,
            outline_hash: u64_at(12)?,
            outlines_dropped: u8_at(5)? & OUTLINES_DROPPED != 0,
            seed: u64_at(20)?,
            steps: u16_at(32)?,
            knots: u8_at(34)?,
            rank: u8_at(35)?,
            cell: u16_at(36)?,
        };
        if header.first_ppem == 0
            || header.first_ppem > header.last_ppem
            || header.last_ppem > MAX_TRAINED_PPEM
        {
            return Err(Error::Malformed(format!(
                "table 'Nfrt' claims sizes {}–{} ppem; convert the font again",
                header.first_ppem, header.last_ppem
            )));
        }
        let count = usize::from(u16_at(10)?);
        let payload_len = u32_at(28)? as usize;
        let gids_at = HEADER_LEN;
        let lengths_at = gids_at + 2 * count;
        let blocks_at = lengths_at + 2 * count;
        let payload_at = blocks_at + 4 * count.div_ceil(BLOCK);
        let composed_at = payload_at.checked_add(payload_len).ok_or_else(truncated)?;
        let (composed, networks_at) = ComposedGlyphs::parse(data, composed_at)?;
        let has_networks = u8_at(5)? & NETWORKS != 0;
        let table = Self {
            header,
            len: bytes.len(),
            gids: data.read_array(gids_at..lengths_at).map_err(|_| truncated())?,
            lengths: data.read_array(lengths_at..blocks_at).map_err(|_| truncated())?,
            blocks: data.read_array(blocks_at..payload_at).map_err(|_| truncated())?,
            payload: bytes.get(payload_at..composed_at).ok_or_else(truncated)?,
            composed,
            networks: if has_networks { Networks::parse(data, networks_at)? } else { Networks::default() },
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

    /// The glyphs that can be drawn, ascending: with a model of their own, put together from others, or with a network.
    pub fn gids(&self) -> Gids<'a> {
        Gids::new([self.gids, self.composed.gids(), self.networks.gids()])
    }

    /// The glyphs that have a network, ascending.
    pub fn network_gids(&self) -> Gids<'a> {
        Gids::new([&[], &[], self.networks.gids()])
    }

    /// Whether a glyph can be drawn.
    pub fn contains(&self, gid: u16) -> bool {
        self.find(gid).is_some() || self.is_composed(gid) || self.is_network(gid)
    }

    /// Whether a glyph is put together from the models of others.
    pub fn is_composed(&self, gid: u16) -> bool {
        self.composed.find(gid).is_some()
    }

    /// Whether a glyph has a network.
    pub fn is_network(&self, gid: u16) -> bool {
        self.networks.find(gid).is_some()
    }

    fn find(&self, gid: u16) -> Option<usize> {
        self.gids.binary_search_by_key(&gid, |g| g.get()).ok()
    }

    /// A glyph's packed model.
    fn packed(&self, gid: u16) -> Result<&'a [u8], Error> {
        let index = self.find(gid).ok_or(Error::MissingGlyph(gid))?;
        let block = index / BLOCK;
        let before: usize =
            self.lengths[block * BLOCK..index].iter().map(|length| usize::from(length.get())).sum();
        let start = (self.blocks[block].get() as usize).saturating_add(before);
        let end = start.saturating_add(self.lengths[index].get().into());
        self.payload.get(start..end).ok_or_else(|| {
            Error::Malformed(format!(
                "the model of glyph {gid} lies outside the table; convert the font again"
            ))
        })
    }

    /// The bytes that a glyph's packed model or its network takes, or the list of its parts.
    ///
    /// # Errors
    ///
    /// `MissingGlyph`, or `Malformed` for an entry that points nowhere.
    pub fn model_len(&self, gid: u16) -> Result<usize, Error> {
        match (self.networks.find(gid), self.composed.find(gid)) {
            (Some(index), _) => self.networks.packed(index).map(<[u8]>::len),
            (None, Some(index)) => self.composed.len_of(index),
            (None, None) => self.packed(gid).map(<[u8]>::len),
        }
    }

    /// Unpacks one glyph's weights.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if the glyph has no model, `Malformed` or `LimitExceeded` if its bytes are damaged.
    pub fn weights(&self, gid: u16, scale: Scale) -> Result<Weights, Error> {
        codec::decode(self.packed(gid)?, scale)
    }

    /// A glyph's network.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if the glyph has none, `Malformed` or `LimitExceeded` if its bytes are damaged.
    pub fn network(&self, gid: u16) -> Result<NetworkWeights, Error> {
        network::decode(self.packed_network(gid)?)
    }

    /// How the weights of a glyph's network are stored.
    ///
    /// # Errors
    ///
    /// As [`Self::network`].
    pub fn precision(&self, gid: u16) -> Result<network::Precision, Error> {
        network::precision(self.packed_network(gid)?)
    }

    fn packed_network(&self, gid: u16) -> Result<&'a [u8], Error> {
        self.networks.packed(self.networks.find(gid).ok_or(Error::MissingGlyph(gid))?)
    }
}

/// Unpacks the parts of a table's composed glyphs.
#[derive(Debug, Default)]
pub struct PartsDecoder {
    /// The places of parts that snap; unpacked when the first composed glyph is asked for.
    snaps: Option<Vec<i8>>,
}

impl PartsDecoder {
    /// Unpacks the parts of a composed glyph. Each is a glyph that has a model of its own. The decoder belongs to
    /// this table from then on.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if the glyph is not composed, `Malformed` or `LimitExceeded` if its bytes are damaged.
    pub fn parts(&mut self, table: &Table<'_>, gid: u16, scale: Scale) -> Result<Vec<Part>, Error> {
        let snaps = match self.snaps.take() {
            Some(snaps) => snaps,
            None => {
                let (count, sizes) = (table.composed.snap_count(), scale.sizes());
                if count * sizes > MAX_SNAP_BYTES {
                    let most = count * sizes;
                    return Err(Error::LimitExceeded(format!("table 'Nfrt' has {most} bytes of places")));
                }
                codec::decode_places(table.composed.packed_snaps(), count, sizes)?
            }
        };
        let parts = table.composed.parts(gid, table.gids, &snaps, scale.sizes());
        self.snaps = Some(snaps);
        parts
    }
}
