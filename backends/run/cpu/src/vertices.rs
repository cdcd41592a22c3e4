//! Runs the vertex stage: every vertex once, in parallel.

use fragbuf_interpreter::{Bytecode, Exit, LANES, LaneMachine, Machine};
use naga::BuiltIn;
use rayon::prelude::*;

use crate::draw::DrawError;
use crate::view::View;

/// The vertices that one thread takes at a time.
const CHUNK: usize = 1024;

/// The source of an input of the vertex stage.
enum VertexInput {
    VertexIndex,
    InstanceIndex,
    /// Words of an interleaved vertex, from this index.
    Words(usize),
}

/// Returns the words of one interleaved vertex: the inputs of `program` in the order of their locations.
pub(crate) fn stride(program: &Bytecode) -> usize {
    program.inputs.iter().filter(|input| input.location().is_some()).map(|input| input.words.len()).sum()
}

/// Runs `count` vertices of an instance; in lanes, if `lanes` is set and the program allows it.
pub(crate) fn run(
    (program, view): (&Bytecode, &View<'_>),
    vertices: &[u32],
    (count, instance): (usize, u32),
    lanes: bool,
) -> Result<Vec<u32>, DrawError> {
    let stage = VertexStage { inputs: vertex_inputs(program)?, stride: stride(program), program, vertices, instance };
    let words = program.result.len();
    let lanes = lanes && program.buffers.iter().all(|buffer| !buffer.is_written);
    let mut results = vec![0; words * count];
    let endless: Vec<Option<u32>> = results
        .par_chunks_mut((words * CHUNK).max(1))
        .enumerate()
        .map(|(chunk, results)| {
            let lanes = LaneMachine::new(program).filter(|_| lanes);
            let end = match lanes {
                Some(machine) => stage.run_in_lanes(machine, chunk * CHUNK, view, results),
                None => stage.run(chunk * CHUNK, &mut view.clone(), results),
            };
            end.err()
        })
        .collect();
    match endless.into_iter().flatten().next() {
        None => Ok(results),
        Some(at) => Err(DrawError::EndlessVertex(at)),
    }
}

/// The program, inputs and vertices of an instance.
struct VertexStage<'a> {
    program: &'a Bytecode,
    inputs: Vec<VertexInput>,
    vertices: &'a [u32],
    stride: usize,
    instance: u32,
}

impl VertexStage<'_> {
    /// Runs consecutive vertices. `Err`: one reached the limit of backward jumps at this instruction.
    fn run(&self, first: usize, view: &mut View<'_>, results: &mut [u32]) -> Result<(), u32> {
        let mut machine = Machine::new(self.program);
        for (vertex, result) in (first..).zip(results.chunks_mut(self.program.result.len().max(1))) {
            machine.restart();
            self.set_inputs(vertex, |word, value| machine.words_mut(word..word + 1)[0] = value);
            if machine.run(view) != Exit::Ended {
                return Err(machine.at());
            }
            result.copy_from_slice(machine.result());
        }
        Ok(())
    }

    /// The same in lanes.
    fn run_in_lanes(
        &self,
        mut machine: LaneMachine<'_>,
        first: usize,
        view: &View<'_>,
        results: &mut [u32],
    ) -> Result<(), u32> {
        let words = self.program.result.len().max(1);
        for (first, results) in (first..).step_by(LANES).zip(results.chunks_mut(words * LANES)) {
            let count = results.len() / words;
            machine.restart(count);
            for lane in 0..count {
                self.set_inputs(first + lane, |word, value| machine.words_mut(word..word + 1)[0][lane] = value);
            }
            machine.run(view)?;
            for (lane, result) in results.chunks_mut(words).enumerate() {
                machine.copy_result(lane, result);
            }
        }
        Ok(())
    }

    /// Calls `set` with the words of the machine that are inputs, and their values.
    fn set_inputs(&self, vertex: usize, mut set: impl FnMut(usize, u32)) {
        for (input, source) in self.program.inputs.iter().zip(&self.inputs) {
            match source {
                VertexInput::VertexIndex => set(input.words.start, vertex as u32),
                VertexInput::InstanceIndex => set(input.words.start, self.instance),
                VertexInput::Words(first) => {
                    let from = self.vertices.get(vertex * self.stride + first..).unwrap_or_default();
                    input.words.clone().zip(from).for_each(|(word, value)| set(word, *value));
                }
            }
        }
    }
}

fn vertex_inputs(program: &Bytecode) -> Result<Vec<VertexInput>, String> {
    let before = |location: u32| -> usize {
        let earlier = program.inputs.iter().filter(|input| input.location().is_some_and(|other| other < location));
        earlier.map(|input| input.words.len()).sum()
    };
    let source = |input: &fragbuf_interpreter::InterfaceVariable| match input.location() {
        Some(location) => Ok(VertexInput::Words(before(location))),
        None if input.is(BuiltIn::VertexIndex) => Ok(VertexInput::VertexIndex),
        None if input.is(BuiltIn::InstanceIndex) => Ok(VertexInput::InstanceIndex),
        None => Err(format!("the vertex input `{}`", input.name)),
    };
    program.inputs.iter().map(source).collect()
}
