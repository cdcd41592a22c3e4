//! Variables that are declared with a literal alone, `let mut s = 0;`, and the declaration that fits a use.
//!
//! Input: the `let`s of a function, and uses of another type. Output: the corrected declaration. As in Rust, the type of such a variable
//! follows from its uses, but an integer literal never becomes a float: the declaration is what the user has to change.

use fragbuf_model::{Code, Diagnostic, SourceSpan};

use super::checker::Checker;
use crate::tree::{Expr, Kind, VariableId};
use crate::types::Type;

/// A variable that is declared with a literal without a suffix.
pub(super) struct LiteralVariable {
    variable: VariableId,
    /// The literal with its sign, as `0` or `-1.5`.
    literal: String,
    /// Whether an integer literal is added to it, or the like.
    is_integer: bool,
}

/// The declaration of a variable that fits one of its uses.
pub(super) struct Redeclaration {
    help: String,
    /// The span of the variable's name in its declaration.
    declared: SourceSpan,
    literal: String,
}

impl Checker<'_, '_, '_> {
    /// Records a variable whose initial value is a literal without a suffix.
    pub(super) fn record_literal(&mut self, variable: VariableId, value: &syn::Expr) {
        if let Some(literal) = literal(value) {
            self.literal_variables.push(LiteralVariable { variable, literal, is_integer: false });
        }
    }

    /// Records an operand whose other operand is an integer literal: a declaration with a float would not fit it.
    pub(super) fn record_integer_operand(&mut self, operand: &Expr, other: &syn::Expr) {
        if let Kind::Variable(id) = operand.kind
            && matches!(other, syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. }) if number.suffix().is_empty())
            && let Some(known) = self.literal_variables.iter_mut().find(|known| known.variable == id)
        {
            known.is_integer = true;
        }
    }

    /// Returns the declaration after which a variable fits `wanted`, if it is declared with a literal and its type is not known yet.
    pub(super) fn redeclared(&self, found: &Expr, wanted: Type) -> Option<Redeclaration> {
        let (name, literal, declared) = self.literal_variable(found)?;
        let (is_integer, wanted) = (self.inference.is_integer(found.ty), self.inference.resolve(wanted));
        let is_open = matches!(self.inference.resolve(found.ty), Type::Unknown(_));
        // A factor of a vector is an `f32`.
        if !is_open && !matches!(wanted, Type::Vector(_)) {
            return None;
        }
        let (what, value) = match wanted {
            Type::Vector(size) => ("a vector", vector(literal, size)),
            _ if is_integer && self.inference.is_float(wanted) => ("a float", float(literal)),
            _ if !is_integer && self.inference.is_integer(wanted) => ("an integer", integer(literal)?),
            _ => return None,
        };
        let help = format!("declare it with {what}: `let {name} = {value};`");
        Some(Redeclaration { help, declared: declared.clone(), literal: literal.to_owned() })
    }

    /// Returns the declaration that gives a variable this type; a literal alone has none that a method could be called on.
    pub(super) fn typed_declaration(&self, found: &Expr, ty: Type) -> Option<String> {
        let (name, literal, _) = self.literal_variable(found)?;
        let value = if ty == Type::F32 { float(literal) } else { literal.to_owned() };
        Some(format!("let {name}: {} = {value};", ty.rust()))
    }

    /// Returns the name of the variable with its `mut`, its literal, and where it is declared.
    fn literal_variable(&self, found: &Expr) -> Option<(String, &str, &SourceSpan)> {
        let Kind::Variable(id) = found.kind else { return None };
        let literal = self.literal_variables.iter().find(|other| other.variable == id && !other.is_integer)?;
        let variable = self.variables.get(id)?;
        let is_number = matches!(self.inference.resolve(variable.ty), Type::Unknown(_) | Type::F32);
        let mutable = if variable.mutable { "mut " } else { "" };
        is_number.then(|| (format!("{mutable}{}", variable.name), literal.literal.as_str(), &variable.span))
    }

    /// Reports a use that the declaration of a variable does not fit. Its other uses are not reported.
    pub(super) fn report_declaration(
        &mut self,
        code: Code,
        variable: &Expr,
        message: impl Into<String>,
        fix: Redeclaration,
    ) {
        let diagnostic = Diagnostic::new(code, &variable.span, message, fix.help);
        self.report.push(diagnostic.label(&fix.declared, format!("declared here with the literal `{}`", fix.literal)));
        self.ignore(variable);
    }

    /// Whether the value that is assigned to a variable has reported its declaration: `s = f.depth.max(s)`.
    pub(super) fn is_ignored(&self, place: &Expr) -> bool {
        matches!(place.kind, Kind::Variable(id) if self.variables.get(id).is_some_and(|variable| variable.ty == Type::Error))
    }

    /// Gives a variable the type of errors.
    pub(super) fn ignore(&mut self, variable: &Expr) {
        if let Kind::Variable(id) = variable.kind
            && let Some(variable) = self.variables.get_mut(id)
        {
            variable.ty = Type::Error;
        }
    }
}

/// Returns a literal without a suffix, with its sign.
fn literal(value: &syn::Expr) -> Option<String> {
    match value {
        syn::Expr::Paren(inner) => literal(&inner.expr),
        syn::Expr::Unary(syn::ExprUnary { op: syn::UnOp::Neg(_), expr, .. }) => {
            literal(expr).filter(|digits| !digits.starts_with('-')).map(|digits| format!("-{digits}"))
        }
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. }) if number.suffix().is_empty() => {
            Some(number.base10_digits().to_owned())
        }
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Float(number), .. }) if number.suffix().is_empty() => {
            Some(number.base10_digits().to_owned())
        }
        _ => None,
    }
}

fn float(literal: &str) -> String {
    let is_float = literal.contains(['.', 'e', 'E']);
    if is_float { literal.to_owned() } else { format!("{literal}.0") }
}

/// Returns a float literal as an integer; `None`: it has a fraction.
fn integer(literal: &str) -> Option<String> {
    let value: f64 = literal.parse().ok()?;
    let is_whole = value.fract() == 0.0 && value.abs() <= f64::from(u32::MAX);
    is_whole.then(|| format!("{value:.0}"))
}

fn vector(literal: &str, size: u8) -> String {
    match literal.parse() {
        Ok(0.0_f64) => format!("Vec{size}::ZERO"),
        _ => format!("Vec{size}::splat({})", float(literal)),
    }
}
