//! Compiles literals, constant expressions and zero values to words.

use naga::{Expression, Handle, Literal, TypeInner};

use super::compiler::{Compiler, Result};
use crate::operation::Word;

impl Compiler<'_> {
    /// Returns words that are zero.
    pub(super) fn zeros(&mut self, count: u32) -> Word {
        if count == 1 { self.constant(0) } else { self.consecutive_constants(&vec![0; count as usize]) }
    }

    /// Returns the dense words of a constant expression of the module.
    pub(super) fn constant_value(&self, expression: Handle<Expression>) -> Result<Vec<u32>> {
        match &self.module.global_expressions[expression] {
            Expression::Literal(literal) => literal_words(literal),
            Expression::Constant(constant) => self.constant_value(self.module.constants[*constant].init),
            Expression::Override(handle) => match self.module.overrides[*handle].init {
                Some(init) => self.constant_value(init),
                None => Err("an override without a value".to_owned()),
            },
            Expression::ZeroValue(kind) => Ok(vec![0; self.layouts.dense(self.layouts.inner(*kind))? as usize]),
            Expression::Compose { components, .. } => {
                let parts: Result<Vec<Vec<u32>>> = components.iter().map(|part| self.constant_value(*part)).collect();
                Ok(parts?.concat())
            }
            Expression::Splat { size, value } => {
                Ok(self.constant_value(*value)?.repeat(crate::layout::count(*size) as usize))
            }
            _ => Err("this constant expression".to_owned()),
        }
    }

    /// Returns the zero value of a type.
    pub(super) fn zero_value(&mut self, inner: &TypeInner) -> Result<Word> {
        let count = self.layouts.dense(inner)?;
        Ok(self.zeros(count))
    }
}

/// Returns the words of a literal.
pub(super) fn literal_words(literal: &Literal) -> Result<Vec<u32>> {
    match *literal {
        Literal::F32(value) => Ok(vec![value.to_bits()]),
        Literal::U32(value) => Ok(vec![value]),
        Literal::I32(value) => Ok(vec![value as u32]),
        Literal::Bool(value) => Ok(vec![u32::from(value)]),
        Literal::U64(value) => Ok(vec![value as u32, (value >> 32) as u32]),
        Literal::I64(value) => Ok(vec![value as u32, (value >> 32) as u32]),
        _ => Err("16-bit numbers and 64-bit floats".to_owned()),
    }
}
