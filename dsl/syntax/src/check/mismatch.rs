//! Type mismatches, and the fix for each pair of types.
//!
//! Input: a checked expression, its source, and the expected type. Output: the expression, or an error expression. A fix repeats the
//! source, so that it compiles in its place.

use fragbuf_model::codes;

use super::checker::Checker;
use super::given::{source, source_of_operand};
use crate::infer::Inference;
use crate::tree::{Expr, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    /// Returns the expression if it has this type or can be inferred to have it. Reports a mismatch otherwise.
    pub(super) fn require(&mut self, found: Expr, expected: Type, written: &syn::Expr) -> Expr {
        if self.inference.unify(found.ty, expected).is_some() {
            return found;
        }
        self.mismatch(&found, expected, written);
        Expr::error(found.span)
    }

    fn mismatch(&mut self, found: &Expr, expected: Type, written: &syn::Expr) {
        let (found_name, expected_name) = (self.inference.name(found.ty), self.inference.name(expected));
        if found.ty == Type::Unit {
            let message = format!("expected a value of type `{expected_name}`, found none");
            let help = "end it with the value, without `;`";
            self.report.error(codes::MISSING_VALUE, &found.span, message, help);
            return;
        }
        let message = if expected == Type::Unit {
            format!("unused value of type `{found_name}`")
        } else {
            format!("mismatched types: expected {1}, found {0}", quoted(found_name), quoted(expected_name))
        };
        let is_vector = matches!(self.inference.resolve(expected), Type::Vector(_));
        if let Some(fix) = self.redeclared(found, expected).filter(|_| !is_vector) {
            self.report_declaration(codes::TYPE_MISMATCH, found, message, fix);
            return;
        }
        let help = self.fix(found, expected, written);
        self.report.error(codes::TYPE_MISMATCH, &found.span, message, help);
    }

    /// Returns the help that turns `found` into a value of type `expected`; `written` is its source.
    pub(super) fn fix(&self, found: &Expr, expected: Type, written: &syn::Expr) -> String {
        let inference = &self.inference;
        let (ty, expected) = (inference.resolve(found.ty), inference.resolve(expected));
        if let Some(literal) = converted_literal(inference, written, expected) {
            return format!("write `{literal}`");
        }
        let whole = if is_long(&found.kind) { "…".to_owned() } else { source(written) };
        let operand = if is_long(&found.kind) { "…".to_owned() } else { source_of_operand(written) };
        match (ty, expected) {
            (_, Type::Unit) => "end it with `;`, or remove it".to_string(),
            (Type::Bool, Type::F32) => format!("write `(if {whole} {{ 1.0 }} else {{ 0.0 }})`"),
            (_, Type::Bool) if inference.is_float(ty) => format!("compare it: `{operand} > 0.0`"),
            (_, Type::Bool) if inference.is_integer(ty) => format!("compare it: `{operand} != 0`"),
            (Type::Vector(_), Type::Bool) => format!("compare a component: `{operand}.x > 0.0`"),
            (Type::Bool, _) if inference.is_integer(expected) => {
                format!("convert it: `({operand} as {})`", integer(inference, expected))
            }
            (Type::Vector(4), Type::Vector(3)) => format!("write `{operand}.truncate()` or `{operand}.xyz()`"),
            (Type::Vector(3), Type::Vector(2)) => format!("write `{operand}.truncate()` or `{operand}.xy()`"),
            (Type::Vector(4), Type::Vector(2)) => format!("write `{operand}.xy()`"),
            (Type::Vector(2), Type::Vector(4)) => format!("append components: `{operand}.extend(0.0).extend(1.0)`"),
            (Type::Vector(_), Type::Vector(_)) => format!("append a component: `{operand}.extend(1.0)`"),
            (Type::Vector(_), _) if inference.is_float(expected) => {
                format!("use a component, `{operand}.x`, or `{operand}.length()`")
            }
            (_, Type::Vector(size)) if inference.is_float(ty) => {
                format!("for equal components, write `Vec{size}::splat({whole})`")
            }
            (_, Type::Vector(size)) if inference.is_integer(ty) => {
                let value = converted_literal(inference, written, Type::F32);
                let value = value.unwrap_or_else(|| format!("{operand} as f32"));
                format!("for equal components, write `Vec{size}::splat({value})`")
            }
            (Type::Fragment, _) => format!("use an attribute, such as `{operand}.depth`"),
            (Type::Fragments, Type::Fragment) => {
                format!("use one, `{operand}[0]`, or iterate: `for f in {operand} {{ … }}`")
            }
            _ if is_number(inference, ty) && is_number(inference, expected) => {
                let target = if inference.is_float(expected) { "f32" } else { integer(inference, expected) };
                format!("convert it: `({operand} as {target})`")
            }
            _ => format!("write an expression of type {}", quoted(inference.name(expected))),
        }
    }
}

/// Returns a type name in backticks; a description of a type stays as it is.
pub(super) fn quoted(name: &str) -> String {
    if name.contains(' ') { name.to_string() } else { format!("`{name}`") }
}

/// Whether the source of an expression has several lines: a help does not repeat it.
fn is_long(kind: &Kind) -> bool {
    matches!(kind, Kind::Block(_) | Kind::If(_) | Kind::For(_))
}

/// Returns a literal without a suffix as one of the expected type; `None`: it is no literal, or it has no such value.
fn converted_literal(inference: &Inference, written: &syn::Expr, expected: Type) -> Option<String> {
    let (sign, number) = match written {
        syn::Expr::Unary(syn::ExprUnary { op: syn::UnOp::Neg(_), expr, .. }) => ("-", &**expr),
        other => ("", other),
    };
    let syn::Expr::Lit(syn::ExprLit { lit, .. }) = number else { return None };
    match lit {
        syn::Lit::Int(integer) if integer.suffix() != "f32" && inference.is_float(expected) => {
            Some(format!("{sign}{}.0", integer.base10_digits()))
        }
        syn::Lit::Float(float) if sign.is_empty() && inference.is_integer(expected) => {
            let value: f32 = float.base10_parse().ok()?;
            (value.fract() == 0.0 && value <= 16_777_216.0).then(|| format!("{value:.0}"))
        }
        _ => None,
    }
}

fn is_number(inference: &Inference, ty: Type) -> bool {
    inference.is_integer(ty) || inference.is_float(ty)
}

fn integer(inference: &Inference, ty: Type) -> &'static str {
    inference.resolve_or_default(ty).rust()
}
