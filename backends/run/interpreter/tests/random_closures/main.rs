//! Generates ten thousand closures and compares their results for edge values: an evaluator of Rust's meaning, the interpreter,
//! and devices that run SPIR-V and GLSL. rustc judges the evaluator.
//!
//! `CLOSURES=100000 FIRST=20000` compares others and more.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test fails by panicking"
)]

mod comparison;
mod compiled;
#[path = "../device/mod.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod device;
#[path = "../functions/edges.rs"]
mod edges;
mod evaluator;
mod expressions;
mod generator;
mod harness;
mod inputs;
#[path = "../lane_dispatch/mod.rs"]
mod lane_dispatch;
mod methods;
mod opengl;
mod operators;
mod random;
mod range;
mod shrink;
mod source;
mod statements;
mod table;
mod types;
mod value;

use std::collections::BTreeSet;

use comparison::{Device, Shader, Tally, buffers, compare, difference, interpret, results, valid};
use compiled::OverflowChecks;
use evaluator::Outcome;
use fragbuf_interpreter::{Bytecode, Options};
use fragbuf_runtime::headless::{Choice, Headless};
use fragbuf_runtime::wgpu;
use generator::Program;
use harness::Parsed;
use table::{NUMBERS, VECTORS};

/// Inputs of each closure.
const INPUTS: usize = 24;

/// Closures that rustc compiles.
const COMPILED: usize = 250;

fn number(variable: &str, default: usize) -> usize {
    std::env::var(variable).map_or(default, |text| text.parse().unwrap())
}

/// Runs closures on devices.
fn assert_equal(devices: &[Device<'_>], count: usize) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let inputs = inputs::inputs(INPUTS);
    let tally = compare(number("FIRST", 0), number("CLOSURES", count), &inputs, devices, threads);
    let Tally { all, defined, rejected, reasons, differences, .. } = &tally;
    println!("{defined} of {all} results are defined, {rejected} closures rejected: {reasons:?}");
    assert!(differences.is_empty(), "{} differ:\n{}", differences.len(), differences[0]);
    assert!(*rejected < tally.programs, "most closures are rejected");
    assert!(defined * 2 > *all, "only {defined} of {all} results are defined");
}

#[test]
fn random_closures_have_the_results_of_rust() {
    let headless = Headless::open(&Choice::Cpu, wgpu::Features::empty()).unwrap();
    let spirv = |shader: &Shader| {
        let program = Bytecode::entry_point(&shader.module, &shader.info, "main", &Options::default()).unwrap();
        let initial = buffers(&program, shader);
        let groups = [shader.groups, 1, 1];
        let mut buffers = device::run(&headless, &shader.source, "main", &program, groups, &initial);
        Ok(buffers.swap_remove(results(&program)))
    };
    assert_equal(&[Device { name: "interpreter", run: &interpret }, Device { name: "SPIR-V", run: &spirv }], 10_000);
}

#[test]
fn random_closures_have_the_results_of_rust_in_opengl() {
    assert_equal(&[Device { name: "GLSL", run: &opengl::run }], 10_000);
}

/// Compiles some of the closures by rustc: their results and panics are those of the evaluator.
#[test]
fn the_evaluator_has_the_results_of_rustc() {
    let inputs = inputs::inputs(INPUTS);
    let programs: Vec<Program> = valid(0, COMPILED).0.into_iter().map(|(program, _)| program).collect();
    let mut wrong = Vec::new();
    let mut counts = [0; 2];
    for checks in [OverflowChecks::On, OverflowChecks::Off] {
        let compiled = compiled::run(&programs, &inputs, checks);
        for (program, results) in programs.iter().zip(compiled) {
            let parsed = Parsed::new(program).unwrap();
            for (input, found) in inputs.iter().zip(results) {
                let Outcome { value: Ok(value), panics } = parsed.evaluate(input) else { continue };
                let is_panic = panics.always || (panics.in_debug && checks == OverflowChecks::On);
                counts[usize::from(is_panic)] += 1;
                let is_right = match &found {
                    Some(words) => !is_panic && value.is(words),
                    None => is_panic,
                };
                if !is_right {
                    let found = found.unwrap_or_default();
                    wrong.push(format!("{panics:?} {}", difference(program, input, "rustc", &value, &found)));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong[0]);
    assert!(counts.iter().all(|count| *count > COMPILED), "results and panics: {counts:?}");
}

/// The generator has every method that `fragbuf language` lists for every type, and the generated closures call each name.
#[test]
fn every_method_is_generated() {
    let sources: String = (0..4000).map(|index| Program::random(index).parts()).collect();
    let reference = fragbuf_syntax::reference();
    let methods = reference.split("# Methods").nth(1).unwrap().split("\n# ").next().unwrap();
    // `| f32 Vec2 | `abs() -> Self` | … |`
    let mut listed: BTreeSet<(&str, &str)> = BTreeSet::new();
    for line in methods.lines() {
        let [_, receivers, signature, ..] = line.split('|').collect::<Vec<_>>()[..] else { continue };
        let Some((name, _)) = signature.split('`').nth(1).and_then(|signature| signature.split_once('(')) else {
            continue;
        };
        listed.extend(receivers.split_whitespace().map(|receiver| (receiver, name)));
    }
    assert!(listed.len() > 120, "{listed:?}");
    let generated: BTreeSet<(&str, &str)> =
        NUMBERS.iter().chain(VECTORS).map(|method| (method.on.rust(), method.name)).collect();
    assert_eq!(generated, listed);
    let is_called = |name: &str| sources.contains(&format!(".{name}(")) || sources.contains(&format!("::{name}("));
    let missing: Vec<_> = listed.iter().filter(|(_, name)| !is_called(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// A report names a small program: what does not change the failure is removed.
#[test]
fn a_failing_program_is_made_smaller() {
    let inputs = inputs::inputs(2);
    // A device that returns 7 for every closure.
    let constant = |shader: &Shader| Ok(vec![7; shader.results]);
    let tally = compare(0, 4, &inputs, &[Device { name: "constant", run: &constant }], 1);
    let report = &tally.differences[0];
    let (program, rest) = report.split_once("\nuniforms").unwrap();
    assert!(program.len() < 200 && rest.contains("from program"), "{report}");
}
