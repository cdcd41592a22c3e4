//! Runs the vertex stage: every vertex once, in parallel.

use fragbuf_interpreter::{Bytecode, Exit, Machine};
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

/// Runs `count` vertices of an instance.
pub(crate) fn run(
    (program, view): (&Bytecode, &View<'_>),
    vertices: &[u32],
    count: usize,
    instance: u32,
) -> Result<Vec<u32>, DrawError> {
    let inputs = vertex_inputs(program)?;
    let stride = stride(program);
    let words = program.result.len();
    let mut results = vec![0; words * count];
    let endless: Vec<Option<u32>> = results
        .par_chunks_mut((words * CHUNK).max(1))
        .enumerate()
        .map(|(chunk, results)| {
            let mut machine = Machine::new(program);
            let mut view = view.clone();
            for (offset, result) in results.chunks_mut(words.max(1)).enumerate() {
                let vertex = chunk * CHUNK + offset;
                machine.restart();
                for (number, source) in inputs.iter().enumerate() {
                    match source {
                        VertexInput::VertexIndex => machine.set_input(number, &[vertex as u32]),
                        VertexInput::InstanceIndex => machine.set_input(number, &[instance]),
                        VertexInput::Words(first) => {
                            let from = vertices.get(vertex * stride + first..).unwrap_or_default();
                            machine.set_input(number, from);
                        }
                    }
                }
                if machine.run(&mut view) != Exit::Ended {
                    return Some(machine.at());
                }
                result.copy_from_slice(machine.result());
            }
            None
        })
        .collect();
    match endless.into_iter().flatten().next() {
        None => Ok(results),
        Some(at) => Err(DrawError::EndlessVertex(at)),
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
