//! Runs a technique of another project, from its own shaders, so that it can be compared with ours on one driver.
//!
//! Input: a [`Description`], the other project's files, a scene. Output: the image, and the time of a frame (`timing`).

mod description;
mod memory;
mod table;

use std::time::Duration;

use fragbuf_follow::{Image, Scene};
use glow::HasContext as _;

pub use self::description::Description;
pub use self::table::{PROJECTS, Project};

use self::memory::PeerMemory;
use crate::api::Desktop;
use crate::device::upside_down;
use crate::memory::Memory;
use crate::program::link;
use crate::timing::finished_at;
use crate::{Context, Error};

const VERTEX: &str = "#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
uniform mat4 view_projection;
out vec4 peer_color;
void main() {
    peer_color = color;
    gl_Position = view_projection * vec4(position, 1.0);
    // From the range of WebGPU, 0 to 1.
    gl_Position.z = 2.0 * gl_Position.z - gl_Position.w;
}
";

const SCREEN: &str = "#version 450 core
out vec4 peer_color;
void main() {
    peer_color = vec4(0.0);
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
";

/// A peer's technique on an OpenGL context, with memory for one size of the frame.
pub struct Peer<'c> {
    context: &'c Context,
    desktop: &'c Desktop,
    size: [i32; 2],
    memory: Vec<PeerMemory>,
    passes: Vec<Pass>,
    output: Memory,
    framebuffers: [glow::Framebuffer; 2],
    layouts: [glow::VertexArray; 2],
    vertices: glow::Buffer,
    /// Where the time of each pass is recorded, if it is measured. Each pass then waits for the one before it.
    pub pass_times: Option<Vec<(String, Duration)>>,
}

struct Pass {
    name: String,
    program: glow::Program,
    draws_scene: bool,
    has_output: bool,
}

/// Words per vertex: position and colour.
const STRIDE: i32 = 4 * (3 + 4);

impl<'c> Peer<'c> {
    /// Compiles every pass and creates the memory. `read` returns the text of a file of the other project.
    pub fn new(
        context: &'c Context,
        description: &Description,
        read: &dyn Fn(&str) -> Result<String, Error>,
        [width, height]: [u32; 2],
    ) -> Result<Self, Error> {
        let gl = &context.gl;
        let Some(desktop) = &context.desktop else {
            return Err(Error(format!(
                "shaders of other projects need OpenGL, and the context is one of {}",
                context.api
            )));
        };
        let size = [width as i32, height as i32];
        let memory = description.memory.iter().map(|memory| PeerMemory::new(gl, memory, size));
        let memory = memory.collect::<Result<_, Error>>()?;
        let mut passes = Vec::new();
        for pass in &description.passes {
            let source = description.source(pass, read)?;
            let vertex = if pass.scene { VERTEX } else { SCREEN };
            let sources = [
                (glow::VERTEX_SHADER, "vertex", vertex),
                (glow::FRAGMENT_SHADER, pass.fragment.as_str(), source.as_str()),
            ];
            let program = link(gl, &sources)?;
            for (name, value) in &pass.uniforms {
                let value = match value.as_str() {
                    "width" => size[0],
                    "height" => size[1],
                    "pixels" => size[0] * size[1],
                    number => number.parse().map_err(|_| Error(format!("uniform `{name}`: no number `{number}`")))?,
                };
                // SAFETY: the context is current.
                unsafe {
                    gl.use_program(Some(program));
                    let location = gl.get_uniform_location(program, name);
                    gl.uniform_1_i32(location.as_ref(), value);
                }
            }
            let file = pass.fragment.rsplit('/').next().unwrap_or_default();
            passes.push(Pass { name: file.to_owned(), program, draws_scene: pass.scene, has_output: pass.output });
        }
        let output = Memory::texture(gl, context.api.output(), 1, size)?;
        // SAFETY: the context is current.
        unsafe {
            let framebuffers = [gl.create_framebuffer().map_err(Error)?, gl.create_framebuffer().map_err(Error)?];
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffers[0]));
            (context.framebuffer_parameter)(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_WIDTH, size[0]);
            (context.framebuffer_parameter)(glow::FRAMEBUFFER, glow::FRAMEBUFFER_DEFAULT_HEIGHT, size[1]);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffers[1]));
            output.attach(gl, 0);
            gl.draw_buffers(&[glow::COLOR_ATTACHMENT0]);
            let layouts = [gl.create_vertex_array().map_err(Error)?, gl.create_vertex_array().map_err(Error)?];
            let vertices = gl.create_named_buffer().map_err(Error)?;
            gl.bind_vertex_array(Some(layouts[1]));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(vertices));
            for (location, components, offset) in [(0, 3, 0), (1, 4, 12)] {
                gl.enable_vertex_attrib_array(location);
                gl.vertex_attrib_pointer_f32(location, components, glow::FLOAT, false, STRIDE, offset);
            }
            Ok(Peer {
                context,
                desktop,
                size,
                memory,
                passes,
                output,
                framebuffers,
                layouts,
                vertices,
                pass_times: None,
            })
        }
    }

    /// Uploads the vertices of a scene: position and colour each.
    pub fn upload(&self, scene: &Scene<'_>) {
        // SAFETY: the context is current.
        unsafe { self.context.gl.named_buffer_data_u8_slice(self.vertices, scene.vertices, glow::STATIC_DRAW) };
    }

    /// Draws a frame over a background, without reading it back. The vertices are those of the last upload.
    pub fn draw(&mut self, scene: &Scene<'_>, background: [f32; 4]) {
        let gl = &self.context.gl;
        // A host that ran before has left its own state.
        let vertices: i32 = scene.objects.iter().map(|object| object.count as i32).sum();
        self.output.clear(self.context, 0, &background.as_slice().into());
        for memory in &self.memory {
            memory.clear(self.desktop);
            memory.bind(gl);
        }
        let [width, height] = self.size;
        // SAFETY: the context is current, and the layout matches the vertices.
        unsafe {
            for capability in [glow::DEPTH_TEST, glow::STENCIL_TEST, glow::CULL_FACE, glow::SAMPLE_MASK] {
                gl.disable(capability);
            }
            gl.viewport(0, 0, width, height);
            for pass in &self.passes {
                let begin = self.pass_times.is_some().then(|| finished_at(self.context));
                gl.use_program(Some(pass.program));
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffers[usize::from(pass.has_output)]));
                if pass.has_output {
                    gl.enable(glow::BLEND);
                    gl.blend_equation(glow::FUNC_ADD);
                    gl.blend_func(glow::ONE, glow::ONE_MINUS_SRC_ALPHA);
                }
                gl.bind_vertex_array(Some(self.layouts[usize::from(pass.draws_scene)]));
                if pass.draws_scene {
                    let location = gl.get_uniform_location(pass.program, "view_projection");
                    gl.uniform_matrix_4_f32_slice(location.as_ref(), false, &upside_down(scene));
                    gl.draw_arrays(glow::TRIANGLES, 0, vertices);
                } else {
                    gl.draw_arrays(glow::TRIANGLES, 0, 3);
                }
                gl.memory_barrier(glow::ALL_BARRIER_BITS);
                if let (Some(begin), Some(times)) = (begin, &mut self.pass_times) {
                    times.push((pass.name.clone(), finished_at(self.context) - begin));
                }
            }
        }
    }

    /// Draws a frame and reads the image back.
    pub fn render(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<Image, Error> {
        self.draw(scene, background);
        let gl = &self.context.gl;
        // SAFETY: the context is current.
        let error = unsafe { gl.get_error() };
        if error != glow::NO_ERROR {
            return Err(Error(format!("OpenGL reports error {error:#x} in a peer's frame")));
        }
        let pixels = self.output.texels(gl, self.size)?;
        Ok(Image { pixels, counters: Default::default(), lost: 0 })
    }
}
