//! One pass of a frame: its programs with the memory that they see, drawn or dispatched.
//!
//! In: a pass and its round. Out: changed memory, the samples that passed, the time it took. What the pass says and this device does
//! not run is refused by name before anything is changed.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use fragbuf_frame::{resource, unsupported};
use fragbuf_interpreter::{Program, Space};
use fragbuf_templates::vocabulary::{Access, Coverage, Kind, Objects, Pass};

use super::call::{call, workgroups};
use super::objects::{FACES, Verdict};
use super::{Frame, number};
use crate::Error;
use crate::attachment::Attachments;
use crate::code::PassCode;
use crate::compute::compute;
use crate::device::Stage;
use crate::draw::{Call, Draw, Drawn, draw};
use crate::interface::Varyings;
use crate::memory::{Words, words};
use crate::sampled::Sampled;
use crate::vertices;
use crate::view::View;

/// The stages of a draw.
type Stages<'a> = (&'a Program, &'a Program);

impl Frame<'_> {
    /// Runs the pass of this number.
    pub(super) fn pass(&mut self, pass: &Pass, at: usize, round: u32) -> Result<(), Error> {
        check(pass)?;
        let start = Instant::now();
        let code = self.code;
        let uniforms = words(&self.device.symbols.frame_words(&code.plan, 0, round)?);
        let fault = match (&code.passes[at], &pass.kind) {
            (PassCode::Compute(program), Kind::Compute { groups }) => {
                let counts = workgroups(self, pass, groups, round)?;
                let view = self.view(program, &uniforms)?;
                compute(program, &view, counts).map_err(|how| Error::Stuck { pass: pass.anchor.clone(), how })?
            }
            (PassCode::Draw { vertex, fragment }, Kind::Geometry | Kind::Fullscreen) => {
                let stages = (vertex, fragment);
                let drawn = match pass.objects {
                    Objects::Boxes => self.boxes(pass, round, stages, &uniforms)?,
                    _ => self.scene(pass, round, stages, &uniforms)?,
                };
                self.samples[at] = drawn.samples;
                drawn.fault
            }
            _ => {
                return Err(unsupported(format!("pass `{}`: its entry points are not of its kind", pass.anchor)).into());
            }
        };
        if fault.is_some() && !self.out_of_bounds.contains(&pass.anchor) {
            self.out_of_bounds.push(pass.anchor.clone());
        }
        self.times[at] += start.elapsed().as_secs_f64() * 1000.0;
        Ok(())
    }

    /// The scene, or a triangle over the whole frame.
    fn scene(&self, pass: &Pass, round: u32, stages: Stages<'_>, uniforms: &Words) -> Result<Drawn, Error> {
        let (vertices, indices) = match pass.kind {
            Kind::Geometry => (self.mesh.vertices, Some(self.mesh.indices)),
            _ => (&[][..], None),
        };
        let call = Draw { vertices, indices, call: call(self, pass)?, ..self.prepared(pass, round, stages, uniforms)? };
        // Millionths, so that threads can add them up.
        let done = AtomicU64::new(0);
        let report = |part: f64| {
            let before = done.fetch_add((1.0e6 * part) as u64, Ordering::Relaxed);
            (self.progress)(Stage { pass: &pass.anchor, share: 1.0e-6 * before as f64 + part });
        };
        draw(&call, &report).map_err(|what| refused(pass, what))
    }

    /// The box of every object that has not been dropped; those of which no sample passes are dropped. The samples of all.
    fn boxes(&mut self, pass: &Pass, round: u32, stages: Stages<'_>, uniforms: &Words) -> Result<Drawn, Error> {
        let mut verdicts = self.verdicts(pass);
        let mut all = Drawn::default();
        let prepared = self.prepared(pass, round, stages, uniforms)?;
        let varyings = Varyings::of(stages.0).map_err(|what| refused(pass, what))?;
        let stride = vertices::stride(stages.0);
        for (object, verdict) in self.mesh_objects().iter().zip(&mut verdicts) {
            let Some(corners) = self.corners(object, stride).filter(|_| *verdict == Verdict::Seen) else { continue };
            let placed = vertices::run((stages.0, &prepared.vertex.1), &corners.vertices, 8, 0);
            let placed = placed.map_err(|what| refused(pass, what))?;
            let crosses = placed.chunks(varyings.stride).any(|vertex| {
                let [_, _, z, w] = varyings.position_in(vertex);
                // Not a number is no place that could be dropped, either.
                !(z >= 0.0 && w > 0.0)
            });
            let call = Draw {
                vertices: &corners.vertices,
                indices: Some(&FACES),
                call: Call::once(FACES.len() as u32 / 3),
                attachments: prepared.attachments.clone(),
                vertex: prepared.vertex.clone(),
                fragment: prepared.fragment.clone(),
                ..prepared
            };
            let drawn = draw(&call, &|_| {}).map_err(|what| refused(pass, what))?;
            all.samples += drawn.samples;
            all.fault = all.fault.or(drawn.fault);
            if drawn.samples == 0 && !crosses {
                *verdict = Verdict::Dropped;
            }
        }
        self.judge(pass, verdicts);
        Ok(all)
    }

    /// A draw of nothing: stages, attachments and what else the pass says.
    fn prepared<'v>(
        &'v self,
        pass: &Pass,
        round: u32,
        (vertex, fragment): (&'v Program, &'v Program),
        uniforms: &'v Words,
    ) -> Result<Draw<'v>, Error> {
        let plan = &self.code.plan;
        let settings = self.device.settings;
        let number = |formula, what| number(plan, &self.device.symbols, formula, round, what);
        let (mut numbers, mut coverage) = ([1, u32::MAX, 0], Coverage::PerSample);
        if let Some(samples) = &pass.state.samples {
            numbers[0] = number(&samples.count, "the samples of a pass")?;
            numbers[1] = number(&samples.mask, "the sample mask of a pass")?;
            coverage = samples.coverage;
        }
        if let Some(stencil) = &pass.state.stencil {
            numbers[2] = number(&stencil.reference, "the stencil's reference of a pass")?;
        }
        let textures = |name: &str| {
            let index = resource(plan, name).ok()?;
            Some((self.device.memory.resources[index].as_slice(), plan.resources[index].resource.element))
        };
        let pixels = settings.width as usize * settings.height as usize;
        Ok(Draw {
            vertex: (vertex, self.view(vertex, uniforms)?),
            fragment: (fragment, self.view(fragment, uniforms)?),
            vertices: &[],
            indices: None,
            call: Call::once(0),
            size: (settings.width, settings.height),
            attachments: Attachments::of(pass, numbers, &textures, (&self.output, pixels))?,
            coverage,
            order: settings.order,
        })
    }

    /// The buffers and textures of a program, by the plan's bindings.
    fn view<'v>(&'v self, program: &Program, frame: &'v Words) -> Result<View<'v>, Error> {
        let resources = &self.code.plan.resources;
        let planned = |binding: u32| {
            let index = resources.iter().position(|planned| planned.binding == binding)?;
            Some((self.device.memory.resources.get(index)?.as_slice(), resources[index].resource.element))
        };
        let bound = |binding: u32| match binding {
            0 => frame.as_slice(),
            1 => &self.uniforms,
            2 => &self.camera,
            _ => planned(binding).map_or(&[][..], |(words, _)| words),
        };
        let buffers = program.buffers.iter().map(|buffer| match (buffer.space, buffer.binding) {
            (Space::Workgroup, _) | (_, None) => &[][..],
            (_, Some((_, binding))) => bound(binding),
        });
        let size = (self.device.settings.width, self.device.settings.height);
        let textures = program.textures.iter().map(|texture| {
            let found = texture.binding.and_then(|(_, binding)| planned(binding));
            let (words, element) =
                found.ok_or_else(|| unsupported(format!("`{}`, which the plan does not have", texture.name)))?;
            Sampled::of(texture, words, element, size)
        });
        let textures = textures.collect::<Result<_, fragbuf_frame::Error>>()?;
        Ok(View { buffers: buffers.collect(), textures, wide: &self.wide })
    }
}

fn refused(pass: &Pass, what: String) -> Error {
    Error::Shader { pass: pass.anchor.clone(), what }
}

/// Refuses what no device runs: a texture that is read while it is drawn to. Depth that is only tested may be read.
fn check(pass: &Pass) -> Result<(), Error> {
    let state = &pass.state;
    let is_written = |name: &str| {
        let depth = state.depth.as_ref().is_some_and(|depth| depth.resource == name && depth.write);
        let stencil = state.stencil.as_ref().is_some_and(|stencil| stencil.resource == name);
        depth || stencil || state.targets.iter().any(|target| target.resource == name)
    };
    let sampled = pass.uses.iter().filter(|usage| usage.access == Access::Sampled);
    match sampled.into_iter().find(|usage| is_written(&usage.resource)) {
        Some(usage) => {
            let what = format!("pass `{}`: `{}`, which it reads and draws to at once", pass.anchor, usage.resource);
            Err(unsupported(what).into())
        }
        None => Ok(()),
    }
}
