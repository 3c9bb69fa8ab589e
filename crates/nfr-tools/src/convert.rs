//! `nfr-convert`: from a hinted font to a neural one.

mod dry_run;
mod into;
mod kept;
mod summary;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Parser;

use super::args::{SelectionArgs, all_cores, jobs, shape, target};
use super::exactness::exceptions;
use super::failure::Failure;
use super::files::{Output, read, same_file};
use super::help::help_template;
use super::interrupt::{last_words, uninterrupted};
use super::pace::Part;
use super::progress::{Reporter, Verbosity, print_line};
use into::Existing;
use kept::tell_how_to_go_on;
use nfr::Target;
use nfr_convert::closure::{LayoutFeatures, close};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::report::glyph_count_text;
use nfr_convert::compare::threshold::FailOn;
use nfr_convert::open::{has_models, open};
use nfr_convert::options::Backend;
use nfr_convert::partial::Partial;
use nfr_convert::ppem::PpemList;
use nfr_convert::select::{glyph_count, glyph_names};
use nfr_convert::teacher::Teacher;
use nfr_convert::{Options, Quality, Shape, resume};
use summary::{About, print_summary, summary};

/// Learns a font's hinted bitmaps, glyph by glyph, and writes a font that carries the models instead of hint
/// programs
#[derive(Debug, Parser)]
#[command(name = "nfr-convert", version, help_template = help_template!(
    "nfr-convert in.ttf out.ttf --unicodes U+20-7E",
    "nfr-convert in.ttf sizes.ttf --text 'Hello, world' --ppem 10-20 --report report.json"
))]
pub struct Args {
    /// A hinted TrueType font
    input: PathBuf,
    /// The neural font to write
    output: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// The features of GSUB whose glyphs are converted with those that they stand for: tags, as in default,smcp,onum, or * or none
    ///
    /// "default" are those that pyftsubset keeps by default: what shapers apply without being asked, and a few more.
    #[arg(long, value_name = "LIST", default_value = "default")]
    layout_features: LayoutFeatures,
    /// Convert only the glyphs that are named, without what layout and composites need, .notdef and the space
    #[arg(long)]
    no_closure: bool,
    /// The sizes to learn, in pixels per em: a range, which may have a step, as in 8-64:2 [default: 8-64, or those of --into]
    ///
    /// With --train-ppem, the sizes that the figures are about.
    #[arg(long, value_name = "SIZES")]
    ppem: Option<PpemList>,
    /// Learn these sizes instead of those of --ppem; what hinting does at the sizes between is predicted from
    /// them
    #[arg(long, value_name = "SIZES")]
    train_ppem: Option<PpemList>,
    /// What to hint for: smooth, mono or lcd [default: smooth, or that of --into]
    #[arg(long, value_name = "TARGET", value_parser = target)]
    target: Option<Target>,
    /// Where models have their shapes from: outline (the font's own), field (their own), or auto, which is outline unless the
    /// outlines are dropped; fields need a build with --features train
    #[arg(long, value_name = "SHAPE", default_value = "auto", value_parser = shape)]
    shape: Shape,
    /// How much error is worth how many bytes: 0 for the smallest file, 100 for the least error
    ///
    /// With outlines, 100 is exact: every point is where the hints put it. A warning says for which glyphs and sizes it is not, and
    /// nfr verify tells more.
    #[arg(long, value_name = "0-100", default_value = "50", value_parser = quality)]
    quality: Quality,
    /// The seed of whatever is drawn at random; the same seed gives the same font
    #[arg(long, value_name = "N", default_value_t = Options::default().seed)]
    seed: u64,
    /// Threads; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = all_cores(), value_parser = jobs)]
    jobs: usize,
    /// burn's backend for training fields: flex, or ndarray where that is built in
    #[arg(long, value_name = "NAME", default_value = "flex", value_parser = backend)]
    backend: Backend,
    /// The font's index, if the input is a collection
    #[arg(long, value_name = "N", default_value_t = 0)]
    index: u32,
    /// Leave out the outlines of the glyphs that get models, for programs that draw only with those
    ///
    /// Metrics, characters and layout stay. Everything else draws these glyphs as blanks. Their models are fields.
    #[arg(long)]
    drop_outlines: bool,
    /// Add what is missing to the models of a neural font that was made from the same input
    ///
    /// The output has all of its models, byte for byte what they draw, and those of the selected glyphs that it lacks. The sizes and the
    /// target are its own. The output may be this font itself.
    #[arg(long, value_name = "NEURAL")]
    into: Option<PathBuf>,
    /// Go on where an interrupted conversion to the same output stopped
    ///
    /// While it runs, a conversion keeps the glyphs that are ready in OUTPUT.partial. If it is interrupted, the
    /// same command with --resume trains only the others, and the font comes out the same. The input, the options
    /// and the version have to be the same, but --jobs and --drop-outlines may change. The file is deleted in the
    /// end.
    #[arg(long)]
    resume: bool,
    /// Write nothing, and tell how long the conversion will take and how large the font will be
    ///
    /// A sample of the glyphs is converted and compared, with these options, and the rest is estimated from it.
    #[arg(long)]
    dry_run: bool,
    /// Write no font, and exit with 1, if any condition holds, as in 'mae>0.0001 || bad16>0.001'
    ///
    /// As for nfr diff, on the figures of all glyphs at the sizes of --ppem.
    #[arg(long, value_name = "EXPR")]
    fail_on: Option<FailOn>,
    /// Write a report as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "verbose")]
    quiet: bool,
    /// Print a line for each glyph
    #[arg(long, short)]
    verbose: bool,
}

fn backend(name: &str) -> Result<Backend, String> {
    match name {
        "flex" => Ok(Backend::Flex),
        #[cfg(feature = "ndarray")]
        "ndarray" => Ok(Backend::Ndarray),
        #[cfg(not(feature = "ndarray"))]
        "ndarray" => Err("this program is built without it; build it with --features ndarray".into()),
        _ => Err("use flex or ndarray".into()),
    }
}

fn quality(text: &str) -> Result<Quality, String> {
    text.parse().ok().and_then(Quality::new).ok_or_else(|| "write a number from 0 to 100".into())
}

/// Runs `nfr-convert`.
///
/// # Errors
///
/// Wrong usage, an input that cannot teach, an output that cannot be written. An existing output is then as
/// it was.
pub fn run(args: &Args) -> Result<(), Failure> {
    check_paths(args)?;
    let input = read(&args.input)?;
    let existing = args.into.as_ref().map(|path| Existing::open(path, &input, args.index)).transpose()?;
    let subject = Subject::new(args, existing.as_ref())?;
    let prepared = prepare(args, &input, &subject).map_err(|e| e.at(args.input.display()))?;
    let Prepared { options, reporter, added } = prepared;
    let output = Output::new(&args.output)?;
    let report = args.report.as_deref().map(Output::new).transpose()?;
    if args.dry_run {
        drop(reporter);
        return dry_run::run(&input, &options, &subject.ppem, existing.as_ref());
    }
    if options.gids.is_empty() {
        let path = args.into.as_deref().unwrap_or(&args.output).display();
        reporter.meter.note(&format!("{path} has models of all selected glyphs already"));
        return output.write(&existing.map_or(Vec::new(), Existing::into_data));
    }

    let partial = output.partial();
    let partial = partial.map(|path| Partial::open(&path, &input, &options, args.resume)).transpose()?;
    let partial = partial.map(Arc::new);
    tell_how_to_go_on(partial.clone(), output.partial());
    if let Some(aside) = partial.as_deref().and_then(Partial::kept_aside) {
        reporter.meter.note(&format!(
            "the work file of another conversion to this output is kept as {}",
            aside.display()
        ));
    }
    if let Some(found) = partial.as_deref().map(Partial::found).filter(|found| *found > 0) {
        reporter.meter.note(&format!("going on after {}", glyph_count_text(found)));
    }

    let converted = resume(&input, &options, &reporter, partial.as_deref());
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
    let give_up = |message: String| {
        if let Some(partial) = partial.as_deref().filter(|partial| !partial.has_fields()) {
            drop(partial.remove());
        }
        Err(Failure::failed(message))
    };
    if args.selection.strict && !conversion.left_out.is_empty() {
        return give_up(format!(
            "{} cannot be converted, first of them glyph {}; leave out --strict to convert the rest",
            glyph_count_text(conversion.left_out.len()),
            conversion.left_out[0]
        ));
    }
    if let Some(existing) = &existing {
        existing.merge(&input, &options, &mut conversion)?;
    }
    // The figures are those of the finished file, not of the models in memory.
    let names = [&args.input, &args.output].map(|path| path.display().to_string());
    let names = [names[0].as_str(), &names[1]];
    let pair = FontPair::open(&input, args.index, &conversion.font)?;
    let pair = pair.watched_by(reporter.meter.watch(|| Part::Comparing));
    let mut gids = options.gids.clone();
    gids.retain(|gid| conversion.left_out.binary_search(gid).is_err());
    let comparison = pair.report(names, &gids, &subject.ppem, args.jobs)?;
    drop(reporter);
    let failures = args.fail_on.as_ref().map_or(Vec::new(), |conditions| conditions.failures(&comparison));
    if !failures.is_empty() {
        // Trained glyphs are kept: with another threshold --resume needs no training.
        return give_up(format!("{}; no font is written", failures.join("; ")));
    }
    if options.fidelity.is_exact() && !args.quiet {
        warn_of_exceptions(&pair, names, &subject.ppem, &options)?;
    }
    let about = About {
        input: args.input.display().to_string(),
        output: args.output.display().to_string(),
        into: args.into.as_ref().map(|path| path.display().to_string()),
        target: subject.target.name(),
        ppem: subject.ppem.to_string(),
        seed: args.seed,
    };
    let contents = summary(about, &input, &conversion, &comparison, elapsed.as_secs_f64());
    let json = serde_json::to_string_pretty(&contents).map_err(|e| Failure::failed(e.to_string()))?;
    {
        let _whole = uninterrupted();
        output.write(&conversion.font)?;
        partial.as_deref().map(Partial::remove).transpose()?;
        if let Some(file) = report {
            file.write((json + "\n").as_bytes())?;
        }
        let path = args.output.display().to_string();
        last_words(move || format!("interrupted; {path} is written"));
    }
    if args.quiet { Ok(()) } else { print_summary(&contents, added) }
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

/// Refuses to write over what is read.
fn check_paths(args: &Args) -> Result<(), Failure> {
    let refuse_same = |a: &Path, b: &Path, what: &str| {
        if same_file(a, b) { Err(Failure::usage(format!("{what}; write to another file"))) } else { Ok(()) }
    };
    refuse_same(&args.input, &args.output, "the output is the input")?;
    if let Some(report) = &args.report {
        refuse_same(&args.input, report, "the report is the input")?;
        refuse_same(&args.output, report, "the report is the output")?;
    }
    Ok(())
}

/// What is learnt, for which sizes and which target.
struct Subject<'a> {
    existing: Option<&'a Existing>,
    /// The sizes that the figures are about.
    ppem: PpemList,
    /// The sizes to learn, and the step between them.
    learnt: (RangeInclusive<u16>, u16),
    target: Target,
}

impl<'a> Subject<'a> {
    fn new(args: &Args, existing: Option<&'a Existing>) -> Result<Self, Failure> {
        let default = || existing.map_or_else(|| PpemList::from(8..=64), |existing| existing.ppem.clone());
        let ppem = args.ppem.clone().unwrap_or_else(default);
        let target = args.target.or(existing.map(|existing| existing.target)).unwrap_or_default();
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
            existing.check(&PpemList::from(learnt.0.clone()), target, args.drop_outlines)?;
        }
        Ok(Self { existing, ppem, learnt, target })
    }
}

/// What is known before the training.
struct Prepared {
    options: Options,
    reporter: Reporter,
    /// The glyphs that were not named: those that layout and composites need, .notdef and the space.
    added: usize,
}

/// Checks all that can be known before the training.
fn prepare(args: &Args, input: &[u8], subject: &Subject<'_>) -> Result<Prepared, Failure> {
    let (ppem, ppem_step) = subject.learnt.clone();
    let font = open(input, args.index)?;
    if has_models(&font) {
        return Err(Failure::failed(
            "the font carries an 'Nfrt' table already; convert the hinted font that it was made from",
        ));
    }
    let teacher = Teacher::new(&font, subject.target)?;
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
        index: args.index,
        gids,
        ppem,
        ppem_step,
        target: subject.target,
        seed: args.seed,
        jobs: args.jobs,
        backend: args.backend,
        shape: subject.existing.map_or(args.shape, |existing| existing.shape(args.shape)),
        drop_outlines: args.drop_outlines,
        ..Options::default().with_quality(args.quality)
    };
    Ok(Prepared { options, reporter, added })
}
