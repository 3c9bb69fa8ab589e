//! The size and the colours of text.

use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::text::renderer::CharacterStyle;
use embedded_graphics::text::{Baseline, DecorationColor};

use crate::face::{Face, is_size, rounded};

/// How text is drawn: by which face, in which size and which colours. It is copied freely.
#[derive(Debug, Clone, Copy)]
pub struct Style<'a, C> {
    pub(crate) face: &'a Face,
    pub(crate) ppem: f32,
    pub(crate) text: Option<C>,
    pub(crate) ground: C,
    pub(crate) background: Option<C>,
    pub(crate) underline: DecorationColor<C>,
    pub(crate) strikethrough: DecorationColor<C>,
}

impl Face {
    /// A style: text of a size in pixels per em and of a colour, on a background of the colour `ground`, which is not drawn.
    pub fn style<C>(&self, ppem: f32, text: C, ground: C) -> Style<'_, C> {
        Style::new(self, ppem, text, ground)
    }
}

impl<'a, C> Style<'a, C> {
    /// Text of a size in pixels per em and of a colour. Partly covered pixels are mixed with the colour `ground`, which should be
    /// that of the display there; pixels that are not covered stay as they are.
    ///
    /// A size that is not above 0 and at most [`nfr::DrawOptions::MAX_PPEM`] draws nothing and is a [`Face::problem`].
    pub fn new(face: &'a Face, ppem: f32, text: C, ground: C) -> Self {
        let (underline, strikethrough) = (DecorationColor::None, DecorationColor::None);
        Self { face, ppem, text: Some(text), ground, background: None, underline, strikethrough }
    }

    /// Fills the lines of the text with a colour, from the ascent to the descent, which partly covered pixels are then mixed with.
    #[must_use]
    pub fn with_background(self, colour: C) -> Self {
        Self { background: Some(colour), ..self }
    }

    /// Underlines the text, where the font's `post` table says, in the text's colour.
    #[must_use]
    pub fn with_underline(self) -> Self {
        Self { underline: DecorationColor::TextColor, ..self }
    }

    /// Strikes the text through, 0.26 em above the baseline, in the text's colour.
    #[must_use]
    pub fn with_strikethrough(self) -> Self {
        Self { strikethrough: DecorationColor::TextColor, ..self }
    }

    /// The measures of a line.
    pub(crate) fn line(&self) -> Line {
        if !is_size(self.ppem) {
            return Line::default();
        }
        let metrics = self.face.font().line_metrics(self.ppem);
        let [ascent, descent] = [rounded(metrics.ascent), rounded(-metrics.descent)];
        Line {
            ascent,
            height: (ascent + descent).max(0) as u32,
            gap: rounded(metrics.line_gap).max(0) as u32,
            underline: ascent + rounded(-metrics.underline_position),
            strikethrough: ascent - rounded(STRIKETHROUGH * self.ppem),
            thickness: rounded(metrics.underline_thickness).max(1) as u32,
        }
    }
}

/// Where text is struck through, in em above the baseline: about half the height of lower case letters.
const STRIKETHROUGH: f32 = 0.26;

/// Measures of a line in pixels, from its top downwards.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Line {
    /// From the top to the baseline.
    pub(crate) ascent: i32,
    /// From the top to the bottom.
    pub(crate) height: u32,
    /// From the bottom to the next line's top.
    pub(crate) gap: u32,
    pub(crate) underline: i32,
    pub(crate) strikethrough: i32,
    /// Of both strokes.
    pub(crate) thickness: u32,
}

impl Line {
    /// How far the position of text lies below the top, as in embedded-graphics' own fonts: an alphabetic position is the row
    /// above the baseline, on which letters stand.
    pub(crate) fn offset(&self, baseline: Baseline) -> i32 {
        let last = self.height.saturating_sub(1) as i32;
        match baseline {
            Baseline::Top => 0,
            Baseline::Bottom => last,
            Baseline::Middle => last / 2,
            Baseline::Alphabetic => self.ascent - i32::from(self.height > 0),
        }
    }
}

impl<C: PixelColor> CharacterStyle for Style<'_, C> {
    type Color = C;

    /// Without a colour the text is not drawn, only its background and decorations.
    fn set_text_color(&mut self, colour: Option<C>) {
        self.text = colour;
    }

    fn set_background_color(&mut self, colour: Option<C>) {
        self.background = colour;
    }

    fn set_underline_color(&mut self, colour: DecorationColor<C>) {
        self.underline = colour;
    }

    fn set_strikethrough_color(&mut self, colour: DecorationColor<C>) {
        self.strikethrough = colour;
    }
}
