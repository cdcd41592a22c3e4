//! Generates ten thousand closures and compares their results for edge values: an evaluator of Rust's meaning, the interpreter,
//! and devices that run SPIR-V and GLSL.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod compiled;
#[path = "../device/mod.rs"]
mod device;
mod evaluator;
mod expressions;
mod generator;
mod harness;
mod inputs;
mod methods;
mod operators;
mod random;
mod range;
mod source;
mod statements;
mod table;
mod types;
mod value;

use std::sync::Mutex;

use compiled::OverflowChecks;
use evaluator::Outcome;
use fragbuf_interpreter::{Bytecode, DispatchEnd, Options, dispatch};
use fragbuf_runtime::headless::{Choice, Headless};
use fragbuf_runtime::wgpu;
use generator::Program;
use harness::{Parsed, RESULT_WORDS, lowered, shader};
use range::Undefined;
use value::{Input, Value};

/// Closures of one shader.
const BATCH: usize = 50;

/// Inputs of each closure.
const INPUTS: usize = 24;

#[test]
fn random_closures_have_the_results_of_rust() {
    let count: usize = std::env::var("CLOSURES").map_or(10_000, |count| count.parse().unwrap());
    let first: usize = std::env::var("FIRST").map_or(0, |first| first.parse().unwrap());
    let inputs = inputs::inputs(INPUTS);
    let mut tally = Tally::default();
    let headless = Headless::open(&Choice::Cpu, wgpu::Features::empty()).unwrap();
    let mut programs = Vec::new();
    for index in first.. {
        if programs.len() == count {
            break;
        }
        let program = Program::random(index);
        match lowered(&program) {
            Ok(functions) => programs.push((program, functions)),
            Err(diagnostics) => tally.rejected.push(format!("{}{diagnostics}", program.parts())),
        }
    }
    let batches = Mutex::new(programs.chunks(BATCH));
    let shared = Mutex::new(tally);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(batch) = { batches.lock().unwrap().next() } {
                    let tally = compare(batch, &inputs, &headless);
                    shared.lock().unwrap().add(tally);
                }
            });
        }
    });
    let mut tally = shared.into_inner().unwrap();
    tally.differences.sort();
    if std::env::var("SHOW").is_ok() {
        println!("{:?}", tally.reasons);
    }
    if let Ok(path) = std::env::var("SHOW") {
        std::fs::write(path, tally.differences.join("\n=====\n")).unwrap();
    }
    println!("{} of {} results are defined, {} closures rejected", tally.defined, tally.all, tally.rejected.len());
    assert!(tally.differences.is_empty(), "{} differ:\n{}", tally.differences.len(), tally.differences.join("\n"));
    assert!(tally.rejected.len() * 2 < count, "{}", tally.rejected[0]);
    assert!(tally.defined * 2 > tally.all, "only {} of {} results are defined", tally.defined, tally.all);
}

/// Closures that rustc compiles.
const COMPILED: usize = 250;

/// Compiles some of the closures by rustc: their results and panics are those of the evaluator.
#[test]
fn the_evaluator_has_the_results_of_rustc() {
    let inputs = inputs::inputs(INPUTS);
    let programs: Vec<Program> =
        (0..).map(Program::random).filter(|program| lowered(program).is_ok()).take(COMPILED).collect();
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
    if let Ok(path) = std::env::var("SHOW") {
        std::fs::write(format!("{path}.rustc"), wrong.join("\n=====\n")).unwrap();
    }
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong[..wrong.len().min(3)].join("\n"));
    assert!(counts.iter().all(|count| *count > COMPILED), "results and panics: {counts:?}");
}

#[derive(Default)]
struct Tally {
    all: usize,
    defined: usize,
    rejected: Vec<String>,
    reasons: std::collections::BTreeMap<Undefined, usize>,
    differences: Vec<String>,
}

impl Tally {
    fn add(&mut self, other: Tally) {
        self.all += other.all;
        self.defined += other.defined;
        self.differences.extend(other.differences);
        for (reason, count) in other.reasons {
            *self.reasons.entry(reason).or_default() += count;
        }
    }
}

/// Runs a batch on every device.
fn compare(batch: &[(Program, String)], inputs: &[Input], headless: &Headless) -> Tally {
    let mut tally = Tally::default();
    let source = shader(batch);
    let (module, info) = match accepted(batch, &source) {
        Ok(valid) => valid,
        Err(errors) => {
            tally.differences = errors;
            return tally;
        }
    };
    let program = Bytecode::entry_point(&module, &info, "main", &Options::default()).unwrap();
    let words: Vec<u32> = inputs.iter().flat_map(|input| input.words.clone()).collect();
    let results = vec![0; inputs.len() * batch.len() * RESULT_WORDS];
    let initial: Vec<Vec<u32>> = program
        .buffers
        .iter()
        .map(|buffer| if buffer.name == "results" { results.clone() } else { words.clone() })
        .collect();
    let at = program.buffers.iter().position(|buffer| buffer.name == "results").unwrap();
    let groups = [inputs.len() as u32, 1, 1];
    let mut interpreted = initial.clone();
    assert_eq!(dispatch(&program, groups, &mut interpreted), DispatchEnd::Ended);
    let mut run = match std::env::var("NO_DEVICE").is_ok() {
        true => interpreted.clone(),
        false => device::run(headless, &source, "main", &program, groups, &initial),
    };
    let found = [("interpreter", interpreted.swap_remove(at)), ("SPIR-V", run.swap_remove(at))];
    for (index, (program, _)) in batch.iter().enumerate() {
        let parsed = Parsed::new(program).unwrap();
        for (number, input) in inputs.iter().enumerate() {
            tally.all += 1;
            let expected = match parsed.evaluate(input).value {
                Ok(value) => value,
                Err(reason) => {
                    *tally.reasons.entry(reason).or_default() += 1;
                    continue;
                }
            };
            tally.defined += 1;
            let first = (number * batch.len() + index) * RESULT_WORDS;
            for (device, results) in &found {
                let words = &results[first..first + RESULT_WORDS];
                if !expected.is(words) {
                    tally.differences.push(difference(program, input, device, &expected, words));
                    break;
                }
            }
        }
    }
    tally
}

/// Returns the validated shader. If it is invalid, finds the programs that are.
fn accepted(
    batch: &[(Program, String)],
    source: &str,
) -> Result<(naga::Module, naga::valid::ModuleInfo), Vec<String>> {
    device::validated(source).map_err(|error| {
        let single = |one: &(Program, String)| {
            let error = device::validated(&shader(std::slice::from_ref(one))).err()?;
            Some(format!("invalid WGSL: {error}\n{}\n{}", one.0.parts(), one.1))
        };
        let errors: Vec<String> = batch.iter().filter_map(single).collect();
        assert!(!errors.is_empty(), "only many functions together are invalid: {error}");
        errors
    })
}

fn difference(program: &Program, input: &Input, device: &str, expected: &Value, words: &[u32]) -> String {
    let floats: Vec<f32> = words.iter().map(|word| f32::from_bits(*word)).collect();
    format!(
        "{device}:\n{}\nuniforms {:?}\nfragments {:?}\nexpected {expected:?}\nfound {words:?} {floats:?}\n",
        program.parts(),
        input.uniforms,
        input.fragments
    )
}
