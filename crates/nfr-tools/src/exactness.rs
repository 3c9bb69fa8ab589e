//! What keeps a conversion of quality 100 from being exact.

use std::ops::RangeInclusive;

use nfr_convert::compare::report::glyph_count_text;
use nfr_convert::compare::verification::{NoPoints, Verification};

/// A line that says how many glyphs and sizes are not as the hints have them, and why; none if all are. `trained` are the sizes that
/// were learned, and the step between them.
pub(super) fn exceptions(
    verification: &Verification,
    (trained, step): (&RangeInclusive<u16>, u16),
) -> Option<String> {
    let mut exceptions: Vec<String> = Vec::new();
    for (reason, count) in verification.reasons() {
        let why = match reason {
            NoPoints::NoModel => "without a model, because hinting changes the contours".to_owned(),
            reason => reason.to_string(),
        };
        exceptions.push(format!("{} {why}", glyph_count_text(count)));
    }
    let (mut outside, mut predicted, mut others) = (0, 0, 0);
    for size in verification.by_ppem.iter().filter(|size| !size.tally.is_equal()) {
        let count = if !trained.contains(&size.ppem) {
            &mut outside
        } else if (size.ppem - trained.start()) % step != 0 {
            &mut predicted
        } else {
            &mut others
        };
        *count += 1;
    }
    let (first, last) = (trained.start(), trained.end());
    let reasons = [
        (predicted, "whose hinting is predicted from other sizes".to_owned()),
        (outside, format!("outside of the trained {first}-{last} ppem, where plain outlines are drawn")),
        (others, "with points or metrics beyond what models hold".to_owned()),
    ];
    for (count, why) in reasons.into_iter().filter(|(count, _)| *count > 0) {
        exceptions.push(format!("{count} size{} {why}", if count == 1 { "" } else { "s" }));
    }
    if exceptions.is_empty() {
        return None;
    }
    Some(format!("--quality 100 is not exact for {}", exceptions.join("; ")))
}
