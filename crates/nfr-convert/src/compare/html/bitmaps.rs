//! The bitmaps of glyphs as the page carries them: for each size a stream of bytes, which gray PNG images hold, so that the browser
//! unpacks it. `page.js` reads it.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::compare::diff::Sources;
use crate::error::Error;
use nfr::Bitmap;

/// The pixels of an image's row, and the most rows of an image: browsers on phones draw no more than 16 million pixels.
const WIDTH: usize = 1024;
const MOST_ROWS: usize = 4096;
/// In place of a record: the bitmap is the hinted one. No record begins like this.
const AS_HINTED: i16 = i16::MIN;

/// The most bitmaps of a kind in a page. Beyond it, fewer sizes are taken: a page of all glyphs of a large font would not open.
const MOST_BITMAPS: usize = 60_000;

/// Those of the sizes that the page carries: all, as long as `glyphs` of them are not too many bitmaps, or else those that text is
/// most often set in, or else some of these.
pub(super) fn sizes_to_carry(sizes: &[u16], glyphs: usize) -> Vec<u16> {
    const USUAL: std::ops::RangeInclusive<u16> = 9..=24;
    let most = (MOST_BITMAPS / glyphs.max(1)).max(1);
    if sizes.len() * 4 <= most || sizes.len() <= 1 {
        return sizes.to_vec();
    }
    let mut usual: Vec<u16> = sizes.iter().copied().filter(|size| USUAL.contains(size)).collect();
    if usual.is_empty() {
        usual = sizes.to_vec();
    }
    let kept = most.min(usual.len());
    (0..kept).map(|at| usual[at * usual.len() / kept]).collect()
}

/// The images of one size, base64, for glyphs in order. Each glyph has three records, of the hinted, the neural and the unhinted bitmap:
/// left, top, width and height as numbers of two bytes, little-endian, then the coverage of each pixel, top row first. The neural
/// record is [`AS_HINTED`] alone where nothing differs.
pub(super) fn images(sources: Sources<'_>, gids: &[u16], ppem: u16) -> Result<Vec<String>, Error> {
    let (mut truth, mut neural) = (sources.truth.at(ppem)?, sources.neural.at(ppem)?);
    let mut unhinted = sources.unhinted.at(ppem)?;
    let mut stream = Vec::new();
    for &gid in gids {
        let truth = truth.bitmap(gid)?;
        let neural = neural.bitmap(gid)?;
        record(&truth, &mut stream)?;
        if neural == truth {
            stream.extend(AS_HINTED.to_le_bytes());
        } else {
            record(&neural, &mut stream)?;
        }
        record(&unhinted.bitmap(gid)?, &mut stream)?;
    }
    stream.chunks(WIDTH * MOST_ROWS).map(image).collect()
}

fn record(bitmap: &Bitmap, stream: &mut Vec<u8>) -> Result<(), Error> {
    let place = bitmap.placement;
    let too_large = || Error::LimitExceeded("a glyph is too large for the page; choose smaller sizes".into());
    for side in [place.left.into(), place.top.into(), place.width.into(), i64::from(place.height)] {
        let side = i16::try_from(side).ok().filter(|side| *side != AS_HINTED).ok_or_else(too_large)?;
        stream.extend(side.to_le_bytes());
    }
    stream.extend(&bitmap.pixels);
    Ok(())
}

/// Bytes as a PNG image, base64; the last row is filled up with zeros.
fn image(bytes: &[u8]) -> Result<String, Error> {
    let rows = bytes.len().div_ceil(WIDTH);
    let mut pixels = bytes.to_vec();
    pixels.resize(rows * WIDTH, 0);
    let mut file = Vec::new();
    // Rows are no rows of a picture: filters would not help.
    let encoder = PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::NoFilter);
    encoder
        .write_image(&pixels, WIDTH as u32, rows as u32, ExtendedColorType::L8)
        .map_err(|e| Error::LimitExceeded(format!("the bitmaps of a size cannot be written ({e})")))?;
    Ok(STANDARD.encode(file))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::compare::source::{BitmapSource, SizedSource};
    use nfr::Placement;

    /// Draws every glyph as one pixel of one level, at its number's column; a glyph of number 0 is blank.
    struct Dots(u8);

    impl BitmapSource for Dots {
        fn at(&self, _: u16) -> Result<Box<dyn SizedSource + '_>, Error> {
            Ok(Box::new(Dots(self.0)))
        }
    }

    impl SizedSource for Dots {
        fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
            if gid == 0 {
                return Ok(Bitmap::default());
            }
            let placement = Placement { left: -i32::from(gid), top: 300, width: 1, height: 1 };
            Ok(Bitmap { placement, pixels: vec![self.0] })
        }
    }

    fn unpacked(images: &[String]) -> Vec<u8> {
        let images = images.iter().map(|image| {
            let file = STANDARD.decode(image).unwrap();
            image::load_from_memory(&file).unwrap().into_luma8().into_raw()
        });
        images.flatten().collect()
    }

    #[test]
    fn a_glyph_is_three_records_and_an_equal_bitmap_is_not_repeated() {
        let (truth, other) = (Dots(7), Dots(9));
        let sources = Sources { truth: &truth, neural: &truth, unhinted: &other };
        let bytes = unpacked(&images(sources, &[0, 2], 12).unwrap());
        let dot = |level: u8| [254, 255, 44, 1, 1, 0, 1, 0, level];
        let as_hinted = [0, 128];
        let expected = [&[0; 8][..], &as_hinted, &[0; 8], &dot(7), &as_hinted, &dot(9)].concat();
        assert_eq!(bytes[..expected.len()], expected);
        assert!(bytes[expected.len()..].iter().all(|byte| *byte == 0));
    }

    #[test]
    fn no_bitmap_is_taken_for_the_mark_of_an_equal_one() {
        let (truth, other) = (Dots(7), Dots(9));
        let sources = Sources { truth: &truth, neural: &other, unhinted: &other };
        // Left sides at -1 and at the farthest.
        for gid in [1u16, 32_767] {
            let bytes = unpacked(&images(sources, &[gid], 12).unwrap());
            let left = (-i32::from(gid)) as i16;
            let dot = |level: u8| [&left.to_le_bytes()[..], &[44, 1, 1, 0, 1, 0, level]].concat();
            assert_eq!(bytes[..27], [dot(7), dot(9), dot(9)].concat());
        }
        assert!(images(sources, &[32_768], 12).is_err());
    }

    #[test]
    fn a_long_stream_is_several_images() {
        let (truth, unhinted) = (Dots(1), Dots(2));
        let sources = Sources { truth: &truth, neural: &unhinted, unhinted: &unhinted };
        let many = (1..=30_000).collect::<Vec<u16>>().repeat(6);
        let images = images(sources, &many, 12).unwrap();
        assert_eq!(images.len(), 2);
        assert_eq!(unpacked(&images)[180_000 * 27 - 1], 2);
    }

    #[test]
    fn a_page_of_many_glyphs_has_fewer_sizes() {
        let all: Vec<u16> = (8..=64).collect();
        assert_eq!(sizes_to_carry(&all, 95), all);
        assert_eq!(sizes_to_carry(&all, 2620), (9..=24).collect::<Vec<_>>());
        assert_eq!(sizes_to_carry(&all, 20_000), [9, 14, 19]);
        assert_eq!(sizes_to_carry(&all, 65_535), [9]);
        assert_eq!(sizes_to_carry(&[40, 48], 30_000), [40, 48]);
        assert_eq!(sizes_to_carry(&[70], 65_535), [70]);
    }
}
