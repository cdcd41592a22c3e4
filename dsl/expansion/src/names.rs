//! Names of emitted items.
//!
//! In: names of the description. Out: identifiers that Rust takes, whatever was wrong with the name.

use proc_macro2::{Ident, Span};

/// The module of a buffer: `MostVisible` becomes `most_visible`, `ABuffer` `a_buffer`.
pub(crate) fn module(name: &str, span: Span) -> Ident {
    let letters: Vec<char> = name.chars().collect();
    let mut snake = String::new();
    for (index, letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).and_then(|before| letters.get(before));
        let after = letters.get(index + 1);
        let begins = letter.is_ascii_uppercase()
            && before.is_some_and(|before| {
                before.is_ascii_lowercase()
                    || before.is_ascii_digit()
                    || before.is_ascii_uppercase() && after.is_some_and(char::is_ascii_lowercase)
            });
        if begins {
            snake.push('_');
        }
        snake.push(letter.to_ascii_lowercase());
    }
    identifier(&snake, span)
}

/// An identifier of this name, raw where it is a word of Rust.
pub(crate) fn identifier(name: &str, span: Span) -> Ident {
    if syn::parse_str::<Ident>(name).is_ok() {
        return Ident::new(name, span);
    }
    match name {
        "_" | "self" | "Self" | "super" | "crate" => Ident::new(&format!("{name}_"), span),
        _ => Ident::new_raw(name, span),
    }
}
