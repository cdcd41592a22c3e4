//! Prints every shader of the corpus in every dialect that supports it, and validates the result with the reference
//! compiler.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use fragbuf_glsl::{Dialect, Unit};
use support::{ALL, accept, parse, print, suffix};

/// Shaders that ES does not support, with a part of the error message.
const UNSUPPORTED_BY_ES: [(&str, &str); 8] = [
    ("fragment_io_early", "a fine derivative"),
    ("interlock_main", "an interlock"),
    ("interlock_ordered_main", "an interlock"),
    ("matrices_vertex", "linear interpolation"),
    ("matrices_fragment", "linear interpolation"),
    ("texture_shapes_main", "cube array"),
    ("wide_words_main", "64-bit integers"),
    ("textures_main", "number of levels"),
];

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
            for dialect in ALL {
                let unsupported = UNSUPPORTED_BY_ES
                    .iter()
                    .find(|(shader, _)| *shader == format!("{stem}_{}", entry.name) && dialect == Dialect::Es310);
                if let Some((_, message)) = unsupported {
                    let errors = print(&source, Unit::EntryPoint(&entry.name), dialect).unwrap_err();
                    assert!(errors.iter().any(|error| error.message.contains(message)), "{stem}: {errors:?}");
                    continue;
                }
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
