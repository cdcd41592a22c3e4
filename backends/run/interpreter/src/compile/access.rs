//! Compiles accesses to elements and members, of values and through pointers.

use naga::{Expression, Handle};

use super::compiler::{Compiler, Result, Value};
use super::pointer::{Pointer, PointerBase};
use crate::operation::Op;

impl Compiler<'_> {
    /// Compiles `base[index]`.
    pub(super) fn access(&mut self, base: Handle<Expression>, index: Handle<Expression>) -> Result<Value> {
        let inner = self.pointee_or_type(base)?;
        let index = self.words(index)?;
        if self.is_pointer(base) {
            let target = self.pointer(base)?;
            return Ok(Value::Pointer(self.element_indexed(target, &inner, index)?));
        }
        let first = self.words(base)?;
        let length = self.layouts.dense(&inner)?;
        // A value is like a variable that is never written.
        let whole = Pointer::to_variable(first, length);
        let part = self.element_indexed(whole, &inner, index)?;
        let kind = self.layouts.element_type(&inner, 0)?;
        Ok(Value::Words(self.load(part, &kind)?))
    }

    /// Compiles `base.member`, or `base[number]` with a constant number.
    pub(super) fn access_at(&mut self, base: Handle<Expression>, number: u32) -> Result<Value> {
        let inner = self.pointee_or_type(base)?;
        if self.is_pointer(base) {
            let target = self.pointer(base)?;
            if let Ok(elements) = self.layouts.elements(&inner)
                && elements.count.is_none()
            {
                let index = self.constant(number);
                return Ok(Value::Pointer(self.element_indexed(target, &inner, index)?));
            }
            return Ok(Value::Pointer(self.element_at(target, &inner, number)?));
        }
        let first = self.words(base)?;
        Ok(Value::Words(first + self.layouts.element_offset(&inner, number)?.dense))
    }

    /// Compiles `arrayLength` of an array at the end of a buffer.
    pub(super) fn array_length(&mut self, array: Handle<Expression>) -> Result<u32> {
        let target = self.pointer(array)?;
        let inner = self.pointee_or_type(array)?;
        let stride = self.layouts.elements(&inner)?.stride.buffer;
        let PointerBase::Buffer { buffer } = target.base else { return Err("the length of a variable".to_owned()) };
        let to = self.take(1);
        self.push(Op::Length { to, buffer, offset: target.offset, stride });
        Ok(to)
    }
}
