//! Methods of the list of fragments.
//!
//! Input: a call on the list. Output: a typed call of `len` or `is_empty`, or the error with what the language has instead.

use fragbuf_model::{SourceSpan, codes, nearest_name};

use super::checker::Checker;
use super::given::{source, source_of_operand};
use super::noted::Noted;
use crate::inspection::NameKind;
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

/// The methods of the list: name and signature.
pub(super) const LIST_METHODS: [(&str, &str); 3] = [
    ("len", "fn len(self) -> usize"),
    ("is_empty", "fn is_empty(self) -> bool"),
    ("iter", "fn iter(self), in the head of a `for` loop"),
];

impl Checker<'_, '_, '_> {
    pub(super) fn list_method(&mut self, call: &syn::ExprMethodCall, span: SourceSpan, name_span: &SourceSpan) -> Expr {
        let name = call.method.to_string();
        if let Some((name, signature)) = LIST_METHODS.iter().find(|(known, _)| *known == name) {
            let known = || Noted::Known(NameKind::Method, (*name).to_owned(), (*signature).to_owned());
            self.note(name_span, known);
        }
        match name.as_str() {
            "len" => {
                self.require_count(&name, 0, call.args.len(), &span);
                Expr::new(Kind::LayerCount, Type::Usize, span)
            }
            "is_empty" => {
                self.require_count(&name, 0, call.args.len(), &span);
                let count = Expr::new(Kind::LayerCount, Type::Usize, span.clone());
                let zero = Expr::new(Kind::Integer(0), Type::Usize, span.clone());
                Expr::new(Kind::Binary(Operator::Equal, Box::new(count), Box::new(zero)), Type::Bool, span)
            }
            _ => {
                let message = format!("no method `{name}` for the list of fragments");
                self.report.error(codes::UNKNOWN_METHOD, name_span, message, instead(&name, call));
                Expr::error(span)
            }
        }
    }
}

/// Returns what the language has instead of a method.
fn instead(name: &str, call: &syn::ExprMethodCall) -> String {
    let list = source_of_operand(&call.receiver);
    match name {
        "iter" | "into_iter" | "rev" => format!("it is only for loops: `for f in {list}.iter().rev() {{ … }}`"),
        "length" | "size" | "count" => format!("write `{list}.len()`"),
        _ => match (element(call), nearest_name(name, &["len", "is_empty"])) {
            (Some(element), _) => format!("write `{element}`"),
            (None, Some(nearest)) => format!("did you mean `{nearest}`?"),
            (None, None) => format!("use `len()`, `is_empty()`, or iterate with `for f in {list} {{ … }}`"),
        },
    }
}

/// Returns the element that a method of a slice or an iterator returns, as `fragments[0]`. `None`: it is another method.
pub(super) fn element(call: &syn::ExprMethodCall) -> Option<String> {
    let list = source_of_operand(super::iterators::list(&call.receiver));
    let mut arguments = call.args.iter();
    match (call.method.to_string().as_str(), arguments.next(), arguments.next()) {
        ("first" | "next" | "front", None, None) => Some(format!("{list}[0]")),
        ("last" | "back", None, None) => Some(format!("{list}[{list}.len() - 1]")),
        ("get" | "nth" | "at", Some(index), None) => Some(format!("{list}[{}]", source(index))),
        _ => None,
    }
}
