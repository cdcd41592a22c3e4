//! CSV files: comment lines that begin with `#`, a line of column names, and rows (RFC 4180).

use std::path::Path;

use crate::cli::output::Failure;

/// The cells of a line.
pub(super) type Row = Vec<String>;

/// Returns a file as text.
pub(super) fn text(comments: &[String], columns: &[&str], rows: &[Row]) -> String {
    let mut text: String = comments.iter().map(|comment| format!("# {comment}\n")).collect();
    let columns: Row = columns.iter().map(|column| (*column).to_owned()).collect();
    for row in std::iter::once(&columns).chain(rows) {
        let cells: Vec<String> = row.iter().map(|cell| quoted(cell)).collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// Writes a file, and creates its folder.
pub(super) fn write(path: &Path, comments: &[String], columns: &[&str], rows: &[Row]) -> Result<(), Failure> {
    write_text(path, &text(comments, columns, rows))
}

/// Writes a text file, and creates its folder.
pub(super) fn write_text(path: &Path, text: &str) -> Result<(), Failure> {
    let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    folder.and_then(|()| std::fs::write(path, text)).map_err(|error| Failure::files(path, &error))
}

/// Returns the comments and the rows of a text, without the line of column names.
pub(super) fn parse(text: &str) -> (Vec<String>, Vec<Row>) {
    let comments = text.lines().take_while(|line| line.starts_with('#'));
    let comments: Vec<String> = comments.map(|line| line.trim_start_matches('#').trim().to_owned()).collect();
    let rows = text.lines().skip(comments.len() + 1).filter(|line| !line.is_empty()).map(cells).collect();
    (comments, rows)
}

/// Quotes a cell if it needs it. Lines are not broken inside of cells.
fn quoted(cell: &str) -> String {
    let cell = cell.replace(['\n', '\r'], " ");
    match cell.contains([',', '"']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell,
    }
}

/// Returns the cells of a line.
fn cells(line: &str) -> Row {
    let (mut cells, mut cell, mut is_quoted) = (Row::new(), String::new(), false);
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        match (character, is_quoted) {
            ('"', true) if characters.peek() == Some(&'"') => {
                cell.push('"');
                characters.next();
            }
            ('"', _) => is_quoted = !is_quoted,
            (',', false) => cells.push(std::mem::take(&mut cell)),
            (character, _) => cell.push(character),
        }
    }
    cells.push(cell);
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_survive_the_file() {
        let rows: Vec<Row> = vec![
            ["plain", "with, comma", "with \"quotes\"", ""].map(str::to_owned).to_vec(),
            ["\"", ",", "\",\"", "K⁺B"].map(str::to_owned).to_vec(),
        ];
        let comments = vec!["fragbuf".to_owned(), "device: a, b".to_owned()];
        let written = text(&comments, &["a", "b", "c", "d"], &rows);
        assert_eq!(parse(&written), (comments, rows));
        assert!(written.starts_with("# fragbuf\n# device: a, b\na,b,c,d\nplain,\"with, comma\","), "{written}");
    }
}
