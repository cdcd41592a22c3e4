//! The row in the head of a user's own WGSL file: the vocabulary of the registry's rows, a statement a line.
//!
//! In: the file's text. Out: the row, with the text as its template and its lines' places, or every mistake at its line
//! and column. Nothing here looks anything up in the registry: whether passes, axes and functions exist is decided when
//! the row is adopted.
//!
//! ```text
//! //: storage -- the first k fragments, as they come          the axis, and what the file does
//! //: paper Carpenter 1984                                    where it comes from
//! //: buffer taken[pixel < pixels]: word, clear 0 -- places given out so far
//! //: pass store: taken atomic, entries plain                 a pass of the frame, in order, and what it touches
//! //: pass resolve: taken read, entries read
//! //: host allocate: reads offsets[pixels]; sets fragments    a decision of the host between two passes: `name`, all
//!                                                            words; `name[index]`, one; `name[first for count]`, some
//! //: offers keeps-best, indexed                              facts
//! //: requires critical, fragment-atomics                      facts of other rows, capabilities of targets
//! //: when keep <= 64 -- write `keep 64;` or less              a condition on the description, and how to meet it
//! //: implies sorted when depth_key                            a fact that is offered where a condition holds
//! //: suits sync slot_counter, cull early                     values on other axes when nobody says another
//! //: parameter limit LIMIT = 4096, from 1 to 65536 -- tries
//! //: keeps best 1 of each key / 1000                         which fragments stay, where no fact says so
//! //: hazard torn unless critical -- key and payload of two fragments in one slot
//! //: soundness atomics                                       atomics, interlock, lock or racy
//! ```

mod line;
mod promises;
mod reader;
mod statements;

use std::sync::Arc;

use fragbuf_model::{Diagnostic, Diagnostics, Origin, OwnRow, RowPlaces, codes};
use fragbuf_templates::vocabulary::{Row, Template};

use line::Line;
use statements::Statements;

/// Before every line of a row.
const SIGN: &str = "//:";

/// Reads the row of a file. `path` is what the description calls the file, and `key` the row; `file` is its name in
/// messages.
pub fn row(text: &str, path: &str, key: &str, file: &str) -> Result<OwnRow, Diagnostics> {
    let file: Arc<str> = file.into();
    let (lines, mut faults) = lines(text, &file);
    let Some((first, rest)) = lines.split_first() else {
        let message = "the file's head has no row";
        let hint = "begin it with a line such as `//: storage -- what it does`";
        faults.push(Diagnostic::new(codes::ROW, &Origin::new(file, 1, 1), message, hint));
        return Err(faults);
    };
    let mut first = Line::new(&file, first.0, first.1, first.2);
    let axis = statements::axis(&mut first, &mut faults);
    // A row that forgets its axis says something else on its first line.
    let rest = if axis.is_some() { rest } else { &lines };
    let mut row = Row::new(&axis.unwrap_or_default(), key, first.summary.unwrap_or("").to_owned(), "");
    row.template = Some(Template {
        path: path.to_owned().into(),
        text: without_row(text).into(),
        own: Some(file.to_string().into()),
    });
    let places = RowPlaces {
        row: first.origin(),
        resources: Vec::new(),
        steps: Vec::new(),
        defaults: Vec::new(),
        parameters: Vec::new(),
    };
    let mut statements = Statements::new(OwnRow { row, places }, faults);
    for (number, text, start) in rest {
        statements.read(Line::new(&file, *number, text, *start));
    }
    statements.finish()
}

/// The lines of the row: number, text, and where the sign ends. A line of a row behind the head is a mistake.
fn lines<'a>(text: &'a str, file: &Arc<str>) -> (Vec<(u32, &'a str, usize)>, Diagnostics) {
    let (mut lines, mut faults) = (Vec::new(), Diagnostics::new());
    let mut in_head = true;
    for (number, text) in (1..).zip(text.lines()) {
        let trimmed = text.trim_start();
        in_head &= trimmed.is_empty() || trimmed.starts_with("//");
        if !trimmed.starts_with(SIGN) {
            continue;
        }
        let start = text.len() - trimmed.len() + SIGN.len();
        if in_head {
            lines.push((number, text, start));
        } else {
            let origin = Line::new(file, number, text, start).origin();
            let message = "a line of the row stands behind the first declaration";
            faults.push(Diagnostic::new(codes::ROW, &origin, message, "move it to the file's head"));
        }
    }
    (lines, faults)
}

/// The text with the row's lines empty: they are no part of the program, and every other line keeps its number.
fn without_row(text: &str) -> String {
    text.split_inclusive('\n').map(|line| if line.trim_start().starts_with(SIGN) { "\n" } else { line }).collect()
}
