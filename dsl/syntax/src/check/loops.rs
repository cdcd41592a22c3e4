//! Bounded loops: `for` over a range or over the fragments; `break` and `continue`.
//!
//! Input: a loop. Output: a typed loop whose number of iterations is known when it starts. `while` and `loop` are rejected.

use fragbuf_model::{SourceSpan, codes};
use syn::spanned::Spanned;

use super::checker::Checker;
use crate::tree::{Expr, For, Kind, Sequence, VariableId};
use crate::types::Type;

const FORMS: &str = "write `for i in a..b`, `for f in fragments`, or `for (i, f) in fragments.iter().enumerate()`";

/// The expression after `in`.
enum IteratorExpr<'a> {
    Range { range: &'a syn::ExprRange, reversed: bool },
    Fragments { list: &'a syn::Expr, enumerated: bool, reversed: bool },
    Other,
}

impl Checker<'_, '_, '_> {
    pub(super) fn for_loop(&mut self, each: &syn::ExprForLoop) -> Expr {
        let span = self.at(each.for_token.span);
        self.scopes.push(Vec::new());
        let sequence = match iterator(&each.expr) {
            IteratorExpr::Range { range, reversed } => self.range(range, &each.pat, reversed),
            IteratorExpr::Fragments { list, enumerated, reversed } => {
                self.fragments(list, &each.pat, enumerated, reversed)
            }
            IteratorExpr::Other => {
                self.reject_iterator(&each.expr);
                None
            }
        };
        if sequence.is_none() {
            self.declare_all(&each.pat);
        }
        self.loops += 1;
        let body = self.block(&each.body, Some(Type::Unit));
        self.loops -= 1;
        self.scopes.pop();
        match sequence {
            Some(sequence) => Expr::new(Kind::For(Box::new(For { sequence, body })), Type::Unit, span),
            None => Expr::error(span),
        }
    }

    fn reject_iterator(&mut self, expr: &syn::Expr) {
        if let syn::Expr::MethodCall(call) = without_parens(expr) {
            let message = format!("a loop cannot iterate over the result of `{}`", call.method);
            self.unsupported(self.at(call.method.span()), message, FORMS);
            return;
        }
        let found = self.expr(expr, None);
        if self.inference.resolve(found.ty) != Type::Error {
            self.unsupported(found.span, "a loop cannot iterate over this", FORMS);
        }
    }

    fn range(&mut self, range: &syn::ExprRange, pattern: &syn::Pat, reversed: bool) -> Option<Sequence> {
        let span = self.at(range.span());
        let (Some(start), Some(end)) = (&range.start, &range.end) else {
            let missing = if range.end.is_none() { "upper" } else { "lower" };
            let message = format!("the range of this `for` loop has no {missing} bound");
            self.report.error(codes::UNBOUNDED_LOOP, &span, message, "write both bounds: `for i in 0..n`");
            return None;
        };
        let from = self.expr(start, None);
        let to = self.expr(end, None);
        let ty = self.range_type(&from, &to)?;
        let inclusive = matches!(range.limits, syn::RangeLimits::Closed(_));
        let variable = self.loop_variable(pattern, ty)?;
        Some(Sequence::Range { variable, ty, from: Box::new(from), to: Box::new(to), inclusive, reversed })
    }

    fn range_type(&mut self, from: &Expr, to: &Expr) -> Option<Type> {
        match self.inference.unify(from.ty, to.ty) {
            Some(Type::Error) => None,
            Some(ty) if self.inference.is_integer(ty) => Some(ty),
            _ => {
                let wrong = if self.inference.is_integer(from.ty) { to } else { from };
                let message = format!(
                    "mismatched range bounds: expected integers of one type, found `{}` and `{}`",
                    self.inference.name(from.ty),
                    self.inference.name(to.ty)
                );
                let help = "convert a bound: `… as u32`, or `… as usize` with `fragments.len()`";
                self.report.error(codes::TYPE_MISMATCH, &wrong.span, message, help);
                None
            }
        }
    }

    fn fragments(
        &mut self,
        list: &syn::Expr,
        pattern: &syn::Pat,
        enumerated: bool,
        reversed: bool,
    ) -> Option<Sequence> {
        let found = self.expr(list, None);
        let ty = self.inference.resolve(found.ty);
        if ty != Type::Fragments {
            if ty != Type::Error {
                self.unsupported(found.span, "a loop cannot iterate over this", FORMS);
            }
            return None;
        }
        match (enumerated, pattern) {
            (false, pattern) => {
                let fragment = self.loop_variable(pattern, Type::Fragment)?;
                Some(Sequence::Fragments { index: None, fragment, reversed })
            }
            (true, syn::Pat::Tuple(pair)) if pair.elems.len() == 2 => {
                let index = self.loop_variable(pair.elems.first()?, Type::Usize)?;
                let fragment = self.loop_variable(pair.elems.last()?, Type::Fragment)?;
                Some(Sequence::Fragments { index, fragment, reversed })
            }
            (true, pattern) => {
                let span = self.at(pattern.span());
                self.report.error(codes::TYPE_MISMATCH, &span, "`enumerate()` yields pairs", "write `for (i, f) in …`");
                None
            }
        }
    }

    /// Declares the variable of a loop; returns `Some(None)` for `_`.
    fn loop_variable(&mut self, pattern: &syn::Pat, ty: Type) -> Option<Option<VariableId>> {
        match pattern {
            syn::Pat::Wild(_) => Some(None),
            syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() && name.mutability.is_none() => {
                Some(Some(self.declare(&name.ident, false, false, ty)))
            }
            _ => {
                let span = self.at(pattern.span());
                self.unsupported(
                    span,
                    "patterns and `mut` in `for` are not supported",
                    "copy it inside: `let mut x = i;`",
                );
                None
            }
        }
    }

    /// Declares all names of a loop whose header has an error, so that their uses are not reported.
    fn declare_all(&mut self, pattern: &syn::Pat) {
        match pattern {
            syn::Pat::Ident(name) => drop(self.declare(&name.ident, true, false, Type::Error)),
            syn::Pat::Tuple(parts) => {
                for part in &parts.elems {
                    if let syn::Pat::Ident(name) = part {
                        self.declare(&name.ident, true, false, Type::Error);
                    }
                }
            }
            _ => {}
        }
    }

    pub(super) fn break_expr(&mut self, end: &syn::ExprBreak) -> Expr {
        let span = self.at(end.span());
        if end.expr.is_some() {
            return self.unsupported(
                span,
                "`break` with a value is not supported",
                "assign the value to a `let mut` before `break`",
            );
        }
        self.jump(end.label.is_some(), "break", Kind::Break, span)
    }

    pub(super) fn continue_expr(&mut self, next: &syn::ExprContinue) -> Expr {
        let span = self.at(next.span());
        self.jump(next.label.is_some(), "continue", Kind::Continue, span)
    }

    fn jump(&mut self, labelled: bool, keyword: &str, kind: Kind, span: SourceSpan) -> Expr {
        if labelled {
            let help = "move the inner loop into a helper `fn` and `return` from it";
            return self.unsupported(span, "labels are not supported", help);
        }
        if self.loops == 0 {
            let message = format!("`{keyword}` outside of a loop");
            self.report.error(codes::UNEXPECTED_TOKEN, &span, message, "`return` a value to leave the function");
            return Expr::error(span);
        }
        Expr::new(kind, Type::Never, span)
    }

    pub(super) fn unbounded_loop(&mut self, expr: &syn::Expr) -> Expr {
        let (keyword, span) = match expr {
            syn::Expr::While(inner) => ("while", self.at(inner.while_token.span)),
            syn::Expr::Loop(inner) => ("loop", self.at(inner.loop_token.span)),
            other => ("loop", self.at(other.span())),
        };
        let message = format!("this `{keyword}` loop has no iteration limit");
        let help = "write `for _ in 0..64 { … }` with a sufficient limit, and `break` when done";
        self.report.error(codes::UNBOUNDED_LOOP, &span, message, help);
        Expr::error(span)
    }
}

/// Classifies the expression after `in`.
fn iterator(expr: &syn::Expr) -> IteratorExpr<'_> {
    match without_parens(expr) {
        syn::Expr::Range(range) => IteratorExpr::Range { range, reversed: false },
        list @ syn::Expr::Path(_) => IteratorExpr::Fragments { list, enumerated: false, reversed: false },
        syn::Expr::MethodCall(call) if call.args.is_empty() && call.turbofish.is_none() => {
            let inner = iterator(&call.receiver);
            match (call.method.to_string().as_str(), inner) {
                ("iter", IteratorExpr::Fragments { list, enumerated: false, reversed: false })
                    if is_path(&call.receiver) =>
                {
                    IteratorExpr::Fragments { list, enumerated: false, reversed: false }
                }
                ("enumerate", IteratorExpr::Fragments { list, enumerated: false, reversed: false })
                    if !is_path(&call.receiver) =>
                {
                    IteratorExpr::Fragments { list, enumerated: true, reversed: false }
                }
                ("rev", IteratorExpr::Fragments { list, enumerated, reversed: false }) if !is_path(&call.receiver) => {
                    IteratorExpr::Fragments { list, enumerated, reversed: true }
                }
                ("rev", IteratorExpr::Range { range, reversed: false }) => {
                    IteratorExpr::Range { range, reversed: true }
                }
                _ => IteratorExpr::Other,
            }
        }
        _ => IteratorExpr::Other,
    }
}

fn is_path(expr: &syn::Expr) -> bool {
    matches!(without_parens(expr), syn::Expr::Path(_))
}

fn without_parens(mut expr: &syn::Expr) -> &syn::Expr {
    loop {
        match expr {
            syn::Expr::Paren(inner) => expr = &inner.expr,
            syn::Expr::Group(inner) => expr = &inner.expr,
            other => return other,
        }
    }
}
