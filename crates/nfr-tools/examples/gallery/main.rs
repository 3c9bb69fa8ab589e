//! The pictures and figures of `docs/gallery`, which `docs/gallery/make` calls this for: text from the models, hinted, unhinted
//! and autohinted.
//!
//! - `page OUT.png ORIGINAL NEURAL --text TEXT`: the text at 9 to 24 pixels per em, one pixel for a pixel, in four columns; it prints how much these differ;
//! - `grid OUT.png ORIGINAL NEURAL --word WORD`: a word at 11, 13 and 16 pixels per em with enlarged pixels, in four rows;
//! - `first OUT.png ORIGINAL NEURAL ... --text TEXT --word WORD`: the same of several fonts in one picture;
//! - `figures REPORT.json ORIGINAL NEURAL --text TEXT`: errors against the hinted bitmaps, bytes and time, as cells of two
//!   Markdown tables, a line each;
//! - `name ORIGINAL NEURAL`: the font's name.
//!
//! In all four renderings the origin of a glyph is at the same place: advances are the font's own, neither hinted nor rounded, origins are
//! at the nearest quarter of a pixel, baselines at whole ones.

#![allow(clippy::print_stdout)]

#[path = "../paragraph/ink.rs"]
mod ink;
#[path = "../paragraph/layout.rs"]
mod layout;

mod autohinted;
mod columns;
mod figures;
mod grid;
mod renderer;
mod sheet;
mod typeface;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use sheet::{MARGIN, Sheet};
use typeface::FontFiles;

/// The sizes of a page, in pixels per em, and those of it that the first picture has and that are enlarged.
const PAGE_SIZES: [u16; 6] = [9, 11, 13, 16, 20, 24];
const FEW_SIZES: [u16; 3] = [11, 13, 16];
/// Lines of text at a size.
const PAGE_LINES: usize = 4;

/// Draws and measures text from the models, hinted, unhinted and autohinted
#[derive(Parser)]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Draws a text at several sizes, one pixel for a pixel
    Page {
        /// The picture, a PNG file
        out: PathBuf,
        #[command(flatten)]
        font: FontPaths,
        #[arg(long)]
        text: String,
    },
    /// Draws a word with enlarged pixels
    Grid {
        /// The picture, a PNG file
        out: PathBuf,
        #[command(flatten)]
        font: FontPaths,
        #[arg(long)]
        word: String,
    },
    /// Draws both of several fonts
    First {
        /// The picture, a PNG file
        out: PathBuf,
        /// Originals, each with the neural font made from it behind it
        #[arg(required = true, num_args = 2..)]
        fonts: Vec<PathBuf>,
        #[arg(long)]
        text: String,
        #[arg(long)]
        word: String,
    },
    /// Prints the original's full name
    Name {
        #[command(flatten)]
        font: FontPaths,
    },
    /// Prints figures over the glyphs of a text
    Figures {
        /// What `nfr-convert --report` wrote
        report: PathBuf,
        #[command(flatten)]
        font: FontPaths,
        #[arg(long)]
        text: String,
    },
}

#[derive(clap::Args)]
struct FontPaths {
    /// The hinted font
    original: PathBuf,
    /// The neural font made from it
    neural: PathBuf,
}

fn main() -> ExitCode {
    match run(&Args::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: &Command) -> Result<(), Box<dyn Error>> {
    match command {
        Command::Page { out, font, text } => {
            let files = FontFiles::read(&font.original, &font.neural)?;
            let mut sheet = Sheet::new()?;
            let top = columns::headings(&mut sheet, MARGIN)?;
            columns::draw(&mut sheet, &files.open()?, text, &PAGE_SIZES, PAGE_LINES, top)?;
            println!("{}", columns::differences(&sheet, top));
            sheet.write(out)
        }
        Command::Grid { out, font, word } => {
            let files = FontFiles::read(&font.original, &font.neural)?;
            let typeface = files.open()?;
            let cells = FEW_SIZES.map(|ppem| (&typeface, ppem, format!("{ppem} px")));
            let mut sheet = Sheet::new()?;
            grid::draw(&mut sheet, &cells, word, 6..=8, MARGIN)?;
            sheet.write(out)
        }
        Command::First { out, fonts, text, word } => {
            let files = fonts.chunks(2).map(|pair| match pair {
                [original, neural] => FontFiles::read(original, neural),
                _ => Err("pass each original with the neural font made from it".into()),
            });
            let files = files.collect::<Result<Vec<_>, _>>()?;
            let typefaces = files.iter().map(FontFiles::open).collect::<Result<Vec<_>, _>>()?;
            let mut sheet = Sheet::new()?;
            let first_row = columns::headings(&mut sheet, MARGIN)?;
            let mut top = first_row;
            for typeface in &typefaces {
                top = columns::draw(&mut sheet, typeface, text, &FEW_SIZES, 1, top)?;
            }
            println!("{}", columns::differences(&sheet, first_row));
            let cells = typefaces
                .iter()
                .zip(FEW_SIZES)
                .map(|(typeface, ppem)| Ok((typeface, ppem, format!("{}, {ppem} px", typeface.name()?))));
            let cells = cells.collect::<Result<Vec<_>, Box<dyn Error>>>()?;
            grid::draw(&mut sheet, &cells, word, 6..=6, top + MARGIN)?;
            sheet.write(out)
        }
        Command::Name { font } => {
            println!("{}", FontFiles::read(&font.original, &font.neural)?.open()?.name()?);
            Ok(())
        }
        Command::Figures { report, font, text } => {
            let files = FontFiles::read(&font.original, &font.neural)?;
            println!("{}", figures::cells(&files.open()?, text, report)?.join("\n"));
            Ok(())
        }
    }
}
