//! What a work file keeps of outline models. Fields are kept where they are trained.

use std::collections::BTreeMap;

use super::glyphs::Measured;
use crate::compare::metrics::Sums;
use crate::conversion::{Progress, Stage};
use crate::error::Error;
use crate::outline::{Encoded, FittedOutline, Store, keep_encoded, keep_fitted, kept_encoded, kept_fitted};
use crate::partial::{Kind, Partial};
use nfr::internals::table::Dropout;

/// A work file, or none.
#[derive(Clone, Copy)]
pub(super) struct Kept<'k>(pub(super) Option<&'k Partial>);

impl Kept<'_> {
    /// A fitted outline, or none for a glyph that cannot have one, if the file has it.
    pub(super) fn fitted(self, gid: u16) -> Option<Option<FittedOutline>> {
        kept_fitted(self.0?.kept(Kind::Fit, gid)?)
    }

    /// An encoded outline, if the file has it.
    pub(super) fn encoded(self, gid: u16) -> Option<Encoded> {
        kept_encoded(self.0?.kept(Kind::Encoding, gid)?)
    }

    /// The errors of a model, if the file has them.
    pub(super) fn measured(self, gid: u16) -> Option<Measured> {
        read_measured(self.0?.kept(Kind::Measurement, gid)?)
    }

    /// The number of these glyphs of which the file has no result of a kind.
    pub(super) fn lacks(self, kind: Kind, gids: impl Iterator<Item = u16>) -> usize {
        gids.filter(|gid| self.0.is_none_or(|partial| partial.kept(kind, *gid).is_none())).count()
    }

    /// Keeps a fitted outline.
    pub(super) fn keep_fitted(self, gid: u16, outline: Option<&FittedOutline>) -> Result<(), Error> {
        self.0.map_or(Ok(()), |partial| partial.keep(Kind::Fit, gid, &keep_fitted(outline)))
    }

    /// Keeps the errors of a model.
    pub(super) fn keep_measured(self, gid: u16, measured: &Measured) -> Result<(), Error> {
        self.0.map_or(Ok(()), |partial| partial.keep(Kind::Measurement, gid, &measured_bytes(measured)))
    }
}

/// Encoded outlines of some glyphs in a work file.
pub(super) struct Messages<'k> {
    pub(super) kept: Kept<'k>,
    pub(super) gids: &'k [u16],
    pub(super) progress: &'k dyn Progress,
}

impl Store for Messages<'_> {
    fn kept(&self, number: usize) -> Option<Encoded> {
        self.kept.encoded(self.gids[number])
    }

    fn keep(&self, number: usize, encoded: &Encoded) -> Result<(), Error> {
        self.progress.worked(Stage::Encoding);
        let Some(partial) = self.kept.0 else { return Ok(()) };
        partial.keep(Kind::Encoding, self.gids[number], &keep_encoded(encoded))
    }
}

fn measured_bytes(measured: &Measured) -> Vec<u8> {
    let mut out = vec![u8::from(measured.is_worse_than_unhinted)];
    for sums in [&measured.learnt, &measured.all] {
        out.extend(sums.to_bytes());
    }
    for (ppem, dropout) in &measured.dropout {
        out.extend(ppem.to_be_bytes());
        let flags = [dropout.is_enabled(), dropout.is_smart(), dropout.fills_stubs()];
        out.extend(flags.map(u8::from));
    }
    out
}

fn read_measured(bytes: &[u8]) -> Option<Measured> {
    let (is_worse, rest) = bytes.split_first()?;
    let (learnt, rest) = rest.split_first_chunk()?;
    let (all, rest) = rest.split_first_chunk()?;
    let modes = rest.as_chunks::<5>().0.iter().map(|[high, low, enabled, smart, stubs]| {
        let mode = if *enabled == 0 { Dropout::default() } else { Dropout::new(*smart != 0, *stubs != 0) };
        (u16::from_be_bytes([*high, *low]), mode)
    });
    Some(Measured {
        learnt: Sums::from_bytes(*learnt),
        all: Sums::from_bytes(*all),
        dropout: modes.collect::<BTreeMap<_, _>>(),
        is_worse_than_unhinted: *is_worse != 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nfr::{Bitmap, Placement};

    #[test]
    fn measurements_are_read_as_they_were_kept() {
        let bitmap = |pixels: [u8; 4]| Bitmap {
            placement: Placement { left: 0, top: 2, width: 2, height: 2 },
            pixels: pixels.to_vec(),
        };
        let learnt = Sums::of(&bitmap([0, 255, 3, 90]), &bitmap([0, 100, 4, 90]));
        let mut all = learnt;
        all.add(&bitmap([9, 8, 7, 6]), &bitmap([5, 4, 3, 2]));
        let dropout = BTreeMap::from([
            (8, Dropout::default()),
            (9, Dropout::new(true, false)),
            (300, Dropout::new(false, true)),
        ]);
        let measured = Measured { learnt, all, dropout, is_worse_than_unhinted: true };
        let read = read_measured(&measured_bytes(&measured));
        let parts = |m: &Measured| (m.learnt, m.all, m.dropout.clone(), m.is_worse_than_unhinted);
        assert_eq!(read.as_ref().map(parts), Some(parts(&measured)));
    }
}
