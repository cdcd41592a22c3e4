//! The relaxed model beside an axiomatic oracle: every program of two invocations with two accesses each, over two words, with
//! and without fences between the accesses.

mod oracle;

use std::collections::BTreeSet;

use fragbuf_interpreter::Bytecode;

use crate::context::SearchContext;
use crate::explore::explore;
use crate::model::Model;
use crate::reduced::explore_reduced;
use crate::search::{Property, StateVerdict};
use crate::test_program::{Search, compiled, two_invocations};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Load,
    Store,
    Add,
    CompareExchange,
}

const KINDS: [Kind; 4] = [Kind::Load, Kind::Store, Kind::Add, Kind::CompareExchange];

#[derive(Clone, Copy, Debug)]
struct Operation {
    kind: Kind,
    word: usize,
    value: u32,
    expected: u32,
}

/// Two operations of each invocation, and whether a fence comes between those of each.
#[derive(Clone, Copy, Debug)]
struct Program {
    operations: [Operation; 4],
    fences: [bool; 2],
}

/// What the operations have observed, and the last values of both words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Outcome {
    /// Twice the observed value; one more if it was exchanged.
    seen: [u32; 4],
    words: [u32; 2],
}

/// Reads the operations of an invocation from a buffer that no invocation writes, so that one shader is every program.
const SHADER: &str = "
@group(0) @binding(0) var<storage, read> operations: array<vec4<u32>, 4>;
@group(0) @binding(1) var<storage, read> fences: array<u32, 2>;
@group(0) @binding(2) var<storage, read_write> words: array<atomic<u32>, 2>;
@group(0) @binding(3) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
fn perform(at: u32) {
    let operation = operations[at];
    let word = operation.y;
    switch operation.x {
        case 0u: { seen[at] = 2u * atomicLoad(&words[word]); }
        case 1u: { atomicStore(&words[word], operation.z); }
        case 2u: { seen[at] = 2u * atomicAdd(&words[word], operation.z); }
        default: {
            let result = atomicCompareExchangeWeak(&words[word], operation.w, operation.z);
            seen[at] = 2u * result.old_value + u32(result.exchanged);
        }
    }
}
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    perform(2u * id.x);
    if fences[id.x] == 1u { memory_fence(); }
    perform(2u * id.x + 1u);
}";

/// Collects the words of final states.
struct Collect {
    outcomes: BTreeSet<Outcome>,
    /// Where the words and what was seen begin in a state.
    words: usize,
    seen: usize,
}

impl Property for Collect {
    fn instant(&mut self, _: &[u32]) -> Option<String> {
        None
    }

    fn final_state(&mut self, words: &[u32]) -> StateVerdict {
        let outcome = Outcome {
            words: std::array::from_fn(|at| words[self.words + at]),
            seen: std::array::from_fn(|at| words[self.seen + at]),
        };
        self.outcomes.insert(outcome);
        StateVerdict::Correct
    }
}

/// Returns the outcomes that a search finds. `is_reduced`: it may leave out interleavings.
fn found(shader: &Bytecode, program: &Program, search: Search, is_reduced: bool) -> BTreeSet<Outcome> {
    let words =
        |operation: &Operation| [operation.kind as u32, operation.word as u32, operation.value, operation.expected];
    let operations = program.operations.iter().flat_map(words).collect();
    let fences = program.fences.map(u32::from).to_vec();
    let memory = vec![operations, fences, vec![0; 2], vec![0; 4]];
    let (mut context, words) = SearchContext::new(shader, &memory, Model::Relaxed);
    context.has_weak_exchange = true;
    context.is_reduced = is_reduced;
    let first = two_invocations(&context, words);
    let begin = |index: usize| context.state_buffers().find(|buffer| buffer.0 == index).map_or(0, |buffer| buffer.1);
    let mut collect = Collect { outcomes: BTreeSet::new(), words: begin(2), seen: begin(3) };
    let result = search(&context, first, &mut collect, 1_000_000);
    assert!(result.is_exhaustive && result.failure.is_none(), "{program:?}: {:?}", result.failure);
    collect.outcomes
}

/// Returns every program, up to the names of the words.
fn programs() -> Vec<Program> {
    let access = |code: usize, at: usize| Operation {
        kind: KINDS[code % 4],
        word: code / 4,
        // All values that can be observed differ.
        value: 1 << (4 * at),
        // The second compare-exchange of an invocation expects what the first access of the other stores.
        expected: [0, 1 << 8, 0, 1][at],
    };
    let mut programs = Vec::new();
    for code in 0..8 * 8 * 8 * 8 {
        let codes: [usize; 4] = std::array::from_fn(|at| code >> (3 * at) & 7);
        for fences in [[false, false], [true, true], [true, false], [false, true]] {
            if codes[0] / 4 == 0 {
                programs.push(Program { operations: std::array::from_fn(|at| access(codes[at], at)), fences });
            }
        }
    }
    programs
}

#[test]
fn outcomes_are_those_of_the_axioms_without_load_buffering() {
    let shader = compiled(SHADER);
    let (mut programs_with_more, mut outcomes) = (0, 0);
    for program in programs() {
        let expected = oracle::outcomes(&program);
        let found = found(&shader, &program, explore_reduced, true);
        assert_eq!(found, expected.ordered, "{program:?}");
        outcomes += found.len();
        programs_with_more += usize::from(expected.all.len() > expected.ordered.len());
        // What load buffering adds needs an invocation that reads before it writes, with no fence in both.
        if expected.all.len() > expected.ordered.len() {
            let reads = |at: usize| program.operations[at].kind != Kind::Store;
            assert!(reads(0) && reads(2) && program.fences != [true, true], "{program:?}");
        }
    }
    assert!(
        outcomes > 10_000 && programs_with_more > 50,
        "{outcomes} outcomes, {programs_with_more} with load buffering"
    );
}

#[test]
fn the_reduced_searches_find_every_outcome() {
    let shader = compiled(SHADER);
    for program in programs() {
        let all = found(&shader, &program, explore, false);
        assert_eq!(found(&shader, &program, explore, true), all, "{program:?}");
        assert_eq!(found(&shader, &program, explore_reduced, true), all, "{program:?}");
    }
}
