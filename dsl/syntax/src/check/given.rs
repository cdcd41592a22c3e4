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
    Given { source: source_of_operand(argument), ty, is_literal }
}

/// Returns the source of an expression.
pub(super) fn source(expr: &syn::Expr) -> String {
    let text = token_limits::compact(&token_limits::spaced(&expr.to_token_stream()));
    if text.chars().count() > LONGEST { "…".to_owned() } else { text }
}

/// Returns the source of the generic arguments of a call: `::<f32>`.
pub(super) fn source_of_generics(generics: &syn::AngleBracketedGenericArguments) -> String {
    token_limits::spaced(&generics.to_token_stream()).replace(' ', "")
}

/// Returns the source of an expression, in parentheses unless it is a name, a literal or a call.
pub(super) fn source_of_operand(expr: &syn::Expr) -> String {
    let source = source(expr);
    if is_primary(expr) || source == "…" { source } else { format!("({source})") }
}

/// Whether an expression needs no parentheses before a method call.
fn is_primary(expr: &syn::Expr) -> bool {
    use syn::Expr::{Call, Field, Index, Lit, MethodCall, Paren, Path};
    matches!(expr, Call(_) | Field(_) | Index(_) | Lit(_) | MethodCall(_) | Paren(_) | Path(_))
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
