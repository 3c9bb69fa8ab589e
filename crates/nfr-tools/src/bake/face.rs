//! What bitmap formats say of a font as a whole: its names, its style, and which character each glyph stands for.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use nfr::Font;
use nfr_convert::select::{GlyphIds, GlyphNames, Selection, glyph_names};
use read_fonts::tables::name::NameRecord;
use read_fonts::tables::os2::SelectionFlags;
use read_fonts::types::NameId;
use read_fonts::{FontRef, TableProvider};

use crate::failure::Failure;

/// The weight class from which a font counts as bold (OpenType 1.9, "OS/2", usWeightClass).
const SEMI_BOLD: u16 = 600;

/// A font, and what is taken of it.
#[derive(Debug, Default)]
pub(super) struct Face {
    /// `Liberation Sans`.
    pub(super) family: String,
    /// `Liberation Sans Bold`.
    pub(super) full_name: String,
    pub(super) copyright: Option<String>,
    pub(super) is_bold: bool,
    pub(super) is_italic: bool,
    pub(super) is_monospaced: bool,
    /// The glyphs that are taken, ascending.
    pub(super) gids: Vec<u16>,
    /// Their characters, ascending.
    pub(super) characters: BTreeMap<u32, u16>,
    by_glyph: HashMap<u16, Vec<u32>>,
    names: HashMap<u16, String>,
}

impl Face {
    /// Reads names and characters. A glyph that is selected by a character stands for the selected characters only, others for all that
    /// the font has for them.
    pub(super) fn new(
        file: &FontRef<'_>,
        font: &Font,
        selection: &Selection,
        gids: Vec<u16>,
    ) -> Result<Self, Failure> {
        let os2 = file.os2().ok();
        let selected = os2.as_ref().map(|os2| os2.fs_selection()).unwrap_or_default();
        let characters = characters(file, font, selection, &gids)?;
        let mut by_glyph: HashMap<u16, Vec<u32>> = HashMap::new();
        for (code, gid) in &characters {
            by_glyph.entry(*gid).or_default().push(*code);
        }
        let family = name(file, NameId::FAMILY_NAME).unwrap_or_else(|| "Unnamed".into());
        Ok(Self {
            full_name: name(file, NameId::FULL_NAME).unwrap_or_else(|| family.clone()),
            family,
            copyright: name(file, NameId::COPYRIGHT_NOTICE),
            is_bold: os2.is_some_and(|os2| os2.us_weight_class() >= SEMI_BOLD),
            is_italic: selected.contains(SelectionFlags::ITALIC),
            is_monospaced: file.post().is_ok_and(|post| post.is_fixed_pitch() != 0),
            characters,
            by_glyph,
            names: glyph_names(file)?,
            gids,
        })
    }

    /// The characters of a glyph, ascending.
    pub(super) fn characters_of(&self, gid: u16) -> &[u32] {
        self.by_glyph.get(&gid).map_or(&[], Vec::as_slice)
    }

    /// The name of a glyph in `post`.
    pub(super) fn glyph_name(&self, gid: u16) -> Option<&str> {
        self.names.get(&gid).map(String::as_str)
    }

    /// A glyph for messages: `glyph 36 (A)`.
    pub(super) fn title(&self, gid: u16) -> String {
        match self.glyph_name(gid) {
            Some(name) => format!("glyph {gid} ({name})"),
            None => format!("glyph {gid}"),
        }
    }
}

fn characters(
    file: &FontRef<'_>,
    font: &Font,
    selection: &Selection,
    gids: &[u16],
) -> Result<BTreeMap<u32, u16>, Failure> {
    let taken = |gid: u32| u16::try_from(gid).ok().filter(|gid| gids.binary_search(gid).is_ok());
    let all = font.characters().filter_map(|(character, gid)| Some((u32::from(character), taken(gid)?)));
    if selection.is_empty() {
        return Ok(all.collect());
    }
    let GlyphIds(by_number) = &selection.gids;
    let GlyphNames(by_name) = &selection.names;
    let numbered: BTreeSet<u16> = if by_number.is_empty() && by_name.is_empty() {
        BTreeSet::new()
    } else {
        let numbered = Selection { text: None, unicodes: Default::default(), ..selection.clone() };
        numbered.resolve(file, [])?.gids.into_iter().collect()
    };
    let written: BTreeSet<u32> = selection.characters().map(u32::from).collect();
    let is_selected = |(code, gid): &(u32, u16)| {
        written.contains(code)
            || selection.unicodes.0.iter().any(|range| range.contains(code))
            || numbered.contains(gid)
    };
    Ok(all.filter(is_selected).collect())
}

/// A string of the `name` table, in the first language that can be read.
fn name(file: &FontRef<'_>, id: NameId) -> Option<String> {
    let table = file.name().ok()?;
    let read = |record: &NameRecord| Some(record.string(table.string_data()).ok()?.to_string());
    let mut records = table.name_record().iter().filter(|record| record.name_id() == id);
    records.find_map(read).filter(|text| !text.is_empty())
}
