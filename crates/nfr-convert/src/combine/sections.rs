//! The parts of a table that are not outline models, put together from two fonts.

use std::collections::BTreeMap;

use nfr::internals::model::compose::Composed;
use nfr::internals::table::{Certificate, CertifiedErrors, Dropout, DropoutException};

use super::font::ConvertedFont;
use crate::error::Error;
use crate::writer::{GlyphModel, GlyphNetwork, add_exception, write, write_header};

/// No table asks for more memory than this for a field; the converter has written it.
const MEMORY: usize = 1 << 30;

/// What a certificate says of glyphs.
pub(super) type Errors = BTreeMap<u16, CertifiedErrors>;

/// The header, the fields and the networks: all of the first font, and those of the second that are new.
///
/// # Errors
///
/// Those of damaged models and of [`write`].
pub(super) fn fields(
    base: &ConvertedFont<'_>,
    addition: &ConvertedFont<'_>,
    is_new: impl Fn(&u16) -> bool,
) -> Result<Vec<u8>, Error> {
    let (header, scale) = (nfr::internals::header(&base.font), nfr::internals::scale(&base.font));
    let (mut models, mut composed, mut networks) = (Vec::new(), Vec::new(), Vec::new());
    for font in [base, addition] {
        let table = font.table()?;
        let is_taken = |gid: &u16| std::ptr::eq(font, base) || is_new(gid);
        for gid in table.field_gids().filter(is_taken) {
            models.push(GlyphModel { gid, weights: table.weights(gid.into(), scale, MEMORY)? });
        }
        for gid in table.network_gids().filter(is_taken) {
            networks.push(GlyphNetwork { gid, bytes: table.packed_network(gid.into())?.to_vec() });
        }
        let is_composed_field = |gid: &u16| {
            let glyph = u32::from(*gid);
            table.is_composed(glyph) && table.outlines().find(glyph).is_none()
        };
        for gid in table.gids().filter(is_taken).filter(is_composed_field) {
            let offsets = table.part_offsets(gid.into(), scale, MEMORY)?;
            composed.push(Composed { gid, parts: table.parts(gid.into(), scale, &offsets)? });
        }
    }
    if models.is_empty() && networks.is_empty() {
        return Ok(write_header(header));
    }
    models.sort_by_key(|model| model.gid);
    composed.sort_by_key(|glyph| glyph.gid);
    networks.sort_by_key(|network| network.gid);
    Ok(write(header, &models, &composed, &networks, scale)?.0)
}

/// What the certificates say of the glyphs; none if a font has no certificate.
pub(super) fn errors(
    base: &ConvertedFont<'_>,
    addition: &ConvertedFont<'_>,
    is_new: impl Fn(&u16) -> bool,
) -> Result<Option<Errors>, Error> {
    let mut errors = Errors::new();
    for font in [addition, base] {
        let table = font.table()?;
        let Some(certificate) = table.certificate() else { return Ok(None) };
        let stated = table.gids().zip(certificate.errors());
        errors.extend(stated.filter(|(gid, _)| std::ptr::eq(font, base) || is_new(gid)));
    }
    Ok(Some(errors))
}

/// The texts of a certificate.
pub(super) struct Texts {
    is_exact: bool,
    texts: [String; 3],
}

impl Texts {
    /// Those of two certificates: where they differ, one after the other.
    pub(super) fn of(base: Option<Certificate<'_>>, addition: Option<Certificate<'_>>) -> Self {
        let both = [&base, &addition].map(|certificate| {
            certificate.as_ref().map_or([""; 3], |certificate| {
                [certificate.teacher, certificate.converter, certificate.options]
            })
        });
        let text = |k: usize| match [both[0][k], both[1][k]] {
            [a, b] if a == b || b.is_empty() => a.to_owned(),
            [a, b] if a.split("; ").any(|known| known == b) => a.to_owned(),
            [a, b] => format!("{a}; {b}"),
        };
        let is_exact = [&base, &addition].into_iter().flatten().all(|certificate| certificate.is_exact);
        Self { is_exact, texts: [text(0), text(1), text(2)] }
    }

    /// A certificate with these texts.
    pub(super) fn certificate(&self) -> Certificate<'_> {
        let [teacher, converter, options] = &self.texts;
        Certificate::new(self.is_exact, teacher, converter, options)
    }
}

/// Modes of drop-out control, in ranges of sizes, and the glyphs that have others.
pub(super) type Modes = (Vec<(u16, Dropout)>, Vec<DropoutException>);

/// The modes of drop-out control: those of the first font, and its exceptions with what is different for the new glyphs; none if a font
/// does not say them.
pub(super) fn dropout(
    base: &ConvertedFont<'_>,
    addition: &ConvertedFont<'_>,
    is_new: impl Fn(&u16) -> bool,
) -> Result<Option<Modes>, Error> {
    let (table, added) = (base.table()?, addition.table()?);
    let (Some(modes), Some(others)) = (table.dropout(), added.dropout()) else { return Ok(None) };
    let ranges: Vec<(u16, Dropout)> = modes.ranges().collect();
    let usual = |ppem: u16| ranges.iter().find(|(last, _)| ppem <= *last).map(|(_, mode)| *mode);
    let mut exceptions: Vec<DropoutException> = modes.exceptions().collect();
    let (first, last) = base.font.ppem_range();
    for gid in added.gids().filter(is_new) {
        for ppem in first..=last {
            if let Some(mode) = others.mode(gid.into(), ppem).filter(|mode| usual(ppem) != Some(*mode)) {
                add_exception(&mut exceptions, gid, ppem, mode);
            }
        }
    }
    exceptions.sort_by_key(|exception| (exception.gid, exception.first_ppem));
    Ok(Some((ranges, exceptions)))
}
