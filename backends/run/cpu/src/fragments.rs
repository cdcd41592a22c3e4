//! Runs the fragments of a tile, with the tests and blending around their shaders.
//!
//! Tests and blending keep the submission order per pixel in any order of the shaders, as the graphics APIs require.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use fragbuf_interpreter::{Exit, Machine, OutOfBoundsAccess};
use fragbuf_templates::vocabulary::Coverage;

use crate::draw_call::DrawCall;
use crate::fragment_stage::{FragmentPosition, FragmentStage};
use crate::interface::{FragmentOutputs, Rate};
use crate::lane_group::LaneGroup;
use crate::schedule::{PixelFragment, interleave};
use crate::tile::{Bin, Bins, CoveredPixel, SIDE, cover};
use crate::triangle::{PIXEL_CENTRE, Triangle, sample_positions};
use crate::view::View;

/// The results of all tiles of a draw call.
#[derive(Default)]
pub(crate) struct TileResults {
    pub(crate) samples: AtomicU64,
    pub(crate) endless: FirstEndless,
    pub(crate) out_of_bounds: Mutex<Option<OutOfBoundsAccess>>,
}

/// The instruction at which the first invocation reached the limit of backward jumps: one more than its index; 0: none did.
#[derive(Default)]
pub(crate) struct FirstEndless(AtomicU64);

impl FirstEndless {
    /// Returns the instruction of the first invocation that does not terminate.
    pub(crate) fn at(&self) -> Option<u32> {
        self.0.load(Ordering::Relaxed).checked_sub(1).map(|at| at as u32)
    }

    /// Sets the instruction, unless another thread did.
    pub(crate) fn set(&self, at: u32) {
        let _ = self.0.compare_exchange(0, u64::from(at) + 1, Ordering::Relaxed, Ordering::Relaxed);
    }
}

/// The state that the tiles of a batch of triangles share.
pub(crate) struct FragmentBatch<'a> {
    pub(crate) draw: &'a DrawCall<'a>,
    pub(crate) stage: FragmentStage<'a>,
    pub(crate) rate: Rate,
    pub(crate) outputs: &'a FragmentOutputs,
    pub(crate) triangles: &'a [Triangle],
    pub(crate) bins: &'a Bins,
    pub(crate) results: &'a TileResults,
}

/// The machines of a thread.
pub(crate) struct Machines<'a> {
    machine: Machine<'a>,
    /// The fragments that run at once; `None`: the program does not run in lanes.
    group: Option<LaneGroup<'a>>,
}

impl<'a> Machines<'a> {
    /// Creates the machines; those of groups only if `lanes` is set.
    pub(crate) fn of(stage: &FragmentStage<'a>, lanes: bool) -> Self {
        Machines { machine: stage.machine(), group: LaneGroup::of(stage).filter(|_| lanes) }
    }
}

impl<'a> FragmentBatch<'a> {
    /// Runs the fragments of a tile, and its helper invocations outside of the frame.
    pub(crate) fn run(&self, bin: &Bin, machines: &mut Machines<'a>, view: &mut View<'_>) {
        let mut samples = 0;
        let Machines { machine, group } = machines;
        match (self.draw.order.interleaving(), group) {
            (Some(order), _) => self.interleaved(bin, view, order, &mut samples),
            (None, Some(group)) => self.in_groups(bin, group, view, &mut samples),
            (None, None) => self.for_each_fragment(bin, |triangle, position| {
                // A fragment that does not terminate takes seconds; the others would too.
                if self.results.endless.at().is_none() {
                    samples += u64::from(self.shade(machine, view, triangle, position));
                }
            }),
        }
        self.run_helpers(bin, machine, view);
        self.results.samples.fetch_add(samples, Ordering::Relaxed);
    }

    /// Calls `fragment` for every fragment of the tile, triangle after triangle.
    pub(crate) fn for_each_fragment(&self, bin: &Bin, mut fragment: impl FnMut(&'a Triangle, FragmentPosition)) {
        let attachments = &self.draw.attachments;
        let sampling = (attachments.samples, self.draw.coverage);
        for number in self.bins.triangles(bin) {
            let triangle = &self.triangles[*number as usize];
            cover(triangle, bin.rectangle, self.draw.size, sampling, |CoveredPixel { x, y, mask }| {
                let mask = mask & attachments.mask;
                match self.rate {
                    _ if mask == 0 => {}
                    Rate::Pixel => {
                        fragment(
                            triangle,
                            FragmentPosition { x, y, weights: triangle.weights(x, y, PIXEL_CENTRE), mask, sample: 0 },
                        );
                    }
                    Rate::Sample => {
                        for sample in (0..attachments.samples).filter(|sample| mask >> sample & 1 == 1) {
                            let weights = triangle.weights(x, y, self.sample_position(sample));
                            fragment(triangle, FragmentPosition { x, y, weights, mask: 1 << sample, sample });
                        }
                    }
                }
            });
        }
    }

    /// Runs the fragments of the tile in groups.
    fn in_groups(&self, bin: &Bin, group: &mut LaneGroup<'a>, view: &View<'_>, samples: &mut u64) {
        group.clear();
        self.for_each_fragment(bin, |triangle, mut position| {
            if self.draw.attachments.is_early {
                position.mask = self.passing_samples(triangle, &position, None);
                if position.mask == 0 {
                    return;
                }
            }
            if !group.has_lane_for(&position) {
                *samples += self.run_group(group, view);
            }
            group.push(&self.stage, (triangle, position));
        });
        *samples += self.run_group(group, view);
    }

    /// Runs a group and empties it. Returns the number of samples that passed.
    fn run_group(&self, group: &mut LaneGroup<'a>, view: &View<'_>) -> u64 {
        let mut samples = 0;
        // A fragment that does not terminate takes seconds; the others would too.
        if self.results.endless.at().is_none() {
            group.machine.restart(group.fragments.len());
            match group.machine.run(view) {
                Ok(()) => {
                    let mut result = std::mem::take(&mut group.result);
                    for lane in group.machine.ended() {
                        let (triangle, position) = group.fragments[lane];
                        group.machine.copy_result(lane, &mut result);
                        samples += u64::from(self.test_and_blend(triangle, position, &result));
                    }
                    group.result = result;
                }
                Err(at) => self.results.endless.set(at),
            }
            self.record_out_of_bounds(&mut group.machine.out_of_bounds);
        }
        group.clear();
        samples
    }

    /// Runs one fragment with its tests; returns the number of samples that passed.
    fn shade(
        &self,
        machine: &mut Machine<'a>,
        view: &mut View<'_>,
        triangle: &Triangle,
        mut position: FragmentPosition,
    ) -> u32 {
        if self.draw.attachments.is_early {
            position.mask = self.passing_samples(triangle, &position, None);
            if position.mask == 0 {
                return 0;
            }
        }
        self.stage.begin(machine, triangle, &position);
        let exit = machine.run(view);
        self.record_exit(machine, exit);
        if exit == Exit::Ended { self.test_and_blend(triangle, position, machine.result()) } else { 0 }
    }

    /// Performs late tests and blending after the shader; returns the number of samples that passed.
    fn test_and_blend(&self, triangle: &Triangle, mut position: FragmentPosition, result: &[u32]) -> u32 {
        let attachments = &self.draw.attachments;
        position.mask &= self.outputs.mask.map_or(u32::MAX, |at| result[at]);
        if !attachments.is_early {
            position.mask =
                self.passing_samples(triangle, &position, self.outputs.depth.map(|at| f32::from_bits(result[at])));
        }
        if position.mask == 0 {
            return 0;
        }
        let pixel = self.pixel(&position);
        for target in 0..attachments.targets.len() {
            let Some(Some(words)) = self.outputs.colors.get(target) else { continue };
            let mut color = [0, 0, 0, 1.0f32.to_bits()];
            color.iter_mut().zip(&result[words.clone()]).for_each(|(to, from)| *to = *from);
            for sample in (0..attachments.samples).filter(|sample| position.mask >> sample & 1 == 1) {
                attachments.blend(target, sample as usize * attachments.pixels + pixel, color);
            }
        }
        position.mask.count_ones()
    }

    /// Performs the tests; returns the mask of samples that passed.
    fn passing_samples(&self, triangle: &Triangle, position: &FragmentPosition, depth: Option<f32>) -> u32 {
        let attachments = &self.draw.attachments;
        if attachments.depth.is_none() && attachments.stencil.is_none() {
            return position.mask;
        }
        let pixel = self.pixel(position);
        let mut mask = 0;
        for sample in (0..attachments.samples).filter(|sample| position.mask >> sample & 1 == 1) {
            let interpolated = || triangle.weights(position.x, position.y, self.sample_position(sample)).depth;
            let passes =
                attachments.test(sample as usize * attachments.pixels + pixel, depth.unwrap_or_else(interpolated));
            mask |= u32::from(passes) << sample;
        }
        mask
    }

    fn pixel(&self, position: &FragmentPosition) -> usize {
        position.y as usize * self.draw.size.0 as usize + position.x as usize
    }

    /// Returns the position at which a sample is tested.
    fn sample_position(&self, sample: u32) -> (i64, i64) {
        let positions = match self.draw.coverage {
            Coverage::PerSample => sample_positions(self.draw.attachments.samples),
            Coverage::WholePixel => sample_positions(1),
        };
        positions[sample as usize % positions.len()]
    }

    /// Runs the fragments of each pixel with interleaved shaders: early tests precede all of them, late tests and blending
    /// follow.
    fn interleaved(&self, bin: &Bin, view: &View<'_>, (seed, window): (u64, Option<u32>), samples: &mut u64) {
        let [x0, _, y0, _] = bin.rectangle;
        let mut pixels: Vec<Vec<PixelFragment<'a>>> = Vec::new();
        pixels.resize_with((SIDE * SIDE) as usize, Vec::new);
        self.for_each_fragment(bin, |triangle, position| {
            pixels[((position.y - y0) * SIDE + position.x - x0) as usize].push((triangle, position));
        });
        for mut fragments in pixels {
            if self.draw.attachments.is_early {
                fragments.retain_mut(|(triangle, position)| {
                    position.mask = self.passing_samples(triangle, position, None);
                    position.mask != 0
                });
            }
            let Some((_, position)) = fragments.first() else { continue };
            if self.results.endless.at().is_some() {
                return;
            }
            let seed = seed ^ (u64::from(position.y) << 32 | u64::from(position.x)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let mut results: Vec<Option<Vec<u32>>> = vec![None; fragments.len()];
            interleave(&self.stage, &fragments, view, (seed, window), |number, machine, exit| {
                self.record_exit(machine, exit);
                results[number] = (exit == Exit::Ended).then(|| machine.result().to_vec());
            });
            for ((triangle, position), result) in fragments.into_iter().zip(results) {
                *samples += result.map_or(0, |result| u64::from(self.test_and_blend(triangle, position, &result)));
            }
        }
    }

    fn record_exit(&self, machine: &mut Machine<'_>, exit: Exit) {
        if exit == Exit::Endless {
            self.results.endless.set(machine.at());
        }
        self.record_out_of_bounds(&mut machine.out_of_bounds);
    }

    fn record_out_of_bounds(&self, access: &mut Option<OutOfBoundsAccess>) {
        if let Some(out_of_bounds) = access.take() {
            self.results.out_of_bounds.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(out_of_bounds);
        }
    }
}
