//! Comparing over glyphs and sizes, on several threads, with a result that does not depend on how many.

use std::collections::BTreeMap;

use super::metrics::Sums;
use super::source::BitmapSource;
use super::watched::Watched;
use crate::error::Error;
use crate::parallel;

/// Glyphs that one thread takes at a time: enough that setting a size up costs little, few enough that the threads end
/// together.
const GLYPHS_PER_CHUNK: usize = 128;

/// One glyph at one size. Orders by size, then glyph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
pub struct GlyphAtSize {
    /// Pixels per em.
    pub ppem: u16,
    /// The glyph.
    pub gid: u16,
}

/// Sums over some glyphs and sizes, and where the largest difference of a pixel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// The sums.
    pub sums: Sums,
    /// Where the largest difference is; of several, the smallest size and glyph. None while all is exact.
    pub max_at: Option<GlyphAtSize>,
}

impl Tally {
    /// Adds another tally to this one.
    pub fn merge(&mut self, other: &Self) {
        let (mine, others) = (self.sums.max(), other.sums.max());
        if others > mine || (others == mine && other.max_at.is_some() && other.max_at < self.max_at) {
            self.max_at = other.max_at;
        }
        self.sums.merge(&other.sums);
    }
}

/// The models' tally and, beside it, that of the unhinted outlines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TallyPair {
    /// Models against the hinted truth.
    pub neural: Tally,
    /// Unhinted outlines against the hinted truth.
    pub unhinted: Tally,
}

impl TallyPair {
    /// Adds another pair to this one.
    pub fn merge(&mut self, other: &Self) {
        self.neural.merge(&other.neural);
        self.unhinted.merge(&other.unhinted);
    }
}

/// One glyph over all sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GlyphTally {
    /// All sizes together.
    pub all: TallyPair,
    /// The size at which the model's mean absolute error is largest (of several, the smallest), and that
    /// size alone.
    pub worst: Option<(u16, TallyPair)>,
}

impl GlyphTally {
    fn merge(&mut self, other: &Self) {
        self.all.merge(&other.all);
        let mae_at =
            |worst: &Option<(u16, TallyPair)>| worst.map(|(ppem, pair)| (pair.neural.sums.mae(), ppem));
        let replace = match (mae_at(&self.worst), mae_at(&other.worst)) {
            (Some((mine, my_ppem)), Some((others, other_ppem))) => {
                others.total_cmp(&mine).then(my_ppem.cmp(&other_ppem)).is_gt()
            }
            (None, _) => true,
            (_, None) => false,
        };
        if replace {
            self.worst = other.worst;
        }
    }
}

/// A comparison's sums, by size and by glyph.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tallies {
    /// By pixels per em.
    pub by_ppem: BTreeMap<u16, TallyPair>,
    /// By glyph.
    pub by_glyph: BTreeMap<u16, GlyphTally>,
}

impl Tallies {
    fn add(&mut self, at: GlyphAtSize, pair: TallyPair) {
        self.by_ppem.entry(at.ppem).or_default().merge(&pair);
        let one = GlyphTally { all: pair, worst: Some((at.ppem, pair)) };
        self.by_glyph.entry(at.gid).or_default().merge(&one);
    }

    fn merge(&mut self, other: &Self) {
        for (&ppem, pair) in &other.by_ppem {
            self.by_ppem.entry(ppem).or_default().merge(pair);
        }
        for (&gid, tally) in &other.by_glyph {
            self.by_glyph.entry(gid).or_default().merge(tally);
        }
    }
}

/// The sources of bitmaps: two renderings, and the truth that they are compared with.
#[derive(Clone, Copy)]
pub struct Sources<'s> {
    /// The hinted bitmaps.
    pub truth: &'s dyn BitmapSource,
    /// The models.
    pub neural: &'s dyn BitmapSource,
    /// The baseline without hints.
    pub unhinted: &'s dyn BitmapSource,
}

/// Compares every glyph at every size.
///
/// # Errors
///
/// The first that a source reports, in the order of sizes (largest first) and glyphs.
pub fn compare(sources: Sources<'_>, gids: &[u16], sizes: &[u16], jobs: usize) -> Result<Tallies, Error> {
    compare_watched(sources, gids, sizes, jobs, &Watched::default())
}

/// Compares as [`compare`] does, and tells how far it is.
pub(super) fn compare_watched(
    sources: Sources<'_>,
    gids: &[u16],
    sizes: &[u16],
    jobs: usize,
    watched: &Watched,
) -> Result<Tallies, Error> {
    watched.begin(gids.len() * sizes.len());
    // The largest sizes take longest, so they come first.
    let chunks: Vec<(u16, &[u16])> = sizes
        .iter()
        .rev()
        .flat_map(|&ppem| gids.chunks(GLYPHS_PER_CHUNK).map(move |gids| (ppem, gids)))
        .collect();
    let tallies = parallel::map(&chunks, jobs, |&(ppem, gids)| {
        compare_chunk(sources, gids, ppem).inspect(|_| watched.done(gids.len()))
    })?;
    Ok(tallies.iter().fold(Tallies::default(), |mut total, tallies| {
        total.merge(tallies);
        total
    }))
}

fn compare_chunk(sources: Sources<'_>, gids: &[u16], ppem: u16) -> Result<Tallies, Error> {
    let (mut truth, mut neural) = (sources.truth.at(ppem)?, sources.neural.at(ppem)?);
    let mut unhinted = sources.unhinted.at(ppem)?;
    let mut tallies = Tallies::default();
    for &gid in gids {
        let at = GlyphAtSize { ppem, gid };
        let truth = truth.bitmap(gid)?;
        let tally = |bitmap| {
            let sums = Sums::of(&truth, &bitmap);
            Tally { sums, max_at: (sums.max() > 0).then_some(at) }
        };
        let pair = TallyPair { neural: tally(neural.bitmap(gid)?), unhinted: tally(unhinted.bitmap(gid)?) };
        tallies.add(at, pair);
    }
    Ok(tallies)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::compare::source::{Hinted, SizedSource, Unhinted};
    use crate::teacher::Teacher;
    use nfr::Bitmap;
    use nfr::Target;
    use read_fonts::FontRef;

    const SANS: &[u8] = include_bytes!("../../fonts/LiberationSans-Regular.ttf");
    /// 'A' to 'z' in Liberation Sans.
    const LETTERS: std::ops::RangeInclusive<u16> = 36..=93;

    fn teacher() -> Teacher {
        Teacher::new(&FontRef::new(SANS).unwrap(), Target::Smooth).unwrap()
    }

    /// Fails at every size up to one, with the size in the message.
    struct Failing(u16);

    impl BitmapSource for Failing {
        fn at(&self, ppem: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
            if ppem <= self.0 { Err(Error::Io(ppem.to_string())) } else { Ok(Box::new(Blank)) }
        }
    }

    struct Blank;

    impl SizedSource for Blank {
        fn bitmap(&mut self, _gid: u16) -> Result<Bitmap, Error> {
            Ok(Bitmap::default())
        }
    }

    #[test]
    fn the_result_does_not_depend_on_the_number_of_threads() {
        let teacher = teacher();
        let (truth, unhinted) = (Hinted(&teacher), Unhinted(&teacher));
        let sources = Sources { truth: &truth, neural: &truth, unhinted: &unhinted };
        let gids: Vec<u16> = (0..300).collect();
        let compare = |jobs| compare(sources, &gids, &[9, 10, 16], jobs).unwrap();
        let one = compare(1);
        assert_eq!(one, compare(2));
        assert_eq!(one, compare(7));
    }

    #[test]
    fn the_truth_equals_itself_and_the_unhinted_outline_does_not() {
        let teacher = teacher();
        let (truth, unhinted) = (Hinted(&teacher), Unhinted(&teacher));
        let sources = Sources { truth: &truth, neural: &truth, unhinted: &unhinted };
        let gids: Vec<u16> = LETTERS.collect();
        let sizes: Vec<u16> = (8..=64).collect();
        let tallies = compare(sources, &gids, &sizes, 2).unwrap();
        let mut all = TallyPair::default();
        tallies.by_ppem.values().for_each(|pair| all.merge(pair));
        assert_eq!((all.neural.sums.figures().exact, all.neural.max_at), (1.0, None));
        // Unhinted outlines of Latin fonts measure 0.028 to 0.030 over 8 to 64 ppem.
        let mae = all.unhinted.sums.figures().mae;
        assert!((0.02..0.04).contains(&mae), "{mae}");
        let by_glyph = tallies.by_glyph.values().fold(TallyPair::default(), |mut sum, glyph| {
            sum.merge(&glyph.all);
            sum
        });
        assert_eq!(by_glyph, all);
    }

    #[test]
    fn a_glyph_is_worst_where_its_mean_error_is_largest() {
        let teacher = teacher();
        let (truth, unhinted) = (Hinted(&teacher), Unhinted(&teacher));
        let sources = Sources { truth: &truth, neural: &unhinted, unhinted: &unhinted };
        let at = |sizes: &[u16]| compare(sources, &[68], sizes, 2).unwrap().by_glyph[&68];
        let sizes = [9, 12, 17, 24, 40];
        let mae = |ppem: u16| at(&[ppem]).all.neural.sums.mae();
        let worst = sizes.into_iter().max_by(|a, b| mae(*a).total_cmp(&mae(*b))).unwrap();
        assert_eq!(at(&sizes).worst, Some((worst, at(&[worst]).all)));
        let max = |ppem: u16| at(&[ppem]).all.neural.sums.max();
        let max_at = sizes.into_iter().max_by_key(|ppem| (max(*ppem), std::cmp::Reverse(*ppem))).unwrap();
        assert_eq!(at(&sizes).all.neural.max_at, Some(GlyphAtSize { ppem: max_at, gid: 68 }));
    }

    #[test]
    fn the_first_error_is_the_same_for_any_number_of_threads() {
        let sources = Sources { truth: &Failing(11), neural: &Failing(0), unhinted: &Failing(0) };
        for jobs in [1, 2, 5] {
            let error = compare(sources, &[1, 2], &[9, 10, 11, 12, 13], jobs).unwrap_err();
            assert_eq!(error, Error::Io("11".into()));
        }
    }
}
