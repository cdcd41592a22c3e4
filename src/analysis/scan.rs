//! Tokens of a text that may be incomplete, and a text with the same offsets whose brackets match.
//!
//! Input: any text. Output: tokens, which cover all but white space, or the corrected text. Nothing here is an error: the compiler
//! reports errors, and this module serves texts that a user is typing.

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// An identifier or a keyword.
    Word,
    Number,
    /// A string or a character, with its quotes.
    Text,
    Comment,
    /// One character of an operator.
    Punct,
    /// `(`, `[` or `{`.
    Open,
    /// `)`, `]` or `}`.
    Close,
    /// A character that no token has.
    Invalid,
}

/// A token, with its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub kind: Kind,
    pub start: usize,
    pub end: usize,
    /// Whether a string or a comment ends with the text.
    pub is_unclosed: bool,
}

impl Token {
    /// Returns the source of the token.
    pub(super) fn of<'a>(&self, text: &'a str) -> &'a str {
        text.get(self.start..self.end).unwrap_or_default()
    }
}

/// Returns the tokens of a text.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let (kind, length, is_unclosed) = next(rest);
        if let Some(kind) = kind {
            tokens.push(Token { kind, start: at, end: at + length, is_unclosed });
        }
        at += length.max(1);
    }
    tokens
}

/// Returns the kind of the first token, its length, and whether it lacks its end. `None`: white space.
fn next(rest: &str) -> (Option<Kind>, usize, bool) {
    let first = rest.chars().next().unwrap_or(' ');
    let while_ = |is_part: &dyn Fn(char) -> bool| rest.find(|letter| !is_part(letter)).unwrap_or(rest.len());
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    if first.is_whitespace() {
        return (None, while_(&char::is_whitespace), false);
    }
    if rest.starts_with("//") {
        return (Some(Kind::Comment), rest.find('\n').unwrap_or(rest.len()), false);
    }
    if rest.starts_with("/*") {
        let end = end_of_comment(rest);
        return (Some(Kind::Comment), end.unwrap_or(rest.len()), end.is_none());
    }
    match first {
        '"' => {
            let end = end_of_string(rest);
            (Some(Kind::Text), end.unwrap_or(rest.len()), end.is_none())
        }
        '\'' => match character(rest) {
            Some(length) => (Some(Kind::Text), length, false),
            None => (Some(Kind::Punct), 1, false),
        },
        '(' | '[' | '{' => (Some(Kind::Open), 1, false),
        ')' | ']' | '}' => (Some(Kind::Close), 1, false),
        _ if first.is_ascii_digit() => (Some(Kind::Number), number(rest), false),
        _ if is_word(first) => (Some(Kind::Word), while_(&is_word), false),
        _ if "!#$%&*+,-./:;<=>?@^|~".contains(first) => (Some(Kind::Punct), 1, false),
        _ => (Some(Kind::Invalid), first.len_utf8(), false),
    }
}

/// Returns the length of a number. A `.` belongs to it if a digit follows.
fn number(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let is_part = |at: usize| match bytes.get(at) {
        Some(b'.') => bytes.get(at + 1).is_some_and(u8::is_ascii_digit),
        Some(letter) => letter.is_ascii_alphanumeric() || *letter == b'_',
        None => false,
    };
    (0..=bytes.len()).find(|at| !is_part(*at)).unwrap_or(bytes.len())
}

fn end_of_string(rest: &str) -> Option<usize> {
    let mut letters = rest.char_indices().skip(1);
    while let Some((at, letter)) = letters.next() {
        match letter {
            '\\' => drop(letters.next()),
            '"' => return Some(at + 1),
            _ => {}
        }
    }
    None
}

/// Returns the length of a character literal; `None`: a label such as `'a`.
fn character(rest: &str) -> Option<usize> {
    let mut letters = rest.char_indices().skip(1);
    let (_, first) = letters.next()?;
    if first == '\\' {
        letters.next()?;
        let (end, _) = letters.take_while(|(_, letter)| *letter != '\n').find(|(_, letter)| *letter == '\'')?;
        return Some(end + 1);
    }
    letters.next().filter(|(_, letter)| *letter == '\'').map(|(end, _)| end + 1)
}

/// Returns the length of a block comment. They nest, as in Rust.
fn end_of_comment(rest: &str) -> Option<usize> {
    let bytes = rest.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while at + 1 < bytes.len() {
        match (bytes[at], bytes[at + 1]) {
            (b'/', b'*') => (depth, at) = (depth + 1, at + 2),
            (b'*', b'/') if depth <= 1 => return Some(at + 2),
            (b'*', b'/') => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
    }
    None
}

/// Returns the index of the token that closes the bracket at `open`.
pub(super) fn closing(tokens: &[Token], open: usize) -> Option<usize> {
    first_balanced(tokens, open..tokens.len(), (Kind::Open, Kind::Close))
}

/// Returns the index of the token that opens the bracket at `close`.
pub(super) fn opening(tokens: &[Token], close: usize) -> Option<usize> {
    first_balanced(tokens, (0..=close).rev(), (Kind::Close, Kind::Open))
}

/// Returns the first index at which as many brackets have ended as have begun.
fn first_balanced(
    tokens: &[Token],
    mut indices: impl Iterator<Item = usize>,
    (begin, end): (Kind, Kind),
) -> Option<usize> {
    let mut depth = 0_usize;
    indices.find(|index| {
        match tokens.get(*index).map(|token| token.kind) {
            Some(kind) if kind == begin => depth += 1,
            Some(kind) if kind == end => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0
    })
}

/// Returns the closing bracket of an opening one.
pub(super) fn partner(open: &str) -> &'static str {
    match open {
        "(" => ")",
        "[" => "]",
        _ => "}",
    }
}

/// Returns the text with spaces in place of brackets without a partner, of unclosed strings and of characters that no token has, and
/// with the missing closing brackets at its end. Other offsets stay the same.
pub(super) fn repaired(text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let mut blank = |token: &Token| {
        for byte in bytes.get_mut(token.start..token.end).unwrap_or_default() {
            // Lines stay the same, too.
            *byte = if *byte == b'\n' { b'\n' } else { b' ' };
        }
    };
    let mut open: Vec<Token> = Vec::new();
    for token in tokens(text) {
        match token.kind {
            Kind::Open => open.push(token),
            Kind::Close => {
                let is_partner = |open: &Token| partner(open.of(text)) == token.of(text);
                match open.iter().rposition(is_partner) {
                    Some(at) => {
                        open.iter().skip(at + 1).for_each(&mut blank);
                        open.truncate(at);
                    }
                    None => blank(&token),
                }
            }
            Kind::Invalid => blank(&token),
            Kind::Text | Kind::Comment if token.is_unclosed => blank(&token),
            _ => {}
        }
    }
    // Only whole characters are replaced, by ASCII.
    let mut repaired = String::from_utf8(bytes).unwrap_or_default();
    repaired.push('\n');
    repaired.extend(open.iter().rev().map(|open| partner(open.of(text))));
    repaired
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_those_of_rust() {
        let text = "a1.b 1.5e3..2 \"x\\\"y\" 'c' 'l /* /* */ */ // end\n}é#\\";
        let found: Vec<(Kind, &str)> = tokens(text).iter().map(|token| (token.kind, token.of(text))).collect();
        use Kind::*;
        let expected = [
            (Word, "a1"),
            (Punct, "."),
            (Word, "b"),
            (Number, "1.5e3"),
            (Punct, "."),
            (Punct, "."),
            (Number, "2"),
            (Text, "\"x\\\"y\""),
            (Text, "'c'"),
            (Punct, "'"),
            (Word, "l"),
            (Comment, "/* /* */ */"),
            (Comment, "// end"),
            (Close, "}"),
            (Word, "é"),
            (Punct, "#"),
            (Invalid, "\\"),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn repaired_texts_have_matching_brackets() {
        for (text, expected) in [
            ("a { (b }", "a {  b }\n"),
            ("a { ) b", "a {   b\n}"),
            ("a [ { ( ", "a [ { ( \n)}]"),
            ("a { \"b }", "a {     \n}"),
            ("a § { /* }", "a    {     \n}"),
        ] {
            let repaired = repaired(text);
            assert_eq!(repaired, expected);
        }
    }
}
