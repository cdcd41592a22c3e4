//! The fragments of a tile: which there are, in which order they run, and the fixed function around them.
//!
//! In: a draw's triangles and one of its tiles. Out: changed memory and attachments. Whatever order the shaders run in, tests
//! and blending keep the order of submission, pixel by pixel, as the graphics APIs do.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Exit, Fault, Machine};
use fragbuf_templates::vocabulary::Coverage;

use crate::device::Order;
use crate::draw::Draw;
use crate::interface::{Outputs, Rate};
use crate::schedule::{Waiting, interleave};
use crate::stages::{FragmentStage, Place};
use crate::tile::{Bin, Bins, Covered, SIDE, cover};
use crate::triangle::{MIDDLE, Triangle, sample_places};
use crate::view::View;

/// What tiles find, all together.
#[derive(Default)]
pub(crate) struct Found {
    pub(crate) samples: AtomicU64,
    pub(crate) endless: AtomicU64,
    pub(crate) fault: Mutex<Option<Fault>>,
}

/// The tiles of a batch of triangles.
pub(crate) struct Tiles<'a> {
    pub(crate) draw: &'a Draw<'a>,
    pub(crate) stage: FragmentStage<'a>,
    pub(crate) rate: Rate,
    pub(crate) outputs: &'a Outputs,
    pub(crate) triangles: &'a [Triangle],
    pub(crate) bins: &'a Bins,
    pub(crate) found: &'a Found,
}

impl<'a> Tiles<'a> {
    /// Runs all fragments of a tile.
    pub(crate) fn run(&self, bin: &Bin, machine: &mut Machine<'a>, view: &mut View<'_>) {
        let mut samples = 0;
        match self.draw.order {
            Order::Shuffled(seed) => self.shuffled(bin, view, seed, &mut samples),
            Order::Submission => self.each(bin, |triangle, place| {
                // One that does not end is found after seconds: the others would be no better.
                if self.found.endless.load(Ordering::Relaxed) == 0 {
                    samples += u64::from(self.shade(machine, view, triangle, place));
                }
            }),
        }
        self.found.samples.fetch_add(samples, Ordering::Relaxed);
    }

    /// Every fragment of the tile, triangle after triangle.
    fn each(&self, bin: &Bin, mut fragment: impl FnMut(&'a Triangle, Place)) {
        let attachments = &self.draw.attachments;
        let sampling = (attachments.samples, self.draw.coverage);
        for number in self.bins.triangles(bin) {
            let triangle = &self.triangles[*number as usize];
            cover(triangle, bin.rectangle, self.draw.size, sampling, |Covered { x, y, mask }| {
                let mask = mask & attachments.mask;
                match self.rate {
                    _ if mask == 0 => {}
                    Rate::Pixel => {
                        fragment(triangle, Place { x, y, weights: triangle.weights(x, y, MIDDLE), mask, sample: 0 });
                    }
                    Rate::Sample => {
                        for sample in (0..attachments.samples).filter(|sample| mask >> sample & 1 == 1) {
                            let weights = triangle.weights(x, y, self.sample(sample));
                            fragment(triangle, Place { x, y, weights, mask: 1 << sample, sample });
                        }
                    }
                }
            });
        }
    }

    /// Runs one fragment with the tests around it; the samples that passed.
    fn shade(&self, machine: &mut Machine<'a>, view: &mut View<'_>, triangle: &Triangle, mut place: Place) -> u32 {
        if self.draw.attachments.is_early {
            place.mask = self.tested(triangle, &place, None);
            if place.mask == 0 {
                return 0;
            }
        }
        self.stage.begin(machine, triangle, &place);
        let exit = machine.run(view);
        self.notice(machine, exit);
        if exit == Exit::Ended { self.settle(triangle, place, machine.result()) } else { 0 }
    }

    /// What comes after the shader: late tests, then blending. The samples that passed.
    fn settle(&self, triangle: &Triangle, mut place: Place, result: &[u32]) -> u32 {
        let attachments = &self.draw.attachments;
        place.mask &= self.outputs.mask.map_or(u32::MAX, |at| result[at]);
        if !attachments.is_early {
            place.mask = self.tested(triangle, &place, self.outputs.depth.map(|at| f32::from_bits(result[at])));
        }
        if place.mask == 0 {
            return 0;
        }
        let pixel = self.pixel(&place);
        for target in 0..attachments.targets.len() {
            let Some(Some(words)) = self.outputs.colors.get(target) else { continue };
            let mut color = [0, 0, 0, 1.0f32.to_bits()];
            color.iter_mut().zip(&result[words.clone()]).for_each(|(to, from)| *to = *from);
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
            let passes = attachments.test(sample as usize * attachments.pixels + pixel, depth.unwrap_or_else(own));
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
            Coverage::PerSample => sample_places(self.draw.attachments.samples),
            Coverage::WholePixel => sample_places(1),
        };
        places[sample as usize % places.len()]
    }

    /// All fragments of each pixel, their shaders interleaved: early tests come before all of them, the rest after.
    fn shuffled(&self, bin: &Bin, view: &View<'_>, seed: u64, samples: &mut u64) {
        let [x0, _, y0, _] = bin.rectangle;
        let mut pixels: Vec<Vec<Waiting<'a>>> = Vec::new();
        pixels.resize_with((SIDE * SIDE) as usize, Vec::new);
        self.each(bin, |triangle, place| {
            pixels[((place.y - y0) * SIDE + place.x - x0) as usize].push((triangle, place));
        });
        for mut fragments in pixels {
            if self.draw.attachments.is_early {
                fragments.retain_mut(|(triangle, place)| {
                    place.mask = self.tested(triangle, place, None);
                    place.mask != 0
                });
            }
            let Some((_, place)) = fragments.first() else { continue };
            if self.found.endless.load(Ordering::Relaxed) > 0 {
                return;
            }
            let seed = seed ^ (u64::from(place.y) << 32 | u64::from(place.x)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let mut results: Vec<Option<Vec<u32>>> = vec![None; fragments.len()];
            interleave(&self.stage, &fragments, view, seed, |number, machine, exit| {
                self.notice(machine, exit);
                results[number] = (exit == Exit::Ended).then(|| machine.result().to_vec());
            });
            for ((triangle, place), result) in fragments.into_iter().zip(results) {
                *samples += result.map_or(0, |result| u64::from(self.settle(triangle, place, &result)));
            }
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
