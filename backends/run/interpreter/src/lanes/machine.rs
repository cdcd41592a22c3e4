//! The machine of a group of invocations, with its interpreter loop. Each lane computes what [`Machine`](crate::Machine) computes.

use super::arithmetic::{binary, ternary, unary};
use super::flow::Flow;
use super::memory::LaneMemory;
use super::program::LaneProgram;
use super::set::{LANES, LaneSet, Lanes};
use crate::bytecode::Bytecode;
use crate::machine::{BACKWARD_JUMP_LIMIT, OutOfBoundsAccess, index_address};
use crate::operation::Op;

/// The most words of a program: a machine has them for every lane.
const MOST_WORDS: usize = 1 << 16;

/// The backward jumps after which lanes that wait run first: they may be what the others wait for.
const PATIENCE: u32 = 1 << 16;

/// A group of invocations of a program.
#[derive(Clone, Debug)]
pub struct LaneMachine<'p> {
    program: &'p Bytecode,
    lanes: &'p LaneProgram,
    pub(super) words: Vec<Lanes>,
    pub(super) flow: Flow,
    /// The backward jumps of each lane.
    jumps: Lanes,
    /// The backward jumps until a lane may have reached the limit, or [`PATIENCE`] ends.
    until_review: u32,
    /// The first access out of bounds since the caller last took this.
    pub out_of_bounds: Option<OutOfBoundsAccess>,
}

impl<'p> LaneMachine<'p> {
    /// Creates a machine. `None`: the program has too many words.
    pub fn new(program: &'p Bytecode) -> Option<Self> {
        (program.initial_words.len() <= MOST_WORDS).then(|| LaneMachine {
            program,
            lanes: program.in_lanes.get_or_init(|| LaneProgram::of(program)),
            words: program.initial_words.iter().map(|word| [*word; LANES]).collect(),
            flow: Flow::default(),
            jumps: [0; LANES],
            until_review: PATIENCE,
            out_of_bounds: None,
        })
    }

    /// Returns words of the machine to write, such as those of an input; each word is a word per lane.
    pub fn words_mut(&mut self, range: std::ops::Range<usize>) -> &mut [[u32; LANES]] {
        &mut self.words[range]
    }

    /// Copies the result of a lane that has ended, densely packed.
    pub fn copy_result(&self, lane: usize, to: &mut [u32]) {
        let result = &self.words[self.program.result.clone()];
        to.iter_mut().zip(result).for_each(|(to, word)| *to = word[lane]);
    }

    /// Returns `count` lanes to the first instruction; inputs keep their words.
    pub fn restart(&mut self, count: usize) {
        let privates = &self.program.initial_words[..self.program.privates];
        self.words.iter_mut().zip(privates).for_each(|(word, initial)| *word = [*initial; LANES]);
        self.jumps = [0; LANES];
        self.until_review = PATIENCE;
        self.flow.start(LaneSet::first(count));
    }

    /// Returns the lanes that have ended, rather than discarded their fragments.
    pub fn ended(&self) -> LaneSet {
        self.flow.ended
    }

    /// Returns the lanes that have stopped at barriers.
    pub fn stopped(&self) -> LaneSet {
        self.flow.stopped()
    }

    /// Runs the lanes from where they are until each has ended, has discarded its fragment or has stopped at a barrier. `Err`: a lane reached
    /// the limit of backward jumps at this instruction.
    pub fn run<M: LaneMemory>(&mut self, memory: &M) -> Result<(), u32> {
        let ops = self.lanes.ops.as_slice();
        let Some(mut at) = self.flow.resume() else { return Ok(()) };
        loop {
            if at >= self.flow.join {
                at = self.flow.arrive(at);
            }
            match ops[at as usize] {
                Op::Copy { to, from, count: 1 } => {
                    let value = self.words[from as usize];
                    self.write(to, value);
                }
                Op::Copy { to, from, count } => self.copy(to, from, count),
                Op::Unary { op, to, a } => {
                    let value = unary(op, &self.words[a as usize], self.flow.active);
                    self.write(to, value);
                }
                Op::Binary { op, to, a, b } => {
                    let value = binary(op, &self.words[a as usize], &self.words[b as usize], self.flow.active);
                    self.write(to, value);
                }
                Op::Ternary { op, to, a, b, c } => {
                    let [a, b, c] = [a, b, c].map(|word| &self.words[word as usize]);
                    let value = ternary(op, a, b, c, self.flow.active);
                    self.write(to, value);
                }
                Op::Jump { to } => {
                    at = if to <= at { self.jump_back(at, to)? } else { to };
                    continue;
                }
                Op::JumpUnless { condition, to } => {
                    let jumping = LaneSet::zeros(&self.words[condition as usize]).and(self.flow.active);
                    if jumping == self.flow.active {
                        at = to;
                        continue;
                    }
                    if !jumping.is_empty() {
                        self.flow.divide(jumping, to);
                    }
                }
                Op::Index { to, base, index, stride, bound } => {
                    let [base, index] = [base, index].map(|word| &self.words[word as usize]);
                    let mut value = [0; LANES];
                    for lane in 0..LANES {
                        value[lane] = index_address(base[lane], index[lane], stride, bound, false);
                    }
                    self.write(to, value);
                }
                Op::Discard | Op::End | Op::Barrier(_) => {
                    let next = match ops[at as usize] {
                        Op::Discard => self.flow.discard(),
                        Op::End => self.flow.end(),
                        _ => self.flow.stop(at),
                    };
                    let Some(next) = next else { return Ok(()) };
                    at = next;
                    continue;
                }
                ref op => self.access(at, op, memory),
            }
            at += 1;
        }
    }

    /// Writes a word of the active lanes.
    #[inline(always)]
    pub(super) fn write(&mut self, to: u32, value: Lanes) {
        let word = &mut self.words[to as usize];
        if self.flow.is_full {
            *word = value;
            return;
        }
        for lane in 0..LANES {
            let mask = self.flow.mask[lane];
            word[lane] = (value[lane] & mask) | (word[lane] & !mask);
        }
    }

    fn copy(&mut self, to: u32, from: u32, count: u32) {
        if self.flow.is_full {
            self.words.copy_within(from as usize..(from + count) as usize, to as usize);
            return;
        }
        let mut copy = |offset: u32| {
            let value = self.words[(from + offset) as usize];
            self.write(to + offset, value);
        };
        if to <= from { (0..count).for_each(&mut copy) } else { (0..count).rev().for_each(&mut copy) }
    }

    /// Returns the instruction of the program that an instruction of the lanes comes from.
    pub(super) fn origin(&self, at: u32) -> u32 {
        self.lanes.origins.get(at as usize).copied().unwrap_or(at)
    }

    /// Counts a jump back from `at` to `to`. Returns the instruction that runs next. `Err`: a lane reached the limit.
    fn jump_back(&mut self, at: u32, to: u32) -> Result<u32, u32> {
        for lane in 0..LANES {
            // The mask is -1.
            self.jumps[lane] = self.jumps[lane].wrapping_sub(self.flow.mask[lane]);
        }
        self.until_review -= 1;
        if self.until_review > 0 {
            return Ok(to);
        }
        let most = self.jumps.iter().copied().max().unwrap_or(0);
        if most >= BACKWARD_JUMP_LIMIT {
            return Err(self.origin(at));
        }
        self.until_review = PATIENCE.min(BACKWARD_JUMP_LIMIT - most);
        Ok(self.flow.park(to))
    }
}
