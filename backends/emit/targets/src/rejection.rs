//! The reason why naga rejects WGSL of a user, in words about the source, and a fix.
//!
//! Input: naga's message. Output: the message without the numbers of naga's handles and the function around the place, which is given by
//! line and column, and a help text. A message that is not known keeps naga's words.

use fragbuf_model::nearest_name;
use naga::SourceLocation;

/// Parts of naga's messages, what the error is, and the fix. An empty message keeps naga's.
const KNOWN: &[(&str, &str, &str)] = &[
    (
        "automatic conversions cannot convert",
        "",
        "write a literal of the type, `1u`, `1i` or `1.0`, or convert the value: `u32(…)`, `i32(…)` or `f32(…)`",
    ),
    ("type mismatch", "", "convert the value: `u32(…)`, `i32(…)` or `f32(…)`"),
    (
        "Abstract types may only appear in constant expressions",
        "the operands have different types",
        "write the literal in the type of the other operand, `1u`, `1i` or `1.0`, or convert: `f32(…)`",
    ),
    (
        "doesn't relate to a valid destination for a store",
        "the place cannot be assigned",
        "declare the buffer as `var<storage, read_write>`, or copy the value to a `var`",
    ),
    (
        "atomic operation is done on a pointer to a non-atomic",
        "the argument is no pointer to an atomic word",
        "declare the word as `atomic<u32>` or `atomic<i32>`, and pass `&name`",
    ),
    (
        "Alignment requirements for address space Uniform",
        "the layout does not fit a uniform buffer",
        "elements of arrays in `var<uniform>` have a multiple of 16 bytes: use `vec4<u32>` or `var<storage>`",
    ),
    ("extension is not supported", "", "remove the extension, and use `f32` in place of `f16`"),
    ("extension is not enabled", "", "remove what needs the extension, and use `f32` in place of `f16`"),
    (
        "expected global item",
        "expected a declaration",
        "declare `fn`, `var`, `const`, `struct`, `alias` or `override`; the source is WGSL",
    ),
    (
        "expression None does not match the declared return type",
        "the function does not return its value",
        "end it with `return …;`",
    ),
    ("invalid field accessor", "", "the value has no member of this name: correct it, or declare it in the `struct`"),
    ("are provided", "", "give the arguments that the function declares"),
    ("recursive", "", "call no function from itself, also not through others"),
    ("redefinition of", "", "rename one of the two"),
];

/// The help for an error that is not known.
const DEFAULT: &str = "correct the source at this place: it must be valid WGSL";

/// The beginning of the message about an unknown name.
const UNKNOWN: &str = "no definition in scope for identifier: `";

/// Returns the message and the help for naga's message about the source `text`.
pub fn explained(message: &str, text: &str) -> (String, String) {
    if let Some(name) = unknown_name(message) {
        let names = declared_names(text, name);
        let help = match nearest_name(name, &names) {
            Some(nearest) => format!("did you mean `{nearest}`?"),
            None => "declare it, or correct its name".to_owned(),
        };
        return (format!("cannot find `{name}`"), help);
    }
    let plain = without_context(&without_handles(message)).replace("`{AbstractFloat}`", "a literal with a point");
    let plain = plain.replace("`{AbstractInt}`", "a whole literal");
    if let Some((part, what, help)) = KNOWN.iter().find(|(part, ..)| message.contains(part)) {
        let found = plain.find(", found ").and_then(|at| plain.get(at..)).filter(|_| part.starts_with("expected"));
        let what = if what.is_empty() { plain.clone() } else { format!("{what}{}", found.unwrap_or_default()) };
        return (with_backquotes(&what), (*help).to_owned());
    }
    let help = match plain.starts_with("expected ") {
        true if plain.starts_with("expected `;`") => "end the statement with `;`",
        true => "correct the syntax here, or the end of the statement before it",
        false => DEFAULT,
    };
    (with_backquotes(&plain), help.to_owned())
}

/// Returns the unknown name of a message; `None`: it is about something else.
pub(crate) fn unknown_name(message: &str) -> Option<&str> {
    message.strip_prefix(UNKNOWN)?.split('`').next()
}

/// Returns the place of the last character before a token that naga found instead of `;`. The statement that lacks it ends there.
pub fn before_missing_semicolon(message: &str, location: SourceLocation, text: &str) -> Option<SourceLocation> {
    if !message.starts_with("expected `;`") {
        return None;
    }
    let mut before = text.get(..location.offset as usize)?.trim_end();
    // Comments are between the statements.
    loop {
        let line = before.rsplit('\n').next()?;
        before = match line.find("//") {
            Some(comment) => before.get(..before.len() - line.len() + comment)?.trim_end(),
            None => break,
        };
    }
    let last = before.chars().next_back()?;
    let offset = before.len() - last.len_utf8();
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Some(SourceLocation {
        line_number: before.matches('\n').count() as u32 + 1,
        line_position: (offset - line_start) as u32 + 1,
        offset: offset as u32,
        length: last.len_utf8() as u32,
    })
}

/// Removes the numbers of handles, ` [12]`.
fn without_handles(message: &str) -> String {
    let mut parts = message.split(" [");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(']') {
            Some((number, rest)) if number.chars().all(|letter| letter.is_ascii_digit()) => out.push_str(rest),
            _ => out.push_str(&format!(" [{part}")),
        }
    }
    out
}

/// Removes the names of the functions and expressions around the place, and begins with a small letter, as all messages.
fn without_context(message: &str) -> String {
    const CONTEXTS: [&str; 6] =
        ["Entry point ", "Function ", "Expression ", "Global variable ", "Local variable ", "Call to "];
    const END: &str = " is invalid: ";
    let mut rest = message;
    while let Some((context, inner)) = rest.split_once(END) {
        if !CONTEXTS.iter().any(|begin| format!("{context} ").starts_with(begin)) {
            break;
        }
        rest = inner;
    }
    let mut letters = rest.chars();
    let first = letters.next().map(|first| first.to_ascii_lowercase());
    first.into_iter().chain(letters).collect()
}

/// Writes a quoted token as all messages do.
fn with_backquotes(message: &str) -> String {
    match message.strip_suffix("found \"\"") {
        Some(begin) => format!("{begin}found the end of the file"),
        None => message.replace('"', "`"),
    }
}

/// The words before a name that they declare.
const DECLARATORS: [&str; 7] = ["fn", "let", "var", "const", "struct", "alias", "override"];

/// Returns the other names that a source declares: those after a keyword of declarations, and those before a type.
pub(crate) fn declared_names<'t>(text: &'t str, unknown: &str) -> Vec<&'t str> {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let (mut names, mut before, mut rest) = (Vec::new(), "", text);
    while let Some(begin) = rest.find(is_part) {
        let word_and_rest = rest.get(begin..).unwrap_or_default();
        let end = word_and_rest.find(|letter| !is_part(letter)).unwrap_or(word_and_rest.len());
        let (word, after) = word_and_rest.split_at(end);
        let has_type = after.trim_start().starts_with(':') && !after.trim_start().starts_with("::");
        let is_name = !word.starts_with(|letter: char| letter.is_ascii_digit()) && !DECLARATORS.contains(&word);
        if is_name && word != unknown && (has_type || DECLARATORS.contains(&before)) && !names.contains(&word) {
            names.push(word);
        }
        (before, rest) = (word, after);
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_semicolon_is_before_the_next_token() {
        for (text, line, column) in [
            ("fn f() {\n    let a = 1u\n    let b = 2u;\n}\n", 2, 14),
            ("fn f() {\n    let a = g(1u) // one\n\n    // two\n    let b = 2u;\n}\n", 2, 17),
        ] {
            let offset = text.find("let b").unwrap_or_default();
            let location = SourceLocation { line_number: 0, line_position: 0, offset: offset as u32, length: 3 };
            let found = before_missing_semicolon("expected `;`, found \"let\"", location, text);
            assert_eq!(found.map(|found| (found.line_number, found.line_position)), Some((line, column)), "{text}");
            assert_eq!(before_missing_semicolon("expected `)`, found \"let\"", location, text), None);
        }
    }

    #[test]
    fn messages_name_the_source_and_not_handles() {
        for (message, expected, part_of_help) in [
            ("no definition in scope for identifier: `coutn`", "cannot find `coutn`", "did you mean `count`?"),
            // A keyword is no name.
            ("no definition in scope for identifier: `fo`", "cannot find `fo`", "declare it, or correct its name"),
            (
                "Entry point main at Compute is invalid: The pointer [2] doesn't relate to a valid destination for a store",
                "the place cannot be assigned",
                "read_write",
            ),
            (
                "Function [3] 'f' is invalid: Expression [19] is invalid: The index is [a] wrong",
                "the index is [a] wrong",
                "valid WGSL",
            ),
            ("expected `;`, found \"@\"", "expected `;`, found `@`", "end the statement with `;`"),
            ("expected `)`, found \"@\"", "expected `)`, found `@`", "the statement before it"),
            ("expected expression, found \"\"", "expected expression, found the end of the file", "correct the syntax"),
            (
                "expected global item (`struct`) or the end of the file, found \"#\"",
                "expected a declaration, found `#`",
                "declare `fn`",
            ),
            (
                "Function [1] 'f' is invalid: Call to [0] is invalid: Requires 2 arguments, but 1 are provided",
                "requires 2 arguments, but 1 are provided",
                "the function declares",
            ),
            (
                "Function [1] 'f' is invalid: The `return` expression None does not match the declared return type Some([4])",
                "the function does not return its value",
                "`return …;`",
            ),
            (
                "automatic conversions cannot convert elements of `{AbstractFloat}` to `u32`",
                "automatic conversions cannot convert elements of a literal with a point to `u32`",
                "`1u`",
            ),
        ] {
            let (found, help) = explained(message, "fn f() { let count = 1; coutn = 2; }");
            assert_eq!(found, expected);
            assert!(help.contains(part_of_help), "{help}");
        }
    }
}
