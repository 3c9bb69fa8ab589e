//! What `nfr info --json` says, as a dict.

use std::collections::BTreeSet;

use nfr::Font;
use nfr::internals::network::Precision;
use nfr::internals::table::{MAJOR_VERSION, MINOR_VERSION, NETWORK_MINOR_VERSION, Table};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::error::Failure;

/// What a font carries.
pub(crate) fn of<'py>(py: Python<'py>, font: &Font) -> Result<Bound<'py, PyDict>, Failure> {
    let table = nfr::internals::table(font)?;
    let (first_ppem, last_ppem) = font.ppem_range();
    let models = font.modelled_glyphs().len();
    let networks: Vec<u32> = table.network_gids().map(u32::from).collect();
    let network_bytes = networks.iter().map(|glyph| font.model_len(*glyph)).sum::<Result<usize, _>>()?;
    let network_bits = networks.iter().map(|glyph| table.precision(*glyph).map(Precision::bits));
    let network_bits = network_bits.collect::<Result<BTreeSet<u8>, _>>()?;
    let minor = if networks.is_empty() { MINOR_VERSION } else { NETWORK_MINOR_VERSION };
    let info = PyDict::new(py);
    info.set_item("version", format!("{MAJOR_VERSION}.{minor}"))?;
    info.set_item("target", font.target().name())?;
    info.set_item("first_ppem", first_ppem)?;
    info.set_item("last_ppem", last_ppem)?;
    info.set_item("glyphs_with_models", models)?;
    info.set_item("glyphs", font.glyph_count())?;
    info.set_item("table_bytes", font.table_len())?;
    info.set_item("bytes_per_glyph", font.table_len() as f64 / models.max(1) as f64)?;
    info.set_item("file_bytes", font.data().len())?;
    info.set_item("outlines_match", py.detach(|| font.outlines_match()))?;
    info.set_item("outlines_dropped", font.outlines_dropped())?;
    info.set_item("networks", networks.len())?;
    info.set_item("network_bytes", network_bytes)?;
    info.set_item("network_bits", network_bits.into_iter().map(u32::from).collect::<Vec<u32>>())?;
    info.set_item("certificate", certificate(py, &table)?)?;
    Ok(info)
}

/// Who taught the models, with which options, and how far each glyph is from its hints.
fn certificate<'py>(py: Python<'py>, table: &Table<'_>) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(certificate) = table.certificate() else { return Ok(None) };
    let glyphs = PyList::empty(py);
    for (gid, errors) in table.gids().zip(certificate.errors()) {
        let glyph = PyDict::new(py);
        glyph.set_item("gid", gid)?;
        glyph.set_item("mae", errors.mae.value())?;
        glyph.set_item("bad16", errors.bad16.value())?;
        glyph.set_item("max", errors.max)?;
        glyphs.append(glyph)?;
    }
    let dict = PyDict::new(py);
    dict.set_item("teacher", certificate.teacher)?;
    dict.set_item("converter", certificate.converter)?;
    dict.set_item("options", certificate.options)?;
    dict.set_item("is_exact", certificate.is_exact)?;
    dict.set_item("glyphs", glyphs)?;
    Ok(Some(dict))
}
