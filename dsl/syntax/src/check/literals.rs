//! Literals: numbers and `bool`.
//!
//! Input: a literal. Output: its value, with a type that may be inferred later. Ranges are checked when all types are
//! known, because `3000000000` fits a `u32` and not an `i32`.

use fragbuf_model::{SourceSpan, codes};

use super::checker::{Checker, IntegerLiteral};
use crate::tree::{Expr, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn literal(&mut self, literal: &syn::Lit) -> Expr {
        let span = self.at(literal.span());
        match literal {
            syn::Lit::Bool(literal) => Expr::new(Kind::Bool(literal.value), Type::Bool, span),
            syn::Lit::Int(number) if matches!(number.suffix(), "f32" | "f64") => {
                self.float(number.base10_digits(), number.suffix(), span)
            }
            syn::Lit::Int(number) => self.integer(number, span, false),
            syn::Lit::Float(number) => self.float(number.base10_digits(), number.suffix(), span),
            _ => self.unsupported(span, "this literal is not supported", "use numbers, vectors and `bool`"),
        }
    }

    /// Checks an integer literal; `negative` is whether `-` precedes it.
    pub(super) fn integer(&mut self, number: &syn::LitInt, span: SourceSpan, negative: bool) -> Expr {
        let ty = match number.suffix() {
            "" => self.inference.integer(),
            "u32" => Type::U32,
            "i32" => Type::I32,
            "usize" => Type::Usize,
            other => {
                let help = "integers are `u32`, `i32` or `usize`";
                return self.unsupported(span, format!("integers have no suffix `{other}`"), help);
            }
        };
        let Ok(value) = number.base10_parse::<u64>() else {
            self.out_of_range(&span, number.base10_digits());
            return Expr::error(span);
        };
        self.integers.push(IntegerLiteral { value, ty, span: span.clone(), negative });
        Expr::new(Kind::Integer(value), ty, span)
    }

    fn float(&mut self, digits: &str, suffix: &str, span: SourceSpan) -> Expr {
        let ty = match suffix {
            "" => self.inference.float(),
            "f32" => Type::F32,
            other => {
                let message = format!("floats have no suffix `{other}` here");
                return self.unsupported(span, message, "write the suffix `f32` or none");
            }
        };
        match digits.parse::<f32>() {
            Ok(value) if value.is_finite() => Expr::new(Kind::Float(value), ty, span),
            _ => {
                let message = format!("literal `{digits}` out of range for `f32`");
                self.report.error(codes::OUT_OF_RANGE, &span, message, "the maximum is `f32::MAX`, about 3.4e38");
                Expr::error(span)
            }
        }
    }

    fn out_of_range(&mut self, span: &SourceSpan, digits: &str) {
        let message = format!("literal `{digits}` out of range for 32 bits");
        let help = format!("the maximum `u32` is {}, the maximum `i32` is {}", u32::MAX, i32::MAX);
        self.report.error(codes::OUT_OF_RANGE, span, message, help);
    }

    /// Reports an integer that is out of range for its type.
    pub(super) fn check_range(&mut self, literal: &IntegerLiteral) {
        let ty = self.inference.resolve_or_default(literal.ty);
        let max = match ty {
            Type::I32 if literal.negative => 1 << 31,
            Type::I32 => (1 << 31) - 1,
            _ => u64::from(u32::MAX),
        };
        if literal.value <= max {
            return;
        }
        let message = format!("literal `{}` out of range for `{}`", literal.value, ty.rust());
        let help = match ty {
            Type::I32 if literal.value <= u64::from(u32::MAX) && !literal.negative => {
                format!("the maximum `i32` is {}; as a `u32`, write `{}u32`", i32::MAX, literal.value)
            }
            Type::I32 => format!("`i32` ranges from {} to {}", i32::MIN, i32::MAX),
            _ => format!("the maximum is {}", u32::MAX),
        };
        self.report.error(codes::OUT_OF_RANGE, &literal.span, message, help);
    }
}
