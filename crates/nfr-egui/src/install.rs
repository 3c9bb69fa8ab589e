//! Which family is drawn by which font: state of an egui context.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use egui::{Context, FontFamily, FontPriority, GlyphRasterizer, Plugin};
use nfr::{Error, Font};

use crate::drawing::Drawing;

/// Lets a font draw the glyphs of a family, in place of the font that drew it before.
///
/// To call it again with the same font changes nothing, so that it may be called every frame; only a font of a collection should be
/// installed once. A change takes effect at the next pass, in which egui lays all text out again.
pub fn install(ctx: &Context, family: FontFamily, font: &Font) -> Installed {
    let families = Families::of(ctx);
    let (drawing, generation) = {
        let mut current = families.lock();
        let kept = current.drawings.get(&family).filter(|drawing| drawing.is_of(font)).map(Arc::clone);
        let drawing = kept.unwrap_or_else(|| {
            let drawing = Arc::new(Drawing::new(font));
            current.drawings.insert(family, Arc::clone(&drawing));
            current.generation += 1;
            drawing
        });
        (drawing, current.generation)
    };
    families.activate(ctx, generation);
    Installed(drawing)
}

/// Gives a family back to egui's fonts at the next pass.
pub fn remove(ctx: &Context, family: &FontFamily) {
    let families = Families::of(ctx);
    let generation = {
        let mut current = families.lock();
        if current.drawings.remove(family).is_none() {
            return;
        }
        current.generation += 1;
        current.generation
    };
    families.activate(ctx, generation);
}

/// A font that was installed. It may be dropped: the font stays.
#[derive(Debug, Clone)]
pub struct Installed(Arc<Drawing>);

impl Installed {
    /// The font.
    pub fn font(&self) -> &Font {
        self.0.font()
    }

    /// The last error of a damaged model: `MalformedModel`, `StaleModel` or the like. egui's fonts draw such glyphs. The first one is
    /// also logged as a warning. A glyph without a model is no error.
    pub fn last_error(&self) -> Option<Error> {
        self.0.last_error()
    }
}

/// The fonts of a context, which its rasterizers share.
#[derive(Debug, Clone, Default)]
struct Families(Arc<Mutex<Current>>);

#[derive(Debug, Default)]
struct Current {
    /// Counts changes.
    generation: u64,
    drawings: HashMap<FontFamily, Arc<Drawing>>,
}

/// As a plugin the state outlives the context's memory, which applications may reset.
impl Plugin for Families {
    fn debug_name(&self) -> &'static str {
        "nfr-egui"
    }
}

impl Families {
    fn of(ctx: &Context) -> Self {
        ctx.plugin_or_default::<Self>().lock().clone()
    }

    fn lock(&self) -> MutexGuard<'_, Current> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What draws a family, if nothing has changed since a generation.
    fn drawing(&self, family: &FontFamily, generation: u64) -> Option<Arc<Drawing>> {
        let current = self.lock();
        current.drawings.get(family).filter(|_| current.generation == generation).map(Arc::clone)
    }

    /// Adds a rasterizer for a generation. egui cannot replace one rasterizer and keep those of others, and draws glyphs again only for
    /// one with a new key. So each change adds one, and the older ones leave everything to it.
    fn activate(&self, ctx: &Context, generation: u64) {
        let families = self.clone();
        let rasterizer = GlyphRasterizer::new(format!("nfr-egui {generation}"), move |request| {
            families.drawing(request.family, generation)?.draw(request)
        });
        ctx.add_glyph_rasterizer(rasterizer.with_priority(FontPriority::Highest));
    }
}
