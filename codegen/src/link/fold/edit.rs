//! Applies edits to a source, and records the origin of each line.
//!
//! Input: a source with the origins of its lines, and edits. Output: the edited source with the origins of its lines.

use std::ops::Range;

/// The replacement of a range of bytes by `text`, which has no line break.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Edit {
    pub(super) range: Range<usize>,
    pub(super) text: String,
}

/// Returns an edit that removes a range.
pub(super) fn removal(range: Range<usize>) -> Edit {
    Edit { range, text: String::new() }
}

/// A source, and the original line of each of its lines, from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Lines {
    pub(super) text: String,
    pub(super) origins: Vec<usize>,
}

impl Lines {
    /// Creates a source before edits.
    pub(super) fn new(text: &str) -> Self {
        Lines { text: text.to_owned(), origins: (0..text.lines().count()).collect() }
    }

    /// Applies the edits. If two overlap, the later one begins at the end of the earlier one. An edit inside another is ignored.
    pub(super) fn apply(&self, mut edits: Vec<Edit>) -> Self {
        edits.sort_by_key(|edit| (edit.range.start, edit.range.end));
        let mut copy = LineCopy {
            old: self,
            new: Lines { text: String::new(), origins: Vec::new() },
            line: 0,
            at: 0,
            is_cut: false,
        };
        for edit in edits {
            if edit.range.start < copy.at && edit.range.end <= copy.at {
                continue;
            }
            copy.keep(edit.range.start.max(copy.at));
            copy.is_cut |= !edit.range.is_empty();
            copy.put(&edit.text);
            copy.is_cut |= !edit.text.is_empty();
            copy.skip(edit.range.end.max(copy.at));
        }
        copy.keep(self.text.len());
        copy.new
    }
}

/// The state of applying edits.
struct LineCopy<'l> {
    old: &'l Lines,
    new: Lines,
    /// The line of `at`.
    line: usize,
    at: usize,
    /// Whether the next text did not follow the end of the new text before the edits.
    is_cut: bool,
}

impl LineCopy<'_> {
    fn keep(&mut self, end: usize) {
        let old = self.old;
        for piece in old.text[self.at..end].split_inclusive('\n') {
            self.put(piece);
            self.line += usize::from(piece.ends_with('\n'));
        }
        self.at = end;
    }

    fn skip(&mut self, end: usize) {
        self.line += self.old.text[self.at..end].matches('\n').count();
        self.at = end;
    }

    fn put(&mut self, piece: &str) {
        let begins = self.new.text.is_empty() || self.new.text.ends_with('\n');
        if begins && !piece.is_empty() {
            self.new.origins.push(self.old.origins.get(self.line).copied().unwrap_or_default());
        }
        if self.is_cut && joins(&self.new.text, piece) {
            self.new.text.push(' ');
        }
        self.is_cut &= piece.is_empty();
        self.new.text.push_str(piece);
    }
}

/// Tests whether the last token of one text and the first of another would form one token or a comment.
fn joins(before: &str, after: &str) -> bool {
    let (Some(&last), Some(&first)) = (before.as_bytes().last(), after.as_bytes().first()) else { return false };
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || !byte.is_ascii();
    match (last, first) {
        (b'+' | b'-' | b'&' | b'|' | b'<' | b'>' | b'=' | b'/', _) if last == first => true,
        (b'+' | b'-' | b'*' | b'/' | b'%' | b'&' | b'|' | b'^' | b'<' | b'>' | b'!', b'=') => true,
        (b'/', b'*') | (b'-', b'>') => true,
        _ => is_word(last) && is_word(first),
    }
}
