//! The context of a search: everything that its states share.
//!
//! Input: a program, memory and a memory model. Output: the location of every buffer, in read-only memory or in the words
//! of a state.

use fragbuf_interpreter::{Buffer, Bytecode, WordAddress};

use crate::memory::memory_index;
use crate::model::Model;

/// What every state of a search shares.
#[derive(Debug)]
pub(crate) struct SearchContext<'p> {
    pub(crate) program: &'p Bytecode,
    /// The location of each buffer of the program.
    pub(crate) locations: Vec<BufferLocation>,
    /// Memory that the program does not write, by binding.
    pub(crate) read_only: Vec<Vec<u32>>,
    /// How many words of a state have an order that matters. They come first.
    pub(crate) ordered: usize,
    pub(crate) model: Model,
    /// Per ordered word, whether it is neither atomic nor coherent: no fence makes it visible to another fragment.
    pub(crate) private: Vec<bool>,
    /// Whether fences are events: the target supports them and the model uses them.
    pub(crate) has_fences: bool,
    /// Whether a compare-exchange may fail for no reason.
    pub(crate) has_weak_exchange: bool,
    /// Whether steps that do not affect each other are followed in one order only.
    pub(crate) is_reduced: bool,
    /// The fragment that is a helper invocation: its writes have no effect, and its atomic operations return any value.
    pub(crate) helper: Option<usize>,
    /// Whether the interlock admits fragments by number, in submission order.
    pub(crate) by_submission: bool,
    /// Whether a fragment that has started runs to its end before another fragment runs.
    pub(crate) one_by_one: bool,
    /// Whether a loop waits for the samples of the pass, so that a discarded fragment has another final state.
    pub(crate) counts_samples: bool,
}

/// The location of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BufferLocation {
    /// The index in [`SearchContext::read_only`].
    ReadOnly(usize),
    /// The words of a state that hold it. `commutes`: no program can observe the order of its accesses.
    State { first: usize, words: usize, commutes: bool },
}

impl<'p> SearchContext<'p> {
    /// Returns the context of a program over this memory, and the words of the first state. Fences are events under the
    /// relaxed model, and every option that a caller may set is off.
    pub(crate) fn new(program: &'p Bytecode, memory: &[Vec<u32>], model: Model) -> (Self, Vec<u32>) {
        let (locations, words, ordered) = SearchContext::lay_out(program, memory);
        let mut context = SearchContext {
            program,
            locations,
            read_only: memory.to_vec(),
            ordered,
            model,
            private: Vec::new(),
            has_fences: model == Model::Relaxed,
            has_weak_exchange: false,
            is_reduced: false,
            helper: None,
            by_submission: false,
            one_by_one: false,
            counts_samples: false,
        };
        context.private = context.each_ordered(|buffer| !buffer.is_coherent);
        (context, words)
    }

    /// Returns the location of each buffer, the words of the first state with the ordered ones first, and the number of
    /// ordered words.
    fn lay_out(program: &Bytecode, memory: &[Vec<u32>]) -> (Vec<BufferLocation>, Vec<u32>, usize) {
        let mut locations = vec![BufferLocation::ReadOnly(0); program.buffers.len()];
        let mut words: Vec<u32> = Vec::new();
        let mut ordered = 0;
        for commutes in [false, true] {
            for (number, buffer) in program.buffers.iter().enumerate() {
                let index = memory_index(buffer.binding);
                if !buffer.is_written {
                    locations[number] = BufferLocation::ReadOnly(index);
                } else if buffer.commutes == commutes {
                    let content = &memory[index];
                    locations[number] = BufferLocation::State { first: words.len(), words: content.len(), commutes };
                    words.extend_from_slice(content);
                }
            }
            if !commutes {
                ordered = words.len();
            }
        }
        (locations, words, ordered)
    }

    /// Returns a property of its buffer for each ordered word.
    fn each_ordered(&self, property: impl Fn(&Buffer) -> bool) -> Vec<bool> {
        let mut all = vec![false; self.ordered];
        for (buffer, location) in self.program.buffers.iter().zip(&self.locations) {
            if let BufferLocation::State { first, words, commutes: false } = location {
                all[*first..first + words].fill(property(buffer));
            }
        }
        all
    }

    /// Returns the index of an address among the words of a state.
    pub(crate) fn word(&self, address: WordAddress) -> Option<usize> {
        match self.locations[usize::from(address.buffer)] {
            BufferLocation::State { first, .. } => Some(first + address.word as usize),
            BufferLocation::ReadOnly(_) => None,
        }
    }

    /// Returns index in memory, first word in a state and number of words of every buffer that states hold.
    pub(crate) fn state_buffers(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let locations = self.program.buffers.iter().zip(&self.locations);
        locations.filter_map(|(buffer, location)| match location {
            BufferLocation::State { first, words, .. } => Some((memory_index(buffer.binding), *first, *words)),
            BufferLocation::ReadOnly(_) => None,
        })
    }
}
