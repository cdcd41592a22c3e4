//! Compares the results of many programs on devices with those of the evaluator.

use std::collections::BTreeMap;
use std::sync::Mutex;

use fragbuf_interpreter::{Bytecode, DispatchEnd, Options, dispatch};
use naga::valid::ModuleInfo;

use super::device;
use super::evaluator::TOO_LONG;
use super::generator::Program;
use super::harness::{Parsed, RESULT_WORDS, lowered, shader};
use super::lane_dispatch::dispatch_in_lanes;
use super::range::Undefined;
use super::shrink::shrink;
use super::value::{Input, Value};

/// Closures of one shader.
const BATCH: usize = 50;

/// A compute shader: binding 0 has the words that it reads, binding 1 the words that it writes.
pub struct Shader {
    pub source: String,
    pub module: naga::Module,
    pub info: ModuleInfo,
    pub inputs: Vec<u32>,
    /// The number of written words.
    pub results: usize,
    /// The number of workgroups of one invocation.
    pub groups: u32,
}

/// A device: its name, and a function from a shader to the words that it writes, or to the reason why it cannot run it.
pub struct Device<'d> {
    pub name: &'static str,
    pub run: &'d (dyn Fn(&Shader) -> Result<Vec<u32>, String> + Sync),
}

/// The results of a comparison.
#[derive(Default)]
pub struct Tally {
    /// Programs that were compared, and those that fragbuf rejects.
    pub programs: usize,
    pub rejected: usize,
    /// Pairs of a program and an input, and those with a defined result.
    pub all: usize,
    pub defined: usize,
    /// Why results are open, and how often.
    pub reasons: BTreeMap<&'static str, usize>,
    /// Shaders of one program that a device does not run.
    pub unsupported: usize,
    pub differences: Vec<String>,
}

/// Returns `count` valid programs from number `first` on, with their functions, and the number of programs that fragbuf rejects.
pub fn valid(first: usize, count: usize) -> (Vec<(Program, String)>, usize) {
    let (mut programs, mut rejected) = (Vec::new(), 0);
    for index in first.. {
        if programs.len() == count {
            break;
        }
        let program = Program::random(index);
        match lowered(&program) {
            Ok(functions) => programs.push((program, functions)),
            Err(rejection) => {
                assert!(rejection.is_expected(), "rejected:\n{}\n{rejection}", program.parts());
                rejected += 1;
                // All of a few programs may be rejected.
                assert!(
                    rejected < count + 20,
                    "most closures are rejected: {rejected}, and {} are not",
                    programs.len()
                );
            }
        }
    }
    (programs, rejected)
}

/// Compares `count` valid programs from number `first` on.
pub fn compare(first: usize, count: usize, inputs: &[Input], devices: &[Device<'_>], threads: usize) -> Tally {
    let (programs, rejected) = valid(first, count);
    let tally = Tally { programs: programs.len(), rejected, ..Tally::default() };
    let batches = Mutex::new(programs.chunks(BATCH));
    let shared = Mutex::new(tally);
    let work = || {
        while let Some(batch) = { batches.lock().unwrap().next() } {
            let tally = compare_batch(batch, inputs, devices);
            shared.lock().unwrap().add(tally);
        }
    };
    match threads {
        // Some devices belong to the thread that opened them.
        1 => work(),
        _ => std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work)))),
    }
    let mut tally = shared.into_inner().unwrap();
    if let Some(first) = tally.differences.first_mut() {
        *first = shrunk(&programs, first, inputs, devices);
    }
    tally
}

impl Tally {
    fn add(&mut self, other: Tally) {
        self.all += other.all;
        self.defined += other.defined;
        self.unsupported += other.unsupported;
        self.differences.extend(other.differences);
        for (reason, count) in other.reasons {
            *self.reasons.entry(reason).or_default() += count;
        }
    }
}

/// Returns the report of a smaller program that fails as well.
fn shrunk(programs: &[(Program, String)], report: &str, inputs: &[Input], devices: &[Device<'_>]) -> String {
    let Some((program, _)) = programs.iter().find(|(program, _)| report.contains(&program.parts())) else {
        return report.to_owned();
    };
    let failure = |program: &Program| {
        let functions = lowered(program).ok()?;
        // Without its `break`, a loop may not end.
        let parsed = Parsed::new(program).ok()?;
        let ends = |input: &Input| parsed.evaluate(input).value != Err(TOO_LONG);
        if !inputs.iter().all(ends) {
            return None;
        }
        compare_batch(&[(program.clone(), functions)], inputs, devices).differences.into_iter().next()
    };
    let small = shrink(program.clone(), |smaller| failure(smaller).is_some());
    format!("{}\nfrom program {}", failure(&small).unwrap_or_else(|| report.to_owned()), program.index)
}

/// Runs a batch on every device.
fn compare_batch(batch: &[(Program, String)], inputs: &[Input], devices: &[Device<'_>]) -> Tally {
    let mut tally = Tally::default();
    let source = shader(batch);
    let (module, info) = match accepted(batch, &source) {
        Ok(valid) => valid,
        Err(errors) => {
            tally.differences = errors;
            return tally;
        }
    };
    let shader = Shader {
        source,
        module,
        info,
        inputs: inputs.iter().flat_map(|input| input.words.clone()).collect(),
        results: inputs.len() * batch.len() * RESULT_WORDS,
        groups: inputs.len() as u32,
    };
    let mut found: Vec<(&str, Vec<u32>)> = Vec::new();
    for device in devices {
        match (device.run)(&shader) {
            Ok(words) => found.push((device.name, words)),
            Err(error) if batch.len() == 1 => {
                let (program, wgsl) = &batch[0];
                tally.unsupported += 1;
                tally.differences.push(format!("{} rejects: {error}\n{}\n{wgsl}", device.name, program.parts()));
                return tally;
            }
            // Find the programs that it rejects.
            Err(error) => {
                batch.chunks(1).for_each(|one| tally.add(compare_batch(one, inputs, devices)));
                if tally.unsupported == 0 {
                    let together =
                        format!("{} accepts each of {} closures and rejects them together", device.name, batch.len());
                    tally.differences.push(format!("{together}: {error}\n{}", shader.source));
                }
                return tally;
            }
        }
    }
    for (index, (program, _)) in batch.iter().enumerate() {
        let parsed = Parsed::new(program).unwrap();
        for (number, input) in inputs.iter().enumerate() {
            tally.all += 1;
            let expected = match parsed.evaluate(input).value {
                Ok(value) => value,
                Err(Undefined::Gap(gap)) => {
                    tally.differences.push(format!("the evaluator has no result: {gap}\n{}", program.parts()));
                    continue;
                }
                Err(Undefined::Open(reason)) => {
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
                }
            }
        }
    }
    tally
}

/// Returns the validated shader. If it is invalid, finds the programs that are.
fn accepted(batch: &[(Program, String)], source: &str) -> Result<(naga::Module, ModuleInfo), Vec<String>> {
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

/// Returns the report of a wrong result.
pub fn difference(program: &Program, input: &Input, device: &str, expected: &Value, words: &[u32]) -> String {
    let floats: Vec<f32> = words.iter().map(|word| f32::from_bits(*word)).collect();
    format!(
        "{device}:\n{}\nuniforms {:?}\nfragments {:?}\nexpected {expected:?}\nfound {words:?} {floats:?}\n",
        program.parts(),
        input.uniforms,
        input.fragments
    )
}

/// Runs a shader on the interpreter: one invocation after the other, and in lanes, which must give the same words.
pub fn interpret(shader: &Shader) -> Result<Vec<u32>, String> {
    let program = Bytecode::entry_point(&shader.module, &shader.info, "main", &Options::default()).unwrap();
    let initial = buffers(&program, shader);
    let mut buffers = initial.clone();
    let end = dispatch(&program, [shader.groups, 1, 1], &mut buffers);
    if end != DispatchEnd::Ended {
        return Err(format!("the shader does not end: {end:?}"));
    }
    let mut in_lanes = initial;
    let end = dispatch_in_lanes(&program, [shader.groups, 1, 1], &mut in_lanes);
    if end != DispatchEnd::Ended || in_lanes != buffers {
        return Err(format!("lanes differ from single invocations: {end:?}"));
    }
    Ok(buffers.swap_remove(results(&program)))
}

/// Returns the words of the buffers before a dispatch, in the order of the program.
pub fn buffers(program: &Bytecode, shader: &Shader) -> Vec<Vec<u32>> {
    let words = |name: &str| if name == "results" { vec![0; shader.results] } else { shader.inputs.clone() };
    program.buffers.iter().map(|buffer| words(&buffer.name)).collect()
}

/// Returns the index of the buffer that the shader writes.
pub fn results(program: &Bytecode) -> usize {
    program.buffers.iter().position(|buffer| buffer.name == "results").unwrap()
}
