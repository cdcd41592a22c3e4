//! Prints WGSL operators as GLSL operators or calls with the same meaning.
//!
//! WGSL defines division by zero, remainders of negative operands and shifts by too many bits; GLSL leaves them undefined.
//! Unless the operands are known to be safe, the text has the WGSL meaning, if necessary through a function of `helpers`.

use naga::{BinaryOperator, Expression, Handle, Literal, ScalarKind, TypeInner, UnaryOperator};

use crate::function::FunctionPrinter;
use crate::helpers::Helper;
use crate::precedence::{Precedence, Text};
use crate::types::numeric_name;

/// Returns the symbol and the precedence of an operator.
fn symbol(op: BinaryOperator) -> (&'static str, Precedence) {
    match op {
        BinaryOperator::Add => ("+", Precedence::Sum),
        BinaryOperator::Subtract => ("-", Precedence::Sum),
        BinaryOperator::Multiply => ("*", Precedence::Product),
        BinaryOperator::Divide => ("/", Precedence::Product),
        BinaryOperator::Modulo => ("%", Precedence::Product),
        BinaryOperator::Equal => ("==", Precedence::Equality),
        BinaryOperator::NotEqual => ("!=", Precedence::Equality),
        BinaryOperator::Less => ("<", Precedence::Relation),
        BinaryOperator::LessEqual => ("<=", Precedence::Relation),
        BinaryOperator::Greater => (">", Precedence::Relation),
        BinaryOperator::GreaterEqual => (">=", Precedence::Relation),
        BinaryOperator::And => ("&", Precedence::BitAnd),
        BinaryOperator::ExclusiveOr => ("^", Precedence::BitXor),
        BinaryOperator::InclusiveOr => ("|", Precedence::BitOr),
        BinaryOperator::LogicalAnd => ("&&", Precedence::LogicalAnd),
        BinaryOperator::LogicalOr => ("||", Precedence::LogicalOr),
        BinaryOperator::ShiftLeft => ("<<", Precedence::Shift),
        BinaryOperator::ShiftRight => (">>", Precedence::Shift),
    }
}

/// Returns GLSL's function that compares vectors by component.
fn vector_comparison(op: BinaryOperator) -> Option<&'static str> {
    Some(match op {
        BinaryOperator::Equal => "equal",
        BinaryOperator::NotEqual => "notEqual",
        BinaryOperator::Less => "lessThan",
        BinaryOperator::LessEqual => "lessThanEqual",
        BinaryOperator::Greater => "greaterThan",
        BinaryOperator::GreaterEqual => "greaterThanEqual",
        _ => return None,
    })
}

/// Tests whether unnecessary parentheses help readers who do not remember the precedences.
fn reads_better(parent: Precedence, child: Precedence) -> bool {
    let bitwise = matches!(parent, Precedence::Shift | Precedence::BitAnd | Precedence::BitXor | Precedence::BitOr);
    let operator = (Precedence::BitOr..=Precedence::Product).contains(&child);
    (bitwise && operator && child != parent) || (parent == Precedence::LogicalOr && child == Precedence::LogicalAnd)
}

/// Prints an operator between two operands, with parentheses where needed.
fn join(symbol: &str, precedence: Precedence, left: Text, right: Text) -> Text {
    let left =
        if reads_better(precedence, left.precedence) { format!("({})", left.text) } else { left.at_least(precedence) };
    let right =
        if reads_better(precedence, right.precedence) { format!("({})", right.text) } else { right.above(precedence) };
    Text::new(format!("{left} {symbol} {right}"), precedence)
}

impl FunctionPrinter<'_, '_> {
    /// Prints `&&` or `||`.
    pub fn logical(&mut self, op: BinaryOperator, left: Handle<Expression>, right: Handle<Expression>) -> Text {
        let (symbol, precedence) = symbol(op);
        let left = self.text(left);
        let mut right = self.text(right);
        // `a && (b && c)` is `a && b && c`.
        if right.precedence == precedence {
            right.precedence = Precedence::Equality;
        }
        join(symbol, precedence, left, right)
    }

    /// Prints a binary operator.
    pub fn binary(
        &mut self,
        expression: Handle<Expression>,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Text {
        self.check_scalar(left);
        if let Some(text) = self.special_operator(expression, op, left, right) {
            return text;
        }
        let (symbol, precedence) = symbol(op);
        let (left, right) = (self.text(left), self.text(right));
        join(symbol, precedence, left, right)
    }

    /// Prints an operator that GLSL lacks or defines differently; returns none for others.
    fn special_operator(
        &mut self,
        expression: Handle<Expression>,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Option<Text> {
        if matches!(self.order.inner(left), TypeInner::Matrix { .. }) {
            return None;
        }
        let (lanes, scalar) = self.shape(left)?;
        match (op, scalar.kind) {
            (BinaryOperator::And | BinaryOperator::InclusiveOr, ScalarKind::Bool) => {
                Some(self.boolean(op, lanes, left, right))
            }
            (BinaryOperator::Divide | BinaryOperator::Modulo, _) if scalar.width > 4 => (!self.is_safe_divisor(right))
                .then(|| {
                    Text::primary(self.error("a division of u64 values by a divisor that may be zero", expression))
                }),
            (BinaryOperator::Divide, ScalarKind::Uint) if !self.is_safe_divisor(right) => {
                Some(self.call_helper(Helper::DivideUint(lanes), &[left, right]))
            }
            (BinaryOperator::Divide, ScalarKind::Sint) if !self.is_safe_divisor(right) => {
                Some(self.call_helper(Helper::DivideInt(lanes), &[left, right]))
            }
            (BinaryOperator::Modulo, ScalarKind::Uint) if !self.is_safe_divisor(right) => {
                Some(self.call_helper(Helper::RemainderUint(lanes), &[left, right]))
            }
            (BinaryOperator::Modulo, ScalarKind::Sint) => {
                Some(self.call_helper(Helper::RemainderInt(lanes), &[left, right]))
            }
            (BinaryOperator::Modulo, ScalarKind::Float) => {
                Some(self.call_helper(Helper::RemainderFloat(lanes), &[left, right]))
            }
            (BinaryOperator::ShiftLeft | BinaryOperator::ShiftRight, _) => Some(self.shift(op, left, right)),
            _ if lanes > 1 => {
                let name = vector_comparison(op)?;
                let (left, right) = (self.expression(left), self.expression(right));
                Some(Text::primary(format!("{name}({left}, {right})")))
            }
            _ => None,
        }
    }

    /// Prints `a & b` of booleans. GLSL has it for scalars only, as `&&`.
    fn boolean(&mut self, op: BinaryOperator, lanes: u8, left: Handle<Expression>, right: Handle<Expression>) -> Text {
        let and = op == BinaryOperator::And;
        if lanes == 1 {
            return self.logical(if and { BinaryOperator::LogicalAnd } else { BinaryOperator::LogicalOr }, left, right);
        }
        let (left, right) = (self.expression(left), self.expression(right));
        let symbol = if and { "&" } else { "|" };
        Text::primary(format!("bvec{lanes}(uvec{lanes}({left}) {symbol} uvec{lanes}({right}))"))
    }

    /// Prints a call of a helper.
    pub fn call_helper(&mut self, helper: Helper, operands: &[Handle<Expression>]) -> Text {
        let name = self.printer.helper(helper);
        let operands: Vec<String> = operands.iter().map(|operand| self.expression(*operand)).collect();
        Text::primary(format!("{name}({})", operands.join(", ")))
    }

    /// Tests whether a divisor is a literal other than 0 and -1.
    fn is_safe_divisor(&self, divisor: Handle<Expression>) -> bool {
        match self.known_literal(divisor) {
            Some(Literal::U32(value)) => value != 0,
            Some(Literal::U64(value)) => value != 0,
            Some(Literal::I32(value)) => value != 0 && value != -1,
            _ => false,
        }
    }

    /// Prints a shift. WGSL takes the amount modulo the bit width; in GLSL it must be less than the bit width.
    fn shift(&mut self, op: BinaryOperator, left: Handle<Expression>, right: Handle<Expression>) -> Text {
        let (symbol, precedence) = symbol(op);
        let bits = self.shape(left).map_or(32, |(_, scalar)| 8 * u32::from(scalar.width));
        let known = matches!(self.known_literal(right), Some(Literal::U32(amount)) if amount < bits);
        let safe = known || self.is_masked(right, bits);
        let left = self.text(left);
        let right_text = self.text(right);
        if safe {
            return join(symbol, precedence, left, right_text);
        }
        let mask = if self.shape(right).is_some_and(|(lanes, _)| lanes > 1) {
            format!("{}({}u)", self.type_name(right), bits - 1)
        } else {
            format!("{}u", bits - 1)
        };
        let masked = join("&", Precedence::BitAnd, right_text, Text::primary(mask));
        join(symbol, precedence, left, masked)
    }

    /// Tests whether an amount is masked to the bit width, as `x & 31u` for 32 bits.
    fn is_masked(&self, amount: Handle<Expression>, bits: u32) -> bool {
        let Expression::Binary { op: BinaryOperator::And, left, right } = self.function.expressions[amount] else {
            return false;
        };
        [left, right]
            .into_iter()
            .any(|side| matches!(self.known_literal(side), Some(Literal::U32(mask)) if mask < bits))
    }

    /// Prints a unary operator.
    pub fn unary(&mut self, op: UnaryOperator, operand: Handle<Expression>) -> Text {
        self.check_scalar(operand);
        let vector = matches!(self.order.inner(operand), TypeInner::Vector { .. });
        let text = self.text(operand);
        match op {
            UnaryOperator::LogicalNot if vector => Text::primary(format!("not({})", text.text)),
            UnaryOperator::LogicalNot => {
                Text::new(format!("!{}", text.at_least(Precedence::Primary)), Precedence::Unary)
            }
            UnaryOperator::BitwiseNot => {
                Text::new(format!("~{}", text.at_least(Precedence::Primary)), Precedence::Unary)
            }
            UnaryOperator::Negate => Text::new(format!("-{}", text.at_least(Precedence::Primary)), Precedence::Unary),
        }
    }

    /// Prints `!condition`; a comparison of integers prints as the opposite comparison.
    pub fn negated(&mut self, condition: Handle<Expression>) -> String {
        if let (Expression::Binary { op, left, right }, false) =
            (&self.function.expressions[condition], self.values.contains_key(&condition))
        {
            let (op, left, right) = (*op, *left, *right);
            let integers = self.shape(left).is_some_and(|(lanes, scalar)| {
                lanes == 1 && matches!(scalar.kind, ScalarKind::Uint | ScalarKind::Sint)
            });
            if let (true, Some(opposite)) = (integers, opposite(op)) {
                let (symbol, precedence) = symbol(opposite);
                let (left, right) = (self.text(left), self.text(right));
                return join(symbol, precedence, left, right).text;
            }
        }
        let text = self.text(condition);
        format!("!{}", text.at_least(Precedence::Primary))
    }

    /// Returns the type with the lanes of an expression and another scalar.
    pub fn type_with_scalar(&self, expression: Handle<Expression>, scalar: naga::Scalar) -> String {
        let size = match *self.order.inner(expression) {
            TypeInner::Vector { size, .. } => Some(size),
            _ => None,
        };
        numeric_name(size, scalar).unwrap_or_default()
    }
}

/// Returns the comparison with the opposite result.
fn opposite(op: BinaryOperator) -> Option<BinaryOperator> {
    Some(match op {
        BinaryOperator::Equal => BinaryOperator::NotEqual,
        BinaryOperator::NotEqual => BinaryOperator::Equal,
        BinaryOperator::Less => BinaryOperator::GreaterEqual,
        BinaryOperator::LessEqual => BinaryOperator::Greater,
        BinaryOperator::Greater => BinaryOperator::LessEqual,
        BinaryOperator::GreaterEqual => BinaryOperator::Less,
        _ => return None,
    })
}
