//! What a conversion is asked to do, and all that can be checked before it.

use std::ops::RangeInclusive;

use super::arguments::Args;
use super::into::Existing;
use crate::failure::Failure;
use crate::progress::{Reporter, Verbosity, print_line};
use crate::source::Source;
use nfr::Target;
use nfr_convert::closure::close;
use nfr_convert::open::{has_models, open};
use nfr_convert::ppem::PpemList;
use nfr_convert::select::{glyph_count, glyph_names};
use nfr_convert::teacher::Teacher;
use nfr_convert::{Hinter, Options};

/// What is learnt, for which sizes and which target.
pub(super) struct Subject<'a> {
    existing: Option<&'a Existing>,
    /// The sizes that the figures are about.
    pub(super) ppem: PpemList,
    /// The sizes to learn, and the step between them.
    learnt: (RangeInclusive<u16>, u16),
    pub(super) target: Target,
    pub(super) hinter: Hinter,
}

impl<'a> Subject<'a> {
    pub(super) fn new(args: &Args, existing: Option<&'a Existing>) -> Result<Self, Failure> {
        let default = || existing.map_or_else(|| PpemList::from(8..=64), |existing| existing.ppem.clone());
        let ppem = args.ppem.clone().unwrap_or_else(default);
        let target = args.target.or(existing.map(|existing| existing.target)).unwrap_or_default();
        let hinter = args.hinter.or(existing.map(|existing| existing.hinter)).unwrap_or_default();
        let (option, list) = match &args.train_ppem {
            Some(list) => ("--train-ppem", list),
            None => ("--ppem", &ppem),
        };
        let learnt = list.evenly_spaced().ok_or_else(|| {
            Failure::usage(format!(
                "{option} {list} is uneven; training takes one range with one step, as in 8-64 or 8-64:2"
            ))
        })?;
        if let Some(existing) = existing {
            existing.check(&PpemList::from(learnt.0.clone()), target, hinter, args.drop_outlines)?;
        }
        Ok(Self { existing, ppem, learnt, target, hinter })
    }
}

/// What is known before the training.
pub(super) struct Prepared {
    pub(super) options: Options,
    pub(super) reporter: Reporter,
    /// The glyphs that were not named: those that layout and composites need, .notdef and the space.
    pub(super) added: usize,
}

/// Checks all that can be known before the training.
pub(super) fn prepare(args: &Args, source: &Source, subject: &Subject<'_>) -> Result<Prepared, Failure> {
    let (ppem, ppem_step) = subject.learnt.clone();
    let font = open(&source.data, source.index)?;
    if has_models(&font) {
        return Err(Failure::failed(
            "the font carries an 'Nfrt' table already; convert the hinted font that it was made from",
        ));
    }
    let teacher = Teacher::with_hinter(&font, subject.target, subject.hinter)?;
    for size in subject.ppem.sizes().iter().copied().chain(ppem.clone().step_by(ppem_step.into())) {
        teacher.at(size)?;
    }
    let warn = |line: &str| {
        if !args.quiet {
            print_line(line);
        }
    };
    let all = 0..=u16::try_from(glyph_count(&font)?.saturating_sub(1)).unwrap_or(u16::MAX);
    let named = args.selection.resolve(&font, all, warn)?;
    let gids = if args.selection.is_empty() || args.no_closure {
        named.clone()
    } else {
        let shaped = args.selection.shaped_glyphs(&font)?;
        close(&font, &[named.clone(), shaped].concat(), &args.layout_features)?
    };
    let gids = subject.existing.map_or_else(|| gids.clone(), |existing| existing.missing(&gids));
    let added = gids.iter().filter(|gid| named.binary_search(gid).is_err()).count();
    let verbosity = match (args.quiet, args.verbose) {
        (true, _) => Verbosity::Quiet,
        (_, true) => Verbosity::Verbose,
        _ => Verbosity::Normal,
    };
    let reporter = Reporter::new(verbosity, gids.len(), glyph_names(&font)?);
    let options = Options {
        index: source.index,
        gids,
        ppem,
        ppem_step,
        target: subject.target,
        hinter: subject.hinter,
        seed: args.seed,
        jobs: args.jobs,
        backend: args.backend,
        shape: subject.existing.map_or(args.shape, |existing| existing.shape(args.shape)),
        drop_outlines: args.drop_outlines,
        ..Options::default().with_quality(args.quality)
    };
    Ok(Prepared { options, reporter, added })
}
