//! Whether what a neural font's certificate says of its glyphs holds.

use std::fmt;

use serde::Serialize;

use super::fonts::FontPair;
use super::metrics::Sums;
use super::report::glyph_count_text;
use super::source::patient;
use crate::error::Error;
use crate::parallel;
use nfr::internals::Decoder;
use nfr::internals::table::{Bound, CertifiedErrors};

/// Glyphs that the printed result lists.
const LISTED: usize = 5;

/// The errors of a glyph over all sizes of the models, as a certificate states them: rounded up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StatedErrors {
    /// The mean absolute error, 0..1.
    pub mae: f64,
    /// The share of pixels off by more than 16/255, 0..1.
    pub bad16: f64,
    /// The largest difference of a pixel, of 255.
    pub max: u8,
}

impl From<CertifiedErrors> for StatedErrors {
    fn from(errors: CertifiedErrors) -> Self {
        Self { mae: errors.mae.value(), bad16: errors.bad16.value(), max: errors.max }
    }
}

impl From<StatedErrors> for CertifiedErrors {
    fn from(errors: StatedErrors) -> Self {
        Self { mae: Bound::of(errors.mae), bad16: Bound::of(errors.bad16), max: errors.max }
    }
}

/// A glyph whose errors are larger than its certificate says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Exceeded {
    /// The glyph.
    pub gid: u16,
    /// What the certificate says.
    pub stated: StatedErrors,
    /// What was measured, rounded up in the same way.
    pub measured: StatedErrors,
}

/// A certificate, and what was found when the errors were measured again.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CertificateCheck {
    /// The engine that ran the hints for the conversion, with its version.
    pub teacher: String,
    /// The converter, with its version.
    pub converter: String,
    /// Its options.
    pub options: String,
    /// Whether the certificate says that all hinted points are equal.
    pub is_exact: bool,
    /// The number of glyphs that were measured.
    pub glyphs: usize,
    /// Those whose errors are larger than stated, ascending.
    pub exceeded: Vec<Exceeded>,
}

impl FontPair<'_> {
    /// Measures the errors of glyphs again, at all sizes of the models, and compares them with what the neural font's certificate
    /// says. None for a font without one. Glyphs that have no model are left out, and those whose outline was changed.
    ///
    /// # Errors
    ///
    /// As [`FontPair::check_outlines`], and those of drawing a glyph.
    pub fn check_certificate(&self, gids: &[u16], jobs: usize) -> Result<Option<CertificateCheck>, Error> {
        let table = nfr::internals::table(self.font())?;
        let Some(certificate) = table.certificate() else { return Ok(None) };
        let mut decoder = Decoder::new(self.font(), patient());
        let mut glyphs = Vec::new();
        for (gid, stated) in table.gids().zip(certificate.errors()) {
            if gids.binary_search(&gid).is_ok() {
                match decoder.glyph(gid.into()) {
                    Ok(glyph) => glyphs.push((gid, stated, glyph)),
                    Err(nfr::Error::StaleModel(_)) => {}
                    Err(error) => return Err(error.into()),
                }
            }
        }
        self.check_outlines(&glyphs.iter().map(|(gid, ..)| *gid).collect::<Vec<_>>())?;
        let (first, last) = self.font().ppem_range();
        let sizes = (first..=last).map(|ppem| self.teacher().at(ppem)).collect::<Result<Vec<_>, _>>()?;
        self.watched().begin(glyphs.len());
        let measured = parallel::map(&glyphs, jobs, |(gid, _, glyph)| {
            let mut sums = Sums::default();
            for at in &sizes {
                sums.add(&at.hinted(*gid)?.rasterize()?, &glyph.render(f32::from(at.ppem()))?);
            }
            self.watched().done(1);
            Ok(sums.certified())
        })?;
        let pairs = glyphs.iter().zip(measured);
        let exceeded = pairs.filter(|((_, stated, _), measured)| {
            measured.mae > stated.mae || measured.bad16 > stated.bad16 || measured.max > stated.max
        });
        let exceeded = exceeded.map(|((gid, stated, _), measured)| Exceeded {
            gid: *gid,
            stated: (*stated).into(),
            measured: measured.into(),
        });
        Ok(Some(CertificateCheck {
            teacher: certificate.teacher.to_owned(),
            converter: certificate.converter.to_owned(),
            options: certificate.options.to_owned(),
            is_exact: certificate.is_exact,
            glyphs: glyphs.len(),
            exceeded: exceeded.collect(),
        }))
    }
}

impl CertificateCheck {
    /// A line if it does not hold.
    pub fn failures(&self) -> Vec<String> {
        if self.exceeded.is_empty() {
            return Vec::new();
        }
        vec![format!(
            "the certificate does not hold: the errors of {} are larger than it says",
            glyph_count_text(self.exceeded.len())
        )]
    }
}

/// The check for people.
impl fmt::Display for CertificateCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { teacher, converter, options, glyphs, exceeded, .. } = self;
        writeln!(f, "teacher       {teacher}, by {converter} {options}")?;
        let glyphs = glyph_count_text(*glyphs);
        if exceeded.is_empty() {
            writeln!(f, "certificate   holds: the errors of {glyphs} are no larger than it says")?;
        } else {
            writeln!(f, "certificate   does not hold for {} of {glyphs}", exceeded.len())?;
        }
        exceeded.iter().take(LISTED).try_for_each(|Exceeded { gid, stated, measured }| {
            writeln!(
                f,
                "  glyph {gid}: mae {:.6} for {:.6}, bad16 {:.6} for {:.6}, max {} for {}",
                measured.mae, stated.mae, measured.bad16, stated.bad16, measured.max, stated.max
            )
        })
    }
}
