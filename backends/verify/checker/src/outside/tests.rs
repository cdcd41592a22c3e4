//! Tests that walks over memory end whatever the memory holds.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use fragbuf_interpreter::{Exit, Sequential};
use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_targets::TARGETS;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Capability;

use super::{FILLS, check_outside, fill_resources, inputs, programs};
use crate::fragments::Candidates;
use crate::frame::Frame;
use crate::memory::{WIDTH, with_buffers};
use crate::pool_case::ample_values;
use crate::sequential::machine_with;
use crate::subject::{RetryLimit, Subject};

/// Calls `test` with every technique whose shaders share memory, on the first target that can express it.
fn each_technique(mut test: impl FnMut(&str, &Subject)) {
    let registry = Registry::builtin();
    let mut tested = 0;
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let draft = Draft::from_technique(key, &SourceSpan::new(key, 1, 1));
        let variant = check(&draft, &registry).unwrap();
        let subject = |target| Subject::new(&variant, target, &registry, RetryLimit::AsDeclared).ok().flatten();
        let Some(subject) = TARGETS.iter().find_map(subject) else { continue };
        if !subject.plan.selection.provides().contains(&Capability::FixedFunction) {
            test(key, &subject);
            tested += 1;
        }
    }
    assert!(tested > 15, "{tested} techniques");
}

#[test]
fn every_technique_leaves_memory_outside_of_the_frame_alone() {
    each_technique(|key, subject| {
        let mut frame = Frame::new(subject, ample_values(subject).unwrap()).unwrap();
        let candidates = Candidates::new(subject, &mut frame.memory).unwrap().ok().unwrap();
        assert_eq!(check_outside(subject, &candidates.ranked[0]).unwrap(), None, "{key}");
        assert!(!subject.fullscreen.is_empty(), "{key}");
    });
}

#[test]
fn every_walk_ends_in_any_memory() {
    each_technique(|key, subject| {
        let mut frame = Frame::new(subject, ample_values(subject).unwrap()).unwrap();
        let candidates = Candidates::new(subject, &mut frame.memory).unwrap().ok().unwrap();
        for (number, fill) in FILLS.into_iter().enumerate() {
            for (pass, program) in programs(subject) {
                for x in 0..WIDTH {
                    let mut memory = frame.memory.clone();
                    fill_resources(subject, &mut memory, fill);
                    let mut machine = machine_with(program, &inputs(program, &candidates.ranked[0], [x, 0]));
                    let exit = with_buffers(program, &mut memory, |buffers| machine.run(&mut Sequential { buffers }));
                    assert!(matches!(exit, Exit::Ended | Exit::Discarded), "{key}, {pass}, fill {number}: {exit:?}");
                }
            }
        }
    });
}
