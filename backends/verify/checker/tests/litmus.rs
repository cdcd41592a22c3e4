//! Litmus tests: small programs that distinguish the memory models.

use fragbuf_checker::{Error, Limits, Model, Report, Shader, check_shader};

pub(crate) fn run(source: &str, invocations: u32, model: Model) -> Report {
    let shader = Shader { file: "litmus.wgsl", source, entry: "main", ..Shader::default() };
    let limits = Limits { fragments: vec![invocations], model, ..Limits::default() };
    let report = check_shader(&shader, &limits).unwrap();
    assert!(report.is_exhaustive || report.failure.is_some());
    report
}

pub(crate) fn holds(source: &str, model: Model) -> bool {
    run(source, 2, model).failure.is_none()
}

const HEAD: &str = "
@group(0) @binding(0) var<storage, read_write> x: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> y: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
@coherent @group(0) @binding(4) var<storage, read_write> data: u32;
fn memory_fence() {}
fn critical_begin() {}
fn critical_end() {}
";

/// Returns a program of two invocations, and the property of its final states.
pub(crate) fn litmus(first: &str, second: &str, holds: &str) -> String {
    format!(
        "{HEAD}
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    if id.x == 0u {{ {first} }} else {{ {second} }}
}}
fn holds() -> bool {{ return {holds}; }}"
    )
}

#[test]
fn message_passing_needs_fences() {
    let program = |fence: &str| {
        litmus(
            &format!("atomicStore(&x, 1u); {fence} atomicStore(&y, 1u);"),
            &format!("seen[0] = atomicLoad(&y); {fence} seen[1] = atomicLoad(&x);"),
            "!(seen[0] == 1u && seen[1] == 0u)",
        )
    };
    assert!(holds(&program(""), Model::Sequential));
    assert!(!holds(&program(""), Model::Relaxed));
    assert!(holds(&program("memory_fence();"), Model::Relaxed));
}

#[test]
fn message_passing_needs_both_fences() {
    let writer = "atomicStore(&x, 1u); memory_fence(); atomicStore(&y, 1u);";
    let reader = "seen[0] = atomicLoad(&y); memory_fence(); seen[1] = atomicLoad(&x);";
    let wrong = "!(seen[0] == 1u && seen[1] == 0u)";
    assert!(!holds(&litmus(writer, &reader.replace("memory_fence();", ""), wrong), Model::Relaxed));
    assert!(!holds(&litmus(&writer.replace("memory_fence();", ""), reader, wrong), Model::Relaxed));
}

#[test]
fn store_buffering_is_relaxed() {
    let program = litmus(
        "atomicStore(&x, 1u); seen[0] = atomicLoad(&y);",
        "atomicStore(&y, 1u); seen[1] = atomicLoad(&x);",
        "seen[0] == 1u || seen[1] == 1u",
    );
    assert!(holds(&program, Model::Sequential));
    assert!(!holds(&program, Model::Relaxed));
}

#[test]
fn writes_to_one_word_are_coherent() {
    let program = litmus(
        "atomicStore(&x, 1u); atomicStore(&x, 2u);",
        "seen[0] = atomicLoad(&x); seen[1] = atomicLoad(&x);",
        "seen[0] <= seen[1] && atomicLoad(&x) == 2u",
    );
    assert!(holds(&program, Model::Relaxed));
}

#[test]
fn an_earlier_store_may_be_ordered_last() {
    // The second invocation observes y, so its store executes later, and still the first store may be the last in the history.
    let program = |fence: &str| {
        litmus(
            &format!("atomicStore(&x, 1u); {fence} atomicStore(&y, 1u);"),
            &format!("if atomicLoad(&y) == 1u {{ {fence} atomicStore(&x, 2u); seen[0] = 1u; }}"),
            "!(seen[0] == 1u && atomicLoad(&x) == 1u)",
        )
    };
    assert!(holds(&program(""), Model::Sequential));
    assert!(!holds(&program(""), Model::Relaxed));
    assert!(holds(&program("memory_fence();"), Model::Relaxed));
}

#[test]
fn atomic_additions_lose_no_count_and_plain_ones_race() {
    let counted = "
@group(0) @binding(0) var<storage, read_write> x: atomic<u32>;
@compute @workgroup_size(1)
fn main() { if atomicAdd(&x, 1u) > 100u { atomicStore(&x, 0u); } }
fn holds() -> bool { return atomicLoad(&x) == 3u; }";
    assert!(run(counted, 3, Model::Relaxed).failure.is_none());
    let plain = "
@group(0) @binding(0) var<storage, read_write> x: u32;
@compute @workgroup_size(1)
fn main() { x += 1u; }";
    let failure = run(plain, 2, Model::Sequential).failure.unwrap();
    assert!(failure.violation.contains("data race"), "{}", failure.violation);
    assert!(failure.steps.iter().all(|step| step.location.starts_with("litmus.wgsl:4")), "{:?}", failure.steps);
}

#[test]
fn two_locks_taken_in_opposite_orders_deadlock() {
    let program = litmus(
        "loop { if atomicExchange(&x, 1u) == 0u { break; } } loop { if atomicExchange(&y, 1u) == 0u { break; } }
         atomicStore(&y, 0u); atomicStore(&x, 0u);",
        "loop { if atomicExchange(&y, 1u) == 0u { break; } } loop { if atomicExchange(&x, 1u) == 0u { break; } }
         atomicStore(&x, 0u); atomicStore(&y, 0u);",
        "true",
    );
    let failure = run(&program, 2, Model::Sequential).failure.unwrap();
    assert!(failure.violation.contains("deadlock"), "{}", failure.violation);
    assert_eq!(failure.steps.len(), 2);
}

#[test]
fn invocations_that_undo_each_other_livelock() {
    let program = litmus(
        "loop { if atomicExchange(&x, 1u) == 3u { break; } }",
        "loop { if atomicExchange(&x, 2u) == 3u { break; } }",
        "true",
    );
    let failure = run(&program, 2, Model::Sequential).failure.unwrap();
    assert!(failure.violation.contains("livelock"), "{}", failure.violation);
}

/// WGSL keeps an index inside of the buffer: the access is dropped, or reaches another word, here the last one.
#[test]
fn an_index_out_of_bounds_is_dropped_and_clamped() {
    let program = |holds: &str| {
        format!(
            "
@group(0) @binding(0) var<storage, read_write> x: array<atomic<u32>, 4>;
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{ atomicStore(&x[atomicAdd(&x[0], 3u)], 7u); }}
fn holds() -> bool {{ return {holds}; }}"
        )
    };
    let report = run(&program("atomicLoad(&x[1]) == 0u"), 3, Model::Sequential);
    assert_eq!(report.failure, None);
    let note = &report.notes[0];
    assert!(note.starts_with("the index at litmus.wgsl:4 may be out of bounds"), "{note}");
    for wrong in ["atomicLoad(&x[3]) == 7u", "atomicLoad(&x[3]) == 0u"] {
        assert!(run(&program(wrong), 3, Model::Sequential).failure.is_some(), "{wrong}");
    }
}

#[test]
fn an_unsupported_expression_is_rejected() {
    let derivative = "
@group(0) @binding(0) var<storage, read_write> x: f32;
@fragment
fn main(@location(0) a: f32) { x = dpdx(a); }";
    let shader = Shader { file: "litmus.wgsl", source: derivative, entry: "main", ..Shader::default() };
    let Err(Error::Unable(text)) = check_shader(&shader, &Limits::default()) else {
        panic!("derivatives are accepted")
    };
    assert_eq!(text, "litmus.wgsl:4:36: the interpreter does not run derivatives");
}

#[test]
fn a_word_of_64_bits_is_relaxed_but_not_torn() {
    let program = |fence: &str, holds: &str| {
        let writer = format!("_ = atomicMax(&wide, (u64(7u) << 32u) | u64(7u)); {fence} atomicStore(&y, 1u);");
        let reader = format!(
            "seen[0] = atomicLoad(&y); {fence} let word = atomicLoad(&wide);
             seen[1] = u32(word >> 32u); seen[2] = u32(word - (u64(seen[1]) << 32u));"
        );
        let wide = "@group(0) @binding(3) var<storage, read_write> wide: atomic<u64>;\n";
        format!("{wide}{}", litmus(&writer, &reader, holds))
    };
    let (announced, whole) = ("!(seen[0] == 1u && seen[1] == 0u)", "seen[1] == seen[2]");
    assert!(holds(&program("", announced), Model::Sequential));
    assert!(!holds(&program("", announced), Model::Relaxed));
    assert!(holds(&program("memory_fence();", announced), Model::Relaxed));
    assert!(holds(&program("", whole), Model::Relaxed));
}
