//! The declarations of a WGSL text: name, extent with the comments and attributes above it, and the names it mentions.

use super::token::{Token, TokenKind, tokens};
use crate::program::Stage;

/// One declaration at module scope.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Item<'a> {
    pub(super) name: &'a str,
    /// From the first comment or attribute above to the closing brace or semicolon.
    pub(super) text: &'a str,
    /// Line of `text`'s first line in its source, from 1.
    pub(super) first_line: usize,
    /// Every name in it, members apart.
    pub(super) mentions: Vec<&'a str>,
    /// For an entry point.
    pub(super) stage: Option<Stage>,
    /// One line: set next to its like, without a blank line between.
    pub(super) is_short: bool,
}

/// The declarations in order. `Err`: the line of something that is none.
pub(super) fn parse(text: &str) -> Result<Vec<Item<'_>>, usize> {
    let (code, comments) = tokens(text);
    let mut items = Vec::new();
    let (mut rest, mut line, mut counted) = (code.as_slice(), 1, 0);
    while let Some(first) = rest.first() {
        let length = item_length(rest).ok_or_else(|| line_of(text, first.at))?;
        let (tokens, after) = rest.split_at(length);
        let name = declared_name(tokens).ok_or_else(|| line_of(text, first.at))?;
        let end = tokens.last().map_or(first.at, |last| last.at + last.text.len());
        let start = with_comments(text, &comments, first.at);
        line += newlines(&text[counted..start]);
        counted = start;
        items.push(Item {
            name,
            text: &text[start..end],
            first_line: line,
            mentions: mentions(tokens),
            stage: stage(tokens),
            is_short: !text[start..end].contains('\n'),
        });
        rest = after;
    }
    Ok(items)
}

/// The comment at the top of a file that a blank line parts from the first declaration, with that blank line.
pub(crate) fn head(text: &str) -> String {
    let mut length = 0;
    for line in text.split_inclusive('\n') {
        if !line.starts_with("//") || line.starts_with("///") {
            let is_apart = length > 0 && line == "\n";
            return if is_apart { text[..length + 1].to_owned() } else { String::new() };
        }
        length += line.len();
    }
    String::new()
}

/// Functions by name, with everything between the name and the body.
pub(crate) fn heads(text: &str) -> Vec<(String, String)> {
    parse(text)
        .unwrap_or_default()
        .into_iter()
        .filter_map(|item| {
            let start = item.text.find(&format!("fn {}(", item.name))?;
            let head = item.text[start + 3 + item.name.len()..].split(" {").next()?;
            Some((item.name.to_owned(), head.to_owned()))
        })
        .collect()
}

/// Everything that a text declares.
pub(crate) fn names(text: &str) -> Vec<String> {
    parse(text).unwrap_or_default().into_iter().map(|item| item.name.to_owned()).collect()
}

fn line_of(text: &str, at: usize) -> usize {
    newlines(&text[..at]) + 1
}

fn newlines(text: &str) -> usize {
    text.bytes().filter(|byte| *byte == b'\n').count()
}

/// Up to the brace that closes the first one opened, or the semicolon before any.
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

fn declared_name<'a>(tokens: &[Token<'a>]) -> Option<&'a str> {
    let keyword = tokens
        .iter()
        .position(|token| matches!(token.text, "fn" | "struct" | "const" | "var" | "alias" | "override"))?;
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

fn mentions<'a>(tokens: &[Token<'a>]) -> Vec<&'a str> {
    let names = tokens.iter().enumerate().filter(|(index, token)| {
        let is_member = *index > 0 && tokens[index - 1].text == ".";
        token.kind == TokenKind::Name && !is_member
    });
    let mut names: Vec<&str> = names.map(|(_, token)| token.text).collect();
    names.sort_unstable();
    names.dedup();
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
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn items_carry_their_comments_and_attributes() {
        let text = "// Head of the file.\n\n// Of a.\n/// Doc.\n@group(0) @binding(1)\nvar<storage, read> a: array<u32>;\nconst B = 2u;\n";
        let items = parse(text).unwrap();
        let names: Vec<&str> = items.iter().map(|item| item.name).collect();
        assert_eq!(names, ["a", "B"]);
        assert!(items[0].text.starts_with("// Of a.\n/// Doc.\n@group"));
        assert_eq!(items[0].first_line, 3);
        assert_eq!(head(text), "// Head of the file.\n\n");
    }

    #[test]
    fn members_are_no_mentions_and_heads_are_found() {
        let text = "fn f(a: u32) -> u32 {\n    return b.c;\n}\n";
        assert_eq!(parse(text).unwrap()[0].mentions, ["a", "b", "f", "fn", "return", "u32"]);
        assert_eq!(heads(text), [("f".to_owned(), "(a: u32) -> u32".to_owned())]);
        assert_eq!(parse("const A = 1u;\n}\n"), Err(2));
    }
}
