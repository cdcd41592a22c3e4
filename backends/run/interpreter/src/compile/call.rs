//! Calls, inlined; and the outermost function with its inputs.

use naga::{Binding, Expression, Function, Handle, TypeInner};

use super::{Compiler, Frame, Result, Value};
use crate::operation::{Op, Word};
use crate::program::{Input, Marker};

impl<'m> Compiler<'m> {
    /// The outermost function: its inputs and its result.
    pub(super) fn whole(&mut self, function: &'m Function) -> Result<(Vec<Input>, Vec<Input>)> {
        let mut inputs = Vec::new();
        for argument in &function.arguments {
            let first = self.take(self.shapes.dense(self.shapes.inner(argument.ty))?);
            self.frame.arguments.push(Value::Words(first));
            let name = argument.name.clone().unwrap_or_default();
            self.parts(name, argument.ty, &argument.binding, first, &mut inputs)?;
        }
        let words = match &function.result {
            Some(result) => self.shapes.dense(self.shapes.inner(result.ty))?,
            None => 0,
        };
        self.frame.result = self.take(words);
        self.body();
        self.push(Op::End);
        let mut outputs = Vec::new();
        if let Some(result) = &function.result {
            self.parts(String::new(), result.ty, &result.binding, self.frame.result, &mut outputs)?;
        }
        Ok((inputs, outputs))
    }

    /// An argument or a result from the word `first` on: its members, where it is a structure without a binding.
    fn parts(
        &self,
        name: String,
        kind: Handle<naga::Type>,
        binding: &Option<Binding>,
        first: Word,
        parts: &mut Vec<Input>,
    ) -> Result<()> {
        let inner = self.shapes.inner(kind);
        let mut push = |name: String, inner: &TypeInner, binding: &Option<Binding>, first: Word| {
            let words = self.shapes.dense(inner)? as usize;
            let kind = crate::shape::number(inner).map(|scalar| scalar.kind);
            parts.push(Input { name, binding: binding.clone(), kind, words: first as usize..first as usize + words });
            Ok(())
        };
        let (TypeInner::Struct { members, .. }, None) = (inner, binding) else {
            return push(name, inner, binding, first);
        };
        for (number, member) in (0..).zip(members) {
            let at = first + self.shapes.part(inner, number)?.dense;
            push(member.name.clone().unwrap_or_default(), self.shapes.inner(member.ty), &member.binding, at)?;
        }
        Ok(())
    }

    /// Variables, then statements; afterwards whatever returned has come together.
    fn body(&mut self) {
        let function = self.frame.function;
        for (handle, variable) in function.local_variables.iter() {
            self.at(function.local_variables.get_span(handle));
            if let Err(what) = self.local(handle, variable) {
                self.refuse(what);
            }
        }
        self.block(&function.body);
        let returns = std::mem::take(&mut self.frame.returns);
        // A return at the very end need not jump.
        self.land(&returns);
    }

    fn local(&mut self, handle: Handle<naga::LocalVariable>, variable: &naga::LocalVariable) -> Result<()> {
        let count = self.shapes.dense(self.shapes.inner(variable.ty))?;
        let to = self.take(count);
        self.frame.locals[handle.index()] = Some((to, count));
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
        let function = &self.module.functions[callee];
        let words = match &function.result {
            Some(result) => self.shapes.dense(self.shapes.inner(result.ty))?,
            None => 0,
        };
        let to = self.take(words);
        if let Some(result) = result {
            self.frame.values[result.index()] = Some(Value::Words(to));
        }
        let name = function.name.as_deref().unwrap_or_default();
        let marker = self.options.markers.iter().find(|(marked, _)| *marked == name);
        if let Some((_, marker)) = marker {
            self.push(match marker {
                Marker::Fence => Op::Fence,
                Marker::CriticalBegin => Op::CriticalBegin,
                Marker::CriticalEnd => Op::CriticalEnd,
                Marker::HelperLane if words == 1 => Op::HelperLane { to },
                Marker::HelperLane => return Err("a helper marker that is no `bool`".to_owned()),
            });
            return Ok(());
        }
        let mut values = Vec::with_capacity(arguments.len());
        for argument in arguments {
            values.push(self.value(*argument)?);
        }
        let top = self.top;
        let site = self.site;
        let inner = Frame { arguments: values, ..Frame::new(function, &self.info[callee], to, site) };
        let outer = std::mem::replace(&mut self.frame, inner);
        self.body();
        self.frame = outer;
        self.site = site;
        // What the call needed is free again: its result stands outside.
        self.top = top;
        Ok(())
    }
}
