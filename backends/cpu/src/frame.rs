//! One frame: the plan's steps, one after the other.
//!
//! In: a device and a mesh. Out: the picture and what the frame counted. What the plan says and this device does not run is an
//! error with its name.

mod call;
mod objects;
mod pass;

use std::sync::Mutex;

use fragbuf_codegen::Plan;
use fragbuf_frame::{
    COUNTERS_RESOURCE, Counters, Counting, Decision, LoopEnd, Looped, PassTime, Symbols, resource, unsupported,
};
use fragbuf_templates::vocabulary::{Formula, Host, Repeat, Step, Until};

use crate::device::{Device, Mesh, Picture, Stage};
use crate::memory::{Words, read, words, zeros};
use crate::{Code, Error};
use objects::Visible;

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
        loops: Vec::new(),
        visible: Visible::default(),
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
    loops: Vec<Looped>,
    visible: Visible,
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
                Step::Copy { from, to } => {
                    let (from, to) = alike(plan, from, to)?;
                    self.device.memory.copy(from, to);
                }
                Step::Swap(a, b) => {
                    let (a, b) = alike(plan, a, b)?;
                    self.device.memory.resources.swap(a, b);
                }
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
        let rounds = number(&self.code.plan, &self.device.symbols, rounds, 0, "the rounds of a loop")?;
        let (mut done, mut end) = (0, LoopEnd::Cut);
        while done < rounds && end == LoopEnd::Cut {
            self.steps(&repeat.body, pass, done)?;
            done += 1;
            if self.is_over(&repeat.until)? {
                end = LoopEnd::Reached;
            }
        }
        let until = match &repeat.until {
            Until::Times(_) => None,
            Until::Zero(name) => Some(format!("`{name}` is zero")),
            Until::NoSamples(anchor) => Some(format!("no sample passes in `{anchor}`")),
        };
        if let Some(until) = until {
            self.note(Looped { until, rounds: done, end });
        }
        Ok(pass + passes(&repeat.body))
    }

    /// Whether what a loop waits for has come true.
    fn is_over(&mut self, until: &Until) -> Result<bool, Error> {
        let plan = &self.code.plan;
        Ok(match until {
            Until::Times(_) => false,
            Until::Zero(name) => {
                let words = &mut self.device.memory.resources[resource(plan, name)?];
                words.first_mut().is_none_or(|word| *word.get_mut() == 0)
            }
            Until::NoSamples(anchor) => {
                let pass = plan.passes().iter().position(|pass| pass.anchor == *anchor);
                let pass = pass.ok_or_else(|| unsupported(format!("the samples of `{anchor}`, which is no pass")))?;
                self.samples[pass] == 0
            }
        })
    }

    /// Adds a loop to what is reported: one inside of another is reported once, cut if it ever was.
    fn note(&mut self, now: Looped) {
        match self.loops.iter_mut().find(|known| known.until == now.until) {
            Some(known) => {
                known.rounds += now.rounds;
                known.end = if now.end == LoopEnd::Cut { LoopEnd::Cut } else { known.end };
            }
            None => self.loops.push(now),
        }
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
            let place = number(plan, &self.device.symbols, place, 0, "the index of a word that the host reads")?;
            let words = &mut self.device.memory.resources[*resource];
            read.push(words.get_mut(place as usize).map_or(0, |word| *word.get_mut()));
        }
        decision.apply(&read, &mut self.device.symbols);
        self.device.memory.resize(plan, &self.device.symbols)
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
        let Frame { out_of_bounds, samples, loops, .. } = self;
        Picture { pixels, times, counters, out_of_bounds, samples, loops }
    }
}

/// The value of a formula in a round of a loop.
fn number(plan: &Plan, symbols: &Symbols, formula: &Formula, round: u32, what: &str) -> Result<u32, Error> {
    let value = formula.evaluate(&|symbol| match symbol {
        "iteration" => Some(round.into()),
        _ => symbols.value(plan, symbol),
    });
    let value = value.map_err(|error| fragbuf_frame::Error::Formula { what: what.to_owned(), error })?;
    Ok(u32::try_from(value).map_err(|_| unsupported(format!("{what}: {value} are too many")))?)
}

/// Two resources of one shape.
fn alike(plan: &Plan, a: &str, b: &str) -> Result<(usize, usize), Error> {
    let pair = (resource(plan, a)?, resource(plan, b)?);
    let [first, second] = [pair.0, pair.1].map(|index| &plan.resources[index]);
    if first.resource.element != second.resource.element || first.words != second.words {
        return Err(unsupported(format!("`{a}` in the place of `{b}`, which has another shape")).into());
    }
    Ok(pair)
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
