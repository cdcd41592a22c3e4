//! `if`, as a statement and as a value.
//!
//! Input: a branch, and the expected type. Output: a typed branch. If a value is expected, both arms must have it.

use fragbuf_model::{Diagnostic, codes};
use syn::spanned::Spanned;

use super::checker::Checker;
use crate::tree::{Expr, If, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn branch(&mut self, branch: &syn::ExprIf, expected: Option<Type>) -> Expr {
        let span = self.at(branch.if_token.span);
        let condition = self.value(&branch.cond, Type::Bool);
        let Some((_, else_branch)) = &branch.else_branch else {
            return self.without_else(branch, condition, expected);
        };
        let then = self.block(&branch.then_branch, expected);
        let then_type = self.type_of_block(&then, expected);
        let needed = expected.or(if then_type == Type::Never { None } else { Some(then_type) });
        let else_branch = match needed {
            Some(needed) => self.value(else_branch, needed),
            None => self.expr(else_branch, None),
        };
        let ty = self.inference.unify(then_type, else_branch.ty).unwrap_or(Type::Error);
        Expr::new(Kind::If(Box::new(If { condition, then, else_branch: Some(else_branch) })), ty, span)
    }

    fn without_else(&mut self, branch: &syn::ExprIf, condition: Expr, expected: Option<Type>) -> Expr {
        let span = self.at(branch.if_token.span);
        let needed = expected.map(|expected| self.inference.resolve(expected));
        let needs_value = needed.is_some_and(|needed| !matches!(needed, Type::Unit | Type::Error | Type::Never));
        let then = self.block(&branch.then_branch, if needs_value { expected } else { Some(Type::Unit) });
        let ty = if needs_value { Type::Error } else { Type::Unit };
        if let (true, Some(needed)) = (needs_value, needed) {
            let message =
                format!("expected a value of type `{}`, found `if` without `else`", self.inference.name(needed));
            let end = self.at(branch.then_branch.span());
            let diagnostic = Diagnostic::new(
                codes::MISSING_VALUE,
                &span,
                message,
                "add `else { … }` with the value for a false condition",
            );
            self.report.push(diagnostic.label(&end, "the value for a true condition"));
        }
        Expr::new(Kind::If(Box::new(If { condition, then, else_branch: None })), ty, span)
    }
}
