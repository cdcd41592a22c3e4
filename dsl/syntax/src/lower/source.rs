//! Source of WGSL expressions, with the parentheses that WGSL's grammar needs.
//!
//! Input: sources of operands, each with its precedence. Output: source with as few parentheses as WGSL §8.18 allows.
//! Unlike Rust, WGSL defines no precedence between `&`, `|`, `^`, shifts and comparisons: their operands are parenthesised
//! unless they are unary, and comparisons do not chain.

use crate::tree::Operator;

/// The precedence of the outermost operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precedence {
    /// A name, a literal, a call, or parentheses: `.x` may follow.
    Primary,
    /// `-x`
    Unary,
    /// `a * b`
    Multiplicative,
    /// `a + b`
    Additive,
    Shift,
    Comparison,
    /// `&`, `|`, `^`, `&&`, `||`: chains of the same operator need no parentheses.
    Chain(Operator),
}

/// The source of an expression.
#[derive(Clone, Debug)]
pub(super) struct ExprSource {
    pub source: String,
    pub precedence: Precedence,
}

impl ExprSource {
    /// Returns a primary expression.
    pub(super) fn primary(source: impl Into<String>) -> Self {
        ExprSource { source: source.into(), precedence: Precedence::Primary }
    }

    /// Returns the source before `.x`.
    pub(super) fn postfixed(&self) -> String {
        self.parenthesised_unless(self.precedence == Precedence::Primary)
    }

    /// Returns the source after a unary operator.
    pub(super) fn unary(&self) -> String {
        self.parenthesised_unless(matches!(self.precedence, Precedence::Primary | Precedence::Unary))
    }

    /// Returns whether `a < ` before this source starts a template list: `a < b >> c` parses as the template `a<b>` and `> c`.
    fn closes_template(&self) -> bool {
        self.precedence == Precedence::Shift && self.source.contains(" >> ")
    }

    fn parenthesised_unless(&self, fits: bool) -> String {
        if fits { self.source.clone() } else { format!("({})", self.source) }
    }

    /// Returns `-x`, `!x` or `~x`.
    pub(super) fn prefixed(operator: char, inner: &ExprSource) -> ExprSource {
        // `--` would be one token.
        let inner = if inner.source.starts_with('-') { format!("({})", inner.source) } else { inner.unary() };
        ExprSource { source: format!("{operator}{inner}"), precedence: Precedence::Unary }
    }

    /// Returns `left operator right`.
    pub(super) fn binary(operator: Operator, left: &ExprSource, right: &ExprSource) -> ExprSource {
        let precedence = precedence_of(operator);
        let left = left.parenthesised_unless(fits_left(precedence, left.precedence));
        // `a - -1.0` is valid but hard to read.
        let double_sign = precedence == Precedence::Additive && right.source.starts_with('-');
        let closes_template = operator == Operator::Less && right.closes_template();
        let right =
            right.parenthesised_unless(fits_right(precedence, right.precedence) && !double_sign && !closes_template);
        ExprSource { source: format!("{left} {} {right}", operator.symbol()), precedence }
    }

    /// Returns `name(arguments)`.
    pub(super) fn call(name: &str, arguments: &[ExprSource]) -> ExprSource {
        ExprSource::primary(format!("{name}({})", arguments_source(arguments)))
    }
}

/// Returns the precedence of `a operator b`.
fn precedence_of(operator: Operator) -> Precedence {
    use Operator::*;
    match operator {
        Multiply | Divide | Remainder => Precedence::Multiplicative,
        Add | Subtract => Precedence::Additive,
        ShiftLeft | ShiftRight => Precedence::Shift,
        Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual => Precedence::Comparison,
        BitAnd | BitOr | BitXor | And | Or => Precedence::Chain(operator),
    }
}

/// Returns whether a left operand needs no parentheses.
fn fits_left(operator: Precedence, operand: Precedence) -> bool {
    match (operator, operand) {
        (Precedence::Multiplicative | Precedence::Additive, Precedence::Multiplicative) => true,
        (Precedence::Additive, Precedence::Additive) => true,
        (Precedence::Chain(operator), Precedence::Chain(other)) if operator == other => true,
        _ => fits_right(operator, operand),
    }
}

/// Returns whether a right operand needs no parentheses.
fn fits_right(operator: Precedence, operand: Precedence) -> bool {
    let unary = matches!(operand, Precedence::Primary | Precedence::Unary);
    let sum = unary || matches!(operand, Precedence::Multiplicative | Precedence::Additive | Precedence::Shift);
    match operator {
        Precedence::Primary | Precedence::Unary | Precedence::Multiplicative | Precedence::Shift => unary,
        Precedence::Additive => unary || operand == Precedence::Multiplicative,
        Precedence::Comparison => sum,
        Precedence::Chain(operator) if operator.is_logical() => sum || operand == Precedence::Comparison,
        Precedence::Chain(_) => unary,
    }
}

/// Returns the arguments of a call. WGSL parses `f(a < b, c > d)` as a template list, so such a comparison gets parentheses.
pub(super) fn arguments_source(arguments: &[ExprSource]) -> String {
    let sources = arguments.iter().enumerate().map(|(index, argument)| {
        let later = arguments.iter().skip(index + 1).any(|other| other.source.contains('>'));
        argument.parenthesised_unless(
            !(later && argument.source.contains(" < ") && argument.precedence != Precedence::Primary),
        )
    });
    sources.collect::<Vec<_>>().join(", ")
}
