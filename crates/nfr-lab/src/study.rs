//! All experiments of the paper's evaluation, one after the other, and what came of them.

use super::Square;
use super::bench::{Bench, Glyph, Subject};
use super::error::{ErrorRow, pixel_error};
use super::family::Member;
use super::interpolation::{Aim, Interpolation, interpolate};
use super::resize::{Method, shrunk, single_wrong_pixel};
use super::single::{Ablation, Model, Outcome, grid_fit, implicit, measure, train};
use super::stored::{cropped, drawn, font, weights};
use nfr::internals::table::Precision;
use nfr_convert::error::Error;

/// What to study.
pub struct Plan<'s> {
    /// The three fonts of the comparison, the first of which also has the other experiments.
    pub fonts: &'s [Subject],
    /// Every size of the first font's truth, for what needs no training.
    pub all_sizes: &'s Subject,
    /// The characters that all models learn.
    pub glyphs: &'s str,
    /// Those of the ablations.
    pub ablated: &'s str,
    /// Those that are stored in a font.
    pub stored: &'s str,
    /// A lighter and a bolder weight, with the sizes in common.
    pub weights: [Member<'s>; 2],
    /// The weight between them.
    pub between: &'s Subject,
    /// The characters of the experiment on weights.
    pub weighted: &'s str,
    /// Two typefaces, with the sizes in common.
    pub styles: [Member<'s>; 2],
    /// The characters of the experiment on typefaces.
    pub styled: &'s str,
}

/// What a font with the paper's network makes of a glyph.
#[derive(Debug, Clone)]
pub struct Stored {
    /// The character.
    pub glyph: char,
    /// Bits of a weight.
    pub bits: u8,
    /// Bytes of the network in the table.
    pub bytes: usize,
    /// What the renderer draws, against the truth.
    pub outcome: Outcome,
    /// The mean squared error of what the network drew before it was stored, in the glyph's box, which is what fonts draw.
    pub before: f64,
}

/// The effect of one wrong pixel on a bitmap.
#[derive(Debug, Clone)]
pub struct WrongPixel {
    /// The character.
    pub glyph: char,
    /// The true bitmap.
    pub truth: Square,
    /// The same with one pixel of ink gone.
    pub wrong: Square,
    /// Column and row of that pixel.
    pub at: [usize; 2],
    /// Its mean squared error.
    pub mse: f64,
}

/// What came of a study.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    /// Masked network, implicit network and grid-fit field, for each font and character.
    pub outcomes: Vec<Outcome>,
    /// Bytes of each grid-fit field.
    pub grid_fit_bytes: Vec<usize>,
    /// The implicit network without one part, on the first font.
    pub ablations: Vec<Outcome>,
    /// One network for two weights.
    pub weights: Vec<Interpolation>,
    /// One network for two typefaces.
    pub styles: Vec<Interpolation>,
    /// Networks in fonts.
    pub stored: Vec<Stored>,
    /// The largest bitmap, shrunk, against the hinted ones: the model is the method.
    pub resized: Vec<ErrorRow>,
    /// Unhinted bitmaps against hinted ones.
    pub unhinted: Vec<ErrorRow>,
    /// One wrong pixel in the smallest bitmap of some characters.
    pub wrong_pixel: Vec<WrongPixel>,
}

/// The name of unhinted bitmaps in tables.
pub const UNHINTED: &str = "unhinted";

impl Plan<'_> {
    /// Runs all experiments. Trainings that the bench has already are taken from there, if it resumes.
    ///
    /// # Errors
    ///
    /// As the experiments'.
    pub fn run(&self, bench: &Bench<'_>) -> Result<Findings, Error> {
        let mut findings = Findings::default();
        self.memorise(bench, &mut findings)?;
        self.ablate(bench, &mut findings)?;
        let weights = |glyph: &char| {
            let share = 0.5;
            let aim = Aim { name: &self.between.name, share, real: Some(self.between) };
            interpolate(bench, "weights", &self.weights, aim, *glyph)
        };
        let weighted: Vec<char> = self.weighted.chars().collect();
        findings.weights = bench.each(&weighted, weights)?;
        let styles = |glyph: &char| {
            let aim = Aim { name: "between the typefaces", share: 0.5, real: None };
            interpolate(bench, "styles", &self.styles, aim, *glyph)
        };
        let styled: Vec<char> = self.styled.chars().collect();
        findings.styles = bench.each(&styled, styles)?;
        self.compare_bitmaps(&mut findings)?;
        self.store(bench, &mut findings)?;
        Ok(findings)
    }

    fn memorise(&self, bench: &Bench<'_>, findings: &mut Findings) -> Result<(), Error> {
        let mut trainings = Vec::new();
        for subject in self.fonts {
            let glyphs = subject.glyphs(self.glyphs)?;
            for (outcome, bytes) in grid_fit(bench, subject, &glyphs)? {
                findings.outcomes.push(outcome);
                findings.grid_fit_bytes.push(bytes);
            }
            let models = [Model::Implicit(Vec::new()), Model::Masked];
            trainings.extend(models.into_iter().flat_map(|model| {
                glyphs.iter().map(move |glyph| (subject, *glyph, model.clone())).collect::<Vec<_>>()
            }));
        }
        findings
            .outcomes
            .extend(bench.each(&trainings, |(subject, glyph, model)| train(bench, subject, *glyph, model))?);
        Ok(())
    }

    fn ablate(&self, bench: &Bench<'_>, findings: &mut Findings) -> Result<(), Error> {
        let glyphs = self.fonts[0].glyphs(self.ablated)?;
        let trainings: Vec<(Glyph, Model)> = Ablation::ALL
            .into_iter()
            .flat_map(|part| glyphs.iter().map(move |glyph| (*glyph, Model::Implicit(vec![part]))))
            .collect();
        findings.ablations =
            bench.each(&trainings, |(glyph, model)| train(bench, &self.fonts[0], *glyph, model))?;
        Ok(())
    }

    /// What can be said about bitmaps without any model.
    fn compare_bitmaps(&self, findings: &mut Findings) -> Result<(), Error> {
        let subject = self.all_sizes;
        let sizes = 0..subject.truth.sizes.len();
        for (glyph, gid) in subject.glyphs(self.glyphs)? {
            let truth = subject.squares(gid)?;
            let plain = sizes.clone().map(|size| subject.truth.plain(gid, size));
            let plain = plain.collect::<Result<Vec<_>, _>>()?;
            findings.unhinted.extend(measure(UNHINTED, subject, glyph, &truth, &plain)?);
            for method in Method::ALL {
                let small = sizes.clone().map(|size| shrunk(&subject.truth, gid, size, method));
                let small = small.map(|shrunk| Ok(shrunk?.0)).collect::<Result<Vec<_>, Error>>()?;
                findings.resized.extend(measure(method.name(), subject, glyph, &truth, &small)?);
            }
        }
        for (glyph, gid) in subject.glyphs(self.ablated)? {
            let truth = subject.truth.hinted(gid, 0)?;
            let (wrong, at) = single_wrong_pixel(&truth);
            let mse = pixel_error(&truth, &wrong)?.mse;
            findings.wrong_pixel.extend(at.map(|at| WrongPixel { glyph, truth, wrong, at, mse }));
        }
        Ok(())
    }

    fn store(&self, bench: &Bench<'_>, findings: &mut Findings) -> Result<(), Error> {
        let subject = &self.fonts[0];
        for glyph in subject.glyphs(self.stored)? {
            // The training is there already: it is one of the first.
            let again = Bench {
                settings: bench.settings.clone(),
                device: bench.device.clone(),
                directory: bench.directory.clone(),
                resume: true,
                ..*bench
            };
            let (before, network) = implicit(&again, subject, glyph, &[])?;
            findings.stored.extend(store(bench, subject, glyph, &network, &before)?);
        }
        Ok(())
    }
}

/// Stores a network with 16-bit and with 8-bit weights in a font, and draws it from there.
///
/// # Errors
///
/// As [`weights`], [`font`] and [`drawn`].
pub fn store(
    bench: &Bench<'_>,
    subject: &Subject,
    glyph: Glyph,
    network: &super::implicit::Implicit,
    before: &Outcome,
) -> Result<[Stored; 2], Error> {
    let weights = weights(network, bench.settings.implicit, subject, glyph)?;
    let seen = cropped(&weights.sizes, &before.drawn);
    let before = Outcome::new(&before.model, subject, glyph, seen)?.mse();
    let one = |precision: Precision| {
        let file = font(subject, &[(glyph, weights.clone())], precision, bench.settings.seed)?;
        let (squares, bytes) = drawn(&file, subject, glyph)?;
        let bits = precision.bits();
        let outcome = Outcome::new(&format!("implicit at {bits} bits"), subject, glyph, squares)?;
        Ok::<_, Error>(Stored { glyph: glyph.0, bits, bytes, outcome, before })
    };
    Ok([one(Precision::Sixteen)?, one(Precision::Eight)?])
}
