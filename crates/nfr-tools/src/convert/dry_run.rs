//! `nfr-convert --dry-run`: time and bytes of a conversion, estimated from that of a sample of its glyphs.

use std::collections::HashMap;
use std::io::{self, Write};
use std::time::Instant;

use read_fonts::TableProvider;
use read_fonts::tables::glyf::{Glyf, Glyph};
use read_fonts::tables::loca::Loca;
use read_fonts::types::GlyphId;

use super::into::Existing;
use crate::failure::Failure;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::report::glyph_count_text;
use nfr_convert::open::open;
use nfr_convert::ppem::PpemList;
use nfr_convert::{Conversion, Error, Options, Progress, convert};

/// The glyphs that are converted first, to see how long they take. Not fewer, as setting the sizes up takes longer than they do.
const FIRST_SAMPLE: usize = 8;
/// The most time that the second sample may take, as a share of what the first one lets expect of all glyphs, or in seconds.
const LARGEST_SHARE: f64 = 0.05;
const LEAST_SECONDS: f64 = 0.8;
/// The fewest and the most glyphs of the second sample. Fewer share too few of their tracks to tell how many bytes all take; fields
/// share nothing, and each takes long.
const OUTLINES: std::ops::RangeInclusive<usize> = 48..=512;
const FIELDS: std::ops::RangeInclusive<usize> = 10..=64;

/// The bytes of a glyph get fewer by this factor whenever there are twice as many glyphs, as more of their tracks are shared. From a
/// twentieth of the glyphs to all it is 0.87 in DejaVu Sans, 0.92 in Carlito, 0.94 in Liberation Sans and Serif and IPA Gothic, and
/// 0.97 in Lohit Devanagari.
const SHARING: f64 = 0.91;

/// Glyphs that are put together from others are drawn and compared, but have no model to find: a rough share of the time.
const OF_COMPOSED: f64 = 0.4;

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// A glyph, and what tells how much work it is.
struct Subject {
    gid: u16,
    is_composite: bool,
    points: usize,
}

impl Subject {
    /// The time that the glyph takes, as a multiple of that of a blank one, if its model is not put together from others: hints, and
    /// curves, take as long as there are points, and each of the tracks that are tried is compared at all points.
    fn work(&self) -> f64 {
        const SQUARE: f64 = 50.0;
        let points = self.points as f64 / 10.0;
        1.0 + points * (1.0 + self.points as f64 / SQUARE)
    }
}

/// A conversion of some glyphs.
struct Sample {
    seconds: f64,
    glyphs: usize,
    /// What took the time, in that of blank glyphs.
    work: f64,
    /// Bytes of models that are not put together from others, and how many there are.
    own: (usize, usize),
    /// Bytes of models that are, and how many there are.
    composed: (usize, usize),
    table_bytes: usize,
    file_bytes: usize,
}

/// What a conversion is expected to take.
struct Estimate {
    seconds: f64,
    table_bytes: f64,
    file_bytes: f64,
}

/// Estimates and prints.
pub(super) fn run(
    input: &[u8],
    options: &Options,
    ppem: &PpemList,
    existing: Option<&Existing>,
) -> Result<(), Failure> {
    let start = Instant::now();
    let subjects = subjects(input, options)?;
    let (estimate, converted) = if subjects.is_empty() {
        (Estimate { seconds: 0.0, table_bytes: 0.0, file_bytes: input.len() as f64 }, 0)
    } else {
        estimate(input, options, ppem, &subjects)?
    };
    let Estimate { seconds, table_bytes, mut file_bytes } = estimate;
    if let Some(existing) = existing {
        file_bytes = existing.len() as f64 + table_bytes;
    }
    let mut out = io::stdout().lock();
    let count = glyph_count_text(options.gids.len());
    let took = start.elapsed().as_secs_f64();
    writeln!(out, "estimate for {count}, from {converted} of them in {took:.1} s; nothing is written")?;
    let each = table_bytes / options.gids.len().max(1) as f64;
    writeln!(out, "table   about {table_bytes:.0} bytes, {each:.1} per glyph")?;
    let percent = 100.0 * file_bytes / input.len().max(1) as f64;
    writeln!(out, "file    about {file_bytes:.0} bytes, {percent:.1} % of the original's {}", input.len())?;
    writeln!(out, "time    about {seconds:.1} s on {} threads", options.jobs)?;
    Ok(())
}

/// The glyphs by what they are, then by their points.
fn subjects(input: &[u8], options: &Options) -> Result<Vec<Subject>, Error> {
    let font = open(input, options.index)?;
    // PostScript outlines are not counted: their glyphs are taken for as much work as each other.
    let tables = font.loca(None).ok().zip(font.glyf().ok());
    let describe = |&gid: &u16| {
        let described = tables.as_ref().map(|(loca, glyf)| points(loca, glyf, gid.into(), 0));
        let (is_composite, points) = described.unwrap_or_default();
        Subject { gid, is_composite, points }
    };
    let mut subjects: Vec<Subject> = options.gids.iter().map(describe).collect();
    subjects.sort_by_key(|subject| (subject.is_composite, subject.points, subject.gid));
    Ok(subjects)
}

/// Whether a glyph is composite, and its points, those of its parts among them.
fn points(loca: &Loca<'_>, glyf: &Glyf<'_>, gid: GlyphId, depth: usize) -> (bool, usize) {
    /// Parts of parts deeper than this are left out of the estimate.
    const DEEPEST: usize = 4;
    /// So are parts beyond these.
    const MOST_PARTS: usize = 16;
    match loca.get_glyf(gid, glyf) {
        Ok(Some(Glyph::Simple(simple))) => (false, simple.num_points()),
        Ok(Some(Glyph::Composite(composite))) if depth < DEEPEST => {
            let parts = composite.components().take(MOST_PARTS);
            (true, parts.map(|part| points(loca, glyf, part.glyph, depth + 1).1).sum())
        }
        _ => (false, 0),
    }
}

/// The estimate, and how many glyphs were converted for it.
fn estimate(
    input: &[u8],
    options: &Options,
    ppem: &PpemList,
    subjects: &[Subject],
) -> Result<(Estimate, usize), Failure> {
    let first = Sample::convert(input, options, ppem, subjects, FIRST_SAMPLE)?;
    let all = subjects.len();
    if first.glyphs == all {
        let Sample { seconds, table_bytes, file_bytes, glyphs, .. } = first;
        let (table_bytes, file_bytes) = (table_bytes as f64, file_bytes as f64);
        return Ok((Estimate { seconds, table_bytes, file_bytes }, glyphs));
    }
    let limits = if options.uses_outlines() { OUTLINES } else { FIELDS };
    let each = first.seconds / first.glyphs as f64;
    let budget = (LARGEST_SHARE * each * all as f64).max(LEAST_SECONDS);
    let count = ((budget / each) as usize).clamp(*limits.start(), *limits.end());
    let second = Sample::convert(input, options, ppem, subjects, count)?;
    Ok((second.extrapolate(&first, subjects, options), first.glyphs.max(second.glyphs)))
}

impl Sample {
    /// Converts so many glyphs, evenly spread over all, and compares them as a conversion does in the end.
    fn convert(
        input: &[u8],
        options: &Options,
        ppem: &PpemList,
        subjects: &[Subject],
        count: usize,
    ) -> Result<Self, Failure> {
        let count = count.min(subjects.len());
        let at = |k: usize| &subjects[(2 * k + 1) * subjects.len() / (2 * count)];
        let mut gids: Vec<u16> = (0..count).map(|k| at(k).gid).collect();
        gids.sort_unstable();
        let options = Options { gids: gids.clone(), ..options.clone() };
        let start = Instant::now();
        let conversion = convert(input, &options, &Silent)?;
        let pair = FontPair::open(input, options.index, &conversion.font)?;
        gids.retain(|gid| conversion.left_out.binary_search(gid).is_err());
        pair.report(["", ""], &gids, ppem, options.jobs)?;
        Ok(Self::of(&conversion, subjects, count, start.elapsed().as_secs_f64()))
    }

    fn of(conversion: &Conversion, subjects: &[Subject], glyphs: usize, seconds: f64) -> Self {
        let works: HashMap<u16, f64> = subjects.iter().map(|subject| (subject.gid, subject.work())).collect();
        let mut work = 0.0;
        let (mut own, mut composed) = ((0, 0), (0, 0));
        for glyph in &conversion.glyphs {
            work += works.get(&glyph.gid).unwrap_or(&1.0) * if glyph.composed { OF_COMPOSED } else { 1.0 };
            if glyph.composed {
                composed = (composed.0 + glyph.bytes, composed.1 + 1);
            } else {
                own = (own.0 + glyph.bytes, own.1 + 1);
            }
        }
        let (table_bytes, file_bytes) = (conversion.table_bytes, conversion.font.len());
        Self { seconds, glyphs, work, own, composed, table_bytes, file_bytes }
    }

    /// The estimate of all glyphs from this sample and a smaller one.
    fn extrapolate(&self, smaller: &Self, subjects: &[Subject], options: &Options) -> Estimate {
        let all = subjects.len() as f64;
        let composites = subjects.iter().filter(|subject| subject.is_composite).count() as f64;
        // Composite glyphs of the font whose hints move their parts as in the parts' own models are put together.
        let sampled_composites = (self.glyphs as f64 * composites / all).max(1.0);
        let composed = composites * (self.composed.1 as f64 / sampled_composites).min(1.0);
        let own = all - composed;
        // Time: what does not depend on the glyphs, and what does.
        let whole = |subject: &Subject| {
            let composed = if subject.is_composite { composed / composites.max(1.0) } else { 0.0 };
            subject.work() * (1.0 - composed * (1.0 - OF_COMPOSED))
        };
        let work: f64 = subjects.iter().map(whole).sum();
        let [little, much] = [smaller.work, self.work];
        let each =
            if much > little { (self.seconds - smaller.seconds).max(0.0) / (much - little) } else { 0.0 };
        let seconds = self.seconds + each * (work - much).max(0.0);
        // Bytes: those of models, and those of the table for each of them.
        let mean = |(bytes, count): (usize, usize)| bytes as f64 / count.max(1) as f64;
        let count = |sample: &Self| (sample.own.1 + sample.composed.1) as f64;
        let around =
            self.table_bytes.saturating_sub(self.own.0 + self.composed.0) as f64 / count(self).max(1.0);
        let unshared = own * mean(self.own) + composed * mean(self.composed) + around * all;
        let doublings = (all / count(self).max(1.0)).log2().max(0.0);
        let table_bytes = unshared * SHARING.powf(doublings);
        // The rest of the file changes only if outlines are dropped.
        let rest = |sample: &Self| sample.file_bytes as f64 - sample.table_bytes as f64;
        let dropped = match options.drop_outlines {
            true => (rest(self) - rest(smaller)) / (count(self) - count(smaller)).max(1.0),
            false => 0.0,
        };
        let rest = rest(self) + dropped * (own + composed - count(self)).max(0.0);
        Estimate { seconds, table_bytes, file_bytes: rest.max(0.0) + table_bytes }
    }
}
