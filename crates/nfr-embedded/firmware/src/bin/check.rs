//! The vectors of spec/vectors, and flash that holds no font, half of one, or a damaged one. Exits with 0 if every bitmap is the same
//! and every piece of bad input is an error.

#![no_std]
#![no_main]

extern crate alloc;

use alloc::vec::Vec;
use core::ops::Range;

use cortex_m_semihosting::hprintln;
use nfr::{DrawOptions, Error, Font, Limits, Rasterizer};
use nfr_firmware::{FONT, exit, heap};

/// A font of spec/vectors: its name, its bytes and the lines with its hashes.
type Vectors = (&'static str, &'static [u8], &'static str);

macro_rules! vectors {
    ($($name:literal),*) => {
        &[$((
            $name,
            include_bytes!(concat!("../../../../../spec/vectors/", $name, ".ttf")),
            include_str!(concat!("../../../../../spec/vectors/", $name, ".txt")),
        )),*]
    };
}

const OUTLINES: &[Vectors] = vectors!["outline", "outline-mono", "postscript"];
#[cfg(feature = "fields")]
const FIELDS: &[Vectors] = vectors!["sans", "serif", "mono"];
#[cfg(not(feature = "fields"))]
const FIELDS: &[Vectors] = &[];

/// The lines `font glyph hash` of all fonts.
const SWEEPS: &str = include_str!("../../../../../spec/vectors/sweeps.txt");
/// A sweep is drawn at so many sizes, a quarter of a pixel apart, up to the last trained one.
const SWEEP: u16 = 65;

nfr_firmware::panics!(info => hprintln!("{}", info));

#[cortex_m_rt::entry]
fn main() -> ! {
    heap::init(heap::ALL);
    let mut good = true;
    for (name, font, lines) in OUTLINES.iter().chain(FIELDS) {
        match compare(name, font, lines) {
            Ok([compared, differing, too_large]) => {
                hprintln!(
                    "{}: {} lines, {} differ, {} not drawn: they do not fit into 16 MB",
                    name,
                    compared,
                    differing,
                    too_large
                );
                good &= compared > 0 && differing == 0;
            }
            Err(error) => {
                hprintln!("{}: {}", name, error);
                good = false;
            }
        }
    }
    good &= bad_input();
    exit(good)
}

/// The lines of a font that were compared, those that differ, and those of bitmaps that this machine has no room for.
fn compare(name: &str, bytes: &'static [u8], lines: &str) -> Result<[u32; 3], Error> {
    let font = Font::new(bytes)?;
    let mut rasterizer = Rasterizer::new(&font);
    let mut counts = [0; 2];
    let mut count = |same: Option<bool>| {
        counts[0] += 1;
        counts[1] += u32::from(same != Some(true));
    };
    let mut too_large = 0;
    for line in lines.lines().filter(|line| !line.starts_with('#')) {
        match pixels(line) {
            Some(size) if size > ROOM => too_large += 1,
            Some(size) if size > LARGE => {
                rasterizer = Rasterizer::new(&font);
                count(is_same(&mut rasterizer, line));
                rasterizer = Rasterizer::new(&font);
            }
            _ => count(is_same(&mut rasterizer, line)),
        }
    }
    for line in SWEEPS.lines() {
        if let Some((_, line)) = line.split_once(' ').filter(|(font, _)| *font == name) {
            count(is_same_sweep(&mut rasterizer, line));
        }
    }
    Ok([counts[0], counts[1], too_large])
}

/// The pixels of the largest bitmap that is sure to have room in 16 MB, in which each takes some bytes while it is drawn.
const ROOM: usize = 1 << 20;
/// From so many pixels on, a bitmap is drawn by a rasterizer of its own, which gives its buffers back.
const LARGE: usize = 1 << 17;

/// The pixels of a line's bitmap; none if the line cannot be read.
fn pixels(line: &str) -> Option<usize> {
    let mut sides = line.split(' ').skip(6).map(|side| side.parse::<usize>().ok());
    Some(sides.next()?? * sides.next()??)
}

/// Whether a line `glyph ppem offset-x offset-y left top width height hash` is what is drawn; none if it cannot be read or drawn.
fn is_same(rasterizer: &mut Rasterizer, line: &str) -> Option<bool> {
    let mut words = line.split(' ');
    let glyph = words.next()?.parse().ok()?;
    let mut number = || words.next()?.parse::<f32>().ok();
    let options = DrawOptions::new(number()?).with_offset([number()?, number()?]);
    let bitmap = rasterizer.draw(glyph, options).ok()?;
    let place = bitmap.placement;
    let written = [words.next()?, words.next()?, words.next()?, words.next()?].map(str::parse::<i64>);
    let drawn = [place.left.into(), place.top.into(), place.width.into(), place.height.into()];
    let hash = u64::from_str_radix(words.next()?, 16).ok()?;
    Some(written == drawn.map(Ok) && hash == fnv1a(EMPTY_HASH, bitmap.pixels))
}

/// The same for a line `glyph hash` of a sweep.
fn is_same_sweep(rasterizer: &mut Rasterizer, line: &str) -> Option<bool> {
    let (glyph, hash) = line.split_once(' ')?;
    let glyph = glyph.parse().ok()?;
    let last = f32::from(rasterizer.font().ppem_range().1);
    let mut drawn = EMPTY_HASH;
    for step in (0..SWEEP).rev() {
        drawn = fnv1a(drawn, rasterizer.draw(glyph, last - f32::from(step) * 0.25).ok()?.pixels);
    }
    Some(u64::from_str_radix(hash, 16).ok()? == drawn)
}

/// The 64-bit FNV-1a hash of no bytes.
const EMPTY_HASH: u64 = 0xcbf2_9ce4_8422_2325;

fn fnv1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Whether all bad input is an error.
fn bad_input() -> bool {
    let opens = |bytes: Vec<u8>| Font::new(bytes).err();
    let whole = Font::new(FONT).ok();
    let small_limit = whole.as_ref().and_then(|font| {
        let mut limits = Limits::default();
        limits.decoded_bytes = 16;
        let glyph = font.glyph_for_char('a')?;
        Rasterizer::new(font).with_limits(limits).draw(glyph, 12.0).err()
    });
    let cases: [(&str, Option<Error>, fn(&Error) -> bool); 6] = [
        ("no bytes", opens(Vec::new()), |error| *error == Error::NotAFont),
        ("erased flash", opens([0xFF; 4096].into()), |error| *error == Error::NotAFont),
        ("half a font", opens(FONT[..FONT.len() / 2].into()), |error| {
            matches!(error, Error::MalformedTable { .. } | Error::MissingTable { .. })
        }),
        ("a font without models", changed(0, b'X').and_then(opens), |error| *error == Error::NotConverted),
        ("models of another version", changed(1, 9).and_then(opens), |error| {
            matches!(error, Error::UnknownVersion { .. })
        }),
        ("a glyph beyond a limit", small_limit, |error| matches!(error, Error::DecodedTooLarge { .. })),
    ];
    let mut good = true;
    for (what, found, is_expected) in &cases {
        let is_good = found.as_ref().is_some_and(is_expected);
        match found {
            Some(error) => hprintln!("{}: {}{}", what, error, if is_good { "" } else { " (unexpected)" }),
            None => hprintln!("{}: no error", what),
        }
        good &= is_good;
    }
    let drawn = damaged();
    hprintln!("damaged models: {} of {} glyphs drawn, the others are errors", drawn[0], drawn[1]);
    good && drawn[0] < drawn[1]
}

/// The font with another byte: the first of the tag `Nfrt` in the font's directory (`place` 0), or the second of that
/// table, which is its version.
fn changed(place: usize, byte: u8) -> Option<Vec<u8>> {
    let mut bytes = FONT.to_vec();
    let entry = FONT.windows(4).position(|tag| tag == b"Nfrt")?;
    let at = match place {
        0 => entry,
        place => {
            let offset = FONT.get(entry + 8..)?.first_chunk()?;
            u32::from_be_bytes(*offset) as usize + place
        }
    };
    *bytes.get_mut(at)? = byte;
    Some(bytes)
}

/// Draws fonts of which one byte in 61 of the models is inverted, from different bytes on. A panic ends the program with an error.
fn damaged() -> [u32; 2] {
    let mut counts = [0; 2];
    let Some(models) = models() else { return counts };
    // Without them a damaged model may ask for more memory than the device has.
    let mut limits = Limits::default();
    limits.bitmap_side = 64;
    limits.decoded_bytes = 16 << 10;
    for first in 0..16 {
        let mut bytes = FONT.to_vec();
        bytes[models.clone()].iter_mut().skip(first).step_by(61).for_each(|byte| *byte = !*byte);
        let Ok(font) = Font::new(bytes) else { continue };
        let mut rasterizer = Rasterizer::new(&font).with_cache(8 << 10).with_limits(limits);
        for glyph in 0..font.glyph_count() {
            counts[0] += u32::from(rasterizer.draw(glyph, 12.0).is_ok());
            counts[1] += 1;
        }
    }
    counts
}

/// More bytes than the certificate has.
const CERTIFICATE: usize = 400;

/// Where most of the models are in the font: in its table, at the end of which is the certificate. What is damaged there is told when
/// the font is opened.
fn models() -> Option<Range<usize>> {
    let font = Font::new(FONT).ok()?;
    let length: usize = font.modelled_glyphs().filter_map(|glyph| font.model_len(glyph).ok()).sum();
    let entry = FONT.windows(4).position(|tag| tag == b"Nfrt")?;
    let number = |at: usize| Some(u32::from_be_bytes(*FONT.get(at..)?.first_chunk()?) as usize);
    let end = number(entry + 8)? + number(entry + 12)? - CERTIFICATE;
    Some(end - length..end)
}
