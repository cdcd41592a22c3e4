//! Pointers during compilation.
//!
//! A machine has no pointer values: the compiler tracks each pointer's variable or buffer, and its address up to one
//! computed word.

use crate::operation::Word;

/// A pointer: a variable or buffer and an address in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pointer {
    pub(super) base: PointerBase,
    /// The constant part of the address, in words.
    pub(super) offset: u32,
    /// The word of the machine that holds the computed part of the address, to which `offset` is added.
    pub(super) dynamic: Option<Word>,
}

/// The memory that a pointer points into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PointerBase {
    /// A variable of this invocation: its first word and its length in words.
    Variable { first: Word, length: u32 },
    /// A buffer, by its number.
    Buffer { buffer: u16 },
}

impl Pointer {
    pub(super) fn to_variable(first: Word, length: u32) -> Self {
        Pointer { base: PointerBase::Variable { first, length }, offset: 0, dynamic: None }
    }

    pub(super) fn to_buffer(buffer: u16) -> Self {
        Pointer { base: PointerBase::Buffer { buffer }, offset: 0, dynamic: None }
    }
}
