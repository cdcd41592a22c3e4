//! Operators: WGSL operators in, GLSL operators or calls of the same meaning out.
//!
//! Where GLSL leaves undefined what WGSL defines (division by zero, remainders of negatives, wide shifts) and the operands
//! are not known to be harmless, the text says what WGSL means, if need be through a function of `helpers`.

use naga::{BinaryOperator, Expression, Handle, Literal, ScalarKind, TypeInner, UnaryOperator};

use crate::expression::{Level, Text};
use crate::function::FunctionPrinter;
use crate::helpers::Helper;
use crate::types::numeric_name;

fn symbol(op: BinaryOperator) -> (&'static str, Level) {
    match op {
        BinaryOperator::Add => ("+", Level::Sum),
        BinaryOperator::Subtract => ("-", Level::Sum),
        BinaryOperator::Multiply => ("*", Level::Product),
        BinaryOperator::Divide => ("/", Level::Product),
        BinaryOperator::Modulo => ("%", Level::Product),
        BinaryOperator::Equal => ("==", Level::Equality),
        BinaryOperator::NotEqual => ("!=", Level::Equality),
        BinaryOperator::Less => ("<", Level::Relation),
        BinaryOperator::LessEqual => ("<=", Level::Relation),
        BinaryOperator::Greater => (">", Level::Relation),
        BinaryOperator::GreaterEqual => (">=", Level::Relation),
        BinaryOperator::And => ("&", Level::BitAnd),
        BinaryOperator::ExclusiveOr => ("^", Level::BitXor),
        BinaryOperator::InclusiveOr => ("|", Level::BitOr),
        BinaryOperator::LogicalAnd => ("&&", Level::LogicalAnd),
        BinaryOperator::LogicalOr => ("||", Level::LogicalOr),
        BinaryOperator::ShiftLeft => ("<<", Level::Shift),
        BinaryOperator::ShiftRight => (">>", Level::Shift),
    }
}

/// GLSL's comparison of vectors, component by component.
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

/// Whether the parentheses, though not needed, spare the reader a look at the table of precedences.
fn reads_better(parent: Level, child: Level) -> bool {
    let bitwise = matches!(parent, Level::Shift | Level::BitAnd | Level::BitXor | Level::BitOr);
    let operator = (Level::BitOr..=Level::Product).contains(&child);
    (bitwise && operator && child != parent) || (parent == Level::LogicalOr && child == Level::LogicalAnd)
}

fn join(symbol: &str, level: Level, left: Text, right: Text) -> Text {
    let left = if reads_better(level, left.level) { format!("({})", left.text) } else { left.at_least(level) };
    let right = if reads_better(level, right.level) { format!("({})", right.text) } else { right.above(level) };
    Text::new(format!("{left} {symbol} {right}"), level)
}

impl FunctionPrinter<'_, '_> {
    pub fn logical(&mut self, op: BinaryOperator, left: Handle<Expression>, right: Handle<Expression>) -> Text {
        let (symbol, level) = symbol(op);
        let left = self.text(left);
        let mut right = self.text(right);
        // `a && (b && c)` is `a && b && c`.
        if right.level == level {
            right.level = Level::Equality;
        }
        join(symbol, level, left, right)
    }

    pub fn binary(
        &mut self,
        expression: Handle<Expression>,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Text {
        self.check_scalar(left);
        if let Some(text) = self.special(expression, op, left, right) {
            return text;
        }
        let (symbol, level) = symbol(op);
        let (left, right) = (self.text(left), self.text(right));
        join(symbol, level, left, right)
    }

    /// The operators that GLSL has otherwise, or not with this meaning.
    fn special(
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
                .then(|| Text::primary(self.error("a division of u64 values by what may be zero", expression))),
            (BinaryOperator::Divide, ScalarKind::Uint) if !self.is_safe_divisor(right) => {
                Some(self.help(Helper::DivideUint(lanes), &[left, right]))
            }
            (BinaryOperator::Divide, ScalarKind::Sint) if !self.is_safe_divisor(right) => {
                Some(self.help(Helper::DivideInt(lanes), &[left, right]))
            }
            (BinaryOperator::Modulo, ScalarKind::Uint) if !self.is_safe_divisor(right) => {
                Some(self.help(Helper::RemainderUint(lanes), &[left, right]))
            }
            (BinaryOperator::Modulo, ScalarKind::Sint) => Some(self.help(Helper::RemainderInt(lanes), &[left, right])),
            (BinaryOperator::Modulo, ScalarKind::Float) => {
                Some(self.help(Helper::RemainderFloat(lanes), &[left, right]))
            }
            (BinaryOperator::ShiftLeft | BinaryOperator::ShiftRight, _) => Some(self.shift(op, left, right)),
            _ if lanes > 1 => {
                let name = vector_comparison(op)?;
                let _ = expression;
                let (left, right) = (self.expression(left), self.expression(right));
                Some(Text::primary(format!("{name}({left}, {right})")))
            }
            _ => None,
        }
    }

    /// `a & b` of truth values; GLSL has it for scalars only, as `&&`.
    fn boolean(&mut self, op: BinaryOperator, lanes: u8, left: Handle<Expression>, right: Handle<Expression>) -> Text {
        let and = op == BinaryOperator::And;
        if lanes == 1 {
            return self.logical(if and { BinaryOperator::LogicalAnd } else { BinaryOperator::LogicalOr }, left, right);
        }
        let (left, right) = (self.expression(left), self.expression(right));
        let symbol = if and { "&" } else { "|" };
        Text::primary(format!("bvec{lanes}(uvec{lanes}({left}) {symbol} uvec{lanes}({right}))"))
    }

    /// Calls a helper with the operands.
    pub fn help(&mut self, helper: Helper, operands: &[Handle<Expression>]) -> Text {
        let name = self.printer.helper(helper);
        let operands: Vec<String> = operands.iter().map(|operand| self.expression(*operand)).collect();
        Text::primary(format!("{name}({})", operands.join(", ")))
    }

    fn is_safe_divisor(&self, divisor: Handle<Expression>) -> bool {
        match self.known(divisor) {
            Some(Literal::U32(value)) => value != 0,
            Some(Literal::U64(value)) => value != 0,
            Some(Literal::I32(value)) => value != 0 && value != -1,
            _ => false,
        }
    }

    /// WGSL shifts by the amount modulo the bits of what is shifted; GLSL by less than those only.
    fn shift(&mut self, op: BinaryOperator, left: Handle<Expression>, right: Handle<Expression>) -> Text {
        let (symbol, level) = symbol(op);
        let bits = self.shape(left).map_or(32, |(_, scalar)| 8 * u32::from(scalar.width));
        let known = matches!(self.known(right), Some(Literal::U32(amount)) if amount < bits);
        let harmless = known || self.is_masked(right, bits);
        let left = self.text(left);
        let right_text = self.text(right);
        if harmless {
            return join(symbol, level, left, right_text);
        }
        let mask = if self.shape(right).is_some_and(|(lanes, _)| lanes > 1) {
            format!("{}({}u)", self.type_name(right), bits - 1)
        } else {
            format!("{}u", bits - 1)
        };
        let masked = join("&", Level::BitAnd, right_text, Text::primary(mask));
        join(symbol, level, left, masked)
    }

    /// Already `x & 31u` or less, for 32 bits.
    fn is_masked(&self, amount: Handle<Expression>, bits: u32) -> bool {
        let Expression::Binary { op: BinaryOperator::And, left, right } = self.function.expressions[amount] else {
            return false;
        };
        [left, right].into_iter().any(|side| matches!(self.known(side), Some(Literal::U32(mask)) if mask < bits))
    }

    pub fn unary(&mut self, op: UnaryOperator, operand: Handle<Expression>) -> Text {
        self.check_scalar(operand);
        let vector = matches!(self.order.inner(operand), TypeInner::Vector { .. });
        let text = self.text(operand);
        match op {
            UnaryOperator::LogicalNot if vector => Text::primary(format!("not({})", text.text)),
            UnaryOperator::LogicalNot => Text::new(format!("!{}", text.at_least(Level::Primary)), Level::Unary),
            UnaryOperator::BitwiseNot => Text::new(format!("~{}", text.at_least(Level::Primary)), Level::Unary),
            UnaryOperator::Negate => Text::new(format!("-{}", text.at_least(Level::Primary)), Level::Unary),
        }
    }

    /// `!condition`; comparisons of integers turn around instead.
    pub fn negated(&mut self, condition: Handle<Expression>) -> String {
        if let (Expression::Binary { op, left, right }, false) =
            (&self.function.expressions[condition], self.values.contains_key(&condition))
        {
            let (op, left, right) = (*op, *left, *right);
            let integers = self.shape(left).is_some_and(|(lanes, scalar)| {
                lanes == 1 && matches!(scalar.kind, ScalarKind::Uint | ScalarKind::Sint)
            });
            if let (true, Some(opposite)) = (integers, opposite(op)) {
                let (symbol, level) = symbol(opposite);
                let (left, right) = (self.text(left), self.text(right));
                return join(symbol, level, left, right).text;
            }
        }
        let text = self.text(condition);
        format!("!{}", text.at_least(Level::Primary))
    }

    /// The type with the lanes of an expression and another scalar.
    pub fn like(&self, expression: Handle<Expression>, scalar: naga::Scalar) -> String {
        let size = match *self.order.inner(expression) {
            TypeInner::Vector { size, .. } => Some(size),
            _ => None,
        };
        numeric_name(size, scalar).unwrap_or_default()
    }
}

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
