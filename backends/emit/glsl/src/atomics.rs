//! Prints atomic operations.
//!
//! Input: atomic loads, stores and read-modify-writes. Output: calls of GLSL's functions. WGSL's atomics are relaxed, at
//! device scope, or at workgroup scope for `var<workgroup>`. The Vulkan dialect states this; OpenGL's functions are defined
//! so. OpenGL has no atomic load: it prints as an atomic that changes nothing, unless the options allow a plain read of the
//! variable. In the functions that the options name, loads and stores are plain.

use naga::{AddressSpace, AtomicFunction, Expression, GlobalVariable, Handle, ScalarKind, Statement};

use crate::footprint::{MemoryObject, root};
use crate::function::FunctionPrinter;
use crate::precedence::{Precedence, Text};
use crate::types::numeric;

const MEMORY_SCOPE: &str = "GL_KHR_memory_scope_semantics";
/// 64-bit atomics. No driver of OpenGL has the extension of Vulkan.
const WIDE_ATOMICS: &str = "GL_EXT_shader_atomic_int64";
const OPENGL_WIDE_ATOMICS: &str = "GL_NV_shader_atomic_int64";

impl FunctionPrinter<'_, '_> {
    /// Returns the shared global that a pointer points into.
    fn root_global(&self, pointer: Handle<Expression>) -> Option<Handle<GlobalVariable>> {
        match root(self.printer.module, self.function, pointer) {
            Some(MemoryObject::Global(global)) => Some(global),
            _ => None,
        }
    }

    /// Returns scope, storage class and ordering in the terms of GL_KHR_memory_scope_semantics.
    fn scope(&self, pointer: Handle<Expression>) -> &'static str {
        let space = self.root_global(pointer).map(|global| self.printer.module.global_variables[global].space);
        match space {
            Some(AddressSpace::WorkGroup) => "gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelaxed",
            _ => "gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsRelaxed",
        }
    }

    /// Returns the zero of the atomic's scalar, `0`, `0u` or `0ul`; rejects signed 64-bit and float atomics.
    fn atomic_zero(&mut self, pointer: Handle<Expression>) -> String {
        let scalar = match *self.order.inner(pointer) {
            naga::TypeInner::Pointer { base, .. } => numeric(&self.printer.module.types[base].inner),
            ref inner => numeric(inner),
        };
        match scalar.map(|(_, scalar)| (scalar.kind, scalar.width)) {
            Some((ScalarKind::Uint, 4)) => "0u".to_owned(),
            Some((ScalarKind::Sint, 4)) => "0".to_owned(),
            Some((ScalarKind::Uint, 8)) => {
                let extension = if self.printer.vulkan() { WIDE_ATOMICS } else { OPENGL_WIDE_ATOMICS };
                self.printer.requirements.extensions.insert(extension);
                "0ul".to_owned()
            }
            _ => self.error("atomics of this type", pointer),
        }
    }

    /// Tests whether atomic loads and stores of this function may be plain.
    fn is_plain(&self) -> bool {
        self.function.name.as_deref().is_some_and(|name| self.printer.options.plain_functions.contains(&name))
    }

    /// Prints an atomic load.
    pub fn atomic_load(&mut self, pointer: Handle<Expression>) -> Text {
        let zero = self.atomic_zero(pointer);
        let target = self.text(pointer);
        if self.is_plain() {
            return target;
        }
        if self.printer.vulkan() {
            self.printer.requirements.extensions.insert(MEMORY_SCOPE);
            return Text::primary(format!("atomicLoad({}, {})", target.text, self.scope(pointer)));
        }
        let plain = self.root_global(pointer).is_some_and(|global| self.printer.allows_plain_loads(global));
        if plain { target } else { Text::primary(format!("atomicOr({}, {zero})", target.text)) }
    }

    /// Prints an atomic store.
    pub fn atomic_store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) -> String {
        let zero = self.atomic_zero(pointer);
        let (target, value) = (self.expression(pointer), self.expression(value));
        if self.is_plain() {
            return format!("{target} = {value}");
        }
        if self.printer.vulkan() {
            self.printer.requirements.extensions.insert(MEMORY_SCOPE);
            return format!("atomicStore({target}, {value}, {})", self.scope(pointer));
        }
        // OpenGL has no atomic store. A coherent store of 32 bits is what drivers make of one; a wider store may be torn.
        let is_wide = zero == "0ul";
        if is_wide { format!("atomicExchange({target}, {value})") } else { format!("{target} = {value}") }
    }

    /// Prints a read-modify-write.
    pub fn atomic(&mut self, statement: &Statement) -> String {
        let Statement::Atomic { pointer, ref fun, value, .. } = *statement else { return String::new() };
        self.atomic_zero(pointer);
        let target = self.expression(pointer);
        let operand = self.text(value);
        let name = match *fun {
            AtomicFunction::Add => "atomicAdd",
            AtomicFunction::Subtract => return format!("atomicAdd({target}, {})", negative(operand)),
            AtomicFunction::And => "atomicAnd",
            AtomicFunction::InclusiveOr => "atomicOr",
            AtomicFunction::ExclusiveOr => "atomicXor",
            AtomicFunction::Min => "atomicMin",
            AtomicFunction::Max => "atomicMax",
            AtomicFunction::Exchange { compare: None } => "atomicExchange",
            AtomicFunction::Exchange { compare: Some(compare) } => {
                let compare = self.expression(compare);
                return format!("atomicCompSwap({target}, {compare}, {})", operand.text);
            }
        };
        format!("{name}({target}, {})", operand.text)
    }
}

/// Prints the negative of an operand. GLSL has no atomic subtraction; adding the negative wraps to the same value.
fn negative(value: Text) -> String {
    format!("-{}", value.at_least(Precedence::Primary))
}
