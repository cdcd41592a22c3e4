//! Every shader of the corpus prints in both dialects, and the reference compiler accepts what is printed.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use fragbuf_glsl::Unit;
use support::{BOTH, accept, parse, print, suffix};

#[test]
fn corpus_is_accepted() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus");
    let mut files: Vec<_> = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "the corpus is empty");
    let mut failures = Vec::new();
    for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "wgsl")) {
        let stem = file.file_stem().unwrap().to_string_lossy();
        let source = std::fs::read_to_string(file).unwrap();
        let (module, _) = parse(&source);
        assert!(!module.entry_points.is_empty(), "{stem} has no entry point");
        for entry in &module.entry_points {
            for dialect in BOTH {
                let result = match print(&source, Unit::EntryPoint(&entry.name), dialect) {
                    Ok(text) => accept(&text, &format!("{stem}_{}", entry.name), suffix(entry.stage), dialect),
                    Err(errors) => Err(format!("{stem}: {errors:?}")),
                };
                failures.extend(result.err());
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n----\n"));
}
