//! The statements of a row.
//!
//! Input: lines. Output: the row, or every error.

use fragbuf_model::{Diagnostic, Diagnostics, SourceSpan, Spanned, UserRow, codes};

use super::former;
use super::line::Line;
use super::reader::{Read, Reader};
use crate::report::{FIRST, Stop};
use crate::unknown_name;

/// The keywords that start a line.
const KEYWORDS: [&str; 16] = [
    "paper",
    "buffer",
    "pass",
    "host",
    "uses",
    "provides",
    "requires",
    "when",
    "implies",
    "suits",
    "parameter",
    "defines",
    "adds",
    "keeps",
    "hazard",
    "soundness",
];

/// Parses the first line of a row: its axis and its summary.
pub(super) fn axis(line: &mut Line<'_>, diagnostics: &mut Diagnostics) -> Option<String> {
    let span = line.here();
    let name = line.name().filter(|name| !KEYWORDS.contains(&name.value.as_str()));
    if let (Some(name), true, Some(_)) = (&name, line.is_done(), line.summary) {
        return Some(name.value.clone());
    }
    let message = "expected an axis, and a summary after ` -- `";
    let help = "write a first line such as `//: storage -- the first k fragments, as they come`";
    diagnostics.push(Diagnostic::new(codes::INVALID_ROW, &span, message, help));
    None
}

/// The row so far.
pub(super) struct Statements {
    pub(super) user_row: UserRow,
    /// The buffers that lines declare, including those with errors.
    pub(super) declared: Vec<String>,
    /// Whether a line is no statement: it may declare anything.
    has_unknown_line: bool,
    /// The buffers that lines refer to.
    pub(super) used: Vec<Spanned<String>>,
    /// The statements and names that a row may give only once, with the span of each.
    given: Vec<(String, SourceSpan)>,
    pub(super) reader: Reader,
}

/// The statements that a row may give only once: a second would replace the first.
const SINGLE: [&str; 5] = ["paper", "provides", "uses", "keeps", "soundness"];

/// The help for a statement that must be on one line.
const MERGE: &str = "merge the two lines, or remove one of them";

impl Statements {
    /// Returns the state after the first line.
    pub(super) fn new(user_row: UserRow, diagnostics: Diagnostics) -> Self {
        Statements {
            user_row,
            declared: Vec::new(),
            has_unknown_line: false,
            used: Vec::new(),
            given: Vec::new(),
            reader: Reader { diagnostics, item_spans: Vec::new() },
        }
    }

    /// Returns the row, or every error.
    pub(super) fn finish(mut self) -> Result<UserRow, Diagnostics> {
        let is_missing = |used: &&Spanned<String>| !self.has_unknown_line && !self.declared.contains(&used.value);
        for used in self.used.iter().filter(is_missing) {
            let message = format!("cannot find buffer `{}` in this row", used.value);
            let help = match self.declared.as_slice() {
                [] => format!("declare it: `//: buffer {}[pixel < pixels]: word`", used.value),
                names => unknown_name::help(&used.value, names),
            };
            self.reader.error(codes::UNKNOWN_RESOURCE, &used.span, message, help);
        }
        self.user_row.row.item_spans = self.reader.item_spans;
        self.reader.diagnostics.into_result(self.user_row)
    }

    /// Parses one line.
    pub(super) fn read(&mut self, mut line: Line<'_>) {
        if self.statement(&mut line).is_ok() && !line.is_done() {
            let message = format!("unexpected {} after the statement", line.describe());
            let help = "remove it; write each statement on a separate line";
            self.reader.error(codes::INVALID_ROW, &line.here(), message, help);
        }
    }

    fn statement(&mut self, line: &mut Line<'_>) -> Read<()> {
        let mut keyword = self.reader.name(line, "a statement", "`buffer`, `pass`, `provides`")?;
        keyword.value = former::present(&keyword.value).to_owned();
        if SINGLE.contains(&keyword.value.as_str()) {
            // Other errors of the line are reported, too.
            let _ = self.once(&keyword.value, &keyword.span, MERGE);
        }
        let row = &mut self.user_row.row;
        match keyword.value.as_str() {
            "paper" => row.paper = line.until(&[]).value.into(),
            "provides" => row.provides = self.reader.capabilities(line)?,
            "requires" => return self.requires(line, &keyword.span),
            "uses" => self.user_row.row.uses = self.uses(line)?,
            "buffer" => return self.buffer(line),
            "pass" => return self.pass(line),
            "host" => return self.host(line),
            "when" => return self.when(line),
            "implies" => return self.implies(line),
            "suits" => return self.suits(line),
            "parameter" => return self.parameter(line),
            "defines" => return self.defines(line),
            "adds" => return self.adds(line),
            "keeps" => return self.keeps(line),
            "hazard" => return self.hazard(line),
            "soundness" => return self.soundness(line),
            // The first line of a row without an axis: `axis` reported it.
            _ if row.axis.is_empty() && line.span() == self.user_row.spans.row => return Err(Stop),
            unknown => {
                self.has_unknown_line = true;
                let message = format!("expected a statement, found `{unknown}`");
                return self.reader.stop(
                    codes::INVALID_ROW,
                    &keyword.span,
                    message,
                    unknown_name::help(unknown, &KEYWORDS),
                );
            }
        }
        Ok(())
    }

    /// Reports a statement or name that the row already has.
    pub(super) fn once(&mut self, what: &str, at: &SourceSpan, help: &str) -> Read<()> {
        let Some((_, first)) = self.given.iter().find(|(given, _)| given == what) else {
            self.given.push((what.to_owned(), at.clone()));
            return Ok(());
        };
        let diagnostic = Diagnostic::new(codes::DUPLICATE, at, format!("duplicate `{what}`"), help);
        self.reader.diagnostics.push(diagnostic.label(first, FIRST));
        Err(Stop)
    }

    /// Parses `requires capability, feature` or `requires feature when condition`.
    fn requires(&mut self, line: &mut Line<'_>, keyword: &SourceSpan) -> Read<()> {
        let list = line.here();
        let (capabilities, features) = self.reader.requirements(line)?;
        if !line.keyword("when") {
            let _ = self.once("requires", keyword, MERGE);
            self.user_row.row.requires = capabilities;
            // A word that the row adds needs a feature, too.
            self.user_row.row.needs.extend(features);
            return Ok(());
        }
        let constants = self.user_row.row.parameters.iter().map(|parameter| parameter.constant.to_string()).collect();
        let condition = self.reader.condition_with(line, constants)?;
        if let Some(capability) = capabilities.first() {
            let message = format!("the capability `{}` cannot be required under a condition", capability.name());
            let help = "conditions apply to features of targets; remove `when` and its condition";
            return self.reader.stop(codes::INVALID_ROW, &list, message, help);
        }
        self.user_row.row.needs_if.extend(features.into_iter().map(|feature| (condition.clone(), feature)));
        Ok(())
    }

    /// Parses `suits axis value, …`.
    fn suits(&mut self, line: &mut Line<'_>) -> Read<()> {
        loop {
            let axis = self.reader.name(line, "an axis", "`suits cull early`")?;
            let value = self.reader.name(line, "a value", "`suits cull early`")?;
            self.once(&format!("suits {}", axis.value), &axis.span, "remove one of them")?;
            self.user_row.row.defaults.push((axis.value.into(), value.value.into()));
            self.user_row.spans.defaults.push(value.span);
            if !line.punct(',') {
                return Ok(());
            }
        }
    }
}

/// Returns the summary after ` -- `.
pub(super) fn summary(line: &Line<'_>) -> String {
    line.summary.unwrap_or("from a user file").to_owned()
}
