//! Which glyph a Python object stands for.

use nfr::Font;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::error::Failure;

/// A glyph from its number, or from a character, which may have a variation selector behind it.
///
/// # Errors
///
/// No such glyph; `TypeError` for other objects; `ValueError` for a string of several characters.
pub(crate) fn glyph(font: &Font, key: &Bound<'_, PyAny>) -> Result<u32, Failure> {
    let Ok(text) = key.cast::<PyString>() else { return numbered(font, key) };
    match of_character(font, text.to_str()?)? {
        Some(glyph) => Ok(glyph),
        None => Err(Failure::NoSuchCharacter(text.to_str()?.chars().next().unwrap_or_default())),
    }
}

/// The glyph of a character, which may have a variation selector behind it.
///
/// # Errors
///
/// `ValueError` for a string of several characters or of none.
pub(crate) fn of_character(font: &Font, text: &str) -> Result<Option<u32>, Failure> {
    let mut found = of_text(font, text);
    match (found.next(), found.next()) {
        (Some((_, glyph)), None) => Ok(glyph),
        _ => {
            let message = format!("one character is needed, not {text:?}; draw_text draws several");
            Err(PyValueError::new_err(message).into())
        }
    }
}

/// A glyph from its number.
fn numbered(font: &Font, key: &Bound<'_, PyAny>) -> Result<u32, Failure> {
    let number: i64 = match key.extract() {
        Ok(number) => number,
        Err(error) if error.is_instance_of::<PyOverflowError>(key.py()) => -1,
        Err(_) => {
            let message = format!("a glyph is a number or a character, not {}", key.get_type().name()?);
            return Err(PyTypeError::new_err(message).into());
        }
    };
    let in_font = u32::try_from(number).ok().filter(|glyph| *glyph < font.glyph_count());
    in_font.ok_or_else(|| Failure::NoSuchGlyph(key.clone().unbind()))
}

/// The characters of a text with their glyphs. Variation selectors go with the character before them.
pub(crate) fn of_text<'a>(font: &'a Font, text: &'a str) -> impl Iterator<Item = (char, Option<u32>)> + 'a {
    let mut characters = text.chars().peekable();
    std::iter::from_fn(move || {
        let character = characters.next()?;
        let selector = characters.next_if(|next| is_selector(*next));
        let variation = selector.and_then(|selector| font.glyph_for_variation(character, selector));
        Some((character, variation.or_else(|| font.glyph_for_char(character))))
    })
}

fn is_selector(character: char) -> bool {
    matches!(character, '\u{FE00}'..='\u{FE0F}' | '\u{E0100}'..='\u{E01EF}')
}
