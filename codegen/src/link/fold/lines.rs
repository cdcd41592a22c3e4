//! Removes statements as whole lines, so that no empty line, comment or indentation remains.
//!
//! Input: ranges of tokens. Output: edits.

use std::ops::Range;

use super::edit::removal;
use super::rules::Rules;

impl Rules<'_> {
    /// Removes statements, and the comments above them.
    pub(super) fn remove(&mut self, statements: &Range<usize>) {
        let mut lines = self.whole_lines(statements);
        let before = self.text[..lines.start].trim_end_matches(' ');
        let after = &self.text[lines.end..];
        // No two blank lines, and none at the end of a block.
        if before.ends_with("\n\n") && (after.starts_with('\n') || after.trim_start().starts_with('}')) {
            lines.start -= 1;
        } else if before.ends_with("{\n") && after.starts_with('\n') {
            lines.end += 1;
        }
        self.values.edits.push(removal(lines));
    }

    /// Removes the comments above a statement.
    pub(super) fn comments_above(&mut self, statement: &Range<usize>) {
        let start = self.line_start(self.tokens[statement.start].at);
        let above = self.with_comments(start);
        self.values.edits.push(removal(above..start));
    }

    /// Removes from one token up to another.
    pub(super) fn cut(&mut self, from: usize, to: usize) {
        self.values.edits.push(removal(self.tokens[from].at..self.tokens[to].at));
    }

    /// Removes the text after one token, up to the end of the token before `end`.
    pub(super) fn cut_after(&mut self, token: usize, end: usize) {
        let start = self.tokens[token].at + self.tokens[token].text.len();
        let last = self.tokens[end - 1];
        self.values.edits.push(removal(start..last.at + last.text.len()));
    }

    /// Returns the lines of some tokens with the comments above, or only the tokens if others are on their lines.
    pub(super) fn whole_lines(&self, tokens: &Range<usize>) -> Range<usize> {
        let bytes = self.values.bytes(tokens);
        let (start, end) = (self.line_start(bytes.start), self.line_end(bytes.end));
        let (before, after) = (self.text[start..bytes.start].trim(), self.text[bytes.end..end].trim());
        if before.is_empty() && (after.is_empty() || after.starts_with("//")) {
            return self.with_comments(start)..end;
        }
        let space = self.text[bytes.end..end].bytes().take_while(|byte| *byte == b' ').count();
        bytes.start..bytes.end + space
    }

    /// Returns the start of the comments directly above a line.
    fn with_comments(&self, line: usize) -> usize {
        let mut start = line;
        while start > 0 {
            let above = self.line_start(start - 1);
            if !self.text[above..start].trim_start().starts_with("//") {
                break;
            }
            start = above;
        }
        start
    }

    pub(super) fn line_start(&self, at: usize) -> usize {
        self.text[..at].rfind('\n').map_or(0, |end| end + 1)
    }

    pub(super) fn line_end(&self, at: usize) -> usize {
        self.text[at..].find('\n').map_or(self.text.len(), |length| at + length + 1)
    }
}
