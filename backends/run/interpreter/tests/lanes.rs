//! Invocations in lanes take different branches, end at different instructions and access memory; every word is that of one invocation after
//! the other.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::needless_range_loop, reason = "a loop over the lanes of several words")]

#[allow(dead_code, reason = "other tests use the rest")]
mod device;
mod lane_dispatch;

use std::sync::atomic::Ordering;

use fragbuf_interpreter::{Bytecode, DispatchEnd, LANES, LaneMachine, LaneWorkgroup, Options, dispatch};
use lane_dispatch::{Buffers, dispatch_in_lanes};

/// The words of each buffer.
const WORDS: usize = 1 << 12;

const BINDINGS: &str = "
@group(0) @binding(0) var<storage, read_write> results: array<u32>;
@group(0) @binding(1) var<storage, read_write> shared_words: array<atomic<u32>>;
";

fn compiled(body: &str, entry: &str) -> Bytecode {
    let (module, info) = device::parsed(&format!("{BINDINGS}{body}"));
    Bytecode::entry_point(&module, &info, entry, &Options::default()).unwrap()
}

/// Compiles a function `run(id) -> u32`; each invocation stores its result.
fn program(body: &str) -> Bytecode {
    let main = "
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let result = run(id.x);
    results[id.x] = result;
}";
    compiled(&format!("{body}{main}"), "main")
}

/// Runs `count` invocations one after the other and in lanes; returns the words and both ends.
fn both(program: &Bytecode, count: u32) -> ([Vec<Vec<u32>>; 2], [DispatchEnd; 2]) {
    let empty = vec![vec![0; WORDS]; program.buffers.len()];
    let (mut single, mut lanes) = (empty.clone(), empty);
    let ends = [dispatch(program, [count, 1, 1], &mut single), dispatch_in_lanes(program, [count, 1, 1], &mut lanes)];
    ([single, lanes], ends)
}

#[test]
fn divergent_lanes_have_the_results_of_single_invocations() {
    let bodies = [
        // Branches in branches, without and with `else`.
        "fn run(id: u32) -> u32 {
            var sum = id;
            if id % 2u == 0u { sum += 3u; if id % 3u == 0u { sum *= 5u; } else { sum ^= 9u; } }
            if id % 5u == 1u { sum += 100u; } else if id % 5u == 2u { sum += 200u; }
            return sum;
        }",
        // Loops of different lengths, left and continued by some lanes.
        "fn run(id: u32) -> u32 {
            var sum = 0u;
            for (var i = 0u; i < id; i++) {
                if i == 7u && id % 2u == 1u { continue; }
                for (var j = id; j > i; j--) { sum += j * i; if sum % 11u == 3u { break; } }
                if sum > 5000u { break; }
            }
            return sum;
        }",
        // Returns from functions, in loops, at different depths.
        "fn least_divisor(n: u32) -> u32 {
            for (var d = 2u; d * d <= n; d++) { if n % d == 0u { return d; } }
            return n;
        }
        fn factors(n: u32) -> u32 {
            var rest = n; var count = 0u;
            loop {
                if rest < 2u { return count; }
                rest /= least_divisor(rest);
                count++;
                continuing { break if count > 9u; }
            }
            return 1000u;
        }
        fn run(id: u32) -> u32 { return factors(id * 12u) + 100u * least_divisor(id + 30u); }",
        // A switch with several values per case and a default.
        "fn run(id: u32) -> u32 {
            var sum = 0u;
            for (var i = 0u; i < 9u; i++) {
                switch (id + i) % 7u {
                    case 0u, 3u: { sum += 1u; }
                    case 1u: { sum = sum * 3u + 1u; if i > 4u { break; } sum ^= 64u; }
                    case 5u: { continue; }
                    default: { sum += i; }
                }
                sum += 1000u;
            }
            return sum;
        }",
        // Local arrays with different indices, and copies of whole arrays in some lanes.
        "fn run(id: u32) -> u32 {
            var a: array<vec2<u32>, 13>;
            for (var i = 0u; i < 13u; i++) { a[(i * (id + 1u)) % 13u] = vec2(i, id); }
            var b = a;
            if id % 3u == 0u { b = array<vec2<u32>, 13>(); b[id % 13u].y = 77u; }
            var sum = 0u;
            for (var i = 0u; i < 13u; i++) { sum = sum * 31u + b[i].x + 7u * b[(i + id) % 13u].y; }
            return sum;
        }",
        // Slow and fast functions in branches, so that some lanes of them do not run.
        "fn run(id: u32) -> u32 {
            var x = f32(id) * 0.37 - 2.0;
            if id % 4u == 3u { x = sin(x) * exp2(x); } else if id % 4u == 1u { x = mix(x, floor(x), 0.25) + pow(abs(x), 1.5); }
            let packed = pack4x8unorm(vec4(fract(x), x, -x, 0.5));
            return packed ^ bitcast<u32>(unpack4x8unorm(packed).y + min(x, 3.0));
        }",
        // Buffers: reads of what the invocation wrote, and integers of 64 bits.
        "fn run(id: u32) -> u32 {
            let at = 1000u + 16u * id;
            for (var i = 0u; i <= id % 16u; i++) { results[at + i] = i * id; }
            var wide = u64(id) << 33u;
            if id % 2u == 0u { wide /= 3lu; }
            return results[at + id % 7u] + u32(wide >> 20u) + arrayLength(&results);
        }",
    ];
    for body in bodies {
        let program = program(body);
        for count in [1, 5, LANES as u32, LANES as u32 + 1, 60] {
            let ([single, lanes], ends) = both(&program, count);
            assert_eq!(ends, [DispatchEnd::Ended; 2], "{body}");
            assert!(single == lanes, "{count} invocations of\n{body}");
            assert!(count == 1 || single[0][..count as usize].iter().any(|word| *word != single[0][0]), "{body}");
        }
    }
}

#[test]
fn atomic_operations_run_in_the_order_of_the_lanes() {
    let functions = ["Add", "Sub", "And", "Or", "Xor", "Min", "Max", "Exchange"];
    let calls = functions
        .iter()
        .enumerate()
        .map(|(at, name)| format!("sum = sum * 31u + atomic{name}(&shared_words[{at}u], id * 7u + 1u);\n"));
    let calls: String = calls.collect();
    let body = format!(
        "fn run(id: u32) -> u32 {{
            var sum = 0u;
            {calls}
            let tried = atomicCompareExchangeWeak(&shared_words[20u + id % 2u], id / 2u * 5u, id / 2u * 5u + 5u);
            return sum * 2u + u32(tried.exchanged) + tried.old_value;
        }}"
    );
    let ([single, lanes], ends) = both(&program(&body), 40);
    assert_eq!(ends, [DispatchEnd::Ended; 2]);
    assert!(single == lanes, "{:?}\n{:?}", single[0], lanes[0]);
    assert!(single[1][20] > 0, "the exchanges succeed");
}

#[test]
fn accesses_out_of_bounds_are_reported_and_have_no_effect() {
    let body = "fn run(id: u32) -> u32 {
        var local: array<u32, 4>;
        if id == 21u { local[id] = 5u; results[5000u + id] = 1u; atomicAdd(&shared_words[5000u], 1u); }
        return local[id % 4u] + results[select(0u, 1u << 20u, id == 22u)];
    }";
    let program = program(body);
    let ([single, lanes], ends) = both(&program, 32);
    assert!(ends.iter().all(|end| matches!(end, DispatchEnd::OutOfBounds(_))), "{ends:?}");
    assert!(single == lanes);
    let unused = "fn run(id: u32) -> u32 {
        var local: array<u32, 64>;
        var index = id;
        index = index * 2u;
        var seen = local[index];
        seen = results[index << 8u];
        return id;
    }";
    let unused = self::program(unused);
    let (_, ends) = both(&unused, 8);
    assert_eq!(ends, [DispatchEnd::Ended; 2], "reads whose results have no use are within the bounds");
    let (_, ends) = both(&unused, 33);
    assert!(ends.iter().all(|end| matches!(end, DispatchEnd::OutOfBounds(_))), "{ends:?}");
    assert_eq!(ends[0], ends[1]);
    let (_, ends) = both(&program, 21);
    assert_eq!(ends, [DispatchEnd::Ended; 2], "lanes that do not run access nothing");
}

/// A loop of one lane does not end. Loops of the others, which are as long together, do.
#[test]
fn an_endless_loop_is_reported_at_the_same_instruction() {
    let endless = program("fn run(id: u32) -> u32 { var i = 0u; while i < 10u { if id != 3u { i++; } } return i; }");
    let (_, [single, lanes]) = both(&endless, 8);
    assert!(matches!(single, DispatchEnd::Endless(_)), "{single:?}");
    assert_eq!(single, lanes);
    let long = program(
        "fn run(id: u32) -> u32 { var i = 0u; while i < 1200000u + id { i += 1u; if i % 16u == id { continue; } } return i; }",
    );
    let ([single, lanes], ends) = both(&long, 16);
    assert_eq!(ends, [DispatchEnd::Ended; 2]);
    assert!(single == lanes);
}

/// A lane waits for a word that another lane sets behind the loop: lanes that wait do not keep others from running.
#[test]
fn lanes_that_wait_for_others_end() {
    let body = "fn run(id: u32) -> u32 {
        while atomicCompareExchangeWeak(&shared_words[0], 0u, 1u).old_value != 0u { }
        let before = atomicLoad(&shared_words[1]);
        atomicStore(&shared_words[1], before + id);
        atomicStore(&shared_words[0], 0u);
        return 1u;
    }";
    let ([single, lanes], ends) = both(&program(body), 20);
    assert_eq!(ends, [DispatchEnd::Ended; 2]);
    assert!(single == lanes && lanes[1][1] == (0..20).sum::<u32>());
}

#[test]
fn discarded_lanes_do_not_end() {
    let body = "
@fragment
fn shade(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    var number = u32(position.x);
    if number % 3u == 1u { discard; }
    for (var i = 0u; i < number; i++) { number += i & 1u; if number > 30u { discard; } }
    results[number] = number;
    return vec4(f32(number), position.y, 0.0, 1.0);
}";
    let program = compiled(body, "shade");
    let mut machine = LaneMachine::new(&program).unwrap();
    let memory = Buffers::of(&vec![vec![0; WORDS]; program.buffers.len()]);
    let mut expected = vec![0; WORDS];
    let end = |x: u32| {
        let mut number = x;
        let mut i = 0;
        while i < number {
            number += i & 1;
            i += 1;
            if number > 30 {
                return None;
            }
        }
        (x % 3 != 1).then_some(number)
    };
    for first in [0, LANES as u32] {
        machine.restart(LANES - 1);
        let inputs = machine.words_mut(program.inputs[0].words.clone());
        for lane in 0..LANES {
            inputs[0][lane] = (first as f32 + lane as f32 + 0.5).to_bits();
            inputs[1][lane] = 7.5f32.to_bits();
        }
        machine.run(&memory).unwrap();
        for lane in 0..LANES {
            let number = end(first + lane as u32).filter(|_| lane + 1 < LANES);
            assert_eq!(machine.ended().contains(lane), number.is_some(), "lane {lane} from {first}");
            let Some(number) = number else { continue };
            expected[number as usize] = number;
            let mut result = [0; 4];
            machine.copy_result(lane, &mut result);
            assert_eq!(result.map(f32::from_bits), [number as f32, 7.5, 0.0, 1.0]);
        }
    }
    let found: Vec<u32> = memory.0[0].iter().map(|word| word.load(Ordering::Relaxed)).collect();
    assert_eq!(found, expected);
}

#[test]
fn barriers_order_the_lanes_of_a_workgroup() {
    let body = "
var<workgroup> sums: array<u32, 40>;
@compute @workgroup_size(40)
fn scan(@builtin(local_invocation_index) id: u32, @builtin(workgroup_id) group: vec3<u32>) {
    sums[id] = id + group.x;
    for (var step = 1u; step < 40u; step *= 2u) {
        workgroupBarrier();
        var sum = sums[id];
        if id >= step { sum += sums[id - step]; }
        workgroupBarrier();
        sums[id] = sum;
    }
    results[40u * group.x + id] = sums[id];
}";
    let program = compiled(body, "scan");
    let lengths = |buffer: &fragbuf_interpreter::Buffer| vec![0; if buffer.name == "sums" { 40 } else { WORDS }];
    let empty: Vec<Vec<u32>> = program.buffers.iter().map(lengths).collect();
    let (mut single, mut lanes) = (empty.clone(), empty);
    assert_eq!(dispatch(&program, [3, 1, 1], &mut single), DispatchEnd::Ended);
    assert_eq!(dispatch_in_lanes(&program, [3, 1, 1], &mut lanes), DispatchEnd::Ended);
    assert!(single == lanes);
    let results = program.buffers.iter().position(|buffer| buffer.name == "results").unwrap();
    assert_eq!(lanes[results][40 + 39], (0..40).map(|id| id + 1).sum::<u32>());
}

#[test]
fn lanes_at_a_barrier_that_others_do_not_reach_are_reported() {
    let body = "
@compute @workgroup_size(20)
fn some(@builtin(local_invocation_index) id: u32) {
    if id != 18u { workgroupBarrier(); }
    results[id] = id;
}";
    // naga rejects such a barrier, unless uniformity is not validated.
    let (module, _) = (naga::front::wgsl::parse_str(&format!("{BINDINGS}{body}")).unwrap(), ());
    let flags = naga::valid::ValidationFlags::all() - naga::valid::ValidationFlags::CONTROL_FLOW_UNIFORMITY;
    let info = naga::valid::Validator::new(flags, naga::valid::Capabilities::all()).validate(&module).unwrap();
    let program = Bytecode::entry_point(&module, &info, "some", &Options::default()).unwrap();
    let memory = Buffers::of(&vec![vec![0; WORDS]; program.buffers.len()]);
    let mut workgroup = LaneWorkgroup::new(&program).unwrap();
    assert_eq!(workgroup.run([0; 3], [1; 3], &memory), DispatchEnd::DivergentBarrier);
}
