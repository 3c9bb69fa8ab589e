//! The whole conversion.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use read_fonts::FontRef;

use super::assemble::{HintBytes, assemble, hint_bytes, outline_hash};
use super::compose::Plan;
use super::course::Course;
use super::open::{has_models, open};
use super::partial::Partial;
use super::polish::Polish;
use super::predict::Predictor;
use super::quality::Quality;
use super::start::{CELLS_TOLD, Capacity};
use super::teacher::{Teacher, TeacherAt};
use super::train::{Backend, Schedule};
use crate::compare::metrics::Sums;
use crate::error::Error;
use nfr::Target;
use nfr::internals::table::{Header, MAX_TRAINED_PPEM, Table};

use crate::writer::{self, GlyphModel};

/// What a conversion is asked to do.
#[derive(Debug, Clone)]
pub struct Options {
    /// The font's index in a collection file; 0 for a plain font.
    pub index: u32,
    /// The glyphs to convert, in ascending order.
    pub gids: Vec<u16>,
    /// The sizes of the models, in pixels per em, as far as the last that the teacher shows.
    pub ppem: RangeInclusive<u16>,
    /// From one size that the teacher shows to the next. What hinting does at the sizes between is predicted.
    pub ppem_step: u16,
    /// What the teacher hints for.
    pub target: Target,
    /// Seeds whatever the training draws at random.
    pub seed: u64,
    /// Threads. The result does not depend on it.
    pub jobs: usize,
    /// burn's backend.
    pub backend: Backend,
    /// How large a glyph's model may become.
    pub capacity: Capacity,
    /// How long and how fast to train.
    pub schedule: Schedule,
    /// How the trained weights are polished.
    pub polish: Polish,
    /// Whether glyphs are put together from others' models where their hints do the same.
    pub compose: bool,
    /// Whether the outlines of the glyphs that have models are left out of the font.
    pub drop_outlines: bool,
}

impl Default for Options {
    /// Sizes 8–64 for smooth rendering, one thread, no glyphs.
    fn default() -> Self {
        Self {
            index: 0,
            gids: Vec::new(),
            ppem: 8..=64,
            ppem_step: 1,
            target: Target::default(),
            seed: 1,
            jobs: 1,
            backend: Backend::default(),
            capacity: Capacity::default(),
            schedule: Schedule::default(),
            polish: Polish::default(),
            compose: true,
            drop_outlines: false,
        }
    }
}

impl Options {
    /// The same with another balance of error and bytes.
    pub fn with_quality(self, quality: Quality) -> Self {
        Self {
            capacity: quality.capacity(),
            schedule: Schedule { smoothness: quality.smoothness(), ..self.schedule },
            polish: quality.polish(),
            ..self
        }
    }

    /// Checks all that can be told without the font. A conversion begins with it.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first option that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        if self.gids.is_empty() {
            return wrong("no glyphs are selected".into());
        }
        if !self.gids.is_sorted_by(|a, b| a < b) {
            return wrong("the glyphs are not in ascending order".into());
        }
        let (first, last) = (*self.ppem.start(), *self.ppem.end());
        if first == 0 || first > last || last > MAX_TRAINED_PPEM {
            return wrong(format!("sizes {first}–{last} ppem; use a range within 1–{MAX_TRAINED_PPEM}"));
        }
        if self.ppem_step == 0 {
            return wrong("0 ppem from size to size; use 1 or more".into());
        }
        if self.jobs == 0 {
            return wrong("0 threads; use 1 or more".into());
        }
        self.capacity.check()?;
        self.schedule.check()?;
        self.polish.check()
    }
}

/// What a conversion tells while it runs; called from several threads.
pub trait Progress: Sync {
    /// So many glyphs will be ready in the end: those selected, and parts of them that need models too.
    fn planned(&self, glyphs: usize) {
        let _ = glyphs;
    }

    /// One glyph is ready: its error over all sizes (mae, 0..1).
    fn glyph_done(&self, gid: u16, mae: f64);

    /// Something in the font is not as it should be, and what was done about it.
    fn warn(&self, message: &str) {
        let _ = message;
    }
}

/// One converted glyph, for the report.
#[derive(Debug, Clone, PartialEq)]
pub struct GlyphReport {
    /// The glyph.
    pub gid: u16,
    /// Bytes of its model in the table, or of the list of its parts.
    pub bytes: usize,
    /// Whether it is put together from others' models.
    pub composed: bool,
    /// Mean absolute error against the teacher over all sizes, 0..1.
    pub mae: f64,
    /// Share of pixels off by more than 16/255.
    pub bad16: f64,
}

/// A finished conversion.
#[derive(Debug, Clone)]
pub struct Conversion {
    /// The new font file.
    pub font: Vec<u8>,
    /// A line for each glyph of the table, in order: those selected, and parts of them.
    pub glyphs: Vec<GlyphReport>,
    /// The sums over all selected glyphs and sizes.
    pub sums: Sums,
    /// The length of the `Nfrt` table.
    pub table_bytes: usize,
    /// The hint programs of the original, which the font does without.
    pub hint_bytes: HintBytes,
}

/// Converts a font: trains a model for each glyph and writes a font that carries them instead of hints.
///
/// # Errors
///
/// `Malformed` or `Unsupported` for a font that cannot teach, `MissingGlyph` for a glyph that it does not
/// have, `InvalidParameter` for options that make no sense.
pub fn convert(input: &[u8], options: &Options, progress: &dyn Progress) -> Result<Conversion, Error> {
    resume(input, options, progress, None)
}

/// Converts a font as [`convert`] does. Glyphs that are ready are kept in `partial`, and those that it holds
/// already are not trained again.
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
    let font = open(input, options.index)?;
    if has_models(&font) {
        return Err(Error::Unsupported(
            "the font already carries an 'Nfrt' table and has no hints left; convert the original font"
                .into(),
        ));
    }
    let teacher = Teacher::new(&font, options.target)?;
    let header = header(&font, options)?;
    let units = teacher.units_per_em();
    let scale = header.scale(units).ok_or_else(|| {
        Error::InvalidParameter(format!(
            "{}–{} ppem of {units} units per em; 1–{MAX_TRAINED_PPEM} and 16–16384 are allowed",
            header.first_ppem, header.last_ppem
        ))
    })?;
    let shown = options.ppem.clone().step_by(options.ppem_step.into());
    let sizes = shown.map(|ppem| teacher.at(ppem)).collect::<Result<Vec<_>, _>>()?;
    warn_of_unhinted(&sizes, progress)?;
    let mut plan = if options.compose {
        Plan::find(&font, &teacher, &sizes, scale, &options.gids)?
    } else {
        Plan::of_models(&options.gids)
    };
    progress.planned(plan.models.len() + plan.composed.len());
    let predictor = Predictor::new(&teacher, &sizes, scale, &plan.models)?;
    plan.complete(&predictor, scale);
    let course =
        Course { teacher: &teacher, sizes: &sizes, scale, predictor: &predictor, options, progress, partial };
    let trained = course.train_all(&plan.models)?;
    let mut judged: BTreeMap<u16, Sums> = trained.iter().map(|t| (t.gid, t.sums)).collect();
    let models: Vec<GlyphModel> =
        trained.into_iter().map(|t| GlyphModel { gid: t.gid, weights: t.weights }).collect();
    judged.extend(course.judge_composed(&models, &plan.composed)?);
    let (table, _) = writer::write(&header, &models, &plan.composed, &[], scale)?;
    let mut sums = Sums::default();
    for gid in &options.gids {
        sums.merge(judged.get(gid).ok_or(Error::MissingGlyph(*gid))?);
    }
    let dropped = if options.drop_outlines { judged.keys().copied().collect() } else { BTreeSet::new() };
    Ok(Conversion {
        font: assemble(&font, &table, &dropped)?,
        hint_bytes: hint_bytes(&font)?,
        glyphs: reports(&Table::parse(&table)?, &judged)?,
        sums,
        table_bytes: table.len(),
    })
}

fn reports(table: &Table<'_>, judged: &BTreeMap<u16, Sums>) -> Result<Vec<GlyphReport>, Error> {
    let report = |(&gid, sums): (&u16, &Sums)| {
        let (figures, composed) = (sums.figures(), table.is_composed(gid.into()));
        let bytes = table.model_len(gid.into())?;
        Ok(GlyphReport { gid, bytes, composed, mae: figures.mae, bad16: figures.bad16 })
    };
    judged.iter().map(report).collect()
}

/// Tells at which sizes the font switches its hints off. A font that does so at all of them teaches nothing.
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
            "the font's 'prep' program switches hinting off at {} ppem; the plain outlines are learnt there",
            off.join(", ")
        ));
    }
    Ok(())
}

fn header(font: &FontRef<'_>, options: &Options) -> Result<Header, Error> {
    let (first, last) = options.ppem.clone().into_inner();
    Ok(Header {
        target: options.target,
        first_ppem: first,
        last_ppem: last - (last - first) % options.ppem_step,
        outline_hash: outline_hash(font)?,
        outlines_dropped: options.drop_outlines,
        seed: options.seed,
        steps: options.schedule.steps as u16,
        knots: options.capacity.knots as u8,
        rank: options.capacity.rank as u8,
        cell: (options.capacity.cell * CELLS_TOLD).round() as u16,
    })
}
