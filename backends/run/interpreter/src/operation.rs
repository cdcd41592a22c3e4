//! The instructions: what they do to the words of an invocation, and which words they read and write.
//!
//! Operands are numbers of words. Numbers from [`CONSTANT`] on are constants until the program is finished, then the words
//! after the last frame. Nothing is executed here.

use crate::memory::Atomic;
use crate::packing::{Pack, Unpack};
use crate::scalar::{Binary, Ternary, Unary};
use crate::wide::Wide;

/// The number of a word.
pub(crate) type Word = u32;

/// Numbers from here on are constants of a program that is being made.
pub(crate) const CONSTANT: Word = 1 << 30;

/// An address that no buffer and no array has: an index went out of bounds on the way to it.
pub(crate) const NOWHERE: u32 = u32::MAX;

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Op {
    /// `count` words.
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
    /// Numbers of 64 bits; widths are the operation's.
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
    /// The address `base + index * stride`, `NOWHERE` unless `index < bound`.
    Index {
        to: Word,
        base: Word,
        index: Word,
        stride: u32,
        bound: u32,
    },
    /// The same, where the bound is what the buffer holds after `base` words.
    IndexRuntime {
        to: Word,
        base: Word,
        index: Word,
        stride: u32,
        buffer: u16,
    },
    /// Elements of `stride` words that the buffer holds after `offset` words.
    Length {
        to: Word,
        buffer: u16,
        offset: u32,
        stride: u32,
    },
    /// Words of a variable of this invocation: `variable` has `length` words, `address` counts from its first.
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
    /// The first `count` numbers of a texel; `place` has column, row, and sample or level.
    Texel {
        to: Word,
        texture: u16,
        place: Word,
        count: u32,
    },
    /// Columns, rows and samples of a texture.
    Extent {
        to: Word,
        texture: u16,
    },
    /// A word that nothing in the program writes.
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
    /// `expected` is read by a compare-exchange alone, which writes whether it exchanged after the old value.
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
    Barrier,
    CriticalBegin,
    CriticalEnd,
    HelperLane {
        to: Word,
    },
    Discard,
    End,
}

/// How an instruction touches a run of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    Read,
    Write,
    /// Some of them, nobody knows which.
    WriteSome,
}

impl Op {
    /// Every run of words that the instruction touches: how, the first word, how many.
    pub(crate) fn touches(&mut self, visit: &mut dyn FnMut(Touch, &mut Word, u32)) {
        use Touch::{Read, Write, WriteSome};
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
            Op::Texel { to, place, count, .. } => {
                visit(Read, place, 3);
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
            Op::Jump { .. } | Op::Fence | Op::Barrier | Op::CriticalBegin | Op::CriticalEnd | Op::Discard | Op::End => {
            }
        }
    }

    /// Whether all that it does is to write words.
    pub(crate) fn is_pure(&self) -> bool {
        let flows = matches!(self, Op::Jump { .. } | Op::JumpUnless { .. } | Op::Discard | Op::End);
        !flows && !self.is_stop()
    }

    /// Where a machine can stop.
    pub(crate) fn is_stop(&self) -> bool {
        matches!(
            self,
            Op::Load { .. }
                | Op::Store { .. }
                | Op::Atomic { .. }
                | Op::Fence
                | Op::Barrier
                | Op::CriticalBegin
                | Op::CriticalEnd
        )
    }

    /// Where the program may go on after the instruction at `at`.
    pub(crate) fn successors(&self, at: usize) -> [Option<usize>; 2] {
        match self {
            Op::Jump { to } => [Some(*to as usize), None],
            Op::JumpUnless { to, .. } => [Some(at + 1), Some(*to as usize)],
            Op::Discard | Op::End => [None, None],
            _ => [Some(at + 1), None],
        }
    }
}
