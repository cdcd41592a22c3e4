//! The map from lines of a linked source to the files that they come from.

use std::sync::Arc;

use fragbuf_model::SourceSpan;

/// Maps each line of a linked source to its origin, as runs of consecutive lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceMap {
    lines: usize,
    runs: Vec<Run>,
}

/// Lines from `first` (counted from 1) to the next run.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    first: usize,
    source: LineSource,
}

/// The origin of one line.
#[derive(Clone, Debug, PartialEq)]
pub enum LineSource {
    /// Headers, banners and blank lines.
    None,
    /// A template or generated source, by name and line.
    Source {
        /// `storage/max_array.wgsl`, `generated/buffers`.
        name: Arc<str>,
        /// From 1.
        line: usize,
    },
    /// The user's description, by span.
    Description(SourceSpan),
    /// A user file: the span of the line without surrounding spaces. The text is the same unless names were replaced.
    UserFile(SourceSpan),
}

impl SourceMap {
    /// Appends lines without an origin.
    pub(crate) fn skip(&mut self, lines: usize) {
        self.run(lines, LineSource::None);
    }

    /// Appends lines: the first has the origin `source`, the next ones the lines after it.
    pub(crate) fn run(&mut self, lines: usize, source: LineSource) {
        self.runs.push(Run { first: self.lines + 1, source });
        self.lines += lines;
    }

    /// Returns the position in the description, a user file or a template that the first of these lines with an origin comes from.
    /// Generated accessors are skipped.
    pub fn location(&self, lines: &[usize]) -> Option<String> {
        lines.iter().find_map(|line| match self.source(*line) {
            LineSource::Source { name, line } if !name.starts_with("generated/") => Some(format!("{name}:{line}")),
            LineSource::Description(span) => Some(span.to_string()),
            LineSource::UserFile(span) => Some(format!("{}:{}", span.file, span.line)),
            _ => None,
        })
    }

    /// Returns the origin of a line, counted from 1.
    pub fn source(&self, line: usize) -> LineSource {
        let index = self.runs.partition_point(|run| run.first <= line);
        let Some(run) = index.checked_sub(1).map(|index| &self.runs[index]).filter(|_| line <= self.lines) else {
            return LineSource::None;
        };
        match &run.source {
            LineSource::Source { name, line: first } => {
                LineSource::Source { name: name.clone(), line: first + line - run.first }
            }
            other => other.clone(),
        }
    }
}
