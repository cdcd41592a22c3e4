//! The examples of the language run, and print what their heads promise.

#[path = "../examples/builder.rs"]
#[allow(dead_code, reason = "an example has a `main`")]
mod builder;
#[path = "../examples/two_buffers.rs"]
#[allow(dead_code, reason = "an example has a `main`")]
mod two_buffers;

#[test]
fn two_buffers_in_one_crate() {
    let mut text = Vec::new();
    two_buffers::report(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    // 0.5 - 0.25 · 1, and the plane at 0.9; exp(-2 · (0.25 + 0.125)).
    assert!(text.contains("alpha 1.00 at 0.50: enters true, criterion 0.2500"), "{text}");
    assert!(text.contains("alpha 0.50 at 0.95: enters false"), "{text}");
    assert!(text.contains("keeps 0.4724 of its light"), "{text}");
    assert!(text.contains("Glass: pass store, ") && text.contains("Thickness: pass resolve, "), "{text}");
    assert!(text.contains("uniform blocks: 16 and 16 bytes"), "{text}");
}

#[test]
fn a_study_through_the_builder() {
    let mut text = Vec::new();
    builder::report(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    assert!(text.contains("most opaque, k = 8: return -f.color.w;"), "{text}");
    assert!(text.contains("weight 0.125: keeps Some(4)"), "{text}");
    let source = include_str!("../examples/builder.rs");
    let line = source.lines().position(|line| line.contains("f.colour.w")).unwrap();
    let column = source.lines().nth(line).unwrap().find("colour").unwrap();
    assert!(text.contains(&format!("examples/builder.rs:{}:{}", line + 1, column + 1)), "{text}");
    assert!(text.contains("did you mean `color`?"), "{text}");
}

/// A `Result` as the type of `main` prints an error in its `Debug` form, which is for programmers of the library.
#[test]
fn examples_print_the_display_of_errors() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for file in ["builder.rs", "minimal.rs", "two_buffers.rs", "material/main.rs"] {
        let source = std::fs::read_to_string(folder.join(file)).unwrap();
        assert!(source.contains("fn main() -> ExitCode {") && source.contains("\"error: {error}\""), "{file}");
    }
    let found = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let examples = found.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).count();
    assert_eq!(examples, 3, "an example that the list lacks");
}
