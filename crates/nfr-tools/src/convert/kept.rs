//! What an interrupted conversion says.

use std::path::PathBuf;
use std::sync::Arc;

use crate::interrupt::last_words;
use nfr_convert::partial::Partial;

/// Has an interruption keep what is ready in the work file, and say how to go on.
pub(super) fn tell_how_to_go_on(partial: Option<Arc<Partial>>, path: Option<PathBuf>) {
    last_words(move || {
        let (Some(partial), Some(path)) = (partial, path) else {
            return "interrupted; nothing is kept: run the same command again".into();
        };
        match partial.flush() {
            Ok(true) => format!(
                "interrupted; what is ready is kept in {}: the same command with --resume goes on",
                path.display()
            ),
            Ok(false) => {
                "interrupted before a glyph was ready; nothing is written: run the same command again".into()
            }
            Err(error) => format!("interrupted; {error}; make room, and run the same command with --resume"),
        }
    });
}
