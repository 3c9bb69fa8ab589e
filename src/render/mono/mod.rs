//! Drawing in black and white, with drop-out control.

mod grid;
mod profiles;
mod sweep;

use alloc::vec::Vec;

use self::grid::Grid;
use self::profiles::{Point, Profiles};
use self::sweep::{Bits, Pass, Sweep};
use super::glyph::HintedOutline;
use super::outline::{check_reach, hinted_plain};
use super::rasterizer::{Rasterizer, Source};
#[cfg(any(feature = "fields", feature = "networks"))]
use crate::bitmap::Canvas;
use crate::constants::MAX_SIDE;
use crate::error::Error;
use crate::limits::{Budget, Limits};
use crate::model::sizes::HintedSize;
use crate::mono::{MonoBitmap, MonoBitmapRef, row_bytes};
use crate::number::round;
use crate::options::DrawOptions;
use crate::placement::Placement;
use crate::table::Dropout;

/// The least coverage of a pixel that is black where a glyph has no outline.
#[cfg(any(feature = "fields", feature = "networks"))]
const HALF: u8 = 128;

/// Working memory of drawing in black and white.
#[derive(Debug, Clone, Default)]
pub(super) struct Mono {
    outline: HintedOutline,
    /// The points of one part.
    points: [Vec<i32>; 2],
    profiles: Profiles,
    sweep: Sweep,
    bits: Vec<u8>,
}

impl Rasterizer {
    /// Draws a glyph in black and white into a buffer of the rasterizer's own, and lends it until the next drawing.
    ///
    /// A pixel is black if its centre is inside the outline, and drop-out control fills the gaps that thin strokes would have. The
    /// box and all pixels are those of FreeType's `FT_RENDER_MODE_MONO` for the same points. Fonts that are converted with `--target
    /// mono` have the hints for it, and know which mode of drop-out control the hints ask for at each size. Where nothing is known,
    /// as for other targets, for sizes without models and for outlines without hints, gaps are filled except at the ends of strokes,
    /// which is FreeType's default, too.
    ///
    /// A subpixel offset is rounded to 1/64 pixel. Glyphs that a field or a network draws have no outline; their pixels are black
    /// from half coverage on.
    ///
    /// ```
    /// # let font = nfr::Font::new(include_bytes!("../../../spec/vectors/outline.ttf").as_slice())?;
    /// let mut rasterizer = nfr::Rasterizer::new(&font);
    /// let glyph = font.glyph_for_char('g').unwrap_or(0);
    /// for row in rasterizer.draw_mono(glyph, 11.0)?.rows() {
    ///     println!("{:08b}", row[0]);
    /// }
    /// # Ok::<(), nfr::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Rasterizer`] lists them.
    pub fn draw_mono(
        &mut self,
        glyph: u32,
        options: impl Into<DrawOptions>,
    ) -> Result<MonoBitmapRef<'_>, Error> {
        let mut mono = core::mem::take(&mut self.scratch.mono);
        let drawn = self.draw_bits(glyph, options.into(), &mut mono);
        self.scratch.mono = mono;
        Ok(MonoBitmapRef::new(drawn?, &self.scratch.mono.bits))
    }

    /// Draws a glyph in black and white into a new bitmap.
    ///
    /// # Errors
    ///
    /// As [`Self::draw_mono`].
    pub fn render_mono(&mut self, glyph: u32, options: impl Into<DrawOptions>) -> Result<MonoBitmap, Error> {
        self.draw_mono(glyph, options).map(MonoBitmap::from)
    }

    fn draw_bits(&mut self, glyph: u32, options: DrawOptions, mono: &mut Mono) -> Result<Placement, Error> {
        mono.outline.clear();
        mono.bits.clear();
        let size = match self.source(glyph, options)? {
            Source::Model(entry) => {
                let options = options.checked()?;
                match entry.glyph().outline_at(options, &mut mono.outline, &mut mono.points)? {
                    Some(size) => size,
                    #[cfg(any(feature = "fields", feature = "networks"))]
                    None => return self.threshold(glyph, options, &mut mono.bits),
                    #[cfg(not(any(feature = "fields", feature = "networks")))]
                    None => return Ok(Placement::default()),
                }
            }
            Source::Blank => {
                options.checked()?;
                return Ok(Placement::default());
            }
            Source::Plain => {
                let options = options.checked()?;
                hinted_plain(self.font(), glyph, options, &mut mono.outline, &mut mono.points)?;
                HintedSize::plain(options.ppem())
            }
        };
        let mode = self.dropout(glyph, &size);
        let offset = options.offset().map(|offset| round(offset * 64.0));
        mono.draw(size.trained_ppem, mode, offset, glyph, self.limits())
    }

    /// What hints ask of drop-out control, or else FreeType's default.
    fn dropout(&self, glyph: u32, size: &HintedSize) -> Dropout {
        let modes = self.font().table().ok().and_then(|table| table.dropout());
        let asked = modes.filter(|_| size.strength > 0.0).and_then(|modes| {
            let ppem = self.font().scale().ppem_of(size.index);
            modes.mode(glyph, ppem as u16)
        });
        asked.unwrap_or(Dropout::new(false, false))
    }

    /// Draws coverage, and makes what is covered by half or more black.
    #[cfg(any(feature = "fields", feature = "networks"))]
    fn threshold(
        &mut self,
        glyph: u32,
        options: DrawOptions,
        bits: &mut Vec<u8>,
    ) -> Result<Placement, Error> {
        let mut samples = core::mem::take(&mut self.scratch.subpixels);
        let drawn = self.draw_with(glyph, options, |placement| {
            samples.clear();
            samples.resize(placement.area(), 0);
            Canvas::new(placement, &mut samples, placement.width as usize).map(Some)
        });
        if let Ok(Some(placement)) = drawn {
            for row in samples.chunks(placement.width.max(1) as usize).take(placement.height as usize) {
                bits.extend(row.chunks(8).map(|eight| {
                    let set = |(at, level): (usize, &u8)| if *level >= HALF { 0x80 >> at } else { 0 };
                    eight.iter().enumerate().map(set).sum::<u8>()
                }));
            }
        }
        self.scratch.subpixels = samples;
        drawn.map(Option::unwrap_or_default)
    }
}

impl Mono {
    /// Draws the outline, moved by `offset` in 1/64 pixel.
    fn draw(
        &mut self,
        ppem: f32,
        mode: Dropout,
        offset: Point,
        glyph: u32,
        limits: &Limits,
    ) -> Result<Placement, Error> {
        let (grid, mut budget) = (Grid::for_size(ppem), Budget::new(glyph, limits));
        let placement = place(&self.outline, offset)?;
        limits.check_sides(placement.width, placement.height)?;
        let Self { outline, profiles, sweep, bits, .. } = self;
        bits.resize(row_bytes(placement.width) * placement.height as usize, 0);
        budget.spend(placement.area() as u64)?;
        let corner = [placement.left, placement.top.saturating_sub(placement.height as i32)];
        let moved = [0, 1].map(|axis| offset[axis] - corner[axis] * 64);
        let mut bits = Bits::new(placement, bits);
        for (pass, [along, across], lines) in
            [(Pass::Rows, [0, 1], placement.height), (Pass::Columns, [1, 0], placement.width)]
        {
            profiles.start(grid, lines);
            let mut start = 0;
            for &end in &outline.ends {
                profiles.contour(end - start, |k| {
                    let at = |axis: usize| grid.position(outline.points[axis][start + k] + moved[axis]);
                    ([at(along), at(across)], outline.on_curve[start + k])
                });
                start = end;
            }
            budget.spend((outline.on_curve.len() + profiles.crossings()) as u64)?;
            if profiles.are_too_many() {
                budget.spend(u64::MAX)?;
            }
            sweep.draw(profiles, mode, pass, &mut bits, &mut budget)?;
        }
        Ok(placement)
    }
}

impl HintedOutline {
    /// Draws it in black and white as an outline of this size in pixels per em.
    ///
    /// # Errors
    ///
    /// `BitmapTooLarge`, `TooMuchWork`.
    pub fn black_and_white(&self, ppem: f32, mode: Dropout) -> Result<MonoBitmap, Error> {
        check_reach(&self.points, [0; 2])?;
        let mut mono = Mono { outline: self.clone(), ..Mono::default() };
        let placement = mono.draw(ppem, mode, [0; 2], 0, &Limits::default())?;
        Ok(MonoBitmap { placement, bits: mono.bits })
    }
}

/// The box that FreeType gives an outline, moved by `offset` in 1/64 pixel: every pixel whose centre lies within the bounds of its
/// points, and one pixel at least (`ft_glyphslot_preset_bitmap`).
fn place(outline: &HintedOutline, offset: Point) -> Result<Placement, Error> {
    if outline.on_curve.is_empty() {
        return Ok(Placement::default());
    }
    let [(left, right), (bottom, top)] = [0, 1].map(|axis| {
        let points = outline.points[axis].iter();
        let [low, high] = points.fold([i32::MAX, i32::MIN], |[low, high], v| [low.min(*v), high.max(*v)]);
        // A centre on a border is inside.
        let [low, high] = [low + offset[axis] + 31, high + offset[axis] + 32];
        match [low >> 6, high >> 6] {
            [first, end] if first < end => (first, end),
            // The pixel with more of what lies between.
            [first, _] if (low & 63) + (high & 63) < 63 => (first - 1, first),
            [first, _] => (first, first + 1),
        }
    });
    let (width, height) = (right.abs_diff(left), top.abs_diff(bottom));
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Error::BitmapTooLarge { width, height, limit: MAX_SIDE });
    }
    Ok(Placement { left, top, width, height })
}
