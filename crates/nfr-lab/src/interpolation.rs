//! The experiment on families: one network for several weights, judged at a weight that it never saw.

use super::Square;
use super::bench::{Bench, Glyph, Subject};
use super::error::ErrorRow;
use super::family::{GridFits, Member, train};
use super::single::measure;
use super::train::Epoch;
use nfr_convert::error::Error;

/// One way to draw the weight between, or one end.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// What drew it.
    pub name: String,
    /// The font that it should be like.
    pub of: String,
    /// Its bitmap for each size.
    pub drawn: Vec<Square>,
    /// The real ones, where there is such a font.
    pub truth: Option<Vec<Square>>,
    /// How far off it is at each size, where that is known.
    pub rows: Vec<ErrorRow>,
}

impl Drawing {
    /// The mean squared error over all sizes, where it is known.
    pub fn mse(&self) -> Option<f64> {
        (!self.rows.is_empty())
            .then(|| self.rows.iter().map(|row| row.mse).sum::<f64>() / self.rows.len() as f64)
    }
}

/// What an experiment on a family gives for one character.
#[derive(Debug, Clone)]
pub struct Interpolation {
    /// The character.
    pub glyph: char,
    /// The network's epochs.
    pub history: Vec<Epoch>,
    /// What the network draws for the fonts that it was trained on.
    pub ends: Vec<Drawing>,
    /// What is drawn between the first and the last of them.
    pub between: Vec<Drawing>,
}

/// The names of what is drawn between, in tables.
pub mod names {
    /// The paper's network, from the interpolated latent vector.
    pub const IMPLICIT: &str = "implicit";
    /// Our models, interpolated in the same way.
    pub const GRID_FIT: &str = "grid-fit";
    /// The same, with knots that stand on whole pixels in both models put on whole pixels.
    pub const SNAPPED: &str = "grid-fit snapped";
    /// The mean of the two true bitmaps.
    pub const BITMAPS: &str = "mean of bitmaps";
    /// The true bitmaps of the lighter font.
    pub const FIRST: &str = "first font as it is";
    /// The true bitmaps of the bolder font.
    pub const LAST: &str = "last font as it is";
}

/// What is drawn between.
#[derive(Clone, Copy)]
pub struct Aim<'s> {
    /// What it is called.
    pub name: &'s str,
    /// Its place between the first member and the last, 0 to 1.
    pub share: f64,
    /// The real font, if there is one, with the same sizes.
    pub real: Option<&'s Subject>,
}

/// Trains one network on a character of all members and draws what lies between the first and the last.
///
/// # Errors
///
/// As [`train`] and [`GridFits::train`].
pub fn interpolate(
    bench: &Bench<'_>,
    experiment: &str,
    members: &[Member<'_>],
    aim: Aim<'_>,
    glyph: char,
) -> Result<Interpolation, Error> {
    let (Some(first), Some(last)) = (members.first(), members.last()) else {
        return Err(Error::InvalidParameter("a family needs two fonts".into()));
    };
    let family = train(bench, experiment, members, glyph)?;
    let glyph_of = |subject: &Subject| subject.glyphs(glyph.encode_utf8(&mut [0; 4]));
    let truth = |subject: &Subject| -> Result<Vec<Square>, Error> {
        glyph_of(subject)?.first().map_or(Ok(Vec::new()), |glyph: &Glyph| subject.squares(glyph.1))
    };
    let measured = |name: &str, drawn: Vec<Square>, of: &str, real: Option<&Subject>| {
        let truth = real.map(truth).transpose()?;
        let rows = match (real, &truth) {
            (Some(subject), Some(truth)) => measure(name, subject, glyph, truth, &drawn)?,
            _ => Vec::new(),
        };
        Ok::<_, Error>(Drawing { name: name.to_owned(), of: of.to_owned(), drawn, truth, rows })
    };
    let end = |(number, member): (usize, &Member<'_>)| {
        measured(names::IMPLICIT, family.member(number)?, &member.subject.name, Some(member.subject))
    };
    let ends = members.iter().enumerate().map(end).collect::<Result<_, _>>()?;
    let fits = GridFits::train(bench, [first.subject, last.subject], glyph)?;
    let (lighter, bolder) = (truth(first.subject)?, truth(last.subject)?);
    let mean = lighter.iter().zip(&bolder).map(|(a, b)| mixed(a, b, aim.share)).collect();
    let drawings = [
        (names::IMPLICIT, family.between(0, members.len() - 1, aim.share)?),
        (names::GRID_FIT, fits.between(first.subject, aim.share, false)?),
        (names::SNAPPED, fits.between(first.subject, aim.share, true)?),
        (names::BITMAPS, mean),
        (names::FIRST, lighter),
        (names::LAST, bolder),
    ];
    let between = drawings.into_iter().map(|(name, drawn)| measured(name, drawn, aim.name, aim.real));
    Ok(Interpolation { glyph, ends, between: between.collect::<Result<_, _>>()?, history: family.history })
}

fn mixed(a: &Square, b: &Square, share: f64) -> Square {
    let pixel = |(a, b): (&u8, &u8)| (f64::from(*a) * (1.0 - share) + f64::from(*b) * share).round() as u8;
    Square { side: a.side, pixels: a.pixels.iter().zip(&b.pixels).map(pixel).collect() }
}
