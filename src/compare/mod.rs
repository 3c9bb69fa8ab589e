//! Comparing renders.

pub mod metrics;
