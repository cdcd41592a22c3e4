//! Runs a draw call: vertices, triangles, tiles.
//!
//! Tiles run in parallel; instances and batches of triangles run one after the other.

use std::sync::PoisonError;

use fragbuf_interpreter::OutOfBoundsAccess;
use rayon::prelude::*;

use crate::clip::{ClipResult, clip};
use crate::draw_call::DrawCall;
use crate::fragment_stage::FragmentStage;
use crate::fragments::{FragmentBatch, Machines, TileResults};
use crate::interface::{ClipInterpolation, VertexOutputLayout, fragment_inputs, fragment_outputs};
use crate::tile::Bins;
use crate::triangle::{Triangle, Vertex, fan};
use crate::vertices;

/// The result of a draw call.
#[derive(Debug, Default)]
pub(crate) struct DrawResult {
    /// The number of samples that passed all tests.
    pub(crate) samples: u64,
    /// An access out of bounds, if there was one.
    pub(crate) out_of_bounds: Option<OutOfBoundsAccess>,
}

/// Why a draw call cannot run.
pub(crate) enum DrawError {
    /// An unsupported construct.
    Shader(String),
    /// A vertex shader reached the limit of backward jumps at this instruction.
    EndlessVertex(u32),
    /// A fragment shader reached the limit of backward jumps at this instruction.
    EndlessFragment(u32),
    /// The triangles, or the lists of the tiles, do not fit into the memory of a draw call with a shuffled order. The number of bytes that
    /// they need, as far as it is known.
    Shuffled(u64),
}

impl From<String> for DrawError {
    fn from(what: String) -> Self {
        DrawError::Shader(what)
    }
}

/// The number of triangles that are set up at a time. A shuffled pixel needs all triangles at once.
const BATCH: usize = 1 << 17;

/// The entries of the lists of triangles of all tiles at which a batch is divided.
const ENTRIES: usize = 1 << 22;

/// The bytes of the triangles of a batch and of the lists of all tiles.
pub(crate) const BATCH_BYTES: u64 = (BATCH * size_of::<Triangle>()) as u64 + ENTRIES as u64 * Bins::ENTRY;

/// Runs a draw call; calls `done` for every tile.
pub(crate) fn draw(draw: &DrawCall<'_>, done: &(dyn Fn(f64) + Sync)) -> Result<DrawResult, DrawError> {
    let layout = VertexOutputLayout::of(draw.vertex.0)?;
    let (inputs, rate) = fragment_inputs(draw.vertex.0, draw.fragment.0)?;
    let outputs = fragment_outputs(draw.fragment.0)?;
    let (numbers, count) = (draw.numbers(), draw.vertex_count());
    let batch = if is_shuffled(draw) { numbers.len().max(1) } else { BATCH };
    let results = TileResults::default();
    for instance in draw.arguments.instances.clone() {
        let mut words = vertices::run((draw.vertex.0, &draw.vertex.1), draw.vertices, (count, instance), draw.lanes)?;
        for numbers_of_batch in numbers.chunks(batch) {
            let share = numbers_of_batch.len() as f64 / numbers.len() as f64 / draw.arguments.instances.len() as f64;
            let triangles = triangles(draw, &layout, &mut words, count, numbers_of_batch)?;
            let entries = max_entries(draw, &triangles)?;
            let stage = FragmentStage { program: draw.fragment.0, inputs: &inputs, vertices: &words };
            let (mut rest, all) = (triangles.as_slice(), triangles.len() as f64);
            while !rest.is_empty() {
                let bins = Bins::of(rest, draw.size, &draw.rows, entries);
                if is_shuffled(draw) && bins.sorted < rest.len() {
                    return Err(DrawError::Shuffled((size_of_val(rest) + bins.bytes()) as u64));
                }
                let tiles = FragmentBatch {
                    draw,
                    stage,
                    rate,
                    outputs: &outputs,
                    triangles: rest,
                    bins: &bins,
                    results: &results,
                };
                let part = share * bins.sorted as f64 / all / bins.tiles.len().max(1) as f64;
                run(&tiles, &|| done(part));
                if let Some(at) = results.endless.at() {
                    return Err(DrawError::EndlessFragment(at));
                }
                rest = rest.get(bins.sorted..).unwrap_or_default();
            }
        }
    }
    let out_of_bounds = results.out_of_bounds.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(DrawResult { samples: results.samples.into_inner(), out_of_bounds })
}

/// Runs the tiles of a batch in parallel; calls `done` for every tile.
fn run(batch: &FragmentBatch<'_>, done: &(dyn Fn() + Sync)) {
    batch.bins.tiles.par_iter().for_each_init(
        || (Machines::of(&batch.stage, batch.draw.lanes), batch.draw.fragment.1.clone()),
        |(machines, view), bin| {
            batch.run(bin, machines, view);
            done();
        },
    );
}

fn is_shuffled(draw: &DrawCall<'_>) -> bool {
    draw.order.interleaving().is_some()
}

/// Checks the bytes of the triangles of a batch. Returns the number of entries of the lists of all tiles at which the batch is divided,
/// or that a shuffled order may not exceed.
fn max_entries(draw: &DrawCall<'_>, triangles: &[Triangle]) -> Result<usize, DrawError> {
    if !is_shuffled(draw) {
        return Ok(ENTRIES);
    }
    let bytes = size_of_val(triangles) as u64;
    let left = draw.memory.checked_sub(bytes).ok_or(DrawError::Shuffled(bytes))?;
    Ok(usize::try_from(left / Bins::ENTRY).unwrap_or(usize::MAX))
}

/// Sets up the triangles with these numbers. Appends the words of clipped corners to those of the vertices.
fn triangles(
    draw: &DrawCall<'_>,
    layout: &VertexOutputLayout,
    words: &mut Vec<u32>,
    count: usize,
    numbers: &[u32],
) -> Result<Vec<Triangle>, DrawError> {
    // Removes the clipped corners of the previous batch.
    words.truncate(count * layout.stride);
    let mut triangles = Vec::with_capacity(numbers.len());
    for number in numbers {
        let Some(corners) = draw.corners(*number, count) else { continue };
        let starts = corners.map(|corner| corner * layout.stride);
        let positions = starts.map(|start| layout.position_in(&words[start..]));
        let mut push = |vertices: [Vertex; 3]| {
            triangles.extend(Triangle::new(
                vertices,
                starts[0] as u32,
                number.wrapping_sub(draw.arguments.zero),
                draw.size,
            ));
        };
        match clip(positions, draw.size) {
            ClipResult::Empty => {}
            ClipResult::Inside => push([0, 1, 2].map(|corner| vertex(positions[corner], starts[corner]))),
            ClipResult::Polygon(polygon) => {
                let clipped: Vec<Vertex> = polygon
                    .iter()
                    .map(|corner| vertex(corner.position, mix(words, layout, starts, corner.weights)))
                    .collect();
                fan(&polygon).for_each(|corners| push(corners.map(|corner| clipped[corner])));
                // Clipping makes more triangles than there are numbers.
                max_entries(draw, &triangles)?;
            }
        }
    }
    Ok(triangles)
}

fn vertex(position: [f32; 4], start: usize) -> Vertex {
    Vertex { position, words: start as u32 }
}

/// Appends the words of a clipped corner; returns the index of the first.
fn mix(words: &mut Vec<u32>, layout: &VertexOutputLayout, starts: [usize; 3], weights: [f32; 3]) -> usize {
    let start = words.len();
    for (word, interpolation) in layout.interpolation.iter().enumerate() {
        let [a, b, c] = starts.map(|start| words[start + word]);
        words.push(match interpolation {
            ClipInterpolation::Flat => a,
            ClipInterpolation::Linear => {
                let [a, b, c] = [a, b, c].map(f32::from_bits);
                (a + weights[1] * (b - a) + weights[2] * (c - a)).to_bits()
            }
        });
    }
    start
}
