//! Sections of a message: its sizes are coded in groups, which are read without each other.

use core::ops::Range;

use crate::constants::MAX_TRAINED_PPEM;
use crate::error::Damage;
use crate::table::context_model::ContextModel;
use crate::table::damage::malformed_end;
use crate::table::elements::SECTION;
use crate::table::range::Coder;

/// The sizes of a section; the last one has those that are left.
pub(super) const SECTION_SIZES: usize = 29;

/// The sizes, counted from the smallest, that are decoded for one: those of its section up to it.
pub fn sizes_for(size: usize) -> Range<usize> {
    size / SECTION_SIZES * SECTION_SIZES..size + 1
}

/// Whose message has sections.
#[derive(Debug, Clone, Copy)]
pub(super) enum Owner {
    Glyph,
    SharedTrack,
}

/// Codes what a message has for each size, of `count`: a writer all of them, a reader the `wanted` ones, the first of which begins
/// a section. `code` codes some that follow each other, without anything that is left from sizes before. Where nothing is coded
/// for any size, `is_coded` is false.
///
/// # Errors
///
/// Those of `code`; `Malformed` for a section that does not end where its bytes do.
pub(super) fn code<C: Coder>(
    model: &mut ContextModel<'_, C>,
    (owner, is_coded): (Owner, bool),
    count: usize,
    wanted: Range<usize>,
    mut code: impl FnMut(&mut ContextModel<'_, C>, Range<usize>) -> Result<(), Damage>,
) -> Result<(), Damage> {
    let sections = count.div_ceil(SECTION_SIZES);
    if sections <= 1 || !is_coded {
        let is_whole = wanted.end == count || !is_coded;
        code(model, wanted)?;
        return if is_whole { model.coder.check_end().map_err(malformed_end) } else { Ok(()) };
    }
    let sizes = |section: usize| section * SECTION_SIZES..((section + 1) * SECTION_SIZES).min(count);
    let mut lengths = [0; MAX_TRAINED_PPEM as usize / SECTION_SIZES];
    let lengths = &mut lengths[..sections - 1];
    if C::WRITES {
        for (section, length) in (1..).zip(&mut *lengths) {
            model.forget();
            model.coder.begin_section();
            code(model, sizes(section))?;
            *length = model.coder.end_section();
        }
        model.forget();
    }
    for (section, length) in (1..).zip(&mut *lengths) {
        let context = 2 * owner as usize + usize::from(section + 1 == sections);
        *length = model.positive(SECTION, [context, 0, 0], *length as u32 + 1) as usize - 1;
    }
    if C::WRITES {
        return code(model, sizes(0));
    }
    let first = wanted.start / SECTION_SIZES;
    for section in first..wanted.end.div_ceil(SECTION_SIZES) {
        let sizes = sizes(section);
        model.coder.enter_section(lengths, section).map_err(malformed_end)?;
        // What is before the sizes has none of their slots.
        if section > first {
            model.forget();
        }
        code(model, sizes.start..sizes.end.min(wanted.end))?;
        if wanted.end >= sizes.end {
            model.coder.check_end().map_err(malformed_end)?;
        }
    }
    Ok(())
}
