//! How far a neural font is from the hinted one that it was made from: bitmaps (`diff`, `report`), and hinted points (`points`,
//! `verification`), and what a font's certificate says (`certificate`).

pub mod certificate;
pub mod diff;
pub mod fonts;
pub mod html;
pub mod metrics;
pub mod picture;
pub mod points;
pub mod report;
pub mod sample_text;
pub mod source;
pub mod threshold;
pub mod verification;
mod watched;

pub use watched::Watch;
