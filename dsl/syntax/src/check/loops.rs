//! Loops with an end: `for` over a range or over the fragments; `break` and `continue`.
//!
//! In: a loop. Out: a typed loop whose number of rounds is known when it begins. `while` and `loop` are refused.

use fragbuf_model::{Origin, codes};
use syn::spanned::Spanned;

use super::Checker;
use crate::tree::{Expr, For, Kind, Over, VariableId};
use crate::types::Type;

const FORMS: &str = "write `for i in a..b`, `for f in fragments`, or `for (i, f) in fragments.iter().enumerate()`";

/// What stands behind `in`.
enum Head<'a> {
    Range { range: &'a syn::ExprRange, reversed: bool },
    Fragments { list: &'a syn::Expr, counted: bool, reversed: bool },
    Other,
}

impl Checker<'_, '_, '_> {
    pub(super) fn for_loop(&mut self, each: &syn::ExprForLoop) -> Expr {
        let origin = self.at(each.for_token.span);
        self.scopes.push(Vec::new());
        let over = match head(&each.expr) {
            Head::Range { range, reversed } => self.over_range(range, &each.pat, reversed),
            Head::Fragments { list, counted, reversed } => self.over_fragments(list, &each.pat, counted, reversed),
            Head::Other => {
                self.over_other(&each.expr);
                None
            }
        };
        if over.is_none() {
            self.declare_all(&each.pat);
        }
        self.loops += 1;
        let body = self.block(&each.body, Some(Type::Unit));
        self.loops -= 1;
        self.scopes.pop();
        match over {
            Some(over) => Expr::new(Kind::For(Box::new(For { over, body })), Type::Unit, origin),
            None => Expr::error(origin),
        }
    }

    fn over_other(&mut self, expr: &syn::Expr) {
        if let syn::Expr::MethodCall(call) = without_parens(expr) {
            let message = format!("a loop cannot go through what `{}` gives", call.method);
            self.refuse(self.at(call.method.span()), message, FORMS);
            return;
        }
        let found = self.expr(expr, None);
        if self.inference.resolve(found.ty) != Type::Error {
            self.refuse(found.origin, "a loop cannot go through this", FORMS);
        }
    }

    fn over_range(&mut self, range: &syn::ExprRange, pattern: &syn::Pat, reversed: bool) -> Option<Over> {
        let origin = self.at(range.span());
        let (Some(start), Some(end)) = (&range.start, &range.end) else {
            let message = "the loop's range has no end that can be read from its head";
            self.report.error(codes::UNBOUNDED_LOOP, &origin, message, "write both ends: `for i in 0..n`");
            return None;
        };
        let from = self.expr(start, None);
        let to = self.expr(end, None);
        let kind = self.range_type(&from, &to)?;
        let inclusive = matches!(range.limits, syn::RangeLimits::Closed(_));
        if inclusive && reversed {
            self.refuse(origin, "`..=` backwards is not part of the language", "write `(a..b + 1).rev()`");
            return None;
        }
        let variable = self.loop_name(pattern, kind)?;
        Some(Over::Range { variable, kind, from: Box::new(from), to: Box::new(to), inclusive, reversed })
    }

    fn range_type(&mut self, from: &Expr, to: &Expr) -> Option<Type> {
        let kind = self.inference.unify(from.ty, to.ty);
        match kind {
            Some(Type::Error) => None,
            Some(kind) if self.inference.is_whole(kind) => Some(kind),
            _ => {
                let wrong = if self.inference.is_whole(from.ty) { to } else { from };
                let message = format!(
                    "a loop counts whole numbers of one type, not from `{}` to `{}`",
                    self.inference.name(from.ty),
                    self.inference.name(to.ty)
                );
                let hint = "convert the bounds: `… as u32`, or `… as usize` beside `fragments.len()`";
                self.report.error(codes::WRONG_TYPE, &wrong.origin, message, hint);
                None
            }
        }
    }

    fn over_fragments(&mut self, list: &syn::Expr, pattern: &syn::Pat, counted: bool, reversed: bool) -> Option<Over> {
        let found = self.expr(list, None);
        let kind = self.inference.resolve(found.ty);
        if kind != Type::Fragments {
            if kind != Type::Error {
                self.refuse(found.origin, "a loop cannot go through this", FORMS);
            }
            return None;
        }
        match (counted, pattern) {
            (false, pattern) => {
                let fragment = self.loop_name(pattern, Type::Fragment)?;
                Some(Over::Fragments { index: None, fragment, reversed })
            }
            (true, syn::Pat::Tuple(pair)) if pair.elems.len() == 2 => {
                let index = self.loop_name(pair.elems.first()?, Type::Usize)?;
                let fragment = self.loop_name(pair.elems.last()?, Type::Fragment)?;
                Some(Over::Fragments { index, fragment, reversed })
            }
            (true, pattern) => {
                let origin = self.at(pattern.span());
                self.report.error(codes::WRONG_TYPE, &origin, "`enumerate()` gives pairs", "write `for (i, f) in …`");
                None
            }
        }
    }

    /// The name of what a round of the loop sees; `Some(None)` for `_`.
    fn loop_name(&mut self, pattern: &syn::Pat, kind: Type) -> Option<Option<VariableId>> {
        match pattern {
            syn::Pat::Wild(_) => Some(None),
            syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() && name.mutability.is_none() => {
                Some(Some(self.declare(&name.ident, false, false, kind)))
            }
            _ => {
                let origin = self.at(pattern.span());
                self.refuse(origin, "a loop's variable is a plain name", "copy it inside: `let mut x = i;`");
                None
            }
        }
    }

    /// After a mistake in the head, the names are there all the same.
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

    pub(super) fn end_loop(&mut self, end: &syn::ExprBreak) -> Expr {
        let origin = self.at(end.span());
        if end.expr.is_some() {
            return self.refuse(
                origin,
                "`break` with a value is not part of the language",
                "assign to a `let mut` before",
            );
        }
        self.jump(end.label.is_some(), "break", Kind::Break, origin)
    }

    pub(super) fn next_round(&mut self, next: &syn::ExprContinue) -> Expr {
        let origin = self.at(next.span());
        self.jump(next.label.is_some(), "continue", Kind::Continue, origin)
    }

    fn jump(&mut self, labelled: bool, word: &str, kind: Kind, origin: Origin) -> Expr {
        if labelled {
            let hint = "move the inner loop into a helper `fn` and `return` from it";
            return self.refuse(origin, "labels are not part of the language", hint);
        }
        if self.loops == 0 {
            let message = format!("`{word}` stands outside any loop");
            self.report.error(codes::UNEXPECTED, &origin, message, "`return` a value to leave the function");
            return Expr::error(origin);
        }
        Expr::new(kind, Type::Never, origin)
    }

    pub(super) fn unbounded(&mut self, expr: &syn::Expr) -> Expr {
        let (word, origin) = match expr {
            syn::Expr::While(inner) => ("while", self.at(inner.while_token.span)),
            syn::Expr::Loop(inner) => ("loop", self.at(inner.loop_token.span)),
            other => ("loop", self.at(other.span())),
        };
        let message = format!("the end of a `{word}` cannot be read from its head");
        let hint = "write `for _ in 0..N { … }` with a number of rounds that is enough, and `break` when done";
        self.report.error(codes::UNBOUNDED_LOOP, &origin, message, hint);
        Expr::error(origin)
    }
}

fn head(expr: &syn::Expr) -> Head<'_> {
    match without_parens(expr) {
        syn::Expr::Range(range) => Head::Range { range, reversed: false },
        list @ syn::Expr::Path(_) => Head::Fragments { list, counted: false, reversed: false },
        syn::Expr::MethodCall(call) if call.args.is_empty() && call.turbofish.is_none() => {
            let inner = head(&call.receiver);
            match (call.method.to_string().as_str(), inner) {
                ("iter", Head::Fragments { list, counted: false, reversed: false }) if is_path(&call.receiver) => {
                    Head::Fragments { list, counted: false, reversed: false }
                }
                ("enumerate", Head::Fragments { list, counted: false, reversed: false })
                    if !is_path(&call.receiver) =>
                {
                    Head::Fragments { list, counted: true, reversed: false }
                }
                ("rev", Head::Fragments { list, counted, reversed: false }) if !is_path(&call.receiver) => {
                    Head::Fragments { list, counted, reversed: true }
                }
                ("rev", Head::Range { range, reversed: false }) => Head::Range { range, reversed: true },
                _ => Head::Other,
            }
        }
        _ => Head::Other,
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
