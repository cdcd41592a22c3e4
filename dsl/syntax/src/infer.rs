//! Type inference of numbers without a suffix. As in Rust, `1` is an `i32` unless its uses need another integer type.
//!
//! Input: types that must be equal, one pair at a time. Output: the type of each number without a suffix. An integer
//! literal never becomes an `f32`: Rust rejects it.

use crate::types::Type;

/// The type variables of the numbers of one function.
#[derive(Debug, Default)]
pub(crate) struct Inference {
    variables: Vec<TypeVariable>,
}

#[derive(Debug)]
struct TypeVariable {
    is_integer: bool,
    binding: Option<Type>,
}

impl Inference {
    /// Returns the type of an unsuffixed `1`.
    pub(crate) fn integer(&mut self) -> Type {
        self.variable(true)
    }

    /// Returns the type of an unsuffixed `1.0`.
    pub(crate) fn float(&mut self) -> Type {
        self.variable(false)
    }

    fn variable(&mut self, is_integer: bool) -> Type {
        self.variables.push(TypeVariable { is_integer, binding: None });
        Type::Unknown(self.variables.len() - 1)
    }

    /// Returns the type as far as it is known.
    pub(crate) fn resolve(&self, mut ty: Type) -> Type {
        // A variable is bound only once, and to an unbound variable or a type, so there is no cycle.
        while let Type::Unknown(index) = ty {
            match self.variables.get(index).and_then(|variable| variable.binding) {
                Some(next) => ty = next,
                None => return ty,
            }
        }
        ty
    }

    /// Returns the type after the whole function is checked: an unbound variable is an `i32` or an `f32`.
    pub(crate) fn resolve_or_default(&self, ty: Type) -> Type {
        match self.resolve(ty) {
            unbound @ Type::Unknown(_) => {
                if self.is_integer(unbound) {
                    Type::I32
                } else {
                    Type::F32
                }
            }
            known => known,
        }
    }

    /// Returns whether the type is an integer, known or inferred.
    pub(crate) fn is_integer(&self, ty: Type) -> bool {
        match self.resolve(ty) {
            Type::Unknown(index) => self.variables.get(index).is_some_and(|variable| variable.is_integer),
            known => known.is_integer(),
        }
    }

    /// Returns whether the type is an `f32`, known or inferred.
    pub(crate) fn is_float(&self, ty: Type) -> bool {
        match self.resolve(ty) {
            unbound @ Type::Unknown(_) => !self.is_integer(unbound),
            known => known == Type::F32,
        }
    }

    /// Unifies two types; returns the common type, or `None` if there is none.
    pub(crate) fn unify(&mut self, a: Type, b: Type) -> Option<Type> {
        let (a, b) = (self.resolve(a), self.resolve(b));
        match (a, b) {
            (Type::Error, other) | (other, Type::Error) | (Type::Never, other) | (other, Type::Never) => Some(other),
            _ if a == b => Some(a),
            (Type::Unknown(index), other) | (other, Type::Unknown(index)) => {
                let agrees =
                    if self.is_integer(Type::Unknown(index)) { self.is_integer(other) } else { self.is_float(other) };
                if !agrees {
                    return None;
                }
                if let Some(variable) = self.variables.get_mut(index) {
                    variable.binding = Some(other);
                }
                Some(other)
            }
            _ => None,
        }
    }

    /// Returns the type as a message names it.
    pub(crate) fn name(&self, ty: Type) -> &'static str {
        match self.resolve(ty) {
            unbound @ Type::Unknown(_) if self.is_integer(unbound) => "an integer",
            Type::Unknown(_) => "f32",
            known => known.rust(),
        }
    }
}
