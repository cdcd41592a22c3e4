//! Prints blocks, and the statements that are no control flow.
//!
//! Input: a block. Output: its lines. `locals` determines where declarations print; baked expressions get their variable
//! where they are evaluated. Comments of the source print above or after their statement.

use naga::{Barrier, Block, Expression, Handle, Literal, Span, Statement};

use crate::function::FunctionPrinter;
use crate::options::Marker;
use crate::precedence::Text;

impl<'m> FunctionPrinter<'_, 'm> {
    /// Prints the statements of a block. `tail` is true if nothing follows the block in the function.
    pub fn statements(&mut self, block: &'m Block, tail: bool) {
        self.statements_from(block, 0, tail);
    }

    /// As [`Self::statements`], beginning at a statement of the block.
    pub fn statements_from(&mut self, block: &'m Block, start: usize, tail: bool) {
        let statements: Vec<(&'m Statement, Span)> =
            block.span_iter().map(|(statement, span)| (statement, *span)).collect();
        let mut initialiser = None;
        for (index, (statement, span)) in statements.iter().copied().enumerate().skip(start) {
            let last = index + 1 == statements.len();
            if let Some(text) = self.initialiser_before(statement, span, &statements[index + 1..]) {
                initialiser = Some(text);
                continue;
            }
            initialiser = initialiser.or(self.declarations_before(statement, span));
            if let Statement::Loop { body, continuing, break_if } = statement {
                self.loop_statement(body, continuing, *break_if, span, initialiser.take());
            } else {
                self.statement(statement, span, tail && last);
            }
        }
        let last = statements
            .iter()
            .skip(start)
            .rev()
            .find(|(statement, span)| span.is_defined() && !matches!(statement, Statement::Block(_)));
        if let Some((_, span)) = last {
            self.print_comments_to_block_end(*span);
        }
    }

    /// Returns the first part of a `for` header, if the source of the statement lies inside the following loop.
    fn initialiser_before(
        &mut self,
        statement: &'m Statement,
        span: Span,
        rest: &[(&'m Statement, Span)],
    ) -> Option<String> {
        let (header, loop_span) = rest.iter().find(|(next, _)| !self.is_silent(next))?;
        let simple =
            matches!(statement, Statement::Store { .. } | Statement::Call { .. }) && !self.is_silent(statement);
        let for_loop = matches!(header, Statement::Loop { .. }) && contains(*loop_span, span);
        // The scope of a variable that the header declares ends with the loop.
        let declared = self
            .declarations
            .by_store
            .get(&self.order.step_of(statement))
            .map(|local| self.function.local_variables.get_span(*local));
        let outlives = declared.is_some_and(|declared| !contains(*loop_span, declared));
        if !simple || !for_loop || outlives || self.is_long_zero(statement) {
            return None;
        }
        // This statement moves into the header, so the declarations before it come first.
        self.declarations_before(statement, span);
        self.declarations_above(header, *loop_span);
        self.print_comments_above(*loop_span);
        self.enter_scope();
        self.simple(statement)
    }

    /// Tests whether a statement sets a long array to zero.
    fn is_long_zero(&self, statement: &Statement) -> bool {
        let Statement::Store { value, .. } = statement else { return false };
        let Expression::ZeroValue(ty) = self.function.expressions[*value] else { return false };
        self.printer.is_long_array(ty)
    }

    /// Tests whether a statement prints nothing at its position.
    pub fn is_silent(&self, statement: &Statement) -> bool {
        let step = self.order.step_of(statement);
        let inlined = |result: &Handle<Expression>| self.plan.live[*result] && !self.plan.baked[*result];
        let silent = match statement {
            Statement::Emit(range) => !range.clone().any(|expression| self.is_baked_here(expression)),
            Statement::If { .. } => self.plan.short_circuit_steps.get(&step).is_some_and(inlined),
            Statement::Call { result: Some(result), .. } | Statement::Atomic { result: Some(result), .. } => {
                inlined(result)
            }
            _ => false,
        };
        silent && !self.declarations.before.contains_key(&step)
    }

    /// Tests whether an `Emit` prints a variable for an expression.
    fn is_baked_here(&self, expression: Handle<Expression>) -> bool {
        self.plan.baked[expression] && !self.plan.short_circuits.contains_key(&expression)
    }

    /// Prints a statement other than a loop.
    fn statement(&mut self, statement: &'m Statement, span: Span, tail: bool) {
        if self.is_silent(statement) {
            return;
        }
        let step = self.order.step_of(statement);
        match statement {
            Statement::Emit(range) => range.clone().for_each(|expression| {
                if self.is_baked_here(expression) {
                    self.bake(expression, self.span(expression));
                }
            }),
            Statement::If { .. } if self.plan.short_circuit_steps.contains_key(&step) => {
                if let Some(value) = self.plan.short_circuit_steps.get(&step).copied() {
                    self.bake(value, span);
                }
            }
            Statement::Call { result: Some(result), .. } | Statement::Atomic { result: Some(result), .. }
                if self.plan.baked[*result] =>
            {
                self.bake(*result, span);
            }
            Statement::Block(block) => {
                self.print_comments_above(span);
                self.line("{");
                self.open_block();
                self.statements(block, tail);
                self.close_block();
                self.line("}");
            }
            Statement::If { condition, accept, reject } => self.if_statement(*condition, accept, reject, span, tail),
            Statement::Switch { selector, cases } => self.switch(*selector, cases, span),
            Statement::Return { value } => self.return_statement(*value, span, tail),
            Statement::Break | Statement::Continue | Statement::Kill => self.jump(statement, span),
            Statement::Store { pointer, .. } if self.is_long_zero(statement) => self.store_zeros(step, *pointer, span),
            _ => {
                self.print_all_comments_of(span);
                match self.simple(statement) {
                    Some(text) => text.split("; ").for_each(|part| self.line(format!("{part};"))),
                    None => drop(self.printer.error(kind_name(statement), span)),
                }
                self.append_comment_after(span);
            }
        }
    }

    /// Prints the variable of a baked expression.
    fn bake(&mut self, expression: Handle<Expression>, span: Span) {
        self.print_all_comments_of(span);
        let value = self.in_place(expression).text;
        let preferred = self.preferred_name(expression);
        let name = self.declare(&preferred);
        let declaration = match self.function.expressions[expression] {
            Expression::AtomicResult { comparison: true, .. } => format!("{} {name}", self.compared_type(expression)),
            _ => {
                let span = self.span(expression);
                let resolution = &self.order.info[expression].ty;
                self.printer.resolved_declaration(resolution, &name, span)
            }
        };
        self.values.insert(expression, name);
        self.line(format!("{declaration} = {value};"));
        self.append_comment_after(span);
    }

    /// Returns the type of the value that a compare-exchange compares.
    fn compared_type(&mut self, result: Handle<Expression>) -> String {
        match self.order.compared.get(&result).copied() {
            Some(compared) => self.type_name(compared),
            None => self.error("a compare-exchange result without its exchange", result),
        }
    }

    /// Returns the preferred name of a baked expression: that of its `let`, or one that names the origin of the value.
    fn preferred_name(&self, expression: Handle<Expression>) -> String {
        if let Some(name) = crate::schedule::name_of(&self.order, expression) {
            return name.to_owned();
        }
        match self.function.expressions[expression] {
            Expression::CallResult(function) => {
                let name = self.printer.module.functions[function].name.as_deref().unwrap_or("call");
                format!("{name}_result")
            }
            Expression::AtomicResult { .. } => "old_value".to_owned(),
            Expression::Load { pointer } => match crate::footprint::root(self.printer.module, self.function, pointer) {
                Some(
                    crate::footprint::MemoryObject::Global(global) | crate::footprint::MemoryObject::Private(global),
                ) => {
                    format!(
                        "{}_value",
                        self.printer.module.global_variables[global].name.as_deref().unwrap_or("loaded")
                    )
                }
                Some(crate::footprint::MemoryObject::Local(local)) => {
                    format!("{}_value", self.function.local_variables[local].name.as_deref().unwrap_or("loaded"))
                }
                _ => "loaded".to_owned(),
            },
            Expression::ImageSample { .. } => "sampled".to_owned(),
            Expression::ImageLoad { .. } => "texel".to_owned(),
            _ => "value".to_owned(),
        }
    }

    /// Prints a statement that fits in one line, without its semicolon.
    pub fn simple(&mut self, statement: &Statement) -> Option<String> {
        Some(match *statement {
            Statement::Store { pointer, value } => self.store(statement, pointer, value),
            Statement::Call { .. } => self.call_text(statement),
            Statement::Atomic { result, .. } => {
                self.check_compare_exchange(result);
                self.atomic(statement)
            }
            Statement::ImageStore { image, coordinate, array_index, value } => {
                self.image_store(image, coordinate, array_index, value)
            }
            Statement::ControlBarrier(barrier) => barrier_text(barrier, true),
            Statement::MemoryBarrier(barrier) => barrier_text(barrier, false),
            _ => return None,
        })
    }

    /// Records an error for a compare-exchange whose result is used as a whole.
    fn check_compare_exchange(&mut self, result: Option<Handle<Expression>>) {
        let Some(result) = result.filter(|result| self.order.compared.contains_key(result)) else { return };
        let members_only = self.order.uses[result].iter().all(|used| match used {
            crate::analysis::Use::Expression { user, .. } => {
                matches!(self.function.expressions[*user], Expression::AccessIndex { .. })
            }
            crate::analysis::Use::Step { .. } => false,
        });
        if !members_only {
            self.error("the result of a compare-exchange as a whole", result);
        }
    }

    /// Prints a store, which may declare its variable.
    fn store(&mut self, statement: &Statement, pointer: Handle<Expression>, value: Handle<Expression>) -> String {
        let step = self.order.step_of(statement);
        if let Some(local) = self.declarations.by_store.get(&step).copied() {
            let value = self.expression(value);
            return self.declare_local(local, Some(value));
        }
        if crate::footprint::is_atomic(self.printer.module, self.function, pointer) {
            return self.atomic_store(pointer, value);
        }
        let target = self.expression(pointer);
        if self.plan.compound.contains(&step)
            && let Expression::Binary { op, right, .. } = self.function.expressions[value]
        {
            return self.compound(&target, op, right);
        }
        format!("{target} = {}", self.expression(value))
    }

    /// Prints `x op= y`, `x++` or `x--`.
    fn compound(&mut self, target: &str, op: naga::BinaryOperator, right: Handle<Expression>) -> String {
        let one = matches!(self.function.expressions[right], Expression::Literal(Literal::U32(1) | Literal::I32(1)));
        let symbol = match op {
            naga::BinaryOperator::Add if one => return format!("{target}++"),
            naga::BinaryOperator::Subtract if one => return format!("{target}--"),
            naga::BinaryOperator::Add => "+",
            naga::BinaryOperator::Subtract => "-",
            naga::BinaryOperator::Multiply => "*",
            naga::BinaryOperator::And => "&",
            naga::BinaryOperator::ExclusiveOr => "^",
            _ => "|",
        };
        format!("{target} {symbol}= {}", self.expression(right))
    }

    /// Prints a store that sets a long array to zero.
    fn store_zeros(&mut self, step: usize, pointer: Handle<Expression>, span: Span) {
        self.print_comments_above(span);
        if let Expression::LocalVariable(local) = self.function.expressions[pointer] {
            if self.declarations.by_store.contains_key(&step) {
                let text = self.declare_local(local, None);
                self.line(text + ";");
            }
            self.zero_long_array(local);
        } else {
            self.printer.error("a long array set to zero", span);
        }
    }

    /// Prints a call, or the replacement of a marker.
    fn call_text(&mut self, statement: &Statement) -> String {
        let Statement::Call { function, ref arguments, .. } = *statement else { return String::new() };
        match self.printer.marker(function) {
            Some(Marker::MemoryFence) => return "memoryBarrierBuffer()".to_owned(),
            Some(Marker::HelperLane) => return "gl_HelperInvocation".to_owned(),
            Some(marker) => return self.critical(statement, marker),
            None => {}
        }
        let name = self.printer.names.functions.get(&function).cloned().unwrap_or_default();
        let arguments: Vec<String> = arguments.iter().map(|argument| self.expression(*argument)).collect();
        format!("{name}({})", arguments.join(", "))
    }

    /// Prints the start or end of a critical section. GLSL allows the interlock only at the top level of `main`.
    fn critical(&mut self, statement: &Statement, marker: Marker) -> String {
        let block = self.order.steps[self.order.step_of(statement)].block;
        if self.interface.is_none() || block != 0 {
            self.printer.error(
                "the start or end of a critical section outside the top level of the entry point",
                Span::UNDEFINED,
            );
        }
        if self.printer.es() {
            return self.printer.error("an interlock", Span::UNDEFINED);
        }
        self.printer.requirements.extensions.insert("GL_ARB_fragment_shader_interlock");
        let layout = match marker {
            Marker::CriticalEnd => return "endInvocationInterlockARB()".to_owned(),
            Marker::OrderedCriticalBegin => "pixel_interlock_ordered",
            _ => "pixel_interlock_unordered",
        };
        if self.printer.requirements.interlock.replace(layout).is_some_and(|other| other != layout) {
            self.printer.error("ordered and unordered critical sections in one entry point", Span::UNDEFINED);
        }
        "beginInvocationInterlockARB()".to_owned()
    }

    /// Prints the call or atomic that produces a result, at the use of the result.
    pub fn result_in_place(&mut self, expression: Handle<Expression>) -> Text {
        let step = self.order.evaluated[expression];
        let statement = step.and_then(|step| self.order.steps[step].statement);
        let text = statement.and_then(|statement| self.simple(statement));
        Text::primary(text.unwrap_or_else(|| self.error("a result without its statement", expression)))
    }
}

/// Tests whether a span contains another.
pub fn contains(outer: Span, inner: Span) -> bool {
    match (outer.to_range(), inner.to_range()) {
        (Some(outer), Some(inner)) => outer.start <= inner.start && inner.end <= outer.end,
        _ => false,
    }
}

/// Prints a barrier.
fn barrier_text(barrier: Barrier, control: bool) -> String {
    let fences = [
        (Barrier::STORAGE, "memoryBarrierBuffer()"),
        (Barrier::WORK_GROUP, "memoryBarrierShared()"),
        (Barrier::TEXTURE, "memoryBarrierImage()"),
    ];
    let fences = fences.iter().filter(|(flag, _)| barrier.contains(*flag)).map(|(_, text)| *text);
    fences.chain(control.then_some("barrier()")).collect::<Vec<_>>().join("; ")
}

/// Returns the name that messages use for a kind of statement.
fn kind_name(statement: &Statement) -> String {
    let text = format!("{statement:?}");
    let name: String = text.chars().take_while(|c| c.is_alphanumeric()).collect();
    format!("a statement of kind {name}")
}
