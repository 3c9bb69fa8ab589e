//! Timing candidates in turn, and the median of their times.

use std::error::Error;
use std::time::Duration;

/// A turn takes at least as long, so that the clock's grain and a single interruption do not show.
const TURN: Duration = Duration::from_millis(1);

/// Draws every glyph once at a size and says how long that took.
type Pass<'a> = Box<dyn FnMut(u16, &[u16]) -> Result<Duration, Box<dyn Error>> + 'a>;

/// A renderer and the operation that is timed.
pub(crate) struct Candidate<'a> {
    name: &'static str,
    pass: Pass<'a>,
}

impl<'a> Candidate<'a> {
    pub(crate) fn new(
        name: &'static str,
        pass: impl FnMut(u16, &[u16]) -> Result<Duration, Box<dyn Error>> + 'a,
    ) -> Self {
        Self { name, pass: Box::new(pass) }
    }

    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// Microseconds a glyph in one turn: a pass for the caches, then as many as fill the turn.
    fn turn(&mut self, ppem: u16, gids: &[u16]) -> Result<f64, Box<dyn Error>> {
        let mut pass = || (self.pass)(ppem, gids).map_err(|e| format!("{} at {ppem} ppem: {e}", self.name));
        pass()?;
        let (mut time, mut glyphs) = (Duration::ZERO, 0);
        while time < TURN {
            time += pass()?;
            glyphs += gids.len();
        }
        Ok(time.as_secs_f64() * 1e6 / glyphs as f64)
    }
}

/// Microseconds a glyph for each candidate: the median of the rounds.
pub(crate) fn medians(
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
