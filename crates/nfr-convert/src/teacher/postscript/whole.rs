//! Control points in whole font units, so that the curve stays where it is.
//!
//! Rounding each control point by itself moves the curve by up to half a unit, which is more than hinting's own roundings at large sizes. What
//! counts is the distance across the curve; along it points are free to move. So the control points of a cubic curve are chosen
//! together, by descent in the lattice of whole numbers.

use super::curve::{Cubic, SAMPLES, controls, derivative, differences};

/// A control point that is so near to a whole number is one.
const WHOLE: f64 = 1e-6;
/// What the distance along the curve counts beside that across it: it moves no edge, but should stay small, since hinting stretches
/// the curve.
const ALONG: f64 = 0.01;
/// A change is better if it makes the square of the distance smaller by more than this.
const LEAST_GAIN: f64 = 1e-9;

/// The control points along x and y as whole numbers, whose spline is nearer to the cubic than with any one, or any two neighbours, of
/// them moved by one unit.
pub(super) fn whole_controls(cubic: &[Cubic; 2], count: usize) -> [Vec<f64>; 2] {
    let mut lattice = Lattice::new(cubic, count);
    while lattice.improve() {}
    lattice.whole
}

/// The square of the distance of a spline from its cubic, as a function of its control points: of x and y of the first one, of the second one …
struct Lattice {
    whole: [Vec<f64>; 2],
    /// A control point on a whole number is level with a point on the curve, mostly, and stays so.
    is_fixed: Vec<[bool; 2]>,
    /// Half the second derivatives, row after row.
    curvature: Vec<f64>,
    /// Half the first derivatives at `whole`.
    slope: Vec<f64>,
}

/// A move of a control point.
type Step = (usize, [f64; 2]);

impl Lattice {
    fn new(cubic: &[Cubic; 2], count: usize) -> Self {
        let exact = cubic.each_ref().map(|axis| controls(axis, count));
        let whole = exact.each_ref().map(|axis| axis.iter().map(|v| v.round()).collect::<Vec<f64>>());
        let roundings: Vec<Step> =
            (0..count).map(|k| (k, [0, 1].map(|axis| whole[axis][k] - exact[axis][k]))).collect();
        let is_fixed = roundings.iter().map(|(_, by)| by.map(|by| by.abs() <= WHOLE)).collect();
        let size = 2 * count;
        let (mut curvature, mut slope) = (vec![0.0; size * size], vec![0.0; size]);
        let [x, y] = [0, 1].map(|axis| differences(&cubic[axis], &exact[axis]));
        let apart = x.into_iter().zip(y).map(<[f64; 2]>::from);
        for (sample, apart) in apart.enumerate() {
            let weights = weights(sample, count);
            let metric = metric(cubic, (sample + 1) as f64 / (count * SAMPLES) as f64);
            for (i, a) in &weights {
                for axis in 0..2 {
                    slope[2 * i + axis] += (0..2).map(|to| a * metric[axis][to] * apart[to]).sum::<f64>();
                    for (j, b) in &weights {
                        for to in 0..2 {
                            curvature[(2 * i + axis) * size + 2 * j + to] += a * b * metric[axis][to];
                        }
                    }
                }
            }
        }
        let mut lattice = Self { whole, is_fixed, curvature, slope };
        roundings.into_iter().for_each(|step| lattice.tilt(step));
        lattice
    }

    /// Adds to the slope what a move makes of it.
    fn tilt(&mut self, (k, by): Step) {
        let size = self.slope.len();
        for (row, slope) in self.slope.iter_mut().enumerate() {
            *slope += (0..2).map(|axis| self.curvature[row * size + 2 * k + axis] * by[axis]).sum::<f64>();
        }
    }

    /// How much moves add to the square of the distance.
    fn change(&self, steps: &[Step]) -> f64 {
        let size = self.slope.len();
        let all = || steps.iter().flat_map(|(k, by)| [0, 1].map(|axis| (2 * k + axis, by[axis])));
        all()
            .map(|(i, a)| {
                let row = &self.curvature[i * size..][..size];
                a * (2.0 * self.slope[i] + all().map(|(j, b)| row[j] * b).sum::<f64>())
            })
            .sum()
    }

    /// Moves control points to where the spline is nearer; whether there was any.
    fn improve(&mut self) -> bool {
        let mut is_better = false;
        for k in 0..self.is_fixed.len() {
            let next = if k + 1 < self.is_fixed.len() { self.steps(k + 1) } else { vec![(k, [0.0; 2])] };
            let pairs = self.steps(k).into_iter().flat_map(|own| next.iter().map(move |next| [own, *next]));
            let changes = pairs.map(|steps| (self.change(&steps), steps));
            let Some((change, steps)) = changes.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            if change < -LEAST_GAIN {
                for (k, by) in steps {
                    (0..2).for_each(|axis| self.whole[axis][k] += by[axis]);
                    self.tilt((k, by));
                }
                is_better = true;
            }
        }
        is_better
    }

    /// The moves of a control point by one unit or none along each axis.
    fn steps(&self, k: usize) -> Vec<Step> {
        let along = |axis: usize| if self.is_fixed[k][axis] { &[0.0][..] } else { &[-1.0, 0.0, 1.0] };
        along(0).iter().flat_map(|x| along(1).iter().map(move |y| (k, [*x, *y]))).collect()
    }
}

/// What each control point counts in a sample of the spline.
fn weights(sample: usize, count: usize) -> Vec<(usize, f64)> {
    let k = sample / SAMPLES;
    let u = (sample % SAMPLES + 1) as f64 / SAMPLES as f64;
    let v = 1.0 - u;
    // The ends of a quadratic curve are half-way between its control point and those beside it, or are the cubic's ends.
    let [before, after] = [v * v / 2.0, u * u / 2.0];
    let mut weights = vec![(k, 2.0 * u * v)];
    if k > 0 {
        weights[0].1 += before;
        weights.push((k - 1, before));
    }
    if k + 1 < count {
        weights[0].1 += after;
        weights.push((k + 1, after));
    }
    weights
}

/// The quadratic form of a distance from a point of the cubic: across its tangent, and a little of that along it, for a unit of its length.
fn metric(cubic: &[Cubic; 2], t: f64) -> [[f64; 2]; 2] {
    let [x, y] = cubic.each_ref().map(|axis| derivative(axis, t));
    let length = x.hypot(y).max(WHOLE);
    let mixed = (ALONG - 1.0) * x * y / length;
    [[(y * y + ALONG * x * x) / length, mixed], [mixed, (x * x + ALONG * y * y) / length]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a circle of radius 500.
    const QUARTER: [Cubic; 2] = [[0.0, 276.0, 500.0, 500.0], [500.0, 500.0, 276.0, 0.0]];

    /// The square of the distance of a spline from its cubic.
    fn squares(cubic: &[Cubic; 2], controls: &[Vec<f64>; 2]) -> f64 {
        let [x, y] = [0, 1].map(|axis| differences(&cubic[axis], &controls[axis]));
        let samples = x.len() as f64;
        let square = |(k, (x, y)): (usize, (&f64, &f64))| {
            let [[a, b], [c, d]] = metric(cubic, (k + 1) as f64 / samples);
            x * (a * x + b * y) + y * (c * x + d * y)
        };
        x.iter().zip(&y).enumerate().map(square).sum()
    }

    #[test]
    fn whole_control_points_keep_levels_and_are_nearer_than_rounded_ones() {
        let mut sums = [0.0; 2];
        for radius in 100..200 {
            let cubic = QUARTER.map(|axis| axis.map(|v| (v * f64::from(radius) / 500.0).round()));
            let rounded =
                cubic.map(|axis| controls(&axis, 3).iter().map(|v| v.round()).collect::<Vec<f64>>());
            let whole = whole_controls(&cubic, 3);
            assert!(whole.iter().flatten().all(|v| v.fract() == 0.0));
            assert_eq!([whole[1][0], whole[0][2]], [f64::from(radius); 2]);
            let exact = squares(&cubic, &cubic.map(|axis| controls(&axis, 3)));
            for (sum, controls) in sums.iter_mut().zip([&whole, &rounded]) {
                *sum += squares(&cubic, controls) - exact;
            }
        }
        assert!(sums[0] < 0.4 * sums[1], "{sums:?}");
    }

    #[test]
    fn no_neighbouring_lattice_point_is_nearer() {
        for (count, cubic) in
            [(1, QUARTER), (2, QUARTER), (5, [[0.0, 31.0, 17.0, 90.0], [0.0, 5.0, 77.0, 60.0]])]
        {
            let whole = whole_controls(&cubic, count);
            let least = squares(&cubic, &whole);
            let lattice = Lattice::new(&cubic, count);
            for k in 0..count {
                for (k, by) in lattice.steps(k) {
                    let mut moved = whole.clone();
                    (0..2).for_each(|axis| moved[axis][k] += by[axis]);
                    assert!(squares(&cubic, &moved) >= least - 1e-6, "{count} {k} {by:?}");
                }
            }
        }
    }
}
