//! Whatever a font file says, converting it ends soon, in bounded memory, with a font or an error.
#![allow(clippy::unwrap_used)]

mod samples;

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use nfr_convert::random::SplitMix64;
use nfr_convert::{Options, Shape, convert};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;

use samples::{FONTS, Silent, font, gid, gids};

/// The whole of a test takes seconds; a case that takes so long hangs.
const PATIENCE: Duration = Duration::from_secs(90);
/// More than any of these conversions needs: fonts of 0.8 MB, a few glyphs, three sizes.
const MOST_MEMORY: u64 = 1 << 30;

/// A file, its name for messages, and the glyphs to convert.
struct Case {
    name: String,
    data: Vec<u8>,
    gids: Vec<u16>,
}

/// Converts all cases on two threads. A panic, a case that does not end, and too much memory fail the test. Returns how many gave a font.
fn survive(cases: Vec<Case>) -> usize {
    let (cases, next) = (Arc::new(cases), Arc::new(AtomicUsize::new(0)));
    let running = Arc::new(Mutex::new(BTreeSet::new()));
    let (sender, receiver) = channel();
    for _ in 0..2 {
        let (cases, next, running, sender) = (cases.clone(), next.clone(), running.clone(), sender.clone());
        thread::spawn(move || {
            while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                running.lock().unwrap().insert(case.name.clone());
                let options = Options {
                    gids: case.gids.clone(),
                    ppem: 9..=11,
                    shape: Shape::Outline,
                    ..Options::default()
                };
                let result = catch_unwind(AssertUnwindSafe(|| convert(&case.data, &options, &Silent)));
                running.lock().unwrap().remove(&case.name);
                sender.send((case.name.clone(), result.map(|converted| converted.map(|c| c.font)))).unwrap();
            }
        });
    }
    drop(sender);
    let (mut converted, mut panics) = (0, Vec::new());
    for _ in 0..cases.len() {
        let Ok((name, result)) = receiver.recv_timeout(PATIENCE) else {
            panic!("these do not end: {:?}", running.lock().unwrap());
        };
        match result {
            Err(_) => panics.push(name),
            Ok(Ok(font)) => {
                assert!(nfr::Font::new(font).is_ok(), "{name}: the result does not open");
                converted += 1;
            }
            Ok(Err(error)) => assert!(error.to_string().len() < 2000, "{name}: {error}"),
        }
    }
    assert!(panics.is_empty(), "these panic: {panics:?}");
    if let Some(peak) = peak_memory() {
        assert!(peak < MOST_MEMORY, "{peak} bytes of memory");
    }
    converted
}

/// The most memory that this process has had, where Linux tells it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}

fn table(font: &[u8], tag: &[u8; 4]) -> Vec<u8> {
    FontRef::new(font).unwrap().table_data(Tag::new(tag)).unwrap().as_bytes().to_vec()
}

/// The font with some tables replaced.
fn with(font: &[u8], tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut builder = FontBuilder::new();
    for (tag, bytes) in tables {
        builder.add_raw(Tag::new(tag), bytes.clone());
    }
    builder.copy_missing_tables(FontRef::new(font).unwrap());
    builder.build()
}

#[test]
fn damaged_fonts_are_converted_or_refused() {
    const TABLES: [&[u8; 4]; 12] = [
        b"glyf", b"loca", b"maxp", b"cvt ", b"fpgm", b"prep", b"hmtx", b"head", b"hhea", b"cmap", b"post",
        b"OS/2",
    ];
    let fonts = FONTS.map(font);
    let mut random = SplitMix64::new(7);
    let mut below = |limit: usize| (random.next_u64() % limit.max(1) as u64) as usize;
    let mut cases = Vec::new();
    for number in 0..900 {
        let original = &fonts[number % fonts.len()];
        let mut data = original.clone();
        let mut gids = gids(original, "aé%");
        // Three of four cases damage a table, and one the directory.
        let tag = TABLES[number / 3 % TABLES.len()];
        let file = FontRef::new(original).unwrap();
        let record =
            file.table_directory().table_records().iter().find(|r| r.tag() == Tag::new(tag)).unwrap();
        let (mut start, mut length) = (record.offset() as usize, record.length() as usize);
        if number % 4 == 3 {
            (start, length) = (12, 16 * file.table_directory().table_records().len());
        } else if tag == b"glyf" {
            // The glyphs that are converted, not others.
            let loca = file.loca(None).unwrap();
            let at = |gid: u16| loca.get_raw(gid.into()).unwrap() as usize;
            let chosen = gids[below(gids.len())];
            (start, length) = (start + at(chosen), at(chosen + 1) - at(chosen));
        } else if tag == b"loca" {
            gids = (0..8).map(|k| k * 5).collect();
            length = length.min(200);
        }
        for _ in 0..1 + below(8) {
            let at = start + below(length);
            data[at] = [0, 0xff, 0x7f, 0x80, data[at] ^ (1 << below(8))][below(5)];
        }
        cases.push(Case { name: format!("case {number}, {}", String::from_utf8_lossy(tag)), data, gids });
    }
    let count = cases.len();
    let converted = survive(cases);
    // Some damage does no harm, and some is found.
    assert!((60..count - 60).contains(&converted), "{converted} of {count} are converted");
}

/// `glyf` and `loca` of a font whose glyph `gid` has other bytes.
fn with_glyph(font: &[u8], gid: u16, glyph: &[u8]) -> Vec<u8> {
    with_glyphs(font, &[(gid, glyph.to_vec())])
}

fn with_glyphs(font: &[u8], changed: &[(u16, Vec<u8>)]) -> Vec<u8> {
    let file = FontRef::new(font).unwrap();
    let (loca, old) = (file.loca(None).unwrap(), table(font, b"glyf"));
    let (mut glyf, mut offsets) = (Vec::new(), vec![0u32]);
    for gid in 0..file.maxp().unwrap().num_glyphs() {
        let at = |gid: u32| loca.get_raw(gid as usize).unwrap() as usize;
        let bytes = changed.iter().find(|(g, _)| *g == gid).map(|(_, bytes)| bytes.as_slice());
        glyf.extend(bytes.unwrap_or(&old[at(gid.into())..at(u32::from(gid) + 1)]));
        glyf.resize(glyf.len().next_multiple_of(4), 0);
        offsets.push(glyf.len() as u32);
    }
    let mut head = table(font, b"head");
    // OpenType 1.9, "head": indexToLocFormat.
    head[51] = 1;
    let loca = offsets.iter().flat_map(|offset| offset.to_be_bytes()).collect();
    with(font, &[(b"glyf", glyf), (b"loca", loca), (b"head", head)])
}

/// A composite glyph of parts at an offset (OpenType 1.9, "glyf": arguments are words and offsets).
fn composite(parts: &[u16]) -> Vec<u8> {
    let mut bytes = vec![0xff, 0xff, 0, 0, 0, 0, 0, 0, 0, 0];
    for (k, part) in parts.iter().enumerate() {
        bytes.extend([0, if k + 1 < parts.len() { 0x23 } else { 0x03 }]);
        bytes.extend(part.to_be_bytes());
        bytes.extend([0, 1, 0, 1]);
    }
    bytes
}

/// A triangle with a program.
fn simple(points: [i16; 6], program: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0, 1];
    bytes.extend([0u8; 8]);
    bytes.extend([0, 2]);
    bytes.extend((program.len() as u16).to_be_bytes());
    bytes.extend(program);
    bytes.extend([1, 1, 1]);
    let (mut x, mut y) = (0i16, 0i16);
    let (mut xs, mut ys) = (Vec::new(), Vec::new());
    for point in points.chunks(2) {
        xs.extend(point[0].wrapping_sub(x).to_be_bytes());
        ys.extend(point[1].wrapping_sub(y).to_be_bytes());
        (x, y) = (point[0], point[1]);
    }
    [bytes, xs, ys].concat()
}

#[test]
fn absurd_fonts_are_converted_or_refused() {
    let sans = font("LiberationSans-Regular");
    let a = gid(&sans, 'a');
    // PUSHW[0] -3, JMPR: back to the push. PUSHW 0x7fff, PUSHB 0, LOOPCALL, and the function calls itself.
    let endless: &[u8] = &[0xb8, 0xff, 0xfd, 0x1c];
    let recursive: &[u8] = &[0xb0, 0, 0x2c, 0xb8, 0x7f, 0xff, 0xb0, 0, 0x2a, 0x2d, 0xb0, 0, 0x2b];
    let triangle = [0, 0, 1000, 0, 0, 1000];
    let extreme = [-32768, -32768, 32767, -32768, 0, 32767];
    let maxp = |change: &dyn Fn(&mut [u8])| {
        let mut bytes = table(&sans, b"maxp");
        change(&mut bytes);
        with(&sans, &[(b"maxp", bytes)])
    };
    let units = |units: u16| {
        let mut head = table(&sans, b"head");
        head[18..20].copy_from_slice(&units.to_be_bytes());
        with(&sans, &[(b"head", head)])
    };
    // Each glyph is the one before it, eight times: 8^30 points.
    let bomb: Vec<(u16, Vec<u8>)> = (1..=30).map(|k| (100 + k, composite(&[99 + k; 8]))).collect();
    // A chain that is as long as the font.
    let chain: Vec<(u16, Vec<u8>)> = (1..2500).map(|k| (100 + k, composite(&[99 + k]))).collect();
    let record = |index: usize, field: usize, value: u32| {
        let mut data = sans.clone();
        data[12 + 16 * index + field..][..4].copy_from_slice(&value.to_be_bytes());
        data
    };
    let mut many_contours = vec![0x7f, 0xff];
    many_contours.extend([0u8; 8]);
    many_contours.extend((0..0x7fffu16).flat_map(|end| end.to_be_bytes()));
    many_contours.extend([0, 0]);
    let mut fonts = vec![
        ("65,535 glyphs in maxp", maxp(&|m| m[4..6].fill(0xff)), a),
        ("no glyph in maxp", maxp(&|m| m[4..6].fill(0)), a),
        ("every limit in maxp at its most", maxp(&|m| m[6..].fill(0xff)), a),
        ("every limit in maxp 0", maxp(&|m| m[6..].fill(0)), a),
        ("maxp cut off", with(&sans, &[(b"maxp", table(&sans, b"maxp")[..5].to_vec())]), a),
        ("16 units per em", units(16), a),
        ("16,384 units per em", units(16384), a),
        ("an endless fpgm", with(&sans, &[(b"fpgm", endless.to_vec())]), a),
        ("an endless prep", with(&sans, &[(b"prep", endless.to_vec())]), a),
        ("an endless glyph program", with_glyph(&sans, a, &simple(triangle, endless)), a),
        ("a function that calls itself", with(&sans, &[(b"fpgm", recursive.to_vec())]), a),
        ("a glyph that is its own part", with_glyph(&sans, a, &composite(&[a])), a),
        (
            "two glyphs that are parts of each other",
            with_glyphs(&sans, &[(a, composite(&[a + 1])), (a + 1, composite(&[a]))]),
            a,
        ),
        ("a composite of a missing glyph", with_glyph(&sans, a, &composite(&[65_000])), a),
        ("a composite that doubles at every level", with_glyphs(&sans, &bomb), 130),
        ("a chain of composites", with_glyphs(&sans, &chain), 2599),
        ("a composite of very many parts", with_glyph(&sans, a, &composite(&[a + 1; 4000])), a),
        ("points at the limits", with_glyph(&sans, a, &simple(extreme, &[0xb0, 0, 0x21])), a),
        ("32,767 contours without points", with_glyph(&sans, a, &many_contours), a),
        (
            "loca backwards",
            with(&sans, &[(b"loca", table(&sans, b"loca").chunks(2).rev().flatten().copied().collect())]),
            a,
        ),
        ("loca empty", with(&sans, &[(b"loca", Vec::new())]), a),
        ("hmtx empty", with(&sans, &[(b"hmtx", Vec::new())]), a),
        ("cvt of one byte", with(&sans, &[(b"cvt ", vec![1])]), a),
    ];
    for index in 0..FontRef::new(&sans).unwrap().table_directory().table_records().len() {
        fonts.push(("a table longer than the file", record(index, 12, u32::MAX), a));
        fonts.push(("a table at the start of the file", record(index, 8, 0), a));
        fonts.push(("a table without bytes", record(index, 12, 0), a));
    }
    let case = |(number, (name, data, gid)): (usize, (&str, Vec<u8>, u16))| Case {
        name: format!("{name} ({number})"),
        data,
        gids: vec![gid],
    };
    survive(fonts.into_iter().enumerate().map(case).collect());
}
