//! Runs one pass of a frame: binds memory to its programs, then draws or dispatches.
//!
//! A pass that this device does not support is an error before it changes memory.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use fragbuf_codegen::{PassId, PlannedPass};
use fragbuf_frame::{BOX_CORNERS, BOX_TRIANGLES, PassRun, Values, is_below_a_pixel, is_cut_by_near_plane, unsupported};
use fragbuf_interpreter::{Bytecode, Space};
use fragbuf_templates::vocabulary::{Access, Coverage, Kind, Objects, Pass};

use super::Frame;
use super::draw_arguments::{draw_arguments, workgroups};
use crate::Error;
use crate::attachment::Attachments;
use crate::bound_texture::BoundTexture;
use crate::code::PassCode;
use crate::compute::{ComputeError, compute};
use crate::draw::{BATCH_BYTES, DrawError, DrawResult, draw};
use crate::draw_call::{DrawArguments, DrawCall};
use crate::interface::VertexOutputLayout;
use crate::memory::{Words, words};
use crate::picture::PassProgress;
use crate::settings::FragmentOrder;
use crate::triangle::Triangle;
use crate::vertices;
use crate::view::View;

/// The vertex and fragment programs of a draw.
type StagePrograms<'a> = (&'a Bytecode, &'a Bytecode);

impl Frame<'_> {
    /// Runs a pass.
    pub(super) fn pass(&mut self, run: PassRun) -> Result<(), Error> {
        let code = self.code;
        let (pass, at) = (&code.plan.passes[run.pass.0], run.pass.0);
        reject_feedback(pass)?;
        let start = Instant::now();
        self.device.memory.arrange(&code.plan, run.flipped);
        let values = self.device.values.in_iteration(run.iteration);
        let uniforms = words(&values.frame_words(&code.plan, self.number, run.iteration)?);
        let out_of_bounds = match (&code.passes[at], &pass.kind) {
            (PassCode::Compute(program), Kind::Compute { .. }) => {
                let counts = workgroups(self, pass, &values)?;
                let view = self.view(program, &uniforms)?;
                compute(program, &view, counts, self.device.settings.lanes).map_err(|error| match error {
                    ComputeError::Endless(instruction) => code.endless(at, program, instruction),
                    ComputeError::DivergentBarrier => Error::NotTerminating {
                        pass: pass.name.clone(),
                        reason: "some invocations wait at a barrier that the others do not reach",
                        location: None,
                    },
                })?
            }
            (PassCode::Draw { vertex, fragment }, Kind::Geometry | Kind::Fullscreen) => {
                let stages = (vertex, fragment);
                let drawn = match pass.objects {
                    Objects::Boxes => self.draw_boxes(run.pass, &values, stages, &uniforms)?,
                    _ => self.draw_scene(run.pass, &values, stages, &uniforms)?,
                };
                self.samples[at] = drawn.samples;
                drawn.out_of_bounds
            }
            _ => {
                return Err(
                    unsupported(format!("pass `{}`, whose entry points do not match its kind", pass.name)).into()
                );
            }
        };
        if out_of_bounds.is_some() && !self.out_of_bounds.contains(&pass.name) {
            self.out_of_bounds.push(pass.name.clone());
        }
        self.times[at] += start.elapsed().as_secs_f64() * 1000.0;
        Ok(())
    }

    /// Draws the scene, or a triangle over the whole frame.
    fn draw_scene(
        &self,
        id: PassId,
        values: &Values,
        stages: StagePrograms<'_>,
        uniforms: &Words,
    ) -> Result<DrawResult, Error> {
        let pass = &self.code.plan.passes[id.0];
        let (vertices, indices) = match pass.kind {
            Kind::Geometry => (self.mesh.vertices, Some(self.mesh.indices)),
            _ => (&[][..], None),
        };
        let call = DrawCall {
            vertices,
            indices,
            arguments: draw_arguments(self, pass)?,
            ..self.empty_draw(pass, values, stages, uniforms)?
        };
        check_shuffled(&call)?;
        // In millionths, so that threads can add atomically.
        let done = AtomicU64::new(0);
        let report = |part: f64| {
            let before = done.fetch_add((1.0e6 * part) as u64, Ordering::Relaxed);
            (self.progress)(PassProgress { pass: &pass.name, share: 1.0e-6 * before as f64 + part });
        };
        draw(&call, &report).map_err(|error| self.draw_error(id, stages, call.triangle_count(), call.memory, error))
    }

    /// Draws the box of every object that is not dropped, and keeps the result per object for the cursor.
    fn draw_boxes(
        &mut self,
        query: PassId,
        values: &Values,
        stages: StagePrograms<'_>,
        uniforms: &Words,
    ) -> Result<DrawResult, Error> {
        let pass = &self.code.plan.passes[query.0];
        let mut all = DrawResult::default();
        let mut visible = Vec::new();
        let empty = self.empty_draw(pass, values, stages, uniforms)?;
        let layout = VertexOutputLayout::of(stages.0).map_err(|what| shader_error(pass, what))?;
        let stride = vertices::stride(stages.0);
        for (number, object) in self.mesh_objects().iter().enumerate() {
            visible.push(1);
            let is_queried = !self.is_dropped(query, number);
            let Some(corners) = self.corners(object, stride).filter(|_| is_queried) else { continue };
            let transformed = vertices::run((stages.0, &empty.vertex.1), &corners, (BOX_CORNERS, 0), empty.lanes);
            let transformed = transformed.map_err(|error| self.draw_error(query, stages, 0, 0, error))?;
            let positions: Vec<[f32; 4]> =
                transformed.chunks(layout.stride).map(|vertex| layout.position_in(vertex)).collect();
            let is_undecided = positions.iter().any(|[_, _, z, w]| is_cut_by_near_plane(*z, *w))
                || is_below_a_pixel(&positions, (self.device.settings.width, self.device.settings.height));
            let call = DrawCall {
                vertices: &corners,
                indices: Some(&BOX_TRIANGLES),
                arguments: DrawArguments::once(BOX_TRIANGLES.len() as u32 / 3),
                attachments: empty.attachments.clone(),
                rows: empty.rows.clone(),
                vertex: empty.vertex.clone(),
                fragment: empty.fragment.clone(),
                ..empty
            };
            let drawn = draw(&call, &|_| {});
            let drawn =
                drawn.map_err(|error| self.draw_error(query, stages, call.triangle_count(), call.memory, error))?;
            all.samples += drawn.samples;
            all.out_of_bounds = all.out_of_bounds.or(drawn.out_of_bounds);
            visible[number] = u32::from(drawn.samples > 0 || is_undecided);
        }
        self.objects = visible;
        Ok(all)
    }

    /// Returns the error of a draw call with this many triangles and this memory.
    fn draw_error(
        &self,
        id: PassId,
        (vertex, fragment): StagePrograms<'_>,
        triangles: u64,
        memory: u64,
        error: DrawError,
    ) -> Error {
        match error {
            DrawError::Shader(what) => shader_error(&self.code.plan.passes[id.0], what),
            DrawError::EndlessVertex(at) => self.code.endless(id.0, vertex, at),
            DrawError::EndlessFragment(at) => self.code.endless(id.0, fragment, at),
            DrawError::Shuffled(needed) => shuffled_error(triangles, memory, needed),
        }
    }

    /// Returns a draw call of the pass without triangles.
    fn empty_draw<'v>(
        &'v self,
        pass: &PlannedPass,
        values: &Values,
        (vertex, fragment): (&'v Bytecode, &'v Bytecode),
        uniforms: &'v Words,
    ) -> Result<DrawCall<'v>, Error> {
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
        Ok(DrawCall {
            vertex: (vertex, self.view(vertex, uniforms)?),
            fragment: (fragment, self.view(fragment, uniforms)?),
            vertices: &[],
            indices: None,
            arguments: DrawArguments::once(0),
            size: (settings.width, settings.height),
            rows: self.slice.rows.clone(),
            attachments: Attachments::of(pass, numbers, &textures, (&self.output, &self.slice))?,
            coverage,
            order: settings.order,
            lanes: settings.lanes,
            memory: self.device.limits.left(plan, &self.device.values)?.max(BATCH_BYTES),
        })
    }

    /// Binds the resources of the plan to the buffers and textures of a program.
    fn view<'v>(&'v self, program: &Bytecode, frame: &'v Words) -> Result<View<'v>, Error> {
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
            let described = texture.binding.and_then(|(_, binding)| self.device.textures.get(&binding));
            if let Some(described) = described {
                return Ok(BoundTexture::described(described));
            }
            let (words, element) =
                found.ok_or_else(|| unsupported(format!("`{}`, which the plan does not have", texture.name)))?;
            BoundTexture::of(texture, words, element, size)
        });
        let textures = textures.collect::<Result<_, fragbuf_frame::Error>>()?;
        Ok(View { buffers: buffers.collect(), textures, wide: &self.wide })
    }
}

/// Checks that the triangles of a draw call fit into its memory where all of them are set up at once.
fn check_shuffled(call: &DrawCall<'_>) -> Result<(), Error> {
    let needed = call.triangle_count().saturating_mul(size_of::<Triangle>() as u64);
    if call.order == FragmentOrder::Submission || needed <= call.memory {
        return Ok(());
    }
    Err(shuffled_error(call.triangle_count(), call.memory, needed))
}

fn shuffled_error(triangles: u64, memory: u64, needed: u64) -> Error {
    fragbuf_frame::Error::TooLarge {
        what: format!("a shuffled order of {triangles} triangles"),
        needed,
        limit: memory,
        limit_name: "the greater of the rest of the memory budget and the size of one batch, in bytes",
        help: "use the order of submission, a smaller scene, lower slices or a larger budget",
        shrinks_with_rows: true,
    }
    .into()
}

fn shader_error(pass: &Pass, what: String) -> Error {
    Error::Shader { pass: pass.name.clone(), what }
}

/// Rejects a texture that the pass both reads and writes. It may read depth that it only tests.
fn reject_feedback(pass: &Pass) -> Result<(), Error> {
    let state = &pass.state;
    let is_written = |name: &str| {
        let depth = state.depth.as_ref().is_some_and(|depth| depth.resource == name && depth.write);
        let stencil = state.stencil.as_ref().is_some_and(|stencil| stencil.resource == name);
        depth || stencil || state.targets.iter().any(|target| target.resource == name)
    };
    let sampled = pass.uses.iter().filter(|usage| usage.access == Access::Sampled);
    match sampled.into_iter().find(|usage| is_written(&usage.resource)) {
        Some(usage) => {
            let what = format!("pass `{}`: `{}`, which it both reads and draws to", pass.name, usage.resource);
            Err(unsupported(what).into())
        }
        None => Ok(()),
    }
}
