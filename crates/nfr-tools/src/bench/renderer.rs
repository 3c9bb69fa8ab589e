//! What renderers have in common that draw at a size which has been set up.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use super::buffer::Coverage;
use super::round::Candidate;

/// A renderer that keeps what it can from one glyph to the next.
pub(super) trait Renderer {
    /// Gets ready for a size.
    fn set_size(&mut self, ppem: u16, gids: &[u16]) -> Result<(), Box<dyn Error>>;

    /// Draws each glyph and shows its pixels.
    fn draw(&mut self, gids: &[u16], show: impl FnMut(Coverage<'_>)) -> Result<(), Box<dyn Error>>;
}

/// Times a renderer at a size that has been drawn before. Opening the font and setting the size are not timed.
pub(super) fn warm<'a>(
    name: &'static str,
    about: &'static str,
    mut renderer: impl Renderer + 'a,
) -> Candidate<'a> {
    let mut last = None;
    Candidate::new(name, about, move |ppem, gids| {
        if last != Some(ppem) {
            renderer.set_size(ppem, gids)?;
            check_ink(&mut renderer, gids)?;
            last = Some(ppem);
        }
        let start = Instant::now();
        renderer.draw(black_box(gids), |coverage| {
            black_box(coverage);
        })?;
        Ok(start.elapsed())
    })
}

/// Refuses a renderer whose bitmaps are mostly empty.
fn check_ink(renderer: &mut impl Renderer, gids: &[u16]) -> Result<(), Box<dyn Error>> {
    let mut inked = 0;
    renderer.draw(gids, |coverage| inked += usize::from(coverage.has_ink()))?;
    if 2 * inked < gids.len() {
        return Err(format!("only {inked} of {} glyphs have ink; select others", gids.len()).into());
    }
    Ok(())
}
