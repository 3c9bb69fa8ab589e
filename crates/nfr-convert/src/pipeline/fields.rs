//! Fields, which are trained.

use std::collections::BTreeMap;

use super::glyphs::{GlyphTrainer, Measured, Stages};
use crate::compose::Decomposition;
use crate::error::Error;
use crate::partial::Partial;
use crate::writer::{self, GlyphModel};
use nfr::internals::table::Header;

/// The table, and the error of each glyph.
pub(super) fn table(
    stages: Stages<'_>,
    partial: Option<&Partial>,
    header: &Header,
    glyphs: &Decomposition,
) -> Result<(Vec<u8>, BTreeMap<u16, Measured>), Error> {
    let trainer = GlyphTrainer { stages, partial };
    let trained = trainer.train_all(&glyphs.modelled)?;
    let mut measured: BTreeMap<u16, Measured> = trained.iter().map(|t| (t.gid, t.measured.clone())).collect();
    let models: Vec<GlyphModel> =
        trained.into_iter().map(|t| GlyphModel { gid: t.gid, weights: t.weights }).collect();
    measured.extend(trainer.measure_composed(&models, &glyphs.composed)?);
    let (table, _) = writer::write(header, &models, &glyphs.composed, &[], stages.scale)?;
    Ok((table, measured))
}
