//! Constants among the items: `const NEAR: f32 = 0.5;`, which the language has as functions.
//!
//! Input: tokens from `const`, `let` or `static`. Output: an error whose help is the function, and the name, so that its uses are not
//! reported.

use fragbuf_model::codes;
use proc_macro2::{TokenStream, TokenTree};

use super::cursor::{Cursor, is_punct};
use crate::report::Report;
use crate::{foreign_names, token_limits};

/// Returns whether a constant is next: `const name`, `let mut name`, not `const fn`.
pub(super) fn starts(cursor: &Cursor) -> bool {
    matches!(cursor.peek_second(), Some(TokenTree::Ident(next)) if next != "fn")
}

/// Reports a constant, moves behind its `;`, and returns its name.
pub(super) fn reject(cursor: &mut Cursor, report: &mut Report) -> Option<String> {
    let span = cursor.source_span(report);
    let found = cursor.describe();
    cursor.take();
    cursor.take_keyword("mut");
    let name = cursor.take_identifier().map(|name| name.to_string());
    let ty = take_until(cursor, '=');
    cursor.take_punct('=');
    let value = take_until(cursor, ';');
    cursor.take_punct(';');
    let ty = match ty.iter().find(|token| matches!(token, TokenTree::Ident(_))) {
        Some(ty) => closure_type(&ty.to_string()),
        None => type_of_value(&value).to_owned(),
    };
    let value = match value.is_empty() {
        true => "0.5".to_owned(),
        false => token_limits::compact(&token_limits::spaced(&value.into_iter().collect::<TokenStream>())),
    };
    let called = name.as_deref().unwrap_or("name");
    let help =
        format!("a constant is a function: write `fn {called}() -> {ty} {{ {value} }}`, and call it as `{called}()`");
    report.error(codes::UNEXPECTED_TOKEN, &span, format!("expected an item, found {found}"), help);
    name
}

fn take_until(cursor: &mut Cursor, end: char) -> Vec<TokenTree> {
    let mut tokens = Vec::new();
    while !cursor.is_done() && !cursor.at_punct(end) && !cursor.at_punct(';') {
        tokens.extend(cursor.take());
    }
    tokens
}

/// Returns the type of a closure for one that may be of another language.
fn closure_type(name: &str) -> String {
    foreign_names::rust_type(name).and_then(|foreign| foreign.own).unwrap_or_else(|| name.to_owned())
}

/// Returns the type of a value without a type.
fn type_of_value(value: &[TokenTree]) -> &'static str {
    let first = value.iter().find(|token| !is_punct(Some(token), '-'));
    match first {
        Some(TokenTree::Ident(name)) => match name.to_string().as_str() {
            "true" | "false" => "bool",
            "vec2" | "Vec2" => "Vec2",
            "vec3" | "Vec3" => "Vec3",
            "vec4" | "Vec4" => "Vec4",
            _ => "f32",
        },
        Some(TokenTree::Literal(literal)) => {
            let is_integer = literal.to_string().chars().all(|letter| letter.is_ascii_digit() || letter == '_');
            match (is_integer, is_punct(value.first(), '-')) {
                (true, true) => "i32",
                (true, false) => "u32",
                _ => "f32",
            }
        }
        _ => "f32",
    }
}
