//! The sum of parts' coverage.

use nfr::internals::union;
use nfr::{Bitmap, Placement};

/// The sum of the parts' bitmaps.
pub(super) fn sum(parts: &[Bitmap]) -> Bitmap {
    let placement = parts.iter().fold(Placement::default(), |whole, part| union(whole, part.placement));
    let mut pixels = vec![0; placement.area()];
    parts.iter().for_each(|part| add(placement, &mut pixels, part.placement, &part.pixels));
    Bitmap { placement, pixels }
}

/// Adds a part's coverage to a bitmap that contains its box, saturating: parts that touch cover a pixel together, and
/// where they overlap the pixel is full.
fn add(whole: Placement, pixels: &mut [u8], place: Placement, layer: &[u8]) {
    if place.area() == 0 {
        return;
    }
    let (row, column) = ((whole.top - place.top) as usize, (place.left - whole.left) as usize);
    let (width, stride) = (place.width as usize, whole.width as usize);
    let rows = pixels.chunks_exact_mut(stride).skip(row);
    for (pixels, layer) in rows.zip(layer.chunks_exact(width)) {
        for (pixel, more) in pixels[column..column + width].iter_mut().zip(layer) {
            *pixel = pixel.saturating_add(*more);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_adds_up_to_full_and_no_further() {
        let part = |left: i32, top: i32, pixels: [u8; 4]| Bitmap {
            placement: Placement { left, top, width: 2, height: 2 },
            pixels: pixels.to_vec(),
        };
        let whole = sum(&[part(-1, 2, [10, 200, 30, 40]), part(0, 3, [1, 2, 100, 3])]);
        assert_eq!(whole.placement, Placement { left: -1, top: 3, width: 3, height: 3 });
        assert_eq!(whole.pixels, [0, 1, 2, 10, 255, 3, 30, 40, 0]);
    }
}
