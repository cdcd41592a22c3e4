//! Names of emitted items.
//!
//! Input: names of the description. Output: valid Rust identifiers, even for names with an error.

use proc_macro2::{Ident, Span};

/// Returns the name of a buffer's module: `MostVisible` becomes `most_visible`, `ABuffer` `a_buffer`.
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

/// Returns an identifier of this name, a raw one if the name is a keyword of Rust.
pub(crate) fn identifier(name: &str, span: Span) -> Ident {
    if syn::parse_str::<Ident>(name).is_ok() {
        return Ident::new(name, span);
    }
    match name {
        "_" | "self" | "Self" | "super" | "crate" => Ident::new(&format!("{name}_"), span),
        _ => Ident::new_raw(name, span),
    }
}

#[cfg(test)]
mod tests {
    use proc_macro2::Span;

    use super::{identifier, module};

    #[test]
    fn modules_are_in_snake_case() {
        let cases = [
            ("Glass", "glass"),
            ("MostVisible", "most_visible"),
            ("ABuffer", "a_buffer"),
            ("KBuffer2", "k_buffer2"),
            ("Gpu3Buffer", "gpu3_buffer"),
            ("RGBA", "rgba"),
            ("Snake_Case", "snake_case"),
            ("Type", "r#type"),
            ("Super", "super_"),
        ];
        for (name, expected) in cases {
            assert_eq!(module(name, Span::call_site()).to_string(), expected, "{name}");
        }
    }

    #[test]
    fn keywords_of_rust_become_raw_identifiers() {
        assert_eq!(identifier("match", Span::call_site()).to_string(), "r#match");
        assert_eq!(identifier("crate", Span::call_site()).to_string(), "crate_");
        assert_eq!(identifier("depth", Span::call_site()).to_string(), "depth");
    }
}
