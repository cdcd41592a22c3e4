//! Places that pointers point to, and moving values between them and a frame.
//!
//! A pointer is never a value of the machine: where it points to is known when the program is made, up to one number.

use naga::{Expression, Handle, TypeInner};

use super::{Compiler, Result, Value};
use crate::operation::{Op, Word};
use crate::program::Space;

/// A place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Spot {
    pub(super) home: Home,
    /// Words from the beginning of the home: known now.
    pub(super) offset: u32,
    /// A word of the frame that holds more of them; everything before it is in it.
    pub(super) moving: Option<Word>,
}

/// What a place is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Home {
    /// A variable of this invocation: its first word, its words.
    Local { first: Word, length: u32 },
    /// A buffer.
    Shared { buffer: u16 },
}

impl Spot {
    pub(super) fn local(first: Word, length: u32) -> Self {
        Spot { home: Home::Local { first, length }, offset: 0, moving: None }
    }

    pub(super) fn shared(buffer: u16) -> Self {
        Spot { home: Home::Shared { buffer }, offset: 0, moving: None }
    }
}

impl Compiler<'_> {
    /// The place that an expression points to.
    pub(super) fn spot(&mut self, pointer: Handle<Expression>) -> Result<Spot> {
        match self.value(pointer)? {
            Value::Spot(spot) => Ok(spot),
            Value::Words(_) | Value::Texture(_) => Err("a pointer that is a value".to_owned()),
        }
    }

    /// A word that holds the whole address.
    fn address(&mut self, spot: Spot) -> Word {
        match spot.moving {
            Some(moving) => moving,
            None => self.constant(spot.offset),
        }
    }

    /// The part of a place at a number that is known now.
    pub(super) fn part_of(&mut self, spot: Spot, inner: &TypeInner, number: u32) -> Result<Spot> {
        let distance = self.shapes.part(inner, number)?;
        let distance = if matches!(spot.home, Home::Local { .. }) { distance.dense } else { distance.buffer };
        Ok(Spot { offset: spot.offset + distance, ..spot })
    }

    /// The part of a place at a number that a word holds.
    pub(super) fn indexed(&mut self, spot: Spot, inner: &TypeInner, index: Word) -> Result<Spot> {
        let parts = self.shapes.parts(inner)?;
        let base = match spot.moving {
            // What is known now comes after what moved: it stays apart, to be added at the access.
            Some(moving) if spot.offset == 0 => moving,
            Some(moving) => self.moved(moving, spot.offset),
            None => self.constant(spot.offset),
        };
        let to = self.take(1);
        match (spot.home, parts.count) {
            (Home::Local { .. }, Some(bound)) => {
                self.push(Op::Index { to, base, index, stride: parts.stride.dense, bound });
            }
            (Home::Shared { .. }, Some(bound)) => {
                self.push(Op::Index { to, base, index, stride: parts.stride.buffer, bound });
            }
            (Home::Shared { buffer }, None) => {
                self.push(Op::IndexRuntime { to, base, index, stride: parts.stride.buffer, buffer });
            }
            (Home::Local { .. }, None) => return Err("a variable of unknown length".to_owned()),
        }
        Ok(Spot { offset: 0, moving: Some(to), ..spot })
    }

    /// An address `by` words on; nowhere stays nowhere.
    fn moved(&mut self, address: Word, by: u32) -> Word {
        let zero = self.constant(0);
        let to = self.take(1);
        self.push(Op::Index { to, base: address, index: zero, stride: 0, bound: 1 });
        // An index of one stride is a sum that keeps `NOWHERE`.
        let one = self.constant(1);
        self.push(Op::Index { to, base: to, index: one, stride: by, bound: 2 });
        to
    }

    /// The value at a place, in words of the frame.
    pub(super) fn load(&mut self, spot: Spot, inner: &TypeInner) -> Result<Word> {
        let count = self.shapes.dense(inner)?;
        let to = self.take(count);
        match spot.home {
            Home::Local { first, length } => match spot.moving {
                None => {
                    self.push(Op::Copy { to, from: first + spot.offset, count });
                }
                Some(moving) => {
                    let address = if spot.offset == 0 { moving } else { self.moved(moving, spot.offset) };
                    self.push(Op::LoadLocal { to, variable: first, length, address, count });
                }
            },
            Home::Shared { buffer } => {
                let is_atomic = matches!(inner, TypeInner::Atomic(_));
                let (address, known) = self.split(spot);
                let mut at = to;
                for (offset, words) in self.numbers(inner)? {
                    for (word, words) in self.accesses(buffer, words) {
                        let offset = known + offset + word;
                        self.push(Op::Load { to: at + word, buffer, address, offset, words, is_atomic });
                    }
                    at += words;
                }
            }
        }
        Ok(to)
    }

    /// Puts a value at a place.
    pub(super) fn store(&mut self, spot: Spot, inner: &TypeInner, from: Word) -> Result<()> {
        let count = self.shapes.dense(inner)?;
        match spot.home {
            Home::Local { first, length } => match spot.moving {
                None => {
                    self.push(Op::Copy { to: first + spot.offset, from, count });
                }
                Some(moving) => {
                    let address = if spot.offset == 0 { moving } else { self.moved(moving, spot.offset) };
                    self.push(Op::StoreLocal { variable: first, length, address, from, count });
                }
            },
            Home::Shared { buffer } => {
                let is_atomic = matches!(inner, TypeInner::Atomic(_));
                let (address, known) = self.split(spot);
                let mut at = from;
                for (offset, words) in self.numbers(inner)? {
                    for (word, words) in self.accesses(buffer, words) {
                        let offset = known + offset + word;
                        self.push(Op::Store { from: at + word, buffer, address, offset, words, is_atomic });
                    }
                    at += words;
                }
            }
        }
        Ok(())
    }

    /// The buffer and the address of a place that an atomic operation works on.
    pub(super) fn shared_address(&mut self, spot: Spot) -> Result<(u16, Word)> {
        let Home::Shared { buffer } = spot.home else { return Err("an atomic variable of one invocation".to_owned()) };
        let address = match spot.moving {
            Some(moving) if spot.offset > 0 => self.moved(moving, spot.offset),
            _ => self.address(spot),
        };
        Ok((buffer, address))
    }

    /// A word with the part of the address that moves, and the part that is known.
    fn split(&mut self, spot: Spot) -> (Word, u32) {
        match spot.moving {
            Some(moving) => (moving, spot.offset),
            None => (self.constant(0), spot.offset),
        }
    }

    fn numbers(&self, inner: &TypeInner) -> Result<Vec<(u32, u32)>> {
        let mut numbers = Vec::new();
        self.shapes.numbers(inner, 0, &mut numbers)?;
        Ok(numbers)
    }

    /// How a number of this many words is read or written: numbers of 64 bits as one in storage, word by word in uniform
    /// buffers, which nobody writes.
    fn accesses(&self, buffer: u16, words: u32) -> Vec<(u32, u8)> {
        match self.buffers[usize::from(buffer)].space {
            Space::Uniform => (0..words).map(|word| (word, 1)).collect(),
            _ => vec![(0, words as u8)],
        }
    }
}
