//! The prediction of a font's glyphs and of the offsets of composed glyphs' parts.

use super::axis::AxisTracks;
use super::likelihood::WeightedSizes;
use super::placement::place;
use super::track::{AlignmentZone, Track};
use super::zones::{TrackCounts, alignment_zones};
use crate::error::Error;
use crate::teacher::{Teacher, TeacherAt};
use crate::training_samples::{GlyphSamples, TrainingSample};
use nfr::internals::model::gridfit::Scale;
use nfr::internals::table::Dropout;

/// Predicts the sizes of a scale that are not known.
pub(crate) struct Predictor {
    known: Vec<u16>,
    wanted: Vec<WantedSize>,
}

struct WantedSize {
    ppem: u16,
    sizes: WeightedSizes,
    /// The font's alignment zones along x and y.
    zones: [Vec<AlignmentZone>; 2],
}

impl Predictor {
    /// Collects how the font hints `gids` at the known `sizes`, to predict the other sizes of `scale`.
    pub(crate) fn new(
        teacher: &Teacher,
        sizes: &[TeacherAt],
        scale: Scale,
        gids: &[u16],
    ) -> Result<Self, Error> {
        let known: Vec<u16> = sizes.iter().map(TeacherAt::ppem).collect();
        let all = (0..scale.sizes()).map(|size| scale.ppem_of(size) as u16);
        let wanted: Vec<u16> = all.filter(|ppem| !known.contains(ppem)).collect();
        let mut counts = [TrackCounts::default(), TrackCounts::default()];
        for gid in if wanted.is_empty() { &[] } else { gids } {
            let unhinted = teacher.unhinted_em(*gid)?;
            let hinted = sizes.iter().map(|at| Ok(at.hinted_with_error(*gid)?.0));
            let hinted = hinted.collect::<Result<Vec<_>, Error>>()?;
            if hinted.iter().all(|outline| outline.has_contours_of(&unhinted)) {
                let hinted: Vec<&[[f32; 2]]> =
                    hinted.iter().map(|outline| outline.points.as_slice()).collect();
                for (counts, axis) in counts.iter_mut().zip(axes(&unhinted.points, &hinted)) {
                    counts.add(&axis.tracks);
                }
            }
        }
        let tracks = counts.map(TrackCounts::into_zone_tracks);
        let wanted = wanted.into_iter().map(|ppem| {
            let sizes = WeightedSizes::new(&known, ppem);
            let zones = [0, 1].map(|axis| alignment_zones(&tracks[axis], &sizes));
            WantedSize { ppem, sizes, zones }
        });
        Ok(Self { wanted: wanted.collect(), known })
    }

    /// Adds the wanted sizes to a glyph's samples at the known sizes.
    pub(crate) fn add_predicted_sizes(&self, samples: &mut GlyphSamples) -> Result<(), Error> {
        if self.wanted.is_empty() {
            return Ok(());
        }
        let hinted: Vec<&[[f32; 2]]> = samples.sizes.iter().map(|size| size.points.as_slice()).collect();
        let axes = axes(&samples.outline.points, &hinted);
        for wanted in &self.wanted {
            let [x, y] = [0, 1].map(|axis| axes[axis].predict(&wanted.sizes, &wanted.zones[axis]));
            let points: Vec<[f32; 2]> = x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
            let bitmap = samples.outline.with_points(&points)?.rasterize()?;
            samples.sizes.push(TrainingSample {
                ppem: wanted.ppem,
                points,
                advance: None,
                dropout: Dropout::default(),
                bitmap,
                predicted: true,
            });
        }
        samples.sizes.sort_by_key(|size| size.ppem);
        Ok(())
    }

    /// The known sizes.
    pub(crate) fn known(&self) -> &[u16] {
        &self.known
    }

    /// Predicts the grid-fitted offset of a part along an axis (pixels) at all sizes, ascending: `unhinted` is its offset
    /// in em, `known` are those at the known sizes.
    pub(crate) fn part_offsets(&self, axis: usize, unhinted: f64, known: &[f64]) -> Vec<f64> {
        let track = Track { unhinted, hinted: known.to_vec() };
        let mut all: Vec<(u16, f64)> = self.known.iter().copied().zip(known.iter().copied()).collect();
        for wanted in &self.wanted {
            let positions = place(std::slice::from_ref(&track), &wanted.sizes, &wanted.zones[axis]);
            all.extend(positions.first().map(|position| (wanted.ppem, position.at.round())));
        }
        all.sort_by_key(|(ppem, _)| *ppem);
        all.into_iter().map(|(_, offset)| offset).collect()
    }
}

/// Both coordinates of an outline's points: unhinted ones in em, hinted ones in pixels by known size.
fn axes(unhinted: &[[f32; 2]], hinted: &[&[[f32; 2]]]) -> [AxisTracks; 2] {
    [0, 1].map(|axis| {
        let of = |points: &[[f32; 2]]| points.iter().map(|point| point[axis]).collect::<Vec<f32>>();
        AxisTracks::new(&of(unhinted), &hinted.iter().map(|points| of(points)).collect::<Vec<_>>())
    })
}
