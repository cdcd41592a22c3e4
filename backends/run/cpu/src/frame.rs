//! One frame: the turns of its cursor, one after the other.
//!
//! In: a device and a mesh. Out: the picture and what the frame counted. What the plan says and this device does not run is an
//! error with its name.

mod call;
mod objects;
mod pass;

use std::sync::Mutex;
use std::sync::atomic::Ordering;

use fragbuf_codegen::PassId;
use fragbuf_frame::{COUNTERS_RESOURCE, Counters, Cursor, PassTime, Question, Span, Turn, resource};

use crate::device::{Device, Mesh, Picture, Stage};
use crate::memory::{Words, read, words, zeros};
use crate::{Code, Error};

/// Words of a pixel of the output: four floats.
const OUTPUT_WORDS: usize = 4;

pub(crate) fn render(
    device: &mut Device,
    mesh: &Mesh<'_>,
    progress: &(dyn Fn(Stage<'_>) + Sync),
) -> Result<Picture, Error> {
    let code = device.code.clone();
    let pixels = device.settings.width as usize * device.settings.height as usize;
    let output = zeros("the output", (4 * OUTPUT_WORDS * pixels) as u64)?;
    let (uniforms, camera) = (words(&device.uniforms), words(&device.camera));
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
        cursor: Cursor::new(&code.plan, device.counting, device.memory.flipped),
        objects: Vec::new(),
        device,
    };
    frame.run()?;
    Ok(frame.picture())
}

struct Frame<'a> {
    code: &'a Code,
    device: &'a mut Device,
    mesh: Mesh<'a>,
    progress: &'a (dyn Fn(Stage<'_>) + Sync),
    output: Words,
    uniforms: Words,
    camera: Words,
    wide: Mutex<()>,
    /// Milliseconds by pass.
    times: Vec<f64>,
    /// Samples that passed in the last run of each pass.
    samples: Vec<u64>,
    out_of_bounds: Vec<String>,
    cursor: Cursor,
    /// What the last query found out of each object: 0 where no sample of its box passed.
    objects: Vec<u32>,
}

impl Frame<'_> {
    /// Goes through the frame, turn by turn.
    fn run(&mut self) -> Result<(), Error> {
        let plan = &self.code.plan;
        while let Some(turn) = self.cursor.next(plan, &self.device.values)? {
            match turn {
                Turn::Clear { resource, value } => self.device.memory.clear(plan, resource, value),
                Turn::Copy { from, to } => self.device.memory.copy(plan, from, to),
                Turn::Pass(run) => self.pass(run)?,
                Turn::Ask(question) => {
                    let words = self.answer(question);
                    self.cursor.answer(plan, &words, &mut self.device.values)?;
                    self.device.memory.resize(plan, &self.device.values)?;
                }
            }
        }
        self.device.memory.arrange(plan, self.cursor.flipped(plan));
        Ok(())
    }

    fn answer(&mut self, question: Question) -> Vec<u32> {
        match question {
            Question::Words(spans) => spans.into_iter().flat_map(|span| self.words(span)).collect(),
            Question::Samples(PassId(pass)) => vec![u32::from(self.samples[pass] > 0)],
            Question::Objects(_) => std::mem::take(&mut self.objects),
        }
    }

    fn words(&mut self, Span { resource, first, count }: Span) -> Vec<u32> {
        let words = self.device.memory.physical(&self.code.plan, resource);
        words.iter().skip(first as usize).take(count as usize).map(|word| word.load(Ordering::Relaxed)).collect()
    }

    fn picture(self) -> Picture {
        let plan = &self.code.plan;
        let counters = resource(plan, COUNTERS_RESOURCE).ok().map(|id| &self.device.memory.resources[id.0]);
        let mut times: Vec<PassTime> = Vec::new();
        for (pass, milliseconds) in plan.passes.iter().zip(&self.times) {
            times.push(PassTime { milliseconds: *milliseconds, ..PassTime::none(pass.anchor.clone()) });
        }
        let channels: Vec<f32> = read(&self.output).into_iter().map(f32::from_bits).collect();
        let pixels = channels.chunks_exact(OUTPUT_WORDS).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        let counters = counters.map(|words| Counters::sum(&read(words)));
        let loops = self.cursor.loops().to_vec();
        let Frame { out_of_bounds, samples, .. } = self;
        Picture { pixels, times, counters, out_of_bounds, samples, loops }
    }
}
