//! A value for each expression of a function, by its handle.

use std::ops::{Index, IndexMut};

use naga::{Expression, Function, Handle};

/// The values, in the order of the expressions.
pub struct PerExpression<T>(Vec<T>);

impl<T: Clone + Default> PerExpression<T> {
    /// Returns the default value for each expression.
    pub fn new(function: &Function) -> Self {
        Self(vec![T::default(); function.expressions.len()])
    }
}

impl<T> Index<Handle<Expression>> for PerExpression<T> {
    type Output = T;

    fn index(&self, expression: Handle<Expression>) -> &T {
        &self.0[expression.index()]
    }
}

impl<T> IndexMut<Handle<Expression>> for PerExpression<T> {
    fn index_mut(&mut self, expression: Handle<Expression>) -> &mut T {
        &mut self.0[expression.index()]
    }
}
