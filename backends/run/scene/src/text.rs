//! Lines and numbers of text formats.

use crate::error::Fault;

/// Lines with their numbers, from 1. A line that ends in a backslash goes on in the next and has the number of its first
/// part. Comments from `#` on, and empty lines, are left out.
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

/// A finite number.
pub(crate) fn number(word: &str, line: usize) -> Result<f32, Fault> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(Fault::line(line, format!("`{word}` is not finite"))),
        Err(_) => Err(Fault::line(line, format!("`{word}` is no number"))),
    }
}

/// All words as finite numbers; `counts` says how many there may be.
pub(crate) fn numbers(words: &[&str], counts: &[usize], line: usize) -> Result<Vec<f32>, Fault> {
    if !counts.contains(&words.len()) {
        let wanted: Vec<String> = counts.iter().map(usize::to_string).collect();
        return Err(Fault::line(line, format!("{} numbers stand where {} belong", words.len(), wanted.join(" or "))));
    }
    words.iter().map(|word| number(word, line)).collect()
}
