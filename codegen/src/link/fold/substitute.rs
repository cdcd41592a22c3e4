//! Finds declarations whose uses can be replaced: by nothing, by a literal, or by an argument.
//!
//! Input: the tokens of one declaration. Output: its substitute. Of the statements, only a single `return` is analysed.

use crate::link::token::{Token, TokenKind};

/// The replacement of the uses of a declaration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::link) enum Substitute {
    /// No replacement.
    #[default]
    None,
    /// For a function with an empty body: its calls are removed.
    Nothing,
    /// For a function that returns this literal.
    Literal(String),
    /// For a function that returns its argument of this number.
    Argument(usize),
    /// For a function that returns this member of the uniform block of the frame.
    FrameMember(String),
    /// For a constant that is this whole number.
    Integer(u64),
}

/// The uniform block of the frame: its members are the same for every invocation, and no shader writes them.
pub(super) const FRAME: &str = "frame";

/// Returns the substitute of a declaration.
pub(in crate::link) fn substitute(tokens: &[Token<'_>]) -> Substitute {
    match tokens {
        [first, rest @ ..] if first.text == "fn" => of_function(rest),
        [first, _, .., equals, value, _] if first.text == "const" && equals.text == "=" => {
            integer(value).map_or(Substitute::None, Substitute::Integer)
        }
        _ => Substitute::None,
    }
}

/// Returns the value of a literal without a fraction, with any suffix.
pub(super) fn integer(token: &Token<'_>) -> Option<u64> {
    let digits = token.text.trim_end_matches(['u', 'i']);
    match digits.strip_prefix("0x") {
        _ if token.kind != TokenKind::Number => None,
        Some(digits) => u64::from_str_radix(digits, 16).ok(),
        None => digits.parse().ok(),
    }
}

fn of_function(tokens: &[Token<'_>]) -> Substitute {
    let Some(open) = tokens.iter().position(|token| token.text == "{") else { return Substitute::None };
    match &tokens[open + 1..] {
        [_] => Substitute::Nothing,
        [keyword, value, _, _] if keyword.text == "return" => returned(value, &tokens[..open]),
        [keyword, base, dot, member, _, _] if keyword.text == "return" && base.text == FRAME && dot.text == "." => {
            match parameters(&tokens[..open]).any(|name| name == FRAME) {
                true => Substitute::None,
                false => Substitute::FrameMember(format!("{FRAME}.{}", member.text)),
            }
        }
        _ => Substitute::None,
    }
}

fn returned(value: &Token<'_>, signature: &[Token<'_>]) -> Substitute {
    match value.kind {
        _ if matches!(value.text, "true" | "false") => Substitute::Literal(value.text.to_owned()),
        // A number without a type could change at the call. A number with a fraction becomes `f32` there.
        TokenKind::Number if value.text.ends_with('u') => Substitute::Literal(value.text.to_owned()),
        TokenKind::Number if value.text.contains('.') && signature.last().is_some_and(|last| last.text == "f32") => {
            Substitute::Literal(value.text.to_owned())
        }
        TokenKind::Name => {
            parameters(signature).position(|name| name == value.text).map_or(Substitute::None, Substitute::Argument)
        }
        _ => Substitute::None,
    }
}

/// Returns the names before a colon. Types contain no colon.
fn parameters<'a>(signature: &'a [Token<'a>]) -> impl Iterator<Item = &'a str> {
    signature.windows(2).filter(|pair| pair[1].text == ":").map(|pair| pair[0].text)
}
