//! Progress: what waits for ever, and what only takes many steps.

use fragbuf_checker::Model;

use crate::litmus::{litmus, run};

/// Four atomic words; loops over them end, though a status may differ from an earlier one in a single word.
const FOUR: &str = "
@group(0) @binding(0) var<storage, read_write> x: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> words: array<atomic<u32>, 8>;
@compute @workgroup_size(1)
fn main() {
    loop { if atomicExchange(&x, 1u) == 0u { break; } }
    memory_fence();
    BODY
    memory_fence();
    atomicStore(&x, 0u);
}
fn memory_fence() {}
fn holds() -> bool { return HOLDS; }
";

fn holds(body: &str, property: &str, invocations: u32) {
    for model in [Model::Sequential, Model::Relaxed] {
        let report = run(&FOUR.replace("BODY", body).replace("HOLDS", property), invocations, model);
        assert_eq!(report.failure, None, "{body} {model:?}");
    }
}

#[test]
fn a_bounded_loop_over_atomics_ends() {
    for invocations in [1, 2, 3] {
        let worst = "var worst = 0u;
            for (var i = 1u; i < 8u; i++) {
                let w = atomicLoad(&words[worst]);
                let c = atomicLoad(&words[i]);
                if w > c { worst = i; }
            }
            atomicStore(&words[worst], atomicLoad(&words[worst]) + 1u);";
        let total = "atomicLoad(&words[0]) + atomicLoad(&words[1])";
        holds(worst, &format!("{total} <= {invocations}u && atomicLoad(&words[0]) > 0u"), invocations);
        // It reads one word again and again.
        let count = "var n = 0u; for (var i = 0u; i < 5u; i++) { n += 1u + 0u * atomicLoad(&words[1]); }
            atomicStore(&words[0], atomicLoad(&words[0]) + n);";
        holds(count, &format!("atomicLoad(&words[0]) == {}u", 5 * invocations), invocations);
        let again =
            "for (var i = 0u; i < 3u; i++) { if atomicLoad(&words[1]) == 9u { return; } } atomicAdd(&words[0], 1u);";
        holds(again, &format!("atomicLoad(&words[0]) == {invocations}u"), invocations);
    }
}

#[test]
fn a_short_loop_reaches_its_limit_before_others_run() {
    let program = |limit: u32| {
        litmus(
            "atomicStore(&x, 1u);",
            &format!("for (var i = 0u; i < {limit}u; i++) {{ if atomicLoad(&x) == 1u {{ return; }} }} seen[0] = 1u;"),
            "seen[0] == 0u",
        )
    };
    // A loop with many attempts is taken to wait while another invocation can still change what it reads.
    for (limit, holds) in [(3, false), (20, false), (1000, true)] {
        for model in [Model::Sequential, Model::Relaxed] {
            assert_eq!(run(&program(limit), 2, model).failure.is_none(), holds, "{limit} {model:?}");
        }
    }
}

#[test]
fn a_long_loop_reaches_its_limit_if_nothing_can_change() {
    // Both store zero, so that the word is not constant.
    let wait = "atomicStore(&x, 0u); for (var i = 0u; i < 1000u; i++) { if atomicLoad(&x) == 1u { return; } }";
    for model in [Model::Sequential, Model::Relaxed] {
        let program =
            litmus(&format!("{wait} seen[0] = 1u;"), &format!("{wait} seen[1] = 1u;"), "seen[0] + seen[1] == 2u");
        assert_eq!(run(&program, 2, model).failure, None);
        let wrong = program.replace("== 2u", "== 1u");
        let failure = run(&wrong, 2, model).failure.unwrap();
        assert!(failure.steps.iter().any(|step| step.action.starts_with("repeats its loop")), "{:?}", failure.steps);
        // An unbounded one waits for ever.
        let endless = program.replacen("for (var i = 0u; i < 1000u; i++)", "loop", 1);
        let failure = run(&endless, 2, model).failure.unwrap();
        assert_eq!(failure.violation, "deadlock: A waits for a value that no running fragment can change");
    }
}

#[test]
fn a_wait_that_reads_several_words_may_be_for_ever() {
    let wait = "loop { let a = atomicLoad(&x); memory_fence(); if a + atomicLoad(&y) == 3u { break; } }";
    for model in [Model::Sequential, Model::Relaxed] {
        let report = |other: &str| run(&litmus(wait, other, "true"), 2, model);
        assert_eq!(report("atomicStore(&y, 1u); atomicStore(&x, 2u);").failure, None);
        let failure = report("atomicStore(&y, 1u); atomicStore(&x, 1u);").failure.unwrap();
        assert!(failure.violation.starts_with("deadlock: A waits"), "{}", failure.violation);
    }
}
