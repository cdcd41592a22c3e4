//! The registry row in the header of a user's WGSL file: the vocabulary of built-in rows, one statement per line.
//!
//! Input: the source of the file. Output: the row with the source as its template and the spans of its lines, or every error.
//! This module does not use the registry: `codegen` validates passes, axes and functions later.
//!
//! ```text
//! //: storage -- the first k fragments, as they come          the axis and a summary
//! //: paper Carpenter 1984                                    the source of the technique
//! //: buffer taken[pixel < pixels]: word, clear 0 -- slots taken so far
//! //: pass store: taken atomic, entries plain                 a pass of the frame, in order, and its uses
//! //: pass resolve: taken read, entries read
//! //: host allocate: reads offsets[pixels]; sets fragments    a decision of the host between two passes: `name`, all
//!                                                            words; `name[index]`, one; `name[first for count]`, some;
//!                                                            `; lags` if values of an earlier frame will do
//! //: provides keeps-best, indexed                              capabilities
//! //: requires mutual-exclusion, fragment-atomics                      capabilities of other rows, features of targets
//! //: requires u64-atomics when LIMIT > 64                      features that are required under a condition
//! //: when keep <= 64 -- write `keep 64;` or less              a condition on the description, and its fix
//! //: implies sorted when depth_key                            a capability that is provided where a condition holds
//! //: suits sync slot_counter, cull early                     defaults on other axes
//! //: parameter limit LIMIT = 4096, from 1 to 65536, retry limit -- tries
//! //: parameter page PAGE = 4, from 1 to 64, power of two, at least k / 8 -- entries of a page
//! //: parameter by BY = 0, attribute -- an attribute, by its index
//! //: defines n = ceil_div(fragments, pixels) + 1              the default of a symbol
//! //: adds coverage from sample_mask                          a word of every fragment, from a built-in value
//! //: keeps best 1 of each key / 1000                         which fragments are kept, if no capability says so
//! //: hazard torn unless mutual-exclusion -- key and payload of two fragments in one slot
//! //: soundness atomics                                       atomics, interlock, lock or racy
//! ```

mod former;
mod line;
mod properties;
mod reader;
mod resources;
mod statements;
mod steps;
mod symbols;

use std::sync::Arc;

use fragbuf_model::{Diagnostic, Diagnostics, RowSpans, SourceSpan, UserRow, codes};
use fragbuf_templates::vocabulary::{Row, Template};

use line::Line;
use statements::Statements;

/// The mark before every line of a row.
const MARK: &str = "//:";

/// Parses the row of a file. The description refers to the file as `path` and to the row as `key`; messages call it `file`.
pub fn row(source: &str, path: &str, key: &str, file: &str) -> Result<UserRow, Diagnostics> {
    let file: Arc<str> = file.into();
    let (lines, mut diagnostics) = lines(source, &file);
    let Some((first, rest)) = lines.split_first() else {
        let message = "the file header has no registry row";
        let help = "start the file with a line such as `//: storage -- what it does`";
        diagnostics.push(Diagnostic::new(codes::INVALID_ROW, &SourceSpan::new(file, 1, 1), message, help));
        return Err(diagnostics);
    };
    let mut first = Line::new(&file, first.0, first.1, first.2);
    let axis = statements::axis(&mut first, &mut diagnostics);
    // A row without an axis may have another statement on its first line.
    let rest = if axis.is_some() { rest } else { &lines };
    let mut row = Row::new(&axis.unwrap_or_default(), key, first.summary.unwrap_or("").to_owned(), "");
    row.template = Some(Template {
        path: path.to_owned().into(),
        source: without_row(source).into(),
        user_file: Some(file.to_string().into()),
    });
    let spans = RowSpans {
        row: first.span(),
        resources: Vec::new(),
        steps: Vec::new(),
        defaults: Vec::new(),
        parameters: Vec::new(),
    };
    let mut statements = Statements::new(UserRow { row, spans }, diagnostics);
    for (number, line, start) in rest {
        statements.read(Line::new(&file, *number, line, *start));
    }
    statements.finish()
}

/// Returns the lines of the row: number, line, and the end of the mark. A line of the row after the file header is an error.
fn lines<'a>(source: &'a str, file: &Arc<str>) -> (Vec<(u32, &'a str, usize)>, Diagnostics) {
    let (mut lines, mut diagnostics) = (Vec::new(), Diagnostics::new());
    let mut in_header = true;
    for (number, line) in (1..).zip(source.lines()) {
        let trimmed = line.trim_start();
        in_header &= trimmed.is_empty() || trimmed.starts_with("//");
        if !trimmed.starts_with(MARK) {
            continue;
        }
        let start = line.len() - trimmed.len() + MARK.len();
        if in_header {
            lines.push((number, line, start));
        } else {
            let span = Line::new(file, number, line, start).span();
            let message = "a line of the row follows the first declaration";
            diagnostics.push(Diagnostic::new(codes::INVALID_ROW, &span, message, "move it to the file header"));
        }
    }
    (lines, diagnostics)
}

/// Returns the source with the row's lines blank: they are not WGSL, and every other line keeps its number.
fn without_row(source: &str) -> String {
    source.split_inclusive('\n').map(|line| if line.trim_start().starts_with(MARK) { "\n" } else { line }).collect()
}
