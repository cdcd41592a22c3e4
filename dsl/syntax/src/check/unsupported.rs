//! Constructs of Rust that the closure language does not support: the name of each, and what to write instead.
//!
//! Input: a syntax tree that no rule accepts. Output: message and help.

use proc_macro2::Span;
use syn::Expr;
use syn::spanned::Spanned;

/// Returns the name of the construct with its verb, and what to write instead.
pub(super) fn describe(expr: &Expr) -> (&'static str, &'static str) {
    match expr {
        Expr::Array(_) | Expr::Repeat(_) => ("arrays are", "use a vector, `vec4(a, b, c, d)`, or one variable each"),
        Expr::Async(_) | Expr::Await(_) => ("`async` is", "call the function directly"),
        Expr::Block(_) | Expr::ForLoop(_) => {
            ("labels are", "move the inner loop into a helper `fn` and `return` from it")
        }
        Expr::Closure(_) => ("closures inside closures are", "write a helper `fn` next to the closure"),
        Expr::Const(_) => ("`const` blocks are", "write the expression itself"),
        Expr::Infer(_) => ("`_` as a value is", "write the value"),
        Expr::Let(_) => ("`if let` is", "compare: `if i < fragments.len() { … }`"),
        Expr::Macro(_) => ("macros are", "write the expanded code"),
        Expr::Match(_) => ("`match` is", "write `if … { … } else if … { … } else { … }`"),
        Expr::Range(_) => ("ranges outside a `for` are", "write `for i in a..b { … }`, or compare: `a <= x && x < b`"),
        Expr::RawAddr(_) | Expr::Reference(_) => ("references are", "pass the value itself: all values are copied"),
        Expr::Struct(_) => ("struct literals are", "use one variable per value"),
        Expr::Try(_) | Expr::TryBlock(_) => ("`?` is", "write `if condition { a } else { b }`"),
        Expr::Tuple(tuple) if tuple.elems.is_empty() => ("`()` is", "remove it"),
        Expr::Tuple(_) => ("tuples are", "use a vector, `vec2(a, b)`, or one variable each"),
        Expr::Unsafe(_) => ("`unsafe` is", "write the block without it"),
        Expr::Yield(_) => ("`yield` is", "`return` the value"),
        _ => ("this expression is", "write it with numbers, vectors, `if`, `for` and helper functions"),
    }
}

/// Returns the span that a message points to.
pub(super) fn span(expr: &Expr) -> Span {
    match expr {
        Expr::Match(inner) => inner.match_token.span,
        Expr::Unsafe(inner) => inner.unsafe_token.span,
        Expr::Async(inner) => inner.async_token.span,
        Expr::Const(inner) => inner.const_token.span,
        Expr::Block(inner) => inner.label.as_ref().map_or_else(|| inner.span(), |label| label.span()),
        Expr::ForLoop(inner) => inner.label.as_ref().map_or_else(|| inner.span(), |label| label.span()),
        other => other.span(),
    }
}
