//! Compiles the same functions as Rust and as closures of fragbuf, and compares their results for edge values and random
//! numbers: Rust, the interpreter, and a device that runs SPIR-V.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod device;
mod functions;
mod lane_dispatch;

use std::fmt::Write;

use fragbuf_interpreter::{Bytecode, DispatchEnd, Options, dispatch};
use fragbuf_runtime::headless::{Choice, Headless};
use fragbuf_runtime::wgpu;
use functions::vectors::vectors;
use functions::{Function, Word, loops, numbers, whole_numbers};
use lane_dispatch::dispatch_in_lanes;

/// Seeded numbers.
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        self.next() as usize % end
    }

    /// Returns an edge value or, seldom, a number between.
    fn argument(&mut self, edges: &[u32], is_float: bool) -> u32 {
        match (self.below(4), is_float) {
            (0, false) => self.next() >> self.below(32),
            (0, true) => (self.below(4001) as f32 / 100.0 - 20.0).to_bits(),
            _ => edges[self.below(edges.len())],
        }
    }
}

/// Arguments of each function.
const ROUNDS: usize = 400;

/// Returns the closures as WGSL, and an entry point that calls each with the arguments of each round.
fn shader(functions: &[Function]) -> String {
    let sources: String = functions.iter().map(|function| format!("{}\n", function.source)).collect();
    let description = format!("buffer Compared {{ {sources} }}");
    let parsed = fragbuf_syntax::parse(&description, "compared");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    let mut wgsl: String = parsed.draft.unwrap().helpers.iter().map(|helper| helper.wgsl.clone()).collect();
    wgsl.push_str(
        "@group(0) @binding(0) var<storage, read> arguments: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
",
    );
    let count = functions.len();
    for (index, Function { name, parameters, .. }) in functions.iter().enumerate() {
        let word = |(at, from): (usize, &&str)| format!("{from}(arguments[(id.x * {count}u + {index}u) * 3u + {at}u])");
        let arguments: Vec<String> = parameters.iter().enumerate().map(word).collect();
        let call = format!("user_{name}({})", arguments.join(", "));
        let _ = writeln!(wgsl, "    results[id.x * {count}u + {index}u] = bitcast<u32>({call});");
    }
    wgsl.push_str("}\n");
    wgsl
}

/// Returns whether a result is right: equal words, or floats within the part that WGSL's accuracy leaves. Infinities, NaN, and
/// numbers that a device may replace by zero are not compared.
fn is_right(expected: u32, found: u32, is_float: bool) -> bool {
    let (right, float) = (f32::from_bits(expected), f32::from_bits(found));
    match is_float {
        false => expected == found,
        true if !right.is_finite() || (right != 0.0 && right.abs() < 1e-30) || right.abs() > 1e35 => true,
        true => (right - float).abs() <= right.abs().max(1.0) / 1024.0,
    }
}

fn differences(functions: &[Function]) -> Vec<String> {
    let source = shader(functions);
    let mut random = Random(0x2545_f491);
    let mut arguments = Vec::new();
    for function in (0..ROUNDS).flat_map(|_| functions) {
        let word = |at: usize, random: &mut Random| {
            let is_float = function.parameters.get(at) == Some(&<f32 as Word>::FROM_WORD);
            function.edges.get(at).map_or(0, |edges| random.argument(edges, is_float))
        };
        arguments.extend((0..3).map(|at| word(at, &mut random)));
    }
    let (module, info) = device::parsed(&source);
    let program = Bytecode::entry_point(&module, &info, "main", &Options::default()).unwrap();
    let results = vec![0; ROUNDS * functions.len()];
    let initial = |name: &str| if name == "results" { results.clone() } else { arguments.clone() };
    let initial: Vec<Vec<u32>> = program.buffers.iter().map(|buffer| initial(&buffer.name)).collect();
    let at = program.buffers.iter().position(|buffer| buffer.name == "results").unwrap();
    let mut interpreted = initial.clone();
    assert_eq!(dispatch(&program, [ROUNDS as u32, 1, 1], &mut interpreted), DispatchEnd::Ended);
    let mut in_lanes = initial.clone();
    assert_eq!(dispatch_in_lanes(&program, [ROUNDS as u32, 1, 1], &mut in_lanes), DispatchEnd::Ended);
    assert!(in_lanes == interpreted, "lanes give other words than single invocations");
    let headless = Headless::open(&Choice::Cpu, wgpu::Features::empty()).unwrap();
    let run = device::run(&headless, &source, "main", &program, [ROUNDS as u32, 1, 1], &initial);
    let mut found = Vec::new();
    for (index, words) in arguments.chunks(3).enumerate() {
        let function = &functions[index % functions.len()];
        let expected = (function.run)(words);
        for (name, result) in [("interpreter", interpreted[at][index]), ("device", run[at][index])] {
            if !is_right(expected, result, function.is_float) {
                let floats = |words: &[u32]| words.iter().map(|word| f32::from_bits(*word)).collect::<Vec<_>>();
                let (expected, result) = ([expected], [result]);
                found.push(format!(
                    "{name}: {}({words:?} {:?}): Rust {expected:?} {:?}, {result:?} {:?}",
                    function.name,
                    floats(words),
                    floats(&expected),
                    floats(&result)
                ));
            }
        }
    }
    found
}

#[test]
fn loops_end_at_the_bounds_of_their_types() {
    let found = differences(&loops());
    assert!(found.is_empty(), "{} results differ:\n{}", found.len(), found.join("\n"));
}

#[test]
fn methods_of_whole_numbers_have_the_results_of_rust() {
    let found = differences(&whole_numbers());
    assert!(found.is_empty(), "{} results differ:\n{}", found.len(), found.join("\n"));
}

#[test]
fn methods_of_floats_have_the_results_of_rust() {
    let found = differences(&numbers());
    assert!(found.is_empty(), "{} results differ:\n{}", found.len(), found.join("\n"));
}

#[test]
fn methods_of_vectors_have_the_results_of_rust() {
    let found = differences(&vectors());
    assert!(found.is_empty(), "{} results differ:\n{}", found.len(), found.join("\n"));
}

/// The functions call every method that `fragbuf language` lists.
#[test]
fn every_method_is_compared() {
    let sources: String =
        [loops(), whole_numbers(), numbers(), vectors()].iter().flatten().map(|function| function.source).collect();
    let reference = fragbuf_syntax::reference();
    let methods = reference.split("# Methods").nth(1).unwrap().split("\n# ").next().unwrap();
    let names: Vec<&str> =
        methods.lines().filter_map(|line| line.split('`').nth(1)?.split_once('(').map(|(name, _)| name)).collect();
    assert!(names.len() > 80, "{names:?}");
    let missing: Vec<&&str> = names.iter().filter(|name| !sources.contains(&format!(".{name}("))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
