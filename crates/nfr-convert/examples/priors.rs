//! Learns the prior probabilities that glyphs are coded with, `spec/priors.txt` for fields or `spec/outline-priors.txt` for
//! outlines, from converted fonts.
//!
//! `cargo run --release --example priors -- [--outlines] FONT.nfr.ttf ... > priors.txt`. The table is part of the format: fonts that were
//! written with another one cannot be read, so this is for a new version of it. The present table comes from printable
//! ASCII (`--unicodes U+21-7E`) of the three fonts of the README's figures, half of it for the target `mono`, too, and
//! letters and digits of Roboto Medium with `--quality 15` and `85`. That of outlines comes from these, from printable ASCII of Cantarell
//! and TeX Gyre Heros, and from letters and digits of five fonts that an autohinter hinted, or IPA: Hack, Noto Sans, Noto Sans Devanagari, Noto
//! Naskh Arabic and IPAex Gothic (`--unicodes U+30-39,U+61-7A`, for the last three `U+915-925`, `U+628-63A` and
//! `U+3042-3060,U+4EBA,U+9593,U+7406`).

#![allow(clippy::print_stdout)]

use std::error::Error;

use nfr::internals::table::{TAG, Table};
use nfr_convert::cost::{learn_outline_priors, learn_priors};
use read_fonts::{FontRef, TableProvider};

fn main() -> Result<(), Box<dyn Error>> {
    let mut paths: Vec<String> = std::env::args().skip(1).collect();
    if paths.first().is_some_and(|first| first == "--outlines") {
        let fonts = paths.drain(1..).map(|path| Ok(nfr::Font::new(std::fs::read(path)?)?));
        let fonts = fonts.collect::<Result<Vec<_>, Box<dyn Error>>>()?;
        print!("{}", learn_outline_priors(&fonts)?);
        return Ok(());
    }
    let mut fonts = Vec::new();
    for path in paths {
        let data = std::fs::read(&path)?;
        let font = FontRef::new(&data)?;
        let bytes =
            font.table_data(TAG).ok_or_else(|| format!("{path} is not converted; use nfr-convert"))?;
        let table = Table::parse(bytes.as_bytes())?;
        let scale = table.header().scale(font.head()?.units_per_em()).ok_or("impossible units per em")?;
        let own = table.field_gids().map(u32::from);
        let weights = own.map(|gid| table.weights(gid, scale, usize::MAX));
        fonts.push((scale, weights.collect::<Result<Vec<_>, _>>()?));
    }
    print!("{}", learn_priors(&fonts)?);
    Ok(())
}
