//! Control flow: `if`, `switch`, loops, jumps.
//!
//! In: naga's loops, which have a body, a continuing block and a `break if`. Out: `for` and `while` where the loop begins
//! with a test, as naga lowers them; else `while (true)`. The continuing block runs at the end of each iteration and before
//! each `continue`: as the third part of a `for` if it is a single statement, written out at each of these places if not.

use naga::{Block, Expression, Handle, Span, Statement, SwitchCase, SwitchValue};

use crate::function::{Continuing, FunctionPrinter};

impl<'m> FunctionPrinter<'_, 'm> {
    pub fn if_statement(
        &mut self,
        condition: Handle<Expression>,
        accept: &'m Block,
        reject: &'m Block,
        span: Span,
        tail: bool,
    ) {
        self.lead(span);
        let (condition, accept, reject) = if accept.is_empty() && !reject.is_empty() {
            (self.negated(condition), reject, accept)
        } else {
            (self.expression(condition), accept, reject)
        };
        self.line(format!("if ({condition}) {{"));
        self.branch(accept, tail);
        self.else_branch(reject, tail);
    }

    fn branch(&mut self, block: &'m Block, tail: bool) {
        self.open();
        self.statements(block, tail);
        self.close();
    }

    fn else_branch(&mut self, reject: &'m Block, tail: bool) {
        // At the end of a function, naga adds a return to each branch.
        let implied = |statement: &Statement| tail && matches!(statement, Statement::Return { value: None });
        if reject.iter().all(implied) {
            self.line("}");
            return;
        }
        if let Some((condition, accept, next)) = self.else_if(reject) {
            let condition = self.expression(condition);
            self.line(format!("}} else if ({condition}) {{"));
            self.branch(accept, tail);
            self.else_branch(next, tail);
            return;
        }
        self.line("} else {");
        self.branch(reject, tail);
        self.line("}");
    }

    /// An `else` that holds nothing but another `if`.
    fn else_if(&self, reject: &'m Block) -> Option<(Handle<Expression>, &'m Block, &'m Block)> {
        let mut rest = reject.iter().filter(|statement| !self.is_silent(statement));
        let Some(statement @ Statement::If { condition, accept, reject }) = rest.next() else { return None };
        let step = self.order.step_of(statement);
        let alone = rest.next().is_none();
        let plain = !self.plan.circuit_steps.contains_key(&step)
            && !self.declarations.before.contains_key(&step)
            && !accept.is_empty();
        (alone && plain).then_some((*condition, accept, reject))
    }

    pub fn switch(&mut self, selector: Handle<Expression>, cases: &'m [SwitchCase], span: Span) {
        self.lead(span);
        let selector = self.expression(selector);
        self.line(format!("switch ({selector}) {{"));
        if let Some(continuing) = self.loops.last_mut() {
            continuing.switches += 1;
        }
        self.open();
        for case in cases {
            let label = match case.value {
                SwitchValue::I32(value) => format!("case {value}:"),
                SwitchValue::U32(value) => format!("case {value}u:"),
                SwitchValue::Default => "default:".to_owned(),
            };
            if case.fall_through && case.body.is_empty() {
                self.line(label);
                continue;
            }
            self.line(format!("{label} {{"));
            self.open();
            self.statements(&case.body, false);
            if !case.fall_through && !ends_in_jump(&case.body) {
                self.line("break;");
            }
            self.close();
            self.line("}");
        }
        self.close();
        if let Some(continuing) = self.loops.last_mut() {
            continuing.switches -= 1;
        }
        self.line("}");
    }

    pub fn jump(&mut self, statement: &Statement, span: Span) {
        self.lead(span);
        match statement {
            Statement::Continue => self.continue_statement(span),
            Statement::Kill => self.line("discard;"),
            _ => self.line("break;"),
        }
        self.trail(span);
    }

    fn continue_statement(&mut self, span: Span) {
        let continuing = self.loops.last().copied();
        if let Some(continuing) = continuing {
            if continuing.break_if.is_some() && continuing.switches > 0 {
                self.printer.error("`continue` inside a `switch`, in a loop with `break if`", span);
            }
            self.continuing(continuing);
        }
        self.line("continue;");
    }

    /// Writes out what a loop does at the end of an iteration.
    fn continuing(&mut self, continuing: Continuing<'m>) {
        if let Some(block) = continuing.block {
            self.statements(block, false);
        }
        if let Some(condition) = continuing.break_if {
            let condition = self.expression(condition);
            self.line(format!("if ({condition}) {{"));
            self.line("    break;");
            self.line("}");
        }
    }

    /// Prints a loop; an initialiser has already opened the scope of a `for`.
    pub fn loop_statement(
        &mut self,
        body: &'m Block,
        continuing: &'m Block,
        break_if: Option<Handle<Expression>>,
        span: Span,
        initialiser: Option<String>,
    ) {
        let opened = initialiser.is_some();
        if !opened {
            self.lead(span);
        }
        let (start, condition) = match self.leading_test(body) {
            Some((index, condition)) => (index + 1, Some(self.expression(condition))),
            None => (0, None),
        };
        let update = if break_if.is_none() { self.single_update(body, continuing) } else { None };
        let rest = Continuing { block: Some(continuing), break_if, switches: 0 };
        let needs_rest = update.is_none() && (!continuing.is_empty() || break_if.is_some());
        let nothing = Continuing { block: None, break_if: None, switches: 0 };

        self.line(header(initialiser, condition, update));
        self.loops.push(if needs_rest { rest } else { nothing });
        self.open();
        self.loop_body(body, start);
        if needs_rest && !ends_in_jump(body) {
            self.continuing(rest);
        }
        self.close();
        self.loops.pop();
        self.line("}");
        if opened {
            self.leave();
        }
    }

    /// naga puts the braces of a `for` or `while` in a block of their own; they are the loop's braces.
    fn loop_body(&mut self, body: &'m Block, start: usize) {
        if let Some(Statement::Block(inner)) = body.get(start)
            && body.len() == start + 1
        {
            self.statements(inner, false);
        } else {
            self.statements_from(body, start, false);
        }
    }

    /// `if c {} else { break; }` at the beginning of a loop, with nothing to print before it.
    fn leading_test(&self, body: &Block) -> Option<(usize, Handle<Expression>)> {
        let (index, first) = body.iter().enumerate().find(|(_, statement)| !self.is_silent(statement))?;
        match first {
            Statement::If { condition, accept, reject }
                if accept.is_empty()
                    && matches!(reject[..], [Statement::Break])
                    && !self.declarations.before.contains_key(&self.order.step_of(first)) =>
            {
                Some((index, *condition))
            }
            _ => None,
        }
    }

    /// The continuing block, if it is a single statement that uses nothing declared in the body.
    fn single_update(&mut self, body: &Block, continuing: &'m Block) -> Option<String> {
        let mut visible = continuing.iter().filter(|statement| !self.is_silent(statement));
        let update = visible.next()?;
        let simple = matches!(update, Statement::Store { .. } | Statement::Call { .. } | Statement::Atomic { .. });
        let declares = self.declarations.by_store.contains_key(&self.order.step_of(update));
        if visible.next().is_some() || !simple || declares || self.declares_for(body) {
            return None;
        }
        self.simple(update)
    }

    /// Whether the continuing block may see a variable of the body, which a `for` header cannot. In naga's lowering of a
    /// `for` the body is a block of its own, whose names end with it.
    fn declares_for(&self, body: &Block) -> bool {
        let own = body.iter().filter(|statement| !self.is_silent(statement));
        own.into_iter().any(|statement| match statement {
            Statement::Emit(_) => true,
            Statement::Call { result: Some(result), .. } | Statement::Atomic { result: Some(result), .. } => {
                self.plan.baked.contains(result)
            }
            Statement::Store { .. } => self.declarations.by_store.contains_key(&self.order.step_of(statement)),
            _ => false,
        })
    }

    pub fn return_statement(&mut self, value: Option<Handle<Expression>>, span: Span, tail: bool) {
        // naga adds the return at the end of a function; in GLSL it goes without saying.
        let implied = value.is_none() && tail;
        if implied {
            return;
        }
        self.lead_whole(span);
        match value {
            Some(value) if self.interface.is_some() => {
                self.write_outputs(value);
                if !tail {
                    self.line("return;");
                }
            }
            Some(value) => {
                let value = self.expression(value);
                self.line(format!("return {value};"));
            }
            None => self.line("return;"),
        }
        self.trail(span);
    }
}

fn header(initialiser: Option<String>, condition: Option<String>, update: Option<String>) -> String {
    match (initialiser, condition, update) {
        (None, None, None) => "while (true) {".to_owned(),
        (None, Some(condition), None) => format!("while ({condition}) {{"),
        (initialiser, condition, update) => {
            let spaced = |part: Option<String>| part.map(|part| format!(" {part}")).unwrap_or_default();
            format!("for ({};{};{}) {{", initialiser.unwrap_or_default(), spaced(condition), spaced(update))
        }
    }
}

/// Whether control never reaches the end of a block.
fn ends_in_jump(block: &Block) -> bool {
    match block.last() {
        Some(Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill) => true,
        Some(Statement::Block(inner)) => ends_in_jump(inner),
        Some(Statement::If { accept, reject, .. }) => ends_in_jump(accept) && ends_in_jump(reject),
        _ => false,
    }
}
