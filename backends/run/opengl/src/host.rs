//! A plan on a context: what a caller sets, and frames. `fragbuf_follow` walks through the steps of a frame, `device` carries them out.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_follow::manifest::{Counter, File, Manifest, Plan, VertexInput};
use fragbuf_follow::{Device as _, Image, Scene, Texels, Values, Walk};
use glow::HasContext as _;

use crate::device::Device;
use crate::memory::Memory;
use crate::program::compile;
use crate::{Context, Error, Material, limits};

/// A plan on a context, with memory for one size of the frame.
pub struct Host<'c> {
    plan: Arc<Plan>,
    values: Values,
    walk: Walk,
    device: Device<'c>,
    /// Where the time of each pass is recorded, if it is measured. Each pass then waits for the one before it.
    pub pass_times: Option<Vec<(String, std::time::Duration)>>,
}

impl<'c> Host<'c> {
    /// Compiles passes in program form and prepares frames of this size. `manifest` is the text of `manifest.json`; `read` returns the text
    /// of a file that it names.
    pub fn new(
        context: &'c Context,
        manifest: &str,
        read: &dyn Fn(&str) -> Result<String, Error>,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let (files, plan) = Manifest::parse(manifest, context.api.target())?;
        if is_module(&files) {
            return Err(Error("the passes are in module form: they need a material".to_owned()));
        }
        Host::prepare(context, &files, plan, read, size, None)
    }

    /// As [`Self::new`], of passes in module form, whose geometry passes are functions that the material calls.
    pub fn with_material(
        context: &'c Context,
        manifest: &str,
        read: &dyn Fn(&str) -> Result<String, Error>,
        size: [u32; 2],
        material: &Material,
    ) -> Result<Self, Error> {
        let (files, mut plan) = Manifest::parse(manifest, context.api.target())?;
        if !is_module(&files) {
            return Err(Error("the passes are in program form: a material needs `--form module`".to_owned()));
        }
        plan.vertex_inputs = material.inputs.clone();
        Host::prepare(context, &files, plan, read, size, Some(material))
    }

    fn prepare(
        context: &'c Context,
        files: &[File],
        plan: Plan,
        read: &dyn Fn(&str) -> Result<String, Error>,
        size: [u32; 2],
        material: Option<&Material>,
    ) -> Result<Self, Error> {
        context.require(plan.extensions(context.api.target()))?;
        context.require(&context.api.extension_of_output().map(str::to_owned).into_iter().collect::<Vec<_>>())?;
        limits::check_uses(&plan)?;
        let plan = Arc::new(plan);
        let values = Values::new(plan.clone(), size);
        limits::check(context, &plan.limits, &|formula| values.value(formula, 0))?;
        let mut device = Device::new(context, plan.clone(), size)?;
        device.converts_z = material.is_some();
        let mut passes: BTreeMap<&str, Vec<&File>> = BTreeMap::new();
        files.iter().for_each(|file| passes.entry(&file.pass).or_default().push(file));
        for (pass, files) in passes {
            let program = compile(context, &files, read, material.map(|material| (material, plan.prefix.as_str())))?;
            device.programs.insert(pass.to_owned(), program);
        }
        Ok(Host { walk: Walk::new(plan.clone()), values, plan, device, pass_times: None })
    }

    /// The inputs of a vertex, in their order.
    pub fn vertex_inputs(&self) -> &[VertexInput] {
        &self.plan.vertex_inputs
    }

    /// Sets a symbol, such as `k`.
    pub fn set_symbol(&mut self, name: &str, value: u64) -> Result<(), Error> {
        self.values.set(name, value)
    }

    /// Sets a uniform of the description.
    pub fn set_uniform(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        self.device.uniforms.set(name, bytes)
    }

    /// The textures that the engine supplies, such as the depth of its opaque surfaces.
    pub fn external_textures(&self) -> impl Iterator<Item = &str> {
        let external = self.plan.resources.iter().filter(|resource| resource.init == "external");
        external.filter(|resource| resource.described().is_none()).map(|resource| resource.name.as_str())
    }

    /// Sets a texture of the description, by its name there. It is kept for all frames.
    pub fn set_texels(&mut self, name: &str, texels: &Texels<'_>) -> Result<(), Error> {
        self.device.set_texels(name, texels)
    }

    /// Sets the texels of an external texture: a number per pixel, row by row from the top. They are kept for all frames.
    pub fn set_texture(&mut self, name: &str, texels: &[f32]) -> Result<(), Error> {
        if !self.external_textures().any(|external| external == name) {
            return Err(Error(format!("no external texture `{name}`")));
        }
        self.device.set_texture(name, texels)
    }

    /// Draws a frame over a background, without reading it back. The vertices are those of the last call of [`Self::render`].
    pub fn draw(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<(), Error> {
        let mut external = self.plan.resources.iter().filter(|resource| resource.init == "external");
        if let Some(missing) = external.find(|resource| !self.device.has(&resource.name)) {
            let (described, missing) = (missing.described(), &missing.name);
            return Err(Error(match described {
                Some((name, _)) => {
                    format!("`{name}` is a texture of the description: set it with `set_texels` before the first frame")
                }
                None => format!("`{missing}` is a texture of the engine: set its texels before the first frame"),
            }));
        }
        self.device.uniforms.bytes()?;
        let size = self.device.size.map(|side| side as u32);
        self.values.begin_slice(0, size[1]);
        self.device.begin(scene, background, self.pass_times.is_some());
        self.device.allocate(&self.values)?;
        let swapped = self.walk.run(&mut self.values, (scene, size), &mut self.device)?;
        self.walk.end_frame(swapped);
        if let (Some(times), Some(measured)) = (&mut self.pass_times, self.device.pass_times.take()) {
            times.extend(measured);
        }
        Ok(())
    }

    /// Draws a frame over a background and reads the image back.
    pub fn render(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<Image, Error> {
        self.device.upload(scene)?;
        self.draw(scene, background)?;
        let gl = &self.device.context.gl;
        // SAFETY: the context is current.
        let error = unsafe { gl.get_error() };
        if error != glow::NO_ERROR {
            return Err(Error(format!("OpenGL reports error {error:#x}")));
        }
        let words = self.words("counters");
        let value = |counter: &Counter| u64::from(words.get(counter.index).copied().unwrap_or(0));
        let counters = self.plan.counters.iter().map(|counter| (counter.name.clone(), value(counter))).collect();
        let lost = self.plan.counters.iter().filter(|counter| counter.is_loss).map(value).sum();
        Ok(Image { pixels: self.device.output.texels(gl, self.device.size)?, counters, lost })
    }

    /// All words of a buffer after a frame.
    pub fn words(&self, resource: &str) -> Vec<u32> {
        let words = |memory: Memory| memory.words(&self.device.context.gl, 0, u64::MAX);
        self.device.memory(resource).map(words).unwrap_or_default()
    }
}

fn is_module(files: &[File]) -> bool {
    files.iter().any(|file| file.stage == "module")
}
