//! The models of memory themselves, by the small programs that tell models apart.

use fragbuf_checker::{Error, Limits, Model, Report, Shader, check_shader};

fn run(text: &str, invocations: u32, model: Model) -> Report {
    let shader = Shader { file: "litmus.wgsl", text, entry: "main", fill: &[] };
    let limits = Limits { fragments: vec![invocations], model, ..Limits::default() };
    let report = check_shader(&shader, &limits).unwrap();
    assert!(report.is_whole || report.failure.is_some());
    report
}

fn holds(text: &str, model: Model) -> bool {
    run(text, 2, model).failure.is_none()
}

const HEAD: &str = "
@group(0) @binding(0) var<storage, read_write> x: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> y: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 4>;
fn memory_fence() {}
";

/// Two invocations and what must not be seen in the end.
fn litmus(first: &str, second: &str, holds: &str) -> String {
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
fn a_message_passed_without_fences_may_come_before_what_it_announces() {
    let text = |fence: &str| {
        litmus(
            &format!("atomicStore(&x, 1u); {fence} atomicStore(&y, 1u);"),
            &format!("seen[0] = atomicLoad(&y); {fence} seen[1] = atomicLoad(&x);"),
            "!(seen[0] == 1u && seen[1] == 0u)",
        )
    };
    assert!(holds(&text(""), Model::Sequential));
    assert!(!holds(&text(""), Model::Late));
    assert!(holds(&text("memory_fence();"), Model::Late));
}

#[test]
fn one_fence_of_the_two_is_not_enough() {
    let writer = "atomicStore(&x, 1u); memory_fence(); atomicStore(&y, 1u);";
    let reader = "seen[0] = atomicLoad(&y); memory_fence(); seen[1] = atomicLoad(&x);";
    let wrong = "!(seen[0] == 1u && seen[1] == 0u)";
    assert!(!holds(&litmus(writer, &reader.replace("memory_fence();", ""), wrong), Model::Late));
    assert!(!holds(&litmus(&writer.replace("memory_fence();", ""), reader, wrong), Model::Late));
}

#[test]
fn both_may_miss_the_others_store() {
    let text = litmus(
        "atomicStore(&x, 1u); seen[0] = atomicLoad(&y);",
        "atomicStore(&y, 1u); seen[1] = atomicLoad(&x);",
        "seen[0] == 1u || seen[1] == 1u",
    );
    assert!(holds(&text, Model::Sequential));
    assert!(!holds(&text, Model::Late));
}

#[test]
fn the_order_of_each_word_is_kept() {
    let text = litmus(
        "atomicStore(&x, 1u); atomicStore(&x, 2u);",
        "seen[0] = atomicLoad(&x); seen[1] = atomicLoad(&x);",
        "seen[0] <= seen[1] && atomicLoad(&x) == 2u",
    );
    assert!(holds(&text, Model::Late));
}

#[test]
fn a_late_store_may_overtake_another_invocations() {
    // y says that the second store came later, and still the first one may win.
    let text = |fence: &str| {
        litmus(
            &format!("atomicStore(&x, 1u); {fence} atomicStore(&y, 1u);"),
            &format!("if atomicLoad(&y) == 1u {{ {fence} atomicStore(&x, 2u); seen[0] = 1u; }}"),
            "!(seen[0] == 1u && atomicLoad(&x) == 1u)",
        )
    };
    assert!(holds(&text(""), Model::Sequential));
    assert!(!holds(&text(""), Model::Late));
    assert!(holds(&text("memory_fence();"), Model::Late));
}

#[test]
fn atomic_operations_lose_no_count_and_plain_ones_race() {
    let counted = "
@group(0) @binding(0) var<storage, read_write> x: atomic<u32>;
@compute @workgroup_size(1)
fn main() { if atomicAdd(&x, 1u) > 100u { atomicStore(&x, 0u); } }
fn holds() -> bool { return atomicLoad(&x) == 3u; }";
    assert!(run(counted, 3, Model::Late).failure.is_none());
    let plain = "
@group(0) @binding(0) var<storage, read_write> x: u32;
@compute @workgroup_size(1)
fn main() { x += 1u; }";
    let failure = run(plain, 2, Model::Sequential).failure.unwrap();
    assert!(failure.fault.contains("a data race"), "{}", failure.fault);
    assert!(failure.steps.iter().all(|step| step.place.starts_with("litmus.wgsl:4")), "{:?}", failure.steps);
}

#[test]
fn two_locks_taken_in_two_orders_wait_for_ever() {
    let text = litmus(
        "loop { if atomicExchange(&x, 1u) == 0u { break; } } loop { if atomicExchange(&y, 1u) == 0u { break; } }
         atomicStore(&y, 0u); atomicStore(&x, 0u);",
        "loop { if atomicExchange(&y, 1u) == 0u { break; } } loop { if atomicExchange(&x, 1u) == 0u { break; } }
         atomicStore(&x, 0u); atomicStore(&y, 0u);",
        "true",
    );
    let failure = run(&text, 2, Model::Sequential).failure.unwrap();
    assert!(failure.fault.contains("waits for ever"), "{}", failure.fault);
    assert_eq!(failure.steps.len(), 2);
}

#[test]
fn fragments_that_undo_each_other_go_round_for_ever() {
    let text = litmus(
        "loop { if atomicExchange(&x, 1u) == 3u { break; } }",
        "loop { if atomicExchange(&x, 2u) == 3u { break; } }",
        "true",
    );
    let failure = run(&text, 2, Model::Sequential).failure.unwrap();
    assert!(failure.fault.contains("go round for ever"), "{}", failure.fault);
}

#[test]
fn an_index_out_of_bounds_is_said_and_what_is_not_run_is_refused() {
    let beyond = "
@group(0) @binding(0) var<storage, read_write> x: array<atomic<u32>, 4>;
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) { atomicStore(&x[atomicAdd(&x[0], 3u)], id.x); }";
    let failure = run(beyond, 3, Model::Sequential).failure.unwrap();
    assert!(failure.fault.contains("out of bounds at litmus.wgsl:4"), "{}", failure.fault);
    let derivative = "
@group(0) @binding(0) var<storage, read_write> x: f32;
@fragment
fn main(@location(0) a: f32) { x = dpdx(a); }";
    let shader = Shader { file: "litmus.wgsl", text: derivative, entry: "main", fill: &[] };
    let Err(Error::Unable(text)) = check_shader(&shader, &Limits::default()) else { panic!("it is run") };
    assert_eq!(text, "litmus.wgsl:4: the interpreter does not run derivatives");
}

#[test]
fn a_word_of_64_bits_comes_late_too_but_whole() {
    let text = |fence: &str, holds: &str| {
        let writer = format!("_ = atomicMax(&wide, (u64(7u) << 32u) | u64(7u)); {fence} atomicStore(&y, 1u);");
        let reader = format!(
            "seen[0] = atomicLoad(&y); {fence} let word = atomicLoad(&wide);
             seen[1] = u32(word >> 32u); seen[2] = u32(word - (u64(seen[1]) << 32u));"
        );
        let wide = "@group(0) @binding(3) var<storage, read_write> wide: atomic<u64>;\n";
        format!("{wide}{}", litmus(&writer, &reader, holds))
    };
    let (announced, whole) = ("!(seen[0] == 1u && seen[1] == 0u)", "seen[1] == seen[2]");
    assert!(holds(&text("", announced), Model::Sequential));
    assert!(!holds(&text("", announced), Model::Late));
    assert!(holds(&text("memory_fence();", announced), Model::Late));
    assert!(holds(&text("", whole), Model::Late));
}
