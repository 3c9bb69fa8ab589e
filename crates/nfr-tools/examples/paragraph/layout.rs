//! From a text to glyphs in lines: shaping by harfrust, lines filled word by word.

use std::error::Error;
use std::ops::Range;

use harfrust::{Buffer, Feature, ShapeOptions, ShaperFont};

/// A glyph that has ink, in a line.
#[derive(Clone, Copy)]
pub(crate) struct PositionedGlyph {
    /// Its number.
    pub(crate) gid: u16,
    /// Its origin, in font units from the start of the line.
    pub(crate) x: i32,
    /// How far it is above the baseline, in font units.
    pub(crate) y: i32,
    /// The first byte of the text that it stands for.
    pub(crate) at: usize,
}

/// A text as glyphs, not broken into lines yet.
pub(crate) struct ShapedText {
    glyphs: Vec<PositionedGlyph>,
    words: Vec<Word>,
}

/// Glyphs that stay together, and where they start and end in one long line.
struct Word {
    glyphs: Range<usize>,
    x: Range<i32>,
}

/// Shapes a text without ligatures: their glyphs have no characters, so that a font converted for characters has no
/// models of them. White space is what separates words.
pub(crate) fn shape(font: &[u8], text: &str) -> Result<ShapedText, Box<dyn Error>> {
    let font = harfrust::Font::new(font.to_vec(), 0).ok_or("harfrust cannot read the original font")?;
    let mut buffer = Buffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let plain = ["-liga", "-clig"].map(str::parse::<Feature>);
    let plain = plain.into_iter().collect::<Result<Vec<_>, _>>().map_err(|e| format!("harfrust: {e:?}"))?;
    harfrust::shape(&ShaperFont::new(&font), &mut buffer, ShapeOptions::new().features(&plain))
        .map_err(|e| format!("harfrust: {e:?}"))?;
    let (mut shaped, mut origin, mut in_word) =
        (ShapedText { glyphs: Vec::new(), words: Vec::new() }, 0, false);
    for (info, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
        let at = info.cluster as usize;
        let space = text[at..].starts_with(char::is_whitespace);
        if !space {
            let (x, y) = (origin + position.x_offset, position.y_offset);
            shaped.push(PositionedGlyph { gid: u16::try_from(info.glyph_id)?, x, y, at }, origin, in_word);
        }
        origin += position.x_advance;
        if let Some(word) = shaped.words.last_mut().filter(|_| !space) {
            word.x.end = origin;
        }
        in_word = !space;
    }
    Ok(shaped)
}

impl ShapedText {
    fn push(&mut self, glyph: PositionedGlyph, origin: i32, in_word: bool) {
        let at = self.glyphs.len();
        self.glyphs.push(glyph);
        match self.words.last_mut() {
            Some(word) if in_word => word.glyphs.end += 1,
            _ => self.words.push(Word { glyphs: at..at + 1, x: origin..origin }),
        }
    }

    /// The glyphs, in the order of the text.
    pub(crate) fn glyphs(&self) -> &[PositionedGlyph] {
        &self.glyphs
    }

    /// Lines of at most `width` font units. A word that is wider has a line of its own.
    pub(crate) fn lines(&self, width: i32) -> Vec<Vec<PositionedGlyph>> {
        let mut lines: Vec<Vec<PositionedGlyph>> = Vec::new();
        let mut start = 0;
        for word in &self.words {
            if lines.is_empty() || word.x.end - start > width {
                start = word.x.start;
                lines.push(Vec::new());
            }
            let glyphs = self.glyphs[word.glyphs.clone()].iter();
            if let Some(line) = lines.last_mut() {
                line.extend(glyphs.map(|glyph| PositionedGlyph { x: glyph.x - start, ..*glyph }));
            }
        }
        lines
    }
}
