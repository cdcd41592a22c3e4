//! Renders a frame, slice by slice: performs the steps of a cursor per slice. A step that this device does not support is an error.

mod conditions;
mod draw_arguments;
mod objects;
mod pass;

use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use fragbuf_codegen::PassId;
use fragbuf_frame::{
    COUNTERS_RESOURCE, Counters, Cursor, FrameStep, HostWait, LoopReport, PassTime, Values, WordRange,
    check_conditions, decide, loop_reports, resource,
};

use self::conditions::ConditionWords;
use crate::device::Device;
use crate::memory::{Slice, Words, read, words, zeros};
use crate::mesh::Mesh;
use crate::picture::{PassProgress, Picture};
use crate::{Code, Error};

/// The words of a pixel of the output: four floats.
const OUTPUT_WORDS: usize = 4;

impl Device {
    /// Renders a frame. `progress` is called from several threads. Fails if the caller has not set an external texture.
    pub fn render(&mut self, mesh: &Mesh<'_>, progress: &(dyn Fn(PassProgress<'_>) + Sync)) -> Result<Picture, Error> {
        let code = self.code.clone();
        if let Some(planned) = self.missing.first().and_then(|index| code.plan.resources.get(*index)) {
            let expected =
                "set with `Device::set_texture` before the frame begins, at the size of the frame".to_owned();
            let name = format!("the texture `{}`", planned.resource.name);
            return Err(fragbuf_frame::Error::BadValue { name, expected }.into());
        }
        check_conditions(&code.plan, self.settings.conditions)?;
        self.decide()?;
        let (width, height) = (self.settings.width, self.settings.height);
        let slice = Slice { rows: 0..self.values.rows().min(height), size: (width, height) };
        let output = zeros("the output", 4 * OUTPUT_WORDS as u64 * slice.pixels() as u64)?;
        let pixels = image(width, height)?;
        let (uniforms, camera) = (words(&self.uniforms), words(&self.camera));
        let mut frame = Frame {
            code: &code,
            mesh: *mesh,
            progress,
            slice,
            number: 0,
            output,
            pixels,
            uniforms,
            camera,
            wide: Mutex::new(()),
            times: code.passes.iter().map(|_| 0.0).collect(),
            samples: vec![0; code.passes.len()],
            all_samples: vec![0; code.passes.len()],
            counters: Vec::new(),
            loops: Vec::new(),
            out_of_bounds: Vec::new(),
            cursor: self.cursor(self.memory.flipped),
            objects: Vec::new(),
            conditions: ConditionWords::new(code.plan.frame.loops.len()),
            device: self,
        };
        frame.run()?;
        Ok(frame.picture())
    }

    /// Returns a cursor at the beginning of a slice.
    fn cursor(&self, flipped: u32) -> Cursor {
        Cursor::new(&self.code.plan, self.frame_readbacks(), flipped).with_conditions(self.settings.conditions)
    }
}

/// Returns an empty list with the capacity for an image.
fn image(width: u32, height: u32) -> Result<Vec<[f32; 4]>, Error> {
    let mut pixels = Vec::new();
    let count = width as usize * height as usize;
    let bytes = (size_of::<[f32; 4]>() as u64).saturating_mul(count as u64);
    let out_of_memory = |_| Error::OutOfMemory { what: "the image".to_owned(), bytes };
    pixels.try_reserve_exact(count).map_err(out_of_memory)?;
    Ok(pixels)
}

/// The state of a frame.
struct Frame<'a> {
    code: &'a Code,
    device: &'a mut Device,
    mesh: Mesh<'a>,
    progress: &'a (dyn Fn(PassProgress<'_>) + Sync),
    /// The current slice, and its number.
    slice: Slice,
    number: u32,
    /// The output of the slice.
    output: Words,
    /// The image of all finished slices.
    pixels: Vec<[f32; 4]>,
    uniforms: Words,
    camera: Words,
    wide: Mutex<()>,
    /// Milliseconds per pass.
    times: Vec<f64>,
    /// The samples that passed in the last run of each pass, in this slice.
    samples: Vec<u64>,
    /// The sums over all finished slices.
    all_samples: Vec<u64>,
    /// The counters of every finished slice.
    counters: Vec<Counters>,
    loops: Vec<LoopReport>,
    out_of_bounds: Vec<String>,
    cursor: Cursor,
    /// The result of the last query per object: 0 if no sample of its box passed.
    objects: Vec<u32>,
    conditions: ConditionWords,
}

impl Frame<'_> {
    /// Draws all slices. Each begins as the frame does.
    fn run(&mut self) -> Result<(), Error> {
        let (values, flipped) = (self.device.values.clone(), self.device.memory.flipped);
        for number in 0..values.slices() {
            self.begin_slice(number, &values, flipped)?;
            self.run_slice()?;
            self.end_slice();
        }
        Ok(())
    }

    fn begin_slice(&mut self, number: u32, values: &Values, flipped: u32) -> Result<(), Error> {
        if number == 0 {
            return Ok(());
        }
        let (rows, (_, height)) = (values.rows(), self.slice.size);
        let first = number * rows;
        self.slice.rows = first..height.min(first.saturating_add(rows));
        self.number = number;
        self.output.iter_mut().for_each(|word| *word = AtomicU32::default());
        self.samples.fill(0);
        self.cursor = self.device.cursor(flipped);
        self.conditions.dropped.clear();
        self.device.values = values.clone();
        self.device.memory.resize(&self.code.plan, values, &self.device.limits)
    }

    /// Performs the steps of a slice.
    fn run_slice(&mut self) -> Result<(), Error> {
        let plan = &self.code.plan;
        while let Some(step) = self.cursor.next(plan, &self.device.values)? {
            match step {
                FrameStep::Clear { resource, value } => {
                    self.device.memory.clear(plan, resource, value, &self.slice);
                }
                FrameStep::Copy { from, to } => self.device.memory.copy(plan, from, to, &self.slice),
                FrameStep::Pass(run) if self.conditions.draws(run.conditional) => self.pass(run)?,
                FrameStep::Pass(run) => self.samples[run.pass.0] = 0,
                FrameStep::Condition(condition) => self.update_conditions(condition),
                FrameStep::Wait(wait) => {
                    let words = self.read_back(wait);
                    self.cursor.supply(plan, &words, &mut self.device.values)?;
                    self.device.lag.record(&self.device.values);
                    self.device.memory.resize(plan, &self.device.values, &self.device.limits)?;
                }
                FrameStep::Read(read) => {
                    let words: Vec<u32> = read.ranges.iter().flat_map(|range| self.words(*range)).collect();
                    let mut decided = self.device.values.clone();
                    decide(plan, &read, &words, &mut decided)?;
                    self.device.lag.record(&decided);
                }
            }
        }
        self.device.memory.arrange(plan, self.cursor.flipped(plan));
        Ok(())
    }

    /// Keeps the results of a slice.
    fn end_slice(&mut self) {
        let plan = &self.code.plan;
        let words = self.output.chunks_exact(OUTPUT_WORDS).take(self.slice.pixels());
        let channel = |word: &AtomicU32| f32::from_bits(word.load(Ordering::Relaxed));
        self.pixels.extend(words.map(|pixel| std::array::from_fn(|index| pixel.get(index).map_or(0.0, channel))));
        self.all_samples.iter_mut().zip(&self.samples).for_each(|(sum, samples)| *sum += samples);
        if let Ok(id) = resource(plan, COUNTERS_RESOURCE) {
            self.counters.push(Counters::from_words(&read(&self.device.memory.resources[id.0])));
        }
        self.cursor.loops().iter().for_each(|report| report.clone().merge_into(&mut self.loops));
    }

    fn read_back(&mut self, wait: HostWait) -> Vec<u32> {
        match wait {
            HostWait::Words(spans) => spans.into_iter().flat_map(|span| self.words(span)).collect(),
            HostWait::Samples(PassId(pass)) => vec![u32::from(self.samples[pass] > 0)],
            HostWait::Objects(_) => std::mem::take(&mut self.objects),
        }
    }

    fn words(&mut self, WordRange { resource, first, count }: WordRange) -> Vec<u32> {
        let words = self.device.memory.physical(&self.code.plan, resource);
        words.iter().skip(first as usize).take(count as usize).map(|word| word.load(Ordering::Relaxed)).collect()
    }

    fn picture(self) -> Picture {
        let mut times: Vec<PassTime> = Vec::new();
        for (pass, milliseconds) in self.code.plan.passes.iter().zip(&self.times) {
            times.push(PassTime { milliseconds: *milliseconds, ..PassTime::zero(pass.name.clone()) });
        }
        let Frame { pixels, out_of_bounds, all_samples: samples, counters: slice_counters, mut loops, .. } = self;
        loops.extend(loop_reports(&self.code.plan, &self.conditions.loops));
        let counters = (!slice_counters.is_empty()).then(|| Counters::total(&slice_counters));
        Picture { pixels, times, counters, slice_counters, out_of_bounds, samples, loops }
    }
}
