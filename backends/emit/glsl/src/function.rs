//! The state of printing one function: its plan, the names in scope and the printed lines.
//!
//! Input: a function and its plan. Output: the lines of its body. This file handles scopes, lines and comments;
//! `expression` and `statement` print expressions and statements.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Block, Expression, Function, Handle, LocalVariable, Span};

use crate::analysis::Order;
use crate::footprint::CallFootprints;
use crate::interface::Interface;
use crate::locals::{Declarations, declarations};
use crate::names::{legal_unreserved, unique_name};
use crate::printer::Printer;
use crate::schedule::{Plan, plan};

/// A loop that is being printed, with what a `continue` must do first.
#[derive(Clone, Copy)]
pub struct LoopContext<'m> {
    pub block: Option<&'m Block>,
    pub break_if: Option<Handle<Expression>>,
    /// The number of `switch` statements around the current statement, within the loop.
    pub switches: usize,
}

/// The state of printing one function.
pub struct FunctionPrinter<'p, 'm> {
    pub printer: &'p mut Printer<'m>,
    pub function: &'m Function,
    pub order: Order<'m>,
    pub plan: Plan,
    pub declarations: Declarations,
    /// The inputs and outputs of an entry point; none for other functions.
    pub interface: Option<Interface>,
    /// Printed names of the arguments.
    pub arguments: Vec<String>,
    /// Variables of baked expressions.
    pub values: BTreeMap<Handle<Expression>, String>,
    pub locals: BTreeMap<Handle<LocalVariable>, String>,
    pub loops: Vec<LoopContext<'m>>,
    pub lines: Vec<String>,
    depth: usize,
    scopes: Vec<BTreeSet<String>>,
    /// The line that opened the current block. No blank line follows it.
    opened: usize,
}

impl<'p, 'm> FunctionPrinter<'p, 'm> {
    /// Analyses and plans a function; prints nothing yet.
    pub fn new(
        printer: &'p mut Printer<'m>,
        function: &'m Function,
        info: &'m naga::valid::FunctionInfo,
        calls: &CallFootprints,
    ) -> Self {
        let order = Order::new(printer.module, function, info, printer.source, calls);
        let plan = plan(&order);
        let declarations = declarations(&order, &plan);
        Self {
            printer,
            function,
            order,
            plan,
            declarations,
            interface: None,
            arguments: Vec::new(),
            values: BTreeMap::new(),
            locals: BTreeMap::new(),
            loops: Vec::new(),
            lines: Vec::new(),
            depth: 0,
            scopes: vec![BTreeSet::new()],
            opened: 0,
        }
    }

    /// Reserves a name for a new variable that hides no visible name.
    pub fn declare(&mut self, wanted: &str) -> String {
        let taken =
            |name: &str| self.printer.names.is_taken(name) || self.scopes.iter().any(|scope| scope.contains(name));
        let name = unique_name(&legal_unreserved(wanted), taken);
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name.clone());
        }
        name
    }

    /// Prints an indented line.
    pub fn line(&mut self, text: impl AsRef<str>) {
        self.lines.push(format!("{}{}", "    ".repeat(self.depth), text.as_ref()));
    }

    /// Appends text to the last line.
    pub fn append_to_last_line(&mut self, text: &str) {
        if let Some(last) = self.lines.last_mut() {
            last.push_str(text);
        }
    }

    /// Opens a scope without indenting, as for the header of a `for`.
    pub fn enter_scope(&mut self) {
        self.scopes.push(BTreeSet::new());
    }

    /// Closes the innermost scope.
    pub fn leave_scope(&mut self) {
        self.scopes.pop();
    }

    /// Opens a block: indents the following lines and opens a scope.
    pub fn open_block(&mut self) {
        self.enter_scope();
        self.depth += 1;
        self.opened = self.lines.len();
    }

    /// Closes the innermost block.
    pub fn close_block(&mut self) {
        self.depth -= 1;
        self.leave_scope();
    }

    /// Prints the blank line and the comments that the source has above a statement.
    pub fn print_comments_above(&mut self, span: Span) {
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        if self.printer.comments.paragraph_before(range.start) && self.lines.len() > self.opened {
            self.lines.push(String::new());
        }
        for comment in self.printer.comments.before(range.start) {
            self.line(comment);
        }
    }

    /// As [`Self::print_comments_above`], for a statement of one line: comments inside it go above it too.
    pub fn print_all_comments_of(&mut self, span: Span) {
        self.print_comments_above(span);
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        for comment in self.printer.comments.within(range.start, range.end) {
            self.line(comment);
        }
    }

    /// Appends the comment that follows a statement on its line.
    pub fn append_comment_after(&mut self, span: Span) {
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        if let Some(comment) = self.printer.comments.after(range.end) {
            self.append_to_last_line(&format!(" {comment}"));
        }
    }

    /// Prints the remaining comments of the block around a statement.
    pub fn print_comments_to_block_end(&mut self, span: Span) {
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        for comment in self.printer.comments.rest(range.start) {
            self.line(comment);
        }
    }

    /// Returns the span of an expression.
    pub fn span(&self, expression: Handle<Expression>) -> Span {
        self.function.expressions.get_span(expression)
    }

    /// Returns the WGSL source of an expression.
    pub fn source_of(&self, expression: Handle<Expression>) -> &'m str {
        let range = self.span(expression).to_range();
        range.and_then(|range| self.printer.source.get(range)).unwrap_or_default()
    }

    /// Records an error at an expression and returns a substitute for its text.
    pub fn error(&mut self, message: impl Into<String>, expression: Handle<Expression>) -> String {
        let span = self.span(expression);
        self.printer.error(message, span)
    }
}
