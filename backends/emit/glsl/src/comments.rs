//! Finds the comments of the WGSL source, above a statement or after it on its line.
//!
//! Input: the source and byte positions of statements. Output: each `//` comment at most once, with its statement. Doc
//! comments are skipped, because the module contains them.

use std::ops::Range;

/// A `//` comment.
struct Comment<'a> {
    start: usize,
    text: &'a str,
    /// The innermost brace pair around the comment, by the position of the opening brace.
    block: usize,
    /// True if code precedes the comment on its line.
    trailing: bool,
    used: bool,
}

/// All line comments of a source, and its brace structure.
pub struct Comments<'a> {
    source: &'a str,
    comments: Vec<Comment<'a>>,
    /// Opening and closing position of every pair of braces, by opening position.
    braces: Vec<(usize, usize)>,
}

impl<'a> Comments<'a> {
    /// Scans a source.
    pub fn new(source: &'a str) -> Self {
        let mut found = Self { source, comments: Vec::new(), braces: Vec::new() };
        let mut open = Vec::new();
        let bytes = source.as_bytes();
        let mut at = 0;
        while let Some(byte) = bytes.get(at) {
            match byte {
                b'/' if source[at..].starts_with("//") => {
                    let end = source[at..].find('\n').map_or(source.len(), |length| at + length);
                    found.record(at, end, open.last().copied().unwrap_or_default());
                    at = end;
                    continue;
                }
                b'/' if source[at..].starts_with("/*") => {
                    at = skip_block(source, at);
                    continue;
                }
                b'{' => open.push(at),
                b'}' => found.braces.extend(open.pop().map(|start| (start, at))),
                _ => {}
            }
            at += 1;
        }
        found.braces.sort_unstable();
        found
    }

    /// Records a comment, unless it is a doc comment.
    fn record(&mut self, start: usize, end: usize, block: usize) {
        let text = &self.source[start..end];
        if text.starts_with("///") || text.starts_with("//!") {
            return;
        }
        let line = self.source[..start].rfind('\n').map_or(0, |at| at + 1);
        let trailing = !self.source[line..start].trim().is_empty();
        self.comments.push(Comment { start, text: text.trim_end(), block, trailing, used: false });
    }

    /// Returns the innermost pair of braces around a position.
    fn braces_around(&self, position: usize) -> Option<(usize, usize)> {
        let before = self.braces.partition_point(|(open, _)| *open < position);
        self.braces[..before].iter().rev().find(|(_, close)| position < *close).copied()
    }

    /// Returns the innermost pair of braces around a position, by its opening brace; 0 outside all braces.
    fn block_at(&self, position: usize) -> usize {
        self.braces_around(position).map_or(0, |(open, _)| open)
    }

    /// Takes the unused comments before a position in the same block.
    pub fn before(&mut self, position: usize) -> Vec<&'a str> {
        let block = self.block_at(position);
        if block == 0 {
            return Vec::new();
        }
        self.take(block..position, |comment| comment.block == block)
    }

    /// Takes the unused comments inside a statement.
    pub fn within(&mut self, start: usize, end: usize) -> Vec<&'a str> {
        self.take(start..end, |_| true)
    }

    /// Takes all unused comments of the block around a position.
    pub fn rest(&mut self, position: usize) -> Vec<&'a str> {
        match self.braces_around(position) {
            Some((block, end)) if block != 0 => self.take(block..end, |comment| comment.block == block),
            _ => Vec::new(),
        }
    }

    /// Takes the comment after the end of a statement, on the same line.
    pub fn after(&mut self, end: usize) -> Option<&'a str> {
        let line_end = self.source.get(end..)?.find('\n').map_or(self.source.len(), |length| end + length);
        let mut comments = self.take(end..line_end, |comment| comment.trailing);
        comments.pop()
    }

    /// Takes the unused comments that start in a range and match.
    fn take(&mut self, range: Range<usize>, wanted: impl Fn(&Comment<'a>) -> bool) -> Vec<&'a str> {
        let mut texts = Vec::new();
        let first = self.comments.partition_point(|comment| comment.start < range.start);
        let in_range = self.comments[first..].iter_mut().take_while(|comment| comment.start < range.end);
        for comment in in_range.filter(|comment| !comment.used) {
            if wanted(comment) {
                comment.used = true;
                texts.push(comment.text);
            }
        }
        texts
    }

    /// Returns the `//` lines directly above a position, such as a function; a doc comment ends them.
    pub fn above(&self, position: usize) -> Vec<&'a str> {
        let Some(before) = self.source.get(..position) else { return Vec::new() };
        let line = before.rfind('\n').map_or(0, |at| at + 1);
        let lines = before[..line].lines().rev().map(str::trim);
        let plain = |text: &&str| text.starts_with("//") && !text.starts_with("///") && !text.starts_with("//!");
        let mut found: Vec<&str> = lines.take_while(plain).collect();
        found.reverse();
        found
    }

    /// Tests whether the source has a blank line above a position or above the comments directly above it.
    pub fn paragraph_before(&self, position: usize) -> bool {
        let Some(before) = self.source.get(..position) else { return false };
        let line = before.rfind('\n').map_or(0, |at| at + 1);
        let mut blank = false;
        for text in before[..line].lines().rev().map(str::trim) {
            if text.is_empty() {
                blank = true;
            } else if blank || !text.starts_with("//") {
                return blank && !text.ends_with('{');
            }
        }
        false
    }
}

/// Returns the end of a block comment; block comments nest in WGSL.
fn skip_block(source: &str, start: usize) -> usize {
    let mut depth = 0usize;
    let mut at = start;
    while at < source.len() {
        if source.as_bytes()[at..].starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if source.as_bytes()[at..].starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    source.len()
}
