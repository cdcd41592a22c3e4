//! The source of an argument, as a suggestion repeats it.
//!
//! Input: a syntax tree. Output: its tokens without needless spaces, in parentheses unless it is a name, a literal or a call. All front
//! ends give the same text, because it is computed from the tokens.

use quote::ToTokens;

use crate::foreign_functions::Given;
use crate::token_limits;
use crate::types::Type;

/// The greatest length of a source that a suggestion repeats, in characters. A longer one is `…`.
const LONGEST: usize = 80;

/// Returns an argument with its source.
pub(super) fn given(argument: &syn::Expr, ty: Type, is_literal: bool) -> Given {
    let text = compact(&token_limits::spaced(&argument.to_token_stream()));
    let source = match text.chars().count() > LONGEST {
        true => "…".to_owned(),
        false if is_primary(argument) => text,
        false => format!("({text})"),
    };
    Given { source, ty, is_literal }
}

/// Whether an expression needs no parentheses before a method call.
fn is_primary(expr: &syn::Expr) -> bool {
    use syn::Expr::{Call, Field, Index, Lit, MethodCall, Paren, Path};
    matches!(expr, Call(_) | Field(_) | Index(_) | Lit(_) | MethodCall(_) | Paren(_) | Path(_))
}

/// Removes the spaces that are not usual from tokens separated by spaces.
fn compact(spaced: &str) -> String {
    let mut out = String::with_capacity(spaced.len());
    for token in spaced.split(' ') {
        let last = out.chars().next_back();
        let is_word = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ')';
        let is_joined = matches!(token, "." | "," | ";" | ")" | "]" | "::" | "..")
            || matches!(last, None | Some('(' | '[' | '.'))
            || out.ends_with("::")
            || (matches!(token, "(" | "[") && last.is_some_and(is_word) && !out.ends_with(" if"));
        if !is_joined {
            out.push(' ');
        }
        out.push_str(token);
    }
    // A sign belongs to its operand.
    if let Some(rest) = out.strip_prefix("- ") { format!("-{rest}") } else { out }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_as_a_user_writes_them() {
        for (source, expected) in [
            ("f.depth", "f.depth"),
            ("f.color.xyz()", "f.color.xyz()"),
            ("a+b*2.0", "(a + b * 2.0)"),
            ("-1.0", "(-1.0)"),
            ("vec2( x , y )", "vec2(x, y)"),
            ("std::f32::consts::PI", "std::f32::consts::PI"),
            ("v [ 0 ]", "v[0]"),
            ("(x)", "(x)"),
        ] {
            let parsed: Result<syn::Expr, _> = syn::parse_str(source);
            let given = parsed.map(|expr| given(&expr, Type::F32, false).source);
            assert_eq!(given.ok().as_deref(), Some(expected));
        }
    }
}
