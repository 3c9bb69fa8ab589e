//! Colours that are mixed by coverage.

use embedded_graphics::pixelcolor::{
    Bgr555, Bgr565, Bgr666, Bgr888, BinaryColor, Gray2, Gray4, Gray8, GrayColor, PixelColor, Rgb555, Rgb565,
    Rgb666, Rgb888, RgbColor,
};

/// A colour that coverage mixes with another. All colours of embedded-graphics are; implement it for a display's own.
pub trait Blend: PixelColor {
    /// Whether there are two colours only. Text is drawn in black and white then, with drop-out control, by
    /// [`nfr::Rasterizer::draw_mono`]: its coverage is 0 or 255.
    const IS_BINARY: bool = false;

    /// The colour of a pixel of this colour that text of the colour `text` covers by `coverage`/255: this one at 0, `text` at
    /// 255.
    #[must_use]
    fn blend(self, text: Self, coverage: u8) -> Self;
}

/// A channel in its own steps, to the nearest.
fn mix(ground: u8, text: u8, coverage: u8) -> u8 {
    let [ground, text, coverage] = [ground, text, coverage].map(u32::from);
    ((ground * (255 - coverage) + text * coverage + 127) / 255) as u8
}

macro_rules! blend_rgb {
    ($($colour:ty),*) => {$(
        impl Blend for $colour {
            fn blend(self, text: Self, coverage: u8) -> Self {
                Self::new(
                    mix(self.r(), text.r(), coverage),
                    mix(self.g(), text.g(), coverage),
                    mix(self.b(), text.b(), coverage),
                )
            }
        }
    )*};
}

macro_rules! blend_grey {
    ($($colour:ty),*) => {$(
        impl Blend for $colour {
            fn blend(self, text: Self, coverage: u8) -> Self {
                Self::new(mix(self.luma(), text.luma(), coverage))
            }
        }
    )*};
}

blend_rgb!(Rgb555, Rgb565, Rgb666, Rgb888, Bgr555, Bgr565, Bgr666, Bgr888);
blend_grey!(Gray2, Gray4, Gray8);

/// A pixel whose centre is inside the outline has the text's colour, and what fills the gaps of thin strokes.
impl Blend for BinaryColor {
    const IS_BINARY: bool = true;

    fn blend(self, text: Self, coverage: u8) -> Self {
        if coverage >= 128 { text } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_on_black_is_the_coverage_and_black_on_white_its_complement() {
        for coverage in 0..=255 {
            assert_eq!(Gray8::BLACK.blend(Gray8::WHITE, coverage), Gray8::new(coverage));
            assert_eq!(Gray8::WHITE.blend(Gray8::BLACK, coverage), Gray8::new(255 - coverage));
        }
    }

    #[test]
    fn channels_are_mixed_in_their_own_steps_to_the_nearest() {
        let mixed = Rgb565::new(0, 63, 31).blend(Rgb565::new(31, 0, 30), 128);
        assert_eq!(mixed, Rgb565::new(16, 31, 30));
        assert_eq!(Rgb565::BLACK.blend(Rgb565::WHITE, 255), Rgb565::WHITE);
        assert_eq!(Gray2::new(0).blend(Gray2::new(3), 127), Gray2::new(1));
    }

    #[test]
    fn two_colours_change_at_half() {
        let of = |coverage| BinaryColor::Off.blend(BinaryColor::On, coverage);
        assert_eq!((of(127), of(128)), (BinaryColor::Off, BinaryColor::On));
    }
}
