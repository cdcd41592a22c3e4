//! Compiles calls, inlined, and the outermost function with its inputs and outputs.

use naga::{Binding, Expression, Function, Handle, TypeInner};

use super::compiler::{Compiler, InlinedCall, Result, Value};
use crate::bytecode::{InterfaceVariable, Marker};
use crate::operation::{Op, Word};

/// The most instructions before a call.
const MOST_INSTRUCTIONS: usize = 1 << 18;

impl<'m> Compiler<'m> {
    /// Compiles the outermost function; returns its inputs and outputs.
    pub(super) fn outermost(
        &mut self,
        function: &'m Function,
    ) -> Result<(Vec<InterfaceVariable>, Vec<InterfaceVariable>)> {
        let mut inputs = Vec::new();
        for argument in &function.arguments {
            let first = self.take(self.layouts.dense(self.layouts.inner(argument.ty))?);
            self.callee.arguments.push(Value::Words(first));
            let name = argument.name.clone().unwrap_or_default();
            self.push_interface(name, argument.ty, &argument.binding, first, &mut inputs)?;
        }
        let words = match &function.result {
            Some(result) => self.layouts.dense(self.layouts.inner(result.ty))?,
            None => 0,
        };
        self.callee.result = self.take(words);
        self.body();
        self.push(Op::End);
        let mut outputs = Vec::new();
        if let Some(result) = &function.result {
            self.push_interface(String::new(), result.ty, &result.binding, self.callee.result, &mut outputs)?;
        }
        Ok((inputs, outputs))
    }

    /// Appends an argument or a result that begins at the word `first`. A structure without a binding is flattened to its
    /// members.
    fn push_interface(
        &self,
        name: String,
        kind: Handle<naga::Type>,
        binding: &Option<Binding>,
        first: Word,
        parts: &mut Vec<InterfaceVariable>,
    ) -> Result<()> {
        let inner = self.layouts.inner(kind);
        let mut push = |name: String, inner: &TypeInner, binding: &Option<Binding>, first: Word| {
            let words = self.layouts.dense(inner)? as usize;
            let kind = crate::layout::scalar_of(inner).map(|scalar| scalar.kind);
            parts.push(InterfaceVariable {
                name,
                binding: binding.clone(),
                kind,
                words: first as usize..first as usize + words,
            });
            Ok(())
        };
        let (TypeInner::Struct { members, .. }, None) = (inner, binding) else {
            return push(name, inner, binding, first);
        };
        for (number, member) in (0..).zip(members) {
            let at = first + self.layouts.element_offset(inner, number)?.dense;
            push(member.name.clone().unwrap_or_default(), self.layouts.inner(member.ty), &member.binding, at)?;
        }
        Ok(())
    }

    /// Compiles the variables and statements of the function; all returns jump to its end.
    fn body(&mut self) {
        let function = self.callee.function;
        for (handle, variable) in function.local_variables.iter() {
            self.at(function.local_variables.get_span(handle));
            if let Err(what) = self.local(handle, variable) {
                self.report_unsupported(what);
            }
        }
        self.block(&function.body);
        let returns = std::mem::take(&mut self.callee.returns);
        self.patch_to_here(&returns);
    }

    fn local(&mut self, handle: Handle<naga::LocalVariable>, variable: &naga::LocalVariable) -> Result<()> {
        let count = self.layouts.dense(self.layouts.inner(variable.ty))?;
        let to = self.take(count);
        self.callee.locals[handle.index()] = Some((to, count));
        let from = match variable.init {
            Some(init) => self.words(init)?,
            None => self.zeros(count),
        };
        self.push(Op::Copy { to, from, count });
        Ok(())
    }

    pub(super) fn call(
        &mut self,
        callee: Handle<Function>,
        arguments: &[Handle<Expression>],
        result: Option<Handle<Expression>>,
    ) -> Result<()> {
        // Every call is inlined, so calls of calls may be exponentially many.
        if self.ops.len() > MOST_INSTRUCTIONS {
            return Err(format!("a program of more than {MOST_INSTRUCTIONS} instructions"));
        }
        let function = &self.module.functions[callee];
        let words = match &function.result {
            Some(result) => self.layouts.dense(self.layouts.inner(result.ty))?,
            None => 0,
        };
        let to = self.take(words);
        if let Some(result) = result {
            self.callee.values[result.index()] = Some(Value::Words(to));
        }
        let name = function.name.as_deref().unwrap_or_default();
        let marker = self.options.markers.iter().find(|(marked, _)| *marked == name);
        if let Some((_, marker)) = marker {
            self.push(match marker {
                Marker::Fence => Op::Fence,
                Marker::CriticalBegin => Op::CriticalBegin,
                Marker::CriticalEnd => Op::CriticalEnd,
                Marker::HelperLane if words == 1 => Op::HelperLane { to },
                Marker::HelperLane => return Err("a helper marker that does not return `bool`".to_owned()),
            });
            return Ok(());
        }
        let mut values = Vec::with_capacity(arguments.len());
        for argument in arguments {
            values.push(self.value(*argument)?);
        }
        let top = self.top;
        let site = self.site;
        let inner = InlinedCall { arguments: values, ..InlinedCall::new(function, &self.info[callee], to, site) };
        let outer = std::mem::replace(&mut self.callee, inner);
        self.body();
        self.callee = outer;
        self.site = site;
        // The words of the call are free again; its result was allocated before them.
        self.top = top;
        Ok(())
    }
}
