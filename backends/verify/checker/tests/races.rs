//! Data races: conflicting accesses of which at least one is not atomic, and which happens-before does not order.

use fragbuf_checker::Model;

use crate::litmus::{litmus, run};

fn is_race(first: &str, second: &str, model: Model) -> bool {
    let failure = run(&litmus(first, second, "true"), 2, model).failure;
    if let Some(failure) = &failure {
        assert!(failure.violation.starts_with("data race on "), "{}", failure.violation);
    }
    failure.is_some()
}

#[test]
fn unordered_accesses_are_a_race_in_both_models() {
    for model in [Model::Sequential, Model::Relaxed] {
        assert!(is_race("data = 1u;", "data = 2u;", model));
        assert!(is_race("data = 1u;", "seen[0] = data;", model));
        assert!(is_race("seen[0] = data;", "data = 1u;", model));
        assert!(!is_race("seen[0] = data;", "seen[1] = data;", model));
        // An access that comes before the atomic one of its invocation is not ordered.
        assert!(is_race("atomicStore(&y, 1u); data = 1u;", "if atomicLoad(&y) == 1u { data = 2u; }", model));
    }
}

#[test]
fn a_relaxed_flag_does_not_order() {
    let fence = "memory_fence();";
    for (access, other) in
        [("data = 1u;", "seen[0] = data;"), ("data = 1u;", "data = 2u;"), ("seen[0] = data;", "data = 2u;")]
    {
        let write = |fence: &str| format!("{access} {fence} atomicStore(&y, 1u);");
        let read = |fence: &str| format!("if atomicLoad(&y) == 1u {{ {fence} {other} }}");
        assert!(!is_race(&write(""), &read(""), Model::Sequential), "{access} {other}");
        assert!(is_race(&write(""), &read(""), Model::Relaxed), "{access} {other}");
        assert!(is_race(&write(fence), &read(""), Model::Relaxed), "{access} {other}");
        assert!(is_race(&write(""), &read(fence), Model::Relaxed), "{access} {other}");
        assert!(!is_race(&write(fence), &read(fence), Model::Relaxed), "{access} {other}");
    }
}

#[test]
fn a_lock_orders_plain_accesses_with_both_fences() {
    let locked = |acquire: &str, release: &str| {
        format!(
            "loop {{ if atomicExchange(&x, 1u) == 0u {{ break; }} }} {acquire} data = data + 1u; {release} atomicStore(&x, 0u);"
        )
    };
    let fence = "memory_fence();";
    for (acquire, release, races) in [(fence, fence, false), (fence, "", true), ("", fence, true), ("", "", true)] {
        let section = locked(acquire, release);
        assert!(!is_race(&section, &section, Model::Sequential), "{section}");
        assert_eq!(is_race(&section, &section, Model::Relaxed), races, "{section}");
    }
}

#[test]
fn an_interlock_orders_plain_accesses_inside_of_it() {
    let inside = "critical_begin(); data = data + 1u; critical_end();";
    let before = "data = data + 1u; critical_begin(); critical_end();";
    for model in [Model::Sequential, Model::Relaxed] {
        assert!(!is_race(inside, inside, model));
        assert!(is_race(inside, before, model));
    }
}
