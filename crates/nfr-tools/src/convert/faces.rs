//! `nfr-convert --all-faces`: every font of a collection.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use read_fonts::{FileRef, FontRef};
use serde::Serialize;

use super::arguments::Args;
use super::face;
use crate::failure::Failure;
use crate::files::Output;
use crate::progress::print_line;
use crate::source::{Source, read_unpacked};
use nfr_convert::face_names::FaceNames;
use nfr_convert::open::open;

/// The longest name of a file, without its extension: what all file systems take, with room for that of the work file.
const MAX_NAME_BYTES: usize = 200;

/// A font of the collection.
struct Face {
    index: u32,
    /// For people.
    title: String,
    output: PathBuf,
}

/// A font that was not converted, in the report.
#[derive(Serialize)]
struct Failed<'f> {
    input: String,
    index: u32,
    error: &'f str,
}

/// Converts all fonts. One that fails does not keep the others from it.
pub(super) fn convert_all(args: &Args) -> Result<(), Failure> {
    let data = read_unpacked(&args.input)?;
    let faces = faces(args, &data)?;
    for face in &faces {
        args.check_paths(&face.output)?;
    }
    fs::create_dir_all(&args.output).map_err(|e| {
        Failure::failed(format!(
            "cannot make the directory {} ({}); --all-faces takes a directory as its output",
            args.output.display(),
            e.kind()
        ))
    })?;
    let report = args.report.as_deref().map(Output::new).transpose()?;
    let (mut reports, mut failed) = (Vec::new(), Vec::new());
    for face in &faces {
        if !args.quiet {
            writeln!(io::stdout(), "{}", face.title)?;
        }
        match convert(args, &data, face) {
            Ok((told, summary)) => {
                reports.push(told.trim_end().to_owned());
                if !args.quiet {
                    writeln!(io::stdout(), "{summary}")?;
                }
            }
            Err(failure) => {
                let error = failure.to_string();
                print_line(&format!("{}: {error}", face.title));
                let entry =
                    Failed { input: args.input.display().to_string(), index: face.index, error: &error };
                reports
                    .push(serde_json::to_string_pretty(&entry).map_err(|e| Failure::failed(e.to_string()))?);
                failed.push(face.index.to_string());
            }
        }
    }
    if let Some(file) = report {
        file.write(format!("[{}]\n", reports.join(",\n")).as_bytes())?;
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format!(
        "{} of {} fonts in {} are not converted (index {})",
        failed.len(),
        faces.len(),
        args.input.display(),
        failed.join(", ")
    )))
}

/// Converts one font. Returns what the report and what people are told.
fn convert(args: &Args, data: &[u8], face: &Face) -> Result<(String, String), Failure> {
    let source = match args.source.face(data, face.index, &args.input)? {
        Some(instance) => instance,
        None => Source { data: data.to_vec(), index: face.index, instance: None },
    };
    let converted = face::convert(args, &source, &face.output)?;
    Ok(converted.map_or_else(Default::default, |converted| (converted.report, converted.summary)))
}

/// The fonts of a file, with the files that they are written to.
fn faces(args: &Args, data: &[u8]) -> Result<Vec<Face>, Failure> {
    let count = match FileRef::new(data) {
        Ok(FileRef::Collection(collection)) => collection.len(),
        // What is wrong with any other file is told by opening its only font.
        _ => open(data, 0).map(|_| 1).map_err(|e| Failure::from(e).at(args.input.display()))?,
    };
    let mut taken = BTreeSet::new();
    Ok((0..count).map(|index| face(&args.output, data, index, &mut taken)).collect())
}

/// Chooses a name that no other font has taken. A font that cannot be read has its index as its name.
fn face(directory: &Path, data: &[u8], index: u32, taken: &mut BTreeSet<String>) -> Face {
    let names = FontRef::from_index(data, index).map(|font| FaceNames::of(&font)).unwrap_or_default();
    let number = format!("font-{index}");
    let mut name =
        names.postscript.as_deref().map(file_name).filter(|name| !name.is_empty()).unwrap_or(number);
    // Some file systems do not tell capitals from small letters.
    while !taken.insert(name.to_lowercase()) {
        name = format!("{name}-{index}");
    }
    let title = match names.full.or(names.postscript) {
        Some(title) => format!("font {index}, {title}"),
        None => format!("font {index}"),
    };
    Face { index, title, output: directory.join(name + ".nfr.ttf") }
}

/// The characters of a PostScript name that are safe in the names of files.
fn file_name(name: &str) -> String {
    let is_safe = |c: &char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    name.chars().filter(is_safe).take(MAX_NAME_BYTES).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_to_no_other_directory() {
        assert_eq!(file_name("../Sans-Bold/\0x"), "Sans-Boldx");
        assert_eq!(file_name("..").as_str(), "");
        assert_eq!(file_name(&"a".repeat(500)).len(), MAX_NAME_BYTES);
    }

    #[test]
    fn fonts_of_one_name_get_files_of_their_own() {
        let mut taken = BTreeSet::new();
        let names: Vec<_> =
            (0..2).map(|index| face(Path::new("out"), b"no font", index, &mut taken).output).collect();
        assert_eq!(names, [Path::new("out/font-0.nfr.ttf"), Path::new("out/font-1.nfr.ttf")]);
    }
}
