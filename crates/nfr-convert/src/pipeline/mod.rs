//! The whole conversion: from a hinted font file to one with models.

mod assembled;
mod certificate;
mod dropout;
mod fields;
mod glyphs;
mod kept;
mod outlines;
mod readable;
mod training;
mod warnings;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use read_fonts::{FontRef, TableProvider};

use crate::assemble::{assemble, hint_bytes, outline_hash};
use crate::compare::metrics::Sums;
use crate::compose::Decomposition;
use crate::conversion::{Conversion, GlyphReport, Progress, Stage};
use crate::error::Error;
use crate::input::open::{check_metrics, has_models, open};
use crate::input::select::glyph_count;
use crate::options::{CELL_UNITS_PER_EM, Options};
use crate::partial::{Kind, Partial};
use crate::predict::Predictor;
use crate::teacher::{Teacher, TeacherAt};
use assembled::warn_of_assembled;
use certificate::certify;
use dropout::add_dropout;
use glyphs::{Measured, Stages};
use kept::Kept;
use nfr::Target;
use nfr::internals::model::gridfit::MAX_TRAINED_PPEM;
use nfr::internals::table::{Header, Table};
use outlines::Learned;
use readable::readable;
use warnings::{glyphs_text, warn_of_bitmaps, warn_of_uncertain};

/// Converts a font: finds or trains a model for each glyph and writes a font that carries them instead of hints.
///
/// # Errors
///
/// `Malformed` or `Unsupported` for a font that cannot be converted, `NoSuchGlyph` for a glyph that it does not have,
/// `InvalidParameter` for options that make no sense, `TrainingNotBuilt` for those that ask for fields, in a build without the
/// feature `train`.
pub fn convert(input: &[u8], options: &Options, progress: &dyn Progress) -> Result<Conversion, Error> {
    resume(input, options, progress, None)
}

/// Converts a font as [`convert`] does. Trained glyphs are appended to the work file `partial`, and those that it
/// holds already are not trained again.
///
/// # Errors
///
/// As [`convert`], and `Io` if the work file cannot be written.
pub fn resume(
    input: &[u8],
    options: &Options,
    progress: &dyn Progress,
    partial: Option<&Partial>,
) -> Result<Conversion, Error> {
    options.check()?;
    let original = open(input, options.index)?;
    if has_models(&original) {
        return Err(Error::Unsupported(
            "the font already carries an 'Nfrt' table and has no hints left; convert the original font"
                .into(),
        ));
    }
    check_metrics(&original)?;
    warn_of_bitmaps(&original, progress);
    let teacher = Teacher::with_hinter(&original, options.target, options.hinter)?;
    let font = teacher.true_type(&original)?;
    if teacher.is_postscript() && original.fvar().is_ok() {
        progress.warn("the font is variable; its default instance is converted");
    }
    let header = header(&font, &teacher, options)?;
    let units = teacher.units_per_em();
    let scale = header.scale(units).ok_or_else(|| {
        Error::InvalidParameter(format!(
            "{}–{} ppem of {units} units per em; 1–{MAX_TRAINED_PPEM} and 16–16384 are allowed; choose other sizes with --ppem",
            header.first_ppem, header.last_ppem
        ))
    })?;
    let known_ppem = options.ppem.clone().step_by(options.ppem_step.into());
    let sizes = known_ppem.map(|ppem| teacher.at(ppem)).collect::<Result<Vec<_>, _>>()?;
    warn_of_unhinted(&sizes, progress)?;
    let is_between = |ppem: &u16| !(ppem - header.first_ppem).is_multiple_of(options.ppem_step);
    let between = (header.first_ppem..=header.last_ppem).filter(is_between).map(|ppem| teacher.at(ppem));
    let between = between.collect::<Result<Vec<_>, _>>()?;
    warn_of_uncertain(&teacher, &options.gids, progress);
    announce(options, partial, progress);
    let (gids, unreadable) = readable(&[&sizes, &between], options, progress)?;
    let options = &Options { gids, ..options.clone() };
    warn_of_assembled(&teacher, options, progress)?;
    let mut glyphs = if options.compose {
        let exact = options.uses_outlines() && options.fidelity.is_exact();
        Decomposition::find(&font, &teacher, &sizes, scale, &options.gids, exact)?
    } else {
        Decomposition::without_composition(&options.gids)
    };
    progress.planned(glyphs.modelled.len() + glyphs.composed.len());
    let predictor = Predictor::new(&teacher, &sizes, scale, &glyphs.modelled)?;
    glyphs.predict_part_offsets(&predictor, scale);
    let failures = Mutex::default();
    let conversion = Stages {
        teacher: &teacher,
        sizes: &sizes,
        between: &between,
        scale,
        predictor: &predictor,
        options,
        progress,
        failures: &failures,
    };
    let (mut table, measured, mut left_out) = if options.uses_outlines() {
        let Learned { table, measured, left_out } =
            outlines::learn(conversion, &font, partial, &header, &glyphs)?;
        (table, measured, left_out)
    } else {
        let (table, measured) = fields::table(conversion, partial, &header, &glyphs)?;
        (table, measured, Vec::new())
    };
    if left_out.len() == options.gids.len() {
        return Err(Error::Unsupported(format!(
            "hinting changes the contours of all selected glyphs, not only the positions of their points; {}",
            training::ADVICE
        )));
    }
    let mut sums = Sums::default();
    for gid in options.gids.iter().filter(|gid| left_out.binary_search(gid).is_err()) {
        sums.merge(&measured.get(gid).ok_or(Error::MissingGlyph(*gid))?.learnt);
    }
    certify(&original, &font, &mut table, &measured, options)?;
    if options.target == Target::Mono {
        add_dropout(&mut table, &measured);
    }
    warn_of_worse(&measured, progress);
    left_out.extend(unreadable);
    left_out.sort_unstable();
    let dropped = if options.drop_outlines { measured.keys().copied().collect() } else { BTreeSet::new() };
    let converted = assemble(&font, &table, &dropped)?;
    // Damage of other tables can keep the font from opening.
    nfr::Font::new(converted.clone())?;
    Ok(Conversion {
        font: converted,
        hint_bytes: hint_bytes(&font)?,
        glyphs: reports(&Table::parse(&table)?, &measured)?,
        sums,
        table_bytes: table.len(),
        left_out,
    })
}

/// Tells how much work there is, as far as that is known before glyphs are drawn.
fn announce(options: &Options, partial: Option<&Partial>, progress: &dyn Progress) {
    let lacks = |kind| Kept(partial).lacks(kind, options.gids.iter().copied());
    let reading = (Stage::Reading, options.gids.len());
    if options.uses_outlines() {
        progress.work(&[
            reading,
            (Stage::Fitting, lacks(Kind::Fit)),
            (Stage::Encoding, lacks(Kind::Encoding)),
            (Stage::Measuring, lacks(Kind::Measurement)),
        ]);
    } else {
        progress.work(&[reading, (Stage::Training, lacks(Kind::Field))]);
    }
}

fn reports(table: &Table<'_>, measured: &BTreeMap<u16, Measured>) -> Result<Vec<GlyphReport>, Error> {
    let report = |(&gid, measured): (&u16, &Measured)| {
        let (figures, composed) = (measured.learnt.figures(), table.is_composed(gid.into()));
        let bytes = table.model_len(gid.into())?;
        Ok(GlyphReport { gid, bytes, composed, mae: figures.mae, bad16: figures.bad16 })
    };
    measured.iter().map(report).collect()
}

/// Warns of the glyphs whose models have a visibly larger error than their unhinted outlines.
fn warn_of_worse(measured: &BTreeMap<u16, Measured>, progress: &dyn Progress) {
    let worse: Vec<u16> =
        measured.iter().filter(|(_, m)| m.is_worse_than_unhinted).map(|(gid, _)| *gid).collect();
    if !worse.is_empty() {
        progress.warn(&format!(
            "the models of {} are farther from the hinted bitmaps than the unhinted outlines",
            glyphs_text(&worse)
        ));
    }
}

/// Warns of the sizes at which the font switches its hints off. A font that does so at all of them is refused.
fn warn_of_unhinted(sizes: &[TeacherAt], progress: &dyn Progress) -> Result<(), Error> {
    let off: Vec<String> =
        sizes.iter().filter(|at| !at.is_hinted()).map(|at| at.ppem().to_string()).collect();
    if off.len() == sizes.len() {
        return Err(Error::Unsupported(
            "the font's 'prep' program switches hinting off at all of these sizes; choose others with --ppem"
                .into(),
        ));
    }
    if !off.is_empty() {
        progress.warn(&format!(
            "the font's 'prep' program switches hinting off at {} ppem; the unhinted outlines are learnt there",
            off.join(", ")
        ));
    }
    Ok(())
}

fn header(font: &FontRef<'_>, teacher: &Teacher, options: &Options) -> Result<Header, Error> {
    let (first, last) = options.ppem.clone().into_inner();
    Ok(Header {
        target: options.target,
        first_ppem: first,
        last_ppem: last - (last - first) % options.ppem_step,
        outline_hash: outline_hash(font)?,
        outlines_dropped: options.drop_outlines,
        origin: teacher.origin(),
        seed: options.seed,
        steps: options.schedule.steps as u16,
        knots: options.capacity.knots as u8,
        rank: options.capacity.rank as u8,
        cell: (options.capacity.cell * CELL_UNITS_PER_EM).round() as u16,
        glyph_count: glyph_count(font)?.try_into().unwrap_or(0),
    })
}
