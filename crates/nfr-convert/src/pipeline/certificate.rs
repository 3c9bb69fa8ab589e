//! The certificate of a conversion: its teacher, its options, and the error of each glyph.

use std::collections::{BTreeMap, BTreeSet};

use nfr::internals::table::{Certificate, Table};
use read_fonts::FontRef;

use super::glyphs::Measured;
use crate::assemble::assemble;
use crate::compare::fonts::FontPair;
use crate::error::Error;
use crate::options::{Hinter, Options, Shape};
use crate::ppem::PpemList;
use crate::writer::write_certificate;

/// The engine that runs the hints. A test compares the version with that of the manifest.
const TEACHER: &str = "skrifa 0.49";
const CONVERTER: &str = concat!("nfr-convert ", env!("CARGO_PKG_VERSION"));

/// Appends the certificate to a table. `font` is the original, or its TrueType copy.
pub(super) fn certify(
    original: &FontRef<'_>,
    font: &FontRef<'_>,
    table: &mut Vec<u8>,
    measured: &BTreeMap<u16, Measured>,
    options: &Options,
) -> Result<(), Error> {
    let is_exact = is_exact([original, font], table, options)?;
    let teacher = options.hinter.teacher(TEACHER);
    let options = arguments(options);
    let errors = Table::parse(table)?.gids().map(|gid| {
        let measured = measured.get(&gid).ok_or(Error::MissingGlyph(gid))?;
        Ok(measured.all.certified())
    });
    let errors = errors.collect::<Result<Vec<_>, Error>>()?;
    write_certificate(table, &Certificate::new(is_exact, &teacher, CONVERTER, &options), errors);
    Ok(())
}

/// Whether all hinted points are the teacher's at all sizes. They are compared where that was asked for and can be.
fn is_exact([original, font]: [&FontRef<'_>; 2], table: &[u8], options: &Options) -> Result<bool, Error> {
    if !options.fidelity.is_exact() || !options.uses_outlines() || options.ppem_step != 1 {
        return Ok(false);
    }
    let (data, index) = (original.data().as_bytes(), original.ttc_index().unwrap_or(0));
    let neural = assemble(font, table, &BTreeSet::new())?;
    let pair = FontPair::open_taught(data, index, &neural, options.hinter)?;
    let gids: Vec<u16> = Table::parse(table)?.gids().collect();
    let verification = pair.verify(["", ""], &gids, &PpemList::from(options.ppem.clone()), options.jobs)?;
    Ok(verification.failures(0).is_empty())
}

/// The options that shape the models, as arguments of `nfr-convert`.
fn arguments(options: &Options) -> String {
    let (first, last) = options.ppem.clone().into_inner();
    let sizes = match options.ppem_step {
        1 => format!("--ppem {first}-{last}"),
        step => format!("--train-ppem {first}-{last}:{step}"),
    };
    let shape = match options.shape {
        Shape::Auto => "auto",
        Shape::Outline => "outline",
        Shape::Field => "field",
    };
    let quality = options.fidelity.quality();
    format!(
        "{sizes} --target {}{} --shape {shape} --quality {quality} --seed {}{}",
        options.target.name(),
        if options.hinter == Hinter::Auto { " --hinter auto" } else { "" },
        options.seed,
        if options.drop_outlines { " --drop-outlines" } else { "" }
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::options::Quality;

    /// The manifest that names skrifa's version: that of the workspace, or in a package its own.
    fn manifest() -> String {
        let own = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        let of_workspace = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.toml");
        let manifests = [own, of_workspace].map(|path| std::fs::read_to_string(path).unwrap_or_default());
        let names_version = |text: &String| !text.contains("skrifa.workspace = true") && !text.is_empty();
        manifests.into_iter().find(names_version).unwrap()
    }

    #[test]
    fn the_teacher_has_the_version_that_the_manifest_asks_for() {
        let manifest = manifest();
        let (_, after) = manifest.split_once("skrifa").unwrap();
        let (_, version) = TEACHER.split_once(' ').unwrap();
        assert_eq!(after.split('"').nth(1), Some(version));
    }

    #[test]
    fn arguments_are_those_that_the_options_stand_for() {
        let options = Options { ppem: 9..=30, ..Options::default() };
        assert_eq!(arguments(&options), "--ppem 9-30 --target smooth --shape auto --quality 50 --seed 1");
        for quality in [0.0, 12.5, 75.0, 100.0] {
            let options = Options { ppem_step: 2, drop_outlines: true, ..Options::default() }
                .with_quality(Quality::new(quality).unwrap());
            let expected = format!(
                "--train-ppem 8-64:2 --target smooth --shape auto --quality {quality} --seed 1 --drop-outlines"
            );
            assert_eq!(arguments(&options), expected);
        }
    }
}
