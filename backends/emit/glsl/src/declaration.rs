//! Prints declarations of variables, at the positions that `locals` chose.
//!
//! Input: a statement, or a variable and its value. Output: the lines or the text of the declaration. WGSL initialises
//! variables to zero and GLSL does not, so every declaration gets a value here.

use naga::{ArraySize, Handle, LocalVariable, Span, Statement, TypeInner};

use crate::function::FunctionPrinter;
use crate::statement::contains;

impl FunctionPrinter<'_, '_> {
    /// Declares the variables that are declared before a statement. Returns the declaration for a `for` header, if any.
    pub fn declarations_before(&mut self, statement: &Statement, span: Span) -> Option<String> {
        self.declare_before(statement, span, matches!(statement, Statement::Loop { .. }))
    }

    /// Declares the variables that are declared before a loop whose header has another declaration.
    pub fn declarations_above(&mut self, statement: &Statement, span: Span) {
        self.declare_before(statement, span, false);
    }

    fn declare_before(&mut self, statement: &Statement, span: Span, has_header: bool) -> Option<String> {
        let step = self.order.step_of(statement);
        let mut in_header = None;
        for local in self.declarations.before.remove(&step).unwrap_or_default() {
            let declared = self.function.local_variables.get_span(local);
            if has_header && contains(span, declared) && in_header.is_none() {
                self.print_comments_above(span);
                self.enter_scope();
                in_header = Some(self.declare_local(local, None));
                continue;
            }
            self.print_comments_above(declared);
            let text = self.declare_local(local, None);
            self.line(text + ";");
            self.zero_long_array(local);
            self.append_comment_after(declared);
        }
        in_header
    }

    /// Returns a declaration such as `uint count = 0u`, with the given value or the variable's constant one.
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

    /// Tests whether a variable is an array without initialiser that is too long for a constructor of zeros.
    fn is_long_array(&self, local: Handle<LocalVariable>) -> bool {
        let variable = &self.function.local_variables[local];
        variable.init.is_none() && self.printer.is_long_array(variable.ty)
    }

    /// Sets a long array to zero in a loop; does nothing for other variables.
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
        self.enter_scope();
        let index = self.declare("index");
        self.line(format!("for (uint {index} = 0u; {index} < {size}u; {index}++) {{"));
        self.line(format!("    {name}[{index}] = {zero};"));
        self.line("}");
        self.leave_scope();
    }
}
