//! The context of a search: everything that its states share.
//!
//! Input: a program, memory and a memory model. Output: the location of every buffer, in read-only memory or in the words
//! of a state.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use fragbuf_interpreter::{Buffer, Bytecode, Event, Space, WordAddress};

use crate::memory::{TexelLayout, memory_index};
use crate::model::Model;
use crate::turn::Turn;

/// What every state of a search shares.
#[derive(Debug)]
pub(crate) struct SearchContext<'p> {
    pub(crate) program: &'p Bytecode,
    /// The location of each buffer of the program.
    pub(crate) locations: Vec<BufferLocation>,
    /// Memory that the program does not write, by binding.
    pub(crate) read_only: Vec<Vec<u32>>,
    pub(crate) texels: TexelLayout,
    /// How many words of a state have an order that matters. They come first.
    pub(crate) ordered: usize,
    /// The first word of workgroup memory, which ends where the ordered words end.
    pub(crate) first_of_workgroups: usize,
    /// Per invocation of a compute shader, the number of its workgroup. Fragments have none.
    pub(crate) workgroups: Vec<u32>,
    /// The instructions whose index was out of bounds, if that is no failure.
    pub(crate) out_of_bounds: Option<RefCell<BTreeSet<u32>>>,
    /// Whether such an index is that of the last element.
    pub(crate) clamps: bool,
    /// Whether a word has had more writes of the same value than memory keeps.
    pub(crate) has_forgotten: Cell<bool>,
    pub(crate) model: Model,
    /// Per ordered word, whether the program has both atomic and plain accesses of it; empty if there is no such word.
    mixed: Vec<bool>,
    /// Per ordered word, whether it is neither atomic nor coherent: no fence makes it visible to another fragment.
    pub(crate) private: Vec<bool>,
    /// Whether fences are events: the target supports them and the model uses them.
    pub(crate) has_fences: bool,
    /// Whether a compare-exchange may fail for no reason.
    pub(crate) has_weak_exchange: bool,
    /// Whether steps that do not affect each other are followed in one order only.
    pub(crate) is_reduced: bool,
    /// Whether a reduced search leaves failures to the search that finds the shortest schedule.
    pub(crate) wants_shortest: bool,
    /// The fragment that is a helper invocation: its writes have no effect, and its atomic operations return any value.
    pub(crate) helper: Option<usize>,
    /// Whether the interlock admits fragments by number, in submission order.
    pub(crate) by_submission: bool,
    /// Whether a fragment that has started runs to its end before another fragment runs.
    pub(crate) one_by_one: bool,
    /// Whether a loop waits for the samples of the pass, so that a discarded fragment has another final state.
    pub(crate) counts_samples: bool,
    /// The turn of the search, if searches of other cases run at the same time.
    pub(crate) turn: Option<Turn>,
}

/// The location of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BufferLocation {
    /// The index in [`SearchContext::read_only`].
    ReadOnly(usize),
    /// The words of a state that hold it. `commutes`: no program can observe the order of its accesses. Workgroup memory
    /// follows once more for each further workgroup.
    State { first: usize, words: usize, commutes: bool },
}

/// The locations of all buffers, and the words of the first state.
struct Layout {
    locations: Vec<BufferLocation>,
    /// Ordered words of storage buffers, those of workgroups, then words whose accesses commute.
    words: Vec<u32>,
    first_of_workgroups: usize,
    ordered: usize,
}

/// The groups of the words of a state, in their order.
#[derive(Clone, Copy, PartialEq, Eq)]
enum WordGroup {
    Ordered,
    Workgroup,
    Commuting,
}

impl WordGroup {
    /// Returns the group of a buffer's words. `None`: the program does not write it.
    fn of(buffer: &Buffer) -> Option<Self> {
        match (buffer.space, buffer.is_written, buffer.commutes) {
            (Space::Workgroup, ..) => Some(WordGroup::Workgroup),
            (_, false, _) => None,
            (_, true, false) => Some(WordGroup::Ordered),
            (_, true, true) => Some(WordGroup::Commuting),
        }
    }
}

impl<'p> SearchContext<'p> {
    /// Returns the context of a program over this memory, and the words of the first state. Fences are events under the
    /// relaxed model, and every option that a caller may set is off.
    pub(crate) fn new(program: &'p Bytecode, memory: &[Vec<u32>], model: Model) -> (Self, Vec<u32>) {
        SearchContext::with_workgroups(program, memory, model, Vec::new())
    }

    /// The same for invocations of a compute shader. `workgroups`: the number of each invocation's workgroup.
    pub(crate) fn with_workgroups(
        program: &'p Bytecode,
        memory: &[Vec<u32>],
        model: Model,
        workgroups: Vec<u32>,
    ) -> (Self, Vec<u32>) {
        let count = workgroups.iter().max().map_or(0, |last| last + 1);
        let Layout { locations, words, first_of_workgroups, ordered } = SearchContext::lay_out(program, memory, count);
        let mut context = SearchContext {
            program,
            locations,
            read_only: memory.to_vec(),
            texels: TexelLayout::FRAME,
            ordered,
            first_of_workgroups,
            workgroups,
            out_of_bounds: None,
            clamps: false,
            has_forgotten: Cell::new(false),
            model,
            mixed: Vec::new(),
            private: Vec::new(),
            has_fences: model == Model::Relaxed,
            has_weak_exchange: false,
            is_reduced: false,
            wants_shortest: true,
            helper: None,
            by_submission: false,
            one_by_one: false,
            counts_samples: false,
            turn: None,
        };
        if program.buffers.iter().any(|buffer| buffer.is_mixed) {
            context.mixed = context.each_ordered(|buffer, _| buffer.is_mixed);
        }
        context.private = context.each_ordered(|buffer, word| {
            buffer.space == Space::Storage && !buffer.is_coherent && !buffer.is_atomic(word)
        });
        (context, words)
    }

    fn lay_out(program: &Bytecode, memory: &[Vec<u32>], workgroups: u32) -> Layout {
        let mut layout = Layout {
            locations: program
                .buffers
                .iter()
                .map(|buffer| BufferLocation::ReadOnly(memory_index(buffer.binding)))
                .collect(),
            words: Vec::new(),
            first_of_workgroups: 0,
            ordered: 0,
        };
        for group in [WordGroup::Ordered, WordGroup::Workgroup, WordGroup::Commuting] {
            let Layout { locations, words, .. } = &mut layout;
            for (buffer, location) in program.buffers.iter().zip(locations) {
                if WordGroup::of(buffer) != Some(group) {
                    continue;
                }
                let (first, commutes) = (words.len(), group == WordGroup::Commuting);
                let length = match group {
                    WordGroup::Workgroup => {
                        words.resize(first + buffer.words as usize * workgroups as usize, 0);
                        buffer.words as usize
                    }
                    WordGroup::Ordered | WordGroup::Commuting => {
                        words.extend_from_slice(&memory[memory_index(buffer.binding)]);
                        words.len() - first
                    }
                };
                *location = BufferLocation::State { first, words: length, commutes };
            }
            match group {
                WordGroup::Ordered => layout.first_of_workgroups = layout.words.len(),
                WordGroup::Workgroup => layout.ordered = layout.words.len(),
                WordGroup::Commuting => {}
            }
        }
        layout
    }

    /// Returns whether the program has both atomic and plain accesses of a word.
    pub(crate) fn is_mixed(&self, word: usize) -> bool {
        self.mixed.get(word).is_some_and(|is_mixed| *is_mixed)
    }

    /// Returns a property of each ordered word, which depends on its buffer and its number there.
    fn each_ordered(&self, property: impl Fn(&Buffer, u32) -> bool) -> Vec<bool> {
        let mut all = vec![false; self.ordered];
        for (buffer, location) in self.program.buffers.iter().zip(&self.locations) {
            if let BufferLocation::State { first, words, commutes: false } = location {
                let copies = if buffer.space == Space::Workgroup { self.workgroup_count() } else { 1 };
                for (at, word) in (0..words * copies).zip(0..) {
                    all[first + at] = property(buffer, word);
                }
            }
        }
        all
    }

    fn workgroup_count(&self) -> usize {
        self.workgroups.iter().max().map_or(0, |last| *last as usize + 1)
    }

    /// Returns the invocations of a fragment's workgroup.
    pub(crate) fn members(&self, fragment: usize) -> Vec<usize> {
        let Some(own) = self.workgroups.get(fragment) else { return vec![fragment] };
        let all = self.workgroups.iter().enumerate();
        all.filter(|(_, workgroup)| *workgroup == own).map(|(member, _)| member).collect()
    }

    /// Returns an event of a fragment with the address in the memory of its own workgroup.
    pub(crate) fn placed(&self, fragment: usize, event: Event) -> Event {
        let Event::Access(mut access) = event else { return event };
        let buffer = &self.program.buffers[usize::from(access.address.buffer)];
        if buffer.space == Space::Workgroup {
            access.address.word += buffer.words * self.workgroups.get(fragment).copied().unwrap_or(0);
        }
        Event::Access(access)
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
            BufferLocation::State { .. } if buffer.space == Space::Workgroup => None,
            BufferLocation::State { first, words, .. } => Some((memory_index(buffer.binding), *first, *words)),
            BufferLocation::ReadOnly(_) => None,
        })
    }
}
