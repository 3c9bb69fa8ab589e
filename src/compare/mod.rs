//! How far a neural font is from the hinted one that it was made from.

pub mod diff;
pub mod metrics;
pub mod picture;
pub mod report;
pub mod source;
pub mod threshold;
