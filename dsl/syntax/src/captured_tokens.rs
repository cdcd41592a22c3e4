//! Tokens that a macro stores in the program: their source, and the position of each in the user's file.
//!
//! Input: tokens with spans, while the user's crate is compiled. Output: the same tokens with the same spans at run time.
//! The stored source has one token per line, so a token's line is its index in the list of positions.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::str::FromStr;
use std::sync::Arc;

use fragbuf_model::{Diagnostic, Draft, SourceSpan, Spanned};
use proc_macro2::{Delimiter, LineColumn, Spacing, Span, TokenStream, TokenTree};

use crate::lexer;
use crate::parse::{Parsed, parse_tokens};

/// Tokens of a description, or of one of its functions, with their positions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CapturedTokens {
    file: Cow<'static, str>,
    source: Cow<'static, str>,
    positions: Positions,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Positions {
    /// One for each line of the stored source: `line:column`, or only `column` if the line is that of the one before.
    PerLine(Cow<'static, str>),
    /// The same span for every token.
    Same(SourceSpan),
}

impl CapturedTokens {
    /// Restores tokens from the three parts that a macro printed: see [`CapturedTokens::parts`].
    pub const fn new(file: &'static str, source: &'static str, positions: &'static str) -> Self {
        let positions = Positions::PerLine(Cow::Borrowed(positions));
        CapturedTokens { file: Cow::Borrowed(file), source: Cow::Borrowed(source), positions }
    }

    /// Stores source that a program generated; every error in it is reported at `span`.
    pub fn from_source(source: impl Into<String>, span: &SourceSpan) -> Self {
        let file = Cow::Owned(span.file.to_string());
        CapturedTokens { file, source: Cow::Owned(source.into()), positions: Positions::Same(span.clone()) }
    }

    /// Stores tokens; `locate` maps each token span to the user's file. All tokens are assumed to be in the first one's file.
    pub fn from_tokens(tokens: &TokenStream, locate: &dyn Fn(Span) -> SourceSpan) -> Self {
        let first = tokens.clone().into_iter().next().map_or_else(Span::call_site, |token| token.span());
        let file = locate(first).file.to_string();
        let mut writer = Writer { locate, source: String::new(), positions: String::new(), line: 0, joint: false };
        writer.tokens(tokens);
        let positions = Positions::PerLine(Cow::Owned(writer.positions));
        CapturedTokens { file: Cow::Owned(file), source: Cow::Owned(writer.source), positions }
    }

    /// Returns the arguments of [`CapturedTokens::new`]: file, source, positions.
    pub fn parts(&self) -> (&str, &str, &str) {
        match &self.positions {
            Positions::PerLine(positions) => (&self.file, &self.source, positions),
            Positions::Same(_) => (&self.file, &self.source, ""),
        }
    }

    /// Parses the tokens as a description.
    pub fn parse(&self) -> Parsed {
        let locate = self.locator();
        match self.tokens() {
            Ok(tokens) => parse_tokens(tokens, &locate),
            Err(invalid) => Parsed { draft: None, diagnostics: (*invalid).into() },
        }
    }

    /// Returns the draft of a description that a macro parsed without an error, or an empty draft if parsing fails.
    pub fn draft(&self) -> Draft {
        let span = SourceSpan::new(&*self.file, 1, 1);
        self.parse().draft.unwrap_or_else(|| Draft::empty(Spanned::new("Unnamed".to_owned(), span)))
    }

    /// Returns the tokens, or an error if generated source is not valid.
    pub(crate) fn tokens(&self) -> Result<TokenStream, Box<Diagnostic>> {
        match &self.positions {
            Positions::PerLine(_) => TokenStream::from_str(&self.source)
                .map_err(|_| Box::new(lexer::invalid_token(&SourceSpan::new(&*self.file, 1, 1), None))),
            Positions::Same(span) => lexer::tokens(&self.source, &self.file).map_err(|mut invalid| {
                invalid.span = span.clone();
                invalid.labels.clear();
                invalid
            }),
        }
    }

    /// Returns a function from spans of [`CapturedTokens::tokens`] to spans in the user's file.
    pub(crate) fn locator(&self) -> impl Fn(Span) -> SourceSpan + use<> {
        let file: Arc<str> = (&*self.file).into();
        let lines = match &self.positions {
            Positions::PerLine(positions) => Ok(line_spans(&self.source, positions)),
            Positions::Same(span) => Err(span.clone()),
        };
        move |span: Span| match &lines {
            Ok(lines) => source_span(lines, &file, span.start(), span.end()),
            Err(same) => same.clone(),
        }
    }
}

/// The position and length in the user's file of one line of the stored source.
struct LineSpan {
    line: u32,
    column: u32,
    length: u32,
}

fn line_spans(source: &str, positions: &str) -> Vec<LineSpan> {
    let mut line = 1;
    let mut spans = Vec::new();
    for (token, position) in source.lines().zip(positions.split(' ')) {
        let column = match position.split_once(':') {
            Some((given, column)) => {
                line = given.parse().unwrap_or(line);
                column
            }
            None => position,
        };
        let length = u32::try_from(token.chars().count()).unwrap_or(u32::MAX);
        spans.push(LineSpan { line, column: column.parse().unwrap_or(1), length });
    }
    spans
}

fn source_span(lines: &[LineSpan], file: &Arc<str>, start: LineColumn, end: LineColumn) -> SourceSpan {
    let number = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
    let first = start.line.saturating_sub(1);
    let Some(begin) = lines.get(first) else { return SourceSpan::new(file.clone(), 1, 1) };
    let column = begin.column.saturating_add(number(start.column));
    let last = lines.get(end.line.saturating_sub(1)).filter(|last| last.line == begin.line);
    let stop = match last {
        Some(last) => last.column.saturating_add(number(end.column)),
        // Beyond the line: to the end of the last token of this line.
        None => lines
            .iter()
            .skip(first)
            .take_while(|other| other.line == begin.line)
            .map(|other| other.column.saturating_add(other.length))
            .last()
            .unwrap_or(column),
    };
    SourceSpan::new(file.clone(), begin.line, column).with_length(stop.saturating_sub(column))
}

/// A writer of one token per line, and a position for each.
struct Writer<'a> {
    locate: &'a dyn Fn(Span) -> SourceSpan,
    source: String,
    positions: String,
    /// The line of the last position.
    line: u32,
    /// Whether the next token stays on the last line, as the second `&` of `&&` does.
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
                        // An expression that `macro_rules` matched stays one expression.
                        Delimiter::None if stream.clone().into_iter().count() > 1 => ("(", ")"),
                        Delimiter::None => {
                            self.tokens(&stream);
                            continue;
                        }
                    };
                    self.token(open, group.span_open());
                    self.tokens(&stream);
                    self.token(close, group.span_close());
                }
                TokenTree::Punct(punct) => {
                    self.token(punct.as_char().encode_utf8(&mut [0; 4]), punct.span());
                    self.joint = punct.spacing() == Spacing::Joint;
                }
                other => self.token(&other.to_string(), other.span()),
            }
        }
    }

    fn token(&mut self, token: &str, span: Span) {
        if !std::mem::take(&mut self.joint) {
            let start = if self.source.is_empty() { "" } else { "\n" };
            self.source.push_str(start);
            self.position(span);
        }
        self.source.push_str(token);
        // A token of several lines has as many positions.
        for _ in token.matches('\n') {
            self.position(span);
        }
    }

    fn position(&mut self, span: Span) {
        let span = (self.locate)(span);
        if !self.positions.is_empty() {
            self.positions.push(' ');
        }
        if span.line != self.line {
            let _ = write!(self.positions, "{}:", span.line);
            self.line = span.line;
        }
        let _ = write!(self.positions, "{}", span.column);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use std::str::FromStr;

    use fragbuf_model::SourceSpan;
    use proc_macro2::{Delimiter, Group, Literal, Span, TokenStream, TokenTree};

    use super::CapturedTokens;

    fn locate(span: Span) -> SourceSpan {
        let (start, end) = (span.start(), span.end());
        let number = |value: usize| u32::try_from(value).unwrap();
        SourceSpan::new("file", number(start.line), number(start.column) + 1)
            .with_length(number(end.column - start.column))
    }

    /// Collects every token but brackets, with its span.
    fn leaves(tokens: TokenStream, locate: &dyn Fn(Span) -> SourceSpan, found: &mut Vec<(String, SourceSpan)>) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => leaves(group.stream(), locate, found),
                other => found.push((other.to_string(), locate(other.span()))),
            }
        }
    }

    #[test]
    fn restored_tokens_have_their_spans() {
        let source = "|f, u| {\n    let größe = f.depth >= 2.5e-1 && u.cut != -1.0;\n\n  'a: \"two\" }";
        let tokens = TokenStream::from_str(source).unwrap();
        let captured = CapturedTokens::from_tokens(&tokens, &locate);
        let (file, source, positions) = captured.parts();
        let leak = |part: &str| -> &'static str { part.to_owned().leak() };
        let again = CapturedTokens::new(leak(file), leak(source), leak(positions));
        assert_eq!(again.tokens().unwrap().to_string(), tokens.to_string());
        let (mut before, mut after) = (Vec::new(), Vec::new());
        leaves(tokens, &locate, &mut before);
        leaves(again.tokens().unwrap(), &again.locator(), &mut after);
        assert_eq!(before, after);
    }

    #[test]
    fn groups_of_macros_keep_their_meaning() {
        let sum = TokenStream::from_str("a + b").unwrap();
        let one = TokenStream::from(TokenTree::from(Literal::i32_unsuffixed(-1)));
        let mut tokens = TokenStream::new();
        for inner in [sum, one] {
            tokens.extend([TokenTree::from(Group::new(Delimiter::None, inner))]);
        }
        let captured = CapturedTokens::from_tokens(&tokens, &locate);
        // A negative number is two tokens: in brackets it cannot become a subtraction.
        assert_eq!(captured.tokens().unwrap().to_string(), "(a + b) (- 1)");
    }
}
