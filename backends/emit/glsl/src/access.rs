//! Reaching into values and memory: members, components, elements, loads.
//!
//! In: accesses and loads. Out: `a.b`, `v.x`, `a[i]`. Indices print as they are: WGSL lets an implementation do what it
//! likes with an index out of range, and generated code has none.

use naga::{AddressSpace, Expression, GlobalVariable, Handle, TypeInner};

use crate::expression::{Level, Text};
use crate::function::FunctionPrinter;
use crate::interface::Argument;
use crate::names;

impl FunctionPrinter<'_, '_> {
    /// What is indexed: the type of a value, or of what a pointer points to.
    fn accessed(&self, base: Handle<Expression>) -> TypeInner {
        let module = self.printer.module;
        match *self.order.inner(base) {
            TypeInner::Pointer { base, .. } => module.types[base].inner.clone(),
            TypeInner::ValuePointer { size: Some(size), scalar, .. } => TypeInner::Vector { size, scalar },
            ref inner => inner.clone(),
        }
    }

    pub fn access(&mut self, base: Handle<Expression>, index: Handle<Expression>) -> Text {
        let base = self.primary(base);
        let index = self.expression(index);
        Text::primary(format!("{base}[{index}]"))
    }

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
        let inner = self.accessed(base);
        let base = self.primary(base);
        match inner {
            TypeInner::Struct { ref members, .. } => {
                Text::primary(format!("{base}.{}", names::field(members, index as usize)))
            }
            TypeInner::Vector { .. } => {
                let letter = ['x', 'y', 'z', 'w'].get(index as usize).copied().unwrap_or('x');
                Text::primary(format!("{base}.{letter}"))
            }
            TypeInner::Array { .. } | TypeInner::Matrix { .. } => Text::primary(format!("{base}[{index}]")),
            _ => Text::primary(self.error("an access into this type", expression)),
        }
    }

    /// `old_value` or `exchanged` of a compare-exchange, which GLSL has only the old value of.
    fn compare_exchange_member(&mut self, result: Handle<Expression>, index: u32) -> Text {
        let old = self.text(result);
        if index == 0 {
            return old;
        }
        let Some(compared) = self.order.compared.get(&result).copied() else {
            return Text::primary(self.error("a compare-exchange result without its exchange", result));
        };
        let compared = self.text(compared).above(Level::Equality);
        Text::new(format!("{} == {compared}", old.above(Level::Equality)), Level::Equality)
    }

    pub fn argument(&mut self, expression: Handle<Expression>, index: u32) -> Text {
        if let Some(interface) = &self.interface {
            return match interface.arguments.get(index as usize) {
                Some(Argument::Value(text)) => text.clone(),
                _ => Text::primary(self.error("an entry point's argument in this place", expression)),
            };
        }
        match self.arguments.get(index as usize) {
            Some(name) => Text::primary(name.clone()),
            None => Text::primary(self.error("an unknown argument", expression)),
        }
    }

    pub fn global(&mut self, global: Handle<GlobalVariable>) -> Text {
        self.printer.needs.globals.insert(global);
        Text::primary(self.printer.names.globals.get(&global).cloned().unwrap_or_default())
    }

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
