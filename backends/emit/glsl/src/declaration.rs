//! Declarations of variables, where `locals` wants them.
//!
//! In: a statement, or a variable and its value. Out: the lines or the text that declare. WGSL's variables begin as zero,
//! GLSL's as anything: every one gets a value here.

use naga::{ArraySize, Handle, LocalVariable, Span, Statement, TypeInner};

use crate::function::FunctionPrinter;
use crate::statement::contains;

impl FunctionPrinter<'_, '_> {
    /// Declares the variables that belong before a statement; the one in a `for` header is handed back instead.
    pub fn declarations_before(&mut self, statement: &Statement, span: Span) -> Option<String> {
        let step = self.order.step_of(statement);
        let mut in_header = None;
        for local in self.declarations.before.remove(&step).unwrap_or_default() {
            let declared = self.function.local_variables.get_span(local);
            if matches!(statement, Statement::Loop { .. }) && contains(span, declared) && in_header.is_none() {
                self.lead(span);
                self.enter();
                in_header = Some(self.declare_local(local, None));
                continue;
            }
            self.lead(declared);
            let text = self.declare_local(local, None);
            self.line(text + ";");
            self.zero_long_array(local);
            self.trail(declared);
        }
        in_header
    }

    /// `uint count = 0u`, with the given value or the variable's constant one.
    pub fn declare_local(&mut self, local: Handle<LocalVariable>, value: Option<String>) -> String {
        let variable = &self.function.local_variables[local];
        let name = self.declare(variable.name.as_deref().unwrap_or("condition"));
        self.locals.insert(local, name.clone());
        let declaration = self.printer.declaration(variable.ty, &name, self.function.local_variables.get_span(local));
        let value = match (value, variable.init) {
            (Some(value), _) => value,
            (None, Some(init)) => self.expression(init),
            (None, None) if self.is_long_array(local) => return declaration,
            (None, None) => self.printer.zero(variable.ty, self.function.local_variables.get_span(local)),
        };
        format!("{declaration} = {value}")
    }

    fn is_long_array(&self, local: Handle<LocalVariable>) -> bool {
        let variable = &self.function.local_variables[local];
        variable.init.is_none() && self.printer.is_long_array(variable.ty)
    }

    /// WGSL's variables begin as zero, GLSL's as anything.
    pub fn zero_long_array(&mut self, local: Handle<LocalVariable>) {
        let variable = &self.function.local_variables[local];
        let TypeInner::Array { base, size: ArraySize::Constant(size), .. } =
            self.printer.module.types[variable.ty].inner
        else {
            return;
        };
        if !self.is_long_array(local) {
            return;
        }
        let zero = self.printer.zero(base, self.function.local_variables.get_span(local));
        let name = self.locals.get(&local).cloned().unwrap_or_default();
        self.enter();
        let index = self.declare("index");
        self.line(format!("for (uint {index} = 0u; {index} < {size}u; {index}++) {{"));
        self.line(format!("    {name}[{index}] = {zero};"));
        self.line("}");
        self.leave();
    }
}
