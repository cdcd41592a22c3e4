//! The vertex stage: every vertex once, in parallel.
//!
//! In: a program, words of interleaved vertices. Out: the words that each vertex leaves behind.

use fragbuf_interpreter::{Exit, Machine, Program};
use naga::BuiltIn;
use rayon::prelude::*;

use crate::view::View;

/// Vertices that one thread runs before it takes others.
const CHUNK: usize = 1024;

/// Where an input of the vertex stage comes from.
enum Feed {
    VertexIndex,
    InstanceIndex,
    /// The word of an interleaved vertex.
    Words(usize),
}

/// Words of one interleaved vertex that `program` reads: its inputs in the order of their locations.
pub(crate) fn stride(program: &Program) -> usize {
    program.inputs.iter().filter(|input| input.location().is_some()).map(|input| input.words.len()).sum()
}

/// Runs `count` vertices of an instance, whose words are `vertices`. `Err`: an input that nothing feeds, or one goes round for ever.
pub(crate) fn run(
    (program, view): (&Program, &View<'_>),
    vertices: &[u32],
    count: usize,
    instance: u32,
) -> Result<Vec<u32>, String> {
    let feeds = feeds(program)?;
    let stride = stride(program);
    let words = program.result.len();
    let mut results = vec![0; words * count];
    let ended: Vec<bool> = results
        .par_chunks_mut((words * CHUNK).max(1))
        .enumerate()
        .map(|(chunk, results)| {
            let mut machine = Machine::new(program);
            let mut view = view.clone();
            for (offset, result) in results.chunks_mut(words.max(1)).enumerate() {
                let vertex = chunk * CHUNK + offset;
                machine.restart();
                for (number, feed) in feeds.iter().enumerate() {
                    match feed {
                        Feed::VertexIndex => machine.set_input(number, &[vertex as u32]),
                        Feed::InstanceIndex => machine.set_input(number, &[instance]),
                        Feed::Words(first) => {
                            let from = vertices.get(vertex * stride + first..).unwrap_or_default();
                            machine.set_input(number, from);
                        }
                    }
                }
                if machine.run(&mut view) != Exit::Ended {
                    return false;
                }
                result.copy_from_slice(machine.result());
            }
            true
        })
        .collect();
    if ended.into_iter().all(|ended| ended) { Ok(results) } else { Err("a vertex that goes round for ever".to_owned()) }
}

fn feeds(program: &Program) -> Result<Vec<Feed>, String> {
    let before = |location: u32| -> usize {
        let earlier = program.inputs.iter().filter(|input| input.location().is_some_and(|own| own < location));
        earlier.map(|input| input.words.len()).sum()
    };
    let feed = |input: &fragbuf_interpreter::Input| match input.location() {
        Some(location) => Ok(Feed::Words(before(location))),
        None if input.is(BuiltIn::VertexIndex) => Ok(Feed::VertexIndex),
        None if input.is(BuiltIn::InstanceIndex) => Ok(Feed::InstanceIndex),
        None => Err(format!("the input `{}` of a vertex", input.name)),
    };
    program.inputs.iter().map(feed).collect()
}
