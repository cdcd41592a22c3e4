//! The state of printing one function: its plan, its names in scope, its lines so far.
//!
//! In: a function and the plan made for it. Out: the lines of its body. What each expression and statement becomes is in
//! `expression` and `statement`; here are only scopes, lines and comments.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Block, Expression, Function, Handle, LocalVariable, Span};

use crate::analysis::Order;
use crate::footprint::Calls;
use crate::interface::Interface;
use crate::locals::{Declarations, declarations};
use crate::names::{free, legal};
use crate::printer::Printer;
use crate::reserved::is_reserved;
use crate::schedule::{Plan, plan};

/// What a `continue` of the innermost loop must do first.
#[derive(Clone, Copy)]
pub struct Continuing<'m> {
    pub block: Option<&'m Block>,
    pub break_if: Option<Handle<Expression>>,
    /// How many `switch` statements the current place is inside of, within the loop.
    pub switches: usize,
}

pub struct FunctionPrinter<'p, 'm> {
    pub printer: &'p mut Printer<'m>,
    pub function: &'m Function,
    pub order: Order<'m>,
    pub plan: Plan,
    pub declarations: Declarations,
    /// How arguments and results print, in an entry point.
    pub interface: Option<Interface>,
    pub arguments: Vec<String>,
    pub values: BTreeMap<Handle<Expression>, String>,
    pub locals: BTreeMap<Handle<LocalVariable>, String>,
    pub loops: Vec<Continuing<'m>>,
    pub lines: Vec<String>,
    depth: usize,
    scopes: Vec<BTreeSet<String>>,
    /// The line that opened the current block, after which no blank line is wanted.
    opened: usize,
}

impl<'p, 'm> FunctionPrinter<'p, 'm> {
    pub fn new(
        printer: &'p mut Printer<'m>,
        function: &'m Function,
        info: &'m naga::valid::FunctionInfo,
        calls: &Calls,
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

    /// Takes a name for a variable declared here, unlike every name that can be seen from here.
    pub fn declare(&mut self, wanted: &str) -> String {
        let taken =
            |name: &str| self.printer.names.is_taken(name) || self.scopes.iter().any(|scope| scope.contains(name));
        let name = free(&legal(wanted, is_reserved), taken);
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name.clone());
        }
        name
    }

    pub fn line(&mut self, text: impl AsRef<str>) {
        self.lines.push(format!("{}{}", "    ".repeat(self.depth), text.as_ref()));
    }

    /// Adds to the end of the last line.
    pub fn amend(&mut self, text: &str) {
        if let Some(last) = self.lines.last_mut() {
            last.push_str(text);
        }
    }

    /// Opens a scope without printing anything, as for the header of a `for`.
    pub fn enter(&mut self) {
        self.scopes.push(BTreeSet::new());
    }

    pub fn leave(&mut self) {
        self.scopes.pop();
    }

    /// Opens a block: what follows is indented and has a scope of its own.
    pub fn open(&mut self) {
        self.enter();
        self.depth += 1;
        self.opened = self.lines.len();
    }

    pub fn close(&mut self) {
        self.depth -= 1;
        self.leave();
    }

    /// Prints what stands above a statement in the source: a free line, comments.
    pub fn lead(&mut self, span: Span) {
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        if self.printer.comments.paragraph_before(range.start) && self.lines.len() > self.opened {
            self.lines.push(String::new());
        }
        for comment in self.printer.comments.before(range.start) {
            self.line(comment);
        }
    }

    /// As [`Self::lead`], for a statement of one line: comments between its parts go above it too.
    pub fn lead_whole(&mut self, span: Span) {
        self.lead(span);
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        for comment in self.printer.comments.within(range.start, range.end) {
            self.line(comment);
        }
    }

    /// Adds the comment that follows a statement on its line.
    pub fn trail(&mut self, span: Span) {
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        if let Some(comment) = self.printer.comments.behind(range.end) {
            self.amend(&format!(" {comment}"));
        }
    }

    /// Prints the comments at the end of a block.
    pub fn leftover(&mut self, span: Span) {
        let Some(range) = span.to_range().filter(|range| range.end <= self.printer.source.len()) else { return };
        for comment in self.printer.comments.rest(range.start) {
            self.line(comment);
        }
    }

    pub fn span(&self, expression: Handle<Expression>) -> Span {
        self.function.expressions.get_span(expression)
    }

    /// What the source has in the place of an expression.
    pub fn written(&self, expression: Handle<Expression>) -> &'m str {
        let range = self.span(expression).to_range();
        range.and_then(|range| self.printer.source.get(range)).unwrap_or_default()
    }

    pub fn error(&mut self, what: impl Into<String>, expression: Handle<Expression>) -> String {
        let span = self.span(expression);
        self.printer.error(what, span)
    }
}
