//! The instructions of a program, and the words that each reads and writes.
//!
//! Operands are word numbers. During compilation, numbers from [`CONSTANT`] are constants; the finished program stores them
//! after the temporaries.

use crate::memory::{Atomic, Barrier};
use crate::packing::{Pack, Unpack};
use crate::scalar::{Binary, Ternary, Unary};
use crate::wide::Wide;

/// The number of a word of a machine.
pub(crate) type Word = u32;

/// The first word number of constants during compilation.
pub(crate) const CONSTANT: Word = 1 << 30;

/// The address that results from an index out of bounds. No buffer and no array contains it.
pub(crate) const OUT_OF_BOUNDS: u32 = u32::MAX;

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Op {
    /// Copies `count` words.
    Copy {
        to: Word,
        from: Word,
        count: u32,
    },
    Unary {
        op: Unary,
        to: Word,
        a: Word,
    },
    Binary {
        op: Binary,
        to: Word,
        a: Word,
        b: Word,
    },
    Ternary {
        op: Ternary,
        to: Word,
        a: Word,
        b: Word,
        c: Word,
    },
    /// An operation on 64-bit integers; the operation defines the widths.
    Wide {
        op: Wide,
        to: Word,
        a: Word,
        b: Word,
    },
    Pack {
        op: Pack,
        to: Word,
        a: Word,
    },
    Unpack {
        op: Unpack,
        to: Word,
        a: Word,
    },
    Jump {
        to: u32,
    },
    JumpUnless {
        condition: Word,
        to: u32,
    },
    /// Computes the address `base + index * stride`; `OUT_OF_BOUNDS` unless `index < bound`.
    Index {
        to: Word,
        base: Word,
        index: Word,
        stride: u32,
        bound: u32,
    },
    /// As `Index`; the bound is the number of elements in the buffer after `base` words.
    IndexRuntime {
        to: Word,
        base: Word,
        index: Word,
        stride: u32,
        buffer: u16,
    },
    /// Computes the number of elements of `stride` words in the buffer after `offset` words.
    Length {
        to: Word,
        buffer: u16,
        offset: u32,
        stride: u32,
    },
    /// Loads words of a variable: `variable` is its first word, `length` its length, `address` is relative to it.
    LoadLocal {
        to: Word,
        variable: Word,
        length: u32,
        address: Word,
        count: u32,
    },
    StoreLocal {
        variable: Word,
        length: u32,
        address: Word,
        from: Word,
        count: u32,
    },
    /// Loads the first `count` channels of a texel; `coordinates` are column, row, and sample or level.
    Texel {
        to: Word,
        texture: u16,
        coordinates: Word,
        count: u32,
    },
    /// Loads the columns, rows, and samples or slices of a texture.
    Extent {
        to: Word,
        texture: u16,
    },
    /// Loads a word of a buffer that the program does not write.
    Constant {
        to: Word,
        buffer: u16,
        address: Word,
        offset: u32,
    },
    Load {
        to: Word,
        buffer: u16,
        address: Word,
        offset: u32,
        words: u8,
        is_atomic: bool,
    },
    Store {
        from: Word,
        buffer: u16,
        address: Word,
        offset: u32,
        words: u8,
        is_atomic: bool,
    },
    /// Only a compare-exchange reads `expected`; after the old value it writes whether it exchanged.
    Atomic {
        function: Atomic,
        words: u8,
        buffer: u16,
        to: Word,
        address: Word,
        value: Word,
        expected: Word,
    },
    Fence,
    Barrier(Barrier),
    CriticalBegin,
    CriticalEnd,
    HelperLane {
        to: Word,
    },
    Discard,
    End,
}

/// The use of an operand: a range of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OperandUse {
    Read,
    Write,
    /// Writes an unknown subset of the words.
    WriteSome,
}

impl Op {
    /// Calls `visit` for every operand with its use, first word and length.
    pub(crate) fn visit_operands(&mut self, visit: &mut dyn FnMut(OperandUse, &mut Word, u32)) {
        use OperandUse::{Read, Write, WriteSome};
        match self {
            Op::Copy { to, from, count } => {
                visit(Read, from, *count);
                visit(Write, to, *count);
            }
            Op::Unary { to, a, .. } => {
                visit(Read, a, 1);
                visit(Write, to, 1);
            }
            Op::Binary { to, a, b, .. } => {
                visit(Read, a, 1);
                visit(Read, b, 1);
                visit(Write, to, 1);
            }
            Op::Ternary { to, a, b, c, .. } => {
                visit(Read, a, 1);
                visit(Read, b, 1);
                visit(Read, c, 1);
                visit(Write, to, 1);
            }
            Op::Wide { op, to, a, b } => {
                let (left, right, result) = op.widths();
                visit(Read, a, left);
                visit(Read, b, right);
                visit(Write, to, result);
            }
            Op::Pack { op, to, a } => {
                visit(Read, a, op.components());
                visit(Write, to, 1);
            }
            Op::Unpack { op, to, a } => {
                visit(Read, a, 1);
                visit(Write, to, op.components());
            }
            Op::JumpUnless { condition, .. } => visit(Read, condition, 1),
            Op::Index { to, base, index, .. } | Op::IndexRuntime { to, base, index, .. } => {
                visit(Read, base, 1);
                visit(Read, index, 1);
                visit(Write, to, 1);
            }
            Op::Texel { to, coordinates, count, .. } => {
                visit(Read, coordinates, 3);
                visit(Write, to, *count);
            }
            Op::Extent { to, .. } => visit(Write, to, 3),
            Op::Length { to, .. } | Op::HelperLane { to } => visit(Write, to, 1),
            Op::LoadLocal { to, variable, length, address, count } => {
                visit(Read, address, 1);
                visit(Read, variable, *length);
                visit(Write, to, *count);
            }
            Op::StoreLocal { variable, length, address, from, count } => {
                visit(Read, address, 1);
                visit(Read, from, *count);
                visit(WriteSome, variable, *length);
            }
            Op::Constant { to, address, .. } => {
                visit(Read, address, 1);
                visit(Write, to, 1);
            }
            Op::Load { to, address, words, .. } => {
                visit(Read, address, 1);
                visit(Write, to, u32::from(*words));
            }
            Op::Store { from, address, words, .. } => {
                visit(Read, address, 1);
                visit(Read, from, u32::from(*words));
            }
            Op::Atomic { function, words, to, address, value, expected, .. } => {
                let words = u32::from(*words);
                let exchanges = *function == Atomic::CompareExchange;
                visit(Read, address, 1);
                visit(Read, value, words);
                if exchanges {
                    visit(Read, expected, words);
                }
                visit(Write, to, words + u32::from(exchanges));
            }
            Op::Jump { .. }
            | Op::Fence
            | Op::Barrier(_)
            | Op::CriticalBegin
            | Op::CriticalEnd
            | Op::Discard
            | Op::End => {}
        }
    }

    /// Returns whether writing words is the only effect.
    pub(crate) fn is_pure(&self) -> bool {
        let flows = matches!(self, Op::Jump { .. } | Op::JumpUnless { .. } | Op::Discard | Op::End);
        !flows && !self.can_stop()
    }

    /// Returns whether a machine can stop at the instruction.
    pub(crate) fn can_stop(&self) -> bool {
        matches!(
            self,
            Op::Load { .. }
                | Op::Store { .. }
                | Op::Atomic { .. }
                | Op::Fence
                | Op::Barrier(_)
                | Op::CriticalBegin
                | Op::CriticalEnd
        )
    }

    /// Returns the possible successors of the instruction at `at`.
    pub(crate) fn successors(&self, at: usize) -> [Option<usize>; 2] {
        match self {
            Op::Jump { to } => [Some(*to as usize), None],
            Op::JumpUnless { to, .. } => [Some(at + 1), Some(*to as usize)],
            Op::Discard | Op::End => [None, None],
            _ => [Some(at + 1), None],
        }
    }
}
