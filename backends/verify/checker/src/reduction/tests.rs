//! Tests that steps that come first hide no state of the words that a property observes.

use std::ops::Range;

use crate::context::SearchContext;
use crate::explore::explore;
use crate::model::Model;
use crate::reduced::explore_reduced;
use crate::search::{FailureKind, Property, StateVerdict};
use crate::test_program::{Search, compiled, two_invocations};

/// One invocation stores to the first word, the other to the second.
const SHADER: &str = "
@group(0) @binding(0) var<storage, read_write> words: array<ELEMENT, 2>;
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u { FIRST } else { SECOND }
}";

/// Fails at the instant when the words have these values.
struct Never([u32; 2]);

impl Property for Never {
    fn instant(&mut self, words: &[u32]) -> Option<String> {
        (*words == self.0).then(|| "found".to_owned())
    }

    fn watched(&self) -> Vec<Range<usize>> {
        std::iter::once(0..2).collect()
    }

    fn final_state(&mut self, _: &[u32]) -> StateVerdict {
        StateVerdict::Correct
    }
}

#[test]
fn every_order_of_two_watched_stores_is_followed() {
    let atomic = ("atomic<u32>", "atomicStore(&words[0], 1u);", "atomicStore(&words[1], 1u);");
    let plain = ("u32", "words[0] = 1u;", "words[1] = 1u;");
    for (element, first, second) in [atomic, plain] {
        let shader = SHADER.replace("ELEMENT", element).replace("FIRST", first).replace("SECOND", second);
        let program = compiled(&shader);
        for model in [Model::Sequential, Model::Relaxed] {
            for (is_reduced, search) in [(false, explore as Search), (true, explore), (true, explore_reduced)] {
                for (wrong, is_found) in [([1, 0], true), ([0, 1], true), ([1, 1], true), ([2, 0], false)] {
                    let (mut context, words) = SearchContext::new(&program, &[vec![0; 2]], model);
                    context.is_reduced = is_reduced;
                    let state = two_invocations(&context, words);
                    let result = search(&context, state, &mut Never(wrong), 1000);
                    let found = result.failure.map(|failure| failure.kind);
                    let expected = is_found.then(|| FailureKind::Instant("found".to_owned()));
                    assert_eq!(found, expected, "{wrong:?} {model:?} {shader}");
                }
            }
        }
    }
}
