//! Simple glyphs with the same shape, such as the Latin and the Cyrillic A.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use super::matcher::PartMatcher;
use crate::error::Error;
use nfr::internals::model::compose::Part;

/// The simple glyphs so far, by their shape.
#[derive(Default)]
pub(super) struct Duplicates {
    /// By the hash of the points relative to the first one, in font units.
    by_shape: HashMap<u64, Vec<u16>>,
    originals: HashMap<u16, u16>,
}

impl Duplicates {
    /// An earlier glyph with the same shape and hinting, as the only part of this one.
    pub(super) fn find(&mut self, gid: u16, matcher: &mut PartMatcher<'_>) -> Result<Option<Part>, Error> {
        let whole = matcher.unhinted(gid)?;
        let Some(first) = whole.points.first() else { return Ok(None) };
        let mut hasher = DefaultHasher::new();
        let units = f32::from(matcher.units_per_em());
        let rounded = |point: &[f32; 2], axis: usize| ((point[axis] - first[axis]) * units).round() as i32;
        whole.points.iter().for_each(|p| [rounded(p, 0), rounded(p, 1)].hash(&mut hasher));
        let bucket = self.by_shape.entry(hasher.finish()).or_default();
        if bucket.is_empty() {
            bucket.push(gid);
            return Ok(None);
        }
        let whole = matcher.draw(gid)?;
        for original in bucket.iter() {
            if let Some(parts) = matcher.match_parts(&whole, &[*original])? {
                self.originals.insert(gid, *original);
                return Ok(parts.into_iter().next());
            }
        }
        bucket.push(gid);
        Ok(None)
    }

    /// The glyph whose model is used for this one.
    pub(super) fn original(&self, gid: u16) -> u16 {
        self.originals.get(&gid).copied().unwrap_or(gid)
    }
}
