//! Runs one pass: binds what its text declares, attaches its targets, sets its state, and draws or dispatches.

use std::collections::BTreeSet;

use fragbuf_follow::manifest::{Binding, BindingKind, Kind, Objects, Pass, VertexInput};
use fragbuf_follow::{BOX, Call};
use glow::HasContext as _;

use crate::device::Device;
use crate::material::MATRIX;
use crate::memory::Memory;
use crate::{Error, state};

impl Device<'_> {
    /// Runs a pass that computes.
    pub fn dispatch(&self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        self.bind(pass, call)?;
        let [x, y, z] = call.groups(pass, self.most_groups)?;
        // SAFETY: the context is current.
        unsafe { self.context.gl.dispatch_compute(x, y, z) };
        Ok(())
    }

    /// Runs a pass that draws.
    pub fn draw(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        let program = self.bind(pass, call)?;
        if pass.kind == Kind::Geometry && self.converts_z {
            self.set_matrix(program);
        }
        state::set(self.context, &pass.state, &|formula| call.value(formula))?;
        let framebuffer = self.attach(pass, call)?;
        let queries = self.draw_objects(pass, call);
        // SAFETY: the context is current.
        unsafe { self.context.gl.delete_framebuffer(framebuffer) };
        self.queries.insert(pass.name.clone(), queries?);
        Ok(())
    }

    /// Binds the program of a pass, its uniform blocks, and the resources that its text declares.
    fn bind(&self, pass: &Pass, call: &Call<'_>) -> Result<glow::Program, Error> {
        let gl = &self.context.gl;
        self.bind_blocks(call)?;
        let is_resource = |binding: &&Binding| binding.kind != BindingKind::Uniform;
        for binding in pass.bindings(self.context.api.target()).iter().filter(is_resource) {
            self.memory(call.resource(&binding.name))?.bind(gl, binding.opengl_binding);
        }
        let program = self.programs.get(&pass.name).copied();
        let program = program.ok_or_else(|| Error(format!("no files of pass `{}`", pass.name)))?;
        // SAFETY: the context is current.
        unsafe { gl.use_program(Some(program)) };
        Ok(program)
    }

    /// Sets the matrix of a material, which maps z to the range of OpenGL as well.
    fn set_matrix(&self, program: glow::Program) {
        let mut matrix = self.view_projection;
        for column in matrix.chunks_exact_mut(4) {
            column[2] = 2.0 * column[2] - column[3];
        }
        let gl = &self.context.gl;
        // SAFETY: the context is current, and so is the program.
        unsafe {
            let location = gl.get_uniform_location(program, MATRIX);
            gl.uniform_matrix_4_f32_slice(location.as_ref(), false, &matrix);
        }
    }

    /// Creates and binds the framebuffer of a pass.
    fn attach(&self, pass: &Pass, call: &Call<'_>) -> Result<glow::Framebuffer, Error> {
        let gl = &self.context.gl;
        let memory = |name: &str| if name == "output" { Ok(self.output) } else { self.memory(call.resource(name)) };
        let targets: Vec<&str> = pass.state.targets.iter().map(|target| target.resource.as_str()).collect();
        let used = pass.uses.iter().filter(|(_, access)| *access == "attachment").map(|(name, _)| name.as_str());
        let depth = pass.state.depth.iter().map(|depth| depth.resource.as_str());
        let stencil = pass.state.stencil.iter().map(|stencil| stencil.resource.as_str());
        let others: BTreeSet<&str> = used.chain(depth).chain(stencil).filter(|name| !targets.contains(name)).collect();
        let others: Vec<Memory> = others.into_iter().map(memory).collect::<Result<_, Error>>()?;
        let targets: Vec<Memory> = targets.into_iter().map(memory).collect::<Result<_, Error>>()?;
        let samples = pass.state.samples.as_ref().map_or(Ok(0), |samples| call.value(&samples.count))?;
        let [width, height] = self.size;
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
                let parameter = self.context.framebuffer_parameter;
                parameter(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_WIDTH, width);
                parameter(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_HEIGHT, height);
                parameter(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_SAMPLES, samples as i32);
            }
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            if status != glow::FRAMEBUFFER_COMPLETE {
                gl.delete_framebuffer(framebuffer);
                return Err(Error(format!("the framebuffer of pass `{}` is incomplete: {status:#x}", pass.name)));
            }
            gl.viewport(0, 0, width, height);
            Ok(framebuffer)
        }
    }

    /// Draws what a pass draws. Returns the queries whether any sample passed: one per box, or one for all objects.
    fn draw_objects(&self, pass: &Pass, call: &Call<'_>) -> Result<Vec<glow::Query>, Error> {
        let is_boxes = matches!(pass.objects, Objects::Boxes);
        let ranges: Vec<[u32; 2]> = if pass.kind == Kind::Fullscreen {
            self.bind_vertices(None);
            vec![[0, 3]]
        } else {
            self.bind_vertices(Some(is_boxes));
            let length = BOX.len() as u32;
            let range = |object: &usize| match self.objects.get(*object) {
                Some(_) if is_boxes => [*object as u32 * length, length],
                Some(object) => [object.first, object.count],
                None => [0, 0],
            };
            call.objects.iter().map(range).collect()
        };
        let drawn: Vec<&[[u32; 2]]> = if is_boxes { ranges.chunks(1).collect() } else { vec![&ranges] };
        let queries = drawn.into_iter().map(|ranges| self.draw_ranges(ranges, call.is_queried));
        Ok(queries.collect::<Result<Vec<_>, Error>>()?.into_iter().flatten().collect())
    }

    /// Draws ranges of vertices, within a query if it is asked for.
    fn draw_ranges(&self, ranges: &[[u32; 2]], is_queried: bool) -> Result<Option<glow::Query>, Error> {
        let gl = &self.context.gl;
        // SAFETY: the context is current, and the vertices are those of the bound layout.
        unsafe {
            let query = if is_queried { Some(gl.create_query().map_err(Error)?) } else { None };
            if let Some(query) = query {
                gl.begin_query(glow::ANY_SAMPLES_PASSED, query);
            }
            for [first, count] in ranges {
                gl.draw_arrays(glow::TRIANGLES, *first as i32, *count as i32);
            }
            if is_queried {
                gl.end_query(glow::ANY_SAMPLES_PASSED);
            }
            Ok(query)
        }
    }

    /// Binds no vertices, those of the scene, or those of its boxes.
    fn bind_vertices(&self, boxes: Option<bool>) {
        let gl = &self.context.gl;
        let stride = self.stride() as i32;
        let mut offset = 0;
        for input in &self.plan.vertex_inputs {
            let (components, kind) = (input.components() as i32, component_type(input));
            // SAFETY: the context is current.
            unsafe {
                let Some(boxes) = boxes else {
                    gl.disable_vertex_attrib_array(input.location);
                    continue;
                };
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.vertices[usize::from(boxes)]));
                gl.enable_vertex_attrib_array(input.location);
                if kind == glow::FLOAT {
                    gl.vertex_attrib_pointer_f32(input.location, components, kind, false, stride, offset);
                } else {
                    gl.vertex_attrib_pointer_i32(input.location, components, kind, stride, offset);
                }
            }
            offset += 4 * components;
        }
    }
}

/// Returns the type of a component of a vertex input.
fn component_type(input: &VertexInput) -> u32 {
    match input.component_type() {
        "u32" => glow::UNSIGNED_INT,
        "i32" => glow::INT,
        _ => glow::FLOAT,
    }
}
