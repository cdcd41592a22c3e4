//! Expressions: one arm per construct of Rust that the language has.
//!
//! Input: a syntax tree, and the expected type if it is known. Output: a typed tree. The expected type only makes messages
//! point into the arms of blocks and branches; [`Checker::value`] requires it.

use fragbuf_model::codes;
use syn::spanned::Spanned;

use super::checker::Checker;
use super::unsupported;
use crate::tree::{Expr, Kind};
use crate::types::Type;

/// The maximum nesting depth of expressions.
const DEPTH: usize = 64;

impl Checker<'_, '_, '_> {
    /// Checks an expression that must have this type.
    pub(super) fn value(&mut self, expr: &syn::Expr, expected: Type) -> Expr {
        let found = self.expr(expr, Some(expected));
        self.require(found, expected, expr)
    }

    /// Checks an expression.
    pub(super) fn expr(&mut self, expr: &syn::Expr, expected: Option<Type>) -> Expr {
        if self.depth >= DEPTH {
            let span = self.at(expr.span());
            return self.unsupported(
                span,
                format!("the expression is nested more than {DEPTH} deep"),
                "name its inner parts with `let`",
            );
        }
        self.depth += 1;
        let found = self.shallow(expr, expected);
        self.depth -= 1;
        found
    }

    fn shallow(&mut self, expr: &syn::Expr, expected: Option<Type>) -> Expr {
        match expr {
            syn::Expr::Paren(inner) => self.expr(&inner.expr, expected),
            syn::Expr::Group(inner) => self.expr(&inner.expr, expected),
            syn::Expr::Lit(literal) => self.literal(&literal.lit),
            syn::Expr::Path(path) => self.path(path),
            syn::Expr::Field(field) => self.field(field),
            syn::Expr::Index(index) => self.index(index),
            syn::Expr::Unary(unary) => self.unary(unary),
            syn::Expr::Binary(binary) => self.binary(binary),
            syn::Expr::Cast(cast) => self.cast(cast),
            syn::Expr::Call(call) => self.call(call),
            syn::Expr::MethodCall(call) => self.method_call(call),
            syn::Expr::If(branch) => self.branch(branch, expected),
            syn::Expr::Block(block) if block.label.is_none() => self.block_expr(&block.block, expected),
            syn::Expr::ForLoop(each) if each.label.is_none() => self.for_loop(each),
            syn::Expr::Assign(assign) if expected == Some(Type::Bool) => self.assignment_for_comparison(assign),
            syn::Expr::Assign(assign) => self.assign(assign),
            syn::Expr::Return(leave) => self.return_expr(leave),
            syn::Expr::Break(end) => self.break_expr(end),
            syn::Expr::Continue(next) => self.continue_expr(next),
            syn::Expr::While(_) | syn::Expr::Loop(_) => self.unbounded_loop(expr),
            other => self.unsupported_expr(other),
        }
    }

    fn block_expr(&mut self, block: &syn::Block, expected: Option<Type>) -> Expr {
        let span = self.at(block.span());
        let block = self.block(block, expected);
        let ty = self.type_of_block(&block, expected);
        Expr::new(Kind::Block(block), ty, span)
    }

    fn return_expr(&mut self, leave: &syn::ExprReturn) -> Expr {
        let span = self.at(leave.span());
        let result = self.result;
        let Some(expr) = &leave.expr else {
            let message = format!("expected a value of type `{}` after `return`", result.rust());
            self.report.error(codes::MISSING_VALUE, &span, message, "write `return value;`");
            return Expr::new(Kind::Error, Type::Never, span);
        };
        let value = self.value(expr, result);
        Expr::new(Kind::Return(Box::new(value)), Type::Never, span)
    }

    fn unsupported_expr(&mut self, expr: &syn::Expr) -> Expr {
        let (what, help) = unsupported::describe(expr);
        let span = self.at(unsupported::span(expr));
        self.unsupported(span, format!("{what} not supported"), help)
    }
}
