//! Names that a description declares: which a user may choose.
//!
//! In: an identifier. Out: the name as the user wrote it, reported where it cannot be used. Words that only WGSL
//! reserves are fine: `fragbuf_model::mangled` spells them otherwise there.

use fragbuf_model::{Spanned, codes};
use proc_macro2::{Ident, TokenTree};
use syn::ext::IdentExt;

use crate::report::Report;

/// The name of a `what`, reported if no name can be so.
pub(crate) fn declared(word: &Ident, what: &str, report: &mut Report) -> Spanned<String> {
    let origin = report.at(word.span());
    let name = word.unraw().to_string();
    if !name.is_ascii() {
        let message = format!("the name `{name}` of this {what} has letters beyond ASCII");
        report.error(codes::NAME_RESERVED, &origin, message, "shader languages have only a-z, A-Z, 0-9 and _");
    } else if is_rust_keyword(word) {
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

fn is_rust_keyword(word: &Ident) -> bool {
    syn::parse2::<Ident>(TokenTree::from(word.clone()).into()).is_err()
}

fn other(name: &str) -> String {
    match name {
        "type" => "kind".to_string(),
        "_" => "value".to_string(),
        _ => format!("{}_value", name.to_lowercase()),
    }
}

/// The nearest UpperCamel name.
pub(crate) fn upper_camel(name: &str) -> String {
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

/// A word of the registry: any identifier will do.
pub(crate) fn word(word: &Ident, report: &Report) -> Spanned<String> {
    Spanned::new(word.unraw().to_string(), report.at(word.span()))
}
