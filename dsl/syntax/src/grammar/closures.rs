//! Closures and helper functions: from the item's tokens to Rust's syntax tree, parameters taken apart.
//!
//! In: tokens from `|` or `fn`. Out: a [`RawFunction`] whose body is syn's. Rust's grammar is syn's affair; what of it a
//! shader can have is [`crate::check`]'s.

use fragbuf_model::{Origin, Spanned, codes};
use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::spanned::Spanned as _;

use super::cursor::{Cursor, is_sign};
use super::items::begins_item;
use super::{Stop, names};
use crate::nesting;
use crate::report::Report;

/// What a function is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Role {
    /// Behind `least`: `|f, u| -> f32`.
    Criterion,
    /// The how-manieth `where`, from 0: `|f, u| -> bool`.
    Admit(usize),
    /// Behind `resolve`: `|fragments, u| -> Vec4`.
    Resolve,
    /// `fn` of this name.
    Helper(String),
}

impl Role {
    /// Its name in WGSL.
    pub(crate) fn wgsl_name(&self) -> String {
        match self {
            Role::Criterion => "user_criterion".to_string(),
            Role::Admit(index) => format!("user_admit_{index}"),
            Role::Resolve => "user_resolve".to_string(),
            Role::Helper(name) => format!("user_{name}"),
        }
    }

    /// What the user calls it.
    pub(crate) fn rust_name(&self) -> &str {
        match self {
            Role::Criterion => "least",
            Role::Admit(_) => "where",
            Role::Resolve => "resolve",
            Role::Helper(name) => name,
        }
    }
}

/// A function in the user's own tokens, documentation comments apart.
#[derive(Clone, Debug)]
pub struct Written {
    /// What it is for.
    pub role: Role,
    /// From `|`, or from `fn`, to its end.
    pub tokens: TokenStream,
}

/// A function as written, read as Rust.
pub(crate) struct RawFunction {
    pub role: Role,
    pub origin: Origin,
    /// The name of a helper, the `|` of a closure.
    pub name_origin: Origin,
    pub rust: String,
    pub parameters: Vec<RawParameter>,
    /// The type behind `->`, if any.
    pub output: Option<syn::Type>,
    pub body: syn::Expr,
}

/// A parameter as written.
pub(crate) struct RawParameter {
    /// Absent for `_`.
    pub name: Option<Spanned<String>>,
    pub mutable: bool,
    pub kind: Option<syn::Type>,
    pub origin: Origin,
}

/// The closure that belongs here, and the `;` behind it.
pub(crate) fn closure(
    cursor: &mut Cursor,
    role: Role,
    written: &mut Vec<Written>,
    report: &mut Report,
) -> Result<RawFunction, Stop> {
    let origin = cursor.origin(report);
    require_closure(cursor, &role, report)?;
    let tokens = closure_tokens(cursor);
    let end = cursor.span();
    let closed = cursor.sign(';');
    written.push(Written { role: role.clone(), tokens: tokens.clone() });
    let (function, is_block) = read_closure(&tokens, role, origin, end, report)?;
    if !closed && !is_block {
        let message = format!("`;` belongs here, not {}", cursor.describe());
        report.error(codes::UNEXPECTED, &report.at(end), message, "end the closure with `;`");
    }
    Ok(function)
}

/// The closure that these tokens are, all of them.
pub(crate) fn whole_closure(tokens: &TokenStream, role: Role, report: &mut Report) -> Result<RawFunction, Stop> {
    let mut cursor = Cursor::new(tokens.clone());
    require_closure(&cursor, &role, report)?;
    let origin = cursor.origin(report);
    let tokens = closure_tokens(&mut cursor);
    require_end(&cursor, "closure", report)?;
    read_closure(&tokens, role, origin, cursor.end(), report).map(|(function, _)| function)
}

/// A block ends a closure, as in a file: what stands behind it belongs to nothing.
fn require_end(cursor: &Cursor, what: &str, report: &mut Report) -> Result<(), Stop> {
    if cursor.is_done() {
        return Ok(());
    }
    let message = format!("{} stands after the {what}", cursor.describe());
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, "leave it out, or put the whole into parentheses");
    Err(Stop)
}

fn require_closure(cursor: &Cursor, role: &Role, report: &mut Report) -> Result<(), Stop> {
    if cursor.at_sign('|') {
        return Ok(());
    }
    let message = format!("a closure belongs here, not {}", cursor.describe());
    let hint = match role {
        Role::Criterion => "write `least |f| f.depth`",
        Role::Resolve => "write `resolve |fragments| { … }`, or name an effect: `resolve: over;`",
        _ => "write `where |f| f.depth > 0.5;`",
    };
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, hint);
    Err(Stop)
}

/// The function, and whether its body is a block.
fn read_closure(
    tokens: &TokenStream,
    role: Role,
    origin: Origin,
    end: Span,
    report: &mut Report,
) -> Result<(RawFunction, bool), Stop> {
    let parsed: syn::ExprClosure = read(tokens, end, report)?;
    let is_block = matches!(*parsed.body, syn::Expr::Block(_));
    refuse_closure_modifiers(&parsed, report);
    let output = match parsed.output {
        syn::ReturnType::Default => None,
        syn::ReturnType::Type(_, kind) => Some(*kind),
    };
    let parameters = parsed.inputs.into_iter().filter_map(|pattern| parameter(pattern, report)).collect();
    let rust = nesting::spaced(tokens);
    let name_origin = origin.clone();
    Ok((RawFunction { role, name_origin, origin, rust, parameters, output, body: *parsed.body }, is_block))
}

/// The tokens of a closure: to the `;`, to the end of its block, or to where the next item can only begin.
fn closure_tokens(cursor: &mut Cursor) -> TokenStream {
    let mut tokens: Vec<TokenTree> = Vec::new();
    let mut bars = 0;
    let mut body_from = 0;
    while !cursor.is_done() && !cursor.at_sign(';') {
        if bars >= 2 && begins_item(cursor) {
            break;
        }
        let Some(token) = cursor.take() else { break };
        if is_sign(Some(&token), '|') && bars < 2 {
            bars += 1;
            body_from = tokens.len() + 1;
        }
        let is_block = matches!(&token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
        tokens.push(token);
        let before = tokens.get(body_from..tokens.len() - 1).unwrap_or_default();
        if is_block && bars == 2 && (before.is_empty() || is_sign(before.first(), '-') && is_sign(before.get(1), '>')) {
            break;
        }
    }
    tokens.into_iter().collect()
}

/// `fn name(…) -> … { … }`
pub(crate) fn helper(
    cursor: &mut Cursor,
    written: &mut Vec<Written>,
    report: &mut Report,
) -> Result<RawFunction, Stop> {
    let origin = cursor.origin(report);
    let mut tokens: Vec<TokenTree> = Vec::new();
    while !cursor.is_done() && !cursor.at_sign(';') {
        let body = cursor.braces();
        let is_body = body.is_some();
        let Some(token) = body.map(TokenTree::from).or_else(|| cursor.take()) else { break };
        tokens.push(token);
        if is_body || (tokens.len() > 1 && begins_item(cursor)) {
            break;
        }
    }
    let end = match tokens.last() {
        Some(TokenTree::Group(group)) => group.span_close(),
        _ => cursor.span(),
    };
    cursor.sign(';');
    let tokens: TokenStream = tokens.into_iter().collect();
    written.push(Written { role: Role::Helper(name_of(&tokens)), tokens: tokens.clone() });
    read_helper(&tokens, origin, end, report)
}

/// The helper function that these tokens are, all of them.
pub(crate) fn whole_helper(tokens: &TokenStream, report: &mut Report) -> Result<RawFunction, Stop> {
    let cursor = Cursor::new(tokens.clone());
    let origin = cursor.origin(report);
    if !cursor.at_word("fn") {
        let message = format!("a function belongs here, not {}", cursor.describe());
        report.error(codes::UNEXPECTED, &origin, message, "write `fn name(x: f32) -> f32 { … }`");
        return Err(Stop);
    }
    read_helper(tokens, origin, cursor.end(), report)
}

/// The word after `fn`.
fn name_of(tokens: &TokenStream) -> String {
    match tokens.clone().into_iter().nth(1) {
        Some(TokenTree::Ident(name)) => name.unraw().to_string(),
        _ => String::new(),
    }
}

fn read_helper(tokens: &TokenStream, origin: Origin, end: Span, report: &mut Report) -> Result<RawFunction, Stop> {
    let parsed: syn::ItemFn = read(tokens, end, report)?;
    refuse_signature(&parsed.sig, report);
    let name = names::declared(&names::written(&parsed.sig.ident, report), "function", report);
    refuse_generated_name(&name, report);
    let output = match parsed.sig.output {
        syn::ReturnType::Default => None,
        syn::ReturnType::Type(_, kind) => Some(*kind),
    };
    let mut parameters = Vec::new();
    for input in parsed.sig.inputs {
        match input {
            syn::FnArg::Typed(typed) => parameters.extend(parameter(syn::Pat::Type(typed), report)),
            syn::FnArg::Receiver(receiver) => {
                let place = report.at(receiver.span());
                report.error(codes::UNSUPPORTED, &place, "`self` has no meaning here", "take what is needed by name");
            }
        }
    }
    let body = syn::Expr::Block(syn::ExprBlock { attrs: Vec::new(), label: None, block: *parsed.block });
    let rust = nesting::spaced(tokens);
    Ok(RawFunction { role: Role::Helper(name.value), origin, name_origin: name.origin, rust, parameters, output, body })
}

/// What these tokens are in Rust's grammar. `end` is where a message points when they end too soon.
fn read<T: syn::parse::Parse>(tokens: &TokenStream, end: Span, report: &mut Report) -> Result<T, Stop> {
    if let Some(span) = nesting::too_long(tokens) {
        let message = "the statement is too long to be read";
        report.error(codes::UNSUPPORTED, &report.at(span), message, "name its parts with `let`");
        return Err(Stop);
    }
    if let Some(span) = attribute(tokens) {
        let hint = "leave it out; what it would switch has no counterpart in a shader";
        report.error(codes::UNSUPPORTED, &report.at(span), "attributes are not part of the language", hint);
        return Err(Stop);
    }
    // In brackets of our own, so that "unexpected end" has a place.
    let mut group = Group::new(Delimiter::Parenthesis, tokens.clone());
    group.set_span(end);
    let parser = |input: syn::parse::ParseStream| {
        let content;
        syn::parenthesized!(content in input);
        content.parse::<T>()
    };
    syn::parse::Parser::parse2(parser, TokenTree::from(group).into()).map_err(|error| {
        let message = format!("this does not read as Rust: {error}");
        let hint = syntax_hint(&error.to_string());
        report.error(codes::UNEXPECTED, &report.at(error.span()), message, hint);
        Stop
    })
}

fn syntax_hint(message: &str) -> &'static str {
    if message.contains("expected `;`") {
        "statements end with `;`"
    } else if message.contains("unexpected end of input") {
        "something is missing before this place"
    } else {
        "closures and functions are written as in Rust: look at this token and the one before it"
    }
}

fn attribute(tokens: &TokenStream) -> Option<Span> {
    tokens.clone().into_iter().find_map(|token| match token {
        TokenTree::Punct(punct) if punct.as_char() == '#' => Some(punct.span()),
        TokenTree::Group(group) => attribute(&group.stream()),
        _ => None,
    })
}

fn parameter(pattern: syn::Pat, report: &mut Report) -> Option<RawParameter> {
    let origin = report.at(pattern.span());
    let (pattern, kind) = match pattern {
        syn::Pat::Type(typed) => (*typed.pat, Some(*typed.ty)),
        other => (other, None),
    };
    match pattern {
        syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => Some(RawParameter {
            name: Some(names::declared(&names::written(&name.ident, report), "parameter", report)),
            mutable: name.mutability.is_some(),
            kind,
            origin,
        }),
        syn::Pat::Wild(_) => Some(RawParameter { name: None, mutable: false, kind, origin }),
        _ => {
            let hint = "write a name, and take it apart inside: `f.depth`";
            report.error(codes::UNSUPPORTED, &origin, "a parameter here is a plain name", hint);
            None
        }
    }
}

fn refuse_closure_modifiers(closure: &syn::ExprClosure, report: &mut Report) {
    let spans = [
        closure.asyncness.map(|token| token.span()),
        closure.constness.map(|token| token.span()),
        closure.capture.map(|token| token.span()),
        closure.lifetimes.as_ref().map(|token| token.span()),
    ];
    for span in spans.into_iter().flatten() {
        report.error(
            codes::UNSUPPORTED,
            &report.at(span),
            "a closure here is plain",
            "write `|f| …` without this word",
        );
    }
}

fn refuse_signature(signature: &syn::Signature, report: &mut Report) {
    let unsafety = match &signature.safety {
        syn::Safety::Safe(word) => Some(word.span()),
        syn::Safety::Unsafe(word) => Some(word.span()),
        syn::Safety::Default => None,
    };
    let mut spans = vec![
        unsafety,
        signature.constness.map(|token| token.span()),
        signature.asyncness.map(|token| token.span()),
        signature.abi.as_ref().map(|token| token.span()),
        signature.variadic.as_ref().map(|token| token.span()),
    ];
    if !signature.generics.params.is_empty() {
        spans.push(Some(signature.generics.params.span()));
    }
    spans.push(signature.generics.where_clause.as_ref().map(|clause| clause.span()));
    for span in spans.into_iter().flatten() {
        let hint = "write `fn name(x: f32) -> f32 { … }` with plain types, one function per type";
        report.error(codes::UNSUPPORTED, &report.at(span), "a helper function here is plain", hint);
    }
}

fn refuse_generated_name(name: &Spanned<String>, report: &mut Report) {
    let taken = name.value == "criterion" || name.value == "resolve" || name.value.starts_with("admit_");
    if taken {
        let message = format!("`{}` names a function of generated code", name.value);
        report.error(codes::NAME_RESERVED, &name.origin, message, format!("choose another: `my_{}`", name.value));
    }
}
