//! Prints control flow: `if`, `switch`, loops, jumps.
//!
//! Input: naga's loops, which have a body, a continuing block and a `break if`. Output: `for` and `while` if the loop begins
//! with a test, as naga lowers them; else `while (true)`. The continuing block runs at the end of each iteration and before
//! each `continue`. A single statement prints as the third part of a `for`; a longer block prints at each of these
//! positions.
//!
//! In the dialects of OpenGL, `while (a && b)` prints as `while (a) { if (!b) { break; }`. Mesa 22.3.6 miscompiles the
//! first form if `b` reads an element of an array of structs that the body reads again: the second read gives zero.

use naga::{BinaryOperator, Block, Expression, Handle, Span, Statement, SwitchCase, SwitchValue};

use crate::function::{FunctionPrinter, LoopContext};

impl<'m> FunctionPrinter<'_, 'm> {
    /// Prints an `if`, with its `else` branches.
    pub fn if_statement(
        &mut self,
        condition: Handle<Expression>,
        accept: &'m Block,
        reject: &'m Block,
        span: Span,
        tail: bool,
    ) {
        self.print_comments_above(span);
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
        self.open_block();
        self.statements(block, tail);
        self.close_block();
    }

    /// Prints the rest of an `if`, from its first `}`.
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

    /// Returns condition and branches of an `else` that contains only another `if`.
    fn else_if(&self, reject: &'m Block) -> Option<(Handle<Expression>, &'m Block, &'m Block)> {
        let mut rest = reject.iter().filter(|statement| !self.is_silent(statement));
        let Some(statement @ Statement::If { condition, accept, reject }) = rest.next() else { return None };
        let step = self.order.step_of(statement);
        let alone = rest.next().is_none();
        let plain = !self.plan.short_circuit_steps.contains_key(&step)
            && !self.declarations.before.contains_key(&step)
            && !accept.is_empty();
        (alone && plain).then_some((*condition, accept, reject))
    }

    /// Prints a `switch`.
    pub fn switch(&mut self, selector: Handle<Expression>, cases: &'m [SwitchCase], span: Span) {
        self.print_comments_above(span);
        let selector = self.expression(selector);
        self.line(format!("switch ({selector}) {{"));
        if let Some(context) = self.loops.last_mut() {
            context.switches += 1;
        }
        self.open_block();
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
            self.open_block();
            self.statements(&case.body, false);
            if !case.fall_through && !ends_in_jump(&case.body) {
                self.line("break;");
            }
            self.close_block();
            self.line("}");
        }
        self.close_block();
        if let Some(context) = self.loops.last_mut() {
            context.switches -= 1;
        }
        self.line("}");
    }

    /// Prints `break`, `continue` or `discard`.
    pub fn jump(&mut self, statement: &Statement, span: Span) {
        self.print_comments_above(span);
        match statement {
            Statement::Continue => self.continue_statement(span),
            Statement::Kill => self.line("discard;"),
            _ => self.line("break;"),
        }
        self.append_comment_after(span);
    }

    /// Prints a `continue`, after what the loop does at the end of an iteration.
    fn continue_statement(&mut self, span: Span) {
        if let Some(context) = self.loops.last().copied() {
            if context.break_if.is_some() && context.switches > 0 {
                self.printer.error("`continue` inside a `switch`, in a loop with `break if`", span);
            }
            self.end_of_iteration(context);
        }
        self.line("continue;");
    }

    /// Prints the continuing block and the `break if` of a loop.
    fn end_of_iteration(&mut self, context: LoopContext<'m>) {
        if let Some(block) = context.block {
            self.statements(block, false);
        }
        if let Some(condition) = context.break_if {
            let condition = self.expression(condition);
            self.exit_if(&condition);
        }
    }

    fn exit_if(&mut self, condition: &str) {
        self.line(format!("if ({condition}) {{"));
        self.line("    break;");
        self.line("}");
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
            self.print_comments_above(span);
        }
        let (start, mut tests) = match self.leading_test(body) {
            Some((index, condition)) => (index + 1, self.tests(condition).into_iter()),
            None => (0, Vec::new().into_iter()),
        };
        let condition = tests.next().map(|condition| self.expression(condition));
        let exits: Vec<String> = tests.map(|condition| self.negated(condition)).collect();
        let update = if break_if.is_none() { self.single_update(body, continuing) } else { None };
        let context = LoopContext { block: Some(continuing), break_if, switches: 0 };
        let has_end = update.is_none() && (!continuing.is_empty() || break_if.is_some());
        let without_end = LoopContext { block: None, break_if: None, switches: 0 };

        self.line(header(initialiser, condition, update));
        self.loops.push(if has_end { context } else { without_end });
        self.open_block();
        for exit in exits {
            self.exit_if(&exit);
        }
        self.loop_body(body, start);
        if has_end && !ends_in_jump(body) {
            self.end_of_iteration(context);
        }
        self.close_block();
        self.loops.pop();
        self.line("}");
        if opened {
            self.leave_scope();
        }
    }

    /// Prints the body of a loop. naga lowers the body of a `for` or `while` to a separate block, whose braces are the
    /// loop's braces.
    fn loop_body(&mut self, body: &'m Block, start: usize) {
        if let Some(Statement::Block(inner)) = body.get(start)
            && body.len() == start + 1
        {
            self.statements(inner, false);
        } else {
            self.statements_from(body, start, false);
        }
    }

    /// Returns index and condition of an `if c {} else { break; }` at the beginning of a loop, with no output before it.
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

    /// Returns the tests of a loop: the condition, or in the dialects of OpenGL each operand of its `&&`.
    fn tests(&self, condition: Handle<Expression>) -> Vec<Handle<Expression>> {
        let circuit = self.plan.short_circuits.get(&condition);
        let is_printed_here = !self.values.contains_key(&condition) && !self.printer.vulkan();
        match circuit.filter(|circuit| is_printed_here && circuit.operator == BinaryOperator::LogicalAnd) {
            Some(circuit) => [self.tests(circuit.left), self.tests(circuit.right)].concat(),
            None => vec![condition],
        }
    }

    /// Prints the continuing block, if it is a single statement that uses no variable declared in the body.
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

    /// Tests whether the continuing block can access a variable of the body, which a `for` header cannot. In naga's lowering
    /// of a `for`, the variables of the body go out of scope before the continuing block.
    fn declares_for(&self, body: &Block) -> bool {
        let mut visible = body.iter().filter(|statement| !self.is_silent(statement));
        visible.any(|statement| match statement {
            Statement::Emit(_) => true,
            Statement::Call { result: Some(result), .. } | Statement::Atomic { result: Some(result), .. } => {
                self.plan.baked[*result]
            }
            Statement::Store { .. } => self.declarations.by_store.contains_key(&self.order.step_of(statement)),
            _ => false,
        })
    }

    /// Prints a `return`; in an entry point, the assignments to the outputs.
    pub fn return_statement(&mut self, value: Option<Handle<Expression>>, span: Span, tail: bool) {
        // naga adds a return at the end of a function; GLSL needs none.
        let implied = value.is_none() && tail;
        if implied {
            return;
        }
        self.print_all_comments_of(span);
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
        self.append_comment_after(span);
    }
}

/// Prints the header of a loop.
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

/// Tests whether control never reaches the end of a block.
fn ends_in_jump(block: &Block) -> bool {
    match block.last() {
        Some(Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill) => true,
        Some(Statement::Block(inner)) => ends_in_jump(inner),
        Some(Statement::If { accept, reject, .. }) => ends_in_jump(accept) && ends_in_jump(reject),
        _ => false,
    }
}
