//! Which glyphs of a face are converted: 16 of its most frequent characters.
//!
//! A script counts if the face has at least half of its letters that are listed here. First come two digits and two signs, then
//! letters of these scripts in turn, the most frequent first. Where that gives fewer than 16 glyphs, others follow: characters of the face
//! at even distances, then glyphs by number at even distances. Glyphs without an outline are passed over.

use std::error::Error;

use read_fonts::tables::glyf::{Glyf, Glyph};
use read_fonts::tables::loca::Loca;
use read_fonts::{FontRef, TableProvider};
use serde::Serialize;
use skrifa::font::Font;

/// How many glyphs are chosen.
const GLYPHS: usize = 16;

const COMMON: &str = "02.&";

/// Letters of scripts, about in the order of their frequency in running text, with an accented letter where the script has some: it
/// is often a composite glyph.
const SCRIPTS: [&str; 32] = [
    "eaténioRgsöHlScd",
    "αοιετσνέηυρπκμλΔ",
    "оеаинтсйрвлЖкмдп",
    "աեինրոմտյկՄ",
    "יוהלארתבמש",
    "االيمنورتبة",
    "ܐܘܢܝܠܡ",
    "ދހށނރބ",
    "ߊߞߟߓߡߣ",
    "करनसतमपलहयआ",
    "করনসতমপলহযআ",
    "ਕਰਨਸਤਮਪਲਹ",
    "કરનસતમપલહયઆ",
    "କରନସତମପଲହ",
    "கதபமனரலவயந",
    "కరనసతమపలవయ",
    "ಕರನಸತಮಪಲವಯ",
    "കരനസതമപലവയ",
    "නයවකරමතසලප",
    "นารกงมอยลวสด",
    "ນາລກງມອຍວສດ",
    "ངསདབགརམལནཔ",
    "ကတနမသရအလပယ",
    "აიესრნმდოლ",
    "በነተለየአመከረወ",
    "កតនមសរបលវយ",
    "ᎠᎡᎢᏂᎳᏗ",
    "ᐊᐃᓂᑕᒥᓄ",
    "ꦲꦤꦕꦫꦏ",
    "이다는에의가고을하지",
    "のにはをたがでとイン",
    "的一是不了人在有我國永",
];

/// A glyph, and the character that it was chosen for.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Chosen {
    pub(crate) gid: u16,
    pub(crate) character: Option<char>,
}

/// Chooses the glyphs of a face.
pub(crate) fn choose(font: &FontRef<'_>) -> Result<Vec<Chosen>, Box<dyn Error>> {
    // Without TrueType outlines every choice is refused alike.
    let (Ok(loca), Ok(glyf)) = (font.loca(None), font.glyf()) else {
        return Ok(vec![Chosen { gid: 0, character: None }]);
    };
    let mapped = mapped(font)?;
    let find = |c: char| {
        let at = mapped.binary_search_by_key(&Some(c), |chosen| chosen.character).ok()?;
        Some(mapped[at])
    };
    let mut choice = Choice { loca, glyf, chosen: Vec::new() };
    choice.add(COMMON.chars().filter_map(find));
    choice.add(in_turn(find).into_iter());
    choice.add(evenly_spread(&mapped).into_iter());
    let all: Vec<_> = (0..font.maxp()?.num_glyphs()).map(|gid| Chosen { gid, character: None }).collect();
    choice.add(evenly_spread(&all).into_iter());
    Ok(choice.chosen)
}

/// The characters of the face, ascending.
fn mapped(font: &FontRef<'_>) -> Result<Vec<Chosen>, Box<dyn Error>> {
    let index = font.ttc_index().unwrap_or(0);
    let copy = Font::new(font.data().as_bytes().to_vec(), index).ok_or("skrifa does not open the font")?;
    let glyph = |(code, gid): (u32, skrifa::GlyphId)| {
        Some(Chosen { gid: u16::try_from(gid.to_u32()).ok()?, character: Some(char::from_u32(code)?) })
    };
    let mut mapped: Vec<Chosen> = copy.charmap().unicodes().filter_map(glyph).collect();
    mapped.sort_unstable_by_key(|chosen| chosen.character);
    mapped.dedup_by_key(|chosen| chosen.character);
    Ok(mapped)
}

/// Letters of the face's scripts in turn.
fn in_turn(find: impl Fn(char) -> Option<Chosen>) -> Vec<Chosen> {
    let found = SCRIPTS.map(|letters| (letters.chars().count(), letters.chars().filter_map(&find).collect()));
    let scripts: Vec<Vec<Chosen>> = found
        .into_iter()
        .filter(|(count, found): &(_, Vec<_>)| 2 * found.len() >= *count)
        .map(|(_, f)| f)
        .collect();
    let longest = scripts.iter().map(Vec::len).max().unwrap_or(0);
    (0..longest).flat_map(|at| scripts.iter().filter_map(move |script| script.get(at).copied())).collect()
}

/// All of them, those at even distances first.
fn evenly_spread(all: &[Chosen]) -> Vec<Chosen> {
    let step = (all.len() / GLYPHS).max(1);
    let even = all.iter().step_by(step).copied();
    even.chain(all.iter().copied()).collect()
}

struct Choice<'f> {
    loca: Loca<'f>,
    glyf: Glyf<'f>,
    chosen: Vec<Chosen>,
}

impl Choice<'_> {
    /// Adds glyphs that have outlines and are not there yet, until there are enough.
    fn add(&mut self, candidates: impl Iterator<Item = Chosen>) {
        for candidate in candidates {
            if self.chosen.len() == GLYPHS {
                return;
            }
            let is_new = self.chosen.iter().all(|chosen| chosen.gid != candidate.gid);
            if is_new && self.has_outline(candidate.gid) {
                self.chosen.push(candidate);
            }
        }
    }

    /// Whether a glyph has contours or parts. A damaged one counts: the converter has to cope with it.
    fn has_outline(&self, gid: u16) -> bool {
        match self.loca.get_glyf(gid.into(), &self.glyf) {
            Ok(Some(Glyph::Simple(simple))) => simple.number_of_contours() > 0,
            Ok(Some(Glyph::Composite(_))) | Err(_) => true,
            Ok(None) => false,
        }
    }
}
