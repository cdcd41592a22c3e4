//! A plan on a device: its programs, memory, symbols and uniforms. `frame` runs its steps.

use std::collections::BTreeMap;

use glow::HasContext as _;

use crate::formula::evaluate;
use crate::frame::Frame;
use crate::manifest::{File, Manifest, Plan, Resource, VertexInput};
use crate::memory::{Format, Memory};
use crate::program::{check_features, compile};
use crate::{Context, Error};

/// A scene: vertices as the vertex inputs lie one after the other, and objects in the order of drawing.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The bytes of all vertices.
    pub vertices: &'a [u8],
    /// The objects.
    pub objects: &'a [Object],
    /// From model space to clip space, column by column.
    pub view_projection: [f32; 16],
}

/// Vertices of a scene that are drawn, or not drawn, together.
#[derive(Clone, Copy, Debug)]
pub struct Object {
    /// The first vertex.
    pub first: u32,
    /// The number of vertices, three per triangle.
    pub count: u32,
    /// The least and the greatest corner of the object's box.
    pub bounds: [[f32; 3]; 2],
}

/// An image: red, green, blue and alpha, row by row from the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// The pixels.
    pub pixels: Vec<[f32; 4]>,
    /// The counters of the frame, by name.
    pub counters: BTreeMap<String, u32>,
}

/// A plan on an OpenGL context, with memory for one size of the frame.
pub struct Host<'c> {
    pub(crate) context: &'c Context,
    pub(crate) plan: Plan,
    pub(crate) size: [i32; 2],
    pub(crate) programs: BTreeMap<String, glow::Program>,
    pub(crate) output: Memory,
    layout: glow::VertexArray,
    /// Where the time of each pass is recorded, if it is measured. Each pass then waits for the one before it.
    pub pass_times: Option<Vec<(String, std::time::Duration)>>,
    /// The vertices of the scene, and those of its boxes.
    pub(crate) vertices: [glow::Buffer; 2],
    memory: BTreeMap<String, Memory>,
    symbols: BTreeMap<String, u64>,
    uniforms: Vec<u8>,
    blocks: Vec<glow::Buffer>,
}

impl<'c> Host<'c> {
    /// Compiles every pass and prepares frames of this size. `manifest` is the text of `manifest.json`; `read` returns the text of a
    /// file that it names.
    pub fn new(
        context: &'c Context,
        manifest: &str,
        read: &dyn Fn(&str) -> Result<String, Error>,
        [width, height]: [u32; 2],
    ) -> Result<Self, Error> {
        let gl = &context.gl;
        let (files, plan) = Manifest::parse(manifest, "glsl")?;
        check_features(gl, &plan.features)?;
        if let Some(external) = plan.resources.iter().find(|resource| resource.init == "external") {
            return Err(Error(format!(
                "`{}` is written by the engine, and this host has no pass that does",
                external.name
            )));
        }
        let mut passes: BTreeMap<&str, Vec<&File>> = BTreeMap::new();
        files.iter().for_each(|file| passes.entry(&file.pass).or_default().push(file));
        let programs = passes.into_iter().map(|(pass, files)| Ok((pass.to_owned(), compile(gl, &files, read)?)));
        let programs = programs.collect::<Result<_, Error>>()?;
        let size = [width as i32, height as i32];
        let uniforms = plan.uniform_blocks.iter().find(|block| block.name == "uniforms");
        // SAFETY: the context is current.
        let layout = unsafe { gl.create_vertex_array() }.map_err(Error)?;
        // SAFETY: the context is current.
        let create = || unsafe { gl.create_named_buffer() }.map_err(Error);
        Ok(Host {
            context,
            size,
            programs,
            layout,
            pass_times: None,
            output: Memory::texture(gl, Format::OUTPUT, 1, size)?,
            vertices: [create()?, create()?],
            memory: BTreeMap::new(),
            symbols: BTreeMap::from([("width".to_owned(), width.into()), ("height".to_owned(), height.into())]),
            uniforms: vec![0; uniforms.map_or(0, |block| block.bytes)],
            blocks: plan.uniform_blocks.iter().map(|_| create()).collect::<Result<_, Error>>()?,
            plan,
        })
    }

    /// The inputs of a vertex, in their order.
    pub fn vertex_inputs(&self) -> &[VertexInput] {
        &self.plan.vertex_inputs
    }

    /// Sets a symbol, such as `k`.
    pub fn set_symbol(&mut self, name: &str, value: u64) {
        self.symbols.insert(name.to_owned(), value);
    }

    /// Sets a uniform of the description.
    pub fn set_uniform(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let block = self.plan.uniform_blocks.iter().find(|block| block.name == "uniforms");
        let field = block.and_then(|block| block.fields.iter().find(|field| field.name == name));
        let offset = field.ok_or_else(|| Error(format!("no uniform `{name}`")))?.offset;
        let place = self.uniforms.get_mut(offset..offset + bytes.len());
        place.ok_or_else(|| Error(format!("{} bytes for the uniform `{name}`", bytes.len())))?.copy_from_slice(bytes);
        Ok(())
    }

    /// Draws a frame over a background, without reading it back. The vertices are those of the last call of [`Self::render`].
    pub fn draw(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<(), Error> {
        self.output.clear(self.context, 0, &background.as_slice().into());
        // SAFETY: the context is current.
        unsafe { self.context.gl.bind_vertex_array(Some(self.layout)) };
        Frame::run(self, scene)
    }

    /// Draws a frame over a background and reads the image back.
    pub fn render(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<Image, Error> {
        self.upload(scene)?;
        self.draw(scene, background)?;
        let gl = &self.context.gl;
        // SAFETY: the context is current.
        let error = unsafe { gl.get_error() };
        if error != glow::NO_ERROR {
            return Err(Error(format!("OpenGL reports error {error:#x}")));
        }
        let counters = self.words("counters");
        let value = |index: usize| counters.get(index).copied().unwrap_or(0);
        let counters = self.plan.counters.iter().map(|counter| (counter.name.clone(), value(counter.index)));
        Ok(Image { pixels: self.output.texels(gl, self.size), counters: counters.collect() })
    }

    /// All words of a buffer after a frame.
    pub fn words(&self, resource: &str) -> Vec<u32> {
        self.memory.get(resource).map(|memory| memory.words(&self.context.gl, 0, u64::MAX)).unwrap_or_default()
    }

    pub(crate) fn resource(&self, name: &str) -> Result<&Resource, Error> {
        let resource = self.plan.resources.iter().find(|resource| resource.name == name);
        resource.ok_or_else(|| Error(format!("no resource `{name}`")))
    }

    pub(crate) fn memory(&self, name: &str) -> Result<Memory, Error> {
        self.memory.get(name).copied().ok_or_else(|| Error(format!("`{name}` has no memory yet")))
    }

    /// Forgets symbols that a step of the frame sets.
    pub(crate) fn forget(&mut self, symbol: &str) {
        self.symbols.remove(symbol);
    }

    /// Exchanges the memory of two resources.
    pub(crate) fn exchange(&mut self, [one, other]: &[String; 2]) {
        if let (Some(first), Some(second)) = (self.memory.remove(one), self.memory.remove(other)) {
            self.memory.insert(one.clone(), second);
            self.memory.insert(other.clone(), first);
        }
    }

    /// Creates the memory of every resource whose size is known and has changed.
    pub(crate) fn allocate(&mut self) -> Result<(), Error> {
        for resource in self.plan.resources.clone() {
            let Ok(words) = self.value(&resource.words, 0) else { continue };
            match self.memory.get(&resource.name) {
                Some(Memory::Texture { .. }) => continue,
                Some(Memory::Buffer { words: present, .. }) if *present == words => continue,
                present => present.into_iter().for_each(|memory| memory.delete(&self.context.gl)),
            }
            let memory = Memory::of(&self.context.gl, &resource, self.size, &|formula| self.value(formula, 0))?;
            memory.clear(self.context, 0, &serde_json::Value::Null);
            self.memory.insert(resource.name, memory);
        }
        Ok(())
    }

    /// Returns the value of a formula in this iteration of the innermost loop.
    pub(crate) fn value(&self, formula: &str, iteration: u64) -> Result<u64, Error> {
        evaluate(formula, &|name| self.symbol(name, iteration))
    }

    /// Returns the bytes of all buffers if symbols had these values.
    pub(crate) fn bytes(&self, assumed: &[(&str, u64)]) -> Result<u64, Error> {
        let value = |name: &str| {
            let assumed = assumed.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
            assumed.or_else(|| self.symbol(name, 0))
        };
        let buffers = self.plan.resources.iter().filter(|resource| resource.texture.is_none());
        buffers.map(|resource| Ok(4 * evaluate(&resource.words, &value)?)).sum()
    }

    fn symbol(&self, name: &str, iteration: u64) -> Option<u64> {
        match name {
            "iteration" => return Some(iteration),
            // This host draws the frame as a whole.
            "first_row" => return Some(0),
            _ => {}
        }
        let stated = self.plan.symbols.iter().find(|symbol| symbol.name == name);
        let set = self.symbols.get(name).or(self.plan.constants.get(name)).copied();
        set.or(stated.and_then(|symbol| symbol.value)).or_else(|| {
            let default = stated?.default.as_ref()?;
            self.value(default, iteration).ok()
        })
    }

    /// Writes the uniform blocks for a pass and binds them.
    pub(crate) fn bind_blocks(&self, scene: &Scene<'_>, iteration: u64) {
        let gl = &self.context.gl;
        for (block, buffer) in self.plan.uniform_blocks.iter().zip(&self.blocks) {
            let mut bytes = vec![0; block.bytes];
            match block.name.as_str() {
                "uniforms" => bytes.copy_from_slice(&self.uniforms),
                "camera" => bytes = scene.view_projection.iter().flat_map(|value| value.to_le_bytes()).collect(),
                _ => block.fields.iter().for_each(|field| {
                    let value = self.symbol(&field.name, iteration).unwrap_or(0) as u32;
                    bytes[field.offset..field.offset + 4].copy_from_slice(&value.to_le_bytes());
                }),
            }
            // SAFETY: the context is current.
            unsafe {
                gl.named_buffer_data_u8_slice(*buffer, &bytes, glow::DYNAMIC_DRAW);
                gl.bind_buffer_base(glow::UNIFORM_BUFFER, block.opengl_binding, Some(*buffer));
            }
        }
    }
}
