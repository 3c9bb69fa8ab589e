//! The outline models of a font: messages of the table, and outlines of `glyf`.

use alloc::vec::Vec;
use core::cell::RefCell;
use core::ops::Range;

use read_fonts::tables::glyf::Glyf;
use read_fonts::tables::loca::Loca;

use super::component::Component;
use super::font::Font;
use super::glyf::{Outline, Outlines};
use super::outline::read_outline;
use super::shared_tracks::SharedTracks;
use crate::error::{Damage, Error};
use crate::limits::Limits;
use crate::model::compose::Part;
use crate::model::outline::OutlineModel;
use crate::table::MAX_PARTS;
use crate::table::context_model::ContextModel;
use crate::table::outline::{
    Advances, Known, KnownGlyph, OutlineIndex, Shared, code, code_advances, code_list, code_parts,
    code_shared, decode, decode_list, decode_parts, decode_shared, plain_parts,
};
use crate::table::range::Coder;

/// The deepest nesting of components. `maxp` allows 16; fonts have two or three.
const MAX_DEPTH: usize = 16;

/// What is kept from one glyph to the next.
#[derive(Debug, Default)]
pub(super) struct Memory {
    tracks: SharedTracks,
    /// Working memory.
    slots: Vec<u16>,
}

impl Font {
    /// Decodes the outline model of a glyph at some sizes.
    pub(super) fn outline_model(
        &self,
        glyph: u32,
        sizes: Range<usize>,
        limits: &Limits,
        memory: &mut Memory,
    ) -> Result<OutlineModel, Error> {
        let table = self.table()?;
        let (outlines, scale) = (*table.outlines(), self.scale());
        let message = outlines.glyph(glyph)?;
        let points = read_outline(self, glyph)?;
        let tracks = RefCell::new(&mut memory.tracks);
        let moves = |axis: usize, number: usize, sizes: Range<usize>, memory: &mut Vec<u16>| {
            let decode = || self.shared_moves(&outlines, axis, number, sizes.clone(), memory);
            tracks.borrow_mut().moves(axis, number, sizes.clone(), decode)
        };
        let shared = Shared { levels: outlines.levels(), moves: &moves };
        let known = Known { points: &points, advance: self.advance_units(glyph), scale, shared };
        let (weights, _) =
            decode(message, &known, sizes.clone(), &mut memory.slots).map_err(|damage| damage.of(glyph))?;
        let model = OutlineModel::new(points, weights, scale, sizes).map_err(|damage| damage.of(glyph))?;
        limits.check_decoded(glyph, model.memory())?;
        Ok(model)
    }

    /// The parts of a composed glyph, and its hinted advance widths.
    pub(super) fn outline_parts(&self, glyph: u32) -> Result<(Vec<Part>, Advances), Error> {
        let table = self.table()?;
        let outlines = table.outlines();
        let sizes = self.scale().sizes();
        let stored = self.with_known(glyph, |known| {
            decode_parts(outlines.glyph(glyph)?, known, sizes).map_err(|damage| damage.of(glyph))
        })?;
        let list = |number: u16| {
            let Some(number) = usize::from(number).checked_sub(1) else { return Ok(Vec::new()) };
            let bytes = outlines.list(number).ok_or(Damage::Malformed("has a part without offsets"))?;
            decode_list(bytes, sizes)
        };
        let part = |[x, y]: [u16; 2]| Ok::<_, Damage>([list(x)?, list(y)?]);
        let parts = stored.parts.iter().map(|stored| {
            let grid_offsets = part(stored.lists).map_err(|damage| damage.of(glyph))?;
            Ok(Part { gid: stored.gid, offset: stored.offset, grid_offsets })
        });
        Ok((parts.collect::<Result<_, Error>>()?, stored.advances))
    }

    /// The moves of a shared track at some sizes.
    fn shared_moves(
        &self,
        outlines: &OutlineIndex<'_>,
        axis: usize,
        number: usize,
        sizes: Range<usize>,
        memory: &mut Vec<u16>,
    ) -> Result<Vec<i16>, Damage> {
        let level = outlines.levels()[axis].get(number).map(|level| level.get());
        let message = level.zip(outlines.shared(axis, number));
        let (level, bytes) = message.ok_or(Damage::Malformed("has a track outside the table"))?;
        decode_shared(bytes, level, self.scale(), sizes, memory)
    }

    /// Calls `f` with what is known of a composed glyph.
    fn with_known<T>(&self, glyph: u32, f: impl FnOnce(&KnownGlyph<'_>) -> T) -> T {
        let parts = self.components(glyph).map(|parts| plain_parts(&parts));
        let advance = self.advance_units(glyph);
        let outline_hash = || {
            let points = read_outline(self, glyph).ok()?;
            Some(points.hash(advance))
        };
        f(&KnownGlyph { parts: parts.as_deref(), advance, outline_hash: &outline_hash })
    }

    /// What a composite glyph of `glyf` consists of.
    fn components(&self, glyph: u32) -> Option<Vec<Part>> {
        let (outlines, _) = self.outline_tables()?;
        parts_of(&outlines, glyph)
    }
}

/// Codes all messages of a font's outline models again, for whoever counts what they consist of. Before each of them `model`
/// forgets what it has adapted to.
///
/// # Errors
///
/// Those of damaged models.
pub fn recode_outlines<C: Coder>(font: &Font, model: &mut ContextModel<'_, C>) -> Result<(), Error> {
    let table = font.table()?;
    let (outlines, scale) = (*table.outlines(), font.scale());
    let sizes = scale.sizes();
    let shared_moves = |axis: usize, number: usize, sizes: Range<usize>, memory: &mut Vec<u16>| {
        font.shared_moves(&outlines, axis, number, sizes, memory)
    };
    let shared = Shared { levels: outlines.levels(), moves: &shared_moves };
    for glyph in table.gids().map(u32::from).filter(|glyph| outlines.find(*glyph).is_some()) {
        model.forget();
        let message = outlines.glyph(glyph)?;
        let recoded = if table.is_composed(glyph) {
            font.with_known(glyph, |known| {
                let mut stored = decode_parts(message, known, sizes)?;
                code_parts(model, &mut stored.parts, known)?;
                code_advances(model, &mut stored.advances, sizes);
                Ok(())
            })
        } else {
            let points = read_outline(font, glyph)?;
            let known = Known { points: &points, advance: font.advance_units(glyph), scale, shared };
            decode(message, &known, 0..sizes, &mut Vec::new()).and_then(|(mut weights, mut sources)| {
                code(model, &known, &mut weights, &mut sources, 0..sizes, &mut |question| {
                    question.wanted.into()
                })
            })
        };
        recoded.map_err(|damage| damage.of(glyph))?;
    }
    for (axis, levels) in outlines.levels().into_iter().enumerate() {
        for (number, level) in levels.iter().enumerate() {
            model.forget();
            let mut moves =
                shared_moves(axis, number, 0..sizes, &mut Vec::new()).map_err(|damage| damage.of(0))?;
            code_shared(model, level.get(), &mut moves, scale, 0..sizes).map_err(|damage| damage.of(0))?;
        }
    }
    for list in (0..outlines.lists()).filter_map(|number| outlines.list(number)) {
        model.forget();
        code_list(model, &mut decode_list(list, sizes).map_err(|damage| damage.of(0))?);
    }
    Ok(())
}

/// The simple glyphs that a composite glyph of `glyf` consists of, with their offsets in font units. None for a simple glyph, for
/// one whose components are scaled or attached to points, and for one that has too many or cannot be read.
pub fn components(loca: &Loca<'_>, glyf: &Glyf<'_>, glyph: u32) -> Option<Vec<Part>> {
    parts_of(&Outlines { glyf: glyf.offset_data().as_bytes(), loca: loca.clone() }, glyph)
}

fn parts_of(outlines: &Outlines<'_>, glyph: u32) -> Option<Vec<Part>> {
    if let Outline::Blank | Outline::Simple { .. } = outlines.get(glyph)? {
        return None;
    }
    let mut found = Found { parts: Vec::new(), steps: 0 };
    collect(outlines, glyph, [0; 2], MAX_DEPTH, &mut found)?;
    Some(found.parts)
}

/// The parts that are found so far.
struct Found {
    parts: Vec<Part>,
    /// The glyphs that were looked at.
    steps: usize,
}

/// The most glyphs that are looked at: empty ones are no parts.
const MAX_STEPS: usize = 256;

fn collect(
    outlines: &Outlines<'_>,
    glyph: u32,
    offset: [i16; 2],
    depth: usize,
    found: &mut Found,
) -> Option<()> {
    found.steps += 1;
    if found.steps > MAX_STEPS {
        return None;
    }
    match outlines.get(glyph)? {
        Outline::Blank => {}
        Outline::Simple { .. } if found.parts.len() < MAX_PARTS => {
            found.parts.push(Part { gid: glyph.try_into().ok()?, offset, ..Part::default() });
        }
        Outline::Simple { .. } => return None,
        Outline::Composite { bytes, .. } => {
            for component in Component::list(bytes) {
                let component = component?;
                let [x, y] = component.offset().filter(|_| !component.is_scaled())?;
                let offset = [offset[0].checked_add(x as i16)?, offset[1].checked_add(y as i16)?];
                collect(outlines, component.glyph, offset, depth.checked_sub(1)?, found)?;
            }
        }
    }
    Some(())
}
