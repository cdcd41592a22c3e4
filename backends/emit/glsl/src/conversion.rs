//! Prints conversions and reinterpretations.
//!
//! Input: `As` expressions. Output: constructors and functions such as `floatBitsToUint`. A saturating helper converts
//! floats to integers, because GLSL leaves values out of range undefined; a constructor is enough if the range is known to
//! fit. u64 converts to and from u32 only.

use naga::{BinaryOperator, BuiltIn, Expression, Handle, Literal, MathFunction, Scalar, ScalarKind, TypeInner};

use crate::function::FunctionPrinter;
use crate::helpers::Helper;
use crate::precedence::Text;
use crate::types::unsupported_scalar;

impl FunctionPrinter<'_, '_> {
    /// Prints a conversion or reinterpretation.
    pub fn convert(
        &mut self,
        expression: Handle<Expression>,
        operand: Handle<Expression>,
        kind: ScalarKind,
        width: Option<u8>,
    ) -> Text {
        if matches!(self.order.inner(operand), TypeInner::Matrix { .. }) {
            return self.text(operand);
        }
        let Some((lanes, from)) = self.shape(operand) else {
            return Text::primary(self.error("a conversion of this type", expression));
        };
        let to = Scalar { kind, width: width.unwrap_or(from.width) };
        for scalar in [from, to] {
            if crate::types::scalar_name(scalar).is_none() {
                return Text::primary(self.error(unsupported_scalar(scalar), expression));
            }
        }
        if from == to {
            return self.text(operand);
        }
        let wide = [from, to].contains(&Scalar::U64);
        if wide && !(from.kind == to.kind && width.is_some()) {
            return Text::primary(self.error("a conversion between u64 and a type other than u32", expression));
        }
        match (width, from.kind, to.kind) {
            (None, ScalarKind::Float, ScalarKind::Uint) => self.call("floatBitsToUint", &[operand]),
            (None, ScalarKind::Float, ScalarKind::Sint) => self.call("floatBitsToInt", &[operand]),
            (None, ScalarKind::Uint, ScalarKind::Float) => self.call("uintBitsToFloat", &[operand]),
            (None, ScalarKind::Sint, ScalarKind::Float) => self.call("intBitsToFloat", &[operand]),
            (Some(_), ScalarKind::Float, ScalarKind::Uint) if !self.fits(operand, -1.0, 4_294_967_296.0) => {
                self.call_helper(Helper::FloatToUint(lanes), &[operand])
            }
            (Some(_), ScalarKind::Float, ScalarKind::Sint)
                if !self.fits(operand, -2_147_483_649.0, 2_147_483_648.0) =>
            {
                self.call_helper(Helper::FloatToInt(lanes), &[operand])
            }
            _ => {
                let ty = self.type_name(expression);
                self.call(&ty, &[operand])
            }
        }
    }

    /// Prints a call of a built-in function or constructor.
    pub fn call(&mut self, name: &str, operands: &[Handle<Expression>]) -> Text {
        let operands: Vec<String> = operands.iter().map(|operand| self.expression(*operand)).collect();
        Text::primary(format!("{name}({})", operands.join(", ")))
    }

    /// Tests whether a float expression is known to be strictly between two bounds.
    fn fits(&self, expression: Handle<Expression>, low: f64, high: f64) -> bool {
        let (least, greatest) = self.range(expression);
        low < least && greatest < high
    }

    /// Returns the bounds of a float expression that follow from its form.
    fn range(&self, expression: Handle<Expression>) -> (f64, f64) {
        const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
        if let Some(Literal::F32(value)) = self.known_literal(expression) {
            return (value.into(), value.into());
        }
        if self.is_pixel_position(expression) {
            return (0.0, 1_048_576.0);
        }
        match self.function.expressions[expression] {
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let bounds =
                    |argument: Option<Handle<Expression>>| argument.map_or(ANY, |argument| self.range(argument));
                match fun {
                    MathFunction::Saturate
                    | MathFunction::Fract
                    | MathFunction::Unpack4x8unorm
                    | MathFunction::Unpack2x16unorm => (0.0, 1.0),
                    MathFunction::Clamp => (bounds(arg1).0, bounds(arg2).1),
                    MathFunction::Min => {
                        (f64::min(self.range(arg).0, bounds(arg1).0), f64::min(self.range(arg).1, bounds(arg1).1))
                    }
                    MathFunction::Max => {
                        (f64::max(self.range(arg).0, bounds(arg1).0), f64::max(self.range(arg).1, bounds(arg1).1))
                    }
                    MathFunction::Floor | MathFunction::Ceil | MathFunction::Round | MathFunction::Trunc => {
                        let (low, high) = self.range(arg);
                        (low.floor(), high.ceil())
                    }
                    _ => ANY,
                }
            }
            Expression::Binary { op: BinaryOperator::Multiply, left, right } => {
                product(self.range(left), self.range(right))
            }
            Expression::Binary { op: BinaryOperator::Add, left, right } => {
                let (left, right) = (self.range(left), self.range(right));
                (left.0 + right.0, left.1 + right.1)
            }
            Expression::AccessIndex { base, .. } if matches!(self.order.inner(base), TypeInner::Vector { .. }) => {
                self.range(base)
            }
            Expression::Swizzle { vector, .. } => self.range(vector),
            _ => ANY,
        }
    }

    /// Tests for `.x`, `.y` or `.xy` of the fragment's position, which lie between 0 and the largest target size.
    fn is_pixel_position(&self, expression: Handle<Expression>) -> bool {
        match self.function.expressions[expression] {
            Expression::AccessIndex { base, index: 0 | 1 } => self.is_position(base),
            Expression::Swizzle { size, vector, pattern } => {
                self.is_position(vector) && pattern[..size as usize].iter().all(|c| (*c as u32) < 2)
            }
            _ => false,
        }
    }

    /// Tests whether an expression is the fragment's position.
    fn is_position(&self, expression: Handle<Expression>) -> bool {
        let position =
            |binding: &Option<naga::Binding>| matches!(binding, Some(naga::Binding::BuiltIn(BuiltIn::Position { .. })));
        match self.function.expressions[expression] {
            Expression::FunctionArgument(index) => {
                self.function.arguments.get(index as usize).is_some_and(|argument| position(&argument.binding))
            }
            Expression::AccessIndex { base, index } => {
                let Expression::FunctionArgument(argument) = self.function.expressions[base] else { return false };
                let Some(argument) =
                    self.function.arguments.get(argument as usize).filter(|_| self.interface.is_some())
                else {
                    return false;
                };
                match self.printer.module.types[argument.ty].inner {
                    TypeInner::Struct { ref members, .. } => {
                        members.get(index as usize).is_some_and(|member| position(&member.binding))
                    }
                    _ => false,
                }
            }
            _ => false,
        }
    }
}

/// Returns the bounds of a product.
fn product(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let corners = [a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1];
    if corners.iter().any(|corner| corner.is_nan()) {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    (corners.iter().copied().fold(f64::INFINITY, f64::min), corners.iter().copied().fold(f64::NEG_INFINITY, f64::max))
}
