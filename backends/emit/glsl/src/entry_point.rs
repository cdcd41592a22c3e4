//! Assembles the inputs and assigns the outputs in the body of an entry point.

use naga::{Expression, Handle, Span, TypeInner};

use crate::function::FunctionPrinter;
use crate::interface::Argument;
use crate::names::field_name;
use crate::precedence::Text;

impl FunctionPrinter<'_, '_> {
    /// Assembles the inputs that are used as a whole, and declares variables for those that need a conversion.
    pub fn assemble_inputs(&mut self) {
        let arguments = self.interface.as_ref().map(|interface| interface.arguments.clone()).unwrap_or_default();
        for (index, argument) in arguments.into_iter().enumerate() {
            let (name, ty, value) = match argument {
                Argument::Whole { name, ty, members } => {
                    let structure = self.printer.type_name(ty, Span::UNDEFINED);
                    let members: Vec<String> = members.into_iter().map(|member| member.text).collect();
                    (name, ty, format!("{structure}({})", members.join(", ")))
                }
                // A conversion is more readable under the argument's name.
                Argument::Value(text) if text.text.contains('(') && self.uses_argument(index) => {
                    let argument = &self.function.arguments[index];
                    (argument.name.clone().unwrap_or_default(), argument.ty, text.text)
                }
                _ => continue,
            };
            let name = self.declare(&name);
            let declaration = self.printer.declaration(ty, &name, Span::UNDEFINED);
            self.line(format!("{declaration} = {value};"));
            if let Some(slot) = self.interface.as_mut().and_then(|interface| interface.arguments.get_mut(index)) {
                *slot = Argument::Value(Text::primary(name));
            }
        }
    }

    /// Tests whether the printed body uses an argument.
    fn uses_argument(&self, index: usize) -> bool {
        let is_argument = |expression: &Expression| matches!(expression, Expression::FunctionArgument(argument) if *argument as usize == index);
        self.function.expressions.iter().any(|(handle, expression)| is_argument(expression) && self.plan.live[handle])
    }

    /// Assigns the result to the outputs.
    pub fn write_outputs(&mut self, value: Handle<Expression>) {
        let outputs = self.interface.as_ref().map(|interface| interface.outputs.clone()).unwrap_or_default();
        let parts = self.parts(value, outputs.len());
        for (output, part) in outputs.iter().zip(parts) {
            let part = if output.as_int { format!("int({part})") } else { part };
            self.line(format!("{} = {part};", output.target));
            if output.is_position && !self.printer.vulkan() {
                self.line("// OpenGL clips depth to -w..w, WGSL to 0..w.");
                self.line("gl_Position.z = 2.0 * gl_Position.z - gl_Position.w;");
            }
        }
    }

    /// Prints the members of a result, or the result itself.
    fn parts(&mut self, value: Handle<Expression>, count: usize) -> Vec<String> {
        let function = self.function;
        let TypeInner::Struct { ref members, .. } = *self.order.inner(value) else {
            return vec![self.expression(value)];
        };
        let members = members.clone();
        if let (Expression::Compose { components, .. }, false) =
            (&function.expressions[value], self.values.contains_key(&value))
        {
            return components.iter().map(|component| self.expression(*component)).collect();
        }
        let mut text = self.expression(value);
        let is_name = text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_name {
            let name = self.declare("result");
            let span = self.span(value);
            let declaration = self.printer.resolved_declaration(&self.order.info[value].ty, &name, span);
            self.line(format!("{declaration} = {text};"));
            text = name;
        }
        (0..count).map(|index| format!("{text}.{}", field_name(&members, index))).collect()
    }
}
