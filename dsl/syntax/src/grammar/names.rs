//! Names that a description declares: which a user may choose.
//!
//! In: a word as written, with its `r#` if it has one. Out: the name, reported where it cannot be used. Words that only
//! WGSL reserves are fine: `fragbuf_model::mangled` spells them otherwise there.

use fragbuf_model::{Spanned, codes};
use proc_macro2::Ident;
use syn::ext::IdentExt;

use crate::report::Report;

/// An identifier as the user wrote it.
pub(crate) fn written(word: &Ident, report: &Report) -> Spanned<String> {
    Spanned::new(word.to_string(), report.at(word.span()))
}

/// The name of a `what`, reported if no name can be so.
pub(crate) fn declared(word: &Spanned<String>, what: &str, report: &mut Report) -> Spanned<String> {
    let Spanned { value: name, origin } = self::word(word, report);
    if !is_identifier(&word.value) {
        // Already said.
    } else if !name.is_ascii() {
        let message = format!("the name `{name}` of this {what} has letters beyond ASCII");
        report.error(codes::NAME_RESERVED, &origin, message, "shader languages have only a-z, A-Z, 0-9 and _");
    } else if syn::parse_str::<Ident>(&word.value).is_err() {
        let message = format!("`{name}` is a word of Rust: no {what} can have this name");
        report.error(codes::NAME_RESERVED, &origin, message, format!("choose another, such as `{}`", other(&name)));
    } else if what != "buffer" && RESERVED.contains(&name.as_str()) {
        let message = format!("`{name}` is a name of the language: no {what} can have it too");
        report.error(codes::NAME_RESERVED, &origin, message, format!("choose another, such as `my_{name}`"));
    }
    Spanned::new(name, origin)
}

/// Names that closures already have a meaning for.
const RESERVED: [&str; 13] =
    ["vec2", "vec3", "vec4", "f32", "u32", "i32", "usize", "bool", "Vec2", "Vec3", "Vec4", "Fragment", "Uniforms"];

/// The buffer's name, which becomes the name of a type.
pub(crate) fn buffer(word: &Spanned<String>, report: &mut Report) -> Spanned<String> {
    let name = declared(word, "buffer", report);
    if name.value.starts_with(|first: char| first.is_ascii_lowercase() || first == '_') {
        let message = format!("the buffer's name `{}` is not in UpperCamelCase", name.value);
        let hint = format!("it becomes a type: write `{}`", upper_camel(&name.value));
        report.error(codes::UNEXPECTED, &name.origin, message, hint);
    }
    name
}

fn is_identifier(text: &str) -> bool {
    syn::parse::Parser::parse_str(Ident::parse_any, text).is_ok()
}

fn other(name: &str) -> String {
    match name {
        "type" => "kind".to_string(),
        "_" => "value".to_string(),
        _ => format!("{}_value", name.to_lowercase()),
    }
}

/// The nearest UpperCamel name.
fn upper_camel(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let camel: String = words
        .map(|word| {
            let mut letters = word.chars();
            let first = letters.next().map(|letter| letter.to_ascii_uppercase());
            first.into_iter().chain(letters).collect::<String>()
        })
        .collect();
    if camel.starts_with(|first: char| first.is_ascii_uppercase()) { camel } else { format!("Buffer{camel}") }
}

/// A word of the registry: any identifier will do. Only the builder can hand in something else.
pub(crate) fn word(word: &Spanned<String>, report: &mut Report) -> Spanned<String> {
    if !is_identifier(&word.value) {
        let message = format!("`{}` is not one word", word.value);
        report.error(
            codes::UNEXPECTED,
            &word.origin,
            message,
            "a word has letters, digits and `_`, and no digit first",
        );
    }
    let name = word.value.strip_prefix("r#").unwrap_or(&word.value);
    Spanned::new(name.to_string(), word.origin.clone())
}
