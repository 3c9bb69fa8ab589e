//! The test fonts are the ones that `fonts/README.md` describes.

use std::collections::BTreeSet;
use std::path::Path;

use sha2::{Digest, Sha256};

#[test]
fn the_table_of_fonts_names_every_font_with_its_hash_and_a_licence_that_is_there() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts"));
    let mut described = BTreeSet::new();
    for line in std::fs::read_to_string(folder.join("README.md")).unwrap().lines() {
        // In a row, what stands in backquotes: file, package, licence file, hash.
        let quoted: Vec<_> = line.split('`').skip(1).step_by(2).collect();
        let &[file, _, licence, hash] = quoted.as_slice() else { continue };
        let digest = Sha256::digest(std::fs::read(folder.join(file)).unwrap());
        assert_eq!(format!("{digest:x}"), hash, "{file} is not the file that fonts/README.md describes");
        assert!(folder.join(licence).is_file(), "{file} lacks its licence, {licence}");
        described.insert(file.to_owned());
    }
    let there: BTreeSet<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".ttf") || name.ends_with(".otf"))
        .collect();
    assert_eq!(described, there, "fonts/README.md (left) and the folder (right) disagree");
}
