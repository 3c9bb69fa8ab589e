//! Short ways to say what is wrong with coded bytes.

use super::range::End;
use crate::error::Damage;

/// Bytes that contradict their own format.
pub(super) fn malformed(what: &'static str) -> Damage {
    Damage::Malformed(what)
}

/// More of something than the format allows. A number below 0 counts as 0.
pub(super) fn too_large(what: &'static str, count: i32, limit: i32) -> Damage {
    let [count, limit] = [count, limit].map(|number| u64::try_from(number).unwrap_or(0));
    Damage::TooLarge { what, count, limit }
}

/// A message that does not end where its bytes do.
pub(super) fn malformed_end(end: End) -> Damage {
    malformed(match end {
        End::Early => "ends early",
        End::Late => "has bytes left over",
    })
}
