//! Progress: what waits for ever, and what only takes many steps.

use fragbuf_checker::{Limits, Model, Report, Shader, check_shader};

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

/// The number of attempts depends on the initial value and the step, not only on the constant of the comparison.
#[test]
fn attempts_are_counted_from_the_initial_value() {
    let from = "if id.x == 9u { first = 1000u; }";
    for (before, head, holds) in [
        ("", "var i = 0u; i < 32u; i++", true),
        ("", "var i = 0u; i < 31u; i++", false),
        ("", "var i = 30u; i < 40u; i++", false),
        ("", "var i = 1000u; i < 1040u; i++", true),
        ("", "var i = 0u; i < 64u; i += 32u", false),
        ("", "var i = 40u; i < 50u; i = 100u - i", false),
        ("", "var i = 1000u; i > 0u; i--", true),
        ("", "var i = 3u; i > 0u; i--", false),
        // It wraps around after four attempts.
        ("", "var i = 3u; i < 1000u; i--", false),
        ("", "var i = -20i; i < 20i; i++", true),
        ("", "var i = 20i; i > -5i; i--", false),
        ("", "var i = 0u; i != 40u; i++", true),
        ("", "var i = 0u; i != 20u; i++", false),
        ("var first = 990u;", "var i = first; i < 1000u; i++", false),
        (&format!("var first = 990u; {from}"), "var i = first; i < 1000u; i++", false),
    ] {
        let wait = format!("{before} for ({head}) {{ if atomicLoad(&x) == 1u {{ return; }} }} seen[0] = 1u;");
        let program = litmus("atomicStore(&x, 1u);", &wait, "seen[0] == 0u");
        for model in [Model::Sequential, Model::Relaxed] {
            assert_eq!(run(&program, 2, model).failure.is_none(), holds, "{before} {head} {model:?}");
        }
    }
}

/// The counter reaches the comparison through an array that is also written at an unknown index.
#[test]
fn a_counter_that_a_local_array_holds_is_more_than_a_limit() {
    let program = litmus(
        "var a: array<u32, 4>;
         let j = id.x + 1u;
         let k = id.x;
         atomicStore(&x, 50u);
         for (var i = 1u; i < 100u; i++) {
             a[0] = i;
             a[j] = 5u;
             if atomicLoad(&x) == a[k] { seen[0] = 1u; break; }
         }",
        "atomicStore(&x, 1000u);",
        "!(seen[0] == 1u && atomicLoad(&x) == 1000u)",
    );
    for model in [Model::Sequential, Model::Relaxed] {
        let failure = run(&program, 2, model).failure.unwrap();
        assert_eq!(failure.violation, "`holds` returns false", "{model:?}");
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
        assert!(
            failure.steps.iter().any(|step| step.action.starts_with("runs on alone, and observes the latest writes")),
            "{:?}",
            failure.steps
        );
        // An unbounded one waits for ever.
        let endless = program.replacen("for (var i = 0u; i < 1000u; i++)", "loop", 1);
        let failure = run(&endless, 2, model).failure.unwrap();
        assert_eq!(failure.violation, "deadlock: A waits for a value that no other fragment can change");
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

/// Returns the report of two invocations that both wait with this number of attempts, and what they then do.
fn waiting(attempts: u32, then: &str, random_schedules: Option<u32>) -> Report {
    // Both store zero, so that the word is not constant.
    let wait = format!(
        "atomicStore(&x, 0u); for (var i = 0u; i < {attempts}u; i++) {{ if atomicLoad(&x) == 1u {{ return; }} }} {then}"
    );
    let source = litmus(&wait, &wait, "true");
    let shader = Shader { file: "litmus.wgsl", source: &source, entry: "main", ..Shader::default() };
    check_shader(&shader, &Limits { fragments: vec![2], random_schedules, ..Limits::default() }).unwrap()
}

#[test]
fn a_loop_too_long_to_run_to_its_limit_is_not_decided() {
    for random in [None, Some(2)] {
        let report = waiting(1 << 20, "", random);
        assert_eq!(report.failure, None, "{random:?}");
        assert!(!report.is_exhaustive, "{random:?}");
    }
    let report = waiting(1 << 10, "", None);
    assert!(report.failure.is_none() && report.is_exhaustive);
}

#[test]
fn a_step_that_fails_at_the_limit_is_no_deadlock() {
    for random in [None, Some(2)] {
        let failure = waiting(1000, "loop { if id.x == 9u { break; } }", random).failure.unwrap();
        assert!(failure.violation.contains(" loops without end, "), "{}", failure.violation);
        assert!(failure.steps.last().unwrap().action.starts_with("runs on alone"), "{:?}", failure.steps);
    }
}
