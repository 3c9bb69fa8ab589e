//! Running the tools as a person would, and fonts that are wrong in one way each.

// Each test program uses a part of this.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use std::path::PathBuf;

use assert_cmd::assert::Assert;
use assert_cmd::cargo::cargo_bin_cmd;
use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

/// The directory of the fonts that the tests use.
pub const FONTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts");
pub const SANS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/LiberationSans-Regular.ttf");

/// A finished tool: its output and exit code.
pub struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
    assert: Assert,
}

pub fn nfr(args: &[&str]) -> Run {
    Run::new(cargo_bin_cmd!("nfr").args(args).assert())
}

pub fn nfr_convert(args: &[&str]) -> Run {
    Run::new(cargo_bin_cmd!("nfr-convert").args(args).assert())
}

impl Run {
    fn new(assert: Assert) -> Self {
        let output = assert.get_output();
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (code, stdout, stderr) =
            (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr));
        Self { code, stdout, stderr, assert }
    }

    /// Asserts exit code 0 and no error.
    #[track_caller]
    pub fn succeeds(mut self) -> Self {
        self.assert = self.assert.success();
        assert!(!self.stderr.contains("error"), "{}", self.stderr);
        self
    }

    /// Asserts exit code 1, nothing on stdout, and one line on stderr with these parts.
    #[track_caller]
    pub fn fails_with(mut self, parts: &[&str]) -> Self {
        self.assert = self.assert.code(1).stdout("");
        assert_eq!(self.stderr.lines().count(), 1, "{}", self.stderr);
        self.prints_error(parts)
    }

    /// Asserts exit code 2, nothing on stdout, and an error with these parts.
    #[track_caller]
    pub fn rejects_usage(mut self, parts: &[&str]) -> Self {
        self.assert = self.assert.code(2).stdout("");
        self.prints_error(parts)
    }

    #[track_caller]
    fn prints_error(self, parts: &[&str]) -> Self {
        assert!(self.stderr.starts_with("error: "), "{}", self.stderr);
        for part in parts {
            assert!(self.stderr.contains(part), "{part:?} is not in {}", self.stderr);
        }
        self
    }
}

/// A directory that goes away, with files in it.
pub struct Directory(tempfile::TempDir);

impl Directory {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn name(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    /// Writes a file and gives its path.
    pub fn write(&self, name: &str, bytes: &[u8]) -> String {
        std::fs::write(self.path(name), bytes).unwrap();
        self.name(name)
    }

    /// The names of its files, sorted; those of temporary files too.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// The bytes of a font in `fonts/`.
pub fn font(name: &str) -> Vec<u8> {
    std::fs::read(format!("{FONTS}/{name}.ttf")).unwrap()
}

pub fn sans() -> Vec<u8> {
    font("LiberationSans-Regular")
}

/// Liberation Sans without some tables, and with others added.
pub fn sans_with(without: &[&[u8; 4]], with: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let data = sans();
    let font = FontRef::new(&data).unwrap();
    let mut builder = FontBuilder::new();
    for record in font.table_directory().table_records() {
        let tag = record.tag();
        if !without.iter().any(|dropped| Tag::new(dropped) == tag) {
            builder.add_raw(tag, font.table_data(tag).unwrap().as_bytes().to_vec());
        }
    }
    for (tag, bytes) in with {
        builder.add_raw(Tag::new(tag), bytes.to_vec());
    }
    builder.build()
}

/// A collection that holds one font.
pub fn collection(font: &[u8]) -> Vec<u8> {
    collection_of(&[font])
}

/// A collection of fonts that share nothing (OpenType 1.9, "otff", TTC header 1.0).
pub fn collection_of(fonts: &[&[u8]]) -> Vec<u8> {
    const DIRECTORY: usize = 12;
    const RECORD: usize = 16;
    let mut file = [b"ttcf".as_slice(), &[0, 1, 0, 0], &(fonts.len() as u32).to_be_bytes()].concat();
    let mut at = (file.len() + 4 * fonts.len()) as u32;
    let mut moved = Vec::new();
    for font in fonts {
        file.extend(at.to_be_bytes());
        let mut font = font.to_vec();
        let tables = usize::from(u16::from_be_bytes([font[4], font[5]]));
        for record in font[DIRECTORY..DIRECTORY + tables * RECORD].chunks_exact_mut(RECORD) {
            let offset: [u8; 4] = record[8..12].try_into().unwrap();
            record[8..12].copy_from_slice(&(u32::from_be_bytes(offset) + at).to_be_bytes());
        }
        font.resize(font.len().next_multiple_of(4), 0);
        at += font.len() as u32;
        moved.extend(font);
    }
    file.extend(moved);
    file
}
