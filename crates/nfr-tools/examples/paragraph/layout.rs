//! From a text to glyphs in lines: shaping by harfrust, lines filled word by word. The text has one direction.

use std::error::Error;
use std::ops::Range;

use harfrust::{Buffer, Direction, Feature, ShapeOptions, ShaperFont};
use nfr_convert::compare::fonts::FontPair;

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
    /// From left to right.
    glyphs: Vec<PositionedGlyph>,
    /// From left to right.
    words: Vec<Word>,
    right_to_left: bool,
}

/// Glyphs that stay together, and where they start and end in one long line.
struct Word {
    glyphs: Range<usize>,
    x: Range<i32>,
}

/// Shapes a text without ligatures: their glyphs have no characters, so that a font converted for characters has no
/// models of them. White space separates words; between Chinese and Japanese characters, which have none, a line can end, too.
pub(crate) fn shape(font: &[u8], text: &str) -> Result<ShapedText, Box<dyn Error>> {
    let font = harfrust::Font::new(font.to_vec(), 0).ok_or("harfrust cannot read the original font")?;
    let mut buffer = Buffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let right_to_left = buffer.direction() == Direction::RightToLeft;
    let plain = ["-liga", "-clig"].map(str::parse::<Feature>);
    let plain = plain.into_iter().collect::<Result<Vec<_>, _>>().map_err(|e| format!("harfrust: {e:?}"))?;
    harfrust::shape(&ShaperFont::new(&font), &mut buffer, ShapeOptions::new().features(&plain))
        .map_err(|e| format!("harfrust: {e:?}"))?;
    let (mut shaped, mut origin, mut in_word) =
        (ShapedText { glyphs: Vec::new(), words: Vec::new(), right_to_left }, 0, false);
    for (info, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
        let at = info.cluster as usize;
        let space = text[at..].starts_with(char::is_whitespace);
        if !space {
            let (x, y) = (origin + position.x_offset, position.y_offset);
            let goes_on = in_word && !text[at..].starts_with(is_ideographic);
            shaped.push(PositionedGlyph { gid: u16::try_from(info.glyph_id)?, x, y, at }, origin, goes_on);
        }
        origin += position.x_advance;
        if let Some(word) = shaped.words.last_mut().filter(|_| !space) {
            word.x.end = origin;
        }
        in_word = !space;
    }
    Ok(shaped)
}

/// Names the first character that cannot be drawn.
pub(crate) fn check_models(
    pair: &FontPair<'_>,
    text: &str,
    shaped: &ShapedText,
) -> Result<(), Box<dyn Error>> {
    if shaped.glyphs().is_empty() {
        return Err("the text has nothing to draw; give another one with --text".into());
    }
    if let Some(glyph) = shaped.glyphs().iter().find(|glyph| !pair.font().has_model(glyph.gid.into())) {
        let character = text[glyph.at..].chars().next().unwrap_or_default();
        return Err(format!(
            "the character {character:?} (glyph {}) has no model; convert the font with it, or change --text",
            glyph.gid
        )
        .into());
    }
    let gids: Vec<u16> = shaped.glyphs().iter().map(|glyph| glyph.gid).collect();
    Ok(pair.check_outlines(&gids)?)
}

/// Kana, Chinese characters and full-width letters. Punctuation stays with the character before it.
fn is_ideographic(c: char) -> bool {
    matches!(c, '\u{3041}'..='\u{30FA}' | '\u{3400}'..='\u{9FFF}' | '\u{FF10}'..='\u{FF19}' | '\u{FF21}'..='\u{FF9F}')
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

    /// Lines of at most `width` font units, at the right of this width if the text runs from right to left. A word that is wider
    /// has a line of its own.
    pub(crate) fn lines(&self, width: i32) -> Vec<Vec<PositionedGlyph>> {
        let mut lines: Vec<Range<usize>> = Vec::new();
        for k in 0..self.words.len() {
            let word = if self.right_to_left { self.words.len() - 1 - k } else { k };
            match lines.last_mut() {
                Some(line) if self.width(line.start.min(word)..line.end.max(word + 1)) <= width => {
                    *line = line.start.min(word)..line.end.max(word + 1);
                }
                _ => lines.push(word..word + 1),
            }
        }
        lines.into_iter().map(|words| self.line(words, width)).collect()
    }

    /// Font units from the start of the first of these words to the end of the last.
    fn width(&self, words: Range<usize>) -> i32 {
        let words = &self.words[words];
        words.first().zip(words.last()).map_or(0, |(first, last)| last.x.end - first.x.start)
    }

    fn line(&self, words: Range<usize>, width: i32) -> Vec<PositionedGlyph> {
        let indent = if self.right_to_left { width - self.width(words.clone()) } else { 0 };
        let start = self.words[words.start].x.start - indent;
        let glyphs = self.words[words].iter().flat_map(|word| &self.glyphs[word.glyphs.clone()]);
        glyphs.map(|glyph| PositionedGlyph { x: glyph.x - start, ..*glyph }).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const DEJAVU: &[u8] = include_bytes!("../../../../fonts/DejaVuSans.ttf");

    fn text_of(line: &[PositionedGlyph], text: &str) -> String {
        line.iter().filter_map(|glyph| text[glyph.at..].chars().next()).collect()
    }

    #[test]
    fn lines_are_filled_word_by_word() {
        let shaped = shape(DEJAVU, "one two three").unwrap();
        let two = shaped.glyphs()[6];
        let lines = shaped.lines(two.x + 2000);
        let texts: Vec<String> = lines.iter().map(|line| text_of(line, "one two three")).collect();
        assert_eq!(texts, ["onetwo", "three"]);
        assert_eq!([lines[0][0].x, lines[1][0].x], [0, 0]);
    }

    #[test]
    fn a_text_from_right_to_left_begins_at_the_right_of_the_first_line() {
        let text = "سلام دنيا";
        let shaped = shape(DEJAVU, text).unwrap();
        let width = 6000;
        let lines = shaped.lines(width);
        let first: Vec<usize> = lines.iter().map(|line| line.iter().map(|g| g.at).min().unwrap()).collect();
        assert_eq!(first, [0, "سلام ".len()], "the first word is in the first line");
        let right = |line: &[PositionedGlyph]| line.last().unwrap().x;
        assert!(lines.iter().all(|line| (width / 2..width).contains(&right(line))));
    }

    #[test]
    fn a_line_ends_between_ideographs_but_not_before_their_punctuation() {
        let text = "生れながら、";
        // The font has none of these: each is the glyph of missing characters.
        let lines = shape(DEJAVU, text).unwrap().lines(1);
        let texts: Vec<String> = lines.iter().map(|line| text_of(line, text)).collect();
        assert_eq!(texts, ["生", "れ", "な", "が", "ら、"]);
    }
}
