//! Timing candidates in turn, and the median of their times.

use std::error::Error;
use std::time::{Duration, Instant};

/// A turn takes at least as long, so that the clock's grain and a single interruption do not show.
const TURN: Duration = Duration::from_millis(1);
/// A turn that takes longer, with what is not timed, ends after the pass: the whole measurement takes seconds. The caches
/// need no pass of their own then, as what they lack at first is less than a hundredth of such a time.
const LONG: Duration = Duration::from_millis(10);

/// Draws every glyph once at a size and says how long that took.
type Pass<'a> = Box<dyn FnMut(u16, &[u16]) -> Result<Duration, Box<dyn Error>> + 'a>;

/// A renderer and the operation that is timed.
pub(super) struct Candidate<'a> {
    name: &'static str,
    about: &'static str,
    pass: Pass<'a>,
}

impl<'a> Candidate<'a> {
    pub(super) fn new(
        name: &'static str,
        about: &'static str,
        pass: impl FnMut(u16, &[u16]) -> Result<Duration, Box<dyn Error>> + 'a,
    ) -> Self {
        Self { name, about, pass: Box::new(pass) }
    }

    /// The JSON's field.
    pub(super) fn name(&self) -> &'static str {
        self.name
    }

    /// What is timed, in a few words.
    pub(super) fn about(&self) -> &'static str {
        self.about
    }

    /// Microseconds a glyph in one turn: a pass for the caches, then as many as fill the turn.
    fn turn(&mut self, ppem: u16, gids: &[u16]) -> Result<f64, Box<dyn Error>> {
        let mut pass = || (self.pass)(ppem, gids).map_err(|e| format!("{} at {ppem} ppem: {e}", self.name));
        let start = Instant::now();
        let (mut time, mut passes) = (pass()?, 1);
        if start.elapsed() < LONG {
            (time, passes) = (pass()?, 1);
        }
        while time < TURN && start.elapsed() < LONG {
            time += pass()?;
            passes += 1;
        }
        Ok(time.as_secs_f64() * 1e6 / (passes * gids.len()) as f64)
    }
}

/// Microseconds a glyph for each candidate: the median of the rounds.
pub(super) fn medians(
    candidates: &mut [Candidate<'_>],
    ppem: u16,
    gids: &[u16],
    rounds: u32,
) -> Result<Vec<f64>, Box<dyn Error>> {
    let count = candidates.len();
    let mut times = vec![Vec::new(); count];
    for round in 0..rounds as usize {
        for place in 0..count {
            // Each round starts with another one, and every second round goes backwards, so that no
            // candidate always follows the same one.
            let place = if round % 2 == 0 { place } else { count - 1 - place };
            let index = (place + round / 2) % count;
            times[index].push(candidates[index].turn(ppem, gids)?);
        }
    }
    Ok(times.into_iter().map(median).collect())
}

/// The middle one, or the mean of the two in the middle.
fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let middle = times.len() / 2;
    if times.len() % 2 == 1 { times[middle] } else { (times[middle - 1] + times[middle]) / 2.0 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::cell::RefCell;

    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0, 4.0]), 3.0);
    }

    #[test]
    fn time_is_divided_by_the_glyphs() {
        let mut candidates = [Candidate::new("", "", |ppem, _| Ok(Duration::from_millis(ppem.into())))];
        assert_eq!(medians(&mut candidates, 12, &[3, 4, 5], 3).unwrap(), [4000.0]);
    }

    #[test]
    fn every_candidate_has_a_turn_in_every_round_and_another_one_before_it() {
        let order = RefCell::new(Vec::new());
        let candidate = |name: &'static str| {
            let order = &order;
            Candidate::new(name, "", move |_, _| {
                order.borrow_mut().push(name);
                Ok(TURN)
            })
        };
        medians(&mut ["a", "b", "c"].map(candidate), 12, &[3], 4).unwrap();
        // The passes of a turn, and of two turns that meet where two rounds do, count once.
        let mut order = order.take();
        order.dedup();
        assert_eq!(order.concat(), "abcbabcacb");
    }
}
