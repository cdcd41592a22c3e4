//! Operators: exactly those of Rust and glam.
//!
//! Input: operands. Output: a typed operation. Both operands are scalars of the same type, vectors of the same size, or a
//! vector and an `f32`, in either order. Comparisons are between scalars.

use fragbuf_model::{SourceSpan, codes};
use syn::spanned::Spanned;
use syn::{BinOp, UnOp};

use super::checker::Checker;
use super::given::{source, source_of_operand};
use super::mismatch::quoted;
use super::written_types::written_type;
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

/// Returns the operator, and whether it assigns.
fn operator(token: &BinOp) -> Option<(Operator, bool)> {
    use Operator::*;
    Some(match token {
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
        let span = self.at(unary.span());
        match unary.op {
            UnOp::Neg(_) => self.negate(unary, span),
            UnOp::Not(_) => {
                let inner = self.expr(&unary.expr, None);
                let ty = self.inference.resolve(inner.ty);
                if ty != Type::Bool && ty != Type::Error && !self.inference.is_integer(ty) {
                    let message = format!("cannot apply unary operator `!` to {}", quoted(self.inference.name(ty)));
                    self.report.error(codes::TYPE_MISMATCH, &span, message, "`!` applies to `bool` and integers");
                    return Expr::error(span);
                }
                Expr::new(Kind::Not(Box::new(inner)), ty, span)
            }
            _ => {
                let help = "use the value itself: all values are copied; for a power, write `x.powf(2.0)`";
                self.unsupported(span, "references are not supported", help)
            }
        }
    }

    fn negate(&mut self, unary: &syn::ExprUnary, span: SourceSpan) -> Expr {
        let inner = match &*unary.expr {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. })
                if !matches!(number.suffix(), "f32" | "f64") =>
            {
                let span = self.at(number.span());
                self.integer(number, span, true)
            }
            other => self.expr(other, None),
        };
        let ty = self.inference.resolve(inner.ty);
        if !self.is_number(ty) && !matches!(ty, Type::Vector(_) | Type::Error) {
            let message = format!("cannot apply unary operator `-` to {}", quoted(self.inference.name(ty)));
            self.report.error(codes::TYPE_MISMATCH, &span, message, "`-` applies to numbers and vectors");
            return Expr::error(span);
        }
        self.negated.push((ty, span.clone()));
        Expr::new(Kind::Negate(Box::new(inner)), ty, span)
    }

    /// Rejects `-` for unsigned numbers, as Rust does, once all types are known.
    pub(super) fn check_negation(&mut self, ty: Type, span: &SourceSpan) {
        let ty = self.inference.resolve_or_default(ty);
        if matches!(ty, Type::U32 | Type::Usize) {
            let message = format!("cannot apply unary operator `-` to `{}`", ty.rust());
            let help = match ty {
                Type::Usize => "count from the end: `fragments[fragments.len() - 1]`",
                _ => "convert it: `-(x as i32)`, or subtract: `a.wrapping_sub(b)`",
            };
            self.report.error(codes::TYPE_MISMATCH, span, message, help);
        }
    }

    pub(super) fn binary(&mut self, binary: &syn::ExprBinary) -> Expr {
        let span = self.at(binary.span());
        let Some((operator, assigns)) = operator(&binary.op) else {
            return self.unsupported(span, "this operator is not supported", "write it with + - * / %");
        };
        if assigns {
            return self.compound(&binary.left, operator, &binary.right, span);
        }
        if operator.is_logical() {
            let left = self.value(&binary.left, Type::Bool);
            let right = self.value(&binary.right, Type::Bool);
            return Expr::new(Kind::Binary(operator, Box::new(left), Box::new(right)), Type::Bool, span);
        }
        let left = self.expr(&binary.left, None);
        let right = self.expr(&binary.right, None);
        if operator.is_comparison()
            && let Some(error) = self.unsigned_and_negative(binary, operator, &left, &right)
        {
            return error;
        }
        match self.operation(operator, &left, &right) {
            Some(ty) => {
                self.record_integer_operand(&left, &binary.right);
                self.record_integer_operand(&right, &binary.left);
                Expr::new(Kind::Binary(operator, Box::new(left), Box::new(right)), ty, span)
            }
            None => {
                self.no_operation(operator, (&left, &binary.left), (&right, &binary.right), &span);
                Expr::error(span)
            }
        }
    }

    /// Reports the comparison of an unsigned number with a negative literal, `f.id == -1`; `None`: it is another comparison.
    fn unsigned_and_negative(
        &mut self,
        binary: &syn::ExprBinary,
        operator: Operator,
        left: &Expr,
        right: &Expr,
    ) -> Option<Expr> {
        let is_negative =
            |expr: &Expr| matches!(&expr.kind, Kind::Negate(inner) if matches!(inner.kind, Kind::Integer(_)));
        let is_unsigned = |expr: &Expr| matches!(self.inference.resolve(expr.ty), Type::U32 | Type::Usize);
        let symbol = operator.symbol();
        let (unsigned, negative, converted) = if is_negative(right) && is_unsigned(left) {
            let converted = format!("({} as i32) {symbol} {}", source_of_operand(&binary.left), source(&binary.right));
            (left, right, converted)
        } else if is_negative(left) && is_unsigned(right) {
            let converted = format!("{} {symbol} ({} as i32)", source(&binary.left), source_of_operand(&binary.right));
            (right, left, converted)
        } else {
            return None;
        };
        let ty = quoted(self.inference.name(unsigned.ty));
        let message = format!("cannot compare {ty} with a negative number");
        let help =
            format!("convert it: `{converted}`; an unsigned number is never below 0, and the greatest is `u32::MAX`");
        self.report.error(codes::TYPE_MISMATCH, &negative.span, message, help);
        Some(Expr::error(self.at(binary.span())))
    }

    /// Returns the type of `left operator right`, or `None` if Rust has no such operation.
    pub(super) fn operation(&mut self, operator: Operator, left: &Expr, right: &Expr) -> Option<Type> {
        let (a, b) = (self.inference.resolve(left.ty), self.inference.resolve(right.ty));
        if a == Type::Error || b == Type::Error {
            return Some(Type::Error);
        }
        if operator.is_arithmetic() {
            return match (a, b) {
                (Type::Vector(n), Type::Vector(m)) if n == m => Some(a),
                (Type::Vector(_), _) if self.inference.is_float(b) => self.inference.unify(b, Type::F32).map(|_| a),
                (_, Type::Vector(_)) if self.inference.is_float(a) => self.inference.unify(a, Type::F32).map(|_| b),
                _ if self.is_number(a) => self.inference.unify(a, b),
                _ => None,
            };
        }
        if operator.is_shift() {
            return (self.inference.is_integer(a) && self.inference.is_integer(b)).then_some(a);
        }
        if operator.is_bitwise() {
            let fits = a == Type::Bool || self.inference.is_integer(a);
            return if fits { self.inference.unify(a, b) } else { None };
        }
        let ordered = self.is_number(a);
        let equal = a == Type::Bool && matches!(operator, Operator::Equal | Operator::NotEqual);
        let fits = (ordered || equal) && self.inference.unify(a, b).is_some();
        fits.then_some(Type::Bool)
    }

    /// Reports an operation that Rust does not have. Each operand has its source.
    pub(super) fn no_operation(
        &mut self,
        operator: Operator,
        (left, left_source): (&Expr, &syn::Expr),
        (right, right_source): (&Expr, &syn::Expr),
        span: &SourceSpan,
    ) {
        let (a, b) = (self.inference.name(left.ty), self.inference.name(right.ty));
        let message = format!("cannot apply `{}` to {} and {}", operator.symbol(), quoted(a), quoted(b));
        let (a, b) = (self.inference.resolve(left.ty), self.inference.resolve(right.ty));
        let is_numeric = !operator.is_bitwise() && !operator.is_shift() && !operator.is_logical();
        if is_numeric && self.redeclare_operand(left, right, &message) {
            return;
        }
        let comparison = operator.is_comparison() || operator.is_logical();
        let (span, help) = match (a, b) {
            (Type::Vector(_), _) | (_, Type::Vector(_)) if comparison => {
                (span, "compare components, `a.x < b.x`, or lengths".to_string())
            }
            (Type::Vector(_), _) if self.inference.is_integer(b) && operator.is_arithmetic() => {
                (&right.span, self.fix(right, Type::F32, right_source))
            }
            (_, Type::Vector(_)) if self.inference.is_integer(a) && operator.is_arithmetic() => {
                (&left.span, self.fix(left, Type::F32, left_source))
            }
            (Type::Vector(n), Type::Vector(m)) if operator.is_arithmetic() && n > m => {
                (&left.span, self.fix(left, b, left_source))
            }
            (Type::Vector(_), Type::Vector(_)) if operator.is_arithmetic() => {
                (&right.span, self.fix(right, a, right_source))
            }
            _ if self.is_number(a) && self.is_number(b) && is_numeric => {
                // Point to the integer, which is the operand to convert.
                if self.inference.is_float(a) || !self.inference.is_float(b) {
                    (&right.span, self.fix(right, a, right_source))
                } else {
                    (&left.span, self.fix(left, b, left_source))
                }
            }
            (Type::F32, _) if operator == Operator::BitXor => (span, "for a power, write `x.powf(2.0)`".to_string()),
            _ if operator.is_bitwise() || operator.is_shift() => {
                (span, "this operator applies to integers: `x.to_bits()`, or `x as u32`".to_string())
            }
            (Type::Bool, Type::Bool) => (span, "combine `bool` values with `&&` and `||`".to_string()),
            _ => (span, "both sides must be numbers of one type, or vectors of one size".to_string()),
        };
        self.report.error(codes::TYPE_MISMATCH, span, message, help);
    }

    /// Reports an operand that is an integer only because its variable is declared with an integer literal, `let mut s = 0;`, where the
    /// other is a float or a vector. Returns whether there is one.
    fn redeclare_operand(&mut self, left: &Expr, right: &Expr, message: &str) -> bool {
        for (variable, other) in [(left, right), (right, left)] {
            let is_float =
                self.inference.is_float(other.ty) || matches!(self.inference.resolve(other.ty), Type::Vector(_));
            let is_integer = self.inference.is_integer(variable.ty);
            if is_integer
                && is_float
                && let Some(fix) = self.redeclared(variable, Type::F32)
            {
                self.report_declaration(codes::TYPE_MISMATCH, variable, message, fix);
                return true;
            }
        }
        false
    }

    pub(super) fn cast(&mut self, cast: &syn::ExprCast) -> Expr {
        let span = self.at(cast.span());
        let inner = self.expr(&cast.expr, None);
        let target = written_type(&cast.ty, self.report);
        let source = self.inference.resolve(inner.ty);
        if matches!(source, Type::Unknown(_)) && self.inference.is_integer(source) && target.is_integer() {
            // As in Rust, the literal of `3000000000 as u32` is a `u32`.
            self.inference.unify(source, target);
        }
        let number = target == Type::F32 || target.is_integer();
        let fits = match source {
            Type::Error => true,
            Type::Bool => target.is_integer(),
            _ => self.is_number(source) && number,
        };
        if fits || target == Type::Error {
            return Expr::new(Kind::Cast(Box::new(inner)), target, span);
        }
        let message = format!("cannot cast {} as `{}`", quoted(self.inference.name(source)), target.rust());
        let help = match (source, target) {
            (Type::Bool, Type::F32) => "write `if … { 1.0 } else { 0.0 }`".to_string(),
            (_, Type::Bool) if self.inference.is_float(source) => "compare it: `x != 0.0`".to_string(),
            (_, Type::Bool) => "compare it: `x != 0`".to_string(),
            _ => self.fix(&inner, target, &cast.expr),
        };
        self.report.error(codes::TYPE_MISMATCH, &span, message, help);
        Expr::error(span)
    }
}
