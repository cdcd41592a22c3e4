//! The item of a description at an offset, from the tokens before it: whether an axis, a value, a type or an expression is there.
//!
//! Input: a text, which may be incomplete, and an offset. Output: the word at the offset, and its place in the grammar.

use std::ops::Range;

use super::scan::{Kind, Token, closing, tokens};

/// A word, and its place in the grammar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Context {
    /// The word at the offset, empty between other tokens.
    pub word: Range<usize>,
    pub place: Place,
    /// The first byte of the item at the offset.
    pub item: usize,
    /// The last token before the word.
    pub before: String,
}

/// A place in the grammar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// No name is expected.
    Other,
    /// Before `buffer`.
    Start,
    /// The name of the buffer.
    Name,
    /// Behind the name of the buffer.
    From,
    Technique,
    /// The beginning of an item.
    Item,
    Value {
        axis: String,
    },
    /// Behind a value.
    Else,
    /// The path of a user file.
    File {
        axis: String,
    },
    OptionName {
        axis: String,
        value: String,
    },
    OptionValue {
        axis: String,
        value: String,
        option: String,
    },
    AttributeName,
    AttributeType,
    UniformName,
    UniformType,
    /// Behind `keep`.
    Count,
    /// Behind the number of `keep`.
    Least,
    /// In a function.
    Function,
}

/// Returns the context of an offset.
pub(super) fn context(text: &str, offset: usize) -> Context {
    let all = tokens(text);
    let at = all.iter().find(|token| match token.kind {
        Kind::Word | Kind::Number => token.start <= offset && offset <= token.end,
        Kind::Text => token.start < offset && offset < token.end,
        Kind::Comment => {
            token.start < offset && (offset < token.end || token.of(text).starts_with("//") && offset == token.end)
        }
        _ => false,
    });
    let word = match at {
        Some(token) if matches!(token.kind, Kind::Word | Kind::Number) => token.start..token.end,
        _ => offset..offset,
    };
    let limit = at.map_or(offset, |token| token.start);
    let before: Vec<Token> =
        all.iter().filter(|token| token.kind != Kind::Comment && token.end <= limit).copied().collect();
    let reader = Reader { text, tokens: &before };
    let (place, item) = match at.map(|token| token.kind) {
        Some(Kind::Comment) => (Place::Other, limit),
        Some(Kind::Text) => match reader.place(limit) {
            (Place::Other, item) => (reader.file(), item),
            other => (Place::Other, other.1),
        },
        _ => reader.place(limit),
    };
    Context { word, place, item, before: reader.last(0).to_owned() }
}

/// Returns the items of the buffer, each with its `;`.
pub(super) fn items(text: &str) -> Vec<Range<usize>> {
    let tokens: Vec<Token> = tokens(text).into_iter().filter(|token| token.kind != Kind::Comment).collect();
    let Some(buffer) = tokens.iter().position(|token| token.kind == Kind::Open) else { return Vec::new() };
    let end = closing(&tokens, buffer).unwrap_or(tokens.len());
    let reader = Reader { text, tokens: tokens.get(..end).unwrap_or_default() };
    let mut firsts = reader.firsts_of_items(buffer + 1);
    firsts.push(end);
    let range = |pair: &[usize]| {
        let (first, last) = (tokens.get(pair[0])?, tokens.get(pair[1].checked_sub(1)?)?);
        (pair[0] < pair[1]).then_some(first.start..last.end)
    };
    firsts.windows(2).filter_map(range).collect()
}

/// What has been read of an item.
struct ItemScan {
    first: usize,
    bars: usize,
    /// The first token behind the parameters of its closure.
    body: Option<usize>,
    /// The last bracket that is in no other.
    bracket: usize,
}

impl ItemScan {
    fn new(first: usize) -> Self {
        ItemScan { first, bars: 0, body: None, bracket: first }
    }
}

/// The tokens before a word, without comments.
struct Reader<'a> {
    text: &'a str,
    tokens: &'a [Token],
}

impl<'a> Reader<'a> {
    fn word(&self, index: usize) -> &'a str {
        self.tokens.get(index).map_or("", |token| token.of(self.text))
    }

    /// Returns the token that is `back` tokens before the last.
    fn last(&self, back: usize) -> &'a str {
        self.tokens.len().checked_sub(back + 1).map_or("", |index| self.word(index))
    }

    /// Returns the place behind the tokens, and the first byte of its item.
    fn place(&self, limit: usize) -> (Place, usize) {
        let mut open: Vec<usize> = Vec::new();
        for (index, token) in self.tokens.iter().enumerate() {
            match token.kind {
                Kind::Open => open.push(index),
                Kind::Close => drop(open.pop()),
                _ => {}
            }
        }
        let Some(buffer) = open.first() else { return (self.header(), limit) };
        let first = self.first_of_item(buffer + 1);
        let start = self.tokens.get(first).map_or(limit, |token| token.start);
        (self.in_item(first, open.get(1).copied()), start)
    }

    /// Returns the place before the braces of the buffer.
    fn header(&self) -> Place {
        match (self.last(2), self.last(1), self.last(0)) {
            (_, _, "buffer") => Place::Name,
            (_, _, "from") => Place::Technique,
            (_, "buffer", _) => Place::From,
            _ if self.tokens.is_empty() => Place::Start,
            _ => Place::Other,
        }
    }

    /// Returns the first token of the item behind which the tokens end; `from` is the first token of the first item.
    fn first_of_item(&self, from: usize) -> usize {
        self.firsts_of_items(from).last().copied().unwrap_or(from)
    }

    /// Returns the first token of each item, and the end of the tokens if an item ends there. Each token is read once.
    fn firsts_of_items(&self, from: usize) -> Vec<usize> {
        let (mut item, mut depth) = (ItemScan::new(from), 0_usize);
        let mut firsts = vec![from];
        for index in from..self.tokens.len() {
            let word = self.word(index);
            let is_end = match self.tokens.get(index).map(|token| token.kind) {
                Some(Kind::Open) => {
                    if depth == 0 {
                        item.bracket = index;
                    }
                    depth += 1;
                    false
                }
                Some(Kind::Close) => {
                    depth = depth.saturating_sub(1);
                    depth == 0 && word == "}" && self.is_end(&item)
                }
                _ => depth == 0 && word == ";",
            };
            if word == "|" {
                item.bars += 1;
                item.body = if item.bars == 2 { Some(index + 1) } else { item.body };
            }
            if is_end {
                item = ItemScan::new(index + 1);
                firsts.push(item.first);
            }
        }
        firsts
    }

    /// Whether an item ends with the `}` of its last bracket.
    fn is_end(&self, item: &ItemScan) -> bool {
        if self.word(item.first + 1) == ":" {
            return false;
        }
        match self.word(item.first) {
            // The closure is a block, or an expression with blocks.
            "where" | "keep" | "resolve" => {
                item.body.is_some_and(|body| body == item.bracket && self.word(body) == "{")
            }
            _ => true,
        }
    }

    /// Returns the place in an item. `inner`: the bracket of the item that is open.
    fn in_item(&self, first: usize, inner: Option<usize>) -> Place {
        let (head, count) = (self.word(first), self.tokens.len().saturating_sub(first));
        let is_choice = self.word(first + 1) == ":" && self.word(first + 2) != ":";
        match (head, inner) {
            _ if count == 0 => Place::Item,
            _ if is_choice => self.in_choice(head, inner),
            ("fragment", Some(_)) => self.in_block(Place::AttributeName, Place::AttributeType),
            ("uniform", Some(_)) => self.in_block(Place::UniformName, Place::UniformType),
            ("keep", None) if count == 1 => Place::Count,
            ("keep", None) if count == 2 => Place::Least,
            ("where" | "keep" | "resolve", _) => {
                let bars = (first..self.tokens.len()).filter(|at| self.word(*at) == "|").count();
                if bars > 1 { Place::Function } else { Place::Other }
            }
            ("fn", _) if count > 2 => Place::Function,
            _ => Place::Other,
        }
    }

    fn in_block(&self, name: Place, ty: Place) -> Place {
        match self.last(0) {
            "{" | "," => name,
            ":" => ty,
            _ => Place::Other,
        }
    }

    fn in_choice(&self, axis: &str, inner: Option<usize>) -> Place {
        let axis = axis.to_owned();
        match (inner, self.last(0)) {
            (None, ":" | "else") => Place::Value { axis },
            (None, _) => Place::Else,
            (Some(open), last) if self.word(open) == "{" => {
                let value = self.word(open.saturating_sub(1)).to_owned();
                match last {
                    "{" | "," => Place::OptionName { axis, value },
                    ":" => Place::OptionValue { axis, value, option: self.last(1).to_owned() },
                    _ => Place::Other,
                }
            }
            _ => Place::Other,
        }
    }

    /// Returns the place in a string.
    fn file(&self) -> Place {
        let is_file = self.last(0) == "(" && self.last(1) == "wgsl";
        let axis = self.tokens.len().checked_sub(3).and_then(|at| {
            let colon = (0..=at).rev().find(|index| self.word(*index) == ":")?;
            Some(self.word(colon.checked_sub(1)?).to_owned())
        });
        match axis {
            Some(axis) if is_file => Place::File { axis },
            _ => Place::Other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the place at the `|` that follows `@`.
    fn at(text: &str) -> (Place, String) {
        let offset = text.find('@').unwrap_or_default();
        let text = text.replace('@', "");
        let context = context(&text, offset);
        (context.place, text.get(context.word).unwrap_or_default().to_owned())
    }

    fn place(text: &str) -> Place {
        at(text).0
    }

    #[test]
    fn every_place_is_recognised() {
        let axis = || "sync".to_owned();
        assert_eq!(place("@"), Place::Start);
        assert_eq!(at("// c\nbuf@"), (Place::Start, "buf".to_owned()));
        assert_eq!(place("buffer @"), Place::Name);
        assert_eq!(place("buffer B @"), Place::From);
        assert_eq!(at("buffer B from kp@lus {}"), (Place::Technique, "kplus".to_owned()));
        assert_eq!(place("buffer B { @"), Place::Item);
        assert_eq!(place("buffer B { keep 8; so@ sync: none; }"), Place::Item);
        assert_eq!(place("buffer B { fragment { depth: f32 } @ }"), Place::Item);
        assert_eq!(place("buffer B { resolve |f| { f } @ }"), Place::Item);
        assert_eq!(place("buffer B { fn f(x: f32) -> f32 { x } @ }"), Place::Item);
        assert_eq!(place("buffer B { sync: @"), Place::Value { axis: axis() });
        assert_eq!(place("buffer B { sync: a else b@; }"), Place::Value { axis: axis() });
        assert_eq!(place("buffer B { sync: a { x: 1 } @"), Place::Else);
        assert_eq!(place("buffer B { sync: wgsl(\"a@\") }"), Place::File { axis: axis() });
        let value = "spin_lock".to_owned();
        assert_eq!(place("buffer B { sync: spin_lock { @"), Place::OptionName { axis: axis(), value: value.clone() });
        let option = "limit".to_owned();
        assert_eq!(
            place("buffer B { sync: spin_lock { limit: @ } }"),
            Place::OptionValue { axis: axis(), value, option }
        );
        assert_eq!(place("buffer B { fragment { color: rgba8, @ } }"), Place::AttributeName);
        assert_eq!(place("buffer B { fragment { color: r@ } }"), Place::AttributeType);
        assert_eq!(place("buffer B { uniform { cut: @ } }"), Place::UniformType);
        assert_eq!(place("buffer B { keep @"), Place::Count);
        assert_eq!(place("buffer B { keep 8 @"), Place::Least);
        assert_eq!(place("buffer B { keep 8 least |f| f.@"), Place::Function);
        assert_eq!(place("buffer B { where |f| if f.depth < 1.0 { true } else { f@"), Place::Function);
        assert_eq!(place("buffer B { resolve |f, u| { let x = @; x } }"), Place::Function);
        assert_eq!(place("buffer B { fn f(x: @"), Place::Function);
        assert_eq!(place("buffer B { // @\n }"), Place::Other);
        assert_eq!(place("buffer B {} @"), Place::Other);
    }
}
