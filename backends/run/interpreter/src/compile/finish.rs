//! The end of compilation: constants get their words, and what can be known of the program is found out.

use crate::live::{liveness, loops};
use crate::memory::Atomic;
use crate::operation::{CONSTANT, Op, Word};
use crate::program::{Input, Program};

use super::Compiler;

impl Compiler<'_> {
    /// The word that always holds this number.
    pub(super) fn constant(&mut self, number: u32) -> Word {
        if let Some(word) = self.constant_words.get(&number) {
            return *word;
        }
        let word = self.constants_in_a_row(&[number]);
        self.constant_words.insert(number, word);
        word
    }

    /// The first of words that always hold these numbers.
    pub(super) fn constants_in_a_row(&mut self, numbers: &[u32]) -> Word {
        if let [one] = numbers
            && let Some(word) = self.constant_words.get(one)
        {
            return *word;
        }
        let first = CONSTANT + self.constants.len() as Word;
        self.constants.extend_from_slice(numbers);
        first
    }

    pub(super) fn finish(mut self, inputs: Vec<Input>, outputs: Vec<Input>, workgroup_size: [u32; 3]) -> Program {
        let first_constant = self.highest;
        let settled = |word: Word| if word >= CONSTANT { word - CONSTANT + first_constant } else { word };
        for op in &mut self.ops {
            op.touches(&mut |_, word, count| {
                if count > 0 {
                    *word = settled(*word);
                }
            });
        }
        // Outputs follow each other without a gap.
        let result =
            outputs.first().map_or(0, |first| first.words.start)..outputs.last().map_or(0, |last| last.words.end);
        let live = liveness(&self.ops, first_constant, &result);
        self.classify(&live.unread);
        let mut image = self.privates;
        let privates = image.len();
        image.resize(first_constant as usize, 0);
        image.extend(self.constants);
        Program {
            in_loop: loops(&self.ops),
            ops: self.ops,
            site_of: self.site_of,
            sites: self.sites,
            image,
            privates,
            live: live.at_stops,
            inputs,
            result,
            outputs,
            buffers: self.buffers,
            textures: self.textures,
            workgroup_size,
        }
    }

    /// Which buffers the program writes, and which of them only by operations that commute. What is only read is read
    /// without a stop.
    fn classify(&mut self, unread: &[usize]) {
        for (number, buffer) in self.buffers.iter_mut().enumerate() {
            let number = number as u16;
            let mut only: Option<Atomic> = None;
            let mut commutes = true;
            for (at, op) in self.ops.iter().enumerate() {
                if let Op::Load { buffer: own, words: 2, .. }
                | Op::Store { buffer: own, words: 2, .. }
                | Op::Atomic { buffer: own, words: 2, .. } = *op
                {
                    buffer.is_wide |= own == number;
                }
                match *op {
                    Op::Store { buffer: own, is_atomic, .. } if own == number => {
                        buffer.is_written = true;
                        buffer.is_coherent |= is_atomic;
                        commutes = false;
                    }
                    Op::Atomic { buffer: own, function, .. } if own == number => {
                        buffer.is_written = true;
                        buffer.is_coherent = true;
                        let goes = !matches!(function, Atomic::Exchange | Atomic::CompareExchange | Atomic::Subtract);
                        commutes &= goes && *only.get_or_insert(function) == function && unread.contains(&at);
                    }
                    Op::Load { buffer: own, is_atomic, .. } if own == number => {
                        buffer.is_coherent |= is_atomic;
                        commutes = false;
                    }
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
