//! The conversion of one font.

use std::path::Path;
use std::sync::Arc;

use super::arguments::Args;
use super::dry_run;
use super::into::Existing;
use super::kept::tell_how_to_go_on;
use super::prepare::{Prepared, Subject, prepare};
use super::summary::{About, report, summary_text};
use crate::exactness::exceptions;
use crate::failure::Failure;
use crate::files::Output;
use crate::interrupt::{last_words, uninterrupted};
use crate::pace::Part;
use crate::progress::{Reporter, print_line};
use crate::source::Source;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::report::glyph_count_text;
use nfr_convert::partial::Partial;
use nfr_convert::ppem::PpemList;
use nfr_convert::{Conversion, Options, resume};

/// What is told of a conversion.
pub(super) struct Converted {
    /// For the file of `--report`.
    pub(super) report: String,
    /// For people.
    pub(super) summary: String,
}

/// Converts a font and writes it. None if it had all models already, or nothing was to be written.
pub(super) fn convert(args: &Args, source: &Source, path: &Path) -> Result<Option<Converted>, Failure> {
    let input = source.data.as_slice();
    let existing = args.into.as_ref().map(|path| Existing::open(path, input, source.index)).transpose()?;
    let subject = Subject::new(args, existing.as_ref())?;
    let prepared = prepare(args, source, &subject).map_err(|e| e.at(args.input.display()))?;
    let Prepared { options, reporter, added } = prepared;
    let output = Output::new(path)?;
    if args.dry_run {
        drop(reporter);
        dry_run::run(input, &options, &subject.ppem, existing.as_ref())?;
        return Ok(None);
    }
    if options.gids.is_empty() {
        let path = args.into.as_deref().unwrap_or(path).display();
        reporter.meter.note(&format!("{path} has models of all selected glyphs already"));
        output.write(&existing.map_or(Vec::new(), Existing::into_data))?;
        return Ok(None);
    }
    let partial = work_file(args, input, &options, &output, &reporter)?;
    tell_how_to_go_on(partial.clone(), output.partial());
    let converted = resume(input, &options, &reporter, partial.as_deref());
    let elapsed = reporter.meter.elapsed();
    let mut conversion = match converted {
        Ok(conversion) => conversion,
        Err(e) => {
            if !e.may_pass() {
                // What made it fail is told; that the file stays is worth no other error.
                drop(partial.as_deref().map(Partial::remove));
            }
            return Err(Failure::from(e).at(args.input.display()));
        }
    };
    // Fields are worth keeping for another try; what is kept of outlines is not.
    let give_up = |failure: Failure| {
        if let Some(partial) = partial.as_deref().filter(|partial| !partial.has_fields()) {
            drop(partial.remove());
        }
        Err(failure)
    };
    if let Err(failure) = check_strict(args, &conversion) {
        return give_up(failure);
    }
    if let Some(existing) = &existing {
        existing.merge(input, &options, &mut conversion)?;
    }
    // The figures are those of the finished file, not of the models in memory.
    let names = [&args.input, path].map(|path| path.display().to_string());
    let names = [names[0].as_str(), &names[1]];
    let pair = FontPair::open(input, source.index, &conversion.font)?;
    let pair = pair.watched_by(reporter.meter.watch(|| Part::Comparing));
    let mut gids = options.gids.clone();
    gids.retain(|gid| conversion.left_out.binary_search(gid).is_err());
    let comparison = pair.report(names, &gids, &subject.ppem, args.jobs)?;
    drop(reporter);
    let failures = args.fail_on.as_ref().map_or(Vec::new(), |conditions| conditions.failures(&comparison));
    if !failures.is_empty() {
        // Trained glyphs are kept: with another threshold --resume needs no training.
        return give_up(Failure::failed(format!("{}; no font is written", failures.join("; "))));
    }
    if options.fidelity.is_exact() && !args.quiet {
        warn_of_exceptions(&pair, names, &subject.ppem, &options)?;
    }
    {
        let _whole = uninterrupted();
        output.write(&conversion.font)?;
        partial.as_deref().map(Partial::remove).transpose()?;
        let path = path.display().to_string();
        last_words(move || format!("interrupted; {path} is written"));
    }
    let about = About {
        input: args.input.display().to_string(),
        output: path.display().to_string(),
        into: args.into.as_ref().map(|path| path.display().to_string()),
        index: source.index,
        instance: source.instance.clone(),
        target: subject.target.name(),
        hinter: subject.hinter,
        ppem: subject.ppem.to_string(),
        seed: args.seed,
    };
    let contents = report(about, input, &conversion, &comparison, elapsed.as_secs_f64());
    let json = serde_json::to_string_pretty(&contents).map_err(|e| Failure::failed(e.to_string()))?;
    Ok(Some(Converted { report: json + "\n", summary: summary_text(&contents, added) }))
}

/// Opens the work file of the conversion, and says what is in it.
fn work_file(
    args: &Args,
    input: &[u8],
    options: &Options,
    output: &Output,
    reporter: &Reporter,
) -> Result<Option<Arc<Partial>>, Failure> {
    let partial = output.partial();
    let partial = partial.map(|path| Partial::open(&path, input, options, args.resume)).transpose()?;
    if let Some(aside) = partial.as_ref().and_then(Partial::kept_aside) {
        reporter.meter.note(&format!(
            "the work file of another conversion to this output is kept as {}",
            aside.display()
        ));
    }
    if let Some(found) = partial.as_ref().map(Partial::found).filter(|found| *found > 0) {
        reporter.meter.note(&format!("going on after {}", glyph_count_text(found)));
    }
    Ok(partial.map(Arc::new))
}

fn check_strict(args: &Args, conversion: &Conversion) -> Result<(), Failure> {
    if !args.selection.strict || conversion.left_out.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format!(
        "{} cannot be converted, first of them glyph {}; leave out --strict to convert the rest",
        glyph_count_text(conversion.left_out.len()),
        conversion.left_out[0]
    )))
}

/// Warns of glyphs and sizes of a conversion of quality 100 that are not exact: those of `--ppem` and those that were learned.
fn warn_of_exceptions(
    pair: &FontPair<'_>,
    names: [&str; 2],
    ppem: &PpemList,
    options: &Options,
) -> Result<(), Failure> {
    let (first, last) = pair.font().ppem_range();
    let sizes = ppem.union(&PpemList::from(first..=last));
    let verification = pair.verify(names, &options.gids, &sizes, options.jobs)?;
    if let Some(line) = exceptions(&verification, (&(first..=last), options.ppem_step)) {
        print_line(&format!("warning: {line}"));
    }
    Ok(())
}
