//! A draw: vertices, triangles, tiles, fragments.
//!
//! In: the programs of a pass with their memory, words of vertices, attachments. Out: changed memory and attachments, and the
//! samples that passed. Tiles run in parallel; in each, fragments run in the order of submission, or shuffled.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Exit, Fault, Machine, Program};
use rayon::prelude::*;

use crate::attachment::Attachments;
use crate::clip::{Clipped, clip};
use crate::device::Order;
use crate::interface::{Outputs, Rate, Varyings, Weighed, feeds, outputs};
use crate::schedule::{Waiting, interleave};
use crate::stages::{FragmentStage, Place};
use crate::tile::{Bin, Bins, Covered, SIDE, cover};
use crate::triangle::{Coverage, MIDDLE, Triangle, Vertex, fan, sample_places};
use crate::vertices;
use crate::view::View;

/// Everything that a draw needs.
pub(crate) struct Draw<'a> {
    pub(crate) vertex: (&'a Program, View<'a>),
    pub(crate) fragment: (&'a Program, View<'a>),
    /// Words of interleaved vertices.
    pub(crate) vertices: &'a [u32],
    pub(crate) indices: Indices<'a>,
    pub(crate) size: (u32, u32),
    pub(crate) attachments: Attachments<'a>,
    pub(crate) coverage: Coverage,
    pub(crate) order: Order,
}

/// Which vertices make triangles, three each.
#[derive(Clone, Copy)]
pub(crate) enum Indices<'a> {
    These(&'a [u32]),
    /// So many, one after the other.
    Count(u32),
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
    let count = match draw.indices {
        Indices::Count(count) => count as usize,
        Indices::These(_) => draw.vertices.len() / vertices::stride(draw.vertex.0).max(1),
    };
    let mut words = vertices::run(draw.vertex.0, &draw.vertex.1, draw.vertices, count)?;
    let (feeds, rate) = feeds(draw.vertex.0, draw.fragment.0)?;
    let outputs = outputs(draw.fragment.0)?;
    let primitives = match draw.indices {
        Indices::Count(count) => count as usize / 3,
        Indices::These(indices) => indices.len() / 3,
    };
    let batch = if draw.order == Order::Submission { BATCH } else { primitives.max(1) };
    let found = Found::default();
    for first in (0..primitives).step_by(batch) {
        let range = first..(first + batch).min(primitives);
        let share = range.len() as f64 / primitives as f64;
        let triangles = triangles(draw, &varyings, &mut words, count, range);
        let bins = Bins::of(&triangles, draw.size);
        let stage = FragmentStage { program: draw.fragment.0, feeds: &feeds, vertices: &words };
        let tiles = Tiles { draw, stage, rate, outputs: &outputs, triangles: &triangles, bins: &bins, found: &found };
        let part = share / bins.tiles.len().max(1) as f64;
        bins.tiles.par_iter().for_each_init(
            || (stage.machine(), draw.fragment.1.clone()),
            |(machine, view), bin| {
                tiles.run(bin, machine, view);
                done(part);
            },
        );
        if found.endless.load(Ordering::Relaxed) > 0 {
            return Err("a fragment goes round for ever".to_owned());
        }
    }
    let fault = found.fault.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(Drawn { samples: found.samples.into_inner(), fault })
}

/// What tiles find, all together.
#[derive(Default)]
struct Found {
    samples: AtomicU64,
    endless: AtomicU64,
    fault: Mutex<Option<Fault>>,
}

/// The triangles of `range`, clipped; corners that clipping makes are added to the words of the vertices.
fn triangles(
    draw: &Draw<'_>,
    varyings: &Varyings,
    words: &mut Vec<u32>,
    count: usize,
    range: std::ops::Range<usize>,
) -> Vec<Triangle> {
    // Corners of an earlier batch are not needed any more.
    words.truncate(count * varyings.stride);
    let mut triangles = Vec::with_capacity(range.len());
    for primitive in range {
        let corners = [0, 1, 2].map(|corner| match draw.indices {
            Indices::Count(_) => 3 * primitive + corner,
            Indices::These(indices) => indices[3 * primitive + corner] as usize,
        });
        if corners.iter().any(|corner| *corner >= count) {
            continue;
        }
        let starts = corners.map(|corner| corner * varyings.stride);
        let positions = starts.map(|start| {
            let at = start + varyings.position;
            std::array::from_fn(|axis| f32::from_bits(words[at + axis]))
        });
        let mut push = |vertices: [Vertex; 3]| {
            triangles.extend(Triangle::new(vertices, starts[0] as u32, primitive as u32, draw.size));
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

/// The tiles of a batch.
struct Tiles<'a> {
    draw: &'a Draw<'a>,
    stage: FragmentStage<'a>,
    rate: Rate,
    outputs: &'a Outputs,
    triangles: &'a [Triangle],
    bins: &'a Bins,
    found: &'a Found,
}

impl<'a> Tiles<'a> {
    fn run(&self, bin: &Bin, machine: &mut Machine<'a>, view: &mut View<'_>) {
        let mut samples = 0;
        match self.draw.order {
            // Tests and blending keep the order of submission on every device.
            Order::Shuffled(seed) if self.draw.attachments.is_empty() => self.shuffled(bin, view, seed),
            _ => self.each(bin, |triangle, covered| self.fragment(machine, view, triangle, &covered, &mut samples)),
        }
        self.found.samples.fetch_add(samples, Ordering::Relaxed);
    }

    /// Every covered pixel of the tile, triangle after triangle.
    fn each(&self, bin: &Bin, mut fragment: impl FnMut(&'a Triangle, Covered)) {
        let attachments = &self.draw.attachments;
        let sampling = (attachments.samples, self.draw.coverage);
        for number in self.bins.triangles(bin) {
            let triangle = &self.triangles[*number as usize];
            cover(triangle, bin.rectangle, self.draw.size, sampling, |mut covered| {
                covered.mask &= attachments.mask;
                if covered.mask != 0 {
                    fragment(triangle, covered);
                }
            });
        }
    }

    fn fragment(
        &self,
        machine: &mut Machine<'a>,
        view: &mut View<'_>,
        triangle: &Triangle,
        covered: &Covered,
        samples: &mut u64,
    ) {
        let Covered { x, y, mask } = *covered;
        match self.rate {
            Rate::Pixel => {
                let place = Place { x, y, weights: triangle.weights(x, y, MIDDLE), mask, sample: 0 };
                *samples += u64::from(self.shade(machine, view, triangle, place));
            }
            Rate::Sample => {
                for sample in (0..self.draw.attachments.samples).filter(|sample| mask >> sample & 1 == 1) {
                    let weights = triangle.weights(x, y, self.sample(sample));
                    let place = Place { x, y, weights, mask: 1 << sample, sample };
                    *samples += u64::from(self.shade(machine, view, triangle, place));
                }
            }
        }
    }

    /// Runs one fragment with the tests around it; the samples that passed.
    fn shade(&self, machine: &mut Machine<'a>, view: &mut View<'_>, triangle: &Triangle, mut place: Place) -> u32 {
        let attachments = &self.draw.attachments;
        // One that does not end is found after seconds: the others would be no better.
        if self.found.endless.load(Ordering::Relaxed) > 0 {
            return 0;
        }
        if attachments.is_early {
            place.mask = self.tested(triangle, &place, None);
            if place.mask == 0 {
                return 0;
            }
        }
        self.stage.begin(machine, triangle, &place);
        let exit = machine.run(view);
        self.notice(machine, exit);
        if exit != Exit::Ended {
            return 0;
        }
        let word = |at: usize| machine.words(at..at + 1)[0];
        place.mask &= self.outputs.mask.map_or(u32::MAX, word);
        if !attachments.is_early {
            place.mask = self.tested(triangle, &place, self.outputs.depth.map(|at| f32::from_bits(word(at))));
        }
        if place.mask == 0 {
            return 0;
        }
        let pixel = self.pixel(&place);
        for target in 0..attachments.targets.len() {
            let Some(Some(words)) = self.outputs.colors.get(target) else { continue };
            let mut color = [0, 0, 0, 1.0f32.to_bits()];
            color.iter_mut().zip(machine.words(words.clone())).for_each(|(to, from)| *to = *from);
            for sample in (0..attachments.samples).filter(|sample| place.mask >> sample & 1 == 1) {
                attachments.blend(target, sample as usize * attachments.pixels + pixel, color);
            }
        }
        place.mask.count_ones()
    }

    /// The samples of a fragment that pass the tests.
    fn tested(&self, triangle: &Triangle, place: &Place, depth: Option<f32>) -> u32 {
        let attachments = &self.draw.attachments;
        if attachments.depth.is_none() && attachments.stencil.is_none() {
            return place.mask;
        }
        let pixel = self.pixel(place);
        let mut mask = 0;
        for sample in (0..attachments.samples).filter(|sample| place.mask >> sample & 1 == 1) {
            let own = || triangle.weights(place.x, place.y, self.sample(sample)).depth;
            let depth = depth.unwrap_or_else(own);
            let passes = attachments.test(sample as usize * attachments.pixels + pixel, depth);
            mask |= u32::from(passes) << sample;
        }
        mask
    }

    fn pixel(&self, place: &Place) -> usize {
        place.y as usize * self.draw.size.0 as usize + place.x as usize
    }

    /// Where a sample is tested.
    fn sample(&self, sample: u32) -> (i64, i64) {
        let places = match self.draw.coverage {
            Coverage::Samples => sample_places(self.draw.attachments.samples),
            Coverage::Middle => sample_places(1),
        };
        places[sample as usize % places.len()]
    }

    /// All fragments of each pixel, interleaved.
    fn shuffled(&self, bin: &Bin, view: &View<'_>, seed: u64) {
        let [x0, _, y0, _] = bin.rectangle;
        let mut pixels: Vec<Vec<Waiting<'a>>> = Vec::new();
        pixels.resize_with((SIDE * SIDE) as usize, Vec::new);
        self.each(bin, |triangle, Covered { x, y, mask }| {
            let pixel = (y - y0) * SIDE + x - x0;
            pixels[pixel as usize]
                .push((triangle, Place { x, y, weights: triangle.weights(x, y, MIDDLE), mask, sample: 0 }));
        });
        for mut fragments in pixels.into_iter().filter(|fragments| !fragments.is_empty()) {
            if self.found.endless.load(Ordering::Relaxed) > 0 {
                return;
            }
            let place = fragments[0].1;
            let seed = seed ^ (u64::from(place.y) << 32 | u64::from(place.x)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            interleave(&self.stage, &mut fragments, view, seed, |machine, exit| self.notice(machine, exit));
        }
    }

    fn notice(&self, machine: &mut Machine<'_>, exit: Exit) {
        if exit == Exit::Endless {
            self.found.endless.fetch_add(1, Ordering::Relaxed);
        }
        if let Some(fault) = machine.fault.take() {
            self.found.fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(fault);
        }
    }
}
