//! How fast work goes, and how much time is left. Only what this run has done counts: what a work file held took another run's time.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use nfr_convert::Stage;

/// A part of a command's work that takes time for each glyph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    /// A stage of the conversion.
    Converting(Stage),
    /// Bitmaps are compared.
    Comparing,
    /// Hinted points are compared.
    Verifying,
    /// A certificate is checked.
    Certifying,
}

impl Part {
    /// How the times that a glyph takes compare, roughly. With these, the share of a conversion of all glyphs of Liberation Sans grows
    /// evenly: 29, 58 and 87 % after 10, 20 and 30 of 35 seconds.
    fn weight(self) -> f64 {
        match self {
            Self::Converting(Stage::Reading) => 0.8,
            Self::Converting(Stage::Fitting) => 2.3,
            Self::Converting(Stage::Encoding) => 2.9,
            Self::Converting(Stage::Measuring) => 1.8,
            Self::Converting(Stage::Training) => 1500.0,
            Self::Comparing => 1.6,
            Self::Verifying => 0.7,
            Self::Certifying => 1.1,
        }
    }
}

/// The parts of a command's work, and how far each is.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    start: Instant,
    /// The share of a part that is done, from 0 to 1, and the number of glyphs that it is about.
    parts: BTreeMap<Part, (f64, usize)>,
}

impl Pace {
    pub(super) fn new() -> Self {
        Self { start: Instant::now(), parts: BTreeMap::new() }
    }

    /// The time since the start.
    pub(super) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// A part is about so many glyphs. What is done of it stays.
    pub(super) fn plan(&mut self, part: Part, glyphs: usize) {
        let (share, before) = self.parts.get(&part).copied().unwrap_or_default();
        let done = share * before as f64;
        self.parts.insert(part, (done / glyphs.max(1) as f64, glyphs));
    }

    /// One glyph more of a part is done.
    pub(super) fn advance(&mut self, part: Part) {
        if let Some((share, glyphs)) = self.parts.get_mut(&part) {
            *share = (*share + 1.0 / (*glyphs).max(1) as f64).min(1.0);
        }
    }

    /// So much of a part is done.
    pub(super) fn reach(&mut self, part: Part, done: usize, of: usize) {
        if let Some((share, _)) = self.parts.get_mut(&part) {
            *share = share.max(done as f64 / of.max(1) as f64);
        }
    }

    /// The share of all work that is done, from 0 to 1.
    pub(super) fn share(&self) -> f64 {
        let all: f64 = self.parts.iter().map(|(part, (_, glyphs))| part.weight() * *glyphs as f64).sum();
        if all > 0.0 { self.done() / all } else { 0.0 }
    }

    fn done(&self) -> f64 {
        self.parts.iter().map(|(part, (share, glyphs))| part.weight() * share * *glyphs as f64).sum()
    }

    /// Glyphs a second, and the time left, after so much time; none at the beginning.
    fn outlook(&self, elapsed: Duration) -> Option<(f64, Duration)> {
        let (share, done) = (self.share(), self.done());
        let parts = self.parts.iter().filter(|(_, (_, glyphs))| *glyphs > 0);
        let whole: f64 = parts.map(|(part, _)| part.weight()).sum();
        (share > 0.0 && !elapsed.is_zero()).then(|| {
            let left = elapsed.as_secs_f64() * (1.0 - share).max(0.0) / share;
            // A glyph counts once all parts are done with it.
            (done / whole / elapsed.as_secs_f64(), Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX))
        })
    }

    /// The state for people, after so much time.
    pub(super) fn text(&self, elapsed: Duration) -> String {
        match self.outlook(elapsed) {
            None => format!("0 % after {}", duration(elapsed)),
            Some((rate, left)) => {
                // What is a whole number but for rounding stays one.
                let percent = (100.0 * self.share() + 1e-6).floor();
                let digits = if rate < 9.95 { 1 } else { 0 };
                format!("{percent} %, {rate:.digits$} glyphs/s, about {} left", duration(left))
            }
        }
    }
}

/// A time for people.
pub(super) fn duration(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..=119 => format!("{seconds} s"),
        seconds @ 120..=7199 => format!("{} min", (seconds + 30) / 60),
        seconds => format!("{:.1} h", seconds as f64 / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRAINING: Part = Part::Converting(Stage::Training);

    #[test]
    fn rate_and_time_left_are_those_of_this_run() {
        // 10 of the 40 glyphs that a work file did not hold took 100 s.
        let mut pace = Pace::new();
        pace.plan(TRAINING, 40);
        (0..10).for_each(|_| pace.advance(TRAINING));
        assert_eq!(pace.text(Duration::from_secs(100)), "25 %, 0.1 glyphs/s, about 5 min left");
        assert_eq!(Pace::new().text(Duration::from_secs(10)), "0 % after 10 s");
    }

    #[test]
    fn parts_count_by_the_time_that_they_take() {
        let fitting = Part::Converting(Stage::Fitting);
        let mut pace = Pace::new();
        pace.plan(fitting, 100);
        pace.plan(Part::Comparing, 100);
        pace.plan(TRAINING, 0);
        pace.reach(fitting, 5, 5);
        let expected = fitting.weight() / (fitting.weight() + Part::Comparing.weight());
        assert!((pace.share() - expected).abs() < 1e-9);
        pace.reach(Part::Comparing, 57, 57);
        assert_eq!(pace.outlook(Duration::from_secs(50)), Some((2.0, Duration::ZERO)));
    }

    #[test]
    fn what_is_done_stays_when_the_plan_changes() {
        let mut pace = Pace::new();
        pace.plan(TRAINING, 10);
        (0..5).for_each(|_| pace.advance(TRAINING));
        pace.plan(TRAINING, 20);
        assert!((pace.share() - 0.25).abs() < 1e-9);
    }
}
