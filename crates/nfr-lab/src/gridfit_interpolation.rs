//! Our own model between two weights: the weights of two grid-fit fields, interpolated as the paper interpolates its
//! network's latent vector.

use nfr::internals::model::gridfit::{AxisWarp, DEFORM_NODES, MAX_KNOTS, Scale, WARP_STEPS, Weights, spline};

/// The highest rank that a model may have.
const MAX_RANK: usize = 16;
/// A quadratic spline that interpolates samples nearly takes this much of each one's neighbours.
const NEIGHBOUR: f64 = -0.125;

/// The model a share `t` of the way from `a` to `b`, both of one glyph and trained at the same sizes.
///
/// Boxes, fields and warps are mixed, each relative to its glyph's box, so that edges that correspond meet. Where
/// both have as many knots these correspond, otherwise the two warps are mixed as functions. The
/// patterns of both are kept, with strengths in proportion. `snap` moves knots that stand on whole pixels at both ends to whole pixels again.
pub fn interpolate_weights(a: &Weights, b: &Weights, t: f64, scale: Scale, snap: bool) -> Weights {
    let mix = |a: f64, b: f64| a + (b - a) * t;
    let bounds = std::array::from_fn(|k| mix(a.bounds[k].into(), b.bounds[k].into()).round() as i16);
    let field = resampled(b, a.cells);
    let field = a.field.iter().zip(&field).map(|(a, b)| byte(mix(f64::from(*a), *b))).collect();
    let warp = |axis: usize| mixed_warp([a, b].map(|w| Axis::new(w, axis, scale)), bounds, axis, t, snap);
    let (warp_x, warp_y) = (warp(0), warp(1));
    let ranks = [a, b].map(|w| usize::from(w.rank));
    let rank = (ranks[0] + ranks[1]).min(MAX_RANK);
    let nodes = DEFORM_NODES * DEFORM_NODES;
    let strengths = |size: usize| {
        let of = |w: &Weights, rank: usize, share: f64| -> Vec<i8> {
            let at = size * rank..(size + 1) * rank;
            w.embedding[at].iter().map(|e| byte(f64::from(*e) * share)).collect()
        };
        let mut all = of(a, ranks[0], 1.0 - t);
        all.extend(of(b, ranks[1], t));
        all.truncate(rank);
        all
    };
    let mut patterns = [a.patterns.as_slice(), &b.patterns].concat();
    patterns.truncate(rank * nodes);
    Weights {
        bounds,
        cells: a.cells,
        field,
        warp_x,
        warp_y,
        rank: rank as u8,
        patterns,
        embedding: (0..scale.sizes()).flat_map(strengths).collect(),
    }
}

fn byte(value: f64) -> i8 {
    value.round().clamp(-127.0, 127.0) as i8
}

/// A field's coefficients on another grid over the same box.
fn resampled(weights: &Weights, cells: [u8; 2]) -> Vec<f64> {
    let [columns, rows] = weights.cells.map(usize::from);
    let [to_columns, to_rows] = cells.map(usize::from);
    let field: Vec<f64> = weights.field.iter().map(|v| f64::from(*v)).collect();
    if weights.cells == cells {
        return field;
    }
    let wide: Vec<Vec<f64>> =
        field.chunks_exact(columns + 2).map(|row| resampled_row(row, to_columns)).collect();
    debug_assert_eq!(wide.len(), rows + 2);
    let upright: Vec<Vec<f64>> = (0..to_columns + 2)
        .map(|column| resampled_row(&wide.iter().map(|row| row[column]).collect::<Vec<_>>(), to_rows))
        .collect();
    (0..to_rows + 2).flat_map(|row| upright.iter().map(move |column| column[row])).collect()
}

/// A row of spline coefficients, two more than cells, over other cells.
fn resampled_row(row: &[f64], to: usize) -> Vec<f64> {
    let cells = row.len() - 2;
    let value = |position: f64| {
        let at = (position * cells as f64 / to as f64).clamp(0.0, cells as f64);
        let cell = (at as usize).min(cells - 1);
        let weights = spline((at - cell as f64) as f32);
        weights.iter().zip(&row[cell..]).map(|(w, c)| f64::from(*w) * c).sum::<f64>()
    };
    let coefficient = |k: usize| {
        let centre = k as f64 - 0.5;
        NEIGHBOUR * (value(centre - 1.0) + value(centre + 1.0)) + (1.0 - 2.0 * NEIGHBOUR) * value(centre)
    };
    (0..to + 2).map(coefficient).collect()
}

/// A warp along one axis.
struct Axis<'w> {
    warp: &'w AxisWarp,
    low: f64,
    span: f64,
    scale: Scale,
}

impl<'w> Axis<'w> {
    fn new(weights: &'w Weights, axis: usize, scale: Scale) -> Self {
        let warp = if axis == 0 { &weights.warp_x } else { &weights.warp_y };
        let (low, high) = (f64::from(weights.bounds[axis]), f64::from(weights.bounds[axis + 2]));
        Self { warp, low, span: (high - low).max(1.0), scale }
    }

    /// Where knots lie in the box, 0 to 1.
    fn positions(&self) -> impl Iterator<Item = f64> + '_ {
        self.warp.knots.iter().map(|k| (f64::from(*k) - self.low) / self.span)
    }

    /// Hinted positions at a size, in steps.
    fn hinted(&self, size: usize) -> &[i32] {
        let count = self.warp.knots.len();
        &self.warp.hinted[size * count..(size + 1) * count]
    }

    /// The hinted position of a position in the box at a size, in steps.
    fn at(&self, position: f64, size: usize) -> f64 {
        let units = self.low + position * self.span;
        let per_unit = self.scale.ppem_of(size) as f64 / f64::from(self.scale.units_per_em());
        let steps = f64::from(WARP_STEPS) * per_unit;
        let (knots, hinted) = (&self.warp.knots, self.hinted(size));
        let above = knots.partition_point(|k| f64::from(*k) <= units);
        let along = |k: usize| f64::from(hinted[k]) + (units - f64::from(knots[k])) * steps;
        match (above.checked_sub(1), knots.get(above)) {
            (None, _) => along(0),
            (Some(below), None) => along(below),
            (Some(below), Some(upper)) => {
                let lower = f64::from(knots[below]);
                let share = (units - lower) / (f64::from(*upper) - lower);
                f64::from(hinted[below]) + f64::from(hinted[above] - hinted[below]) * share
            }
        }
    }
}

fn mixed_warp([a, b]: [Axis<'_>; 2], bounds: [i16; 4], axis: usize, t: f64, snap: bool) -> AxisWarp {
    if a.warp.knots.is_empty() || b.warp.knots.is_empty() {
        return AxisWarp::default();
    }
    // Of each knot, its position in either box.
    let mut pairs: Vec<[f64; 2]> = if a.warp.knots.len() == b.warp.knots.len() {
        a.positions().zip(b.positions()).map(|(a, b)| [a, b]).collect()
    } else {
        a.positions().chain(b.positions()).map(|position| [position; 2]).collect()
    };
    pairs.sort_by(|p, q| p[0].total_cmp(&q[0]));
    let (low, high) = (f64::from(bounds[axis]), f64::from(bounds[axis + 2]));
    let unit = |pair: &[f64; 2]| (low + (pair[0] + (pair[1] - pair[0]) * t) * (high - low)).round() as i16;
    pairs.dedup_by_key(|pair| unit(pair));
    pairs.truncate(MAX_KNOTS);
    let whole = |steps: f64| steps.rem_euclid(f64::from(WARP_STEPS)) == 0.0;
    let hinted = |size: usize, [p, q]: &[f64; 2]| {
        let ends = [a.at(*p, size), b.at(*q, size)];
        let mixed = ends[0] + (ends[1] - ends[0]) * t;
        let step = f64::from(WARP_STEPS);
        let mixed = if snap && ends.into_iter().all(whole) { (mixed / step).round() * step } else { mixed };
        mixed.round() as i32
    };
    let sizes = 0..a.scale.sizes();
    AxisWarp {
        knots: pairs.iter().map(unit).collect(),
        hinted: sizes
            .flat_map(|size| pairs.iter().map(move |pair| (size, pair)))
            .map(|(s, p)| hinted(s, p))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: Scale = Scale::new(1000, 10, 11).unwrap();

    /// A model whose field rises by `slope` a cell, with three knots.
    fn model(bounds: [i16; 4], cells: u8, slope: i8, hinted: [i32; 6]) -> Weights {
        let side = i8::try_from(cells).map_or(0, |cells| cells + 2);
        let field = (0..side).flat_map(|_| (0..side).map(move |column| column * slope)).collect();
        let middle = (bounds[1] + bounds[3]) / 2;
        Weights {
            bounds,
            cells: [cells; 2],
            field,
            warp_y: AxisWarp { knots: vec![bounds[1], middle, bounds[3]], hinted: hinted.into() },
            rank: 1,
            patterns: vec![4; 64],
            embedding: vec![8, -8],
            ..Weights::default()
        }
    }

    #[test]
    fn at_its_ends_it_is_either_model() {
        let a = model([0, 0, 400, 600], 6, 4, [0, 96, 192, 0, 96, 192]);
        let b = model([0, 0, 440, 640], 6, 8, [0, 128, 224, 0, 128, 224]);
        let (first, last) =
            (interpolate_weights(&a, &b, 0.0, SCALE, false), interpolate_weights(&a, &b, 1.0, SCALE, false));
        assert_eq!((first.bounds, &first.field, &first.warp_y), (a.bounds, &a.field, &a.warp_y));
        assert_eq!((last.bounds, &last.field, &last.warp_y), (b.bounds, &b.field, &b.warp_y));
        assert_eq!((first.rank, first.embedding), (2, vec![8, 0, -8, 0]));
    }

    #[test]
    fn half_way_everything_is_the_mean_and_snapped_knots_are_whole() {
        let a = model([0, 0, 400, 600], 6, 4, [0, 96, 192, 0, 97, 192]);
        let b = model([0, 0, 440, 640], 6, 8, [0, 128, 224, 0, 128, 224]);
        let half = interpolate_weights(&a, &b, 0.5, SCALE, false);
        assert_eq!((half.bounds, half.warp_y.knots), ([0, 0, 420, 620], vec![0, 310, 620]));
        assert_eq!(half.warp_y.hinted, [0, 112, 208, 0, 113, 208]);
        assert!(half.field.iter().enumerate().all(|(k, v)| *v == (k % 8) as i8 * 6));
        let snapped = interpolate_weights(&a, &b, 0.5, SCALE, true).warp_y.hinted;
        // 3.5 and 6.5 pixels round away from 0; 97 stands on no whole pixel.
        assert_eq!(snapped, [0, 128, 224, 0, 113, 224]);
    }

    #[test]
    fn another_grid_holds_the_same_plane() {
        let (a, b) = (model([0, 0, 400, 600], 6, 0, [0; 6]), model([0, 0, 400, 600], 12, 6, [0; 6]));
        let field = resampled(&b, a.cells);
        // Cells that are twice as wide rise twice as much; coefficients outside the box are cut off.
        for row in field.chunks_exact(8) {
            let steps: Vec<f64> = row[2..6].windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(steps.iter().all(|step| (step - 12.0).abs() < 1e-4), "{steps:?}");
        }
    }

    #[test]
    fn warps_with_different_knots_are_mixed_as_functions() {
        let mut a = model([0, 0, 400, 600], 6, 4, [0, 96, 192, 0, 96, 192]);
        a.warp_y = AxisWarp { knots: vec![0, 600], hinted: vec![0, 192, 0, 192] };
        let b = model([0, 0, 400, 600], 6, 4, [0, 128, 192, 0, 128, 192]);
        let half = interpolate_weights(&a, &b, 0.5, SCALE, false);
        assert_eq!(
            half.warp_y,
            AxisWarp { knots: vec![0, 300, 600], hinted: vec![0, 112, 192, 0, 112, 192] }
        );
    }
}
