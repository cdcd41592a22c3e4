//! Spans in the user's source.

use std::fmt;
use std::sync::Arc;

/// A span in the user's source. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SourceSpan {
    /// The file name as the user wrote it.
    pub file: Arc<str>,
    /// Line, from 1.
    pub line: u32,
    /// Column, from 1, in characters.
    pub column: u32,
    /// The number of characters on the first line, at least 1.
    pub length: u32,
}

impl SourceSpan {
    /// Creates a span of one character.
    pub fn new(file: impl Into<Arc<str>>, line: u32, column: u32) -> Self {
        SourceSpan { file: file.into(), line, column, length: 1 }
    }

    /// Sets the length to `length` characters.
    pub fn with_length(mut self, length: u32) -> Self {
        self.length = length.max(1);
        self
    }
}

impl fmt::Display for SourceSpan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

/// A value with its span. Equality compares only the values: the same description has other spans in each front end.
#[derive(Clone, Debug)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its span.
    pub span: SourceSpan,
}

impl<T> Spanned<T> {
    /// Creates a value with a span.
    pub fn new(value: T, span: SourceSpan) -> Self {
        Spanned { value, span }
    }
}

impl<T: PartialEq> PartialEq for Spanned<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: Eq> Eq for Spanned<T> {}
