//! The components of composite glyphs in `glyf`.

use read_fonts::tables::glyf::{CompositeGlyphFlags, Glyph};
use read_fonts::{FontRef, TableProvider};

use nfr::internals::table::MAX_PARTS;

/// The deepest nesting of components. `maxp` allows 16; fonts have two or three.
const MAX_DEPTH: usize = 16;

/// The simple glyphs that a glyph consists of, in the order of its points. None if it has too many, or scales
/// them, or cannot be read.
pub(super) fn simple_components(font: &FontRef<'_>, gid: u16) -> Option<Vec<u16>> {
    let mut found = Vec::new();
    collect(font, gid, MAX_DEPTH, &mut found)?;
    Some(found)
}

fn collect(font: &FontRef<'_>, gid: u16, depth: usize, found: &mut Vec<u16>) -> Option<()> {
    let scaled = CompositeGlyphFlags::WE_HAVE_A_SCALE
        | CompositeGlyphFlags::WE_HAVE_AN_X_AND_Y_SCALE
        | CompositeGlyphFlags::WE_HAVE_A_TWO_BY_TWO;
    match font.loca(None).ok()?.get_glyf(gid.into(), &font.glyf().ok()?).ok()? {
        Some(Glyph::Simple(_)) if found.len() < MAX_PARTS => found.push(gid),
        Some(Glyph::Simple(_)) => return None,
        Some(Glyph::Composite(composite)) => {
            for component in composite.components() {
                if component.flags.intersects(scaled) {
                    return None;
                }
                let gid = u16::try_from(component.glyph.to_u32()).ok()?;
                collect(font, gid, depth.checked_sub(1)?, found)?;
            }
        }
        None => {}
    }
    Some(())
}
