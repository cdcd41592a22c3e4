//! Renders a frame: performs the steps of its cursor. A step that this device does not support is an error.

mod draw_arguments;
mod objects;
mod pass;

use std::sync::Mutex;
use std::sync::atomic::Ordering;

use fragbuf_codegen::PassId;
use fragbuf_frame::{COUNTERS_RESOURCE, Counters, Cursor, FrameStep, HostWait, PassTime, WordRange, resource};

use crate::device::Device;
use crate::memory::{Words, read, words, zeros};
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
        let pixels = self.settings.width as usize * self.settings.height as usize;
        let output = zeros("the output", (4 * OUTPUT_WORDS * pixels) as u64)?;
        let (uniforms, camera) = (words(&self.uniforms), words(&self.camera));
        let mut frame = Frame {
            code: &code,
            mesh: *mesh,
            progress,
            output,
            uniforms,
            camera,
            wide: Mutex::new(()),
            times: code.passes.iter().map(|_| 0.0).collect(),
            samples: vec![0; code.passes.len()],
            out_of_bounds: Vec::new(),
            cursor: Cursor::new(&code.plan, self.readbacks, self.memory.flipped),
            objects: Vec::new(),
            device: self,
        };
        frame.run()?;
        Ok(frame.picture())
    }
}

/// The state of a frame.
struct Frame<'a> {
    code: &'a Code,
    device: &'a mut Device,
    mesh: Mesh<'a>,
    progress: &'a (dyn Fn(PassProgress<'_>) + Sync),
    output: Words,
    uniforms: Words,
    camera: Words,
    wide: Mutex<()>,
    /// Milliseconds per pass.
    times: Vec<f64>,
    /// The samples that passed in the last run of each pass.
    samples: Vec<u64>,
    out_of_bounds: Vec<String>,
    cursor: Cursor,
    /// The result of the last query per object: 0 if no sample of its box passed.
    objects: Vec<u32>,
}

impl Frame<'_> {
    /// Performs the steps of the frame.
    fn run(&mut self) -> Result<(), Error> {
        let plan = &self.code.plan;
        while let Some(step) = self.cursor.next(plan, &self.device.values)? {
            match step {
                FrameStep::Clear { resource, value } => self.device.memory.clear(plan, resource, value),
                FrameStep::Copy { from, to } => self.device.memory.copy(plan, from, to),
                FrameStep::Pass(run) => self.pass(run)?,
                FrameStep::Wait(wait) => {
                    let words = self.read_back(wait);
                    self.cursor.supply(plan, &words, &mut self.device.values)?;
                    self.device.memory.resize(plan, &self.device.values)?;
                }
            }
        }
        self.device.memory.arrange(plan, self.cursor.flipped(plan));
        Ok(())
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
        let plan = &self.code.plan;
        let counters = resource(plan, COUNTERS_RESOURCE).ok().map(|id| &self.device.memory.resources[id.0]);
        let mut times: Vec<PassTime> = Vec::new();
        for (pass, milliseconds) in plan.passes.iter().zip(&self.times) {
            times.push(PassTime { milliseconds: *milliseconds, ..PassTime::zero(pass.name.clone()) });
        }
        let channels: Vec<f32> = read(&self.output).into_iter().map(f32::from_bits).collect();
        let pixels = channels.chunks_exact(OUTPUT_WORDS).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        let counters = counters.map(|words| Counters::sum(&read(words)));
        let loops = self.cursor.loops().to_vec();
        let Frame { out_of_bounds, samples, .. } = self;
        Picture { pixels, times, counters, out_of_bounds, samples, loops }
    }
}
