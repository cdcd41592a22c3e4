//! Prints WGSL's built-in functions as GLSL with the same meaning.
//!
//! Most differ only in name. The others print as expressions, or as calls of a function of `helpers`.

use naga::{
    DerivativeAxis, DerivativeControl, Expression, Handle, Literal, MathFunction, RelationalFunction, Scalar,
    ScalarKind,
};

use crate::function::FunctionPrinter;
use crate::helpers::Helper;
use crate::precedence::{Precedence, Text};

/// Returns the GLSL function with the same meaning.
fn plain_name(fun: MathFunction) -> Option<&'static str> {
    use MathFunction as M;
    Some(match fun {
        M::Abs => "abs",
        M::Min => "min",
        M::Max => "max",
        M::Cos => "cos",
        M::Cosh => "cosh",
        M::Sin => "sin",
        M::Sinh => "sinh",
        M::Tan => "tan",
        M::Tanh => "tanh",
        M::Acos => "acos",
        M::Asin => "asin",
        M::Atan | M::Atan2 => "atan",
        M::Asinh => "asinh",
        M::Acosh => "acosh",
        M::Atanh => "atanh",
        M::Radians => "radians",
        M::Degrees => "degrees",
        M::Ceil => "ceil",
        M::Floor => "floor",
        // Ties go to even in WGSL; GLSL's round() leaves that to the implementation.
        M::Round => "roundEven",
        M::Fract => "fract",
        M::Trunc => "trunc",
        M::Ldexp => "ldexp",
        M::Exp => "exp",
        M::Exp2 => "exp2",
        M::Log => "log",
        M::Log2 => "log2",
        M::Pow => "pow",
        M::Cross => "cross",
        M::Distance => "distance",
        M::Length => "length",
        M::Normalize => "normalize",
        M::FaceForward => "faceforward",
        M::Reflect => "reflect",
        M::Refract => "refract",
        M::Outer => "outerProduct",
        M::Sign => "sign",
        M::Fma => "fma",
        M::Step => "step",
        M::SmoothStep => "smoothstep",
        M::Sqrt => "sqrt",
        M::InverseSqrt => "inversesqrt",
        M::Inverse => "inverse",
        M::Transpose => "transpose",
        M::Determinant => "determinant",
        M::ReverseBits => "bitfieldReverse",
        M::Pack4x8snorm => "packSnorm4x8",
        M::Pack4x8unorm => "packUnorm4x8",
        M::Pack2x16snorm => "packSnorm2x16",
        M::Pack2x16unorm => "packUnorm2x16",
        M::Pack2x16float => "packHalf2x16",
        M::Unpack4x8snorm => "unpackSnorm4x8",
        M::Unpack4x8unorm => "unpackUnorm4x8",
        M::Unpack2x16snorm => "unpackSnorm2x16",
        M::Unpack2x16unorm => "unpackUnorm2x16",
        M::Unpack2x16float => "unpackHalf2x16",
        _ => return None,
    })
}

impl FunctionPrinter<'_, '_> {
    /// Prints a call of a built-in function.
    pub fn math(&mut self, expression: Handle<Expression>) -> Text {
        let Expression::Math { fun, arg, arg1, arg2, arg3 } = self.function.expressions[expression] else {
            return Text::primary(self.error("an expression that is not a built-in function", expression));
        };
        let operands: Vec<_> = [Some(arg), arg1, arg2, arg3].into_iter().flatten().collect();
        operands.iter().for_each(|operand| self.check_scalar(*operand));
        let (lanes, scalar) = self.shape(arg).map_or((1, None), |(lanes, scalar)| (lanes, Some(scalar)));
        let kind = scalar.map(|scalar| scalar.kind);
        let takes_wide = matches!(fun, MathFunction::Abs | MathFunction::Min | MathFunction::Max | MathFunction::Clamp);
        if scalar.is_some_and(|scalar| scalar.width > 4) && !takes_wide {
            return Text::primary(self.error(format!("the built-in function {fun:?} of u64 values"), expression));
        }
        match fun {
            // ES 3.1 has no fma; WGSL allows two roundings.
            MathFunction::Fma if self.printer.es() => self.multiply_add(&operands),
            MathFunction::Abs if kind == Some(ScalarKind::Uint) => self.text(arg),
            MathFunction::Clamp => self.clamp(&operands),
            MathFunction::Mix => self.call("mix", &operands),
            MathFunction::Saturate => {
                let value = self.expression(arg);
                Text::primary(format!("clamp({value}, 0.0, 1.0)"))
            }
            MathFunction::Dot if kind != Some(ScalarKind::Float) => self.integer_dot(&operands),
            MathFunction::Dot => self.call("dot", &operands),
            MathFunction::QuantizeToF16 => self.call_helper(Helper::QuantizeToHalf(lanes), &operands),
            MathFunction::CountOneBits => self.bit_function("bitCount", arg),
            MathFunction::FirstTrailingBit => self.bit_function("findLSB", arg),
            MathFunction::FirstLeadingBit => self.bit_function("findMSB", arg),
            MathFunction::CountLeadingZeros => self.count_leading_zeros(arg),
            MathFunction::CountTrailingZeros => self.count_trailing_zeros(arg),
            MathFunction::ExtractBits | MathFunction::InsertBits => self.bit_field(fun, &operands),
            MathFunction::Pack4xU8 => self.call_helper(Helper::PackBytes { signed: false, clamp: false }, &operands),
            MathFunction::Pack4xI8 => self.call_helper(Helper::PackBytes { signed: true, clamp: false }, &operands),
            MathFunction::Pack4xU8Clamp => {
                self.call_helper(Helper::PackBytes { signed: false, clamp: true }, &operands)
            }
            MathFunction::Pack4xI8Clamp => self.call_helper(Helper::PackBytes { signed: true, clamp: true }, &operands),
            MathFunction::Modf => self.call_helper(Helper::Modf(lanes), &operands),
            MathFunction::Frexp => self.call_helper(Helper::Frexp(lanes), &operands),
            MathFunction::Dot4U8Packed => self.call_helper(Helper::DotBytes { signed: false }, &operands),
            MathFunction::Dot4I8Packed => self.call_helper(Helper::DotBytes { signed: true }, &operands),
            MathFunction::Unpack4xU8 => self.call_helper(Helper::UnpackBytes { signed: false }, &operands),
            MathFunction::Unpack4xI8 => self.call_helper(Helper::UnpackBytes { signed: true }, &operands),
            fun => match plain_name(fun) {
                Some(name) => self.call(name, &operands),
                None => Text::primary(self.error(format!("the built-in function {fun:?}"), expression)),
            },
        }
    }

    /// Prints clamp(). GLSL leaves it undefined if low exceeds high; WGSL defines it as `min(max(value, low), high)`.
    fn clamp(&mut self, operands: &[Handle<Expression>]) -> Text {
        let [value, low, high] = operands else { return self.call("clamp", operands) };
        let ordered = match (self.known_literal(*low), self.known_literal(*high)) {
            (Some(Literal::U32(low)), Some(Literal::U32(high))) => low <= high,
            (Some(Literal::I32(low)), Some(Literal::I32(high))) => low <= high,
            (Some(Literal::F32(low)), Some(Literal::F32(high))) => low <= high,
            _ => false,
        };
        if ordered {
            return self.call("clamp", operands);
        }
        let (value, low, high) = (self.expression(*value), self.expression(*low), self.expression(*high));
        Text::primary(format!("min(max({value}, {low}), {high})"))
    }

    /// Prints a dot product of integers, which GLSL lacks, by component.
    fn integer_dot(&mut self, operands: &[Handle<Expression>]) -> Text {
        let [left, right] = operands else { return self.call("dot", operands) };
        let lanes = self.shape(*left).map_or(0, |(lanes, _)| usize::from(lanes));
        let (left, right) = (self.primary(*left), self.primary(*right));
        let terms: Vec<String> =
            ["x", "y", "z", "w"].iter().take(lanes).map(|c| format!("{left}.{c} * {right}.{c}")).collect();
        Text::new(terms.join(" + "), Precedence::Sum)
    }

    /// Prints a bit function. GLSL's return `int`; -1, for no bit, is all ones in both types.
    fn bit_function(&mut self, name: &str, value: Handle<Expression>) -> Text {
        let text = self.call(name, &[value]);
        if self.shape(value).is_some_and(|(_, scalar)| scalar.kind == ScalarKind::Uint) {
            let ty = self.type_with_scalar(value, Scalar::U32);
            return Text::primary(format!("{ty}({})", text.text));
        }
        text
    }

    fn count_leading_zeros(&mut self, value: Handle<Expression>) -> Text {
        let unsigned = self.type_with_scalar(value, Scalar::U32);
        let signed = self.shape(value).is_some_and(|(_, scalar)| scalar.kind == ScalarKind::Sint);
        let text = self.expression(value);
        if signed {
            // WGSL counts the sign bit; findMSB() of an int does not.
            return Text::new(format!("31 - findMSB({unsigned}({text}))"), Precedence::Sum);
        }
        Text::primary(format!("{unsigned}(31 - findMSB({text}))"))
    }

    fn count_trailing_zeros(&mut self, value: Handle<Expression>) -> Text {
        let unsigned = self.type_with_scalar(value, Scalar::U32);
        let signed = self.shape(value).is_some_and(|(_, scalar)| scalar.kind == ScalarKind::Sint);
        let text = self.expression(value);
        // For 0, findLSB() returns -1, all ones, so the minimum is 32.
        let count = format!("min({unsigned}(findLSB({text})), 32u)");
        if signed {
            let integers = self.type_with_scalar(value, Scalar::I32);
            return Text::primary(format!("{integers}({count})"));
        }
        Text::primary(count)
    }

    /// Prints extractBits() or insertBits(); a helper clamps a range that is not constant.
    fn bit_field(&mut self, fun: MathFunction, operands: &[Handle<Expression>]) -> Text {
        let extract = fun == MathFunction::ExtractBits;
        let Some((size, scalar)) = operands.first().and_then(|value| self.shape(*value)) else {
            return self.call("bitfieldExtract", operands);
        };
        let (values, range) = operands.split_at(if extract { 1 } else { 2 });
        let known: Vec<_> = range
            .iter()
            .filter_map(|part| if let Some(Literal::U32(part)) = self.known_literal(*part) { Some(part) } else { None })
            .collect();
        if let [offset, count] = known[..]
            && offset.saturating_add(count) <= 32
        {
            let name = if extract { "bitfieldExtract" } else { "bitfieldInsert" };
            let values: Vec<String> = values.iter().map(|value| self.expression(*value)).collect();
            return Text::primary(format!("{name}({}, {offset}, {count})", values.join(", ")));
        }
        let signed = scalar.kind == ScalarKind::Sint;
        let helper = if extract { Helper::ExtractBits { signed, size } } else { Helper::InsertBits { signed, size } };
        self.call_helper(helper, operands)
    }

    /// Prints fma() as a product and a sum.
    fn multiply_add(&mut self, operands: &[Handle<Expression>]) -> Text {
        let factors: Vec<String> = operands.iter().map(|operand| format!("({})", self.expression(*operand))).collect();
        match factors.as_slice() {
            [a, b, c] => Text::primary(format!("({a} * {b} + {c})")),
            _ => self.call("fma", operands),
        }
    }

    /// Prints a derivative.
    pub fn derivative(&mut self, axis: DerivativeAxis, control: DerivativeControl, value: Handle<Expression>) -> Text {
        let axis = match axis {
            DerivativeAxis::X => "dFdx",
            DerivativeAxis::Y => "dFdy",
            DerivativeAxis::Width => "fwidth",
        };
        let control = match control {
            // ES leaves the choice to the driver.
            DerivativeControl::Coarse if self.printer.es() => "",
            DerivativeControl::Fine if self.printer.es() => {
                return Text::primary(self.error("a fine derivative", value));
            }
            DerivativeControl::Coarse => "Coarse",
            DerivativeControl::Fine => "Fine",
            DerivativeControl::None => "",
        };
        self.call(&format!("{axis}{control}"), &[value])
    }

    /// Prints all(), any(), isnan() or isinf().
    pub fn relational(&mut self, fun: RelationalFunction, argument: Handle<Expression>) -> Text {
        let scalar = self.shape(argument).is_some_and(|(lanes, _)| lanes == 1);
        match fun {
            // For a scalar, all() and any() return the argument.
            RelationalFunction::All | RelationalFunction::Any if scalar => self.text(argument),
            RelationalFunction::All => self.call("all", &[argument]),
            RelationalFunction::Any => self.call("any", &[argument]),
            RelationalFunction::IsNan => self.call("isnan", &[argument]),
            RelationalFunction::IsInf => self.call("isinf", &[argument]),
        }
    }
}
