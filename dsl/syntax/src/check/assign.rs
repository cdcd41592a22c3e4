//! Assignments: `x = …`, `x += …`, and to a component, an element or an attribute of a `let mut`.
//!
//! Input: a place expression and a value. Output: a typed assignment, if Rust accepts it.

use fragbuf_model::{Diagnostic, SourceSpan, codes};
use syn::spanned::Spanned;

use super::checker::Checker;
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn assign(&mut self, assign: &syn::ExprAssign) -> Expr {
        let span = self.at(assign.span());
        let place = self.place(&assign.left);
        let value = self.value(&assign.right, place.ty);
        let kind = Kind::Assign { place: Box::new(place), operator: None, value: Box::new(value) };
        Expr::new(kind, Type::Unit, span)
    }

    pub(super) fn compound(
        &mut self,
        left: &syn::Expr,
        operator: Operator,
        right: &syn::Expr,
        span: SourceSpan,
    ) -> Expr {
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
