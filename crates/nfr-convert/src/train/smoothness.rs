//! The regularisation of the field: spline coefficients that lie on the plane through their neighbours take few bits.

use burn::tensor::{Device, Tensor, TensorData};

use super::batch::Extent;
use crate::fit::Parameters;

/// 1 for each square of four coefficients within a glyph's own field, 0 where a chunk's padding is part of it:
/// `[glyphs, columns − 1, rows − 1]`.
pub(super) fn squares(parameters: &[Parameters], extent: Extent, device: &Device) -> Tensor<3> {
    let [columns, rows] = extent.coefficients.map(|c| c - 1);
    let own = |glyph: &Parameters, i: usize, j: usize| i <= glyph.cells[0] && j <= glyph.cells[1];
    let mask: Vec<f32> = parameters
        .iter()
        .flat_map(|glyph| (0..columns).flat_map(move |i| (0..rows).map(move |j| own(glyph, i, j))))
        .map(|own| if own { 1.0 } else { 0.0 })
        .collect();
    Tensor::from_data(TensorData::new(mask, [extent.glyphs, columns, rows]), device)
}

/// The distances of coefficients from the planes through three neighbours, summed over the squares of `mask` (em).
pub(super) fn roughness(field: &Tensor<3>, mask: &Tensor<3>) -> Tensor<1> {
    let [_, columns, rows] = mask.dims();
    let part = |i: usize, j: usize| field.clone().narrow(1, i, columns).narrow(2, j, rows);
    ((part(1, 1) - part(0, 1) - part(1, 0) + part(0, 0)).abs() * mask.clone()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two fields of different sizes, padded to the larger: one a plane, one with a single bump.
    #[test]
    fn planes_are_smooth_and_padding_does_not_count() {
        let glyph = |cells: [usize; 2]| Parameters { cells, ..Parameters::default() };
        let parameters = [glyph([1, 2]), glyph([3, 3])];
        let extent = Extent { glyphs: 2, sizes: 1, coefficients: [5, 5], knots: [0, 2], rank: 1 };
        let device = Device::flex();
        let mut field = vec![0.0f32; 50];
        for (i, j) in (0..3).flat_map(|i| (0..4).map(move |j| (i, j))) {
            field[i * 5 + j] = 1.0 + 0.5 * i as f32 - 0.25 * j as f32;
        }
        field[25 + 2 * 5 + 2] = 0.125;
        let field = Tensor::from_data(TensorData::new(field, [2, 5, 5]), &device);
        let rough: Vec<f32> =
            roughness(&field, &squares(&parameters, extent, &device)).into_data().iter::<f32>().collect();
        // The bump is part of four squares.
        assert_eq!(rough, [0.5]);
    }
}
