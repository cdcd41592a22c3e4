//! Compiles unary and binary operators, component by component.

use naga::{BinaryOperator, Expression, Handle, ScalarKind, TypeInner, UnaryOperator};

use super::compiler::{Compiler, Result};
use crate::operation::{Op, Word};
use crate::scalar::{Binary, Unary};
use crate::wide::Wide;

/// An operation on 32-bit words or on 64-bit integers.
enum NumericOp {
    Narrow(Binary),
    Wide(Wide),
}

impl Compiler<'_> {
    pub(super) fn unary(&mut self, operator: UnaryOperator, expression: Handle<Expression>) -> Result<Word> {
        let inner = self.type_of(expression);
        let total = self.layouts.dense(inner)?;
        let (kind, width) = self.kind_of(inner)?;
        let a = self.words(expression)?;
        if width == 2 {
            let op = match operator {
                UnaryOperator::Negate => Wide::Negate,
                UnaryOperator::BitwiseNot | UnaryOperator::LogicalNot => Wide::Complement,
            };
            return Ok(self.each_wide(op, a, a, total / 2, 2));
        }
        let op = match (operator, kind) {
            (UnaryOperator::Negate, ScalarKind::Float) => Unary::NegateF,
            (UnaryOperator::Negate, _) => Unary::Negate,
            (UnaryOperator::BitwiseNot, ScalarKind::Bool) | (UnaryOperator::LogicalNot, _) => Unary::Not,
            (UnaryOperator::BitwiseNot, _) => Unary::Complement,
        };
        Ok(self.each(op, a, total))
    }

    pub(super) fn binary(
        &mut self,
        operator: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Result<Word> {
        let (left_type, right_type) = (self.type_of(left), self.type_of(right));
        let (a, b) = (self.words(left)?, self.words(right)?);
        if operator == BinaryOperator::Multiply
            && let Some(product) = self.product(left_type, a, right_type, b)?
        {
            return Ok(product);
        }
        let (kind, width) = self.kind_of(left_type)?;
        let count = |inner: &TypeInner| Ok::<_, String>(self.layouts.dense(inner)? / width);
        let left_count = count(left_type)?;
        // The shift amount is always 32 bits wide.
        let right_count = self.layouts.dense(right_type)? / self.kind_of(right_type)?.1;
        let total = left_count.max(right_count);
        // A scalar is combined with every component of a vector.
        let (left_step, right_step) = (u32::from(left_count > 1), u32::from(right_count > 1));
        let swapped = matches!(operator, BinaryOperator::Greater | BinaryOperator::GreaterEqual);
        let (a, b, left_step, right_step) =
            if swapped { (b, a, right_step, left_step) } else { (a, b, left_step, right_step) };
        match numeric_op(operator, kind, width)? {
            NumericOp::Narrow(op) => {
                let to = self.take(total);
                for number in 0..total {
                    let (a, b) = (a + number * left_step, b + number * right_step);
                    self.push(Op::Binary { op, to: to + number, a, b });
                }
                Ok(to)
            }
            NumericOp::Wide(op) => {
                let (left_width, right_width, result) = op.widths();
                let to = self.take(total * result);
                for number in 0..total {
                    let (a, b) = (a + number * left_step * left_width, b + number * right_step * right_width);
                    self.push(Op::Wide { op, to: to + number * result, a, b });
                }
                Ok(to)
            }
        }
    }

    /// Applies an operation to each of `count` words.
    pub(super) fn each(&mut self, op: Unary, a: Word, count: u32) -> Word {
        let to = self.take(count);
        for number in 0..count {
            self.push(Op::Unary { op, to: to + number, a: a + number });
        }
        to
    }

    /// Applies an operation to each pair of words.
    pub(super) fn pairs(&mut self, op: Binary, a: Word, b: Word, count: u32) -> Word {
        let to = self.take(count);
        for number in 0..count {
            self.push(Op::Binary { op, to: to + number, a: a + number, b: b + number });
        }
        to
    }

    /// Applies an operation to each of `count` numbers; `step` is the width of the operands.
    pub(super) fn each_wide(&mut self, op: Wide, a: Word, b: Word, count: u32, step: u32) -> Word {
        let (_, _, result) = op.widths();
        let to = self.take(count * result);
        for number in 0..count {
            let (a, b) = (a + number * step, b + number * step);
            self.push(Op::Wide { op, to: to + number * result, a, b });
        }
        to
    }
}

fn numeric_op(operator: BinaryOperator, kind: ScalarKind, width: u32) -> Result<NumericOp> {
    use BinaryOperator as B;
    let is_signed = kind == ScalarKind::Sint;
    if width == 2 {
        return Ok(NumericOp::Wide(match operator {
            B::Add => Wide::Add,
            B::Subtract => Wide::Subtract,
            B::Multiply => Wide::Multiply,
            B::Divide => {
                if is_signed {
                    Wide::DivideS
                } else {
                    Wide::DivideU
                }
            }
            B::Modulo => {
                if is_signed {
                    Wide::RemainderS
                } else {
                    Wide::RemainderU
                }
            }
            B::Equal => Wide::Equal,
            B::NotEqual => Wide::NotEqual,
            B::Less | B::Greater => {
                if is_signed {
                    Wide::LessS
                } else {
                    Wide::LessU
                }
            }
            B::LessEqual | B::GreaterEqual => {
                if is_signed {
                    Wide::LessEqualS
                } else {
                    Wide::LessEqualU
                }
            }
            B::And | B::LogicalAnd => Wide::And,
            B::InclusiveOr | B::LogicalOr => Wide::Or,
            B::ExclusiveOr => Wide::ExclusiveOr,
            B::ShiftLeft => Wide::ShiftLeftN,
            B::ShiftRight => {
                if is_signed {
                    Wide::ShiftRightSN
                } else {
                    Wide::ShiftRightUN
                }
            }
        }));
    }
    if kind == ScalarKind::Float {
        return Ok(NumericOp::Narrow(match operator {
            B::Add => Binary::AddF,
            B::Subtract => Binary::SubtractF,
            B::Multiply => Binary::MultiplyF,
            B::Divide => Binary::DivideF,
            B::Modulo => Binary::RemainderF,
            B::Equal => Binary::EqualF,
            B::NotEqual => Binary::NotEqualF,
            B::Less | B::Greater => Binary::LessF,
            B::LessEqual | B::GreaterEqual => Binary::LessEqualF,
            _ => return Err("bitwise operators on floats".to_owned()),
        }));
    }
    Ok(NumericOp::Narrow(match operator {
        B::Add => Binary::Add,
        B::Subtract => Binary::Subtract,
        B::Multiply => Binary::Multiply,
        B::Divide => {
            if is_signed {
                Binary::DivideS
            } else {
                Binary::DivideU
            }
        }
        B::Modulo => {
            if is_signed {
                Binary::RemainderS
            } else {
                Binary::RemainderU
            }
        }
        B::Equal => Binary::Equal,
        B::NotEqual => Binary::NotEqual,
        B::Less | B::Greater => {
            if is_signed {
                Binary::LessS
            } else {
                Binary::LessU
            }
        }
        B::LessEqual | B::GreaterEqual => {
            if is_signed {
                Binary::LessEqualS
            } else {
                Binary::LessEqualU
            }
        }
        B::And | B::LogicalAnd => Binary::And,
        B::InclusiveOr | B::LogicalOr => Binary::Or,
        B::ExclusiveOr => Binary::ExclusiveOr,
        B::ShiftLeft => Binary::ShiftLeft,
        B::ShiftRight => {
            if is_signed {
                Binary::ShiftRightS
            } else {
                Binary::ShiftRightU
            }
        }
    }))
}
