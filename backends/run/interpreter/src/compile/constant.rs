//! Constants: literals, constant expressions and zeros, as words.

use naga::{Expression, Handle, Literal, TypeInner};

use super::{Compiler, Result};
use crate::operation::Word;

impl Compiler<'_> {
    /// Words that are zero.
    pub(super) fn zeros(&mut self, count: u32) -> Word {
        if count == 1 { self.constant(0) } else { self.constants_in_a_row(&vec![0; count as usize]) }
    }

    /// The dense words of a constant expression of the module.
    pub(super) fn constant_value(&self, expression: Handle<Expression>) -> Result<Vec<u32>> {
        match &self.module.global_expressions[expression] {
            Expression::Literal(literal) => literal_words(literal),
            Expression::Constant(constant) => self.constant_value(self.module.constants[*constant].init),
            Expression::Override(handle) => match self.module.overrides[*handle].init {
                Some(init) => self.constant_value(init),
                None => Err("an override without a value".to_owned()),
            },
            Expression::ZeroValue(kind) => Ok(vec![0; self.shapes.dense(self.shapes.inner(*kind))? as usize]),
            Expression::Compose { components, .. } => {
                let parts: Result<Vec<Vec<u32>>> = components.iter().map(|part| self.constant_value(*part)).collect();
                Ok(parts?.concat())
            }
            Expression::Splat { size, value } => {
                Ok(self.constant_value(*value)?.repeat(crate::shape::count(*size) as usize))
            }
            _ => Err("this constant expression".to_owned()),
        }
    }

    /// A value of zeros.
    pub(super) fn zero_value(&mut self, inner: &TypeInner) -> Result<Word> {
        let count = self.shapes.dense(inner)?;
        Ok(self.zeros(count))
    }
}

/// The words of a literal.
pub(super) fn literal_words(literal: &Literal) -> Result<Vec<u32>> {
    match *literal {
        Literal::F32(value) => Ok(vec![value.to_bits()]),
        Literal::U32(value) => Ok(vec![value]),
        Literal::I32(value) => Ok(vec![value as u32]),
        Literal::Bool(value) => Ok(vec![u32::from(value)]),
        Literal::U64(value) => Ok(vec![value as u32, (value >> 32) as u32]),
        Literal::I64(value) => Ok(vec![value as u32, (value >> 32) as u32]),
        _ => Err("numbers of 16 bits and floats of 64".to_owned()),
    }
}
