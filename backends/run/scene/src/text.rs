//! Lines and numbers of text formats.

use std::borrow::Cow;

use crate::error::FileError;

/// The greatest length of a line of OBJ and MTL in bytes, with all lines that continue it.
const MAX_LINE: usize = 16 << 20;

/// The greatest length of a part of a file that a message quotes, in characters.
const MAX_QUOTED: usize = 60;

/// The greatest length of a message of another crate, in characters: it may quote a part of a file.
const MAX_MESSAGE: usize = 300;

/// The statements whose rest is a name that must equal another name or that of a file. Whether a `#` in it is part of the name, as in
/// `Material #1` of 3ds Max, or begins a comment, depends on these names.
const NAMED: [&str; 4] = ["newmtl", "usemtl", "mtllib", "map_Kd"];

/// The greatest number: differences of two numbers are finite.
pub(crate) const MAX_NUMBER: f64 = 1.0e300;

/// Returns the first line without its end, and the rest of the bytes after it. A line ends with a line feed, a carriage return, or
/// both. `None`: there is no line.
pub(crate) fn first_line(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    if bytes.is_empty() {
        return None;
    }
    let end = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(bytes.len());
    let (line, rest) = bytes.split_at(end);
    let rest = rest.strip_prefix(b"\r\n").or_else(|| rest.get(1..)).unwrap_or_default();
    Some((line, rest))
}

/// Returns a text without its byte order mark.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Returns the lines with their numbers, from 1, without comments after `#` and empty lines. A line that ends in a backslash
/// continues in the next, unless the backslash is in a comment; it has the number of its first part. Invalid UTF-8 becomes U+FFFD.
pub(crate) fn lines(bytes: &[u8]) -> impl Iterator<Item = Result<(usize, Cow<'_, str>), FileError>> {
    let (mut rest, mut next) = (without_mark(bytes), 1);
    std::iter::from_fn(move || {
        let number = next;
        let mut line = || {
            let (line, after) = first_line(rest)?;
            (rest, next) = (after, next + 1);
            Some(line)
        };
        let first = line()?;
        let (mut whole, mut last) = (Cow::Borrowed(first), first);
        let is_named = is_named(first);
        // Only the last part is searched: a comment in an earlier one has ended the statement.
        let continues = |part: &[u8]| is_named || !part.contains(&b'#');
        while let Some(part) = last.trim_ascii_end().strip_suffix(b"\\").filter(|part| continues(part)) {
            let joined = whole.to_mut();
            joined.truncate(joined.len() - (last.len() - part.len()));
            joined.push(b' ');
            last = line().unwrap_or_default();
            joined.extend_from_slice(last);
            if joined.len() > MAX_LINE {
                break;
            }
        }
        if whole.len() > MAX_LINE {
            return Some(Err(FileError::line(number, format!("the line has more than {MAX_LINE} bytes"))));
        }
        Some(Ok((number, statement(whole))))
    })
    .filter(|line| !matches!(line, Ok((_, statement)) if statement.is_empty()))
}

/// Whether a `#` begins a comment in a line.
fn has_comment(line: &[u8]) -> bool {
    line.contains(&b'#') && !is_named(line)
}

/// Whether the rest of a statement is a name.
fn is_named(line: &[u8]) -> bool {
    let keyword = line.trim_ascii_start().split(u8::is_ascii_whitespace).next().unwrap_or_default();
    NAMED.iter().any(|name| name.as_bytes() == keyword)
}

/// Returns a line as text, without its comment and the space around it.
fn statement(line: Cow<'_, [u8]>) -> Cow<'_, str> {
    let has_comment = has_comment(&line);
    let text = match line {
        Cow::Borrowed(bytes) => String::from_utf8_lossy(bytes),
        Cow::Owned(bytes) => Cow::Owned(String::from_utf8_lossy(&bytes).into_owned()),
    };
    let trimmed = |text: &str| if has_comment { without_comment(text).len() } else { text.trim_end().len() };
    match text {
        Cow::Borrowed(text) => Cow::Borrowed(text.get(..trimmed(text)).unwrap_or_default().trim()),
        Cow::Owned(text) => Cow::Owned(text.get(..trimmed(&text)).unwrap_or_default().trim().to_owned()),
    }
}

/// Returns the text before a comment.
pub(crate) fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or("").trim_end()
}

/// Returns a part of a file for a message: in backquotes, and shortened if it is long.
pub(crate) fn quoted(text: &str) -> String {
    format!("`{}`", shortened(text, MAX_QUOTED))
}

/// Returns bytes of a file for a message, like [`quoted`]. Bytes that are not shown are not decoded.
pub(crate) fn quoted_bytes(bytes: &[u8]) -> String {
    // A character has at most four bytes.
    quoted(&String::from_utf8_lossy(bytes.get(..4 * (MAX_QUOTED + 1)).unwrap_or(bytes)))
}

/// Returns a message of another crate, shortened if it is long.
pub(crate) fn foreign_message(error: &dyn std::fmt::Display) -> String {
    shortened(&error.to_string(), MAX_MESSAGE).into_owned()
}

fn shortened(text: &str, length: usize) -> Cow<'_, str> {
    match beginning(text, length) {
        all if all.len() == text.len() => Cow::Borrowed(text),
        part => Cow::Owned(format!("{part}…")),
    }
}

/// Returns the first `length` characters of a text.
pub(crate) fn beginning(text: &str, length: usize) -> &str {
    text.char_indices().nth(length).and_then(|(end, _)| text.get(..end)).unwrap_or(text)
}

/// Parses a finite number.
pub(crate) fn number(word: &str, line: usize) -> Result<f64, FileError> {
    match word.parse::<f64>() {
        Ok(value) if value.abs() <= MAX_NUMBER => Ok(value),
        Ok(value) if value.is_finite() => {
            Err(FileError::line(line, format!("{} is not from -1e300 to 1e300", quoted(word))))
        }
        Ok(_) => Err(FileError::line(line, format!("{} is not finite", quoted(word)))),
        Err(_) => Err(FileError::line(line, format!("{} is not a number", quoted(word)))),
    }
}

/// Returns a number with its noun in the singular or the plural: `1 line`, `2 lines`. The plural of `noun` ends in `s`.
pub(crate) fn counted(number: impl std::fmt::Display, noun: &str) -> String {
    let number = number.to_string();
    let ending = if number == "1" { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// Parses all words as finite numbers, at most `N`; `counts` are the allowed numbers of words. Returns the numbers, padded with
/// 0, and their count.
pub(crate) fn numbers<const N: usize>(
    words: &str,
    counts: &[usize],
    line: usize,
) -> Result<([f64; N], usize), FileError> {
    let found = words.split_whitespace().count();
    if !counts.contains(&found) {
        let expected: Vec<String> = counts.iter().map(usize::to_string).collect();
        let noun = if counts == [1] { "number" } else { "numbers" };
        return Err(FileError::line(line, format!("expected {} {noun}, found {found}", expected.join(" or "))));
    }
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(words.split_whitespace()) {
        *value = number(word, line)?;
    }
    Ok((values, found))
}
