//! Composite glyphs in which a program writes what a later one reads. FreeType keeps control values and storage from the program of
//! one component to that of the next, and to that of the composite glyph; skrifa gives each program those that `prep` left.
//!
//! Code that only writes can stand before a later program of the same glyph: it writes the same there. The composite glyph gets
//! components of its own, which have such code before their programs: whole programs, or what a program writes at its end.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use read_fonts::{FontRef, TableProvider};

use super::cells::{Cell, overlap};
use super::effects::Effects;
use super::follow::Sizes;
use super::functions::Functions;
use super::glyphs::Glyphs;

/// The most parts of a composite glyph, nested ones and repeated ones included, that read-fonts draws.
const MAX_PARTS: usize = 2048;
/// The deepest nesting of composite glyphs that read-fonts draws.
const MAX_DEPTH: usize = 64;
/// The most parts of all composite glyphs. No font comes near it.
const MAX_ALL_PARTS: usize = 1 << 22;
/// The most bytes of new glyphs. No font comes near it.
const MAX_NEW_BYTES: usize = 1 << 26;

/// A limit is reached.
struct TooMuch;

/// The glyphs that the copy has in place of the font's, and behind them.
#[derive(Default)]
pub(super) struct NewGlyphs {
    /// Composite glyphs with other components.
    pub(super) replaced: BTreeMap<u16, Vec<u8>>,
    /// Components with longer programs, each with the glyph whose metrics it has.
    pub(super) added: Vec<(u16, Vec<u8>)>,
    /// Composite glyphs, ascending, in which a later program reads what such code does not write.
    pub(super) uncertain: Vec<u16>,
}

/// Finds the composite glyphs that need new components.
pub(super) fn new_glyphs(font: &FontRef<'_>) -> NewGlyphs {
    let Some(mut search) = Search::of(font) else { return NewGlyphs::default() };
    for gid in 0..search.glyphs.count {
        if search.glyphs.bytes(gid).is_some_and(|data| data.first().is_some_and(|byte| byte & 0x80 != 0)) {
            search.composite(gid);
        }
    }
    search.new
}

struct Search<'a> {
    glyphs: Glyphs<'a>,
    functions: Functions<'a>,
    sizes: Sizes,
    effects: HashMap<u16, Effects>,
    /// The new components by the old ones and the glyphs whose programs stand before theirs.
    clones: HashMap<(u16, Vec<u16>), u16>,
    parts: usize,
    bytes: usize,
    new: NewGlyphs,
}

impl<'a> Search<'a> {
    fn of(font: &FontRef<'a>) -> Option<Self> {
        let maxp = font.maxp().ok()?;
        let sizes = Sizes {
            control_values: font.cvt().map_or(0, <[_]>::len),
            storage: maxp.max_storage().unwrap_or(0).into(),
            stack: maxp.max_stack_elements().unwrap_or(0).into(),
        };
        Some(Self {
            glyphs: Glyphs::of(font)?,
            functions: Functions::of(font),
            sizes,
            effects: HashMap::new(),
            clones: HashMap::new(),
            parts: 0,
            bytes: 0,
            new: NewGlyphs::default(),
        })
    }

    fn composite(&mut self, gid: u16) {
        if self.parts > MAX_ALL_PARTS {
            self.new.uncertain.push(gid);
            return;
        }
        let mut parts = Vec::new();
        let collected = self.collect(gid, 0, &mut parts);
        self.parts += parts.len();
        // read-fonts does not draw a composite glyph that is nested deeper, or has more parts.
        if collected.is_err() {
            return;
        }
        let (missed, passed) = self.what_later_programs_read(&parts);
        let done = !passed || self.renewed(gid, &[]).is_ok();
        if missed || !done {
            self.new.uncertain.push(gid);
        }
    }

    /// The parts of a glyph, and itself, in the order in which their programs run.
    fn collect(&self, gid: u16, depth: usize, parts: &mut Vec<u16>) -> Result<(), TooMuch> {
        if depth > MAX_DEPTH || parts.len() > MAX_PARTS {
            return Err(TooMuch);
        }
        let Some(glyph) = self.glyphs.get(gid) else { return Ok(()) };
        for (_, component) in &glyph.components {
            self.collect(*component, depth + 1, parts)?;
        }
        parts.push(gid);
        Ok(())
    }

    fn effects(&mut self, gid: u16) -> &Effects {
        self.effects.entry(gid).or_insert_with(|| {
            let glyph = self.glyphs.get(gid);
            let program = glyph.as_ref().map_or(&[][..], |glyph| glyph.program());
            Effects::of(program, &self.functions, self.sizes)
        })
    }

    /// Whether a program reads what no other code writes again, and whether one may read what other code does.
    fn what_later_programs_read(&mut self, parts: &[u16]) -> (bool, bool) {
        let (mut missed, mut passed) = (false, false);
        let (mut lost, mut kept) = (BTreeSet::new(), BTreeSet::new());
        for gid in parts {
            let effects = self.effects(*gid);
            missed |= overlap(&effects.reads, &lost);
            passed |= sees(effects, &kept);
            kept.extend(effects.repeated.iter().copied());
            lost.extend(effects.lost.iter().copied());
        }
        (missed, passed)
    }

    /// The glyph that stands for another one after the programs of the glyphs in `before`, which write something.
    fn renewed(&mut self, gid: u16, before: &[u16]) -> Result<u16, TooMuch> {
        let Some(glyph) = self.glyphs.get(gid) else { return Ok(gid) };
        if !glyph.is_composite() && !self.reads_from(gid, before) {
            return Ok(gid);
        }
        let key = (gid, before.to_vec());
        if let Some(known) = self.clones.get(&key) {
            return Ok(*known);
        }
        let mut writers = before.to_vec();
        let mut components = Vec::with_capacity(glyph.components.len());
        for (_, component) in &glyph.components {
            components.push(self.renewed(*component, &writers)?);
            self.add_writers(*component, &mut writers)?;
        }
        let prefix = if self.reads_from(gid, &writers) { self.prefix(&writers) } else { Vec::new() };
        let same = glyph.components.iter().map(|(_, component)| component).eq(&components);
        let renewed = if same && prefix.is_empty() {
            gid
        } else {
            let data = glyph.with(&components, &prefix).ok_or(TooMuch)?;
            self.put(gid, data, before.is_empty())?
        };
        self.clones.insert(key, renewed);
        Ok(renewed)
    }

    /// Whether a glyph's program can see what these glyphs' programs write.
    fn reads_from(&mut self, gid: u16, writers: &[u16]) -> bool {
        let mut writes = BTreeSet::new();
        for writer in writers {
            writes.extend(self.effects(*writer).repeated.iter().copied());
        }
        sees(self.effects(gid), &writes)
    }

    /// Adds the glyphs whose programs run for a glyph and write what can be written again.
    fn add_writers(&mut self, gid: u16, writers: &mut Vec<u16>) -> Result<(), TooMuch> {
        let mut parts = Vec::new();
        self.collect(gid, 0, &mut parts)?;
        for gid in parts {
            if !self.effects(gid).repeat.is_empty() {
                writers.push(gid);
            }
        }
        Ok(())
    }

    /// What writes again what the programs of these glyphs have written.
    fn prefix(&mut self, writers: &[u16]) -> Vec<u8> {
        writers.iter().flat_map(|gid| self.effects(*gid).repeat.clone()).collect()
    }

    /// Puts a glyph in place of another one, or behind all others.
    fn put(&mut self, gid: u16, data: Vec<u8>, in_place: bool) -> Result<u16, TooMuch> {
        self.bytes += data.len();
        if self.bytes > MAX_NEW_BYTES {
            return Err(TooMuch);
        }
        if in_place {
            self.new.replaced.insert(gid, data);
            return Ok(gid);
        }
        let new = usize::from(self.glyphs.count) + self.new.added.len();
        // The number of glyphs has 16 bits.
        let new = u16::try_from(new).ok().filter(|new| *new < u16::MAX).ok_or(TooMuch)?;
        self.new.added.push((gid, data));
        Ok(new)
    }
}

/// Whether something that can be seen depends on these cells in a program.
fn sees(effects: &Effects, cells: &BTreeSet<Cell>) -> bool {
    !effects.unseen && !cells.is_empty() && (!effects.complete || overlap(&effects.reads, cells))
}
