//! The instructions of a lane machine that differ per lane: accesses to memory and local arrays, and operations on several words.

use std::sync::atomic::{AtomicU32, Ordering};

use super::machine::LaneMachine;
use super::memory::LaneMemory;
use super::set::{LANES, Lanes};
use crate::machine::{OutOfBoundsAccess, index_address};
use crate::memory::{Access, Atomic, Operation, WordAddress};
use crate::operation::Op;
use crate::packing::Pack;

impl LaneMachine<'_> {
    /// Runs the instruction at `at` for the active lanes.
    pub(super) fn access<M: LaneMemory>(&mut self, at: u32, op: &Op, memory: &M) {
        match *op {
            Op::IndexRuntime { to, base, index, stride, buffer } => {
                let length = memory.words(buffer).len() as u32;
                let value = self.runtime_addresses(base, index, stride, length);
                self.write(to, value);
            }
            Op::Length { to, buffer, offset, stride } => {
                let length = memory.words(buffer).len() as u32;
                self.write(to, [length.saturating_sub(offset) / stride.max(1); LANES]);
            }
            Op::LoadLocal { to, variable, length, address, count } => {
                self.load_local(at, (variable, length), address, to, count);
            }
            Op::StoreLocal { variable, length, address, from, count } => {
                self.store_local(at, (variable, length), address, from, count);
            }
            Op::Constant { to, buffer, address, offset }
            | Op::Load { to, buffer, address, offset, words: 1, is_atomic: _ } => {
                self.load(at, memory.words(buffer), address, offset, to);
            }
            Op::Store { from, buffer, address, offset, words: 1, is_atomic: _ } => {
                self.store(at, memory.words(buffer), address, offset, from);
            }
            Op::Load { to, buffer, address, offset, words, is_atomic } => {
                self.each_access(
                    at,
                    memory,
                    (buffer, address, offset, words),
                    |_, _| (Operation::Load, is_atomic, 0, 0),
                    |machine, lane, old| {
                        machine.write_wide(to, words.into(), lane, old.unwrap_or(0));
                    },
                );
            }
            Op::Store { from, buffer, address, offset, words, is_atomic } => {
                self.each_access(
                    at,
                    memory,
                    (buffer, address, offset, words),
                    |machine, lane| (Operation::Store, is_atomic, machine.read_wide(from, words.into(), lane), 0),
                    |_, _, _| {},
                );
            }
            Op::Atomic { function, words, buffer, to, address, value, expected } => {
                let exchanges = function == Atomic::CompareExchange;
                let width = u32::from(words);
                let expected =
                    |machine: &Self, lane| if exchanges { machine.read_wide(expected, width, lane) } else { 0 };
                self.each_access(
                    at,
                    memory,
                    (buffer, address, 0, words),
                    |machine, lane| {
                        let value = machine.read_wide(value, width, lane);
                        (Operation::Atomic(function), true, value, expected(machine, lane))
                    },
                    |machine, lane, old| {
                        let exchanged = exchanges && old == Some(expected(machine, lane));
                        machine.write_wide(to, width, lane, old.unwrap_or(0));
                        if exchanges {
                            machine.words[(to + width) as usize][lane] = u32::from(exchanged);
                        }
                    },
                );
            }
            Op::Texel { to, texture, coordinates, count } => {
                for lane in self.flow.active {
                    let coordinates = [0, 1, 2].map(|axis| self.words[coordinates as usize + axis][lane]);
                    let texel = memory.texel(texture, coordinates).unwrap_or_else(|| {
                        self.report_out_of_bounds(at);
                        [0; 4]
                    });
                    for (word, channel) in self.words[to as usize..(to + count) as usize].iter_mut().zip(texel) {
                        word[lane] = channel;
                    }
                }
            }
            Op::Extent { to, texture } => {
                for (number, words) in (0..).zip(memory.extent(texture)) {
                    self.write(to + number, [words; LANES]);
                }
            }
            Op::Wide { op, to, a, b } => {
                let (left, right, result) = op.widths();
                for lane in self.flow.active {
                    let value = op.apply(self.read_wide(a, left, lane), self.read_wide(b, right, lane));
                    self.write_wide(to, result, lane, value);
                }
            }
            Op::Pack { op, to, a } => {
                let value = self.packed(op, a);
                self.write(to, value);
            }
            Op::Unpack { op, to, a } => {
                let packed = self.words[a as usize];
                for number in 0..op.components() {
                    let mut value = [0; LANES];
                    for lane in 0..LANES {
                        value[lane] = op.component(packed[lane], number);
                    }
                    self.write(to + number, value);
                }
            }
            Op::HelperLane { to } => self.write(to, [0; LANES]),
            // Accesses take effect at once, so there is nothing to order.
            Op::Fence | Op::CriticalBegin | Op::CriticalEnd => {}
            // The interpreter loop runs these.
            Op::Barrier(_)
            | Op::Copy { .. }
            | Op::Unary { .. }
            | Op::Binary { .. }
            | Op::Ternary { .. }
            | Op::Jump { .. }
            | Op::JumpUnless { .. }
            | Op::Index { .. }
            | Op::Discard
            | Op::End => {}
        }
    }

    fn report_out_of_bounds(&mut self, at: u32) {
        let at = self.origin(at);
        self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at });
    }

    /// Computes the addresses of elements of a runtime-sized array. Most bases are equal in all lanes, and a division is slow.
    fn runtime_addresses(&self, base: u32, index: u32, stride: u32, length: u32) -> Lanes {
        let [base, index] = [base, index].map(|word| &self.words[word as usize]);
        let bound = |base: u32| length.saturating_sub(base) / stride.max(1);
        let bounds = match uniform(base) {
            Some(base) => [bound(base); LANES],
            None => base.map(bound),
        };
        let mut value = [0; LANES];
        for lane in 0..LANES {
            value[lane] = index_address(base[lane], index[lane], stride, bounds[lane], false);
        }
        value
    }

    fn packed(&self, op: Pack, a: u32) -> Lanes {
        let words = &self.words[a as usize..(a + op.components()) as usize];
        let mut value = [0; LANES];
        if op == Pack::Unorm8 {
            // The operation of colours, as a loop of vector instructions.
            for (number, word) in words.iter().enumerate() {
                for lane in 0..LANES {
                    value[lane] |= Pack::Unorm8.component(word[lane]) << (8 * number);
                }
            }
            return value;
        }
        for lane in self.flow.active {
            let mut components = [0; 4];
            components.iter_mut().zip(words).for_each(|(component, word)| *component = word[lane]);
            value[lane] = op.apply(&components[..words.len()]);
        }
        value
    }

    fn load_local(&mut self, at: u32, (variable, length): (u32, u32), address: u32, to: u32, count: u32) {
        let addresses = self.words[address as usize];
        for lane in self.flow.active {
            let address = addresses[lane];
            if address.saturating_add(count) <= length {
                for number in 0..count {
                    self.words[(to + number) as usize][lane] = self.words[(variable + address + number) as usize][lane];
                }
            } else {
                self.words[to as usize..(to + count) as usize].iter_mut().for_each(|word| word[lane] = 0);
                self.report_out_of_bounds(at);
            }
        }
    }

    fn store_local(&mut self, at: u32, (variable, length): (u32, u32), address: u32, from: u32, count: u32) {
        let addresses = self.words[address as usize];
        for lane in self.flow.active {
            let address = addresses[lane];
            if address.saturating_add(count) <= length {
                for number in 0..count {
                    self.words[(variable + address + number) as usize][lane] =
                        self.words[(from + number) as usize][lane];
                }
            } else {
                self.report_out_of_bounds(at);
            }
        }
    }

    fn load(&mut self, at: u32, words: &[AtomicU32], address: u32, offset: u32, to: u32) {
        if let Some(address) = uniform(&self.words[address as usize])
            && let Some(word) = element(words, address, offset)
        {
            self.write(to, [word.load(Ordering::Relaxed); LANES]);
            return;
        }
        let (addresses, mut value) = (self.words[address as usize], self.words[to as usize]);
        for lane in self.flow.active {
            value[lane] = match element(words, addresses[lane], offset) {
                Some(word) => word.load(Ordering::Relaxed),
                None => {
                    self.report_out_of_bounds(at);
                    0
                }
            };
        }
        self.words[to as usize] = value;
    }

    fn store(&mut self, at: u32, words: &[AtomicU32], address: u32, offset: u32, from: u32) {
        let (addresses, value) = (self.words[address as usize], self.words[from as usize]);
        for lane in self.flow.active {
            match element(words, addresses[lane], offset) {
                Some(word) => word.store(value[lane], Ordering::Relaxed),
                None => self.report_out_of_bounds(at),
            }
        }
    }

    /// Performs the access that `operation` returns, for each active lane in ascending order, and calls `done` with the old value. `None`:
    /// the address is out of bounds.
    fn each_access<M: LaneMemory>(
        &mut self,
        at: u32,
        memory: &M,
        (buffer, address, offset, words): (u16, u32, u32, u8),
        operation: impl Fn(&Self, usize) -> (Operation, bool, u64, u64),
        done: impl Fn(&mut Self, usize, Option<u64>),
    ) {
        let buffer_words = memory.words(buffer);
        for lane in self.flow.active {
            let address = self.words[address as usize][lane];
            let last = element(buffer_words, address, offset + u32::from(words) - 1);
            let old = match (element(buffer_words, address, offset), last) {
                (Some(word), Some(_)) => {
                    let (operation, is_atomic, value, expected) = operation(self, lane);
                    let address = WordAddress { buffer, word: address + offset };
                    let access = Access { address, operation, words, is_atomic, value, expected };
                    Some(if words == 1 { access.perform(word).into() } else { memory.wide(&access) })
                }
                _ => {
                    self.report_out_of_bounds(at);
                    None
                }
            };
            done(self, lane, old);
        }
    }

    fn read_wide(&self, word: u32, width: u32, lane: usize) -> u64 {
        match width {
            0 => 0,
            1 => u64::from(self.words[word as usize][lane]),
            _ => u64::from(self.words[word as usize][lane]) | u64::from(self.words[word as usize + 1][lane]) << 32,
        }
    }

    fn write_wide(&mut self, word: u32, width: u32, lane: usize, value: u64) {
        self.words[word as usize][lane] = value as u32;
        if width == 2 {
            self.words[word as usize + 1][lane] = (value >> 32) as u32;
        }
    }
}

/// Returns the word that all lanes have. `None`: they differ.
#[inline]
fn uniform(words: &Lanes) -> Option<u32> {
    let mut differences = 0;
    for lane in 0..LANES {
        differences |= words[lane] ^ words[0];
    }
    (differences == 0).then_some(words[0])
}

/// Returns the word at `address + offset`. `None`: out of bounds, as [`OUT_OF_BOUNDS`](crate::operation::OUT_OF_BOUNDS) is in any buffer.
#[inline]
fn element(words: &[AtomicU32], address: u32, offset: u32) -> Option<&AtomicU32> {
    words.get(usize::try_from(u64::from(address) + u64::from(offset)).ok()?)
}
