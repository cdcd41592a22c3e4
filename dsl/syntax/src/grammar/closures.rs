//! Closures and helper functions.
//!
//! Input: tokens from `|` or `fn`. Output: a [`RawFunction`] with parsed parameters and a syntax tree of syn as its body.
//! syn parses Rust; [`crate::check`] rejects the constructs that shaders do not have.

use fragbuf_model::{SourceSpan, Spanned, codes};
use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::spanned::Spanned as _;

use super::cursor::{Cursor, is_punct};
use super::recovery::{reject_alternatives, source_of_rest, starts_item};
use super::syntax_error::syntax_error;
use crate::raw_function::{FunctionTokens, RawFunction, RawParameter, Role};
use crate::report::{Report, Stop};
use crate::{names, token_limits};

/// Parses a closure and the `;` after it.
pub(super) fn closure(
    cursor: &mut Cursor,
    role: Role,
    function_tokens: &mut Vec<FunctionTokens>,
    report: &mut Report,
) -> Result<RawFunction, Stop> {
    let span = cursor.source_span(report);
    require_closure(cursor, &role, report)?;
    reject_bare_let(cursor, report)?;
    let tokens = closure_tokens(cursor);
    let end = cursor.span();
    let has_alternatives = cursor.at_keyword("else");
    if has_alternatives {
        let what = match role {
            Role::Resolve | Role::Between => "the effect is",
            Role::Image(_) => "the image is",
            Role::Criterion => "k and the criterion are",
            _ => "the constraint is",
        };
        let help = format!("{what} the same on all targets: remove `{}`", source_of_rest(cursor));
        reject_alternatives(cursor, "a closure", &help, report);
    }
    let closed = has_alternatives || cursor.take_punct(';');
    function_tokens.push(FunctionTokens { role: role.clone(), tokens: tokens.clone() });
    let (function, is_block) = parse_closure(&tokens, role, span, end, report)?;
    if !closed && !is_block {
        cursor.missing_semicolon("end the closure with `;`", report);
    }
    Ok(function)
}

/// Parses a closure from all of these tokens.
pub(crate) fn whole_closure(tokens: &TokenStream, role: Role, report: &mut Report) -> Result<RawFunction, Stop> {
    let mut cursor = Cursor::new(tokens.clone());
    require_closure(&cursor, &role, report)?;
    let span = cursor.source_span(report);
    let tokens = closure_tokens(&mut cursor);
    require_end(&cursor, "closure", report)?;
    parse_closure(&tokens, role, span, cursor.end(), report).map(|(function, _)| function)
}

/// Rejects tokens after a function. A block ends a closure, as in a file.
fn require_end(cursor: &Cursor, what: &str, report: &mut Report) -> Result<(), Stop> {
    if cursor.is_done() {
        return Ok(());
    }
    let message = format!("unexpected {} after the {what}", cursor.describe());
    report.error(
        codes::UNEXPECTED_TOKEN,
        &cursor.source_span(report),
        message,
        "remove it, or enclose the whole body in parentheses",
    );
    Err(Stop)
}

fn require_closure(cursor: &Cursor, role: &Role, report: &mut Report) -> Result<(), Stop> {
    if cursor.at_punct('|') {
        return Ok(());
    }
    let value = value_of_a_fragment(cursor);
    let help = match role {
        Role::Criterion => format!("write `least |f| {}`", value.as_deref().unwrap_or("f.depth")),
        Role::Resolve => "write `resolve |fragments| { … }`, or name an effect: `resolve: over;`".to_owned(),
        Role::Between => "write `between |front, back, gap| { … }`".to_owned(),
        Role::Image(name) => format!("write `image {name} |fragments| {{ … }}`"),
        _ => format!("write `where |f| {};`", value.as_deref().unwrap_or("f.depth > 0.5")),
    };
    Err(cursor.expected("a closure", help, report))
}

/// Returns the source of the expression up to the next `;`, if it reads a fragment `f`.
fn value_of_a_fragment(cursor: &Cursor) -> Option<String> {
    let is_end = |token: &&TokenTree| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ';');
    let tokens: TokenStream = cursor.rest().iter().take_while(|token| !is_end(token)).cloned().collect();
    let source = token_limits::compact(&token_limits::spaced(&tokens));
    let is_expression = syn::parse2::<syn::Expr>(tokens).is_ok();
    (is_expression && source.contains("f.") && source.chars().count() < 120).then_some(source)
}

/// Rejects statements without braces: `|f| let x = …; …`. Moves to the next item.
fn reject_bare_let(cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
    let after = cursor.after_parameters();
    if !matches!(after, Some(TokenTree::Ident(keyword)) if keyword == "let") {
        return Ok(());
    }
    let span = after.map_or_else(Span::call_site, TokenTree::span);
    let help = "enclose statements in braces: `|f| { let x = …; … }`";
    report.error(codes::UNEXPECTED_TOKEN, &report.at(span), "expected an expression, found `let`", help);
    while !cursor.is_done() && cursor.take().is_some() && !starts_item(cursor) {}
    Err(Stop)
}

/// Parses a closure; returns it, and whether its body is a block.
fn parse_closure(
    tokens: &TokenStream,
    role: Role,
    span: SourceSpan,
    end: Span,
    report: &mut Report,
) -> Result<(RawFunction, bool), Stop> {
    let parsed: syn::ExprClosure = parse(tokens, end, report)?;
    let is_block = matches!(*parsed.body, syn::Expr::Block(_));
    reject_closure_modifiers(&parsed, report);
    let output = match parsed.output {
        syn::ReturnType::Default => None,
        syn::ReturnType::Type(_, ty) => Some(*ty),
    };
    let count = parsed.inputs.len();
    let parameters: Vec<_> = parsed.inputs.into_iter().filter_map(|pattern| parameter(pattern, report)).collect();
    if parameters.len() < count {
        // The names of a pattern are not known.
        return Err(Stop);
    }
    let rust = token_limits::spaced(tokens);
    let name_span = span.clone();
    Ok((RawFunction { role, name_span, span, rust, parameters, output, body: *parsed.body }, is_block))
}

/// Takes the tokens of a closure: up to the `;`, the end of its block, or the start of the next item.
fn closure_tokens(cursor: &mut Cursor) -> TokenStream {
    let mut tokens: Vec<TokenTree> = Vec::new();
    let (mut bars, mut conditions) = (0, 0_usize);
    let mut body_from = 0;
    while !cursor.is_done() && !cursor.at_punct(';') {
        // `c ? a : b` of other languages has a colon that begins no item.
        conditions += usize::from(cursor.at_punct('?'));
        conditions = conditions.saturating_sub(usize::from(cursor.at_punct(':')));
        if bars >= 2 && conditions == 0 && (starts_item(cursor) || is_alternative(cursor, tokens.last())) {
            break;
        }
        let Some(token) = cursor.take() else { break };
        if is_punct(Some(&token), '|') && bars < 2 {
            bars += 1;
            body_from = tokens.len() + 1;
        }
        let is_block = matches!(&token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
        tokens.push(token);
        let before = tokens.get(body_from..tokens.len() - 1).unwrap_or_default();
        if is_block && bars == 2 && (before.is_empty() || is_punct(before.first(), '-') && is_punct(before.get(1), '>'))
        {
            break;
        }
    }
    tokens.into_iter().collect()
}

/// Whether the next token is an `else` that belongs to no `if`, as after a choice.
fn is_alternative(cursor: &Cursor, last: Option<&TokenTree>) -> bool {
    let is_block = matches!(last, Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace);
    cursor.at_keyword("else") && !is_block
}

/// Parses `fn name(…) -> … { … }`.
pub(super) fn helper(
    cursor: &mut Cursor,
    function_tokens: &mut Vec<FunctionTokens>,
    report: &mut Report,
) -> Result<RawFunction, Stop> {
    let span = cursor.source_span(report);
    let mut tokens: Vec<TokenTree> = Vec::new();
    while !cursor.is_done() && !cursor.at_punct(';') {
        let body = cursor.take_braces();
        let is_body = body.is_some();
        let Some(token) = body.map(TokenTree::from).or_else(|| cursor.take()) else { break };
        tokens.push(token);
        if is_body || (tokens.len() > 1 && starts_item(cursor)) {
            break;
        }
    }
    let end = match tokens.last() {
        Some(TokenTree::Group(group)) => group.span_close(),
        _ => cursor.span(),
    };
    cursor.take_punct(';');
    let tokens: TokenStream = tokens.into_iter().collect();
    function_tokens.push(FunctionTokens { role: Role::Helper(name_of(&tokens)), tokens: tokens.clone() });
    parse_helper(&tokens, span, end, report)
}

/// Parses a helper function from all of these tokens.
pub(crate) fn whole_helper(tokens: &TokenStream, report: &mut Report) -> Result<RawFunction, Stop> {
    let cursor = Cursor::new(tokens.clone());
    let span = cursor.source_span(report);
    if !cursor.at_keyword("fn") {
        return Err(cursor.expected("a function", "write `fn name(x: f32) -> f32 { … }`", report));
    }
    parse_helper(tokens, span, cursor.end(), report)
}

/// Returns the name after `fn`, or an empty string.
fn name_of(tokens: &TokenStream) -> String {
    match tokens.clone().into_iter().nth(1) {
        Some(TokenTree::Ident(name)) => name.unraw().to_string(),
        _ => String::new(),
    }
}

fn parse_helper(tokens: &TokenStream, span: SourceSpan, end: Span, report: &mut Report) -> Result<RawFunction, Stop> {
    let parsed: syn::ItemFn = parse(tokens, end, report)?;
    reject_signature(&parsed.sig, report);
    let name = names::declared(&names::written(&parsed.sig.ident, report), "function", report);
    reject_generated_name(&name, report);
    let output = match parsed.sig.output {
        syn::ReturnType::Default => None,
        syn::ReturnType::Type(_, ty) => Some(*ty),
    };
    let mut parameters = Vec::new();
    for input in parsed.sig.inputs {
        match input {
            syn::FnArg::Typed(typed) => parameters.extend(parameter(syn::Pat::Type(typed), report)),
            syn::FnArg::Receiver(receiver) => {
                let span = report.at(receiver.span());
                report.error(codes::UNSUPPORTED, &span, "`self` is not supported", "write a named parameter");
            }
        }
    }
    let body = syn::Expr::Block(syn::ExprBlock { attrs: Vec::new(), label: None, block: *parsed.block });
    let rust = token_limits::spaced(tokens);
    Ok(RawFunction { role: Role::Helper(name.value), span, name_span: name.span, rust, parameters, output, body })
}

/// Parses tokens with Rust's grammar. Messages point to `end` if the tokens end too early.
fn parse<T: syn::parse::Parse>(tokens: &TokenStream, end: Span, report: &mut Report) -> Result<T, Stop> {
    if let Some(span) = token_limits::too_long(tokens) {
        let message = format!("the statement has more than {} tokens", token_limits::LENGTH);
        report.error(codes::UNSUPPORTED, &report.at(span), message, "split it with `let`");
        return Err(Stop);
    }
    if let Some(span) = attribute(tokens) {
        reject_attribute(&report.at(span), report);
        return Err(Stop);
    }
    // The tokens are wrapped in parentheses, so that "unexpected end" has a span.
    let mut group = Group::new(Delimiter::Parenthesis, tokens.clone());
    group.set_span(end);
    let parser = |input: syn::parse::ParseStream| {
        let content;
        syn::parenthesized!(content in input);
        content.parse::<T>()
    };
    syn::parse::Parser::parse2(parser, TokenTree::from(group).into()).map_err(|error| {
        syntax_error(tokens, &error, report);
        Stop
    })
}

/// Reports an attribute `#[…]`.
pub(super) fn reject_attribute(span: &SourceSpan, report: &mut Report) {
    let help = "remove `#`: a comment begins with `//`, and shaders have no attributes like `#[…]`";
    report.error(codes::UNSUPPORTED, span, "attributes are not supported", help);
}

fn attribute(tokens: &TokenStream) -> Option<Span> {
    tokens.clone().into_iter().find_map(|token| match token {
        TokenTree::Punct(punct) if punct.as_char() == '#' => Some(punct.span()),
        TokenTree::Group(group) => attribute(&group.stream()),
        _ => None,
    })
}

fn parameter(pattern: syn::Pat, report: &mut Report) -> Option<RawParameter> {
    let span = report.at(pattern.span());
    let (pattern, ty) = match pattern {
        syn::Pat::Type(typed) => (*typed.pat, Some(*typed.ty)),
        other => (other, None),
    };
    match pattern {
        syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => Some(RawParameter {
            name: Some(names::declared(&names::written(&name.ident, report), "parameter", report)),
            mutable: name.mutability.is_some(),
            ty,
            span,
        }),
        syn::Pat::Wild(_) => Some(RawParameter { name: None, mutable: false, ty, span }),
        _ => {
            let help = "write a name, and use its fields: `f.depth`";
            report.error(codes::UNSUPPORTED, &span, "patterns in parameters are not supported", help);
            None
        }
    }
}

fn reject_closure_modifiers(closure: &syn::ExprClosure, report: &mut Report) {
    let spans = [
        closure.asyncness.map(|token| token.span()),
        closure.constness.map(|token| token.span()),
        closure.capture.map(|token| token.span()),
        closure.lifetimes.as_ref().map(|token| token.span()),
    ];
    for span in spans.into_iter().flatten() {
        let help = "write `|f| …` without this keyword";
        report.error(codes::UNSUPPORTED, &report.at(span), "closure modifiers are not supported", help);
    }
}

fn reject_signature(signature: &syn::Signature, report: &mut Report) {
    let unsafety = match &signature.safety {
        syn::Safety::Safe(keyword) => Some(keyword.span()),
        syn::Safety::Unsafe(keyword) => Some(keyword.span()),
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
        let help = "write `fn name(x: f32) -> f32 { … }` with concrete types, one function per type";
        report.error(codes::UNSUPPORTED, &report.at(span), "function modifiers and generics are not supported", help);
    }
}

fn reject_generated_name(name: &Spanned<String>, report: &mut Report) {
    let is_taken = ["criterion", "resolve", "between"].contains(&name.value.as_str())
        || ["admit_", "image_"].iter().any(|prefix| name.value.starts_with(prefix));
    if is_taken {
        let message = format!("the name `{}` is used by generated code", name.value);
        report.error(
            codes::NAME_RESERVED,
            &name.span,
            message,
            format!("choose another name, such as `my_{}`", name.value),
        );
    }
}
