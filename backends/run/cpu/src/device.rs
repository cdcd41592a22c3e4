//! The CPU device: runs one plan at one frame size.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use fragbuf_codegen::Plan;
use fragbuf_frame::{
    LaggedValues, MemoryLimits, Readbacks, Value, Values, described_texture, initial_values, pool_size_after, resource,
    set_uniform, unsupported, zero_uniforms,
};
use fragbuf_templates::vocabulary::{Element, TextureFormat};

use crate::bound_texture::DescribedTexture;
use crate::memory::{Memory, memory_limits, read, zeros};
use crate::settings::Settings;
use crate::{Code, Error};

/// A device that runs one plan.
#[derive(Debug)]
pub struct Device {
    pub(crate) code: Arc<Code>,
    pub(crate) settings: Settings,
    pub(crate) values: Values,
    pub(crate) limits: MemoryLimits,
    pub(crate) readbacks: Readbacks,
    /// The decisions of earlier frames that later ones use.
    pub(crate) lag: LaggedValues,
    pub(crate) memory: Memory,
    pub(crate) uniforms: Vec<u32>,
    pub(crate) camera: Vec<u32>,
    pub(crate) objects: Vec<Range<u32>>,
    /// The textures of the description that the caller has set, by their bindings.
    pub(crate) textures: BTreeMap<u32, DescribedTexture>,
    /// External textures that the caller has not set yet.
    pub(crate) missing: BTreeSet<usize>,
}

/// The default camera: positions are clip-space positions.
const IDENTITY: [f32; 16] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

impl Device {
    /// Allocates the resources of a frame, in slices that fit into the memory of the settings.
    pub fn new(code: Arc<Code>, settings: Settings) -> Result<Self, Error> {
        if settings.width == 0 || settings.height == 0 || settings.width.max(settings.height) > MAX_SIDE {
            let expected = format!("from 1 to {MAX_SIDE} pixels along each side");
            return Err(fragbuf_frame::Error::BadValue { name: "the size of the frame".to_owned(), expected }.into());
        }
        let (values, readbacks) = initial_values(&code.plan, (settings.width, settings.height), settings.sizing)?;
        let limits = memory_limits(settings.memory);
        let values = values.with_rows(limits.rows(&code.plan, &values, settings.slice)?);
        let mut memory = Memory::default();
        memory.resize(&code.plan, &values, &limits)?;
        let uniforms = zero_uniforms(&code.plan.variant.uniforms);
        let resources = code.plan.resources.iter().enumerate();
        let missing = resources.filter(|(_, planned)| planned.is_external()).map(|(index, _)| index).collect();
        let (camera, objects, textures) = (Vec::new(), Vec::new(), BTreeMap::new());
        let lag = LaggedValues::new(&code.plan, settings.decisions);
        let mut device = Device {
            code,
            settings,
            values,
            limits,
            readbacks,
            lag,
            memory,
            uniforms,
            camera,
            objects,
            textures,
            missing,
        };
        device.set_camera(&IDENTITY);
        Ok(device)
    }

    /// Sets the view-projection matrix, column by column: from positions to clip space, z from 0 to 1.
    pub fn set_camera(&mut self, view_projection: &[f32; 16]) {
        self.camera = view_projection.iter().map(|number| number.to_bits()).collect();
    }

    /// Sets the objects of later meshes, as ranges of the index list. An empty list: the mesh is one object.
    pub fn set_objects(&mut self, objects: &[Range<u32>]) {
        self.objects = objects.to_vec();
    }

    /// Sets a uniform of the description.
    pub fn set_uniform(&mut self, name: &str, value: Value) -> Result<(), Error> {
        Ok(set_uniform(&mut self.uniforms, &self.code.plan.variant.uniforms, name, value)?)
    }

    /// Sets an external texture of the plan (`init: external` in the manifest): one number per texel, row after row from the
    /// top. Frames read it until the caller sets another.
    pub fn set_texture(&mut self, name: &str, texels: &[f32]) -> Result<(), Error> {
        let plan = &self.code.plan;
        let index = resource(plan, name)?.0;
        let (width, height) = (self.settings.width, self.settings.height);
        let is_float =
            |element| matches!(element, Element::Texture(TextureFormat::Depth32Float | TextureFormat::R32Float));
        let bad = |expected: String| fragbuf_frame::Error::BadValue { name: format!("the texture `{name}`"), expected };
        let planned = &plan.resources[index];
        if !planned.is_external() {
            return Err(bad("left to the plan, which creates it".to_owned()).into());
        }
        if !is_float(planned.resource.element) || planned.resource.extents.len() > 1 {
            return Err(unsupported(format!("`{name}`, which has more than one number per pixel")).into());
        }
        if texels.len() != width as usize * height as usize {
            let found = texels.len();
            return Err(bad(format!("as large as the frame, {width} x {height} texels, but has {found}")).into());
        }
        for (word, texel) in self.memory.resources[index].iter_mut().zip(texels) {
            *word.get_mut() = texel.to_bits();
        }
        self.missing.remove(&index);
        Ok(())
    }

    /// Sets a texture of the description, by the name that it has there. `size`: columns, rows and slices, 1 for a texture of two
    /// dimensions; four channels per texel, row after row, slice after slice. Frames read it until the caller sets another.
    pub fn set_description_texture(&mut self, name: &str, size: [u32; 3], texels: &[[f32; 4]]) -> Result<(), Error> {
        let number = described_texture(&self.code.plan, name, size)?;
        let count = size.iter().map(|length| u64::from(*length)).product::<u64>();
        if texels.len() as u64 != count {
            let expected =
                format!("of {count} texels, {} x {} x {}, but has {}", size[0], size[1], size[2], texels.len());
            return Err(fragbuf_frame::Error::BadValue { name: format!("the texture `{name}`"), expected }.into());
        }
        let bytes = count.saturating_mul(size_of::<[f32; 4]>() as u64);
        let left = self.limits.left(&self.code.plan, &self.values)?;
        if bytes > left {
            let expected = format!("at most {left} bytes, which the memory budget leaves, but needs {bytes}");
            return Err(fragbuf_frame::Error::BadValue { name: format!("the texture `{name}`"), expected }.into());
        }
        let mut words = zeros(name, bytes)?;
        for (word, value) in words.iter_mut().zip(texels.iter().flatten()) {
            *word.get_mut() = value.to_bits();
        }
        let binding = self.code.plan.resources[number.0].binding;
        self.textures.insert(binding, DescribedTexture { size, words });
        self.missing.remove(&number.0);
        Ok(())
    }

    /// Returns the plan.
    pub fn plan(&self) -> &Plan {
        &self.code.plan
    }

    /// Returns the number of slices of the frame.
    pub fn slices(&self) -> u32 {
        self.values.slices()
    }

    /// Returns the words of a resource after the last frame; `None` if the plan does not have it. A texture has the whole frame; a
    /// buffer has the last slice.
    pub fn words(&self, name: &str) -> Option<Vec<u32>> {
        let id = resource(&self.code.plan, name).ok()?;
        self.memory.resources.get(id.0).map(|words| read(words))
    }

    /// Returns the value of a symbol of the plan's formulas.
    pub fn symbol(&self, name: &str) -> Option<u64> {
        self.values.named(name)
    }

    /// Returns the number of fragments that a pixel keeps; `None`: all.
    pub fn k(&self) -> Option<u32> {
        self.values.k()
    }

    /// Returns the size of all resources in bytes.
    pub fn allocated_bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// Returns the pool size, in fragments, for the frame after one that lost `short` fragments to overflow.
    pub fn pool_size_after(&self, short: u32) -> u64 {
        pool_size_after(&self.code.plan, &self.values, short)
    }
}

/// The most pixels along a side: within it, coordinates in 256ths are exact.
const MAX_SIDE: u32 = 1 << 15;
