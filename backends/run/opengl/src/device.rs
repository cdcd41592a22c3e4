//! The memory, programs and uniforms of a plan, and the steps that OpenGL carries out. `draw` has the passes.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use fragbuf_follow::manifest::{Kind, Pass, Plan};
use fragbuf_follow::{Call, Object, Scene, Texels, Uniforms, Values};
use glow::HasContext as _;

use crate::memory::Memory;
use crate::timing::finished_at;
use crate::{Context, Error, limits};

/// The device of one plan and one size of the frame.
pub(crate) struct Device<'c> {
    pub context: &'c Context,
    pub plan: Arc<Plan>,
    pub size: [i32; 2],
    pub programs: BTreeMap<String, glow::Program>,
    pub output: Memory,
    layout: glow::VertexArray,
    /// The vertices of the scene, and those of its boxes.
    pub vertices: [glow::Buffer; 2],
    memory: BTreeMap<String, Memory>,
    pub uniforms: Uniforms,
    pub blocks: Vec<glow::Buffer>,
    /// The matrix and the objects of the frame.
    pub view_projection: [f32; 16],
    pub objects: Vec<Object>,
    /// Whether the matrix maps z to the range of OpenGL. Generated vertex shaders convert it themselves.
    pub converts_z: bool,
    /// The queries of the latest run of each pass whose samples are counted.
    pub queries: BTreeMap<String, Vec<glow::Query>>,
    /// The greatest numbers of workgroups along x, y and z.
    pub most_groups: [u32; 3],
    /// The time of each pass of the frame, if it is measured.
    pub pass_times: Option<Vec<(String, Duration)>>,
}

impl<'c> Device<'c> {
    pub fn new(context: &'c Context, plan: Arc<Plan>, [width, height]: [u32; 2]) -> Result<Self, Error> {
        let gl = &context.gl;
        let size = [width as i32, height as i32];
        // SAFETY: the context is current.
        let layout = unsafe { gl.create_vertex_array() }.map_err(Error)?;
        // SAFETY: the context is current.
        let create = || unsafe { gl.create_buffer() }.map_err(Error);
        Ok(Device {
            context,
            size,
            programs: BTreeMap::new(),
            output: Memory::texture(gl, context.api.output(), 1, size)?,
            layout,
            vertices: [create()?, create()?],
            memory: BTreeMap::new(),
            uniforms: Uniforms::new(&plan),
            blocks: plan.uniform_blocks.iter().map(|_| create()).collect::<Result<_, Error>>()?,
            view_projection: [0.0; 16],
            objects: Vec::new(),
            converts_z: false,
            queries: BTreeMap::new(),
            most_groups: limits::most_groups(context),
            pass_times: None,
            plan,
        })
    }

    /// Uploads the vertices of a scene, and its objects' boxes in the same layout.
    pub fn upload(&self, scene: &Scene<'_>) -> Result<(), Error> {
        let gl = &self.context.gl;
        let uploaded = (scene.vertices.len() / self.stride().max(1)) as u64;
        let is_beyond = |object: &&Object| u64::from(object.first) + u64::from(object.count) > uploaded;
        if let Some(object) = scene.objects.iter().find(is_beyond) {
            let Object { first, count, .. } = object;
            return Err(Error(format!("an object has {count} vertices from {first} on, and the scene has {uploaded}")));
        }
        for (buffer, bytes) in self.vertices.iter().zip([scene.vertices, &scene.boxes(self.stride())]) {
            // SAFETY: the context is current.
            unsafe {
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(*buffer));
                gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytes, glow::STATIC_DRAW);
            }
        }
        Ok(())
    }

    /// Begins a frame over a background.
    pub fn begin(&mut self, scene: &Scene<'_>, background: [f32; 4], is_measured: bool) {
        self.view_projection = upside_down(scene);
        self.objects = scene.objects.to_vec();
        self.pass_times = is_measured.then(Vec::new);
        self.output.clear(self.context, 0, &background.as_slice().into());
        // SAFETY: the context is current.
        unsafe { self.context.gl.bind_vertex_array(Some(self.layout)) };
    }

    /// Creates an external texture and writes its texels.
    pub fn set_texture(&mut self, name: &str, texels: &[f32]) -> Result<(), Error> {
        let [width, height] = self.size;
        let pixels = (width * height) as usize;
        if texels.len() != pixels {
            return Err(Error(format!("{} texels for `{name}`, and the frame has {pixels} pixels", texels.len())));
        }
        let texture = self.plan.resource(name).and_then(|resource| resource.texture.as_ref());
        let texture = texture.ok_or_else(|| Error(format!("`{name}` is no texture")))?;
        let gl = &self.context.gl;
        let memory = Memory::texture_of(gl, texture, 1, self.size)?;
        memory.write(gl, texels, self.size);
        if let Some(former) = self.memory.insert(name.to_owned(), memory) {
            former.delete(gl);
        }
        Ok(())
    }

    /// Creates a texture of the description with its texels.
    pub fn set_texels(&mut self, name: &str, texels: &Texels<'_>) -> Result<(), Error> {
        let gl = &self.context.gl;
        let most = [glow::MAX_TEXTURE_SIZE, glow::MAX_3D_TEXTURE_SIZE];
        // SAFETY: the context is current.
        let most = most.map(|limit| unsafe { gl.get_parameter_i32(limit) }.max(0) as u32);
        let (resource, dimension) = texels.resource(&self.plan, name, most)?;
        let memory = Memory::of_texels(gl, texels, dimension)?;
        if let Some(former) = self.memory.insert(resource.name.clone(), memory) {
            former.delete(gl);
        }
        Ok(())
    }

    pub fn has(&self, resource: &str) -> bool {
        self.memory.contains_key(resource)
    }

    /// Returns the memory of a resource whose size is known.
    pub fn memory(&self, name: &str) -> Result<Memory, Error> {
        let memory = self.memory.get(name).copied();
        memory.ok_or_else(|| {
            Error(format!("`{name}` has no memory, because a symbol of its size has no value: set it before the frame"))
        })
    }

    /// Writes the uniform blocks for a pass and binds them.
    pub fn bind_blocks(&self, call: &Call<'_>) -> Result<(), Error> {
        let gl = &self.context.gl;
        for (block, buffer) in self.plan.uniform_blocks.iter().zip(&self.blocks) {
            let bytes = call.block(block, &self.uniforms, &self.view_projection)?;
            // SAFETY: the context is current.
            unsafe {
                gl.bind_buffer(glow::UNIFORM_BUFFER, Some(*buffer));
                gl.buffer_data_u8_slice(glow::UNIFORM_BUFFER, &bytes, glow::DYNAMIC_DRAW);
                gl.bind_buffer_base(glow::UNIFORM_BUFFER, block.opengl_binding, Some(*buffer));
            }
        }
        Ok(())
    }

    /// The bytes of a vertex.
    pub fn stride(&self) -> usize {
        self.plan.vertex_inputs.iter().map(|input| 4 * input.components()).sum()
    }

    fn delete_queries(&mut self, pass: &str) {
        for query in self.queries.remove(pass).into_iter().flatten() {
            // SAFETY: the context is current.
            unsafe { self.context.gl.delete_query(query) };
        }
    }
}

/// Returns the matrix of a scene with y turned. Rows count in the direction of `gl_FragCoord.y`, from below; so the first row of every texture
/// is the upper row of the image. `glClipControl` does the same, but OpenGL ES lacks it.
pub(crate) fn upside_down(scene: &Scene<'_>) -> [f32; 16] {
    let mut matrix = scene.view_projection;
    matrix.chunks_exact_mut(4).for_each(|column| column[1] = -column[1]);
    matrix
}

impl fragbuf_follow::Device for Device<'_> {
    fn clear(&mut self, resource: &str, value: u32, texel: Option<&serde_json::Value>) -> Result<(), Error> {
        self.memory(resource)?.clear(self.context, value, texel.unwrap_or(&serde_json::Value::Null));
        Ok(())
    }

    fn copy(&mut self, from: &str, to: &str) -> Result<(), Error> {
        self.memory(to)?.copy_from(&self.context.gl, self.memory(from)?, self.size)
    }

    fn pass(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        let begin = self.pass_times.is_some().then(|| finished_at(self.context));
        self.delete_queries(&pass.name);
        match pass.kind {
            Kind::Compute => self.dispatch(pass, call)?,
            Kind::Geometry | Kind::Fullscreen => self.draw(pass, call)?,
        }
        // SAFETY: the context is current.
        unsafe { self.context.gl.memory_barrier(glow::ALL_BARRIER_BITS) };
        let end: Option<Instant> = begin.map(|_| finished_at(self.context));
        if let (Some(begin), Some(end), Some(times)) = (begin, end, &mut self.pass_times) {
            times.push((pass.name.clone(), end - begin));
        }
        Ok(())
    }

    fn words(&mut self, resource: &str, first: u64, count: u64) -> Result<Vec<u32>, Error> {
        Ok(self.memory(resource)?.words(&self.context.gl, first, count))
    }

    fn samples(&mut self, pass: &str) -> Result<Vec<u64>, Error> {
        let queries = self.queries.get(pass).into_iter().flatten();
        let samples = queries.map(|query| {
            // SAFETY: the context is current.
            unsafe { self.context.gl.get_query_parameter_u32(*query, glow::QUERY_RESULT) }.into()
        });
        Ok(samples.collect())
    }

    /// Creates the memory of every resource whose size is known and has changed.
    fn allocate(&mut self, values: &Values) -> Result<(), Error> {
        let gl = &self.context.gl;
        for resource in self.plan.resources.iter().filter(|resource| resource.init != "external") {
            let memory = match (&resource.texture, self.memory.get(&resource.name)) {
                (Some(_), Some(_)) => continue,
                (Some(texture), None) => {
                    Memory::texture_of(gl, texture, values.value(&texture.samples, 0)?, self.size)?
                }
                (None, present) => {
                    let Ok(bytes) = values.bytes(resource) else { continue };
                    if present.is_some_and(|present| present.bytes() == bytes) {
                        continue;
                    }
                    check_block(gl, &resource.name, bytes)?;
                    Memory::buffer(gl, &resource.name, bytes)?
                }
            };
            memory.clear(self.context, 0, &serde_json::Value::Null);
            if let Some(former) = self.memory.insert(resource.name.clone(), memory) {
                former.delete(gl);
            }
        }
        Ok(())
    }
}

/// Checks that the driver binds a buffer of this size.
fn check_block(gl: &glow::Context, name: &str, bytes: u64) -> Result<(), Error> {
    // SAFETY: the context is current.
    let greatest = unsafe { gl.get_parameter_i64(glow::MAX_SHADER_STORAGE_BLOCK_SIZE) }.max(0) as u64;
    if bytes <= greatest {
        return Ok(());
    }
    Err(Error(format!(
        "`{name}` needs {bytes} bytes, and GL_MAX_SHADER_STORAGE_BLOCK_SIZE is {greatest}: set a smaller `fragments`, or draw a smaller frame"
    )))
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        let gl = &self.context.gl;
        self.memory.values().for_each(|memory| memory.delete(gl));
        self.output.delete(gl);
        // SAFETY: the context is current, and nothing draws with these objects any more.
        unsafe {
            self.programs.values().for_each(|program| gl.delete_program(*program));
            self.vertices.iter().chain(&self.blocks).for_each(|buffer| gl.delete_buffer(*buffer));
            self.queries.values().flatten().for_each(|query| gl.delete_query(*query));
            gl.delete_vertex_array(self.layout);
        }
    }
}
