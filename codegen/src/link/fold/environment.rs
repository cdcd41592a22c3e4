//! The declarations around a function.

use super::substitute::Substitute;
use crate::link::item::Item;

/// Looks up declarations by name.
pub(super) struct Environment<'e> {
    /// Returns the substitute of a declaration.
    pub(super) substitute: &'e dyn Fn(&str) -> Substitute,
    /// Returns whether a call of a function has side effects; `None` if the function is not declared.
    pub(super) has_effects: &'e dyn Fn(&str) -> Option<bool>,
    /// Returns the kind of a declaration; `None` if the name is not declared.
    pub(super) kind: &'e dyn Fn(&str) -> Option<DeclarationKind>,
}

/// The kind of a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DeclarationKind {
    Function,
    Variable,
    /// A constant or a type.
    Other,
}

impl DeclarationKind {
    pub(super) fn of(item: &Item<'_>) -> Self {
        match item {
            _ if item.is_function => DeclarationKind::Function,
            _ if item.is_variable => DeclarationKind::Variable,
            _ => DeclarationKind::Other,
        }
    }
}
