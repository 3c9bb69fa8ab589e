//! Reading what people pass in: font files, selections of glyphs, lists of sizes.

pub mod closure;
pub mod face_names;
pub mod open;
pub mod ppem;
pub mod select;
pub mod variable;
pub mod web_font;
