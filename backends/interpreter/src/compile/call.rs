//! Calls, inlined; and the outermost function with its inputs.

use std::ops::Range;

use naga::{Expression, Function, Handle, TypeInner};

use super::{Compiler, Frame, Result, Value};
use crate::operation::Op;
use crate::program::{Input, Marker};

impl<'m> Compiler<'m> {
    /// The outermost function: its inputs and its result.
    pub(super) fn whole(&mut self, function: &'m Function) -> Result<(Vec<Input>, Range<usize>)> {
        let mut inputs = Vec::new();
        for argument in &function.arguments {
            let inner = self.shapes.inner(argument.ty);
            let first = self.take(self.shapes.dense(inner)?);
            self.frame.arguments.push(Value::Words(first));
            let name = argument.name.clone().unwrap_or_default();
            match (inner, &argument.binding) {
                (TypeInner::Struct { members, .. }, None) => {
                    for (number, member) in (0..).zip(members) {
                        let at = (first + self.shapes.part(inner, number)?.dense) as usize;
                        let words = self.shapes.dense(self.shapes.inner(member.ty))? as usize;
                        inputs.push(Input {
                            name: member.name.clone().unwrap_or_default(),
                            binding: member.binding.clone(),
                            kind: crate::shape::number(self.shapes.inner(member.ty)).map(|scalar| scalar.kind),
                            words: at..at + words,
                        });
                    }
                }
                (_, binding) => {
                    let words = self.shapes.dense(inner)? as usize;
                    inputs.push(Input {
                        name,
                        binding: binding.clone(),
                        kind: crate::shape::number(inner).map(|scalar| scalar.kind),
                        words: first as usize..first as usize + words,
                    });
                }
            }
        }
        let words = match &function.result {
            Some(result) => self.shapes.dense(self.shapes.inner(result.ty))?,
            None => 0,
        };
        self.frame.result = self.take(words);
        self.body();
        self.push(Op::End);
        let first = self.frame.result as usize;
        Ok((inputs, first..first + words as usize))
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
