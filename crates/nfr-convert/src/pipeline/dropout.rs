//! What the hints ask of a renderer in black and white: a mode for each size, and the glyphs that ask for another.

use std::collections::BTreeMap;

use nfr::internals::table::{Dropout, DropoutException};

use super::glyphs::Measured;
use crate::writer::{add_exception, write_dropout};

/// Appends the modes to a table that has its certificate.
pub(super) fn add_dropout(table: &mut Vec<u8>, measured: &BTreeMap<u16, Measured>) {
    let modes = measured.iter().map(|(gid, measured)| (*gid, &measured.dropout));
    let (ranges, exceptions) = modes_of_sizes(modes);
    write_dropout(table, &ranges, &exceptions);
}

/// The modes of most glyphs, in ranges of sizes, and the glyphs that have others.
fn modes_of_sizes<'m>(
    glyphs: impl Iterator<Item = (u16, &'m BTreeMap<u16, Dropout>)> + Clone,
) -> (Vec<(u16, Dropout)>, Vec<DropoutException>) {
    let mut counts: BTreeMap<u16, BTreeMap<Dropout, usize>> = BTreeMap::new();
    for (ppem, mode) in glyphs.clone().flat_map(|(_, modes)| modes) {
        *counts.entry(*ppem).or_default().entry(*mode).or_default() += 1;
    }
    let most = |modes: BTreeMap<Dropout, usize>| modes.into_iter().max_by_key(|(_, count)| *count);
    let usual: BTreeMap<u16, Dropout> =
        counts.into_iter().filter_map(|(ppem, modes)| Some((ppem, most(modes)?.0))).collect();
    let mut ranges: Vec<(u16, Dropout)> = Vec::new();
    for (&ppem, &mode) in &usual {
        match ranges.last_mut() {
            Some((last, known)) if *known == mode => *last = ppem,
            _ => ranges.push((ppem, mode)),
        }
    }
    let mut exceptions: Vec<DropoutException> = Vec::new();
    for (gid, modes) in glyphs {
        for (&ppem, &mode) in modes.iter().filter(|(ppem, mode)| usual.get(ppem) != Some(mode)) {
            add_exception(&mut exceptions, gid, ppem, mode);
        }
    }
    (ranges, exceptions)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_one_mode_are_a_range_and_glyphs_of_another_are_exceptions() {
        let [none, simple, smart] =
            [Dropout::default(), Dropout::new(false, false), Dropout::new(true, false)];
        let of = |modes: [Dropout; 4]| (8..).zip(modes).collect::<BTreeMap<u16, Dropout>>();
        let usual = of([simple, simple, smart, smart]);
        let odd = of([none, none, smart, simple]);
        let blank = BTreeMap::new();
        let glyphs = [(3, &usual), (5, &odd), (6, &blank), (9, &usual)];
        let (ranges, exceptions) = modes_of_sizes(glyphs.into_iter());
        assert_eq!(ranges, [(9, simple), (11, smart)]);
        let expected = [(8, 9, none), (11, 11, simple)]
            .map(|(first_ppem, last_ppem, mode)| DropoutException { gid: 5, first_ppem, last_ppem, mode });
        assert_eq!(exceptions, expected);
    }
}
