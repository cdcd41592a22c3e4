//! Numbers and truth values as written.
//!
//! In: a literal. Out: its value, with a type that may be decided later. Ranges are checked when all types are known,
//! because `3000000000` fits a `u32` and not an `i32`.

use fragbuf_model::{Origin, codes};

use super::Checker;
use crate::tree::{Expr, Kind};
use crate::types::Type;

/// A whole number as written.
pub(super) struct Whole {
    pub value: u64,
    pub kind: Type,
    pub origin: Origin,
    /// Whether a `-` stands before it.
    pub negative: bool,
}

impl Checker<'_, '_, '_> {
    pub(super) fn literal(&mut self, literal: &syn::Lit) -> Expr {
        let origin = self.at(literal.span());
        match literal {
            syn::Lit::Bool(word) => Expr::new(Kind::Bool(word.value), Type::Bool, origin),
            syn::Lit::Int(number) if matches!(number.suffix(), "f32" | "f64") => {
                self.float(number.base10_digits(), number.suffix(), origin)
            }
            syn::Lit::Int(number) => self.whole(number, origin, false),
            syn::Lit::Float(number) => self.float(number.base10_digits(), number.suffix(), origin),
            _ => {
                let hint = "closures calculate with numbers and vectors only";
                self.refuse(origin, "text is not part of the language", hint)
            }
        }
    }

    /// A whole number; `negative` says that `-` stands before it.
    pub(super) fn whole(&mut self, number: &syn::LitInt, origin: Origin, negative: bool) -> Expr {
        let kind = match number.suffix() {
            "" => self.inference.whole(),
            "u32" => Type::U32,
            "i32" => Type::I32,
            "usize" => Type::Usize,
            other => {
                let hint = "whole numbers are `u32`, `i32` or `usize`";
                return self.refuse(origin, format!("`{other}` numbers are not part of the language"), hint);
            }
        };
        let Ok(value) = number.base10_parse::<u64>() else {
            self.out_of_range(&origin, number.base10_digits());
            return Expr::error(origin);
        };
        self.wholes.push(Whole { value, kind, origin: origin.clone(), negative });
        Expr::new(Kind::Whole(value), kind, origin)
    }

    fn float(&mut self, digits: &str, suffix: &str, origin: Origin) -> Expr {
        let kind = match suffix {
            "" => self.inference.fractional(),
            "f32" => Type::F32,
            other => {
                let message = format!("`{other}` numbers are not part of the language");
                return self.refuse(origin, message, "write `f32`, or no type: numbers with a point are `f32`");
            }
        };
        match digits.parse::<f32>() {
            Ok(value) if value.is_finite() => Expr::new(Kind::Float(value), kind, origin),
            _ => {
                let message = format!("`{digits}` does not fit an `f32`");
                self.report.error(codes::OUT_OF_RANGE, &origin, message, "the greatest is `f32::MAX`, about 3.4e38");
                Expr::error(origin)
            }
        }
    }

    fn out_of_range(&mut self, origin: &Origin, digits: &str) {
        let message = format!("`{digits}` does not fit 32 bits");
        let hint = format!("the greatest `u32` is {}, the greatest `i32` is {}", u32::MAX, i32::MAX);
        self.report.error(codes::OUT_OF_RANGE, origin, message, hint);
    }

    /// Whether a whole number fits its type.
    pub(super) fn check_range(&mut self, whole: &Whole) {
        let kind = self.inference.settle(whole.kind);
        let greatest = match kind {
            Type::I32 if whole.negative => 1 << 31,
            Type::I32 => (1 << 31) - 1,
            _ => u64::from(u32::MAX),
        };
        if whole.value <= greatest {
            return;
        }
        let message = format!("`{}` does not fit an `{}`", whole.value, kind.rust());
        let hint = match kind {
            Type::I32 if whole.value <= u64::from(u32::MAX) && !whole.negative => {
                format!("the greatest `i32` is {}; as a `u32`, write `{}u32`", i32::MAX, whole.value)
            }
            Type::I32 => format!("an `i32` goes from {} to {}", i32::MIN, i32::MAX),
            _ => format!("it goes to {}", u32::MAX),
        };
        self.report.error(codes::OUT_OF_RANGE, &whole.origin, message, hint);
    }
}
