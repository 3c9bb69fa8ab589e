//! A paragraph from the models, beside the hinted truth and the plain outlines.
//!
//! `cargo run --release --features bench --example paragraph -- NEURAL.ttf ORIGINAL.ttf OUT.png [--text TEXT] [--ppem 11,13,16,24]
//! [--width 320]`: for each size a row of three columns, black on white, one pixel for a pixel. The text is shaped with
//! its kerning; advances are the font's own, neither hinted nor rounded, and each glyph is drawn with its origin at
//! the nearest quarter of a pixel, on a baseline at a whole one.
//!
//! It prints how many glyphs a second each renderer draws: all glyphs of the paragraph one after the other, none kept,
//! the median of 15 passes. What is timed ends with the glyph's coverage in memory; blending it into the picture is not
//! part of it.

#![allow(clippy::print_stdout)]

mod ink;
mod layout;
mod renderer;

use std::error::Error;
use std::hint::black_box;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use image::GrayImage;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::ppem::PpemList;

use ink::{blank, blend, split_position};
use layout::{PositionedGlyph, ShapedText, check_models, shape};
use renderer::Renderer;

const TEXT: &str = "A page of text is where hinting shows: bars fall on whole pixels, bowls keep their height, and \
    every 'e' looks like its neighbour. In 1991, the makers of TrueType gave each glyph a program of its own; by 2007 \
    most screens had some 96 dots per inch (a few had 133), and small type was read from 9 to 16 pixels. AV, To, Wa & \
    fi: kerning matters, too - quickly judge that yourself!";

/// Pixels around and between columns.
const MARGIN: usize = 16;
/// The size of the captions, and how dark they are.
const CAPTION: (u16, u8) = (11, 150);
/// Timed passes over the paragraph, of which the median is printed.
const PASSES: usize = 15;

/// Draws a paragraph from the models, hinted, and unhinted
#[derive(Parser)]
struct Args {
    /// The neural font
    neural: PathBuf,
    /// The font that it was converted from
    original: PathBuf,
    /// The picture, a PNG file
    out: PathBuf,
    /// The text
    #[arg(long, default_value = TEXT)]
    text: String,
    /// The sizes, in pixels per em
    #[arg(long, default_value = "11,13,16,24")]
    ppem: PpemList,
    /// The width of a column in pixels
    #[arg(long, default_value_t = 320, value_parser = clap::value_parser!(u16).range(16..=8192))]
    width: u16,
}

/// A paragraph at a size, and where it lies in the picture.
struct Block {
    ppem: u16,
    lines: Vec<Vec<PositionedGlyph>>,
    top: usize,
    ascent: usize,
    line_height: usize,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    let (neural, original) = (read(&args.neural)?, read(&args.original)?);
    let pair = FontPair::open(&original, 0, &neural)?;
    let text = args.text.replace(char::is_whitespace, " ");
    let shaped = shape(&original, &text)?;
    check_models(&pair, &text, &shaped)?;
    let (blocks, height) = blocks(&pair, &shaped, args);
    let column = usize::from(args.width) + MARGIN;
    let mut picture = blank(MARGIN + 3 * column, height)?;
    for block in &blocks {
        let mut renderers = Renderer::all(&pair, block.ppem)?;
        for (k, renderer) in renderers.iter_mut().enumerate() {
            let left = (MARGIN + k * column) as i64;
            // A word that is too wide for its column ends in the margin.
            let columns = left - MARGIN as i64 / 2..left + column as i64 - MARGIN as i64 / 2;
            block.caption(&pair, renderer.name(), &mut picture, &columns, left)?;
            block.draw(&pair, renderer, &mut picture, &columns, left)?;
        }
        println!("{}", block.speed(&pair, &mut renderers)?);
    }
    picture.save(&args.out).map_err(|e| format!("cannot write {} ({e})", args.out.display()).into())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|e| format!("cannot read {} ({e})", path.display()))
}

/// The paragraph at each size, one below the other, and the height of all.
fn blocks(pair: &FontPair<'_>, shaped: &ShapedText, args: &Args) -> (Vec<Block>, usize) {
    let mut top = MARGIN;
    let blocks = args.ppem.sizes().iter().map(|&ppem| {
        let metrics = pair.font().line_metrics(ppem.into());
        let height = metrics.ascent - metrics.descent + metrics.line_gap;
        let block = Block {
            ppem,
            lines: shaped.lines(i32::from(args.width) * units_per_em(pair) / i32::from(ppem)),
            top,
            ascent: metrics.ascent.ceil() as usize,
            line_height: (height.ceil() as usize).max(1),
        };
        top += caption_height() + block.lines.len() * block.line_height + MARGIN;
        block
    });
    (blocks.collect(), top)
}

fn units_per_em(pair: &FontPair<'_>) -> i32 {
    pair.teacher().units_per_em().into()
}

/// Pixels from a block's top to its text.
fn caption_height() -> usize {
    usize::from(CAPTION.0) * 7 / 4
}

impl Block {
    /// Draws the paragraph.
    fn draw(
        &self,
        pair: &FontPair<'_>,
        renderer: &mut Renderer,
        picture: &mut GrayImage,
        columns: &Range<i64>,
        left: i64,
    ) -> Result<(), Box<dyn Error>> {
        let first = self.top + caption_height() + self.ascent;
        for (line, baseline) in self.lines.iter().zip((first..).step_by(self.line_height)) {
            let style = LineStyle { left, baseline: baseline as i64, ppem: self.ppem, darkness: 255 };
            style.draw(pair, line, renderer, picture, columns)?;
        }
        Ok(())
    }

    /// Draws the renderer's name and the size above a column, in the font itself.
    fn caption(
        &self,
        pair: &FontPair<'_>,
        name: &str,
        picture: &mut GrayImage,
        columns: &Range<i64>,
        left: i64,
    ) -> Result<(), Box<dyn Error>> {
        let (ppem, darkness) = CAPTION;
        let shaped = shape(pair.original().data().as_bytes(), &format!("{name}, {} ppem", self.ppem))?;
        let baseline = (self.top + usize::from(ppem)) as i64;
        let mut plain = Renderer::unhinted(pair, ppem)?;
        let line = shaped.lines(i32::MAX).concat();
        LineStyle { left, baseline, ppem, darkness }.draw(pair, &line, &mut plain, picture, columns)
    }

    /// How many glyphs a second each renderer draws, as a line of text.
    fn speed(&self, pair: &FontPair<'_>, renderers: &mut [Renderer]) -> Result<String, Box<dyn Error>> {
        let glyphs: Vec<(u16, f32)> = self
            .lines
            .iter()
            .flatten()
            .map(|glyph| (glyph.gid, split_position(glyph.x, self.ppem, units_per_em(pair)).1))
            .collect();
        let mut times = vec![Vec::new(); renderers.len()];
        // The first pass fills the caches.
        for pass in 0..=PASSES {
            for (renderer, times) in renderers.iter_mut().zip(&mut times) {
                let start = Instant::now();
                for &(gid, x) in black_box(&glyphs) {
                    black_box(renderer.draw(gid, x)?);
                }
                times.extend((pass > 0).then(|| start.elapsed().as_secs_f64()));
            }
        }
        let speeds = renderers.iter().zip(times).map(|(renderer, mut times)| {
            times.sort_by(f64::total_cmp);
            format!("{} {:.0}", renderer.name(), glyphs.len() as f64 / times[PASSES / 2])
        });
        let speeds: Vec<String> = speeds.collect();
        Ok(format!("{:>4} ppem, {} glyphs, glyphs/s: {}", self.ppem, glyphs.len(), speeds.join(", ")))
    }
}

/// The position, size and darkness of a line.
struct LineStyle {
    left: i64,
    baseline: i64,
    ppem: u16,
    darkness: u8,
}

impl LineStyle {
    fn draw(
        &self,
        pair: &FontPair<'_>,
        line: &[PositionedGlyph],
        renderer: &mut Renderer,
        picture: &mut GrayImage,
        columns: &Range<i64>,
    ) -> Result<(), Box<dyn Error>> {
        for glyph in line {
            let (x, offset) = split_position(glyph.x, self.ppem, units_per_em(pair));
            let (y, _) = split_position(glyph.y, self.ppem, units_per_em(pair));
            let (place, coverage) = renderer.draw(glyph.gid, offset)?;
            blend(picture, [self.left + x, self.baseline - y], &place, coverage, columns, self.darkness);
        }
        Ok(())
    }
}
