//! One pass of a frame: its programs with the memory that they see, drawn or dispatched.
//!
//! In: a run of a pass. Out: changed memory, the samples that passed, the time it took. What the pass says and this device does
//! not run is refused by name before anything is changed.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use fragbuf_codegen::{PassId, PlannedPass};
use fragbuf_frame::{BOX_CORNERS, BOX_TRIANGLES, Run, Values, is_cut_by_near_plane, unsupported};
use fragbuf_interpreter::{Program, Space};
use fragbuf_templates::vocabulary::{Access, Coverage, Kind, Objects, Pass};

use super::Frame;
use super::call::{call, workgroups};
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
    /// Runs a pass.
    pub(super) fn pass(&mut self, run: Run) -> Result<(), Error> {
        let code = self.code;
        let (pass, at) = (&code.plan.passes[run.pass.0], run.pass.0);
        check(pass)?;
        let start = Instant::now();
        self.device.memory.arrange(&code.plan, run.flipped);
        let values = self.device.values.in_iteration(run.iteration);
        let uniforms = words(&values.frame_words(&code.plan, 0, run.iteration)?);
        let fault = match (&code.passes[at], &pass.kind) {
            (PassCode::Compute(program), Kind::Compute { .. }) => {
                let counts = workgroups(self, pass, &values)?;
                let view = self.view(program, &uniforms)?;
                compute(program, &view, counts).map_err(|how| Error::Stuck { pass: pass.anchor.clone(), how })?
            }
            (PassCode::Draw { vertex, fragment }, Kind::Geometry | Kind::Fullscreen) => {
                let stages = (vertex, fragment);
                let drawn = match pass.objects {
                    Objects::Boxes => self.boxes(run.pass, &values, stages, &uniforms)?,
                    _ => self.scene(pass, &values, stages, &uniforms)?,
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
    fn scene(&self, pass: &PlannedPass, values: &Values, stages: Stages<'_>, uniforms: &Words) -> Result<Drawn, Error> {
        let (vertices, indices) = match pass.kind {
            Kind::Geometry => (self.mesh.vertices, Some(self.mesh.indices)),
            _ => (&[][..], None),
        };
        let call =
            Draw { vertices, indices, call: call(self, pass)?, ..self.prepared(pass, values, stages, uniforms)? };
        // Millionths, so that threads can add them up.
        let done = AtomicU64::new(0);
        let report = |part: f64| {
            let before = done.fetch_add((1.0e6 * part) as u64, Ordering::Relaxed);
            (self.progress)(Stage { pass: &pass.anchor, share: 1.0e-6 * before as f64 + part });
        };
        draw(&call, &report).map_err(|what| refused(pass, what))
    }

    /// The box of every object that has not been dropped; what is found out of each is kept for the cursor. The samples of
    /// all.
    fn boxes(&mut self, query: PassId, values: &Values, stages: Stages<'_>, uniforms: &Words) -> Result<Drawn, Error> {
        let pass = &self.code.plan.passes[query.0];
        let mut all = Drawn::default();
        let mut found = Vec::new();
        let prepared = self.prepared(pass, values, stages, uniforms)?;
        let varyings = Varyings::of(stages.0).map_err(|what| refused(pass, what))?;
        let stride = vertices::stride(stages.0);
        for (number, object) in self.mesh_objects().iter().enumerate() {
            found.push(1);
            let is_asked = !self.cursor.is_dropped(&self.code.plan, query, number);
            let Some(corners) = self.corners(object, stride).filter(|_| is_asked) else { continue };
            let placed = vertices::run((stages.0, &prepared.vertex.1), &corners, BOX_CORNERS, 0);
            let placed = placed.map_err(|what| refused(pass, what))?;
            let crosses = placed.chunks(varyings.stride).any(|vertex| {
                let [_, _, z, w] = varyings.position_in(vertex);
                is_cut_by_near_plane(z, w)
            });
            let call = Draw {
                vertices: &corners,
                indices: Some(&BOX_TRIANGLES),
                call: Call::once(BOX_TRIANGLES.len() as u32 / 3),
                attachments: prepared.attachments.clone(),
                vertex: prepared.vertex.clone(),
                fragment: prepared.fragment.clone(),
                ..prepared
            };
            let drawn = draw(&call, &|_| {}).map_err(|what| refused(pass, what))?;
            all.samples += drawn.samples;
            all.fault = all.fault.or(drawn.fault);
            found[number] = u32::from(drawn.samples > 0 || crosses);
        }
        self.objects = found;
        Ok(all)
    }

    /// A draw of nothing: stages, attachments and what else the pass says.
    fn prepared<'v>(
        &'v self,
        pass: &PlannedPass,
        values: &Values,
        (vertex, fragment): (&'v Program, &'v Program),
        uniforms: &'v Words,
    ) -> Result<Draw<'v>, Error> {
        let plan = &self.code.plan;
        let settings = self.device.settings;
        let mut numbers = [1, u32::MAX, 0];
        if let Some([count, mask]) = &pass.samples {
            numbers[0] = values.word(count, "the samples of a pass")?;
            numbers[1] = values.word(mask, "the sample mask of a pass")?;
        }
        if let Some(reference) = &pass.reference {
            numbers[2] = values.word(reference, "the stencil's reference of a pass")?;
        }
        let coverage = pass.state.samples.as_ref().map_or(Coverage::PerSample, |samples| samples.coverage);
        let textures = |name: &str| {
            let index = plan.resource_id(name)?.0;
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
