//! One frame: the plan's steps, one after the other.
//!
//! In: a device and a mesh. Out: the picture and what the frame counted. What the plan says and this device does not run is an
//! error with its name.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use fragbuf_codegen::Plan;
use fragbuf_frame::{COUNTERS_RESOURCE, Counters, Counting, Decision, PassTime, resource, unsupported};
use fragbuf_interpreter::{Fault, Program, Space};
use fragbuf_templates::vocabulary::{Access, Formula, Host, Kind, Objects, Pass, Repeat, Step, Until};

use crate::attachment::Attachments;
use crate::code::PassCode;
use crate::compute::compute;
use crate::device::{Device, Mesh, Picture, Stage};
use crate::draw::{Draw, Indices, draw};
use crate::memory::{Words, read, words, zeros};
use crate::view::View;
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
        device,
    };
    frame.steps(&code.plan.steps, 0, 0)?;
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
}

impl Frame<'_> {
    /// Carries out steps, the first pass of which has the number `pass`; the number of the first pass after them.
    fn steps(&mut self, steps: &[Step], mut pass: usize, round: u32) -> Result<usize, Error> {
        let plan = &self.code.plan;
        for step in steps {
            match step {
                Step::Pass(run) => {
                    self.pass(run, pass, round)?;
                    pass += 1;
                }
                Step::Clear { resource: name, value } => self.device.memory.clear(resource(plan, name)?, *value),
                Step::Copy { from, to } => self.device.memory.copy(resource(plan, from)?, resource(plan, to)?),
                Step::Swap(a, b) => self.device.memory.resources.swap(resource(plan, a)?, resource(plan, b)?),
                Step::Host(host) => self.decide(host)?,
                Step::Repeat(repeat) => pass = self.repeat(repeat, pass)?,
            }
        }
        Ok(pass)
    }

    fn repeat(&mut self, repeat: &Repeat, pass: usize) -> Result<usize, Error> {
        let rounds = match &repeat.until {
            Until::Times(times) => times,
            _ => &repeat.at_most,
        };
        let rounds = self.number(rounds, 0, "the rounds of a loop")?;
        let mut next = pass + passes(&repeat.body);
        for round in 0..rounds {
            next = self.steps(&repeat.body, pass, round)?;
            let is_over = match &repeat.until {
                Until::Times(_) => false,
                Until::Zero(name) => {
                    let words = &mut self.device.memory.resources[resource(&self.code.plan, name)?];
                    words.first_mut().is_none_or(|word| *word.get_mut() == 0)
                }
                Until::NoSamples(anchor) => {
                    let plan = self.code.plan.passes();
                    plan.iter().position(|pass| pass.anchor == *anchor).is_none_or(|pass| self.samples[pass] == 0)
                }
            };
            if is_over {
                break;
            }
        }
        Ok(next)
    }

    /// The host reads, decides, and makes room; where room has been reserved it has nothing to say.
    fn decide(&mut self, host: &Host) -> Result<(), Error> {
        let plan = &self.code.plan;
        let decision = Decision::of(host, plan)?;
        if self.device.counting == Counting::Reserved {
            return Ok(());
        }
        let mut read = Vec::new();
        for (resource, place) in &decision.reads {
            let place = self.number(place, 0, "the index of a word that the host reads")?;
            let words = &mut self.device.memory.resources[*resource];
            read.push(words.get_mut(place as usize).map_or(0, |word| *word.get_mut()));
        }
        decision.apply(&read, &mut self.device.symbols);
        self.device.memory.resize(plan, &self.device.symbols)
    }

    fn pass(&mut self, pass: &Pass, number: usize, round: u32) -> Result<(), Error> {
        check(pass)?;
        let start = Instant::now();
        let code = self.code;
        let frame = words(&self.device.symbols.frame_words(&code.plan, 0, round)?);
        let fault = match &code.passes[number] {
            PassCode::Compute(program) => {
                let Kind::Compute { groups } = &pass.kind else { return Err(stageless(pass)) };
                let mut counts = [0; 3];
                for (count, formula) in counts.iter_mut().zip(groups) {
                    *count = self.number(formula, round, "the workgroups of a pass")?;
                }
                let view = self.view(program, &frame);
                compute(program, &view, counts).map_err(|how| Error::Stuck { pass: pass.anchor.clone(), how })?
            }
            PassCode::Draw { vertex, fragment } => self.draw(pass, number, round, (vertex, fragment), &frame)?,
        };
        if fault.is_some() && !self.out_of_bounds.contains(&pass.anchor) {
            self.out_of_bounds.push(pass.anchor.clone());
        }
        self.times[number] += start.elapsed().as_secs_f64() * 1000.0;
        Ok(())
    }

    fn draw(
        &mut self,
        pass: &Pass,
        number: usize,
        round: u32,
        (vertex, fragment): (&Program, &Program),
        frame: &Words,
    ) -> Result<Option<Fault>, Error> {
        let plan = &self.code.plan;
        let settings = self.device.settings;
        let size = (settings.width, settings.height);
        let mut numbers = [1, u32::MAX, 0];
        if let Some(samples) = &pass.state.samples {
            numbers[0] = self.number(&samples.count, round, "the samples of a pass")?;
            numbers[1] = self.number(&samples.mask, round, "the sample mask of a pass")?;
        }
        if let Some(stencil) = &pass.state.stencil {
            numbers[2] = self.number(&stencil.reference, round, "the stencil's reference of a pass")?;
        }
        let textures = |name: &str| {
            let index = resource(plan, name).ok()?;
            Some((self.device.memory.resources[index].as_slice(), plan.resources[index].resource.element))
        };
        let pixels = size.0 as usize * size.1 as usize;
        let (vertices, indices) = match pass.kind {
            Kind::Geometry => (self.mesh.vertices, Indices::These(self.mesh.indices)),
            _ => (&[][..], Indices::Count(3)),
        };
        let call = Draw {
            vertex: (vertex, self.view(vertex, frame)),
            fragment: (fragment, self.view(fragment, frame)),
            vertices,
            indices,
            size,
            attachments: Attachments::of(pass, numbers, &textures, (&self.output, pixels))?,
            coverage: settings.coverage,
            order: settings.order,
        };
        // Millionths, so that threads can add them up.
        let done = AtomicU64::new(0);
        let report = |part: f64| {
            let before = done.fetch_add((1.0e6 * part) as u64, Ordering::Relaxed);
            (self.progress)(Stage { pass: &pass.anchor, share: 1.0e-6 * before as f64 + part });
        };
        let drawn = draw(&call, &report).map_err(|what| Error::Shader { pass: pass.anchor.clone(), what })?;
        self.samples[number] = drawn.samples;
        Ok(drawn.fault)
    }

    /// The buffers of a program, by the plan's bindings.
    fn view<'v>(&'v self, program: &Program, frame: &'v Words) -> View<'v> {
        let bound = |binding: u32| match binding {
            0 => frame.as_slice(),
            1 => &self.uniforms,
            2 => &self.camera,
            _ => {
                let index = self.code.plan.resources.iter().position(|planned| planned.binding == binding);
                index.and_then(|index| self.device.memory.resources.get(index)).map_or(&[][..], Vec::as_slice)
            }
        };
        let buffers = program.buffers.iter().map(|buffer| match (buffer.space, buffer.binding) {
            (Space::Workgroup, _) | (_, None) => &[][..],
            (_, Some((_, binding))) => bound(binding),
        });
        View { buffers: buffers.collect(), wide: &self.wide }
    }

    fn number(&self, formula: &Formula, round: u32, what: &str) -> Result<u32, Error> {
        let plan: &Plan = &self.code.plan;
        let value = formula.evaluate(&|symbol| match symbol {
            "iteration" => Some(round.into()),
            _ => self.device.symbols.value(plan, symbol),
        });
        let value = value.map_err(|error| fragbuf_frame::Error::Formula { what: what.to_owned(), error })?;
        Ok(u32::try_from(value).map_err(|_| unsupported(format!("{what}: {value} are too many")))?)
    }

    fn picture(self) -> Picture {
        let plan = &self.code.plan;
        let counters = resource(plan, COUNTERS_RESOURCE).ok().map(|index| &self.device.memory.resources[index]);
        let mut times: Vec<PassTime> = Vec::new();
        for (pass, milliseconds) in plan.passes().into_iter().zip(&self.times) {
            times.push(PassTime { pass: pass.anchor.clone(), milliseconds: *milliseconds });
        }
        let channels: Vec<f32> = read(&self.output).into_iter().map(f32::from_bits).collect();
        let pixels = channels.chunks_exact(OUTPUT_WORDS).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        let counters = counters.map(|words| Counters::sum(&read(words)));
        Picture { pixels, times, counters, out_of_bounds: self.out_of_bounds }
    }
}

/// Passes among steps, those inside loops included.
fn passes(steps: &[Step]) -> usize {
    let passes = steps.iter().map(|step| match step {
        Step::Pass(_) => 1,
        Step::Repeat(repeat) => passes(&repeat.body),
        _ => 0,
    });
    passes.sum()
}

/// Refuses what this device does not run.
fn check(pass: &Pass) -> Result<(), Error> {
    let refuse = |what: String| Err(unsupported(format!("pass `{}`: {what}", pass.anchor)).into());
    if pass.objects != Objects::All {
        return refuse("drawing only visible objects".to_owned());
    }
    let not_run = |access: Access| matches!(access, Access::Sampled | Access::Indirect);
    match pass.uses.iter().find(|usage| not_run(usage.access)) {
        Some(usage) => refuse(format!("`{}` as {:?}", usage.resource, usage.access)),
        None => Ok(()),
    }
}

fn stageless(pass: &Pass) -> Error {
    unsupported(format!("pass `{}`: its entry points are not of its kind", pass.anchor)).into()
}
