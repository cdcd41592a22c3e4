//! Expressions: one arm per construct of Rust that the language has.
//!
//! In: a syntax tree, and the type its place expects if that is known. Out: a typed tree. The expected type only steers
//! messages into the arms of blocks and branches; whether it is met, [`Checker::value`] decides.

use fragbuf_model::codes;
use syn::spanned::Spanned;

use super::{Checker, DEPTH, unsupported};
use crate::tree::{Expr, Kind};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    /// An expression whose place needs this type.
    pub(super) fn value(&mut self, expr: &syn::Expr, expected: Type) -> Expr {
        let found = self.expr(expr, Some(expected));
        self.require(found, expected)
    }

    /// An expression.
    pub(super) fn expr(&mut self, expr: &syn::Expr, expected: Option<Type>) -> Expr {
        if self.depth >= DEPTH {
            let origin = self.at(expr.span());
            return self.refuse(origin, "the expression nests too deep", "name its inner parts with `let`");
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
            syn::Expr::Assign(assign) => self.assign(assign),
            syn::Expr::Return(leave) => self.leave(leave),
            syn::Expr::Break(end) => self.end_loop(end),
            syn::Expr::Continue(next) => self.next_round(next),
            syn::Expr::While(_) | syn::Expr::Loop(_) => self.unbounded(expr),
            other => self.unsupported(other),
        }
    }

    fn block_expr(&mut self, block: &syn::Block, expected: Option<Type>) -> Expr {
        let origin = self.at(block.span());
        let block = self.block(block, expected);
        let ty = self.type_of_block(&block, expected);
        Expr::new(Kind::Block(block), ty, origin)
    }

    fn leave(&mut self, leave: &syn::ExprReturn) -> Expr {
        let origin = self.at(leave.span());
        let result = self.result;
        let Some(expr) = &leave.expr else {
            let message = format!("`return` needs a value of type `{}` here", result.rust());
            self.report.error(codes::MISSING_VALUE, &origin, message, "write `return value;`");
            return Expr::new(Kind::Error, Type::Never, origin);
        };
        let value = self.value(expr, result);
        Expr::new(Kind::Return(Box::new(value)), Type::Never, origin)
    }

    fn unsupported(&mut self, expr: &syn::Expr) -> Expr {
        let (what, hint) = unsupported::describe(expr);
        let origin = self.at(unsupported::head(expr));
        self.refuse(origin, format!("{what} not part of the language"), hint)
    }
}
