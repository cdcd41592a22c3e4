//! Splits a WGSL source into declarations: the name, the text with the comments and attributes above it, and the names that it mentions.

use super::fold::{Substitute, has_effects, substitute};
use super::index::Index;
use super::token::{Token, TokenKind, tokens};
use crate::entry_point::Stage;

/// A declaration at module scope.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Item<'a> {
    pub(crate) name: &'a str,
    /// From the first comment or attribute above to the closing brace or semicolon.
    pub(crate) text: &'a str,
    /// The line of the start of `text` in its source, from 1.
    pub(crate) first_line: usize,
    /// The line of the name, from 1.
    pub(crate) declared_line: usize,
    /// Every name in it except members.
    pub(crate) mentions: Vec<&'a str>,
    /// The stage of an entry point.
    pub(crate) stage: Option<Stage>,
    /// Whether it has a binding.
    pub(crate) is_bound: bool,
    /// Whether it is a single line. No blank line is written between single lines.
    pub(crate) is_short: bool,
    pub(super) is_function: bool,
    pub(super) is_variable: bool,
    /// The replacement of its uses.
    pub(super) substitute: Substitute,
    /// Whether it is a function that compares a constant with a number or another constant.
    pub(super) compares_constants: bool,
    /// Whether it is a function with side effects, ignoring those of the functions that it calls.
    pub(super) has_effects: bool,
    /// Whether it is a `var<private>` of an array without an initial value.
    pub(super) is_private_array: bool,
}

/// Parses the declarations in order. Fails with the line of the first text that is not a declaration.
pub(crate) fn parse(text: &str) -> Result<Vec<Item<'_>>, usize> {
    let (code, comments) = tokens(text);
    let (mut items, mut names) = (Vec::new(), Names::for_tokens(code.len()));
    let (mut rest, mut line, mut counted) = (code.as_slice(), 1, 0);
    while let Some(first) = rest.first() {
        let length = item_length(rest).ok_or_else(|| line_of(text, first.at))?;
        let (tokens, after) = rest.split_at(length);
        let keyword = tokens.iter().position(is_keyword).ok_or_else(|| line_of(text, first.at))?;
        let declared = declared_name(&tokens[keyword + 1..]).ok_or_else(|| line_of(text, first.at))?;
        let end = tokens.last().map_or(first.at, |last| last.at + last.text.len());
        let start = with_comments(text, &comments, first.at);
        line += newlines(&text[counted..start]);
        counted = start;
        let attributes = &tokens[..keyword];
        let is_function = tokens[keyword].text == "fn";
        items.push(Item {
            name: declared.text,
            text: &text[start..end],
            first_line: line,
            declared_line: line + newlines(&text[start..declared.at]),
            mentions: names.of(tokens),
            stage: stage(attributes),
            is_bound: attributes.windows(2).any(|pair| (pair[0].text, pair[1].text) == ("@", "binding")),
            is_short: !text[start..end].contains('\n'),
            is_function,
            is_variable: tokens[keyword].text == "var",
            substitute: substitute(tokens),
            compares_constants: is_function && compares_constants(tokens),
            has_effects: is_function && has_effects(tokens),
            is_private_array: is_private_array(tokens),
        });
        rest = after;
    }
    Ok(items)
}

/// Returns the header of a file: the comment at its top, if a blank line follows, with the blank line.
pub(crate) fn file_header(text: &str) -> String {
    let mut length = 0;
    for line in text.split_inclusive('\n') {
        if !line.starts_with("//") || line.starts_with("///") {
            let is_separate = length > 0 && line == "\n";
            return if is_separate { text[..length + 1].to_owned() } else { String::new() };
        }
        length += line.len();
    }
    String::new()
}

/// Returns the first paragraph of a header, and a blank line.
pub(super) fn first_paragraph(header: &str) -> String {
    match header.split_once("\n//\n") {
        Some((first, _)) => format!("{first}\n\n"),
        None => header.to_owned(),
    }
}

/// The name of a function, and its parameters and result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FunctionSignature<'a> {
    pub(crate) name: &'a str,
    /// `(a: u32) -> u32`, as written.
    pub(crate) signature: &'a str,
    /// The byte offset of the name.
    pub(crate) offset: usize,
}

/// Returns the signatures of all functions, in order.
pub(crate) fn signatures(text: &str) -> Vec<FunctionSignature<'_>> {
    let (code, _) = tokens(text);
    let mut signatures = Vec::new();
    for (index, pair) in code.windows(2).enumerate() {
        let [keyword, name] = pair else { continue };
        if keyword.text != "fn" || name.kind != TokenKind::Name {
            continue;
        }
        let rest = code[index + 2..].iter().take_while(|token| token.text != "{");
        let start = name.at + name.text.len();
        let end = rest.last().map_or(start, |last| last.at + last.text.len());
        signatures.push(FunctionSignature { name: name.text, signature: &text[start..end], offset: name.at });
    }
    signatures
}

/// Returns the types of a signature without the names of its parameters: `(u32,u32)->Packed`.
pub(crate) fn types(signature: &str) -> String {
    let (code, _) = tokens(signature);
    let is_name = |index: usize| code.get(index + 1).is_some_and(|next: &Token<'_>| next.text == ":");
    let kept = code.iter().enumerate().filter(|(index, token)| {
        let ends_list = token.text == "," && code.get(index + 1).is_some_and(|next| next.text == ")");
        token.text != ":" && !ends_list && !is_name(*index)
    });
    kept.map(|(_, token)| token.text).collect()
}

/// Returns the names of the parameters of a signature, in order.
pub(crate) fn parameter_names(signature: &str) -> Vec<&str> {
    let (code, _) = tokens(signature);
    let named = code
        .windows(2)
        .filter(|pair| matches!(pair, [name, colon] if colon.text == ":" && name.kind == TokenKind::Name));
    named.filter_map(|pair| pair.first().map(|name| name.text)).collect()
}

/// Returns the names of all declarations of a source.
pub(crate) fn names(text: &str) -> Vec<String> {
    parse(text).unwrap_or_default().into_iter().map(|item| item.name.to_owned()).collect()
}

fn line_of(text: &str, at: usize) -> usize {
    newlines(&text[..at]) + 1
}

fn newlines(text: &str) -> usize {
    text.bytes().filter(|byte| *byte == b'\n').count()
}

/// Returns the number of tokens up to the brace that closes the first open brace, or up to a semicolon before any brace.
fn item_length(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0usize;
    for (index, token) in tokens.iter().enumerate().filter(|(_, token)| token.kind == TokenKind::Sign) {
        match token.text {
            "{" => depth += 1,
            "}" => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    let semicolon = tokens.get(index + 1).is_some_and(|next| next.text == ";");
                    return Some(index + 1 + usize::from(semicolon));
                }
            }
            ";" if depth == 0 => return Some(index + 1),
            _ => {}
        }
    }
    None
}

fn is_keyword(token: &Token<'_>) -> bool {
    matches!(token.text, "fn" | "struct" | "const" | "var" | "alias" | "override")
}

/// Returns the name after a keyword.
fn declared_name<'a>(tokens: &[Token<'a>]) -> Option<Token<'a>> {
    let mut rest = tokens.iter();
    let mut next = rest.next()?;
    if next.text == "<" {
        while next.text != ">" {
            next = rest.next()?;
        }
        next = rest.next()?;
    }
    (next.kind == TokenKind::Name).then_some(*next)
}

/// Returns the start of the line comments directly above `at`.
fn with_comments(text: &str, comments: &[Token<'_>], at: usize) -> usize {
    let before = comments.partition_point(|comment| comment.at < at);
    let mut start = at;
    for token in comments[..before].iter().rev() {
        let between = &text[token.at + token.text.len()..start];
        if !between.trim().is_empty() || newlines(between) != 1 {
            break;
        }
        start = token.at;
    }
    start
}

/// Tests whether tokens compare the name of a constant with another such name or a number.
fn compares_constants(tokens: &[Token<'_>]) -> bool {
    let is_constant = |token: &Token<'_>| !token.text.bytes().any(|byte| byte.is_ascii_lowercase());
    let is_named = |token: &Token<'_>| token.kind == TokenKind::Name && is_constant(token);
    let is_operand = |token: &Token<'_>| token.kind == TokenKind::Number || is_named(token);
    let is_sign = |index: usize| matches!(tokens[index].text, "<" | ">" | "=" | "!");
    (1..tokens.len().saturating_sub(2)).any(|index| {
        let (left, right) = (&tokens[index - 1], &tokens[index + 1 + usize::from(is_sign(index + 1))]);
        is_sign(index) && is_operand(left) && is_operand(right) && (is_named(left) || is_named(right))
    })
}

fn is_private_array(tokens: &[Token<'_>]) -> bool {
    let is_at = |index: usize, text: &str| tokens.get(index).is_some_and(|token| token.text == text);
    let is_private = ["var", "<", "private", ">"].iter().enumerate().all(|(index, text)| is_at(index, text));
    is_private && is_at(6, "array") && !tokens.iter().any(|token| token.text == "=")
}

/// Returns every name in a source except members, once each and in order.
pub(super) fn mentions<'a>(tokens: &[Token<'a>]) -> Vec<&'a str> {
    Names::for_tokens(tokens.len()).of(tokens)
}

/// Names, each with the number of the last declaration that mentions it. One table serves a whole file.
struct Names<'a> {
    last: Index<'a>,
    declaration: usize,
}

impl<'a> Names<'a> {
    /// Creates a table with capacity for the names that `count` tokens usually contain.
    fn for_tokens(count: usize) -> Self {
        Names { last: Index::with_capacity_and_hasher(count / 6, Default::default()), declaration: 0 }
    }

    fn of(&mut self, tokens: &[Token<'a>]) -> Vec<&'a str> {
        self.declaration += 1;
        let mut names = Vec::new();
        let mut is_member = false;
        for token in tokens {
            let is_name = token.kind == TokenKind::Name && !is_member;
            if is_name && self.last.insert(token.text, self.declaration) != Some(self.declaration) {
                names.push(token.text);
            }
            is_member = token.text == ".";
        }
        names.sort_unstable();
        names
    }
}

fn stage(attributes: &[Token<'_>]) -> Option<Stage> {
    attributes.windows(2).find_map(|pair| match (pair[0].text, pair[1].text) {
        ("@", "vertex") => Some(Stage::Vertex),
        ("@", "fragment") => Some(Stage::Fragment),
        ("@", "compute") => Some(Stage::Compute),
        _ => None,
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn items_include_their_comments_and_attributes() {
        let text = "// Header of the file.\n\n// Of a.\n/// Doc.\n@group(0) @binding(1)\nvar<storage, read> a: array<u32>;\nconst B = 2u;\n";
        let items = parse(text).unwrap();
        let names: Vec<&str> = items.iter().map(|item| item.name).collect();
        assert_eq!(names, ["a", "B"]);
        assert!(items[0].text.starts_with("// Of a.\n/// Doc.\n@group"));
        assert_eq!(items[0].first_line, 3);
        assert_eq!(file_header(text), "// Header of the file.\n\n");
    }

    #[test]
    fn members_are_not_mentions_and_signatures_are_found() {
        let text = "fn f(a: u32) -> u32 {\n    return b.c;\n}\n";
        assert_eq!(parse(text).unwrap()[0].mentions, ["a", "b", "f", "fn", "return", "u32"]);
        assert_eq!(signatures(text), [FunctionSignature { name: "f", signature: "(a: u32) -> u32", offset: 3 }]);
        assert_eq!(types("( b : u32, ) -> u32"), types("(a: u32) -> u32"));
        assert_ne!(types("(a: u32, b: u32)"), types("(a: u32)"));
        assert_eq!(parse("const A = 1u;\n}\n"), Err(2));
    }
}
