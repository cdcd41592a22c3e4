//! What a caller sees: a device for one plan at one size, meshes in, pictures out.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use fragbuf_codegen::Plan;
use fragbuf_frame::{
    Counters, Counting, Looped, PassTime, Sizing, Value, Values, resource, room_after, set, unsupported, values, zeros,
};
use fragbuf_templates::vocabulary::{Element, TextureFormat};

use crate::memory::{Memory, read};
use crate::{Code, Error, frame};

/// What a caller decides.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Width of the frame, in pixels.
    pub width: u32,
    /// Height of the frame, in pixels.
    pub height: u32,
    /// How much room is made for fragments whose number no one knows beforehand.
    pub sizing: Sizing,
    /// In which order fragments of one pixel run.
    pub order: Order,
}

/// In which order fragments of one pixel run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// One after the other, as they were submitted.
    #[default]
    Submission,
    /// Shaders are permuted and interleaved from one shared access to the next, by this seed. The fixed function around them
    /// keeps the order of submission, as it does on every device: early tests come before all shaders of the pixel, late tests
    /// and blending after them.
    Shuffled(u64),
}

/// Triangles.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// Interleaved vertices, as words: the inputs of the vertex stage in the order of their locations, the position first.
    pub vertices: &'a [u32],
    /// Three per triangle.
    pub indices: &'a [u32],
}

/// How far a frame is.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The pass that is running.
    pub pass: &'a str,
    /// How much of it is done, from 0 to 1.
    pub share: f64,
}

/// A frame, drawn.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Premultiplied red, green, blue and alpha, row after row from the top.
    pub pixels: Vec<[f32; 4]>,
    /// The time that each pass took, in the order of the plan.
    pub times: Vec<PassTime>,
    /// What the frame counted; `None`: the plan counts nothing.
    pub counters: Option<Counters>,
    /// Passes that went out of bounds: they read 0 there, and wrote nothing.
    pub out_of_bounds: Vec<String>,
    /// Samples that passed all tests in the last run of each pass, in the order of the plan; 0 for those that draw nothing.
    pub samples: Vec<u64>,
    /// The loops that wait for something, in the order of the plan.
    pub loops: Vec<Looped>,
}

/// Runs one plan.
#[derive(Debug)]
pub struct Device {
    pub(crate) code: Arc<Code>,
    pub(crate) settings: Settings,
    pub(crate) values: Values,
    pub(crate) counting: Counting,
    pub(crate) memory: Memory,
    pub(crate) uniforms: Vec<u32>,
    pub(crate) camera: Vec<u32>,
    pub(crate) objects: Vec<Range<u32>>,
    /// Textures that the caller has not brought yet.
    missing: BTreeSet<usize>,
}

/// The camera before any is set: positions are clip space.
const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

impl Device {
    /// Makes room for a frame.
    pub fn new(code: Arc<Code>, settings: Settings) -> Result<Self, Error> {
        if settings.width == 0 || settings.height == 0 || settings.width.max(settings.height) > LARGEST {
            let wanted = format!("from 1 to {LARGEST} pixels along each side");
            return Err(fragbuf_frame::Error::BadValue { name: "the frame's size".to_owned(), wanted }.into());
        }
        let (values, counting) = values(&code.plan, (settings.width, settings.height), settings.sizing)?;
        let mut memory = Memory::default();
        memory.resize(&code.plan, &values)?;
        let uniforms = zeros(&code.plan.variant.uniforms);
        let resources = code.plan.resources.iter().enumerate();
        let missing = resources.filter(|(_, planned)| planned.is_brought()).map(|(index, _)| index).collect();
        let (camera, objects) = (Vec::new(), Vec::new());
        let mut device = Device { code, settings, values, counting, memory, uniforms, camera, objects, missing };
        device.set_camera(&IDENTITY);
        Ok(device)
    }

    /// The view-projection matrix, column by column: from positions to clip space, z from 0 to 1.
    pub fn set_camera(&mut self, view_projection: &[f32; 16]) {
        self.camera = view_projection.iter().map(|number| number.to_bits()).collect();
    }

    /// The objects of the meshes to come, which can be seen or not: a part of the index list each. None: all is one object.
    pub fn set_objects(&mut self, objects: &[Range<u32>]) {
        self.objects = objects.to_vec();
    }

    /// One of the description's own uniforms.
    pub fn set_uniform(&mut self, name: &str, value: Value) -> Result<(), Error> {
        Ok(set(&mut self.uniforms, &self.code.plan.variant.uniforms, name, value)?)
    }

    /// Brings a texture that the plan has and does not make (`init: host` in the manifest), filled: one number for each texel,
    /// row after row from the top. It is only read, from the next frame on, until another takes its place.
    pub fn set_texture(&mut self, name: &str, texels: &[f32]) -> Result<(), Error> {
        let plan = &self.code.plan;
        let index = resource(plan, name)?.0;
        let (width, height) = (self.settings.width, self.settings.height);
        let is_float =
            |element| matches!(element, Element::Texture(TextureFormat::Depth32Float | TextureFormat::R32Float));
        let bad = |wanted: String| fragbuf_frame::Error::BadValue { name: format!("the texture `{name}`"), wanted };
        let planned = &plan.resources[index];
        if !planned.is_brought() {
            return Err(bad("left to the plan, which makes it itself".to_owned()).into());
        }
        if !is_float(planned.resource.element) || planned.resource.extents.len() > 1 {
            return Err(unsupported(format!("`{name}`, which has more than one number for a pixel")).into());
        }
        if texels.len() != width as usize * height as usize {
            let found = texels.len();
            return Err(bad(format!("as large as the frame, {width} x {height} texels; it has {found}")).into());
        }
        for (word, texel) in self.memory.resources[index].iter_mut().zip(texels) {
            *word.get_mut() = texel.to_bits();
        }
        self.missing.remove(&index);
        Ok(())
    }

    /// A whole frame. `progress` hears from several threads how far it is. Fails where a texture is missing that the caller
    /// brings.
    pub fn render(&mut self, mesh: &Mesh<'_>, progress: &(dyn Fn(Stage<'_>) + Sync)) -> Result<Picture, Error> {
        if let Some(planned) = self.missing.first().and_then(|index| self.code.plan.resources.get(*index)) {
            let wanted = "brought before a frame begins, as large as the frame: `Device::set_texture`".to_owned();
            let name = format!("the texture `{}`", planned.resource.name);
            return Err(fragbuf_frame::Error::BadValue { name, wanted }.into());
        }
        frame::render(self, mesh, progress)
    }

    /// What is run.
    pub fn plan(&self) -> &Plan {
        &self.code.plan
    }

    /// All words of a resource, as the last frame left them. `None`: the plan does not have it.
    pub fn words(&self, name: &str) -> Option<Vec<u32>> {
        let id = resource(&self.code.plan, name).ok()?;
        self.memory.resources.get(id.0).map(|words| read(words))
    }

    /// The value of a symbol of the plan's formulas.
    pub fn symbol(&self, name: &str) -> Option<u64> {
        self.values.named(name)
    }

    /// Fragments that a pixel keeps; `None`: all.
    pub fn k(&self) -> Option<u32> {
        self.values.k()
    }

    /// Bytes of all resources.
    pub fn allocated_bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// Room, in fragments, after a frame that lost `short` of them for want of it.
    pub fn room_after(&self, short: u32) -> u64 {
        room_after(&self.code.plan, &self.values, short)
    }
}

/// Pixels along a side: within it, coordinates are exact in 256ths.
const LARGEST: u32 = 1 << 15;
