//! Reading the table: nothing is copied until a glyph is asked for.

use read_fonts::FontData;
use read_fonts::types::BigEndian;
use ruzstd::decoding::{BlockDecodingStrategy, Dictionary, FrameDecoder};

use super::{
    HEADER_LEN, Header, MAJOR_VERSION, MAX_DICTIONARY_BYTES, MAX_MODEL_BYTES, MAX_SNAP_BYTES,
    MAX_TRAINED_PPEM, OUTLINES_DROPPED, ZSTD_MAGIC, codec,
    composed::{ComposedGlyphs, Gids},
};
use crate::error::Error;
use crate::model::Target;
use crate::model::compose::Part;
use crate::model::gridfit::{Scale, Weights};

/// An `Nfrt` table, borrowed from the font's bytes.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    header: Header,
    len: usize,
    gids: &'a [BigEndian<u16>],
    bounds: &'a [BigEndian<i16>],
    ends: &'a [BigEndian<u32>],
    composed: ComposedGlyphs<'a>,
    dictionary: &'a [u8],
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
            steps: u16_at(36)?,
            knots: u8_at(38)?,
            rank: u8_at(39)?,
            cell: u16_at(40)?,
            skipped: u8_at(42)?,
        };
        if header.first_ppem == 0
            || header.first_ppem > header.last_ppem
            || header.last_ppem > MAX_TRAINED_PPEM
            || !(header.last_ppem - header.first_ppem).is_multiple_of(u16::from(header.skipped) + 1)
        {
            return Err(Error::Malformed(format!(
                "table 'Nfrt' claims sizes {}–{} ppem with {} left out between each two; convert the font again",
                header.first_ppem, header.last_ppem, header.skipped
            )));
        }
        let count = usize::from(u16_at(10)?);
        let (dictionary_len, payload_len) = (u32_at(28)? as usize, u32_at(32)? as usize);
        if dictionary_len > MAX_DICTIONARY_BYTES {
            return Err(Error::LimitExceeded(format!(
                "table 'Nfrt' has a dictionary of {dictionary_len} bytes"
            )));
        }
        let gids_at = HEADER_LEN;
        let bounds_at = gids_at + 2 * count;
        let ends_at = bounds_at + 8 * count;
        let dictionary_at = ends_at + 4 * count;
        let payload_at = dictionary_at + dictionary_len;
        let composed_at = payload_at.checked_add(payload_len).ok_or_else(truncated)?;
        let slice = |range: std::ops::Range<usize>| bytes.get(range).ok_or_else(truncated);
        let table = Self {
            header,
            len: bytes.len(),
            gids: data.read_array(gids_at..bounds_at).map_err(|_| truncated())?,
            bounds: data.read_array(bounds_at..ends_at).map_err(|_| truncated())?,
            ends: data.read_array(ends_at..dictionary_at).map_err(|_| truncated())?,
            dictionary: slice(dictionary_at..payload_at)?,
            payload: slice(payload_at..composed_at)?,
            composed: ComposedGlyphs::parse(data, composed_at)?,
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

    /// The glyphs that can be drawn, ascending: with a model of their own, or put together from others.
    pub fn gids(&self) -> Gids<'a> {
        Gids::new(self.gids, self.composed.gids())
    }

    /// Whether a glyph can be drawn.
    pub fn contains(&self, gid: u16) -> bool {
        self.find(gid).is_some() || self.is_composed(gid)
    }

    /// Whether a glyph is put together from the models of others.
    pub fn is_composed(&self, gid: u16) -> bool {
        self.composed.find(gid).is_some()
    }

    fn find(&self, gid: u16) -> Option<usize> {
        self.gids.binary_search_by_key(&gid, |g| g.get()).ok()
    }

    /// A glyph's outline box in font units and its compressed model.
    fn entry(&self, gid: u16) -> Result<([i16; 4], &'a [u8]), Error> {
        let index = self.find(gid).ok_or(Error::MissingGlyph(gid))?;
        let bounds = [0, 1, 2, 3].map(|k| self.bounds[4 * index + k].get());
        let start = if index == 0 { 0 } else { self.ends[index - 1].get() as usize };
        let bytes = self
            .payload
            .get(start..self.ends[index].get() as usize)
            .ok_or_else(|| Error::Malformed(format!("the model of glyph {gid} lies outside the table")))?;
        Ok((bounds, bytes))
    }

    /// The bytes that a glyph's compressed model takes, or the list of its parts.
    ///
    /// # Errors
    ///
    /// `MissingGlyph`, or `Malformed` for an entry that points nowhere.
    pub fn model_len(&self, gid: u16) -> Result<usize, Error> {
        match self.composed.find(gid) {
            Some(index) => self.composed.len_of(index),
            None => self.entry(gid).map(|(_, bytes)| bytes.len()),
        }
    }
}

/// Unpacks models; keeps the table's dictionary and its own memory between calls.
pub struct ModelDecoder {
    frames: FrameDecoder,
    dictionary: Option<u32>,
    frame: Vec<u8>,
    /// The places of parts that snap; unpacked when the first composed glyph is asked for.
    snaps: Option<Vec<i8>>,
}

impl ModelDecoder {
    /// Prepares for a table's models.
    ///
    /// # Errors
    ///
    /// `Malformed` if the table's dictionary is damaged.
    pub fn new(table: &Table<'_>) -> Result<Self, Error> {
        let mut frames = FrameDecoder::new();
        frames.set_max_window_size(MAX_MODEL_BYTES as u64);
        let mut dictionary = None;
        if !table.dictionary.is_empty() {
            let decoded = Dictionary::decode_dict(table.dictionary)
                .map_err(|e| Error::Malformed(format!("table 'Nfrt' has a damaged dictionary ({e})")))?;
            dictionary = Some(decoded.id);
            frames.add_dict(decoded).map_err(|e| Error::Malformed(e.to_string()))?;
        }
        Ok(Self { frames, dictionary, frame: Vec::new(), snaps: None })
    }

    /// Unpacks one glyph's weights.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if the glyph has no model, `Malformed` or `LimitExceeded` if its bytes are damaged.
    pub fn decode(&mut self, table: &Table<'_>, gid: u16, scale: Scale) -> Result<Weights, Error> {
        let (bounds, packed) = table.entry(gid)?;
        let bytes =
            self.unpack(packed, self.dictionary, MAX_MODEL_BYTES, &format!("the model of glyph {gid}"))?;
        codec::decode(&bytes, bounds, scale)
    }

    /// Unpacks the parts of a composed glyph. Each is a glyph that has a model of its own.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if the glyph is not composed, `Malformed` or `LimitExceeded` if its bytes are damaged.
    pub fn parts(&mut self, table: &Table<'_>, gid: u16, scale: Scale) -> Result<Vec<Part>, Error> {
        let snaps = match self.snaps.take() {
            Some(snaps) => snaps,
            None => {
                let most = table.composed.snap_count() * scale.sizes();
                if most > MAX_SNAP_BYTES {
                    return Err(Error::LimitExceeded(format!("table 'Nfrt' has {most} bytes of places")));
                }
                let bytes = match table.composed.packed_snaps() {
                    [] => Vec::new(),
                    packed => self.unpack(packed, None, most, "the list of places")?,
                };
                bytes.into_iter().map(|byte| byte as i8).collect()
            }
        };
        let parts = table.composed.parts(gid, table.gids, &snaps, scale.sizes());
        self.snaps = Some(snaps);
        parts
    }

    fn unpack(
        &mut self,
        packed: &[u8],
        dictionary: Option<u32>,
        most: usize,
        what: &str,
    ) -> Result<Vec<u8>, Error> {
        let damaged = |e: &dyn std::fmt::Display| {
            Error::Malformed(format!("{what} cannot be unpacked ({e}); convert the font again"))
        };
        self.frame.clear();
        self.frame.extend_from_slice(&ZSTD_MAGIC);
        self.frame.extend_from_slice(packed);
        let mut source = self.frame.as_slice();
        self.frames.init(&mut source).map_err(|e| damaged(&e))?;
        if let Some(id) = dictionary {
            self.frames.force_dict(id).map_err(|e| damaged(&e))?;
        }
        let mut bytes = Vec::new();
        // Frame by frame of at most the limit: what claims to be larger is stopped before it is unpacked.
        while !self.frames.is_finished() {
            self.frames
                .decode_blocks(&mut source, BlockDecodingStrategy::UptoBytes(most))
                .map_err(|e| damaged(&e))?;
            self.frames.collect_to_writer(&mut bytes).map_err(|e| damaged(&e))?;
            if bytes.len() > most {
                return Err(Error::LimitExceeded(format!("{what} is larger than any can be")));
            }
        }
        self.frames.collect_to_writer(&mut bytes).map_err(|e| damaged(&e))?;
        Ok(bytes)
    }
}
