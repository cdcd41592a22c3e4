//! Prints accesses to members, components and elements, and loads.
//!
//! Input: accesses and loads. Output: `a.b`, `v.x`, `a[i]`. Indices print unchanged, without bounds checks: generated code
//! has no index out of range, and WGSL leaves its effect to the implementation.

use naga::{AddressSpace, Expression, GlobalVariable, Handle, TypeInner};

use crate::function::FunctionPrinter;
use crate::interface::Argument;
use crate::names;
use crate::precedence::{Precedence, Text};

impl FunctionPrinter<'_, '_> {
    /// Returns the indexed type: that of a value, or the pointee of a pointer.
    fn accessed_type(&self, base: Handle<Expression>) -> TypeInner {
        let module = self.printer.module;
        match *self.order.inner(base) {
            TypeInner::Pointer { base, .. } => module.types[base].inner.clone(),
            TypeInner::ValuePointer { size: Some(size), scalar, .. } => TypeInner::Vector { size, scalar },
            ref inner => inner.clone(),
        }
    }

    /// Prints `a[i]` with a computed index.
    pub fn access(&mut self, base: Handle<Expression>, index: Handle<Expression>) -> Text {
        let base = self.primary(base);
        let index = self.expression(index);
        Text::primary(format!("{base}[{index}]"))
    }

    /// Prints an access with a constant index: `a.b`, `v.x` or `a[2]`.
    pub fn access_index(&mut self, expression: Handle<Expression>, base: Handle<Expression>, index: u32) -> Text {
        if let Expression::FunctionArgument(argument) = self.function.expressions[base]
            && let Some(Argument::Members(members)) =
                self.interface.as_ref().and_then(|interface| interface.arguments.get(argument as usize))
            && let Some(member) = members.get(index as usize)
        {
            return member.clone();
        }
        if let Expression::AtomicResult { comparison: true, .. } = self.function.expressions[base] {
            return self.compare_exchange_member(base, index);
        }
        let inner = self.accessed_type(base);
        let base = self.primary(base);
        match inner {
            TypeInner::Struct { ref members, .. } => {
                Text::primary(format!("{base}.{}", names::field_name(members, index as usize)))
            }
            TypeInner::Vector { .. } => {
                let letter = ['x', 'y', 'z', 'w'].get(index as usize).copied().unwrap_or('x');
                Text::primary(format!("{base}.{letter}"))
            }
            TypeInner::Array { .. } | TypeInner::Matrix { .. } => Text::primary(format!("{base}[{index}]")),
            _ => Text::primary(self.error("an access into this type", expression)),
        }
    }

    /// Prints `old_value` or `exchanged` of a compare-exchange; GLSL returns only the old value.
    fn compare_exchange_member(&mut self, result: Handle<Expression>, index: u32) -> Text {
        let old = self.text(result);
        if index == 0 {
            return old;
        }
        let Some(compared) = self.order.compared.get(&result).copied() else {
            return Text::primary(self.error("a compare-exchange result without its exchange", result));
        };
        let compared = self.text(compared).above(Precedence::Equality);
        Text::new(format!("{} == {compared}", old.above(Precedence::Equality)), Precedence::Equality)
    }

    /// Prints an argument.
    pub fn argument(&mut self, expression: Handle<Expression>, index: u32) -> Text {
        if let Some(interface) = &self.interface {
            return match interface.arguments.get(index as usize) {
                Some(Argument::Value(text)) => text.clone(),
                _ => Text::primary(self.error("an entry point's argument in this position", expression)),
            };
        }
        match self.arguments.get(index as usize) {
            Some(name) => Text::primary(name.clone()),
            None => Text::primary(self.error("an unknown argument", expression)),
        }
    }

    /// Prints a global variable.
    pub fn global(&mut self, global: Handle<GlobalVariable>) -> Text {
        self.printer.requirements.globals.insert(global);
        Text::primary(self.printer.names.globals.get(&global).cloned().unwrap_or_default())
    }

    /// Prints a load.
    pub fn load(&mut self, expression: Handle<Expression>, pointer: Handle<Expression>) -> Text {
        self.check_scalar(expression);
        if crate::footprint::is_atomic(self.printer.module, self.function, pointer) {
            return self.atomic_load(pointer);
        }
        if let Expression::GlobalVariable(global) = self.function.expressions[pointer] {
            let variable = &self.printer.module.global_variables[global];
            let buffer = matches!(variable.space, AddressSpace::Storage { .. });
            if buffer && self.printer.is_unwrapped(global) {
                return Text::primary(self.error("reading a buffer as a whole", expression));
            }
        }
        self.text(pointer)
    }
}
