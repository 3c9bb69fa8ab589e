//! `include/nfr.h` is what cbindgen makes of the sources.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

/// The sources that have items of the interface, in the order of the header.
const SOURCES: [&str; 5] = ["status", "bytes", "values", "font", "rasterizer"];

fn generated(root: &Path) -> String {
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap();
    let builder = cbindgen::Builder::new().with_config(config);
    let builder =
        SOURCES.iter().fold(builder, |builder, name| builder.with_src(root.join(format!("src/{name}.rs"))));
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    String::from_utf8(text).unwrap()
}

#[test]
fn the_header_is_that_of_the_sources() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (path, made) = (root.join("include/nfr.h"), generated(root));
    let committed = fs::read_to_string(&path).unwrap_or_default();
    if std::env::var_os("NFR_WRITE_HEADER").is_some() {
        fs::write(&path, &made).unwrap();
    }
    // A run that writes fails, too, so that nobody takes it for a test.
    assert!(
        committed == made,
        "include/nfr.h is out of date: NFR_WRITE_HEADER=1 cargo test -p nfr-capi --test header"
    );
}

#[test]
fn every_exported_function_is_in_the_header() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let header = generated(root);
    let mut exported = 0;
    for entry in fs::read_dir(root.join("src")).unwrap() {
        let source = fs::read_to_string(entry.unwrap().path()).unwrap();
        for after in source.split("#[unsafe(no_mangle)]").skip(1) {
            let name = after.split("fn ").nth(1).unwrap().split('(').next().unwrap();
            assert!(header.contains(&format!("{name}(")), "{name} is not in the header");
            exported += 1;
        }
    }
    assert!(exported > 20);
}
