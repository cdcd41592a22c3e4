//! Operators: what Rust and glam have, and nothing else.
//!
//! In: operands. Out: a typed operation. Scalars meet scalars of the same type; vectors meet vectors of the same size or
//! an `f32`, in either order. Comparisons are between scalars.

use fragbuf_model::{Origin, codes};
use syn::spanned::Spanned;
use syn::{BinOp, UnOp};

use super::mismatch::{quoted, way_out};
use super::{Checker, written_type};
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

/// The operator, and whether it assigns.
fn operator(sign: &BinOp) -> Option<(Operator, bool)> {
    use Operator::*;
    Some(match sign {
        BinOp::Add(_) => (Add, false),
        BinOp::Sub(_) => (Subtract, false),
        BinOp::Mul(_) => (Multiply, false),
        BinOp::Div(_) => (Divide, false),
        BinOp::Rem(_) => (Remainder, false),
        BinOp::And(_) => (And, false),
        BinOp::Or(_) => (Or, false),
        BinOp::BitXor(_) => (BitXor, false),
        BinOp::BitAnd(_) => (BitAnd, false),
        BinOp::BitOr(_) => (BitOr, false),
        BinOp::Shl(_) => (ShiftLeft, false),
        BinOp::Shr(_) => (ShiftRight, false),
        BinOp::Eq(_) => (Equal, false),
        BinOp::Lt(_) => (Less, false),
        BinOp::Le(_) => (LessEqual, false),
        BinOp::Ne(_) => (NotEqual, false),
        BinOp::Ge(_) => (GreaterEqual, false),
        BinOp::Gt(_) => (Greater, false),
        BinOp::AddAssign(_) => (Add, true),
        BinOp::SubAssign(_) => (Subtract, true),
        BinOp::MulAssign(_) => (Multiply, true),
        BinOp::DivAssign(_) => (Divide, true),
        BinOp::RemAssign(_) => (Remainder, true),
        BinOp::BitXorAssign(_) => (BitXor, true),
        BinOp::BitAndAssign(_) => (BitAnd, true),
        BinOp::BitOrAssign(_) => (BitOr, true),
        BinOp::ShlAssign(_) => (ShiftLeft, true),
        BinOp::ShrAssign(_) => (ShiftRight, true),
        _ => return None,
    })
}

impl Checker<'_, '_, '_> {
    pub(super) fn unary(&mut self, unary: &syn::ExprUnary) -> Expr {
        let origin = self.at(unary.span());
        match unary.op {
            UnOp::Neg(_) => self.negate(unary, origin),
            UnOp::Not(_) => {
                let inner = self.expr(&unary.expr, None);
                let kind = self.inference.resolve(inner.ty);
                if kind != Type::Bool && kind != Type::Error && !self.inference.is_whole(kind) {
                    let message = format!("`!` has no meaning for {}", quoted(self.inference.name(kind)));
                    self.report.error(codes::WRONG_TYPE, &origin, message, "it is for `bool` and whole numbers");
                    return Expr::error(origin);
                }
                Expr::new(Kind::Not(Box::new(inner)), kind, origin)
            }
            _ => {
                let hint = "use the value itself: all values are copied";
                self.refuse(origin, "references are not part of the language", hint)
            }
        }
    }

    fn negate(&mut self, unary: &syn::ExprUnary, origin: Origin) -> Expr {
        let inner = match &*unary.expr {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. })
                if !matches!(number.suffix(), "f32" | "f64") =>
            {
                let place = self.at(number.span());
                self.whole(number, place, true)
            }
            other => self.expr(other, None),
        };
        let kind = self.inference.resolve(inner.ty);
        let fits = self.inference.is_whole(kind) || self.inference.is_fractional(kind);
        if !fits && !matches!(kind, Type::Vector(_) | Type::Error) {
            let message = format!("`-` has no meaning for {}", quoted(self.inference.name(kind)));
            self.report.error(codes::WRONG_TYPE, &origin, message, "it is for numbers and vectors");
            return Expr::error(origin);
        }
        self.negated.push((kind, origin.clone()));
        Expr::new(Kind::Negate(Box::new(inner)), kind, origin)
    }

    /// Once all types are known: Rust has no `-` for unsigned numbers.
    pub(super) fn check_negation(&mut self, kind: Type, origin: &Origin) {
        let kind = self.inference.settle(kind);
        if matches!(kind, Type::U32 | Type::Usize) {
            let message = format!("`-` has no meaning for `{}`", kind.rust());
            let hint = "convert it: `-(x as i32)`, or subtract: `a.wrapping_sub(b)`";
            self.report.error(codes::WRONG_TYPE, origin, message, hint);
        }
    }

    pub(super) fn binary(&mut self, binary: &syn::ExprBinary) -> Expr {
        let origin = self.at(binary.span());
        let Some((operator, assigns)) = operator(&binary.op) else {
            return self.refuse(origin, "this operator is not part of the language", "write it with + - * / %");
        };
        if assigns {
            return self.compound(&binary.left, operator, &binary.right, origin);
        }
        if operator.is_logical() {
            let left = self.value(&binary.left, Type::Bool);
            let right = self.value(&binary.right, Type::Bool);
            return Expr::new(Kind::Binary(operator, Box::new(left), Box::new(right)), Type::Bool, origin);
        }
        let left = self.expr(&binary.left, None);
        let right = self.expr(&binary.right, None);
        match self.operation(operator, &left, &right) {
            Some(ty) => Expr::new(Kind::Binary(operator, Box::new(left), Box::new(right)), ty, origin),
            None => {
                self.no_operation(operator, &left, &right, &origin);
                Expr::error(origin)
            }
        }
    }

    /// The type of `left operator right`; nothing where Rust has no such operation.
    pub(super) fn operation(&mut self, operator: Operator, left: &Expr, right: &Expr) -> Option<Type> {
        let (a, b) = (self.inference.resolve(left.ty), self.inference.resolve(right.ty));
        if a == Type::Error || b == Type::Error {
            return Some(Type::Error);
        }
        if operator.is_arithmetic() {
            return match (a, b) {
                (Type::Vector(n), Type::Vector(m)) if n == m => Some(a),
                (Type::Vector(_), _) if self.inference.is_fractional(b) => {
                    self.inference.unify(b, Type::F32).map(|_| a)
                }
                (_, Type::Vector(_)) if self.inference.is_fractional(a) => {
                    self.inference.unify(a, Type::F32).map(|_| b)
                }
                _ if self.is_number(a) => self.inference.unify(a, b),
                _ => None,
            };
        }
        if operator.is_shift() {
            return (self.inference.is_whole(a) && self.inference.is_whole(b)).then_some(a);
        }
        if operator.is_bitwise() {
            let fits = a == Type::Bool || self.inference.is_whole(a);
            return if fits { self.inference.unify(a, b) } else { None };
        }
        let ordered = self.is_number(a);
        let equal = a == Type::Bool && matches!(operator, Operator::Equal | Operator::NotEqual);
        let fits = (ordered || equal) && self.inference.unify(a, b).is_some();
        fits.then_some(Type::Bool)
    }

    fn is_number(&self, kind: Type) -> bool {
        self.inference.is_whole(kind) || self.inference.is_fractional(kind)
    }

    pub(super) fn no_operation(&mut self, operator: Operator, left: &Expr, right: &Expr, origin: &Origin) {
        let (a, b) = (self.inference.name(left.ty), self.inference.name(right.ty));
        let message = format!("`{}` has no meaning between {} and {}", operator.sign(), quoted(a), quoted(b));
        let (a, b) = (self.inference.resolve(left.ty), self.inference.resolve(right.ty));
        let comparison = !operator.is_arithmetic() && !operator.is_shift() && !operator.is_bitwise();
        let (place, hint) = match (a, b) {
            (Type::Vector(_), Type::Vector(_)) if comparison => {
                (origin, "compare components, `a.x < b.x`, or lengths".to_string())
            }
            (Type::Vector(_), _) if self.inference.is_whole(b) && operator.is_arithmetic() => {
                (&right.origin, way_out(&self.inference, right, Type::F32))
            }
            (_, Type::Vector(_)) if self.inference.is_whole(a) && operator.is_arithmetic() => {
                (&left.origin, way_out(&self.inference, left, Type::F32))
            }
            _ if self.is_number(a) && self.is_number(b) && !operator.is_shift() && !operator.is_bitwise() => {
                // Point at the whole number, which is the one to convert.
                if self.inference.is_fractional(a) || !self.inference.is_fractional(b) {
                    (&right.origin, way_out(&self.inference, right, a))
                } else {
                    (&left.origin, way_out(&self.inference, left, b))
                }
            }
            _ if operator.is_bitwise() || operator.is_shift() => {
                (origin, "bits belong to whole numbers: `x.to_bits()`, or `x as u32`".to_string())
            }
            (Type::Bool, Type::Bool) => (origin, "combine truth values with `&&` and `||`".to_string()),
            _ => (origin, "both sides must be numbers of one type, or vectors of one size".to_string()),
        };
        self.report.error(codes::WRONG_TYPE, place, message, hint);
    }

    pub(super) fn cast(&mut self, cast: &syn::ExprCast) -> Expr {
        let origin = self.at(cast.span());
        let inner = self.expr(&cast.expr, None);
        let target = written_type(&cast.ty, self.report);
        let source = self.inference.resolve(inner.ty);
        if matches!(source, Type::Unknown(_)) && self.inference.is_whole(source) && target.is_integer() {
            // As in Rust: in `3000000000 as u32` the number is a `u32` from the start.
            self.inference.unify(source, target);
        }
        let number = target == Type::F32 || target.is_integer();
        let fits = match source {
            Type::Error => true,
            Type::Bool => target.is_integer(),
            _ => self.is_number(source) && number,
        };
        if fits || target == Type::Error {
            return Expr::new(Kind::Cast(Box::new(inner)), target, origin);
        }
        let message = format!("{} cannot become `{}` with `as`", quoted(self.inference.name(source)), target.rust());
        let hint = match (source, target) {
            (Type::Bool, Type::F32) => "write `if … { 1.0 } else { 0.0 }`".to_string(),
            (_, Type::Bool) => "compare it: `x != 0`".to_string(),
            _ => way_out(&self.inference, &inner, target),
        };
        self.report.error(codes::WRONG_TYPE, &origin, message, hint);
        Expr::error(origin)
    }
}
