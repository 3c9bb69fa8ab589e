//! A model's warp and deformation at a size, in double precision: what the naive twins of the renderer and of the
//! training share.

use nfr::internals::model::gridfit::{
    AxisWarp, DEFORM_NODES, EMBEDDING_STEPS, MIN_KNOT_GAP, PADDING, PATTERN_STEPS, Scale, WARP_STEPS, Weights,
};

/// A model at a size.
pub(crate) struct ModelTwin<'a> {
    pub(crate) weights: &'a Weights,
    pub(crate) scale: Scale,
    pub(crate) ppem: f64,
}

impl ModelTwin<'_> {
    pub(crate) fn em(&self, units: i16) -> f64 {
        f64::from(units) / f64::from(self.scale.units_per_em())
    }

    pub(crate) fn warp(&self, axis: usize) -> &AxisWarp {
        [&self.weights.warp_x, &self.weights.warp_y][axis]
    }

    /// The index of the nearest trained size, if it is within half a pixel per em; halves are rounded up.
    fn nearest_size(&self) -> Option<usize> {
        let off = |size: &usize| self.ppem - self.scale.ppem_of(*size) as f64;
        (0..self.scale.sizes()).find(|size| (-0.5..0.5).contains(&off(size)))
    }

    /// Unhinted (em) and hinted (pixels) knot positions. Outside of the trained sizes nothing is moved.
    pub(crate) fn knots(&self, axis: usize) -> Vec<(f64, f64)> {
        let warp = self.warp(axis);
        let mut knots: Vec<(f64, f64)> = Vec::new();
        for (k, &units) in warp.knots.iter().enumerate() {
            let unhinted = self.em(units);
            let hinted = self.nearest_size().map_or(unhinted * self.ppem, |size| {
                f64::from(warp.hinted[size * warp.knots.len() + k]) / f64::from(WARP_STEPS)
            });
            let least = knots.last().map_or(f64::NEG_INFINITY, |(_, below)| below + f64::from(MIN_KNOT_GAP));
            knots.push((unhinted, hinted.max(least)));
        }
        knots
    }

    /// The lower end of the field's grid and its length, in em.
    pub(crate) fn grid(&self, axis: usize) -> [f64; 2] {
        let [low, high] = [axis, axis + 2].map(|k| self.em(self.weights.bounds[k]));
        [low - f64::from(PADDING), high - low + 2.0 * f64::from(PADDING)]
    }

    /// How far the deformation moves an unhinted point (em) down, in pixels.
    pub(crate) fn deformation(&self, x: f64, y: f64) -> f64 {
        let Some(size) = self.nearest_size() else { return 0.0 };
        let near = |axis: usize, q: f64| {
            let [origin, span] = self.grid(axis);
            let at = ((q - origin) / span).clamp(0.0, 1.0) * (DEFORM_NODES - 1) as f64;
            let hat = move |node: usize| (node, (1.0 - (at - node as f64).abs()).max(0.0));
            let first = (at as usize).min(DEFORM_NODES - 2);
            [hat(first), hat(first + 1)]
        };
        let (columns, rows) = (near(0, x), near(1, y));
        let rank = usize::from(self.weights.rank);
        let mut sum = 0.0;
        for r in 0..rank {
            let strength = f64::from(self.weights.embedding[size * rank + r]) / f64::from(EMBEDDING_STEPS);
            for ((row, v), (column, u)) in rows.iter().flat_map(|row| columns.map(|column| (*row, column))) {
                let node = self.weights.patterns[(r * DEFORM_NODES + row) * DEFORM_NODES + column];
                sum += strength * f64::from(node) / f64::from(PATTERN_STEPS) * u * v;
            }
        }
        sum
    }
}

/// The centred quadratic B-spline.
pub(crate) fn spline(d: f64) -> f64 {
    match d.abs() {
        d if d <= 0.5 => 0.75 - d * d,
        d if d <= 1.5 => 0.5 * (1.5 - d) * (1.5 - d),
        _ => 0.0,
    }
}
