//! Litmus tests of the relaxed model that concern read-modify-writes, weak exchanges, waits and the interlock. Comments name the
//! shape; the comparison with the axioms is in `src/relaxed/tests`.

use fragbuf_checker::Model;

use crate::litmus::{holds, litmus, run};

/// Returns whether the relaxed model has the outcome that sequential consistency lacks.
fn is_relaxed_only(program: &str) -> bool {
    assert!(holds(program, Model::Sequential), "{program}");
    !holds(program, Model::Relaxed)
}

#[test]
fn a_read_modify_write_may_observe_an_older_write() {
    // MP, whose second read is a read-modify-write.
    let program = |fence: &str| {
        litmus(
            &format!("atomicStore(&x, 1u); {fence} atomicStore(&y, 1u);"),
            &format!("seen[0] = atomicLoad(&y); {fence} seen[1] = atomicAdd(&x, 0u);"),
            "!(seen[0] == 1u && seen[1] == 0u)",
        )
    };
    assert!(is_relaxed_only(&program("")));
    assert!(holds(&program("memory_fence();"), Model::Relaxed));
    // SB, whose loads are read-modify-writes.
    let buffering = litmus(
        "atomicStore(&x, 1u); seen[0] = atomicAdd(&y, 0u);",
        "atomicStore(&y, 1u); seen[1] = atomicAdd(&x, 0u);",
        "seen[0] == 1u || seen[1] == 1u",
    );
    assert!(is_relaxed_only(&buffering));
    // 2+2W, whose second stores are exchanges.
    let writes = litmus(
        "atomicStore(&x, 1u); atomicExchange(&y, 2u);",
        "atomicStore(&y, 1u); atomicExchange(&x, 2u);",
        "!(atomicLoad(&x) == 1u && atomicLoad(&y) == 1u)",
    );
    assert!(is_relaxed_only(&writes));
}

#[test]
fn no_write_comes_between_the_halves_of_a_read_modify_write() {
    let exchange = litmus(
        "seen[0] = atomicExchange(&x, 1u);",
        "atomicStore(&x, 2u);",
        "(seen[0] == 0u && atomicLoad(&x) != 0u) || (seen[0] == 2u && atomicLoad(&x) == 1u)",
    );
    assert!(holds(&exchange, Model::Relaxed));
    let counted = litmus("seen[0] = atomicAdd(&x, 1u);", "seen[1] = atomicAdd(&x, 1u);", "seen[0] + seen[1] == 1u");
    assert!(holds(&counted, Model::Relaxed));
}

#[test]
fn a_failed_exchange_is_a_load() {
    let stale = litmus(
        "atomicStore(&x, 1u); atomicStore(&y, 1u);",
        "seen[0] = atomicLoad(&y); seen[1] = atomicCompareExchangeWeak(&x, 7u, 9u).old_value;",
        "!(seen[0] == 1u && seen[1] == 0u)",
    );
    assert!(is_relaxed_only(&stale));
    // It writes nothing, so it releases nothing.
    let release = litmus(
        "atomicStore(&x, 1u); memory_fence(); let r = atomicCompareExchangeWeak(&y, 7u, 9u);",
        "seen[0] = 1u + atomicExchange(&y, 2u); memory_fence(); seen[1] = atomicLoad(&x);",
        "!(seen[0] == 1u && seen[1] == 0u && atomicLoad(&y) == 2u)",
    );
    assert!(!holds(&release, Model::Relaxed));
}

#[test]
fn a_weak_exchange_may_fail_for_no_reason() {
    let once = litmus("seen[0] = u32(atomicCompareExchangeWeak(&x, 0u, 9u).exchanged);", "", "seen[0] == 1u");
    for model in [Model::Sequential, Model::Relaxed] {
        let failure = run(&once, 1, model).failure.unwrap();
        assert!(failure.steps[0].action.ends_with("it is, but the weak exchange fails"), "{:?}", failure.steps);
    }
    let repeated =
        once.replace("seen[0] = u32(", "loop { if ").replace(".exchanged);", ".exchanged { seen[0] = 1u; break; } }");
    for model in [Model::Sequential, Model::Relaxed] {
        assert!(run(&repeated, 1, model).failure.is_none());
    }
}

#[test]
fn a_wait_may_end_on_a_value_that_is_overwritten() {
    let program = |look: &str| {
        format!(
            "{}\nfn holds() -> bool {{ return seen[0] == 0u; }}",
            litmus("", "", "true").split("@compute").next().unwrap().to_owned()
                + &format!(
                    "@group(0) @binding(5) var<storage, read_write> z: atomic<u32>;
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    switch id.x {{
        case 0u: {{ atomicStore(&x, 1u); atomicStore(&x, 0u); atomicStore(&y, 1u); }}
        case 1u: {{ loop {{ if atomicLoad(&y) == 1u {{ break; }} }} {look} }}
        default: {{
            loop {{ if atomicLoad(&y) == 1u {{ break; }} }}
            seen[0] = atomicLoad(&z);
            atomicStore(&x, 1u);
        }}
    }}
}}"
                )
        )
    };
    for look in [
        "if atomicLoad(&x) == 1u { atomicStore(&z, 1u); }",
        "for (var i = 0u; i < 1000u; i++) { if atomicLoad(&x) == 1u { atomicStore(&z, 1u); return; } }",
    ] {
        assert!(run(&program(look), 3, Model::Sequential).failure.is_none(), "{look}");
        let failure = run(&program(look), 3, Model::Relaxed).failure.unwrap();
        assert_eq!(failure.violation, "`holds` returns false", "{look}");
    }
}

#[test]
fn an_interlock_orders_its_own_sections_only() {
    let program = |before: &str, inside: &str, after: &str| {
        litmus(
            &format!("{before} critical_begin(); atomicStore(&x, 1u); {inside} critical_end();"),
            &format!("critical_begin(); seen[0] = atomicLoad(&x); {after}"),
            "!(seen[0] == 1u && seen[1] == 0u)",
        )
    };
    let (store, load) = ("atomicStore(&y, 1u);", "seen[1] = atomicLoad(&y);");
    let (load_inside, load_after) = (format!("{load} critical_end();"), format!("critical_end(); {load}"));
    assert!(holds(&program("", store, &load_inside), Model::Relaxed));
    assert!(is_relaxed_only(&program(store, "", &load_after)));
    assert!(is_relaxed_only(&program(store, "", &load_inside)));
    // A fence in each section orders what comes before it too.
    let fenced = program(&format!("{store} memory_fence();"), "", &format!("memory_fence(); {load_after}"));
    assert!(holds(&fenced, Model::Relaxed));
}

#[test]
fn a_store_orders_no_load_that_need_not_observe_it() {
    // The addition of the second invocation may come first, although its load comes before it and the store may do so too.
    let program = litmus(
        "seen[0] = atomicAdd(&x, 1u); atomicStore(&y, 1u);",
        "seen[1] = atomicLoad(&y); atomicAdd(&x, 2u);",
        "seen[0] == 0u",
    );
    assert!(!holds(&program, Model::Relaxed));
}

#[test]
fn a_word_may_have_many_writes() {
    let program = litmus(
        "for (var i = 1u; i <= 300u; i++) { atomicStore(&x, i); }",
        "seen[0] = atomicLoad(&x); seen[1] = atomicLoad(&x);",
        "seen[0] <= seen[1] && atomicLoad(&x) == 300u",
    );
    assert!(holds(&program, Model::Relaxed));
}
