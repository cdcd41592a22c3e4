//! Lines and numbers of text formats.

use crate::error::FileError;

/// Returns the lines with their numbers, from 1, without comments after `#` and empty lines. A line that ends in a backslash
/// continues in the next; it has the number of its first part.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut rest = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, line) = rest.next()?;
        let mut whole = line.to_owned();
        while let Some(part) = whole.trim_end().strip_suffix('\\') {
            let more = rest.next().map_or("", |(_, line)| line);
            whole = format!("{part} {more}");
        }
        Some((index + 1, whole.split('#').next().unwrap_or("").trim().to_owned()))
    })
    .filter(|(_, line)| !line.is_empty())
}

/// Parses a finite number.
pub(crate) fn number(word: &str, line: usize) -> Result<f32, FileError> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(FileError::line(line, format!("`{word}` is not finite"))),
        Err(_) => Err(FileError::line(line, format!("`{word}` is not a number"))),
    }
}

/// Parses all words as finite numbers; `counts` are the allowed numbers of words.
pub(crate) fn numbers(words: &[&str], counts: &[usize], line: usize) -> Result<Vec<f32>, FileError> {
    if !counts.contains(&words.len()) {
        let expected: Vec<String> = counts.iter().map(usize::to_string).collect();
        return Err(FileError::line(
            line,
            format!("expected {} numbers, found {}", expected.join(" or "), words.len()),
        ));
    }
    words.iter().map(|word| number(word, line)).collect()
}
