//! Chains of iterator methods, `fragments.iter().map(|f| f.depth).sum()`, which the language does not have, and the loop that computes
//! the same.
//!
//! Input: a chain over the list of fragments or a range. Output: one error, whose help is an expression that compiles in place of the
//! chain. The closures are checked, because the first value of a sum depends on their types.

use fragbuf_model::codes;
use syn::spanned::Spanned;

use super::checker::Checker;
use super::given::{source, source_of_operand};
use super::list_methods;
use crate::tree::Expr;
use crate::types::Type;

/// Methods that only begin or reorder the iteration, as a `for` loop can.
const OF_LOOPS: [&str; 4] = ["iter", "into_iter", "rev", "enumerate"];

/// Methods that return an iterator.
const ADAPTERS: [&str; 12] =
    ["iter", "into_iter", "rev", "enumerate", "map", "filter", "take_while", "copied", "cloned", "skip", "take", "zip"];

/// Methods that return what an `Option` contains.
const OF_OPTION: [&str; 4] = ["unwrap", "expect", "unwrap_or", "unwrap_or_default"];

/// A loop that computes the same as the chain so far.
struct Loop {
    /// What follows `in`.
    over: String,
    /// The pattern after `for`; empty: no closure has named the item yet.
    pattern: String,
    /// The statements before that of the last method, with open blocks.
    body: String,
    open: usize,
    /// The source and the type of the item.
    value: String,
    ty: Type,
    is_enumerated: bool,
}

impl Checker<'_, '_, '_> {
    /// Reports a chain of iterator methods that ends with this call. `None`: it is none, or it ends before this call.
    pub(super) fn iterator_chain(&mut self, call: &syn::ExprMethodCall) -> Option<Expr> {
        let links = links(call);
        let base = without_parens(&links.first()?.receiver);
        let is_list = self.is_list(base);
        let range = match base {
            syn::Expr::Range(range) => Some(range),
            _ => None,
        };
        if !is_list && range.is_none() || !is_whole(&links) {
            return None;
        }
        let names: Vec<String> = links.iter().map(|link| link.method.to_string()).collect();
        if is_list && !OF_LOOPS.contains(&names.first()?.as_str()) {
            return self.element_of_list(&links);
        }
        if names.iter().all(|name| OF_LOOPS.contains(&name.as_str())) {
            return None;
        }
        let span = self.at(call.span());
        let help = match range {
            Some(range) if names.first()?.as_str() == "contains" => self.contains(range, links.first()?),
            _ => {
                let errors = self.report.count();
                self.scopes.push(Vec::new());
                let found = self.as_loop(base, &links);
                self.scopes.pop();
                match found {
                    Some(expression) => format!("write `{expression}`"),
                    // The closures have errors of their own.
                    None if self.report.count() > errors => return Some(Expr::error(span)),
                    None => {
                        format!("write a loop: `for {} {{ … }}`", if is_list { "f in fragments" } else { "i in a..b" })
                    }
                }
            }
        };
        self.report.error(codes::UNSUPPORTED, &span, "iterators are not supported outside of `for`", help);
        Some(Expr::error(span))
    }

    /// Tests whether an expression is the list of fragments.
    fn is_list(&self, base: &syn::Expr) -> bool {
        let syn::Expr::Path(path) = base else { return false };
        let id = path.path.get_ident().and_then(|name| self.lookup(&name.to_string()));
        id.and_then(|id| self.variables.get(id)).is_some_and(|variable| variable.ty == Type::Fragments)
    }

    /// Reports `fragments.first().unwrap()`. `None`: the first method returns no element.
    fn element_of_list(&mut self, links: &[&syn::ExprMethodCall]) -> Option<Expr> {
        let (first, last) = (links.first()?, links.last()?);
        let element = list_methods::element(first).filter(|_| links.len() > 1)?;
        let message = format!("no method `{}` for the list of fragments", first.method);
        let help = format!("write `{element}`");
        self.report.error(codes::UNKNOWN_METHOD, &self.at(first.method.span()), message, help);
        Some(Expr::error(self.at(last.span())))
    }

    /// Returns the help for `(a..b).contains(&x)`.
    fn contains(&mut self, range: &syn::ExprRange, call: &syn::ExprMethodCall) -> String {
        let value = match call.args.first() {
            Some(syn::Expr::Reference(reference)) => source_of_operand(&reference.expr),
            Some(other) => source_of_operand(other),
            None => "x".to_owned(),
        };
        let below = if matches!(range.limits, syn::RangeLimits::Closed(_)) { "<=" } else { "<" };
        let from = range.start.as_ref().map(|start| format!("{value} >= {}", source_of_operand(start)));
        let to = range.end.as_ref().map(|end| format!("{value} {below} {}", source_of_operand(end)));
        let both: Vec<String> = from.into_iter().chain(to).collect();
        format!("compare: `({})`", both.join(" && "))
    }

    /// Returns the expression that computes the same as a chain.
    fn as_loop(&mut self, base: &syn::Expr, links: &[&syn::ExprMethodCall]) -> Option<String> {
        // What an `Option` contains is what the loop computes.
        let is_of_option = |link: &&&syn::ExprMethodCall| OF_OPTION.contains(&link.method.to_string().as_str());
        let after = links.iter().rev().take_while(is_of_option).count();
        let (last, adapters) = links.get(..links.len() - after)?.split_last()?;
        let is_range = matches!(base, syn::Expr::Range(_));
        let ty = match base {
            syn::Expr::Range(range) => self.type_of_bounds(range)?,
            _ => Type::Fragment,
        };
        let over = if is_range { format!("({})", source(base)) } else { source(base) };
        let mut each = Loop {
            over,
            pattern: String::new(),
            body: String::new(),
            open: 0,
            value: String::new(),
            ty,
            is_enumerated: false,
        };
        for link in adapters {
            self.adapter(&mut each, link)?;
        }
        self.last_link(
            &mut each,
            last,
            adapters.iter().all(|link| OF_LOOPS.contains(&link.method.to_string().as_str())),
        )
    }

    fn type_of_bounds(&mut self, range: &syn::ExprRange) -> Option<Type> {
        let from = self.expr(range.start.as_ref()?, None);
        let to = self.expr(range.end.as_ref()?, None);
        self.inference.unify(from.ty, to.ty).filter(|ty| self.inference.is_integer(*ty))
    }

    /// Adds a method that returns an iterator.
    fn adapter(&mut self, each: &mut Loop, link: &syn::ExprMethodCall) -> Option<()> {
        match link.method.to_string().as_str() {
            "iter" | "into_iter" | "copied" | "cloned" => {}
            "rev" | "enumerate" if !each.pattern.is_empty() => return None,
            "rev" => {
                let iter = if each.ty == Type::Fragment && !each.is_enumerated { ".iter()" } else { "" };
                each.over = format!("{}{iter}.rev()", each.over.replace(".iter()", ""));
            }
            "enumerate" if each.ty == Type::Fragment => {
                let iter = if each.over.contains(".iter()") { "" } else { ".iter()" };
                each.over = format!("{}{iter}.enumerate()", each.over);
                each.is_enumerated = true;
            }
            "map" => {
                let (value, ty) = self.applied(each, link.args.first()?)?;
                (each.value, each.ty, each.is_enumerated) = (value, ty, false);
            }
            "filter" => {
                let (condition, _) = self.applied(each, link.args.first()?)?;
                each.body.push_str(&format!("if {condition} {{ "));
                each.open += 1;
            }
            "take_while" => {
                let (condition, _) = self.applied(each, link.args.first()?)?;
                each.body.push_str(&format!("if !({condition}) {{ break; }} "));
            }
            _ => return None,
        }
        Some(())
    }

    /// Names the item by the parameter of a closure. Returns the source of the closure's body and its type.
    fn applied(&mut self, each: &mut Loop, closure: &syn::Expr) -> Option<(String, Type)> {
        let syn::Expr::Closure(closure) = closure else { return None };
        let parameter = closure.inputs.first().filter(|_| closure.inputs.len() == 1)?;
        self.name_item(each, parameter)?;
        self.checked_body(&closure.body)
    }

    fn checked_body(&mut self, body: &syn::Expr) -> Option<(String, Type)> {
        let errors = self.report.count();
        let checked = self.expr(body, None);
        (self.report.count() == errors).then(|| (source(body), self.inference.resolve_or_default(checked.ty)))
    }

    fn name_item(&mut self, each: &mut Loop, parameter: &syn::Pat) -> Option<()> {
        let parameter = without_reference(parameter);
        match parameter {
            syn::Pat::Tuple(pair) if each.is_enumerated && each.pattern.is_empty() && pair.elems.len() == 2 => {
                let (index, item) = (name(pair.elems.first()?)?, name(pair.elems.last()?)?);
                self.declare(index, false, false, Type::Usize);
                self.declare(item, false, false, each.ty);
                each.pattern = format!("({index}, {item})");
                each.value = item.to_string();
            }
            parameter if !each.is_enumerated => {
                let item = name(parameter)?;
                self.declare(item, false, false, each.ty);
                let item = item.to_string();
                if each.pattern.is_empty() {
                    each.pattern.clone_from(&item);
                } else if each.value != item {
                    each.body.push_str(&format!("let {item} = {}; ", each.value));
                }
                each.value = item;
            }
            _ => return None,
        }
        Some(())
    }

    /// Returns the whole expression with the method that ends the chain.
    fn last_link(&mut self, each: &mut Loop, link: &syn::ExprMethodCall, is_plain: bool) -> Option<String> {
        let method = link.method.to_string();
        let is_list = each.ty == Type::Fragment;
        if is_plain && is_list && each.pattern.is_empty() && !each.over.contains(".rev()") {
            if method == "count" {
                return Some(format!("{}.len()", each.over));
            }
            if let Some(element) = list_methods::element(link) {
                return Some(element);
            }
        }
        let argument = link.args.first();
        let (name, first, step) = match method.as_str() {
            "sum" => ("sum".to_owned(), zero(each.ty)?, format!("sum += {};", each.item()?)),
            "product" => ("product".to_owned(), one(each.ty)?, format!("product *= {};", each.item()?)),
            "count" => ("count".to_owned(), "0_usize".to_owned(), "count += 1;".to_owned()),
            "any" | "all" => {
                let (condition, _) = self.applied(each, argument?)?;
                let is_any = method == "any";
                let condition = if is_any { condition } else { format!("!({condition})") };
                (method.clone(), (!is_any).to_string(), format!("if {condition} {{ {method} = {is_any}; }}"))
            }
            "fold" => self.fold(each, argument?, link.args.iter().nth(1)?)?,
            "for_each" => {
                let (statement, _) = self.applied(each, argument?)?;
                return Some(format!("for {} {{ {} }}", each.head(), each.with(&format!("{statement};"))));
            }
            _ => return None,
        };
        let (name_only, _) = name.split_once(':').unwrap_or((&name, ""));
        let body = each.with(&step);
        Some(format!("({{ let mut {name} = {first}; for {} {{ {body} }} {name_only} }})", each.head()))
    }

    /// Returns the accumulator with its type, its first value, and the statement that adds an item.
    fn fold(&mut self, each: &mut Loop, first: &syn::Expr, function: &syn::Expr) -> Option<(String, String, String)> {
        let value = self.expr(first, None);
        let ty = self.inference.resolve_or_default(value.ty);
        let declared = |name: &str| format!("{name}: {}", ty.rust());
        match function {
            syn::Expr::Closure(closure) if closure.inputs.len() == 2 => {
                let total = name(without_reference(closure.inputs.first()?))?;
                self.declare(total, true, true, ty);
                self.name_item(each, closure.inputs.last()?)?;
                let (body, _) = self.checked_body(&closure.body)?;
                Some((declared(&total.to_string()), source(first), format!("{total} = {body};")))
            }
            // `f32::max`
            syn::Expr::Path(path) if path.path.segments.len() == 2 => {
                let method = &path.path.segments.last()?.ident;
                let item = each.item()?;
                Some((declared("best"), source(first), format!("best = best.{method}({item});")))
            }
            _ => None,
        }
    }
}

impl Loop {
    /// Returns what is between `for` and the block.
    fn head(&self) -> String {
        let pattern = match self.pattern.as_str() {
            "" if self.is_enumerated => "(_, f)",
            "" if self.ty == Type::Fragment => "f",
            "" => "i",
            pattern => pattern,
        };
        format!("{pattern} in {}", self.over)
    }

    /// Returns the source of the item; `None`: it is a fragment, which no method of numbers takes.
    fn item(&self) -> Option<String> {
        match (self.value.as_str(), self.ty) {
            (_, Type::Fragment) => None,
            ("", _) => Some("i".to_owned()),
            (value, _) => Some(value.to_owned()),
        }
    }

    /// Returns the statements of the loop with `last` inside of the open blocks.
    fn with(&self, last: &str) -> String {
        format!("{}{last}{}", self.body, " }".repeat(self.open))
    }
}

/// Returns the calls of a chain, the innermost first.
fn links(call: &syn::ExprMethodCall) -> Vec<&syn::ExprMethodCall> {
    let mut links = vec![call];
    let mut receiver = &*call.receiver;
    while let syn::Expr::MethodCall(inner) = receiver {
        links.push(inner);
        receiver = &inner.receiver;
    }
    links.reverse();
    links
}

/// Tests whether a chain ends with its last call: a call after the end of a chain is a method of its value.
fn is_whole(links: &[&syn::ExprMethodCall]) -> bool {
    let name = |link: &&syn::ExprMethodCall| link.method.to_string();
    let end = links.iter().position(|link| !ADAPTERS.contains(&name(link).as_str()));
    let after = end.map_or(&[][..], |end| links.get(end + 1..).unwrap_or_default());
    after.iter().all(|link| OF_OPTION.contains(&name(link).as_str()))
}

/// Returns the list of `fragments.iter()`.
pub(super) fn list(receiver: &syn::Expr) -> &syn::Expr {
    match without_parens(receiver) {
        syn::Expr::MethodCall(call) if OF_LOOPS.contains(&call.method.to_string().as_str()) => list(&call.receiver),
        other => other,
    }
}

fn without_parens(mut expr: &syn::Expr) -> &syn::Expr {
    while let syn::Expr::Paren(inner) = expr {
        expr = &inner.expr;
    }
    expr
}

fn without_reference(pattern: &syn::Pat) -> &syn::Pat {
    match pattern {
        syn::Pat::Reference(reference) => without_reference(&reference.pat),
        syn::Pat::Type(typed) => without_reference(&typed.pat),
        other => other,
    }
}

fn name(pattern: &syn::Pat) -> Option<&syn::Ident> {
    match without_reference(pattern) {
        syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => Some(&name.ident),
        _ => None,
    }
}

/// Returns the value before the first term of a sum.
fn zero(ty: Type) -> Option<String> {
    match ty {
        Type::F32 => Some("0.0".to_owned()),
        Type::Vector(size) => Some(format!("Vec{size}::ZERO")),
        ty if ty.is_integer() => Some(format!("0_{}", ty.rust())),
        _ => None,
    }
}

/// Returns the value before the first factor of a product.
fn one(ty: Type) -> Option<String> {
    match ty {
        Type::F32 => Some("1.0".to_owned()),
        Type::Vector(size) => Some(format!("Vec{size}::ONE")),
        ty if ty.is_integer() => Some(format!("1_{}", ty.rust())),
        _ => None,
    }
}
