//! From a hinted font to a neural one.
pub mod teacher;
