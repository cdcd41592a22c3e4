//! Parts of values and of what pointers point to.

use naga::{Expression, Handle};

use super::place::{Home, Spot};
use super::{Compiler, Result, Value};
use crate::operation::Op;

impl Compiler<'_> {
    /// `base[index]`
    pub(super) fn access(&mut self, base: Handle<Expression>, index: Handle<Expression>) -> Result<Value> {
        let inner = self.pointee_or_own(base)?;
        let index = self.words(index)?;
        if self.is_pointer(base) {
            let spot = self.spot(base)?;
            return Ok(Value::Spot(self.indexed(spot, &inner, index)?));
        }
        let first = self.words(base)?;
        let length = self.shapes.dense(&inner)?;
        // A value is a variable that nobody writes.
        let whole = Spot { home: Home::Local { first, length }, offset: 0, moving: None };
        let part = self.indexed(whole, &inner, index)?;
        let kind = self.shapes.part_type(&inner, 0)?;
        Ok(Value::Words(self.load(part, &kind)?))
    }

    /// `base.member`, or `base[number]` with a number that is known.
    pub(super) fn access_at(&mut self, base: Handle<Expression>, number: u32) -> Result<Value> {
        let inner = self.pointee_or_own(base)?;
        if self.is_pointer(base) {
            let spot = self.spot(base)?;
            if let Ok(parts) = self.shapes.parts(&inner)
                && parts.count.is_none()
            {
                let index = self.constant(number);
                return Ok(Value::Spot(self.indexed(spot, &inner, index)?));
            }
            return Ok(Value::Spot(self.part_of(spot, &inner, number)?));
        }
        let first = self.words(base)?;
        Ok(Value::Words(first + self.shapes.part(&inner, number)?.dense))
    }

    /// Elements of an array at the end of a buffer.
    pub(super) fn array_length(&mut self, array: Handle<Expression>) -> Result<u32> {
        let spot = self.spot(array)?;
        let inner = self.pointee_or_own(array)?;
        let stride = self.shapes.parts(&inner)?.stride.buffer;
        let Home::Shared { buffer } = spot.home else { return Err("the length of a variable".to_owned()) };
        let to = self.take(1);
        self.push(Op::Length { to, buffer, offset: spot.offset, stride });
        Ok(to)
    }
}
