//! Text of expressions, and where WGSL's grammar wants parentheses.
//!
//! In: texts of operands, each with the level of its outermost operator. Out: text with as few parentheses as WGSL §8.18
//! allows. Unlike Rust, WGSL does not order `&`, `|`, `^`, shifts and comparisons among each other: their operands are
//! parenthesised unless they are unary, and comparisons do not chain.

use crate::tree::Operator;

/// What the outermost operator of a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    /// A name, a literal, a call, something in parentheses: `.x` may follow.
    Primary,
    /// `-x`
    Unary,
    /// `a * b`
    Multiplicative,
    /// `a + b`
    Additive,
    Shift,
    Comparison,
    /// `&`, `|`, `^`, `&&`, `||`: chains of the same one need no parentheses.
    Chain(Operator),
}

/// The text of an expression.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub text: String,
    pub level: Level,
}

impl Text {
    pub(super) fn primary(text: impl Into<String>) -> Self {
        Text { text: text.into(), level: Level::Primary }
    }

    /// As it stands where `.x` follows.
    pub(super) fn postfixed(&self) -> String {
        self.unless(self.level == Level::Primary)
    }

    /// As it stands where an operator precedes that binds closest.
    pub(super) fn unary(&self) -> String {
        self.unless(matches!(self.level, Level::Primary | Level::Unary))
    }

    fn unless(&self, fits: bool) -> String {
        if fits { self.text.clone() } else { format!("({})", self.text) }
    }

    /// `-x`, `!x`, `~x`
    pub(super) fn prefixed(sign: char, inner: &Text) -> Text {
        // Two minus signs would be read as one token.
        let inner = if inner.text.starts_with('-') { format!("({})", inner.text) } else { inner.unary() };
        Text { text: format!("{sign}{inner}"), level: Level::Unary }
    }

    /// `left operator right`
    pub(super) fn binary(operator: Operator, left: &Text, right: &Text) -> Text {
        let level = level_of(operator);
        let left = left.unless(fits_left(level, left.level));
        // `a - -1.0` is legal, and unreadable.
        let double_sign = level == Level::Additive && right.text.starts_with('-');
        let right = right.unless(fits_right(level, right.level) && !double_sign);
        Text { text: format!("{left} {} {right}", operator.sign()), level }
    }

    /// `name(arguments)`
    pub(super) fn call(name: &str, arguments: &[Text]) -> Text {
        Text::primary(format!("{name}({})", arguments_text(arguments)))
    }
}

/// The level of `a operator b`.
pub(super) fn level_of(operator: Operator) -> Level {
    use Operator::*;
    match operator {
        Multiply | Divide | Remainder => Level::Multiplicative,
        Add | Subtract => Level::Additive,
        ShiftLeft | ShiftRight => Level::Shift,
        Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual => Level::Comparison,
        BitAnd | BitOr | BitXor | And | Or => Level::Chain(operator),
    }
}

fn fits_left(level: Level, operand: Level) -> bool {
    match (level, operand) {
        (Level::Multiplicative | Level::Additive, Level::Multiplicative) => true,
        (Level::Additive, Level::Additive) => true,
        (Level::Chain(operator), Level::Chain(other)) if operator == other => true,
        _ => fits_right(level, operand),
    }
}

fn fits_right(level: Level, operand: Level) -> bool {
    let unary = matches!(operand, Level::Primary | Level::Unary);
    let sum = unary || matches!(operand, Level::Multiplicative | Level::Additive | Level::Shift);
    match level {
        Level::Primary | Level::Unary | Level::Multiplicative | Level::Shift => unary,
        Level::Additive => unary || operand == Level::Multiplicative,
        Level::Comparison => sum,
        Level::Chain(operator) if operator.is_logical() => sum || operand == Level::Comparison,
        Level::Chain(_) => unary,
    }
}

/// Arguments of a call. `f(a < b, c > d)` would be read as a template list, so such a comparison gets parentheses.
pub(super) fn arguments_text(arguments: &[Text]) -> String {
    let texts = arguments.iter().enumerate().map(|(index, argument)| {
        let later = arguments.iter().skip(index + 1).any(|other| other.text.contains('>'));
        argument.unless(!(later && argument.text.contains(" < ") && argument.level != Level::Primary))
    });
    texts.collect::<Vec<_>>().join(", ")
}
