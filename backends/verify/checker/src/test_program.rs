//! Compiles small programs for the tests of this crate.
//!
//! Input: WGSL source with a compute entry point `main`. Output: its program, and the first state of invocations of it.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use fragbuf_codegen::{Notes, PassSource, Profile, SourceMap};
use fragbuf_interpreter::{Bytecode, Machine, Options};
use fragbuf_model::SourceSpan;
use fragbuf_targets::check;

use crate::context::SearchContext;
use crate::programs::MARKERS;
use crate::search::{Property, SearchResult};
use crate::state::State;

/// A search: of all interleavings, or of a reduced set.
pub(crate) type Search = fn(&SearchContext<'_>, State, &mut dyn Property, usize) -> SearchResult;

/// Compiles the entry point `main`.
pub(crate) fn compiled(source: &str) -> Bytecode {
    let source = PassSource {
        name: "main".to_owned(),
        text: source.to_owned(),
        lines: SourceMap::default(),
        entry_points: Vec::new(),
        exports: Vec::new(),
        resources: Vec::new(),
        written_first: Vec::new(),
        guarded: Vec::new(),
        user_buffers: Vec::new(),
        notes: Notes::default(),
    };
    let checked = check(source, Profile::Native, &SourceSpan::new("test", 1, 1)).unwrap();
    let options = Options { markers: &MARKERS, ..Options::default() };
    Bytecode::entry_point(checked.module(), checked.info(), "main", &options).unwrap()
}

/// Returns the state in which two invocations start, whose numbers are the program's first input.
pub(crate) fn two_invocations(context: &SearchContext<'_>, words: Vec<u32>) -> State {
    let machines = (0..2).map(|number| {
        let mut machine = Machine::new(context.program);
        machine.set_input(0, &[number, 0, 0]);
        machine
    });
    context.start(words, machines.collect()).unwrap()
}
