//! Address arithmetic, loads and stores through pointers.

use naga::{Expression, Handle, TypeInner};

use super::compiler::{Compiler, Result, Value};
use super::pointer::{Pointer, PointerBase};
use crate::bytecode::Space;
use crate::operation::{Op, Word};

impl Compiler<'_> {
    /// Returns the pointer that an expression evaluates to.
    pub(super) fn pointer(&mut self, pointer: Handle<Expression>) -> Result<Pointer> {
        match self.value(pointer)? {
            Value::Pointer(pointer) => Ok(pointer),
            Value::Words(_) | Value::Texture(_) => Err("a pointer as a value".to_owned()),
        }
    }

    /// Returns a word with the whole address.
    fn address(&mut self, pointer: Pointer) -> Word {
        match pointer.dynamic {
            Some(dynamic) => dynamic,
            None => self.constant(pointer.offset),
        }
    }

    /// Returns a pointer to an element or member with a constant number.
    pub(super) fn element_at(&mut self, pointer: Pointer, inner: &TypeInner, number: u32) -> Result<Pointer> {
        let distance = self.layouts.element_offset(inner, number)?;
        let distance =
            if matches!(pointer.base, PointerBase::Variable { .. }) { distance.dense } else { distance.buffer };
        Ok(Pointer { offset: pointer.offset + distance, ..pointer })
    }

    /// Returns a pointer to the element whose number is in a word.
    pub(super) fn element_indexed(&mut self, pointer: Pointer, inner: &TypeInner, index: Word) -> Result<Pointer> {
        let elements = self.layouts.elements(inner)?;
        let base = match pointer.dynamic {
            // The offset is relative to the computed part, so it is added first.
            Some(dynamic) if pointer.offset == 0 => dynamic,
            Some(dynamic) => self.offset_address(dynamic, pointer.offset),
            None => self.constant(pointer.offset),
        };
        let to = self.take(1);
        match (pointer.base, elements.count) {
            (PointerBase::Variable { .. }, Some(bound)) => {
                self.push(Op::Index { to, base, index, stride: elements.stride.dense, bound });
            }
            (PointerBase::Buffer { .. }, Some(bound)) => {
                self.push(Op::Index { to, base, index, stride: elements.stride.buffer, bound });
            }
            (PointerBase::Buffer { buffer }, None) => {
                self.push(Op::IndexRuntime { to, base, index, stride: elements.stride.buffer, buffer });
            }
            (PointerBase::Variable { .. }, None) => return Err("a runtime-sized variable".to_owned()),
        }
        Ok(Pointer { offset: 0, dynamic: Some(to), ..pointer })
    }

    /// Adds `by` words to an address; `OUT_OF_BOUNDS` stays `OUT_OF_BOUNDS`.
    fn offset_address(&mut self, address: Word, by: u32) -> Word {
        let zero = self.constant(0);
        let to = self.take(1);
        self.push(Op::Index { to, base: address, index: zero, stride: 0, bound: 1 });
        // An `Index` of one stride is an addition that preserves `OUT_OF_BOUNDS`.
        let one = self.constant(1);
        self.push(Op::Index { to, base: to, index: one, stride: by, bound: 2 });
        to
    }

    /// Loads the value at a pointer into new words.
    pub(super) fn load(&mut self, pointer: Pointer, inner: &TypeInner) -> Result<Word> {
        let count = self.layouts.dense(inner)?;
        let to = self.take(count);
        match pointer.base {
            PointerBase::Variable { first, length } => match pointer.dynamic {
                None => {
                    self.push(Op::Copy { to, from: first + pointer.offset, count });
                }
                Some(dynamic) => {
                    let address =
                        if pointer.offset == 0 { dynamic } else { self.offset_address(dynamic, pointer.offset) };
                    self.push(Op::LoadLocal { to, variable: first, length, address, count });
                }
            },
            PointerBase::Buffer { buffer } => {
                let is_atomic = self.is_atomic_access(buffer, inner);
                let (address, constant) = self.split(pointer);
                let mut at = to;
                for (offset, words) in self.scalars(inner)? {
                    for (word, words) in self.accesses(buffer, words) {
                        let offset = constant + offset + word;
                        self.push(Op::Load { to: at + word, buffer, address, offset, words, is_atomic });
                    }
                    at += words;
                }
            }
        }
        Ok(to)
    }

    /// Stores a value at a pointer.
    pub(super) fn store(&mut self, pointer: Pointer, inner: &TypeInner, from: Word) -> Result<()> {
        let count = self.layouts.dense(inner)?;
        match pointer.base {
            PointerBase::Variable { first, length } => match pointer.dynamic {
                None => {
                    self.push(Op::Copy { to: first + pointer.offset, from, count });
                }
                Some(dynamic) => {
                    let address =
                        if pointer.offset == 0 { dynamic } else { self.offset_address(dynamic, pointer.offset) };
                    self.push(Op::StoreLocal { variable: first, length, address, from, count });
                }
            },
            PointerBase::Buffer { buffer } => {
                let is_atomic = self.is_atomic_access(buffer, inner);
                let (address, constant) = self.split(pointer);
                let mut at = from;
                for (offset, words) in self.scalars(inner)? {
                    for (word, words) in self.accesses(buffer, words) {
                        let offset = constant + offset + word;
                        self.push(Op::Store { from: at + word, buffer, address, offset, words, is_atomic });
                    }
                    at += words;
                }
            }
        }
        Ok(())
    }

    /// Tests whether a load or store of a value is atomic: its type is, and the present function is not one whose accesses are plain.
    fn is_atomic_access(&mut self, buffer: u16, inner: &TypeInner) -> bool {
        if !matches!(inner, TypeInner::Atomic(_)) {
            return false;
        }
        let name = self.callee.function.name.as_ref();
        let is_plain = name.is_some_and(|name| self.options.plain_functions.contains(name));
        self.buffers[usize::from(buffer)].is_mixed |= is_plain;
        !is_plain
    }

    /// Returns the buffer and the address of an atomic operation.
    pub(super) fn shared_address(&mut self, pointer: Pointer) -> Result<(u16, Word)> {
        let PointerBase::Buffer { buffer } = pointer.base else {
            return Err("an atomic variable outside a buffer".to_owned());
        };
        let address = match pointer.dynamic {
            Some(dynamic) if pointer.offset > 0 => self.offset_address(dynamic, pointer.offset),
            _ => self.address(pointer),
        };
        Ok((buffer, address))
    }

    /// Splits an address into a word with its computed part, and its constant part.
    fn split(&mut self, pointer: Pointer) -> (Word, u32) {
        match pointer.dynamic {
            Some(dynamic) => (dynamic, pointer.offset),
            None => (self.constant(0), pointer.offset),
        }
    }

    fn scalars(&self, inner: &TypeInner) -> Result<Vec<(u32, u32)>> {
        let mut scalars = Vec::new();
        self.layouts.scalars(inner, 0, &mut scalars)?;
        Ok(scalars)
    }

    /// Returns the accesses to a number of this width, as offsets and widths. A 64-bit number is one access in storage
    /// buffers, and two in uniform buffers, which are read-only.
    fn accesses(&self, buffer: u16, words: u32) -> Vec<(u32, u8)> {
        match self.buffers[usize::from(buffer)].space {
            Space::Uniform => (0..words).map(|word| (word, 1)).collect(),
            _ => vec![(0, words as u8)],
        }
    }
}
