//! Runs the steps of a frame in their order: clears, copies, passes, loops, exchanges and readbacks.

use std::collections::{BTreeMap, BTreeSet};

use glow::HasContext as _;

use crate::host::{Host, Object, Scene};
use crate::manifest::{Action, Exchange, Kind, Objects, Pass, Read, Step, Until};
use crate::memory::Memory;
use crate::{Error, state};

/// The corners of a box as triangles: bit 0 selects x, bit 1 y and bit 2 z of the greatest corner.
const BOX: [usize; 36] =
    [0, 1, 2, 2, 1, 3, 4, 6, 5, 5, 6, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 6, 3, 7, 0, 2, 4, 4, 2, 6, 1, 5, 3, 3, 5, 7];

/// A frame that is under way.
pub struct Frame<'h, 'c, 's> {
    host: &'h mut Host<'c>,
    scene: &'s Scene<'s>,
    /// The loops around the step: the index of their first step, and their iteration.
    loops: Vec<(usize, u64)>,
    /// The finished iterations of each loop in this frame.
    finished: BTreeMap<usize, u64>,
    /// The passes whose samples are counted.
    queried: BTreeSet<String>,
    /// The samples that passed in the latest run of each of them: one number per object.
    samples: BTreeMap<String, Vec<u32>>,
}

impl<'h, 'c, 's> Frame<'h, 'c, 's> {
    /// Runs a whole frame.
    pub fn run(host: &'h mut Host<'c>, scene: &'s Scene<'s>) -> Result<(), Error> {
        let steps = host.plan.steps.clone();
        for step in &steps {
            if let Action::Host { sets, .. } = &step.action {
                sets.iter().for_each(|symbol| host.forget(symbol));
            }
        }
        host.allocate()?;
        let ends = host.plan.exchanges.clone();
        let queried = steps.iter().filter_map(|step| queried(&step.action)).cloned().collect();
        let mut frame =
            Frame { host, scene, loops: Vec::new(), finished: BTreeMap::new(), queried, samples: BTreeMap::new() };
        let mut at = 0;
        while let Some(step) = steps.get(at) {
            let pairs = frame.exchanged_now(&step.exchanged);
            frame.exchange(&pairs);
            let next = frame.step(step, at);
            // The names stand for their own memory again.
            frame.exchange(&pairs);
            at = next?.unwrap_or(at + 1);
        }
        let pairs = frame.exchanged_now(&ends);
        frame.exchange(&pairs);
        Ok(())
    }

    fn iteration(&self) -> u64 {
        self.loops.last().map_or(0, |(_, iteration)| *iteration)
    }

    fn value(&self, formula: &str) -> Result<u64, Error> {
        self.host.value(formula, self.iteration())
    }

    /// Returns the pairs that are exchanged now: those of an odd number of finished iterations.
    fn exchanged_now(&self, pairs: &[Exchange]) -> Vec<[String; 2]> {
        let finished = |pair: &Exchange| pair.loops.iter().filter_map(|begin| self.finished.get(begin)).sum::<u64>();
        let is_odd = |pair: &&Exchange| (finished(pair) + u64::from(pair.odd)) % 2 == 1;
        pairs.iter().filter(is_odd).map(|pair| pair.resources.clone()).collect()
    }

    fn exchange(&mut self, pairs: &[[String; 2]]) {
        pairs.iter().for_each(|pair| self.host.exchange(pair));
    }

    /// Runs a step. Returns the index of the next one if it is not the following.
    fn step(&mut self, step: &Step, at: usize) -> Result<Option<usize>, Error> {
        match &step.action {
            Action::Clear { resource, value, texel } => {
                let texel = texel.clone().unwrap_or_default();
                self.host.memory(resource)?.clear(self.host.context, *value, &texel);
            }
            Action::Copy { from, to } => {
                let (from, to) = (self.host.memory(from)?, self.host.memory(to)?);
                to.copy_from(&self.host.context.gl, from, self.host.size);
            }
            Action::Pass(pass) => {
                let begin = self.host.pass_times.is_some().then(|| self.finished_at());
                self.pass(pass)?;
                if let Some(begin) = begin {
                    let time = self.finished_at() - begin;
                    self.host.pass_times.iter_mut().for_each(|times| times.push((pass.name.clone(), time)));
                }
            }
            Action::Loop { max_iterations, end } => {
                self.loops.push((at, 0));
                if self.value(max_iterations)? == 0 {
                    self.loops.pop();
                    return Ok(Some(end + 1));
                }
            }
            Action::LoopEnd { begin, until } => return self.end_of_iteration(*begin, until.as_ref()),
            Action::Host { function, reads, sets } => self.host_step(function, reads, sets)?,
        }
        Ok(None)
    }

    /// Waits for the driver; returns the time.
    fn finished_at(&self) -> std::time::Instant {
        // SAFETY: the context is current.
        unsafe { self.host.context.gl.finish() };
        std::time::Instant::now()
    }

    fn end_of_iteration(&mut self, begin: usize, until: Option<&Until>) -> Result<Option<usize>, Error> {
        *self.finished.entry(begin).or_default() += 1;
        let Some(Step { action: Action::Loop { max_iterations, .. }, .. }) = self.host.plan.steps.get(begin) else {
            return Err(Error(format!("step {begin} begins no loop")));
        };
        let most = self.value(max_iterations)?;
        let is_met = match until {
            None => false,
            Some(Until::WordIsZero(word)) => self.words(word, 0, 1)?.first() == Some(&0),
            Some(Until::NoSamples(pass)) => self.samples.get(pass).is_some_and(|counts| counts.iter().all(|n| *n == 0)),
        };
        match self.loops.last_mut() {
            Some((_, iteration)) if !is_met && *iteration + 1 < most => *iteration += 1,
            _ => {
                self.loops.pop();
                return Ok(None);
            }
        }
        Ok(Some(begin + 1))
    }

    fn words(&self, resource: &str, first: u64, count: u64) -> Result<Vec<u32>, Error> {
        Ok(self.host.memory(resource)?.words(&self.host.context.gl, first, count))
    }

    fn host_step(&mut self, function: &str, reads: &[Read], sets: &[String]) -> Result<(), Error> {
        let mut words = Vec::new();
        for read in reads {
            words.extend(self.words(&read.resource, self.value(&read.first)?, self.value(&read.count)?)?);
        }
        let values: Vec<u64> = match function {
            "allocate" => words.into_iter().map(u64::from).collect(),
            "predict_k" => vec![self.predict_k(&words)?],
            _ => return Err(Error(format!("no host function `{function}`"))),
        };
        for (symbol, value) in sets.iter().zip(values) {
            self.host.set_symbol(symbol, value);
        }
        self.host.allocate()
    }

    /// Returns the least k that keeps the wanted part of the fragments, or the greatest whose buffers fit into the budget. The words are 1024
    /// bins, the pixels with 1, 2, … fragments, and the fragments beyond the 1024th of their pixels.
    fn predict_k(&self, words: &[u32]) -> Result<u64, Error> {
        let bins = words.get(..1024).unwrap_or(words);
        let beyond = words.get(1024).map_or(0, |beyond| u64::from(*beyond));
        let hits = |k: u64| (1..).zip(bins).map(|(count, pixels)| k.min(count) * u64::from(*pixels)).sum::<u64>();
        let fragments = hits(u64::MAX) + beyond;
        let (budget, percent) = (self.value("BUDGET_MIB")? << 20, self.value("HIT_PERCENT")?);
        let most = self.value("keep")?.min(self.value("capacity")?).min(1024);
        let fits = |k: u64| {
            let bytes = self.host.bytes(&[("k", k), ("kept", hits(k)), ("fragments", fragments)])?;
            Ok::<bool, Error>(bytes <= budget)
        };
        let mut k = 0;
        while k < most && (k == 0 || hits(k) * 100 < fragments * percent) && fits(k + 1)? {
            k += 1;
        }
        match k {
            0 => Err(Error("one fragment per pixel does not fit into the budget of `allocation`".to_owned())),
            k => Ok(k),
        }
    }

    fn pass(&mut self, pass: &Pass) -> Result<(), Error> {
        let host = &*self.host;
        let gl = &host.context.gl;
        host.bind_blocks(self.scene, self.iteration());
        for (name, access) in &pass.uses {
            if access != "attachment" {
                host.memory(name)?.bind(gl, host.resource(name)?.opengl_binding);
            }
        }
        let program =
            host.programs.get(&pass.name).ok_or_else(|| Error(format!("no files of pass `{}`", pass.name)))?;
        // SAFETY: the context is current.
        unsafe { gl.use_program(Some(*program)) };
        if pass.kind == Kind::Compute {
            let groups: Vec<u32> =
                pass.groups.iter().map(|groups| Ok(self.value(groups)? as u32)).collect::<Result<_, Error>>()?;
            let count = |index: usize| groups.get(index).copied().unwrap_or(1);
            // SAFETY: the context is current.
            unsafe { gl.dispatch_compute(count(0), count(1), count(2)) };
        } else {
            state::set(host.context, &pass.state, &|formula| self.value(formula))?;
            let framebuffer = self.attach(pass)?;
            let samples = self.draw(pass);
            // SAFETY: the context is current.
            unsafe { gl.delete_framebuffer(framebuffer) };
            self.samples.insert(pass.name.clone(), samples?);
        }
        // SAFETY: the context is current.
        unsafe { self.host.context.gl.memory_barrier(glow::ALL_BARRIER_BITS) };
        Ok(())
    }

    /// Creates and binds the framebuffer of a pass.
    fn attach(&self, pass: &Pass) -> Result<glow::Framebuffer, Error> {
        let gl = &self.host.context.gl;
        let memory = |name: &str| if name == "output" { Ok(self.host.output) } else { self.host.memory(name) };
        let targets: Vec<&str> = pass.state.targets.iter().map(|target| target.resource.as_str()).collect();
        let used = pass.uses.iter().filter(|(_, access)| *access == "attachment").map(|(name, _)| name.as_str());
        let depth = pass.state.depth.iter().map(|depth| depth.resource.as_str());
        let stencil = pass.state.stencil.iter().map(|stencil| stencil.resource.as_str());
        let others: BTreeSet<&str> = used.chain(depth).chain(stencil).filter(|name| !targets.contains(name)).collect();
        let others: Vec<Memory> = others.into_iter().map(memory).collect::<Result<_, Error>>()?;
        let targets: Vec<Memory> = targets.into_iter().map(memory).collect::<Result<_, Error>>()?;
        // SAFETY: the context is current.
        unsafe {
            let framebuffer = gl.create_framebuffer().map_err(Error)?;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            let colors = (0..).zip(&targets).filter_map(|(index, memory)| memory.attach(gl, index));
            gl.draw_buffers(&colors.collect::<Vec<u32>>());
            for memory in &others {
                memory.attach(gl, targets.len() as u32);
            }
            if targets.is_empty() && others.is_empty() {
                let [width, height] = self.host.size;
                let samples = pass.state.samples.as_ref().map_or(Ok(0), |samples| self.value(&samples.count))?;
                let parameter = self.host.context.framebuffer_parameter;
                parameter(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_WIDTH, width);
                parameter(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_HEIGHT, height);
                parameter(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_SAMPLES, samples as i32);
            }
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            if status != glow::FRAMEBUFFER_COMPLETE {
                return Err(Error(format!("the framebuffer of pass `{}` is incomplete: {status:#x}", pass.name)));
            }
            let [width, height] = self.host.size;
            gl.viewport(0, 0, width, height);
            Ok(framebuffer)
        }
    }

    /// Draws a pass and returns the samples that passed, per object.
    fn draw(&self, pass: &Pass) -> Result<Vec<u32>, Error> {
        let gl = &self.host.context.gl;
        let is_queried = self.queried.contains(&pass.name);
        let draw = |first: u32, count: u32| {
            // SAFETY: the context is current, and the vertices are those of the bound layout.
            unsafe {
                if !is_queried {
                    gl.draw_arrays(glow::TRIANGLES, first as i32, count as i32);
                    return Ok(0);
                }
                let query = gl.create_query().map_err(Error)?;
                gl.begin_query(glow::SAMPLES_PASSED, query);
                gl.draw_arrays(glow::TRIANGLES, first as i32, count as i32);
                gl.end_query(glow::SAMPLES_PASSED);
                let samples = gl.get_query_parameter_u32(query, glow::QUERY_RESULT);
                gl.delete_query(query);
                Ok(samples)
            }
        };
        if pass.kind == Kind::Fullscreen {
            self.host.bind_vertices(None);
            return Ok(vec![draw(0, 3)?]);
        }
        let objects = self.scene.objects.iter().enumerate();
        self.host.bind_vertices(Some(matches!(pass.objects, Objects::Boxes)));
        let samples = objects.map(|(index, object)| match &pass.objects {
            Objects::All => draw(object.first, object.count),
            // The near plane may clip every sample of such a box away although the object is visible.
            Objects::Boxes if crosses_near_plane(object, &self.scene.view_projection) => Ok(1),
            Objects::Boxes => draw((BOX.len() * index) as u32, BOX.len() as u32),
            Objects::VisibleIn(query) => match self.samples.get(query).and_then(|counts| counts.get(index)) {
                Some(0) => Ok(0),
                _ => draw(object.first, object.count),
            },
        });
        samples.collect()
    }
}

/// Returns the pass whose samples an action reads.
fn queried(action: &Action) -> Option<&String> {
    match action {
        Action::LoopEnd { until: Some(Until::NoSamples(pass)), .. } => Some(pass),
        Action::Pass(pass) => match &pass.objects {
            Objects::VisibleIn(query) => Some(query),
            _ => None,
        },
        _ => None,
    }
}

impl Host<'_> {
    /// Uploads the vertices of a scene, and its objects' boxes in the same layout.
    pub(crate) fn upload(&self, scene: &Scene<'_>) -> Result<(), Error> {
        let stride = self.stride();
        let mut boxes = Vec::new();
        for corner in scene.objects.iter().flat_map(|object| BOX.map(|corner| box_corner(object, corner))) {
            let mut vertex: Vec<u8> = corner.iter().flat_map(|value| value.to_le_bytes()).collect();
            vertex.resize(stride, 0);
            boxes.extend(vertex);
        }
        for (buffer, bytes) in self.vertices.iter().zip([scene.vertices, &boxes]) {
            // SAFETY: the context is current.
            unsafe { self.context.gl.named_buffer_data_u8_slice(*buffer, bytes, glow::STATIC_DRAW) };
        }
        Ok(())
    }

    fn stride(&self) -> usize {
        self.plan.vertex_inputs.iter().map(|input| 4 * input.components()).sum()
    }

    /// Binds no vertices, those of the scene, or those of its boxes.
    fn bind_vertices(&self, boxes: Option<bool>) {
        let gl = &self.context.gl;
        let mut offset = 0;
        for input in &self.plan.vertex_inputs {
            let (components, kind) = (input.components() as i32, input.component_type());
            // SAFETY: the context is current.
            unsafe {
                let Some(boxes) = boxes else {
                    gl.disable_vertex_attrib_array(input.location);
                    continue;
                };
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.vertices[usize::from(boxes)]));
                gl.enable_vertex_attrib_array(input.location);
                if kind == glow::FLOAT {
                    let stride = self.stride() as i32;
                    gl.vertex_attrib_pointer_f32(input.location, components, kind, false, stride, offset);
                } else {
                    gl.vertex_attrib_pointer_i32(input.location, components, kind, self.stride() as i32, offset);
                }
            }
            offset += 4 * components;
        }
    }
}

/// Returns a corner of an object's box. The box is larger by 1/64 of its greatest extent at each side, so that no object is
/// dropped because a rasteriser rounds positions.
fn box_corner(object: &Object, corner: usize) -> [f32; 3] {
    let [least, greatest] = object.bounds;
    let margin = (0..3).map(|axis| greatest[axis] - least[axis]).fold(0.0, f32::max) / 64.0;
    std::array::from_fn(|axis| if corner >> axis & 1 == 1 { greatest[axis] + margin } else { least[axis] - margin })
}

/// Tests whether a corner of an object's box lies before the near plane, z = 0 in clip space.
fn crosses_near_plane(object: &Object, matrix: &[f32; 16]) -> bool {
    let row = |row: usize, [x, y, z]: [f32; 3]| {
        matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row]
    };
    (0..8).map(|corner| box_corner(object, corner)).any(|corner| row(2, corner) < 0.0 || row(3, corner) <= 0.0)
}
