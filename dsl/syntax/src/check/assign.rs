//! Assignments: `x = …`, `x += …`, and to a component, an element or an attribute of a `let mut`.
//!
//! Input: a place expression and a value. Output: a typed assignment, if Rust accepts it.

use fragbuf_model::{Diagnostic, SourceSpan, codes};
use syn::spanned::Spanned;

use super::checker::Checker;
use super::given::{source, source_of_operand};
use crate::foreign_names;
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn assign(&mut self, assign: &syn::ExprAssign) -> Expr {
        let span = self.at(assign.span());
        if let Some(error) = self.swizzled_place(&assign.left, "=", &assign.right) {
            return error;
        }
        let place = self.place(&assign.left);
        let value = self.value(&assign.right, place.ty);
        let kind = Kind::Assign { place: Box::new(place), operator: None, value: Box::new(value) };
        Expr::new(kind, Type::Unit, span)
    }

    /// Reports an assignment in place of a comparison: `a = b` where a `bool` is expected.
    pub(super) fn assignment_for_comparison(&mut self, assign: &syn::ExprAssign) -> Expr {
        // `a && b = c` is an assignment to `a && b`; `a && b == c` compares `b` and `c`.
        let comparison = format!("{} == {}", source(&assign.left), source(&assign.right));
        let span = self.at(assign.eq_token.span());
        let message = "mismatched types: expected `bool`, found an assignment";
        self.report.error(
            codes::TYPE_MISMATCH,
            &span,
            message,
            format!("`=` assigns: write `==` to compare, `{comparison}`"),
        );
        // Both sides are checked for other errors, unless operators around the comparison are part of them.
        if !matches!(*assign.left, syn::Expr::Binary(_)) {
            self.expr(&assign.left, None);
            self.expr(&assign.right, None);
        }
        Expr::error(span)
    }

    pub(super) fn compound(
        &mut self,
        left: &syn::Expr,
        operator: Operator,
        right: &syn::Expr,
        span: SourceSpan,
    ) -> Expr {
        if let Some(error) = self.swizzled_place(left, &format!("{}=", operator.symbol()), right) {
            return error;
        }
        let place = self.place(left);
        let value = self.expr(right, None);
        let ty = self.operation(operator, &place, &value);
        // `x += v` with a scalar `x` and a vector `v` is invalid: it would change the type of `x`.
        if ty.is_none_or(|ty| self.inference.unify(ty, place.ty).is_none()) {
            self.no_operation(operator, &place, &value, &span);
            return Expr::error(span);
        }
        let kind = Kind::Assign { place: Box::new(place), operator: Some(operator), value: Box::new(value) };
        Expr::new(kind, Type::Unit, span)
    }

    /// Reports an assignment to several components, `v.xyz = …` or `v.xyz() += …`; `None`: it is another place.
    fn swizzled_place(&mut self, left: &syn::Expr, operator: &str, right: &syn::Expr) -> Option<Expr> {
        let (base, letters) = match left {
            syn::Expr::Paren(inner) => return self.swizzled_place(&inner.expr, operator, right),
            syn::Expr::Field(field) => match &field.member {
                syn::Member::Named(name) => (&*field.base, name.to_string()),
                syn::Member::Unnamed(_) => return None,
            },
            syn::Expr::MethodCall(call) if call.args.is_empty() => (&*call.receiver, call.method.to_string()),
            _ => return None,
        };
        let xyzw = foreign_names::swizzle(&letters).unwrap_or(letters);
        if !(2..=4).contains(&xyzw.len()) || !xyzw.chars().all(|letter| "xyzw".contains(letter)) {
            return None;
        }
        let errors = self.report.count();
        let vector = self.expr(base, None);
        let Type::Vector(size) = self.inference.resolve(vector.ty) else {
            return (self.report.count() > errors).then(|| Expr::error(vector.span));
        };
        let span = self.at(left.span());
        let value = self.expr(right, None);
        let value_type = self.inference.resolve(value.ty);
        let is_vector = matches!(value_type, Type::Vector(_));
        let (base, value) = (source(base), source_of_operand(right));
        let parts: Vec<String> = xyzw
            .chars()
            .zip("xyzw".chars())
            .map(|(to, from)| match is_vector {
                true => format!("{base}.{to} {operator} {value}.{from}"),
                false => format!("{base}.{to} {operator} {value}"),
            })
            .collect();
        let is_inside = xyzw.chars().all(|letter| "xyzw".find(letter).is_some_and(|at| at < usize::from(size)));
        let help = match is_inside {
            true => format!("assign each component: `{};`", parts.join("; ")),
            false => {
                let components = "x, y, z, w".get(..usize::from(size) * 3 - 2).unwrap_or_default();
                format!("the components of `Vec{size}` are {components}")
            }
        };
        self.report.error(codes::NOT_MUTABLE, &span, "cannot assign to several components at once", help);
        Some(Expr::error(span))
    }

    /// Checks the left side of an assignment.
    fn place(&mut self, expr: &syn::Expr) -> Expr {
        if matches!(expr, syn::Expr::Infer(_)) {
            let span = self.at(expr.span());
            return self.unsupported(span, "`_ = …` is not supported", "remove the statement");
        }
        let place = self.expr(expr, None);
        self.require_mutable(&place, &place.span);
        self.uncount_read(&place);
        place
    }

    fn require_mutable(&mut self, part: &Expr, whole: &SourceSpan) {
        match &part.kind {
            Kind::Error => {}
            Kind::Attribute(base, _) | Kind::Element(base, _) => self.require_mutable(base, whole),
            Kind::Components(base, names) if names.len() == 1 => self.require_mutable(base, whole),
            Kind::Variable(id) => self.require_mutable_variable(*id, whole),
            Kind::Uniform(name) => {
                let message = format!("cannot assign to the uniform `{name}`");
                let help = format!("copy it: `let mut {name} = …;`");
                self.report.error(codes::NOT_MUTABLE, whole, message, help);
            }
            Kind::Layer(_) => {
                let message = "cannot assign to a fragment of the list";
                self.report.error(codes::NOT_MUTABLE, whole, message, "copy one: `let mut f = fragments[i];`");
            }
            _ => {
                let message = "invalid left-hand side of assignment";
                self.report.error(codes::NOT_MUTABLE, whole, message, "assign to a variable: `let mut x = …;`");
            }
        }
    }

    fn require_mutable_variable(&mut self, id: usize, whole: &SourceSpan) {
        let Some(variable) = self.variables.get(id) else { return };
        if variable.mutable {
            return;
        }
        let name = variable.name.clone();
        let declared = variable.span.clone();
        let message = format!("cannot assign to `{name}`: it is not declared with `mut`");
        let help = match variable.ty {
            Type::Fragments | Type::Uniforms => {
                format!("`{name}` is read-only: copy the value into a `let mut`")
            }
            _ => format!("declare it with `let mut {name} = …;`, or copy it into a `let mut`"),
        };
        let diagnostic = Diagnostic::new(codes::NOT_MUTABLE, whole, message, help);
        self.report.push(diagnostic.label(&declared, "declared here"));
    }
}
