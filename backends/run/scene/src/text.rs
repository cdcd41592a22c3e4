//! Lines and numbers of text formats.

use std::borrow::Cow;

use crate::error::FileError;

/// The greatest length of a line of OBJ and MTL in bytes, with all lines that continue it.
const MAX_LINE: usize = 16 << 20;

/// The greatest length of a part of a file that a message quotes, in characters.
const MAX_QUOTED: usize = 60;

/// Returns the lines with their numbers, from 1, without comments after `#` and empty lines. A line that ends in a backslash
/// continues in the next; it has the number of its first part. Invalid UTF-8 becomes U+FFFD.
pub(crate) fn lines(bytes: &[u8]) -> impl Iterator<Item = Result<(usize, Cow<'_, str>), FileError>> {
    let mut rest = bytes.split(|byte| *byte == b'\n').zip(1..);
    std::iter::from_fn(move || {
        let (first, number) = rest.next()?;
        let (mut whole, mut last) = (Cow::Borrowed(first), first);
        while let Some(part) = last.trim_ascii_end().strip_suffix(b"\\") {
            let joined = whole.to_mut();
            joined.truncate(joined.len() - (last.len() - part.len()));
            joined.push(b' ');
            last = rest.next().map_or(&b""[..], |(line, _)| line);
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

/// Returns a line as text, without its comment and the space around it.
fn statement(line: Cow<'_, [u8]>) -> Cow<'_, str> {
    let text = match line {
        Cow::Borrowed(bytes) => String::from_utf8_lossy(bytes),
        Cow::Owned(bytes) => Cow::Owned(String::from_utf8_lossy(&bytes).into_owned()),
    };
    match text {
        Cow::Borrowed(text) => Cow::Borrowed(without_comment(text)),
        Cow::Owned(text) => Cow::Owned(without_comment(&text).to_owned()),
    }
}

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or("").trim()
}

/// Returns a part of a file for a message: in backquotes, and shortened if it is long.
pub(crate) fn quoted(text: &str) -> String {
    match text.char_indices().nth(MAX_QUOTED) {
        Some((end, _)) => format!("`{}…`", text.get(..end).unwrap_or_default()),
        None => format!("`{text}`"),
    }
}

/// Parses a finite number.
pub(crate) fn number(word: &str, line: usize) -> Result<f32, FileError> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(FileError::line(line, format!("{} is not finite", quoted(word)))),
        Err(_) => Err(FileError::line(line, format!("{} is not a number", quoted(word)))),
    }
}

/// Parses all words as finite numbers, at most `N`; `counts` are the allowed numbers of words. Returns the numbers, padded with
/// 0, and their count.
pub(crate) fn numbers<const N: usize>(
    words: &str,
    counts: &[usize],
    line: usize,
) -> Result<([f32; N], usize), FileError> {
    let found = words.split_whitespace().count();
    if !counts.contains(&found) {
        let expected: Vec<String> = counts.iter().map(usize::to_string).collect();
        return Err(FileError::line(line, format!("expected {} numbers, found {found}", expected.join(" or "))));
    }
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(words.split_whitespace()) {
        *value = number(word, line)?;
    }
    Ok((values, found))
}
