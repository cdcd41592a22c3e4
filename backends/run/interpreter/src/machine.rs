//! One invocation: a place in the program and its words. The dispatch loop is here.
//!
//! In: replies of [`Shared`]. Out: an [`Exit`]. A machine never allocates while it runs, and always comes back: jumps
//! backwards are limited.

use crate::arithmetic::{binary, ternary, unary};
use crate::memory::{Access, Atomic, Event, Operation, Place, Reply, Shared};
use crate::operation::{NOWHERE, Op};
use crate::program::Program;

/// Why a machine came back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The end of the program; the result stands in [`Machine::result`].
    Ended,
    /// The fragment was discarded.
    Discarded,
    /// It stands before this.
    Stopped(Event),
    /// More jumps backwards than a program should need: it goes round for ever.
    Endless,
}

/// An index out of bounds. WGSL allows an implementation to read or write anything of the same buffer there; here a read
/// gives 0 and a write does nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The instruction, for [`Program::trace`].
    pub at: u32,
}

/// Jumps backwards that a machine may take in one run.
const JUMPS: u32 = 1 << 24;

/// One invocation of a program.
#[derive(Clone, Debug)]
pub struct Machine<'p> {
    program: &'p Program,
    words: Vec<u32>,
    at: u32,
    /// Whether this is a helper invocation: what the marker says.
    pub is_helper: bool,
    /// What went out of bounds since somebody last emptied this; one entry per run at most.
    pub fault: Option<Fault>,
}

impl<'p> Machine<'p> {
    /// A machine before the first instruction, inputs at zero.
    pub fn new(program: &'p Program) -> Self {
        Machine { program, words: program.image.clone(), at: 0, is_helper: false, fault: None }
    }

    /// Its program.
    pub fn program(&self) -> &'p Program {
        self.program
    }

    /// The next instruction.
    pub fn at(&self) -> u32 {
        self.at
    }

    /// Puts words into the input of this number; what is too long is cut.
    pub fn set_input(&mut self, input: usize, words: &[u32]) {
        if let Some(input) = self.program.inputs.get(input) {
            for (to, from) in self.words[input.words.clone()].iter_mut().zip(words) {
                *to = *from;
            }
        }
    }

    /// The result of a program that has ended: dense words.
    pub fn result(&self) -> &[u32] {
        &self.words[self.program.result.clone()]
    }

    /// Goes back to the first instruction; inputs keep their words.
    pub fn restart(&mut self) {
        // Only private variables are read before the program writes them; nothing in it writes inputs or constants.
        let privates = self.program.privates;
        self.words[..privates].copy_from_slice(&self.program.image[..privates]);
        self.at = 0;
    }

    /// A word of the machine, for inputs and outputs by their ranges.
    pub fn words(&self, range: std::ops::Range<usize>) -> &[u32] {
        &self.words[range]
    }

    /// Words of an input, to be written.
    pub fn words_mut(&mut self, range: std::ops::Range<usize>) -> &mut [u32] {
        &mut self.words[range]
    }

    /// Writes down where a stopped machine stands and every word that still matters: equal machines write equal words.
    pub fn save(&self, out: &mut Vec<u32>) {
        out.push(self.at);
        if let Some(ranges) = self.program.live.get(&self.at) {
            for range in ranges {
                out.extend_from_slice(&self.words[range.start as usize..range.end as usize]);
            }
        }
    }

    /// Puts the machine where `save` found it.
    pub fn load(&mut self, saved: &[u32]) {
        let Some((at, mut rest)) = saved.split_first() else { return };
        self.at = *at;
        if let Some(ranges) = self.program.live.get(at) {
            for range in ranges {
                let (words, after) = rest.split_at((range.end - range.start) as usize);
                self.words[range.start as usize..range.end as usize].copy_from_slice(words);
                rest = after;
            }
        }
    }

    /// Runs until the end or until `shared` stops it.
    pub fn run<S: Shared>(&mut self, shared: &mut S) -> Exit {
        let program = self.program;
        let mut jumps = JUMPS;
        loop {
            let at = self.at as usize;
            let words = &mut self.words;
            macro_rules! read {
                ($word:expr) => {
                    words[$word as usize]
                };
            }
            match program.ops[at] {
                Op::Copy { to, from, count: 1 } => read!(to) = read!(from),
                Op::Copy { to, from, count } => {
                    words.copy_within(from as usize..(from + count) as usize, to as usize);
                }
                Op::Unary { op, to, a } => read!(to) = unary(op, read!(a)),
                Op::Binary { op, to, a, b } => read!(to) = binary(op, read!(a), read!(b)),
                Op::Ternary { op, to, a, b, c } => read!(to) = ternary(op, read!(a), read!(b), read!(c)),
                Op::Wide { op, to, a, b } => {
                    let (left, right, result) = op.widths();
                    let value = op.apply(joined(words, a, left), joined(words, b, right));
                    split(words, to, result, value);
                }
                Op::Pack { op, to, a } => {
                    read!(to) = op.apply(&words[a as usize..(a + op.components()) as usize]);
                }
                Op::Unpack { op, to, a } => {
                    let word = read!(a);
                    for number in 0..op.components() {
                        read!(to + number) = op.component(word, number);
                    }
                }
                Op::Jump { to } => {
                    if (to as usize) <= at {
                        jumps -= 1;
                        if jumps == 0 {
                            return Exit::Endless;
                        }
                    }
                    self.at = to;
                    continue;
                }
                Op::JumpUnless { condition, to } => {
                    if read!(condition) == 0 {
                        self.at = to;
                        continue;
                    }
                }
                Op::Index { to, base, index, stride, bound } => {
                    read!(to) = place(read!(base), read!(index), stride, bound);
                }
                Op::IndexRuntime { to, base, index, stride, buffer } => {
                    let bound = shared.length(buffer).saturating_sub(read!(base)) / stride.max(1);
                    read!(to) = place(read!(base), read!(index), stride, bound);
                }
                Op::Length { to, buffer, offset, stride } => {
                    read!(to) = shared.length(buffer).saturating_sub(offset) / stride.max(1);
                }
                Op::LoadLocal { to, variable, length, address, count } => match read!(address) {
                    address if address.saturating_add(count) <= length => {
                        let from = (variable + address) as usize;
                        words.copy_within(from..from + count as usize, to as usize);
                    }
                    _ => {
                        words[to as usize..(to + count) as usize].fill(0);
                        self.fault.get_or_insert(Fault { at: at as u32 });
                    }
                },
                Op::StoreLocal { variable, length, address, from, count } => match read!(address) {
                    address if address.saturating_add(count) <= length => {
                        words.copy_within(from as usize..(from + count) as usize, (variable + address) as usize);
                    }
                    _ => {
                        self.fault.get_or_insert(Fault { at: at as u32 });
                    }
                },
                Op::Texel { to, texture, place, count } => {
                    let place = [read!(place), read!(place + 1), read!(place + 2)];
                    let texel = shared.texel(texture, place).unwrap_or_else(|| {
                        self.fault.get_or_insert(Fault { at: at as u32 });
                        [0; 4]
                    });
                    words[to as usize..(to + count) as usize].copy_from_slice(&texel[..count as usize]);
                }
                Op::Extent { to, texture } => {
                    words[to as usize..to as usize + 3].copy_from_slice(&shared.extent(texture));
                }
                Op::Constant { to, buffer, address, offset } => match inside(shared, buffer, read!(address), offset, 1)
                {
                    Some(place) => read!(to) = shared.constant(place),
                    None => {
                        read!(to) = 0;
                        self.fault.get_or_insert(Fault { at: at as u32 });
                    }
                },
                Op::Load { to, buffer, address, offset, words: size, is_atomic } => {
                    let value = match inside(shared, buffer, read!(address), offset, size) {
                        Some(place) => {
                            let access = Access {
                                place,
                                operation: Operation::Load,
                                words: size,
                                is_atomic,
                                value: 0,
                                expected: 0,
                            };
                            match shared.event(&Event::Access(access)) {
                                Reply::Done(value) => value,
                                Reply::Stop => return Exit::Stopped(Event::Access(access)),
                            }
                        }
                        None => {
                            self.fault.get_or_insert(Fault { at: at as u32 });
                            0
                        }
                    };
                    split(words, to, size.into(), value);
                }
                Op::Store { from, buffer, address, offset, words: size, is_atomic } => {
                    match inside(shared, buffer, read!(address), offset, size) {
                        Some(place) => {
                            let value = joined(words, from, size.into());
                            let access = Access {
                                place,
                                operation: Operation::Store,
                                words: size,
                                is_atomic,
                                value,
                                expected: 0,
                            };
                            if shared.event(&Event::Access(access)) == Reply::Stop {
                                return Exit::Stopped(Event::Access(access));
                            }
                        }
                        None => {
                            self.fault.get_or_insert(Fault { at: at as u32 });
                        }
                    }
                }
                Op::Atomic { function, words: size, buffer, to, address, value, expected } => {
                    let operand = joined(words, value, size.into());
                    let exchanges = function == Atomic::CompareExchange;
                    let wanted = if exchanges { joined(words, expected, size.into()) } else { 0 };
                    let (old, met) = match inside(shared, buffer, read!(address), 0, size) {
                        Some(place) => {
                            let operation = Operation::Atomic(function);
                            let access = Access {
                                place,
                                operation,
                                words: size,
                                is_atomic: true,
                                value: operand,
                                expected: wanted,
                            };
                            match shared.event(&Event::Access(access)) {
                                Reply::Done(old) => (old, old == wanted),
                                Reply::Stop => return Exit::Stopped(Event::Access(access)),
                            }
                        }
                        None => {
                            self.fault.get_or_insert(Fault { at: at as u32 });
                            (0, false)
                        }
                    };
                    split(words, to, size.into(), old);
                    if exchanges {
                        read!(to + u32::from(size)) = u32::from(met);
                    }
                }
                Op::Fence | Op::Barrier | Op::CriticalBegin | Op::CriticalEnd => {
                    let event = match program.ops[at] {
                        Op::Fence => Event::Fence,
                        Op::Barrier => Event::Barrier,
                        Op::CriticalBegin => Event::CriticalBegin,
                        _ => Event::CriticalEnd,
                    };
                    if shared.event(&event) == Reply::Stop {
                        return Exit::Stopped(event);
                    }
                }
                Op::HelperLane { to } => read!(to) = u32::from(self.is_helper),
                Op::Discard => return Exit::Discarded,
                Op::End => return Exit::Ended,
            }
            self.at += 1;
        }
    }
}

fn joined(words: &[u32], at: u32, width: u32) -> u64 {
    match width {
        0 => 0,
        1 => u64::from(words[at as usize]),
        _ => u64::from(words[at as usize]) | u64::from(words[at as usize + 1]) << 32,
    }
}

fn split(words: &mut [u32], at: u32, width: u32, value: u64) {
    words[at as usize] = value as u32;
    if width == 2 {
        words[at as usize + 1] = (value >> 32) as u32;
    }
}

fn place(base: u32, index: u32, stride: u32, bound: u32) -> u32 {
    if base == NOWHERE || index >= bound { NOWHERE } else { base + index * stride }
}

/// The place at `address + offset`, if the buffer has all its words.
fn inside<S: Shared>(shared: &S, buffer: u16, address: u32, offset: u32, words: u8) -> Option<Place> {
    if address == NOWHERE {
        return None;
    }
    let word = address.checked_add(offset)?;
    (word.checked_add(words.into())? <= shared.length(buffer)).then_some(Place { buffer, word })
}
