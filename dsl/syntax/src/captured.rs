//! Tokens that a macro keeps for the running program: their text, and where each stood in the user's file.
//!
//! In: tokens with their places, while the user's crate is compiled. Out: at run time, the same tokens at the same
//! places. The text has one word a line, so a token's line in it is its index in the list of places. Nothing here knows
//! what the tokens mean.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::str::FromStr;
use std::sync::Arc;

use fragbuf_model::{Diagnostic, Draft, Origin, Spanned};
use proc_macro2::{Delimiter, LineColumn, Spacing, Span, TokenStream, TokenTree};

use crate::{Parsed, parse_tokens, text};

/// Tokens of a description, or of one function of it, with their places.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Captured {
    file: Cow<'static, str>,
    text: Cow<'static, str>,
    places: Places,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Places {
    /// One for each line of the text: `line:column`, or `column` alone on the line of the one before.
    Words(Cow<'static, str>),
    /// The same for every token.
    One(Origin),
}

impl Captured {
    /// What [`Captured::of`] kept: the three parts as a macro prints them.
    pub const fn new(file: &'static str, text: &'static str, places: &'static str) -> Self {
        let places = Places::Words(Cow::Borrowed(places));
        Captured { file: Cow::Borrowed(file), text: Cow::Borrowed(text), places }
    }

    /// Text made by a program; every mistake in it stands at `origin`, where the program hands it over.
    pub fn made(text: impl Into<String>, origin: &Origin) -> Self {
        let file = Cow::Owned(origin.file.to_string());
        Captured { file, text: Cow::Owned(text.into()), places: Places::One(origin.clone()) }
    }

    /// Keeps these tokens; `place` says where each stands. All are taken to stand in the first one's file.
    pub fn of(tokens: &TokenStream, place: &dyn Fn(Span) -> Origin) -> Self {
        let first = tokens.clone().into_iter().next().map_or_else(Span::call_site, |token| token.span());
        let file = place(first).file.to_string();
        let mut writer = Writer { place, text: String::new(), places: String::new(), line: 0, joint: false };
        writer.tokens(tokens);
        let places = Places::Words(Cow::Owned(writer.places));
        Captured { file: Cow::Owned(file), text: Cow::Owned(writer.text), places }
    }

    /// The three parts that [`Captured::new`] takes: file, text, places.
    pub fn parts(&self) -> (&str, &str, &str) {
        match &self.places {
            Places::Words(places) => (&self.file, &self.text, places),
            Places::One(_) => (&self.file, &self.text, ""),
        }
    }

    /// The description that these tokens are.
    pub fn parse(&self) -> Parsed {
        let place = self.place();
        match self.tokens() {
            Ok(tokens) => parse_tokens(tokens, &place),
            Err(unreadable) => Parsed { draft: None, diagnostics: (*unreadable).into() },
        }
    }

    /// The draft of a description that a macro has read without a mistake; an empty one if these tokens are none.
    pub fn draft(&self) -> Draft {
        let origin = Origin::new(&*self.file, 1, 1);
        self.parse().draft.unwrap_or_else(|| Draft::empty(Spanned::new("Unnamed".to_owned(), origin)))
    }

    /// The tokens again; text made by a program may be none.
    pub(crate) fn tokens(&self) -> Result<TokenStream, Box<Diagnostic>> {
        match &self.places {
            Places::Words(_) => TokenStream::from_str(&self.text)
                .map_err(|_| Box::new(text::unreadable(&Origin::new(&*self.file, 1, 1), None))),
            Places::One(origin) => text::tokens(&self.text, &self.file).map_err(|mut unreadable| {
                unreadable.origin = origin.clone();
                unreadable.labels.clear();
                unreadable
            }),
        }
    }

    /// The way from a span of [`Captured::tokens`] to the user's place.
    pub(crate) fn place(&self) -> impl Fn(Span) -> Origin + use<> {
        let file: Arc<str> = (&*self.file).into();
        let words = match &self.places {
            Places::Words(places) => Words::Each(words(&self.text, places)),
            Places::One(origin) => Words::One(origin.clone()),
        };
        move |span: Span| match &words {
            Words::One(origin) => origin.clone(),
            Words::Each(words) => origin(words, &file, span.start(), span.end()),
        }
    }
}

enum Words {
    Each(Vec<Word>),
    One(Origin),
}

/// One line of the text: where it stood, and how long it is.
struct Word {
    line: u32,
    column: u32,
    length: u32,
}

fn words(text: &str, places: &str) -> Vec<Word> {
    let mut line = 1;
    let mut words = Vec::new();
    for (word, place) in text.lines().zip(places.split(' ')) {
        let column = match place.split_once(':') {
            Some((given, column)) => {
                line = given.parse().unwrap_or(line);
                column
            }
            None => place,
        };
        let length = u32::try_from(word.chars().count()).unwrap_or(u32::MAX);
        words.push(Word { line, column: column.parse().unwrap_or(1), length });
    }
    words
}

fn origin(words: &[Word], file: &Arc<str>, start: LineColumn, end: LineColumn) -> Origin {
    let number = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
    let first = start.line.saturating_sub(1);
    let Some(word) = words.get(first) else { return Origin::new(file.clone(), 1, 1) };
    let column = word.column.saturating_add(number(start.column));
    let last = words.get(end.line.saturating_sub(1)).filter(|last| last.line == word.line);
    let stop = match last {
        Some(last) => last.column.saturating_add(number(end.column)),
        // Beyond the line: as far as the words of this line go.
        None => words
            .iter()
            .skip(first)
            .take_while(|other| other.line == word.line)
            .map(|other| other.column.saturating_add(other.length))
            .last()
            .unwrap_or(column),
    };
    Origin::new(file.clone(), word.line, column).with_length(stop.saturating_sub(column))
}

/// Writes one word a line, and a place for each.
struct Writer<'a> {
    place: &'a dyn Fn(Span) -> Origin,
    text: String,
    places: String,
    /// The line of the last place.
    line: u32,
    /// Whether the next token belongs to the last word, as the second `&` of `&&` does.
    joint: bool,
}

impl Writer<'_> {
    fn tokens(&mut self, tokens: &TokenStream) {
        for token in tokens.clone() {
            match token {
                TokenTree::Group(group) => {
                    let stream = group.stream();
                    let (open, close) = match group.delimiter() {
                        Delimiter::Parenthesis => ("(", ")"),
                        Delimiter::Brace => ("{", "}"),
                        Delimiter::Bracket => ("[", "]"),
                        // What `macro_rules` took for one expression stays one.
                        Delimiter::None if stream.clone().into_iter().count() > 1 => ("(", ")"),
                        Delimiter::None => {
                            self.tokens(&stream);
                            continue;
                        }
                    };
                    self.word(open, group.span_open());
                    self.tokens(&stream);
                    self.word(close, group.span_close());
                }
                TokenTree::Punct(punct) => {
                    self.word(punct.as_char().encode_utf8(&mut [0; 4]), punct.span());
                    self.joint = punct.spacing() == Spacing::Joint;
                }
                other => self.word(&other.to_string(), other.span()),
            }
        }
    }

    fn word(&mut self, word: &str, span: Span) {
        if !std::mem::take(&mut self.joint) {
            let start = if self.text.is_empty() { "" } else { "\n" };
            self.text.push_str(start);
            self.place_for(span);
        }
        self.text.push_str(word);
        // A word of several lines has as many places.
        for _ in word.matches('\n') {
            self.place_for(span);
        }
    }

    fn place_for(&mut self, span: Span) {
        let place = (self.place)(span);
        if !self.places.is_empty() {
            self.places.push(' ');
        }
        if place.line != self.line {
            let _ = write!(self.places, "{}:", place.line);
            self.line = place.line;
        }
        let _ = write!(self.places, "{}", place.column);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use std::str::FromStr;

    use fragbuf_model::Origin;
    use proc_macro2::{Delimiter, Group, Literal, Span, TokenStream, TokenTree};

    use super::Captured;

    fn place(span: Span) -> Origin {
        let (start, end) = (span.start(), span.end());
        let number = |value: usize| u32::try_from(value).unwrap();
        Origin::new("file", number(start.line), number(start.column) + 1).with_length(number(end.column - start.column))
    }

    /// Every leaf with its place, brackets apart.
    fn leaves(tokens: TokenStream, place: &dyn Fn(Span) -> Origin, found: &mut Vec<(String, Origin)>) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => leaves(group.stream(), place, found),
                other => found.push((other.to_string(), place(other.span()))),
            }
        }
    }

    #[test]
    fn tokens_come_back_at_their_places() {
        let text = "|f, u| {\n    let größe = f.depth >= 2.5e-1 && u.cut != -1.0;\n\n  'a: \"two\" }";
        let tokens = TokenStream::from_str(text).unwrap();
        let captured = Captured::of(&tokens, &place);
        let (file, text, places) = captured.parts();
        let leak = |part: &str| -> &'static str { part.to_owned().leak() };
        let again = Captured::new(leak(file), leak(text), leak(places));
        assert_eq!(again.tokens().unwrap().to_string(), tokens.to_string());
        let (mut before, mut after) = (Vec::new(), Vec::new());
        leaves(tokens, &place, &mut before);
        leaves(again.tokens().unwrap(), &again.place(), &mut after);
        assert_eq!(before, after);
    }

    #[test]
    fn what_macros_make_of_tokens_keeps_its_meaning() {
        let sum = TokenStream::from_str("a + b").unwrap();
        let one = TokenStream::from(TokenTree::from(Literal::i32_unsuffixed(-1)));
        let mut tokens = TokenStream::new();
        for inner in [sum, one] {
            tokens.extend([TokenTree::from(Group::new(Delimiter::None, inner))]);
        }
        let captured = Captured::of(&tokens, &place);
        // A negative number is two tokens: in brackets it cannot become a subtraction.
        assert_eq!(captured.tokens().unwrap().to_string(), "(a + b) (- 1)");
    }
}
