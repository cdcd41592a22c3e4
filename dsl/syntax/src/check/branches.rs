//! `if`, as a statement and as a value.
//!
//! In: a branch, and the type that its place needs. Out: a typed branch; where a value is needed, both ways give it.

use fragbuf_model::codes;
use syn::spanned::Spanned;

use super::Checker;
use crate::tree::{Expr, If, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn branch(&mut self, branch: &syn::ExprIf, expected: Option<Type>) -> Expr {
        let origin = self.at(branch.if_token.span);
        let condition = self.value(&branch.cond, Type::Bool);
        let Some((_, otherwise)) = &branch.else_branch else {
            return self.without_else(branch, condition, expected);
        };
        let then = self.block(&branch.then_branch, expected);
        let then_type = self.type_of_block(&then, expected);
        let needed = expected.or(if then_type == Type::Never { None } else { Some(then_type) });
        let otherwise = match needed {
            Some(needed) => self.value(otherwise, needed),
            None => self.expr(otherwise, None),
        };
        let ty = self.inference.unify(then_type, otherwise.ty).unwrap_or(Type::Error);
        Expr::new(Kind::If(Box::new(If { condition, then, otherwise: Some(otherwise) })), ty, origin)
    }

    fn without_else(&mut self, branch: &syn::ExprIf, condition: Expr, expected: Option<Type>) -> Expr {
        let origin = self.at(branch.if_token.span);
        let needed = expected.map(|expected| self.inference.resolve(expected));
        let needs_value = needed.is_some_and(|needed| !matches!(needed, Type::Unit | Type::Error | Type::Never));
        let then = self.block(&branch.then_branch, if needs_value { expected } else { Some(Type::Unit) });
        let ty = if needs_value { Type::Error } else { Type::Unit };
        if let (true, Some(needed)) = (needs_value, needed) {
            let message = format!("without `else`, a value of type `{}` is missing", self.inference.name(needed));
            let end = self.at(branch.then_branch.span());
            let diagnostic = fragbuf_model::Diagnostic::new(
                codes::MISSING_VALUE,
                &origin,
                message,
                "add `else { … }` with the value for when the condition is false",
            );
            self.report.push(diagnostic.label(&end, "the value for when it is true"));
        }
        Expr::new(Kind::If(Box::new(If { condition, then, otherwise: None })), ty, origin)
    }
}
