//! Compiles statements: blocks, branches, loops, stores, atomics and barriers.

use naga::{
    AtomicFunction, Barrier, Block, Expression, Handle, ScalarKind, Statement, SwitchCase, SwitchValue, TypeInner,
};

use super::compiler::{Compiler, PendingJumps, Result, Value};
use crate::layout::{Layouts, scalar_of};
use crate::memory::{self, Atomic};
use crate::operation::{Op, Word};
use crate::scalar::Binary;

/// The barriers of `workgroupUniformLoad`.
const WORKGROUP: memory::Barrier = memory::Barrier { storage: false, workgroup: true };

impl<'m> Compiler<'m> {
    pub(super) fn block(&mut self, block: &'m Block) {
        for (statement, span) in block.span_iter() {
            self.at(*span);
            if let Err(what) = self.statement(statement) {
                self.report_unsupported(what);
            }
            if matches!(statement, Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue)
            {
                // The statements after it are unreachable.
                break;
            }
        }
    }

    fn statement(&mut self, statement: &'m Statement) -> Result<()> {
        match statement {
            Statement::Emit(range) => {
                for expression in range.clone() {
                    self.at(self.callee.function.expressions.get_span(expression));
                    self.emit(expression)?;
                }
            }
            Statement::Block(block) => self.block(block),
            Statement::If { condition, accept, reject } => self.branch(*condition, accept, reject)?,
            Statement::Switch { selector, cases } => self.switch(*selector, cases)?,
            Statement::Loop { body, continuing, break_if } => self.loop_statement(body, continuing, *break_if)?,
            Statement::Break => {
                let jump = self.push(Op::Jump { to: 0 });
                self.callee.loops.last_mut().ok_or("a break outside a loop")?.breaks.push(jump);
            }
            Statement::Continue => {
                let jump = self.push(Op::Jump { to: 0 });
                let mut loops = self.callee.loops.iter_mut().rev();
                loops.find(|jumps| jumps.is_loop).ok_or("a continue outside a loop")?.continues.push(jump);
            }
            Statement::Return { value } => {
                if let Some(value) = value {
                    let count = self.layouts.dense(self.type_of(*value))?;
                    let from = self.words(*value)?;
                    self.push(Op::Copy { to: self.callee.result, from, count });
                }
                let jump = self.push(Op::Jump { to: 0 });
                self.callee.returns.push(jump);
            }
            Statement::Kill => {
                self.push(Op::Discard);
            }
            Statement::ControlBarrier(barrier) => {
                self.push(Op::Barrier(memory::Barrier {
                    storage: barrier.contains(Barrier::STORAGE),
                    workgroup: barrier.contains(Barrier::WORK_GROUP),
                }));
            }
            Statement::MemoryBarrier(barrier) if barrier.contains(Barrier::STORAGE) => {
                self.push(Op::Fence);
            }
            Statement::Store { pointer, value } => {
                let target = self.pointer(*pointer)?;
                let inner = self.layouts.pointee(self.type_of(*pointer))?;
                let from = self.words(*value)?;
                self.store(target, &inner, from)?;
            }
            Statement::Atomic { pointer, fun, value, result } => self.atomic(*pointer, fun, *value, *result)?,
            Statement::WorkGroupUniformLoad { pointer, result } => {
                self.push(Op::Barrier(WORKGROUP));
                let target = self.pointer(*pointer)?;
                let inner = self.layouts.pointee(self.type_of(*pointer))?;
                let words = self.load(target, &inner)?;
                self.callee.values[result.index()] = Some(Value::Words(words));
                self.push(Op::Barrier(WORKGROUP));
            }
            Statement::Call { function, arguments, result } => self.call(*function, arguments, *result)?,
            Statement::MemoryBarrier(_) => return Err("memory barriers over textures".to_owned()),
            Statement::ImageStore { .. } | Statement::ImageAtomic { .. } => return Err("writing textures".to_owned()),
            Statement::RayQuery { .. } | Statement::RayPipelineFunction(_) => return Err("rays".to_owned()),
            Statement::SubgroupBallot { .. }
            | Statement::SubgroupGather { .. }
            | Statement::SubgroupCollectiveOperation { .. } => return Err("subgroup operations".to_owned()),
            Statement::CooperativeStore { .. } => return Err("cooperative matrices".to_owned()),
        }
        Ok(())
    }

    fn next_index(&self) -> u32 {
        self.ops.len() as u32
    }

    /// Sets the target of jumps to the next instruction.
    pub(super) fn patch_to_here(&mut self, jumps: &[usize]) {
        let here = self.next_index();
        self.patch(jumps, here);
    }

    fn patch(&mut self, jumps: &[usize], target: u32) {
        for jump in jumps {
            if let Some(Op::Jump { to } | Op::JumpUnless { to, .. }) = self.ops.get_mut(*jump) {
                *to = target;
            }
        }
    }

    fn branch(&mut self, condition: Handle<Expression>, accept: &'m Block, reject: &'m Block) -> Result<()> {
        let condition = self.words(condition)?;
        let to_reject = self.push(Op::JumpUnless { condition, to: 0 });
        self.block(accept);
        if reject.is_empty() {
            self.patch_to_here(&[to_reject]);
            return Ok(());
        }
        let to_end = self.push(Op::Jump { to: 0 });
        self.patch_to_here(&[to_reject]);
        self.block(reject);
        self.patch_to_here(&[to_end]);
        Ok(())
    }

    fn loop_statement(
        &mut self,
        body: &'m Block,
        continuing: &'m Block,
        break_if: Option<Handle<Expression>>,
    ) -> Result<()> {
        let (start, site) = (self.next_index(), self.site);
        self.callee.loops.push(PendingJumps { is_loop: true, ..PendingJumps::default() });
        self.block(body);
        let continues = self.callee.loops.last_mut().map(|jumps| std::mem::take(&mut jumps.continues));
        self.patch_to_here(&continues.unwrap_or_default());
        self.block(continuing);
        let mut breaks = Vec::new();
        if let Some(condition) = break_if {
            let condition = self.words(condition)?;
            let next = self.push(Op::JumpUnless { condition, to: 0 });
            breaks.push(self.push(Op::Jump { to: 0 }));
            self.patch_to_here(&[next]);
        }
        // The jump back is at the span of the loop, which messages name by it.
        self.site = site;
        self.push(Op::Jump { to: start });
        breaks.extend(self.callee.loops.pop().map(|jumps| jumps.breaks).unwrap_or_default());
        self.patch_to_here(&breaks);
        Ok(())
    }

    fn switch(&mut self, selector: Handle<Expression>, cases: &'m [SwitchCase]) -> Result<()> {
        let selector = self.words(selector)?;
        let mut entries: Vec<Vec<usize>> = Vec::with_capacity(cases.len());
        let mut default = None;
        for (index, case) in cases.iter().enumerate() {
            let value = match case.value {
                SwitchValue::I32(value) => value as u32,
                SwitchValue::U32(value) => value,
                SwitchValue::Default => {
                    default = Some(index);
                    entries.push(Vec::new());
                    continue;
                }
            };
            let (b, to) = (self.constant(value), self.take(1));
            self.push(Op::Binary { op: Binary::NotEqual, to, a: selector, b });
            entries.push(vec![self.push(Op::JumpUnless { condition: to, to: 0 })]);
        }
        let to_default = self.push(Op::Jump { to: 0 });
        self.callee.loops.push(PendingJumps::default());
        for (index, case) in cases.iter().enumerate() {
            self.patch_to_here(&entries[index]);
            if default == Some(index) {
                self.patch_to_here(&[to_default]);
            }
            self.block(&case.body);
            if !case.fall_through {
                let jump = self.push(Op::Jump { to: 0 });
                if let Some(jumps) = self.callee.loops.last_mut() {
                    jumps.breaks.push(jump);
                }
            }
        }
        let breaks = self.callee.loops.pop().map(|jumps| jumps.breaks).unwrap_or_default();
        self.patch_to_here(&breaks);
        if default.is_none() {
            self.patch_to_here(&[to_default]);
        }
        Ok(())
    }

    fn atomic(
        &mut self,
        pointer: Handle<Expression>,
        function: &AtomicFunction,
        value: Handle<Expression>,
        result: Option<Handle<Expression>>,
    ) -> Result<()> {
        let target = self.pointer(pointer)?;
        let inner = self.layouts.pointee(self.type_of(pointer))?;
        let scalar = scalar_of(&inner).ok_or("an atomic operation on a type other than a number")?;
        if scalar.kind == ScalarKind::Float {
            return Err("atomic operations on floats".to_owned());
        }
        let words = Layouts::scalar_words(scalar)?;
        let is_signed = scalar.kind == ScalarKind::Sint;
        let (buffer, address) = self.shared_address(target)?;
        let value = self.words(value)?;
        let mut expected: Word = value;
        let function = match function {
            AtomicFunction::Add => Atomic::Add,
            AtomicFunction::Subtract => Atomic::Subtract,
            AtomicFunction::And => Atomic::And,
            AtomicFunction::InclusiveOr => Atomic::Or,
            AtomicFunction::ExclusiveOr => Atomic::ExclusiveOr,
            AtomicFunction::Min if is_signed => Atomic::SignedMin,
            AtomicFunction::Max if is_signed => Atomic::SignedMax,
            AtomicFunction::Min => Atomic::Min,
            AtomicFunction::Max => Atomic::Max,
            AtomicFunction::Exchange { compare: None } => Atomic::Exchange,
            AtomicFunction::Exchange { compare: Some(compare) } => {
                expected = self.words(*compare)?;
                Atomic::CompareExchange
            }
        };
        let exchanges = u32::from(function == Atomic::CompareExchange);
        let to = self.take(words + exchanges);
        self.push(Op::Atomic { function, words: words as u8, buffer, to, address, value, expected });
        if let Some(result) = result {
            self.callee.values[result.index()] = Some(Value::Words(to));
        }
        Ok(())
    }

    /// Returns the words of an expression that is a value.
    pub(super) fn words(&mut self, expression: Handle<Expression>) -> Result<Word> {
        match self.value(expression)? {
            Value::Words(words) => Ok(words),
            Value::Pointer(_) => Err("a pointer as a value".to_owned()),
            Value::Texture(_) => Err("a texture as a value".to_owned()),
        }
    }

    /// Returns the scalar kind of a type and its width in words.
    pub(super) fn kind_of(&self, inner: &TypeInner) -> Result<(ScalarKind, u32)> {
        let scalar = scalar_of(inner).ok_or("arithmetic on a type other than numbers")?;
        Ok((scalar.kind, Layouts::scalar_words(scalar)?))
    }
}
