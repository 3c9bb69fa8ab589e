//! What the example and the tests share.
#![allow(dead_code, reason = "the example and each test file use a part of it")]

pub(crate) mod canvas;
pub(crate) mod fonts;
