//! What a declaration comes to: nothing, a constant, one of its arguments.
//!
//! In: the tokens of one declaration. Out: what may stand in place of its uses. Never looks into a statement other than a
//! single `return`.

use crate::link::token::{Token, TokenKind};

/// What may stand in place of a declaration's uses.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::link) enum Worth {
    /// The declaration itself.
    #[default]
    Itself,
    /// A function with an empty body.
    Nothing,
    /// A function that returns this literal.
    Literal(String),
    /// A function that returns its argument of this number.
    Argument(usize),
    /// A constant that is this whole number.
    Integer(u64),
}

/// Reads it off the tokens of a declaration.
pub(in crate::link) fn worth(tokens: &[Token<'_>]) -> Worth {
    match tokens {
        [first, rest @ ..] if first.text == "fn" => of_function(rest),
        [first, _, .., equals, value, _] if first.text == "const" && equals.text == "=" => {
            integer(value).map_or(Worth::Itself, Worth::Integer)
        }
        _ => Worth::Itself,
    }
}

/// A literal without a fraction, whatever its suffix.
pub(super) fn integer(token: &Token<'_>) -> Option<u64> {
    let digits = token.text.trim_end_matches(['u', 'i']);
    match digits.strip_prefix("0x") {
        _ if token.kind != TokenKind::Number => None,
        Some(digits) => u64::from_str_radix(digits, 16).ok(),
        None => digits.parse().ok(),
    }
}

fn of_function(tokens: &[Token<'_>]) -> Worth {
    let Some(open) = tokens.iter().position(|token| token.text == "{") else { return Worth::Itself };
    match &tokens[open + 1..] {
        [_] => Worth::Nothing,
        [word, value, _, _] if word.text == "return" => returned(value, &tokens[..open]),
        _ => Worth::Itself,
    }
}

fn returned(value: &Token<'_>, signature: &[Token<'_>]) -> Worth {
    match value.kind {
        _ if matches!(value.text, "true" | "false") => Worth::Literal(value.text.to_owned()),
        // Without a type of its own a number could become another at the call.
        TokenKind::Number if value.text.ends_with('u') || value.text.contains('.') => {
            Worth::Literal(value.text.to_owned())
        }
        TokenKind::Name => {
            parameters(signature).position(|name| name == value.text).map_or(Worth::Itself, Worth::Argument)
        }
        _ => Worth::Itself,
    }
}

/// The names before a colon: types hold none.
fn parameters<'a>(signature: &'a [Token<'a>]) -> impl Iterator<Item = &'a str> {
    signature.windows(2).filter(|pair| pair[1].text == ":").map(|pair| pair[0].text)
}
