//! Finishes a compilation: numbers the constants and analyses the program.

use std::sync::OnceLock;

use crate::bytecode::{Bytecode, InterfaceVariable};
use crate::live::{in_loops, liveness};
use crate::memory::Atomic;
use crate::operation::{CONSTANT, Op, Word};
use crate::retry::retry_loops;

use super::compiler::Compiler;

impl Compiler<'_> {
    /// Returns the word of a constant.
    pub(super) fn constant(&mut self, number: u32) -> Word {
        if let Some(word) = self.constant_words.get(&number) {
            return *word;
        }
        let word = self.consecutive_constants(&[number]);
        self.constant_words.insert(number, word);
        word
    }

    /// Returns the first of consecutive words with these constants.
    pub(super) fn consecutive_constants(&mut self, numbers: &[u32]) -> Word {
        if let [one] = numbers
            && let Some(word) = self.constant_words.get(one)
        {
            return *word;
        }
        let first = CONSTANT + self.constants.len() as Word;
        self.constants.extend_from_slice(numbers);
        first
    }

    pub(super) fn finish(
        mut self,
        inputs: Vec<InterfaceVariable>,
        outputs: Vec<InterfaceVariable>,
        workgroup_size: [u32; 3],
    ) -> Bytecode {
        let first_constant = self.peak;
        let final_word = |word: Word| if word >= CONSTANT { word - CONSTANT + first_constant } else { word };
        for op in &mut self.ops {
            op.visit_operands(&mut |_, word, count| {
                if count > 0 {
                    *word = final_word(*word);
                }
            });
        }
        // Outputs are consecutive.
        let result =
            outputs.first().map_or(0, |first| first.words.start)..outputs.last().map_or(0, |last| last.words.end);
        let live = liveness(&self.ops, first_constant, &result);
        let retry_loops = retry_loops(&self.ops, &live, first_constant, &self.constants);
        self.classify(&live.unread);
        let mut initial_words = self.privates;
        let privates = initial_words.len();
        initial_words.resize(first_constant as usize, 0);
        let constants = self.constants.len();
        initial_words.extend(self.constants);
        Bytecode {
            in_loop: in_loops(&self.ops),
            retry_loops,
            ops: self.ops,
            site_of: self.site_of,
            sites: self.sites,
            initial_words,
            privates,
            constants,
            in_lanes: OnceLock::new(),
            live: live.at_stops,
            inputs,
            result,
            outputs,
            buffers: self.buffers,
            textures: self.textures,
            workgroup_size,
        }
    }

    /// Determines which buffers the program writes, and which only by operations that commute. Loads from the other
    /// buffers become `Op::Constant`, at which machines do not stop.
    fn classify(&mut self, unread: &[usize]) {
        for (number, buffer) in self.buffers.iter_mut().enumerate() {
            let number = number as u16;
            let mut only: Option<Atomic> = None;
            let mut commutes = true;
            for (at, op) in self.ops.iter().enumerate() {
                if let Op::Load { buffer: accessed, words: 2, .. }
                | Op::Store { buffer: accessed, words: 2, .. }
                | Op::Atomic { buffer: accessed, words: 2, .. } = *op
                {
                    buffer.is_wide |= accessed == number;
                }
                match *op {
                    Op::Store { buffer: accessed, .. } if accessed == number => {
                        buffer.is_written = true;
                        commutes = false;
                    }
                    Op::Atomic { buffer: accessed, function, .. } if accessed == number => {
                        buffer.is_written = true;
                        let is_commutative =
                            !matches!(function, Atomic::Exchange | Atomic::CompareExchange | Atomic::Subtract);
                        commutes &= is_commutative && *only.get_or_insert(function) == function && unread.contains(&at);
                    }
                    Op::Load { buffer: accessed, .. } if accessed == number => commutes = false,
                    _ => {}
                }
            }
            buffer.commutes = buffer.is_written && commutes;
        }
        for op in &mut self.ops {
            if let Op::Load { to, buffer, address, offset, words: 1, .. } = *op
                && !self.buffers[usize::from(buffer)].is_written
            {
                *op = Op::Constant { to, buffer, address, offset };
            }
        }
    }
}
