//! Assignments: `x = …`, `x += …`, and to a component, an element or an attribute of a `let mut`.
//!
//! In: a place and a value. Out: a typed assignment to a place that Rust would let be assigned.

use fragbuf_model::{Diagnostic, Origin, codes};
use syn::spanned::Spanned;

use super::Checker;
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn assign(&mut self, assign: &syn::ExprAssign) -> Expr {
        let origin = self.at(assign.span());
        let place = self.place(&assign.left);
        let value = self.value(&assign.right, place.ty);
        let kind = Kind::Assign { place: Box::new(place), operator: None, value: Box::new(value) };
        Expr::new(kind, Type::Unit, origin)
    }

    pub(super) fn compound(&mut self, left: &syn::Expr, operator: Operator, right: &syn::Expr, origin: Origin) -> Expr {
        let place = self.place(left);
        let value = self.expr(right, None);
        let ty = self.operation(operator, &place, &value);
        // `x += v` with a scalar `x` and a vector `v` would change the type of `x`.
        if ty.is_none_or(|ty| self.inference.unify(ty, place.ty).is_none()) {
            self.no_operation(operator, &place, &value, &origin);
            return Expr::error(origin);
        }
        let kind = Kind::Assign { place: Box::new(place), operator: Some(operator), value: Box::new(value) };
        Expr::new(kind, Type::Unit, origin)
    }

    /// An expression that can be assigned.
    fn place(&mut self, expr: &syn::Expr) -> Expr {
        if matches!(expr, syn::Expr::Infer(_)) {
            let origin = self.at(expr.span());
            return self.refuse(origin, "`_ = …` is not part of the language", "leave the line out");
        }
        let place = self.expr(expr, None);
        self.require_mutable(&place, &place.origin);
        place
    }

    fn require_mutable(&mut self, part: &Expr, whole: &Origin) {
        match &part.kind {
            Kind::Error => {}
            Kind::Attribute(base, _) | Kind::Element(base, _) => self.require_mutable(base, whole),
            Kind::Components(base, names) if names.len() == 1 => self.require_mutable(base, whole),
            Kind::Variable(id) => self.require_mutable_variable(*id, whole),
            Kind::Uniform(name) => {
                let message = format!("the uniform `{name}` cannot be assigned");
                let hint = format!("copy it: `let mut {name} = …;`");
                self.report.error(codes::NOT_MUTABLE, whole, message, hint);
            }
            Kind::Layer(_) => {
                let message = "the fragments in the list cannot be assigned";
                self.report.error(codes::NOT_MUTABLE, whole, message, "copy one: `let mut f = fragments[i];`");
            }
            _ => {
                let message = "this is a value, not a variable, and cannot be assigned";
                self.report.error(codes::NOT_MUTABLE, whole, message, "name it first: `let mut x = …;`");
            }
        }
    }

    fn require_mutable_variable(&mut self, id: usize, whole: &Origin) {
        let Some(variable) = self.variables.get(id) else { return };
        if variable.mutable {
            return;
        }
        let name = variable.name.clone();
        let declared = variable.origin.clone();
        let message = format!("`{name}` cannot be assigned: it is not declared with `mut`");
        let hint = match variable.kind {
            Type::Fragments | Type::Uniforms => {
                format!("`{name}` only gives values: copy what you need into a `let mut`")
            }
            _ => format!("declare it with `let mut {name} = …;`, or copy it into such a variable"),
        };
        let diagnostic = Diagnostic::new(codes::NOT_MUTABLE, whole, message, hint);
        self.report.push(diagnostic.label(&declared, "declared here"));
    }
}
