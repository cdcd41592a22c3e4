//! The machine: one invocation of a program, with the interpreter loop.
//!
//! A machine does not allocate while it runs. It always returns, because the number of backward jumps is limited.

use crate::arithmetic::{binary, ternary, unary};
use crate::bytecode::Bytecode;
use crate::memory::{Access, Atomic, Event, Operation, Reply, SharedMemory, WordAddress};
use crate::operation::{OUT_OF_BOUNDS, Op};

/// The reason why a machine returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The program ended; [`Machine::result`] returns its result.
    Ended,
    /// The shader discarded the fragment.
    Discarded,
    /// Memory stopped the machine before this event.
    Stopped(Event),
    /// The machine reached the limit of backward jumps: the program does not terminate, or takes very long.
    Endless,
}

/// An access with an index out of bounds. WGSL allows it to read or write any word of the same buffer; here a read returns
/// 0 and a write does nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfBoundsAccess {
    /// The instruction, for [`Bytecode::trace`].
    pub at: u32,
}

/// The limit of backward jumps of one run.
pub(crate) const BACKWARD_JUMP_LIMIT: u32 = 1 << 24;

/// The backward jumps after which [`Machine::run_or_repeat`] looks for a cycle. Few programs have so many.
const FIRST_JUMPS: u32 = 1 << 12;

/// The most backward jumps in which [`Machine::repeats`] looks for a cycle.
const LONGEST_CYCLE: u32 = 1 << 18;

/// One invocation of a program.
#[derive(Clone, Debug)]
pub struct Machine<'p> {
    program: &'p Bytecode,
    words: Vec<u32>,
    at: u32,
    /// Whether this is a helper invocation, as the marker reports it.
    pub is_helper: bool,
    /// Whether an index out of bounds is that of the last element, as in WGSL that wgpu and browsers emit. Otherwise the access
    /// reads 0 or writes nothing.
    pub clamps: bool,
    /// The first access out of bounds since the caller last took this.
    pub out_of_bounds: Option<OutOfBoundsAccess>,
}

impl<'p> Machine<'p> {
    /// Creates a machine at the first instruction, with zero inputs.
    pub fn new(program: &'p Bytecode) -> Self {
        Machine {
            program,
            words: program.initial_words.clone(),
            at: 0,
            is_helper: false,
            clamps: false,
            out_of_bounds: None,
        }
    }

    /// Returns the program.
    pub fn program(&self) -> &'p Bytecode {
        self.program
    }

    /// Returns the index of the next instruction.
    pub fn at(&self) -> u32 {
        self.at
    }

    /// Writes words into the input with this number; ignores words beyond its length.
    pub fn set_input(&mut self, input: usize, words: &[u32]) {
        if let Some(input) = self.program.inputs.get(input) {
            for (to, from) in self.words[input.words.clone()].iter_mut().zip(words) {
                *to = *from;
            }
        }
    }

    /// Returns the result of a program that has ended, densely packed.
    pub fn result(&self) -> &[u32] {
        &self.words[self.program.result.clone()]
    }

    /// Returns to the first instruction; inputs keep their words.
    pub fn restart(&mut self) {
        // The program reads only private variables before it writes them, and never writes inputs or constants.
        let privates = self.program.privates;
        self.words[..privates].copy_from_slice(&self.program.initial_words[..privates]);
        self.at = 0;
    }

    /// Returns words of the machine, such as those of an output.
    pub fn words(&self, range: std::ops::Range<usize>) -> &[u32] {
        &self.words[range]
    }

    /// Returns words of the machine to write, such as those of an input.
    pub fn words_mut(&mut self, range: std::ops::Range<usize>) -> &mut [u32] {
        &mut self.words[range]
    }

    /// Appends the state of a stopped machine: its position and its live words. Equal machines append equal words.
    pub fn save(&self, out: &mut Vec<u32>) {
        out.push(self.at);
        if let Some(ranges) = self.program.live.get(&self.at) {
            for range in ranges {
                out.extend_from_slice(&self.words[range.start as usize..range.end as usize]);
            }
        }
    }

    /// Restores the state that `save` appended.
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

    /// Runs the program until it ends or `shared` stops it.
    pub fn run<S: SharedMemory>(&mut self, shared: &mut S) -> Exit {
        self.run_jumps(shared, BACKWARD_JUMP_LIMIT)
    }

    /// Runs the program until it ends, `shared` stops it, or it comes back to a state in which it has been. Then it is
    /// [`Exit::Endless`], long before the limit of backward jumps. `changes` returns how often `shared` has changed what the program
    /// can observe.
    pub fn run_or_repeat<S: SharedMemory>(&mut self, shared: &mut S, changes: impl Fn(&S) -> u64) -> Exit {
        let exit = self.run_jumps(shared, FIRST_JUMPS);
        if exit != Exit::Endless {
            return exit;
        }
        let before = changes(shared);
        if self.repeats(shared) && changes(shared) == before {
            return Exit::Endless;
        }
        // A machine that has ended or was stopped meanwhile does so again.
        self.run_jumps(shared, BACKWARD_JUMP_LIMIT - FIRST_JUMPS - LONGEST_CYCLE)
    }

    /// Returns whether the machine comes back to a state in which it has been, before `shared` stops it. It has reached a limit of
    /// backward jumps. `false` if it does not within [`LONGEST_CYCLE`] backward jumps.
    pub fn repeats<S: SharedMemory>(&mut self, shared: &mut S) -> bool {
        let (mut earlier, mut limit) = ((self.at, self.words.clone()), 1);
        for jump in 0..LONGEST_CYCLE {
            // One jump, up to the next one.
            if self.run_jumps(shared, 2) != Exit::Endless {
                return false;
            }
            if self.at == earlier.0 && self.words == earlier.1 {
                return true;
            }
            if jump == limit {
                (earlier, limit) = ((self.at, self.words.clone()), 2 * limit);
            }
        }
        false
    }

    fn run_jumps<S: SharedMemory>(&mut self, shared: &mut S, limit: u32) -> Exit {
        let program = self.program;
        let mut jumps = limit;
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
                    let value = op.apply(read_words(words, a, left), read_words(words, b, right));
                    write_words(words, to, result, value);
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
                    read!(to) = index_address(read!(base), read!(index), stride, bound, self.clamps);
                }
                Op::IndexRuntime { to, base, index, stride, buffer } => {
                    let bound = shared.length(buffer).saturating_sub(read!(base)) / stride.max(1);
                    read!(to) = index_address(read!(base), read!(index), stride, bound, self.clamps);
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
                        self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                    }
                },
                Op::StoreLocal { variable, length, address, from, count } => match read!(address) {
                    address if address.saturating_add(count) <= length => {
                        words.copy_within(from as usize..(from + count) as usize, (variable + address) as usize);
                    }
                    _ => {
                        self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                    }
                },
                Op::Texel { to, texture, coordinates, count } => {
                    let coordinates = [read!(coordinates), read!(coordinates + 1), read!(coordinates + 2)];
                    let texel = shared.texel(texture, coordinates).unwrap_or_else(|| {
                        self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                        [0; 4]
                    });
                    words[to as usize..(to + count) as usize].copy_from_slice(&texel[..count as usize]);
                }
                Op::Extent { to, texture } => {
                    words[to as usize..to as usize + 3].copy_from_slice(&shared.extent(texture));
                }
                Op::Constant { to, buffer, address, offset } => {
                    match checked_address(shared, buffer, read!(address), offset, 1) {
                        Some(address) => read!(to) = shared.constant(address),
                        None => {
                            read!(to) = 0;
                            self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                        }
                    }
                }
                Op::Load { to, buffer, address, offset, words: size, is_atomic } => {
                    let value = match checked_address(shared, buffer, read!(address), offset, size) {
                        Some(address) => {
                            let access = Access {
                                address,
                                operation: Operation::Load,
                                words: size,
                                is_atomic,
                                value: 0,
                                expected: 0,
                            };
                            match shared.event(&Event::Access(access)) {
                                Reply::Done(value) | Reply::Failed(value) => value,
                                Reply::Stop => return Exit::Stopped(Event::Access(access)),
                            }
                        }
                        None => {
                            self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                            0
                        }
                    };
                    write_words(words, to, size.into(), value);
                }
                Op::Store { from, buffer, address, offset, words: size, is_atomic } => {
                    match checked_address(shared, buffer, read!(address), offset, size) {
                        Some(address) => {
                            let value = read_words(words, from, size.into());
                            let access = Access {
                                address,
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
                            self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                        }
                    }
                }
                Op::Atomic { function, words: size, buffer, to, address, value, expected } => {
                    let operand = read_words(words, value, size.into());
                    let exchanges = function == Atomic::CompareExchange;
                    let expected_value = if exchanges { read_words(words, expected, size.into()) } else { 0 };
                    let (old, exchanged) = match checked_address(shared, buffer, read!(address), 0, size) {
                        Some(address) => {
                            let operation = Operation::Atomic(function);
                            let access = Access {
                                address,
                                operation,
                                words: size,
                                is_atomic: true,
                                value: operand,
                                expected: expected_value,
                            };
                            match shared.event(&Event::Access(access)) {
                                Reply::Done(old) => (old, old == expected_value),
                                Reply::Failed(old) => (old, false),
                                Reply::Stop => return Exit::Stopped(Event::Access(access)),
                            }
                        }
                        None => {
                            self.out_of_bounds.get_or_insert(OutOfBoundsAccess { at: at as u32 });
                            (0, false)
                        }
                    };
                    write_words(words, to, size.into(), old);
                    if exchanges {
                        read!(to + u32::from(size)) = u32::from(exchanged);
                    }
                }
                Op::Fence | Op::Barrier(_) | Op::CriticalBegin | Op::CriticalEnd => {
                    let event = match program.ops[at] {
                        Op::Fence => Event::Fence,
                        Op::Barrier(barrier) => Event::Barrier(barrier),
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

fn read_words(words: &[u32], at: u32, width: u32) -> u64 {
    match width {
        0 => 0,
        1 => u64::from(words[at as usize]),
        _ => u64::from(words[at as usize]) | u64::from(words[at as usize + 1]) << 32,
    }
}

fn write_words(words: &mut [u32], at: u32, width: u32, value: u64) {
    words[at as usize] = value as u32;
    if width == 2 {
        words[at as usize + 1] = (value >> 32) as u32;
    }
}

#[inline]
pub(crate) fn index_address(base: u32, index: u32, stride: u32, bound: u32, clamps: bool) -> u32 {
    let index = if clamps { index.min(bound.saturating_sub(1)) } else { index };
    // Lanes that do not run have any words, so the address may wrap around.
    if base == OUT_OF_BOUNDS || index >= bound { OUT_OF_BOUNDS } else { base.wrapping_add(index.wrapping_mul(stride)) }
}

/// Returns the address `address + offset` if all `words` words are inside the buffer.
fn checked_address<S: SharedMemory>(
    shared: &S,
    buffer: u16,
    address: u32,
    offset: u32,
    words: u8,
) -> Option<WordAddress> {
    if address == OUT_OF_BOUNDS {
        return None;
    }
    let word = address.checked_add(offset)?;
    (word.checked_add(words.into())? <= shared.length(buffer)).then_some(WordAddress { buffer, word })
}
