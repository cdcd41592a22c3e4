//! The declarations of a WGSL text: name, extent with the comments and attributes above it, and the names it mentions.

use super::token::{Token, TokenKind, tokens};
use crate::program::Stage;

/// One declaration at module scope.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Item {
    pub(super) name: String,
    /// From the first comment or attribute above to the closing brace or semicolon.
    pub(super) text: String,
    /// Line of `text`'s first line in its source, from 1.
    pub(super) first_line: usize,
    /// Every name in it, members apart.
    pub(super) mentions: Vec<String>,
    /// For an entry point.
    pub(super) stage: Option<Stage>,
    /// One line: set next to its like, without a blank line between.
    pub(super) is_short: bool,
}

/// The declarations in order. `Err`: the line of something that is none.
pub(super) fn parse(text: &str) -> Result<Vec<Item>, usize> {
    let all = tokens(text);
    let code: Vec<Token<'_>> = all.iter().copied().filter(|token| token.kind != TokenKind::Comment).collect();
    let mut items = Vec::new();
    let mut at = 0;
    while at < code.len() {
        let length = item_length(&code[at..]).ok_or_else(|| line_of(text, code[at].at))?;
        let tokens = &code[at..at + length];
        let name = declared_name(tokens).ok_or_else(|| line_of(text, code[at].at))?;
        let last = tokens[length - 1];
        let start = with_comments(text, &all, tokens[0].at);
        let item_text = &text[start..last.at + last.text.len()];
        items.push(Item {
            name: name.to_owned(),
            text: item_text.to_owned(),
            first_line: line_of(text, start),
            mentions: mentions(tokens),
            stage: stage(tokens),
            is_short: !item_text.contains('\n'),
        });
        at += length;
    }
    Ok(items)
}

/// The comment at the top of a file that a blank line parts from the first declaration, with that blank line.
pub(crate) fn head(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let comments = lines.iter().take_while(|line| line.starts_with("//") && !line.starts_with("///")).count();
    let is_apart = lines.get(comments).is_some_and(|line| line.is_empty());
    if comments == 0 || !is_apart { String::new() } else { format!("{}\n\n", lines[..comments].join("\n")) }
}

/// Functions by name, with everything between the name and the body.
pub(crate) fn heads(text: &str) -> Vec<(String, String)> {
    parse(text)
        .unwrap_or_default()
        .into_iter()
        .filter_map(|item| {
            let start = item.text.find(&format!("fn {}(", item.name))?;
            let head = item.text[start + 3 + item.name.len()..].split(" {").next()?;
            Some((item.name, head.to_owned()))
        })
        .collect()
}

/// Everything that a text declares.
pub(crate) fn names(text: &str) -> Vec<String> {
    parse(text).unwrap_or_default().into_iter().map(|item| item.name).collect()
}

fn line_of(text: &str, at: usize) -> usize {
    text[..at].bytes().filter(|byte| *byte == b'\n').count() + 1
}

/// Up to the brace that closes the first one opened, or the semicolon before any.
fn item_length(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0usize;
    for (index, token) in tokens.iter().enumerate() {
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

fn declared_name<'a>(tokens: &[Token<'a>]) -> Option<&'a str> {
    let keyword = tokens.iter().position(|token| matches!(token.text, "fn" | "struct" | "const" | "var" | "alias" | "override"))?;
    let mut rest = tokens[keyword + 1..].iter();
    let mut next = rest.next()?;
    if next.text == "<" {
        while next.text != ">" {
            next = rest.next()?;
        }
        next = rest.next()?;
    }
    (next.kind == TokenKind::Name).then_some(next.text)
}

/// Where the comments begin that stand directly above `at`, line by line.
fn with_comments(text: &str, all: &[Token<'_>], at: usize) -> usize {
    let mut start = at;
    for token in all.iter().rev().filter(|token| token.at < at && token.kind == TokenKind::Comment) {
        let between = &text[token.at + token.text.len()..start];
        if !between.trim().is_empty() || between.matches('\n').count() != 1 {
            break;
        }
        start = token.at;
    }
    // A comment that opens the file and belongs to it as a whole is its head; one that touches the item is the item's.
    start
}

fn mentions(tokens: &[Token<'_>]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        let is_member = index > 0 && tokens[index - 1].text == ".";
        if token.kind == TokenKind::Name && !is_member && !names.iter().any(|name| name == token.text) {
            names.push(token.text.to_owned());
        }
    }
    names
}

fn stage(tokens: &[Token<'_>]) -> Option<Stage> {
    tokens.windows(2).take_while(|pair| pair[0].text != "fn").find_map(|pair| match (pair[0].text, pair[1].text) {
        ("@", "vertex") => Some(Stage::Vertex),
        ("@", "fragment") => Some(Stage::Fragment),
        ("@", "compute") => Some(Stage::Compute),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_carry_their_comments_and_attributes() {
        let text = "// Head of the file.\n\n// Of a.\n/// Doc.\n@group(0) @binding(1)\nvar<storage, read> a: array<u32>;\nconst B = 2u;\n";
        let items = parse(text).unwrap();
        let names: Vec<&str> = items.iter().map(|item| item.name.as_str()).collect();
        assert_eq!(names, ["a", "B"]);
        assert!(items[0].text.starts_with("// Of a.\n/// Doc.\n@group"));
        assert_eq!(items[0].first_line, 3);
        assert_eq!(head(text), "// Head of the file.\n\n");
    }

    #[test]
    fn members_are_no_mentions_and_heads_are_found() {
        let text = "fn f(a: u32) -> u32 {\n    return b.c;\n}\n";
        assert_eq!(parse(text).unwrap()[0].mentions, ["fn", "f", "a", "u32", "return", "b"]);
        assert_eq!(heads(text), [("f".to_owned(), "(a: u32) -> u32".to_owned())]);
        assert_eq!(parse("const A = 1u;\n}\n"), Err(2));
    }
}
