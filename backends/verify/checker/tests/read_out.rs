//! Reads pixels out through users' storages that are wrong: reading ends with an error.

use fragbuf_checker::{FrameMemory, ReadOut, ReadOutError};
use fragbuf_codegen::{Profile, plan};
use fragbuf_model::Selection;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Template;

use crate::subjects::variant;

/// Words of each resource. None of them marks an empty slot.
const WORDS: usize = 64;

/// Reads a pixel of `kb` out, whose storage has these replacements in its source.
fn read(replacements: &[(&str, &str)]) -> Result<Vec<Vec<u32>>, ReadOutError> {
    with_frame(replacements, |read_out, frame| read_out.pixel(frame, [0, 0]))
}

/// Calls a function with the storage and a frame of one pixel.
fn with_frame<T>(replacements: &[(&str, &str)], call: impl Fn(&ReadOut, &mut FrameMemory) -> T) -> T {
    let registry = Registry::builtin();
    let mut row = registry.row("storage", "sorted_array").unwrap().clone();
    let template = row.template.unwrap();
    let mut source = template.source.into_owned();
    for (before, after) in replacements {
        assert_eq!(source.matches(before).count(), 1, "{before}");
        source = source.replace(before, after);
    }
    row.template = Some(Template::new("user/sorted_array.wgsl", source));
    let registry = registry.with(row);
    let variant = variant("kb", &[], &registry).unwrap();
    let plan = plan(&variant, &Selection::first(&variant), &registry).unwrap();
    let read_out = ReadOut::new(&plan, Profile::Native, &registry).unwrap();
    let symbol = |name: &str| [("width", 1), ("height", 1), ("k", 2)].iter().find(|one| one.0 == name).map(|one| one.1);
    let mut frame = FrameMemory::new(&plan, [1, 1], symbol, |_| Some(vec![7; WORDS]));
    call(&read_out, &mut frame)
}

/// Returns the number of the line of the storage that contains a text.
fn line_of(text: &str) -> usize {
    let source = Registry::builtin().row("storage", "sorted_array").unwrap().template.clone().unwrap().source;
    source.lines().position(|line| line.contains(text)).unwrap() + 1
}

const NEXT: &str = "return sorted_array_seek(pixel, cursor + 1u);";
const READ: &str = "return sorted_array_read(pixel, cursor);";

#[test]
fn a_storage_without_errors_is_read_to_its_end() {
    assert_eq!(read(&[]).map(|entries| entries.len()), Ok(2));
}

#[test]
fn a_list_that_returns_to_an_earlier_fragment_is_endless() {
    assert_eq!(read(&[(NEXT, "return cursor;")]), Err(ReadOutError::Cycle));
    assert_eq!(read(&[(NEXT, "return cursor ^ 1u;")]), Err(ReadOutError::Cycle));
}

#[test]
fn a_list_with_more_fragments_than_words_is_endless() {
    let first = (READ, "return sorted_array_read(pixel, 0u);");
    assert_eq!(read(&[(NEXT, "return cursor + 1u;"), first]), Err(ReadOutError::Cycle));
}

#[test]
fn a_call_of_storage_next_that_does_not_end_is_endless() {
    let next = "var next = cursor; while next != END { next ^= 1u; } return next;";
    let Err(ReadOutError::Endless { location }) = read(&[(NEXT, next)]) else { panic!("it ends") };
    assert_eq!(location, format!("user/sorted_array.wgsl:{}", line_of(NEXT)));
}

#[test]
fn a_cursor_beyond_the_buffers_is_out_of_bounds() {
    // The read of the entry: the access is in a generated accessor, which the template calls.
    let Err(error) = read(&[(NEXT, "return cursor + 1000u;")]) else { panic!("it is within bounds") };
    let expected = "reading the pixel accesses an index out of bounds at user/sorted_array.wgsl:";
    assert!(error.to_string().starts_with(expected), "{error}");
}

#[test]
fn an_error_of_the_bound_has_its_line() {
    let before = "return keys_hint(frame.k - 1u, pixel);";
    let bound = |read_out: &ReadOut, frame: &mut FrameMemory| read_out.bound(frame, [0, 0]);
    assert_eq!(with_frame(&[], bound), Ok(Some(7)));
    let Err(error) = with_frame(&[(before, "return keys_hint(frame.k + 1000u, pixel);")], bound) else {
        panic!("it is within bounds")
    };
    let expected =
        format!("reading the pixel accesses an index out of bounds at user/sorted_array.wgsl:{}", line_of(before));
    assert_eq!(error.to_string(), expected);
}
