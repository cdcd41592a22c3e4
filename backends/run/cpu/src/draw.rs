//! A draw: vertices, triangles, tiles.
//!
//! In: the programs of a pass with their memory, words of vertices, attachments. Out: changed memory and attachments, and the
//! samples that passed. Tiles run in parallel, batches of triangles and instances one after the other.

use std::ops::Range;
use std::sync::PoisonError;
use std::sync::atomic::Ordering;

use fragbuf_interpreter::{Fault, Program};
use fragbuf_templates::vocabulary::Coverage;
use rayon::prelude::*;

use crate::attachment::Attachments;
use crate::clip::{Clipped, clip};
use crate::device::Order;
use crate::fragments::{Found, Tiles};
use crate::interface::{Varyings, Weighed, feeds, outputs};
use crate::stages::FragmentStage;
use crate::tile::Bins;
use crate::triangle::{Triangle, Vertex, fan};
use crate::vertices;
use crate::view::View;

/// Everything that a draw needs.
pub(crate) struct Draw<'a> {
    pub(crate) vertex: (&'a Program, View<'a>),
    pub(crate) fragment: (&'a Program, View<'a>),
    /// Words of interleaved vertices.
    pub(crate) vertices: &'a [u32],
    /// Vertices, three per triangle; `None`: one after the other.
    pub(crate) indices: Option<&'a [u32]>,
    pub(crate) call: Call,
    pub(crate) size: (u32, u32),
    pub(crate) attachments: Attachments<'a>,
    pub(crate) coverage: Coverage,
    pub(crate) order: Order,
}

/// Which triangles are drawn, and how often.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Call {
    /// Parts of the indices, in triangles. What is left out changes no other triangle's number.
    pub(crate) triangles: Vec<Range<u32>>,
    /// The triangle that has the number 0.
    pub(crate) zero: u32,
    /// Added to every index.
    pub(crate) base: i32,
    pub(crate) instances: Range<u32>,
}

impl Call {
    /// So many triangles, once.
    pub(crate) fn once(triangles: u32) -> Self {
        Call { triangles: std::iter::once(0..triangles).collect(), zero: 0, base: 0, instances: 0..1 }
    }
}

/// What came of a draw.
#[derive(Debug, Default)]
pub(crate) struct Drawn {
    /// Samples that passed all tests.
    pub(crate) samples: u64,
    /// An index out of bounds.
    pub(crate) fault: Option<Fault>,
}

/// Triangles that are set up and binned at a time. A shuffled pixel needs all of them at once.
const BATCH: usize = 1 << 17;

/// Draws; `done` hears of every tile. `Err`: what the device does not run, or why it does not end.
pub(crate) fn draw(draw: &Draw<'_>, done: &(dyn Fn(f64) + Sync)) -> Result<Drawn, String> {
    let varyings = Varyings::of(draw.vertex.0)?;
    let (feeds, rate) = feeds(draw.vertex.0, draw.fragment.0)?;
    let outputs = outputs(draw.fragment.0)?;
    let (numbers, count) = (draw.numbers(), draw.vertex_count());
    let batch = if draw.order == Order::Submission { BATCH } else { numbers.len().max(1) };
    let found = Found::default();
    for instance in draw.call.instances.clone() {
        let mut words = vertices::run((draw.vertex.0, &draw.vertex.1), draw.vertices, count, instance)?;
        for numbers_of_batch in numbers.chunks(batch) {
            let share = numbers_of_batch.len() as f64 / numbers.len() as f64 / draw.call.instances.len() as f64;
            let triangles = triangles(draw, &varyings, &mut words, count, numbers_of_batch);
            let bins = Bins::of(&triangles, draw.size);
            let stage = FragmentStage { program: draw.fragment.0, feeds: &feeds, vertices: &words };
            let tiles =
                Tiles { draw, stage, rate, outputs: &outputs, triangles: &triangles, bins: &bins, found: &found };
            let part = share / bins.tiles.len().max(1) as f64;
            bins.tiles.par_iter().for_each_init(
                || (stage.machine(), draw.fragment.1.clone()),
                |(machine, view), bin| {
                    tiles.run(bin, machine, view);
                    done(part);
                },
            );
            if found.endless.load(Ordering::Relaxed) > 0 {
                return Err("a fragment that goes round for ever".to_owned());
            }
        }
    }
    let fault = found.fault.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(Drawn { samples: found.samples.into_inner(), fault })
}

impl Draw<'_> {
    /// The numbers of all triangles, those that the indices do not have left out.
    fn numbers(&self) -> Vec<u32> {
        let end = self.indices.map_or(u32::MAX, |indices| (indices.len() / 3) as u32);
        self.call.triangles.iter().flat_map(|range| range.start.min(end)..range.end.min(end)).collect()
    }

    fn vertex_count(&self) -> usize {
        match self.indices {
            Some(_) => self.vertices.len() / vertices::stride(self.vertex.0).max(1),
            None => {
                let last = self.call.triangles.iter().map(|range| 3 * i64::from(range.end)).max().unwrap_or(0);
                (last + i64::from(self.call.base)).max(0) as usize
            }
        }
    }

    /// The vertices of a triangle. `None`: it has one that is not there.
    fn corners(&self, number: u32, count: usize) -> Option<[usize; 3]> {
        let mut corners = [0; 3];
        for (vertex, corner) in (3 * number as usize..).zip(&mut corners) {
            let index = self.indices.map_or(vertex as i64, |indices| i64::from(indices[vertex]));
            *corner = usize::try_from(index + i64::from(self.call.base)).ok().filter(|vertex| *vertex < count)?;
        }
        Some(corners)
    }
}

/// The triangles of these numbers, clipped; corners that clipping makes are added to the words of the vertices.
fn triangles(
    draw: &Draw<'_>,
    varyings: &Varyings,
    words: &mut Vec<u32>,
    count: usize,
    numbers: &[u32],
) -> Vec<Triangle> {
    // Corners of an earlier batch are not needed any more.
    words.truncate(count * varyings.stride);
    let mut triangles = Vec::with_capacity(numbers.len());
    for number in numbers {
        let Some(corners) = draw.corners(*number, count) else { continue };
        let starts = corners.map(|corner| corner * varyings.stride);
        let positions = starts.map(|start| varyings.position_in(&words[start..]));
        let mut push = |vertices: [Vertex; 3]| {
            triangles.extend(Triangle::new(vertices, starts[0] as u32, number.wrapping_sub(draw.call.zero), draw.size));
        };
        match clip(positions, draw.size) {
            Clipped::Nothing => {}
            Clipped::Whole => push([0, 1, 2].map(|corner| vertex(positions[corner], starts[corner]))),
            Clipped::Part(polygon) => {
                let made: Vec<Vertex> = polygon
                    .iter()
                    .map(|corner| vertex(corner.position, mix(words, varyings, starts, corner.shares)))
                    .collect();
                fan(&polygon).for_each(|corners| push(corners.map(|corner| made[corner])));
            }
        }
    }
    triangles
}

fn vertex(position: [f32; 4], start: usize) -> Vertex {
    Vertex { position, words: start as u32 }
}

/// Adds the words of a corner that clipping has made; where they begin.
fn mix(words: &mut Vec<u32>, varyings: &Varyings, starts: [usize; 3], shares: [f32; 3]) -> usize {
    let start = words.len();
    for (word, weighed) in varyings.weighed.iter().enumerate() {
        let [a, b, c] = starts.map(|start| words[start + word]);
        words.push(match weighed {
            Weighed::Flat => a,
            Weighed::Float => {
                let [a, b, c] = [a, b, c].map(f32::from_bits);
                (a + shares[1] * (b - a) + shares[2] * (c - a)).to_bits()
            }
        });
    }
    start
}
