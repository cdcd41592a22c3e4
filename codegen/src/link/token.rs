//! Splits WGSL into tokens with byte offsets. They suffice to find declarations and names; naga checks the rest.

/// A token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    /// The byte offset.
    pub(super) at: usize,
    pub(super) kind: TokenKind,
}

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    Name,
    Number,
    Sign,
}

/// Returns the tokens of `text`, and its comments. Block comments nest, as in WGSL.
pub(super) fn tokens(text: &str) -> (Vec<Token<'_>>, Vec<Token<'_>>) {
    let bytes = text.as_bytes();
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut comments = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let (kind, end) = match class(byte) {
            Class::Space => {
                at += 1;
                continue;
            }
            Class::Letter => (TokenKind::Name, word_end(bytes, at, b'_')),
            Class::Digit => (TokenKind::Number, word_end(bytes, at, b'.')),
            Class::Sign if byte == b'/' && matches!(bytes.get(at + 1), Some(b'/' | b'*')) => {
                let end = if bytes[at + 1] == b'/' { line_end(bytes, at) } else { block_end(bytes, at) };
                comments.push(Token { text: &text[at..end], at, kind: TokenKind::Sign });
                at = end;
                continue;
            }
            Class::Sign if byte.is_ascii() => (TokenKind::Sign, at + 1),
            Class::Sign => (TokenKind::Sign, at + text[at..].chars().next().map_or(1, char::len_utf8)),
        };
        tokens.push(Token { text: &text[at..end], at, kind });
        at = end;
    }
    (tokens, comments)
}

/// The class of the first byte of a token.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Space,
    Letter,
    Digit,
    Sign,
}

/// Looks up the class of a byte. A table is faster than comparisons.
fn class(byte: u8) -> Class {
    const CLASSES: [Class; 256] = {
        let mut classes = [Class::Sign; 256];
        let mut byte = 0u8;
        while byte < 128 {
            classes[byte as usize] = match byte {
                b'a'..=b'z' | b'A'..=b'Z' | b'_' => Class::Letter,
                b'0'..=b'9' => Class::Digit,
                _ if byte.is_ascii_whitespace() => Class::Space,
                _ => Class::Sign,
            };
            byte += 1;
        }
        classes
    };
    CLASSES[usize::from(byte)]
}

fn line_end(bytes: &[u8], at: usize) -> usize {
    bytes[at..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |length| at + length)
}

fn block_end(bytes: &[u8], start: usize) -> usize {
    let mut depth = 0usize;
    let mut at = start;
    while at < bytes.len() {
        match &bytes[at..(at + 2).min(bytes.len())] {
            b"/*" => {
                depth += 1;
                at += 2;
            }
            b"*/" => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    bytes.len()
}

fn word_end(bytes: &[u8], at: usize, also: u8) -> usize {
    let inside = |byte: &u8| match class(*byte) {
        Class::Digit => true,
        Class::Letter => *byte != b'_' || also == b'_',
        _ => *byte == also,
    };
    at + bytes[at..].iter().position(|byte| !inside(byte)).unwrap_or(bytes.len() - at)
}
