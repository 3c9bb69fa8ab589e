//! What hinting does to the points of `glyf`.

use crate::options::Fidelity;
use crate::path_points::places;
use crate::training_samples::GlyphSamples;
use nfr::internals::model::gridfit::Scale;
use nfr::internals::model::outline::{Interpolation, OutlinePoints, rounded_down, scale_of};
use nfr::internals::model::sizes::Origin;
use nfr::internals::mul_fixed;

/// How far the points of what were cubic curves are from their scaled places where nothing is hinted, in 1/64 pixel: each is a combination
/// of rounded points, and rounded itself.
const ROUNDINGS: u32 = 2;

/// A glyph's points, and where hinting puts them at each size.
#[derive(Debug, Clone)]
pub(crate) struct OutlineSamples {
    pub(crate) points: OutlinePoints,
    /// The factor from font units to 1/64 pixel at each size, in 1/65536.
    pub(crate) scales: Vec<i32>,
    /// Along x and y: the hinted positions in 1/64 pixel, size after size.
    pub(crate) hinted: [Vec<i32>; 2],
    /// The hinted advance width at each size, in whole pixels less the scaled one, rounded.
    pub(crate) advances: Vec<i8>,
    origin: Origin,
    interpolation: [Interpolation; 2],
}

impl OutlineSamples {
    /// Finds the points of `glyf` in the paths that the teacher has drawn. `advance` is the glyph's advance width in font units.
    /// None if the paths are not those of the points, at any size.
    pub(crate) fn new(
        samples: &GlyphSamples,
        points: OutlinePoints,
        advance: u16,
        scale: Scale,
    ) -> Option<Self> {
        if samples.contours_change {
            return None;
        }
        let contours: Vec<_> = points.contours().collect();
        let places = places(&points.on_curve, &contours, samples.outline.points.len())?;
        let scales: Vec<i32> =
            samples.sizes.iter().map(|size| scale_of(size.ppem.into(), scale.units_per_em())).collect();
        let mut hinted = [Vec::new(), Vec::new()];
        for (size, scale) in samples.sizes.iter().zip(&scales) {
            for (axis, hinted) in hinted.iter_mut().enumerate() {
                hinted.extend(places.iter().zip(&points.coordinates[axis]).map(|(place, units)| {
                    let plain = mul_fixed((*units).into(), *scale);
                    let Some(place) = place else { return plain };
                    let position = (size.points[*place][axis] * 64.0).round() as i32;
                    // Predictions know nothing of the rounding of scaled points.
                    if size.predicted && (position - plain).abs() <= 1 { plain } else { position }
                }));
            }
        }
        let advances: Vec<i8> = samples
            .sizes
            .iter()
            .zip(&scales)
            .map(|(size, scale)| {
                let rounded = (mul_fixed(advance.into(), *scale) + 32) >> 6;
                size.advance
                    .map_or(0, |hinted| (hinted - rounded).clamp(i8::MIN.into(), i8::MAX.into()) as i8)
            })
            .collect();
        Some(Self { scales, hinted, advances, ..Self::of_points(points, scale) })
    }

    /// A glyph's points without the hinted positions, which are not needed once it is encoded.
    pub(crate) fn of_points(points: OutlinePoints, scale: Scale) -> Self {
        let interpolation = [0, 1].map(|axis| Interpolation::of(axis, &scale));
        let hinted = [Vec::new(), Vec::new()];
        Self {
            points,
            scales: Vec::new(),
            hinted,
            advances: Vec::new(),
            origin: scale.origin(),
            interpolation,
        }
    }

    /// What moves the points along an axis that no track moves.
    pub(crate) fn interpolation(&self, axis: usize) -> Interpolation {
        self.interpolation[axis]
    }

    /// The number of sizes.
    pub(crate) fn sizes(&self) -> usize {
        self.scales.len()
    }

    /// The positions along an axis at a size if nothing is hinted there.
    fn plain(&self, axis: usize, size: usize) -> impl Iterator<Item = i32> + '_ {
        let (scale, rounds_down) = (self.scales[size], self.origin == Origin::PostScript);
        let plain = move |v: i32| if rounds_down { rounded_down(v, scale) } else { mul_fixed(v, scale) };
        self.points.coordinates[axis].iter().map(move |units| plain((*units).into()))
    }

    /// Whether hinting leaves an axis alone at all sizes.
    pub(crate) fn is_still(&self, axis: usize, fidelity: Fidelity) -> bool {
        let tolerance = match self.origin {
            Origin::TrueType => fidelity.tolerance() as u32 / 2,
            _ if fidelity.is_exact() => 0,
            _ => ROUNDINGS,
        };
        (0..self.sizes()).all(|size| {
            self.plain(axis, size).zip(self.hinted_at(axis, size)).all(|(a, b)| a.abs_diff(*b) <= tolerance)
        })
    }

    /// The hinted positions along an axis at a size.
    pub(crate) fn hinted_at(&self, axis: usize, size: usize) -> &[i32] {
        &self.hinted[axis][size * self.points.len()..][..self.points.len()]
    }
}
