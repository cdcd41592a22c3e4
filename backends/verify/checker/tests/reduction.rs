//! The partial-order reduction changes no verdict: a search of all interleavings has the same.

use fragbuf_checker::{Limits, Model, Report, Shader, check_shader};
use fragbuf_templates::Registry;

use crate::litmus::litmus;
use crate::subjects::{limits, report};
use crate::verdicts::{VERDICTS, outcome};

fn violation(report: &Report) -> Option<&str> {
    report.failure.as_ref().map(|failure| failure.violation.as_str())
}

#[test]
fn techniques_have_the_same_verdict_without_the_reduction() {
    let registry = Registry::builtin();
    let (mut reduced_states, mut all_states) = (0, 0);
    for (number, (key, set, target, model, _)) in VERDICTS.into_iter().enumerate() {
        // Every technique with one entry, and one in four with two.
        let entries = if number.is_multiple_of(4) { vec![1, 2] } else { vec![1] };
        let checked = |reduce: bool| {
            let limits = Limits { reduce, shortest: !reduce, entries: entries.clone(), ..limits(2, model) };
            report(key, set, target, &limits, &registry).unwrap()
        };
        // The reduced search alone, beside all interleavings alone.
        let (reduced, all) = (checked(true), checked(false));
        assert!(reduced.is_exhaustive && all.is_exhaustive, "{key} {set:?} {target} {model:?}");
        assert_eq!(outcome(&reduced), outcome(&all), "{key} {set:?} {target} {model:?}");
        if all.failure.is_none() {
            reduced_states += reduced.states;
            all_states += all.states;
        }
    }
    println!("{reduced_states} of {all_states} states");
    assert!(reduced_states < all_states);
}

#[test]
fn three_fragments_have_the_same_verdict_without_the_reduction() {
    let registry = Registry::builtin();
    for (key, target, model) in [
        ("kplus_array", "wgsl", Model::Sequential),
        ("kplus_array", "wgsl", Model::Relaxed),
        ("kplus_array", "spirv", Model::Relaxed),
        ("kb_ll", "spirv", Model::Sequential),
        ("ab_ll_paged", "wgsl", Model::Relaxed),
        ("mdt32_coplanar", "wgsl", Model::Relaxed),
    ] {
        let checked = |reduce: bool| {
            let limits = Limits { fragments: vec![3], entries: vec![1], reduce, shortest: !reduce, ..limits(3, model) };
            report(key, &[], target, &limits, &registry).unwrap()
        };
        let (reduced, all) = (checked(true), checked(false));
        assert_eq!(outcome(&reduced), outcome(&all), "{key} {target} {model:?}");
        assert!(reduced.states <= all.states || all.failure.is_some(), "{key} {target} {model:?}");
    }
}

/// Programs of three invocations of different lengths, with loops that wait and accesses that race.
#[test]
fn shaders_have_the_same_verdict_without_the_reduction() {
    let accesses = [
        "atomicStore(&x, 1u);",
        "seen[id.x] = atomicLoad(&y);",
        "seen[id.x] = atomicAdd(&x, 2u);",
        "loop { if atomicLoad(&x) != 0u { break; } }",
        "if atomicLoad(&y) == 1u { data = id.x; }",
        "memory_fence(); atomicStore(&y, 1u);",
        "critical_begin(); data = data + 1u; critical_end();",
        "loop { let a = atomicLoad(&y); if a + atomicLoad(&x) > 1u { break; } }",
    ];
    let count = accesses.len();
    for code in 0..count * count * count {
        let [a, b, c] = [code % count, code / count % count, code / count / count].map(|at| accesses[at]);
        // No invocation has this number, but without it some words would be constant.
        let writes = "if id.x == 9u { atomicStore(&x, 0u); atomicStore(&y, 0u); data = 0u; }";
        let program = litmus(&format!("{a} {b}"), &format!("{writes} {b} {c}"), "seen[0] + seen[1] < 3u");
        for model in [Model::Sequential, Model::Relaxed] {
            let checked = |reduce: bool| {
                let shader = Shader { file: "litmus.wgsl", source: &program, entry: "main", ..Shader::default() };
                check_shader(&shader, &Limits { fragments: vec![2, 3], model, reduce, ..Limits::default() }).unwrap()
            };
            let (reduced, all) = (checked(true), checked(false));
            let kind =
                |report: &Report| violation(report).map(|text| text.split(':').next().unwrap_or_default().to_owned());
            assert_eq!(kind(&reduced), kind(&all), "{model:?} {program}");
        }
    }
}
