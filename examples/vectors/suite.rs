//! What the vectors are: which glyphs are drawn how, and how that is written down.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::thread;

use nfr::{Bitmap, DrawOptions, Error, Font, Rasterizer};

/// The fonts: `NAME.ttf`, whose vectors are in `NAME.txt`.
pub(crate) const FONTS: &[&str] = if cfg!(feature = "networks") {
    &["sans", "serif", "mono", "outline", "outline-mono", "postscript", NETWORK]
} else {
    &["sans", "serif", "mono", "outline", "outline-mono", "postscript"]
};
/// The font that has networks. Without the feature `networks` it is left out.
const NETWORK: &str = "network";
/// The file with whole bitmaps.
pub(crate) const BITMAPS: &str = "bitmaps.txt";
/// The file with a hash of many bitmaps of each glyph.
const SWEEPS: &str = "sweeps.txt";

/// Sizes at which every glyph is drawn: whole ones and ones between, and ones on both sides of each limit: 8 and 64 ppem,
/// where the training of two of the fonts begins and ends, and 25, 50 and 128 ppem, where polygons become finer.
const SIZES: [f32; 22] = [
    7.0, 7.5, 8.0, 9.0, 11.0, 12.5, 13.0, 16.0, 17.25, 24.75, 25.0, 33.3, 40.0, 49.75, 50.0, 63.0, 64.25,
    64.5, 100.0, 127.75, 128.0, 256.0,
];
/// Sizes at which every glyph is drawn with each of `OFFSETS` too.
const OFFSET_SIZES: [f32; 6] = [9.0, 12.5, 13.0, 16.0, 24.0, 40.0];
const OFFSETS: [[f32; 2]; 4] = [[0.25, 0.0], [0.5, 0.0], [0.75, 0.0], [0.25, 0.625]];
/// The largest size, at which one glyph in eight is drawn too: the more pixels an em has, the sooner a difference in the
/// last bit of a number shows in a level.
const LARGE: (f32, u32) = (2048.0, 8);
/// A sweep goes in such steps up to the last trained size, and begins so far below it.
const SWEEP: (f32, u16) = (0.25, 16);
/// What is written as a whole bitmap, from each font.
const WHOLE: [(char, f32, [f32; 2]); 5] = [
    ('8', 9.0, [0.25, 0.625]),
    ('g', 12.5, [0.0, 0.0]),
    ('é', 13.0, [0.25, 0.0]),
    ('A', 16.0, [0.5, 0.0]),
    ('@', 24.0, [0.0, 0.0]),
];

/// The most differing lines of a file that are listed.
const LISTED: usize = 5;

/// A file's name and what has to stand in it.
pub(crate) type File = (String, String);

/// A line to draw: a glyph, and how. A sweep has many sizes.
type Job = (u32, Vec<DrawOptions>);

/// What a check found.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Outcome {
    /// The lines and rows of pixels that were compared.
    pub(crate) compared: usize,
    /// What is not as it was written down, in sentences.
    pub(crate) differences: Vec<String>,
}

/// Draws the fonts of a folder and writes the vectors beside them.
///
/// # Errors
///
/// What went wrong, for a person; a build without the feature `networks`, which would lose what it cannot draw.
pub(crate) fn write(folder: &Path) -> Result<(), String> {
    if !FONTS.contains(&NETWORK) {
        return Err("to write vectors, build with --features networks".into());
    }
    for (name, text) in draw(folder, 1)? {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(())
}

/// Draws the fonts of a folder on so many threads and compares with the vectors beside them.
///
/// # Errors
///
/// A font that cannot be drawn, or a file that cannot be read. What differs is no error, it is in the outcome.
pub(crate) fn check(folder: &Path, threads: usize) -> Result<Outcome, String> {
    compare(folder, &draw(folder, threads)?)
}

/// Compares what was drawn with the vectors of a folder.
///
/// # Errors
///
/// A file that cannot be read.
pub(crate) fn compare(folder: &Path, drawn: &[File]) -> Result<Outcome, String> {
    let mut outcome = Outcome::default();
    for (name, drawn) in drawn {
        let path = folder.join(name);
        let written =
            fs::read_to_string(&path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
        let written = if name == BITMAPS { drawable(&written) } else { &written };
        outcome.compared += drawn.lines().filter(|line| !line.starts_with('#') && !line.is_empty()).count();
        compare_file(name, written, drawn, &mut outcome.differences);
    }
    Ok(outcome)
}

/// The bitmaps of fonts that are drawn; those of the networks come last.
fn drawable(bitmaps: &str) -> &str {
    let networks = bitmaps.find(&format!("\n\n{NETWORK} "));
    networks.filter(|_| !FONTS.contains(&NETWORK)).map_or(bitmaps, |at| &bitmaps[..=at])
}

/// The files with vectors, as they are drawn here and now on so many threads.
///
/// # Errors
///
/// A font that is not there or that cannot be drawn.
pub(crate) fn draw(folder: &Path, threads: usize) -> Result<Vec<File>, String> {
    let mut files = Vec::new();
    let mut bitmaps =
        "# font glyph ppem offset-x offset-y left top width height, then the rows, top row first, in hexadecimal\n"
            .to_owned();
    let mut sweeps = "# font glyph hash\n".to_owned();
    for &name in FONTS {
        let path = folder.join(format!("{name}.ttf"));
        let failed = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let data = fs::read(&path).map_err(|e| failed(&e))?;
        let font = Font::new(data).map_err(|e| failed(&e))?;
        let (vectors, sweep) = jobs(&font).map_err(|e| failed(&e))?;
        let lines = |jobs: &[Job]| lines(&font, jobs, threads).map_err(|e| failed(&e));
        let mut text = "# glyph ppem offset-x offset-y left top width height hash\n".to_owned();
        lines(&vectors)?.iter().for_each(|line| text.extend([line, "\n"]));
        lines(&sweep)?.iter().for_each(|line| sweeps.extend([name, " ", line, "\n"]));
        whole(name, &font, &mut bitmaps).map_err(|e| failed(&e))?;
        files.push((format!("{name}.txt"), text));
    }
    files.extend([(SWEEPS.into(), sweeps), (BITMAPS.into(), bitmaps)]);
    Ok(files)
}

/// The vectors of a font, and its sweeps.
fn jobs(font: &Font) -> Result<(Vec<Job>, Vec<Job>), Error> {
    let shifted = OFFSET_SIZES
        .iter()
        .flat_map(|ppem| OFFSETS.map(|offset| DrawOptions::new(*ppem).with_offset(offset)));
    let usual: Vec<DrawOptions> = SIZES.iter().map(|ppem| DrawOptions::from(*ppem)).chain(shifted).collect();
    let last = f32::from(font.ppem_range().1);
    let steps = (f32::from(SWEEP.1) / SWEEP.0) as u16;
    let sweep: Vec<DrawOptions> =
        (0..=steps).rev().map(|step| (last - f32::from(step) * SWEEP.0).into()).collect();
    let (mut vectors, mut sweeps) = (Vec::new(), Vec::new());
    for glyph in font.modelled_glyphs() {
        if let Some(sizes) = network_sizes(font, glyph)? {
            // It draws the sizes that it was trained for, and nothing between pixels.
            vectors.extend(sizes.into_iter().map(|size| (glyph, vec![size])));
            continue;
        }
        sweeps.push((glyph, sweep.clone()));
        let large = (glyph % LARGE.1 == 0).then(|| DrawOptions::from(LARGE.0));
        vectors.extend(usual.iter().copied().chain(large).map(|options| (glyph, vec![options])));
    }
    Ok((vectors, sweeps))
}

/// The sizes of a glyph's network, if a network draws it.
#[cfg(feature = "networks")]
fn network_sizes(font: &Font, glyph: u32) -> Result<Option<Vec<DrawOptions>>, Error> {
    let glyph = nfr::internals::decode(font, glyph)?;
    let sizes = |network: &nfr::internals::network::Network| {
        network.sizes().iter().map(|size| DrawOptions::from(f32::from(size.ppem))).collect()
    };
    Ok(glyph.network().map(sizes))
}

#[cfg(not(feature = "networks"))]
fn network_sizes(_: &Font, _: u32) -> Result<Option<Vec<DrawOptions>>, Error> {
    Ok(None)
}

/// What is written for some jobs, on so many threads, which share the font.
fn lines(font: &Font, jobs: &[Job], threads: usize) -> Result<Vec<String>, Error> {
    let threads = threads.max(1);
    let shares = in_threads(threads, |first| {
        let mut rasterizer = Rasterizer::new(font);
        let share = jobs.iter().skip(first).step_by(threads);
        share.map(|job| line(job, &mut rasterizer)).collect::<Result<Vec<String>, Error>>()
    })?;
    Ok((0..jobs.len()).map(|at| shares[at % threads][at / threads].clone()).collect())
}

/// What a function gives for each number below `threads`, each on a thread of its own.
fn in_threads<T: Send>(
    threads: usize,
    work: impl Fn(usize) -> Result<T, Error> + Sync,
) -> Result<Vec<T>, Error> {
    // One alone is this one: WASI has no others.
    if threads == 1 {
        return Ok(vec![work(0)?]);
    }
    thread::scope(|scope| {
        let work = &work;
        let running: Vec<_> = (0..threads).map(|number| scope.spawn(move || work(number))).collect();
        let join = |thread: thread::ScopedJoinHandle<'_, Result<T, Error>>| {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        running.into_iter().map(join).collect()
    })
}

/// What is written for a job.
fn line((glyph, sizes): &Job, rasterizer: &mut Rasterizer) -> Result<String, Error> {
    if let [options] = sizes.as_slice() {
        let bitmap = rasterizer.render(*glyph, *options)?;
        return Ok(format!("{} {:016x}", head(*glyph, *options, &bitmap), fnv1a(EMPTY_HASH, &bitmap.pixels)));
    }
    let mut hash = EMPTY_HASH;
    for options in sizes {
        hash = fnv1a(hash, rasterizer.draw(*glyph, *options)?.pixels);
    }
    Ok(format!("{glyph} {hash:016x}"))
}

/// What was drawn how, and where it lies.
fn head(glyph: u32, options: DrawOptions, bitmap: &Bitmap) -> String {
    let (ppem, [x, y]) = (options.ppem(), options.offset());
    let place = bitmap.placement;
    format!("{glyph} {ppem} {x} {y} {} {} {} {}", place.left, place.top, place.width, place.height)
}

/// The 64-bit FNV-1a hash of no bytes.
const EMPTY_HASH: u64 = 0xcbf2_9ce4_8422_2325;

/// Goes on with a 64-bit FNV-1a hash.
fn fnv1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Writes some of a font's bitmaps down, pixel by pixel.
fn whole(name: &str, font: &Font, text: &mut String) -> Result<(), Error> {
    let networks = name == NETWORK;
    // A font of networks is smaller, and draws its own sizes alone.
    let first = [('a', f32::from(font.ppem_range().0), [0.0, 0.0])];
    for (character, ppem, offset) in if networks { first.to_vec() } else { WHOLE.to_vec() } {
        let gid = font.glyph_for_char(character).ok_or(Error::NoSuchGlyph(0))?;
        let options = DrawOptions::new(ppem).with_offset(offset);
        let bitmap = Rasterizer::new(font).render(gid, options)?;
        text.extend(["\n", name, " ", &head(gid, options, &bitmap), "\n"]);
        for row in bitmap.pixels.chunks(bitmap.placement.width.max(1) as usize) {
            for (at, pixel) in row.iter().enumerate() {
                // Writing to a string cannot fail.
                let _ = write!(text, "{}{pixel:02x}", if at > 0 { " " } else { "" });
            }
            text.push('\n');
        }
    }
    Ok(())
}

/// Says where a file's lines are not those that were drawn.
fn compare_file(name: &str, written: &str, drawn: &str, differences: &mut Vec<String>) {
    let count = written.lines().count().max(drawn.lines().count());
    let [mut written, mut drawn] = [written.lines(), drawn.lines()];
    let mut wrong = 0;
    for number in 1..=count {
        let (written, drawn) = (written.next().unwrap_or("nothing"), drawn.next().unwrap_or("nothing"));
        if written != drawn {
            wrong += 1;
            if wrong <= LISTED {
                differences.push(format!("{name}:{number}: written {written}, drawn {drawn}"));
            }
        }
    }
    if wrong > LISTED {
        differences.push(format!("{name}: {} more lines differ", wrong - LISTED));
    }
}
