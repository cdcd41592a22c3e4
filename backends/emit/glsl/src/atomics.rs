//! Atomics.
//!
//! In: atomic loads, stores and read-modify-writes. Out: GLSL's functions. WGSL's atomics are relaxed, at device scope (at
//! workgroup scope for `var<workgroup>`); Vulkan's dialect says so, OpenGL's functions are that by definition. OpenGL has
//! no atomic load: it prints as an atomic that changes nothing, unless the options allow a plain read for that variable.

use naga::{AddressSpace, AtomicFunction, Expression, GlobalVariable, Handle, ScalarKind, Statement};

use crate::expression::{Level, Text};
use crate::footprint::{Place, root};
use crate::function::FunctionPrinter;
use crate::types::numeric;

const MEMORY_SCOPE: &str = "GL_KHR_memory_scope_semantics";
const WIDE_ATOMICS: &str = "GL_EXT_shader_atomic_int64";

impl FunctionPrinter<'_, '_> {
    fn root_global(&self, pointer: Handle<Expression>) -> Option<Handle<GlobalVariable>> {
        match root(self.printer.module, self.function, pointer) {
            Some(Place::Global(global)) => Some(global),
            _ => None,
        }
    }

    /// Scope and storage class, as GL_KHR_memory_scope_semantics names them.
    fn scope(&self, pointer: Handle<Expression>) -> &'static str {
        let space = self.root_global(pointer).map(|global| self.printer.module.global_variables[global].space);
        match space {
            Some(AddressSpace::WorkGroup) => "gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelaxed",
            _ => "gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsRelaxed",
        }
    }

    /// `0`, `0u` or `0ul`, as the atomic's scalar has it; signed 64-bit and float atomics have none.
    fn atomic_zero(&mut self, pointer: Handle<Expression>) -> String {
        let scalar = match *self.order.inner(pointer) {
            naga::TypeInner::Pointer { base, .. } => numeric(&self.printer.module.types[base].inner),
            ref inner => numeric(inner),
        };
        match scalar.map(|(_, scalar)| (scalar.kind, scalar.width)) {
            Some((ScalarKind::Uint, 4)) => "0u".to_owned(),
            Some((ScalarKind::Sint, 4)) => "0".to_owned(),
            Some((ScalarKind::Uint, 8)) => {
                self.printer.needs.extensions.insert(WIDE_ATOMICS);
                "0ul".to_owned()
            }
            _ => self.error("atomics of this type", pointer),
        }
    }

    pub fn atomic_load(&mut self, pointer: Handle<Expression>) -> Text {
        let zero = self.atomic_zero(pointer);
        let place = self.text(pointer);
        if self.printer.vulkan() {
            self.printer.needs.extensions.insert(MEMORY_SCOPE);
            return Text::primary(format!("atomicLoad({}, {})", place.text, self.scope(pointer)));
        }
        let plain = self.root_global(pointer).is_some_and(|global| self.printer.is_plain(global));
        if plain { place } else { Text::primary(format!("atomicOr({}, {zero})", place.text)) }
    }

    pub fn atomic_store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) -> String {
        self.atomic_zero(pointer);
        let (place, value) = (self.expression(pointer), self.expression(value));
        if self.printer.vulkan() {
            self.printer.needs.extensions.insert(MEMORY_SCOPE);
            return format!("atomicStore({place}, {value}, {})", self.scope(pointer));
        }
        format!("atomicExchange({place}, {value})")
    }

    /// The call of a read-modify-write.
    pub fn atomic(&mut self, statement: &Statement) -> String {
        let Statement::Atomic { pointer, ref fun, value, .. } = *statement else { return String::new() };
        self.atomic_zero(pointer);
        let place = self.expression(pointer);
        let operand = self.text(value);
        let name = match *fun {
            AtomicFunction::Add => "atomicAdd",
            AtomicFunction::Subtract => return format!("atomicAdd({place}, {})", negative(operand)),
            AtomicFunction::And => "atomicAnd",
            AtomicFunction::InclusiveOr => "atomicOr",
            AtomicFunction::ExclusiveOr => "atomicXor",
            AtomicFunction::Min => "atomicMin",
            AtomicFunction::Max => "atomicMax",
            AtomicFunction::Exchange { compare: None } => "atomicExchange",
            AtomicFunction::Exchange { compare: Some(compare) } => {
                let compare = self.expression(compare);
                return format!("atomicCompSwap({place}, {compare}, {})", operand.text);
            }
        };
        format!("{name}({place}, {})", operand.text)
    }
}

/// GLSL has no atomic subtraction; adding the negative wraps around to the same, for `uint` too.
fn negative(value: Text) -> String {
    format!("-{}", value.at_least(Level::Primary))
}
