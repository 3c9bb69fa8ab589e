//! The class `Font`.

use std::sync::{Arc, OnceLock};

use nfr::{DrawOptions, Error, MissingModel};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use read_fonts::model;
use read_fonts::types::GlyphId;

use crate::bitmap::Bitmap;
use crate::error::Failure;
use crate::glyphs::glyph;
use crate::info;
use crate::input::bytes;
use crate::line::{self, Style};
use crate::pool::{Pool, Settings};
use crate::values::{Limits, LineMetrics, lcd, unsigned};

/// A font with models, and what draws it.
///
/// file: a path, the file's bytes (any object with the buffer protocol; bytes are not copied), or a file open in binary mode.
/// index: which font of a collection, counted from 0.
/// missing_model: what is drawn for a glyph that has no model: "error" raises MissingModelError, "blank" draws nothing,
/// "outline" draws the plain outline, without hinting.
/// limits: what drawing a glyph may take.
/// cache_bytes: the memory for decoded models, for each thread that draws at the same time.
///
/// Threads may use one font at the same time without a lock. The GIL is released while it draws.
///
/// Raises FontError for a file that is no font, has no models, or is damaged; OSError for one that cannot be read.
#[pyclass(frozen, module = "nfr")]
pub(crate) struct Font {
    font: nfr::Font,
    pool: Pool,
    /// The same font for the names of its glyphs, which are seldom asked for.
    names: OnceLock<Option<model::Font>>,
    index: u32,
}

/// A font's bytes, for another reader of them.
struct Shared(nfr::Font);

impl AsRef<[u8]> for Shared {
    fn as_ref(&self) -> &[u8] {
        self.0.data()
    }
}

impl Font {
    fn names(&self) -> Option<&model::Font> {
        let open = || {
            let blob = model::Blob::Shared(Arc::new(Shared(self.font.clone())));
            model::Font::new(blob, self.index)
        };
        self.names.get_or_init(open).as_ref()
    }

    /// Does work with a rasterizer while other Python threads run.
    fn detached<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut nfr::Rasterizer) -> T + Send) -> T {
        py.detach(|| self.pool.with(&self.font, work))
    }
}

fn checked(ppem: f32) -> Result<f32, Failure> {
    if ppem > 0.0 && ppem <= DrawOptions::MAX_PPEM { Ok(ppem) } else { Err(Error::InvalidSize(ppem).into()) }
}

fn missing_model(name: &str) -> PyResult<MissingModel> {
    match name {
        "error" => Ok(MissingModel::Error),
        "blank" => Ok(MissingModel::Blank),
        "outline" => Ok(MissingModel::Outline),
        _ => {
            let message = format!("missing_model is 'error', 'blank' or 'outline', not {name:?}");
            Err(PyValueError::new_err(message))
        }
    }
}

/// A line is one line.
fn one_line(text: &str) -> PyResult<&str> {
    let breaks = ['\n', '\r', '\u{B}', '\u{C}', '\u{85}', '\u{2028}', '\u{2029}'];
    match text.find(breaks) {
        Some(at) => {
            let before = text[..at].chars().count();
            Err(PyValueError::new_err(format!("the text has a line break at index {before}; draw each line")))
        }
        None => Ok(text),
    }
}

#[pymethods]
impl Font {
    #[new]
    #[pyo3(signature = (file, index=0, *, missing_model="error", limits=None, cache_bytes=8_388_608))]
    fn new(
        py: Python<'_>,
        file: &Bound<'_, PyAny>,
        index: i64,
        missing_model: &str,
        limits: Option<Limits>,
        cache_bytes: i64,
    ) -> Result<Self, Failure> {
        let index = unsigned("index", index)?;
        let cache = unsigned("cache_bytes", cache_bytes)?;
        let limits = limits.map_or_else(nfr::Limits::default, Into::into);
        let settings = Settings { missing: self::missing_model(missing_model)?, limits, cache };
        let data = bytes(file)?;
        let font = py.detach(|| nfr::Font::from_index(data, index))?;
        Ok(Self { font, pool: Pool::new(settings), names: OnceLock::new(), index })
    }

    /// Draws a glyph.
    ///
    /// glyph: its number, or a character, which may have a variation selector behind it.
    /// ppem: the size in pixels per em, above 0 and at most 2048; it may be fractional.
    /// offset: how far the glyph is moved in pixels, x to the right and y up: the part of a position that is below a pixel.
    /// hinting: False draws the plain outline.
    ///
    /// Raises GlyphError for a glyph that the font lacks or whose model is damaged, MissingModelError for one without a
    /// model, LimitError, and ArgumentError, which is a ValueError, for a size or an offset out of range.
    #[pyo3(
        signature = (glyph, ppem, *, offset=[0.0; 2], hinting=true),
        text_signature = "($self, glyph, ppem, *, offset=(0.0, 0.0), hinting=True)"
    )]
    fn draw(
        &self,
        py: Python<'_>,
        glyph: &Bound<'_, PyAny>,
        ppem: f32,
        offset: [f32; 2],
        hinting: bool,
    ) -> Result<Bitmap, Failure> {
        let glyph = self::glyph(&self.font, glyph)?;
        let options = DrawOptions::new(ppem).with_offset(offset).with_hinting(hinting);
        self.pool.with(&self.font, |rasterizer| {
            let drawn = py.detach(move || rasterizer.draw(glyph, options))?;
            Ok(Bitmap::new(py, drawn.placement, drawn.pixels)?)
        })
    }

    /// Draws the red, green and blue subpixels of a glyph, for LCD panels. The bitmap's pixels have the shape (height, width, 3).
    ///
    /// glyph, ppem, offset, hinting: as in draw.
    /// order: how the subpixels lie, "rgb" or "bgr" from left to right, "v-rgb" or "v-bgr" from top to bottom.
    /// filter: "shifted" (as FreeType does by default), "light" or "fir5" (FreeType's filters), or "none".
    ///
    /// Raises as draw, and ValueError for another order or filter.
    #[pyo3(
        signature = (glyph, ppem, *, offset=[0.0; 2], hinting=true, order="rgb", filter="shifted"),
        text_signature = "($self, glyph, ppem, *, offset=(0.0, 0.0), hinting=True, order='rgb', filter='shifted')"
    )]
    #[allow(clippy::too_many_arguments, reason = "they are named in Python")]
    fn draw_lcd(
        &self,
        py: Python<'_>,
        glyph: &Bound<'_, PyAny>,
        ppem: f32,
        offset: [f32; 2],
        hinting: bool,
        order: &str,
        filter: &str,
    ) -> Result<Bitmap, Failure> {
        let glyph = self::glyph(&self.font, glyph)?;
        let options = DrawOptions::new(ppem).with_offset(offset).with_hinting(hinting);
        let lcd = lcd(order, filter)?;
        self.pool.with(&self.font, |rasterizer| {
            let drawn = py.detach(move || rasterizer.draw_lcd(glyph, options, lcd))?;
            Ok(Bitmap::of_subpixels(py, drawn.placement, drawn.pixels)?)
        })
    }

    /// Draws a line of text, glyph after glyph, as its characters map to them: no kerning, no ligatures, left to right.
    ///
    /// The bitmap is the box of all ink; left and top are relative to the beginning of the line on its baseline. For a
    /// character that the font lacks glyph 0 is drawn. Where glyphs overlap, coverage is combined as paint over paint.
    ///
    /// ppem, hinting: as in draw.
    /// hinted_advances: whether the pen moves by hinted advance widths, as hinted_advance has them, or by linear ones, with
    /// glyphs at parts of a pixel. By default as hinting.
    ///
    /// Raises as draw, and ValueError for a line break in the text.
    #[pyo3(signature = (text, ppem, *, hinting=true, hinted_advances=None))]
    fn draw_text(
        &self,
        py: Python<'_>,
        text: &str,
        ppem: f32,
        hinting: bool,
        hinted_advances: Option<bool>,
    ) -> Result<Bitmap, Failure> {
        let glyphs = line::glyphs(&self.font, one_line(text)?);
        let hinted_advances = hinted_advances.unwrap_or(hinting);
        let style = Style { ppem: checked(ppem)?, hinting, hinted_advances };
        let limits = self.pool.settings().limits;
        let drawn = self.detached(py, |rasterizer| line::draw(rasterizer, &glyphs, style, &limits))?;
        Ok(Bitmap::new(py, drawn.placement, &drawn.pixels)?)
    }

    /// How far the pen moves over a line of text that draw_text draws, in pixels.
    #[pyo3(signature = (text, ppem, *, hinted_advances=true))]
    fn text_advance(
        &self,
        py: Python<'_>,
        text: &str,
        ppem: f32,
        hinted_advances: bool,
    ) -> Result<f64, Failure> {
        let glyphs = line::glyphs(&self.font, one_line(text)?);
        let style = Style { ppem: checked(ppem)?, hinting: true, hinted_advances };
        Ok(self.detached(py, |rasterizer| line::advance(rasterizer, &glyphs, style))?)
    }

    /// The advance width of a glyph in pixels, linear in the size.
    fn advance(&self, glyph: &Bound<'_, PyAny>, ppem: f32) -> Result<f32, Failure> {
        let glyph = self::glyph(&self.font, glyph)?;
        Ok(self.font.advance(glyph, checked(ppem)?))
    }

    /// The hinted advance width of a glyph in pixels: a whole number at sizes that round to those of ppem_range, and the linear
    /// one at others and for glyphs whose models do not know it.
    fn hinted_advance(&self, py: Python<'_>, glyph: &Bound<'_, PyAny>, ppem: f32) -> Result<f32, Failure> {
        let glyph = self::glyph(&self.font, glyph)?;
        Ok(self.detached(py, |rasterizer| rasterizer.hinted_advance(glyph, ppem))?)
    }

    /// The hinted left side bearing of a glyph in pixels: from its origin to the leftmost point of its outline, control points
    /// included. It is the linear one for glyphs without an outline and for those whose models do not know it.
    fn hinted_side_bearing(
        &self,
        py: Python<'_>,
        glyph: &Bound<'_, PyAny>,
        ppem: f32,
    ) -> Result<f32, Failure> {
        let glyph = self::glyph(&self.font, glyph)?;
        Ok(self.detached(py, |rasterizer| rasterizer.hinted_side_bearing(glyph, ppem))?)
    }

    /// Metrics of a line of text at a size in pixels per em.
    fn line_metrics(&self, ppem: f32) -> Result<LineMetrics, Failure> {
        Ok(self.font.line_metrics(checked(ppem)?).into())
    }

    /// The glyph of a character, which may have a variation selector behind it; None if the font has none.
    fn glyph_for_char(&self, character: &str) -> Result<Option<u32>, Failure> {
        crate::glyphs::of_character(&self.font, character)
    }

    /// The glyph with a name of the font's table post; None if there is none.
    fn glyph_for_name(&self, name: &str) -> Option<u32> {
        self.names()?.glyph_by_name(name).map(GlyphId::to_u32)
    }

    /// The name of a glyph; gid7 for glyph 7 where the font has none.
    fn glyph_name(&self, glyph: &Bound<'_, PyAny>) -> Result<String, Failure> {
        let glyph = self::glyph(&self.font, glyph)?;
        let name = self.names().and_then(|font| font.glyph_name(GlyphId::new(glyph)));
        Ok(name.map_or_else(|| format!("gid{glyph}"), |name| name.to_string()))
    }

    /// Whether a glyph has a model.
    fn has_model(&self, glyph: &Bound<'_, PyAny>) -> Result<bool, Failure> {
        Ok(self.font.has_model(self::glyph(&self.font, glyph)?))
    }

    /// The characters of the font with their glyphs.
    fn characters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let characters = PyDict::new(py);
        for (character, glyph) in self.font.characters() {
            characters.set_item(character, glyph)?;
        }
        Ok(characters)
    }

    /// The glyphs that have models, ascending.
    fn modelled_glyphs(&self) -> Vec<u32> {
        self.font.modelled_glyphs().collect()
    }

    /// What the table of models says, with the keys of `nfr info --json`.
    fn info<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>, Failure> {
        info::of(py, &self.font)
    }

    /// The number of glyphs in the font, with a model or without.
    #[getter]
    fn glyph_count(&self) -> u32 {
        self.font.glyph_count()
    }

    /// Font units in an em.
    #[getter]
    fn units_per_em(&self) -> u16 {
        self.font.units_per_em()
    }

    /// What the models were made for: 'smooth', 'mono' or 'lcd'.
    #[getter]
    fn target(&self) -> &'static str {
        self.font.target().name()
    }

    /// The first and the last size that the models know, in pixels per em.
    #[getter]
    fn ppem_range(&self) -> (u16, u16) {
        self.font.ppem_range()
    }

    /// The file's bytes, for a shaper or another renderer.
    #[getter]
    fn data<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.font.data())
    }

    fn __repr__(&self) -> String {
        let (first, last) = self.font.ppem_range();
        let (models, glyphs) = (self.font.modelled_glyphs().len(), self.font.glyph_count());
        format!("<nfr.Font {}, {first}-{last} ppem, models of {models} of {glyphs} glyphs>", self.target())
    }
}
