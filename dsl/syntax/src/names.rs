//! Names that a description declares or refers to.
//!
//! Input: an identifier as written, with `r#` if present. Output: the name; an error if it cannot be used. Names that only
//! WGSL reserves are valid: `fragbuf_model::mangled` renames them there.

use fragbuf_model::{Spanned, codes};
use proc_macro2::Ident;
use syn::ext::IdentExt;

use crate::report::Report;

/// The help for a name with non-ASCII characters.
pub(crate) const ASCII_ONLY: &str = "use only a-z, A-Z, 0-9 and _: shading languages accept no other characters";

/// Returns an identifier as the user wrote it.
pub(crate) fn written(identifier: &Ident, report: &Report) -> Spanned<String> {
    Spanned::new(identifier.to_string(), report.at(identifier.span()))
}

/// Returns a declared name without `r#`. Reports a name that a `what` cannot have.
pub(crate) fn declared(written: &Spanned<String>, what: &str, report: &mut Report) -> Spanned<String> {
    let Spanned { value: name, span } = identifier(written, report);
    if !is_identifier(&written.value) {
        // `identifier` reported it.
    } else if !name.is_ascii() {
        let message = format!("the {what} name `{name}` contains non-ASCII characters");
        report.error(codes::NAME_RESERVED, &span, message, ASCII_ONLY);
    } else if syn::parse_str::<Ident>(&written.value).is_err() {
        let message = format!("expected {what} name, found Rust keyword `{name}`");
        report.error(codes::NAME_RESERVED, &span, message, format!("choose another name, such as `{}`", other(&name)));
    } else if what != "buffer" && RESERVED.contains(&name.as_str()) {
        let message = format!("expected {what} name, found built-in name `{name}`");
        report.error(codes::NAME_RESERVED, &span, message, format!("choose another name, such as `my_{name}`"));
    }
    Spanned::new(name, span)
}

/// The names that are built into closures.
const RESERVED: [&str; 13] =
    ["vec2", "vec3", "vec4", "f32", "u32", "i32", "usize", "bool", "Vec2", "Vec3", "Vec4", "Fragment", "Uniforms"];

/// Returns the buffer's name, which becomes the name of a type.
pub(crate) fn buffer(written: &Spanned<String>, report: &mut Report) -> Spanned<String> {
    // Only the builder can pass several words as one name.
    if written.value.contains([' ', '-']) && written.value.is_ascii() {
        let name = upper_camel(&written.value);
        let message = format!("expected an identifier, found `{}`", written.value);
        let help = format!("a name is one word: write `{name}`");
        report.error(codes::UNEXPECTED_TOKEN, &written.span, message, help);
        return Spanned::new(name, written.span.clone());
    }
    let name = declared(written, "buffer", report);
    if name.value.starts_with(|first: char| first.is_ascii_lowercase() || first == '_') {
        let message = format!("the buffer name `{}` is not in UpperCamelCase", name.value);
        let help = format!("it becomes a type: write `{}`", upper_camel(&name.value));
        report.error(codes::UNEXPECTED_TOKEN, &name.span, message, help);
    }
    name
}

fn is_identifier(name: &str) -> bool {
    syn::parse::Parser::parse_str(Ident::parse_any, name).is_ok()
}

/// Returns a usable name in place of a keyword.
fn other(name: &str) -> String {
    match name {
        "type" => "kind".to_string(),
        "_" => "value".to_string(),
        _ => format!("{}_value", name.to_lowercase()),
    }
}

/// Returns the name in UpperCamelCase.
pub(crate) fn upper_camel(name: &str) -> String {
    let parts = name.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    let camel: String = parts
        .map(|part| {
            let mut letters = part.chars();
            let first = letters.next().map(|letter| letter.to_ascii_uppercase());
            first.into_iter().chain(letters).collect::<String>()
        })
        .collect();
    if camel.starts_with(|first: char| first.is_ascii_uppercase()) { camel } else { format!("Buffer{camel}") }
}

/// Returns a name of the registry without `r#`: any identifier is valid. Only the builder can pass something else.
pub(crate) fn identifier(written: &Spanned<String>, report: &mut Report) -> Spanned<String> {
    if !is_identifier(&written.value) {
        let message = format!("expected an identifier, found `{}`", written.value);
        let help = "an identifier has letters, digits and `_`, and does not start with a digit";
        report.error(codes::UNEXPECTED_TOKEN, &written.span, message, help);
    }
    let name = written.value.strip_prefix("r#").unwrap_or(&written.value);
    Spanned::new(name.to_string(), written.span.clone())
}
