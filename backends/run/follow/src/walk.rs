//! Walks through the steps of a frame: loops, exchanges, queries of objects and host steps. A [`Device`] does what is
//! left.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::check::queried;
use crate::manifest::{Action, Exchange, Objects, Pass, Plan, Read, Step, Until};
use crate::{Error, Scene, Values, functions};

/// The most iterations of a loop. A manifest from anywhere must not run for ever.
const MOST_ITERATIONS: u64 = 1 << 20;

/// The most iterations of loops inside each other together.
const MOST_NESTED_ITERATIONS: u64 = 1 << 24;

/// What a graphics API does. Names of resources are those whose memory is meant: exchanges have been applied.
pub trait Device {
    /// Sets every word of a buffer to `value`, or every texel of a texture to `texel`.
    fn clear(&mut self, resource: &str, value: u32, texel: Option<&serde_json::Value>) -> Result<(), Error>;
    /// Copies a resource to one of the same shape.
    fn copy(&mut self, from: &str, to: &str) -> Result<(), Error>;
    /// Runs a pass.
    fn pass(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error>;
    /// Waits for the device and returns words of a buffer.
    fn words(&mut self, resource: &str, first: u64, count: u64) -> Result<Vec<u32>, Error>;
    /// Waits for the device and returns the samples that passed in the latest run of a pass: a number per box, or one
    /// in total.
    fn samples(&mut self, pass: &str) -> Result<Vec<u64>, Error>;
    /// Waits for the device and creates the memory whose size a host step has decided.
    fn allocate(&mut self, values: &Values) -> Result<(), Error>;
}

/// What the frame adds to a pass.
pub struct Call<'a> {
    /// The index of its step.
    pub step: usize,
    /// The values of symbols.
    pub values: &'a Values,
    /// The iteration of the innermost loop.
    pub iteration: u64,
    /// Whether [`Device::samples`] will be called for the pass.
    pub is_queried: bool,
    /// The indices of the objects to draw, or whose boxes to draw.
    pub objects: Vec<usize>,
    names: BTreeMap<&'a str, &'a str>,
}

impl Call<'_> {
    /// Returns the resource whose memory a name of the pass means.
    pub fn resource<'n>(&'n self, name: &'n str) -> &'n str {
        self.names.get(name).copied().unwrap_or(name)
    }

    /// Returns the value of a formula.
    pub fn value(&self, formula: &str) -> Result<u64, Error> {
        self.values.value(formula, self.iteration)
    }
}

/// What the walk keeps from frame to frame.
pub struct Walk {
    plan: Arc<Plan>,
    /// Whether the resources of each pair of `exchanges` have swapped their memory.
    swapped: Vec<bool>,
    /// The passes whose samples are counted.
    queried: BTreeSet<String>,
}

impl Walk {
    /// Begins before the first frame.
    pub fn new(plan: Arc<Plan>) -> Self {
        let queried = plan.steps.iter().filter_map(|step| queried(&step.action)).map(str::to_owned).collect();
        Walk { swapped: vec![false; plan.exchanges.len()], queried, plan }
    }

    /// Runs the steps once: a frame of a size, or one slice of it. Returns how pairs are swapped at its end; give
    /// that to [`Self::end_frame`] after the last slice, because every slice begins alike.
    pub fn run(
        &self,
        values: &mut Values,
        (scene, size): (&Scene<'_>, [u32; 2]),
        device: &mut dyn Device,
    ) -> Result<Vec<bool>, Error> {
        let decidable = scene.objects.iter().map(|object| object.is_decidable(&scene.view_projection, size));
        let mut frame = Frame {
            walk: self,
            values,
            device,
            decidable: decidable.collect(),
            loops: Vec::new(),
            finished: BTreeMap::new(),
            drawn: BTreeMap::new(),
            dropped: BTreeMap::new(),
        };
        let mut at = 0;
        while let Some(step) = self.plan.steps.get(at) {
            at = frame.step(step, at)?.unwrap_or(at + 1);
        }
        let ends = self.plan.exchanges.iter().zip(&self.swapped);
        Ok(ends.map(|(pair, swapped)| frame.is_odd(pair) != *swapped).collect())
    }

    /// Ends a frame.
    pub fn end_frame(&mut self, swapped: Vec<bool>) {
        self.swapped = swapped;
    }
}

/// A frame, or a slice of one, that is under way.
struct Frame<'a> {
    walk: &'a Walk,
    values: &'a mut Values,
    device: &'a mut dyn Device,
    /// Whether a query of its box decides about each object.
    decidable: Vec<bool>,
    /// The loops around the step: the iteration and the greatest number of iterations.
    loops: Vec<[u64; 2]>,
    /// The finished iterations of each loop, by the index of its first step.
    finished: BTreeMap<usize, u64>,
    /// The objects whose boxes each pass has drawn, if their samples have not been read.
    drawn: BTreeMap<&'a str, Vec<usize>>,
    /// The objects for which a query of a pass counted no sample.
    dropped: BTreeMap<&'a str, BTreeSet<usize>>,
}

impl<'a> Frame<'a> {
    /// Runs a step. Returns the index of the next one if it is not the following.
    fn step(&mut self, step: &'a Step, at: usize) -> Result<Option<usize>, Error> {
        let names = self.names(&step.exchanged);
        let memory = |name: &'a str| names.get(name).copied().unwrap_or(name);
        match &step.action {
            Action::Clear { resource, value, texel } => {
                self.device.clear(memory(resource), *value, texel.as_ref())?;
            }
            Action::Copy { from, to } => self.device.copy(memory(from), memory(to))?,
            Action::Pass(pass) => self.pass(pass, at, names)?,
            Action::Loop { max_iterations, end } => {
                let most = self.value(max_iterations)?;
                if most == 0 {
                    return Ok(Some(end + 1));
                }
                self.check_iterations(at, most)?;
                self.loops.push([0, most]);
            }
            Action::LoopEnd { begin, until } => {
                let is_met = match until {
                    None => false,
                    Some(Until::WordIsZero(word)) => self.device.words(memory(word), 0, 1)?.first() == Some(&0),
                    Some(Until::NoSamples(pass)) => self.device.samples(pass)?.iter().all(|samples| *samples == 0),
                };
                return Ok(self.end_of_iteration(*begin, is_met));
            }
            Action::Host { function, reads, sets } => self.host_step(function, reads, sets, &names)?,
        }
        Ok(None)
    }

    /// Checks the iterations of a loop that begins at a step.
    fn check_iterations(&self, step: usize, most: u64) -> Result<(), Error> {
        let nested = self.loops.iter().fold(most, |product, [_, most]| product.saturating_mul(*most));
        for (iterations, allowed) in [(most, MOST_ITERATIONS), (nested, MOST_NESTED_ITERATIONS)] {
            if iterations > allowed {
                return Err(Error(format!(
                    "the loop at step {step} has up to {iterations} iterations, more than {allowed}: set lesser symbols, \
                     or generate the manifest with lesser options"
                )));
            }
        }
        Ok(())
    }

    fn iteration(&self) -> u64 {
        self.loops.last().map_or(0, |[iteration, _]| *iteration)
    }

    fn value(&self, formula: &str) -> Result<u64, Error> {
        self.values.value(formula, self.iteration())
    }

    fn is_odd(&self, pair: &Exchange) -> bool {
        let finished: u64 = pair.loops.iter().filter_map(|begin| self.finished.get(begin)).sum();
        (finished + u64::from(pair.odd)) % 2 == 1
    }

    /// Returns the resources of pairs that are swapped, each with the one whose memory its name means in a step.
    fn names(&self, exchanged: &[Exchange]) -> BTreeMap<&'a str, &'a str> {
        let mut names = BTreeMap::new();
        for (pair, swapped) in self.walk.plan.exchanges.iter().zip(&self.walk.swapped) {
            let now = exchanged.iter().find(|now| now.resources == pair.resources);
            if now.is_some_and(|now| self.is_odd(now)) != *swapped {
                let [one, other] = &pair.resources;
                names.extend([(one.as_str(), other.as_str()), (other.as_str(), one.as_str())]);
            }
        }
        names
    }

    fn end_of_iteration(&mut self, begin: usize, is_met: bool) -> Option<usize> {
        *self.finished.entry(begin).or_default() += 1;
        match self.loops.last_mut() {
            Some([iteration, most]) if !is_met && *iteration + 1 < *most => {
                *iteration += 1;
                Some(begin + 1)
            }
            _ => {
                self.loops.pop();
                None
            }
        }
    }

    fn pass(&mut self, pass: &'a Pass, step: usize, names: BTreeMap<&'a str, &'a str>) -> Result<(), Error> {
        let query = match &pass.objects {
            Objects::All => None,
            Objects::Boxes => Some(pass.name.as_str()),
            Objects::VisibleIn(query) => Some(query.as_str()),
        };
        // What the last query of the boxes counted decides what is drawn now.
        if let Some((query, drawn)) = query.and_then(|query| self.drawn.remove_entry(query)) {
            let hidden = drawn.into_iter().zip(self.device.samples(query)?).filter(|(_, samples)| *samples == 0);
            self.dropped.entry(query).or_default().extend(hidden.map(|(object, _)| object));
        }
        let dropped = query.and_then(|query| self.dropped.get(query));
        let is_boxes = matches!(pass.objects, Objects::Boxes);
        let objects = (0..self.decidable.len()).filter(|object| {
            let is_dropped = dropped.is_some_and(|dropped| dropped.contains(object));
            !is_dropped && (!is_boxes || self.decidable[*object])
        });
        let objects: Vec<usize> = objects.collect();
        if is_boxes {
            self.drawn.insert(&pass.name, objects.clone());
        }
        let iteration = self.iteration();
        let is_queried = self.walk.queried.contains(&pass.name);
        self.device.pass(pass, &Call { step, values: self.values, iteration, is_queried, objects, names })
    }

    fn host_step(
        &mut self,
        function: &str,
        reads: &'a [Read],
        sets: &[String],
        names: &BTreeMap<&'a str, &'a str>,
    ) -> Result<(), Error> {
        let mut words = Vec::new();
        for Read { resource, first, count } in reads {
            let (first, count) = (self.value(first)?, self.value(count)?);
            let resource = names.get(resource.as_str()).copied().unwrap_or(resource);
            words.extend(self.device.words(resource, first, count)?);
        }
        let results = functions::call(function, &words, self.values)?;
        if results.len() != sets.len() {
            return Err(Error(format!(
                "the host function `{function}` has {} results, not {}",
                results.len(),
                sets.len()
            )));
        }
        for (symbol, value) in sets.iter().zip(results) {
            self.values.decide(symbol, value)?;
        }
        self.device.allocate(self.values)
    }
}
