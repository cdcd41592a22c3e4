//! A plan on a device: what a caller sets and draws, and what it gets back.

use std::sync::Arc;

use ash::vk;
use fragbuf_follow::manifest::{Manifest, Objects, Plan, VertexInput, ViewDimension};
use fragbuf_follow::{Image, Scene, Texels, Uniforms, Values, Walk};

use crate::context::Context;
use crate::engine::{Engine, Frame};
use crate::gpu::Gpu;
use crate::memory::Texture;
use crate::names::TEXEL_FORMATS;
use crate::pipeline::vertex_bytes;
use crate::requirements::check;
use crate::{Error, OUTPUT, TARGET};

/// A plan on a Vulkan device, with memory for one size of the frame.
pub struct Host<'c> {
    engine: Engine<'c>,
    context: &'c Context,
    values: Values,
    walk: Walk,
    /// The rows of a slice; all for `None`.
    rows: Option<u32>,
    uniforms: Uniforms,
}

impl<'c> Host<'c> {
    /// Creates a device with what the plan requires, loads every pass, and prepares frames of this size. `manifest`
    /// is the text of `manifest.json`; `read` returns the bytes of a file that it names.
    pub fn new(
        context: &'c Context,
        manifest: &str,
        read: &dyn Fn(&str) -> Result<Vec<u8>, Error>,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let (files, plan) = Manifest::parse(manifest, TARGET)?;
        if plan.vertex_inputs.is_empty() {
            return Err(Error("the manifest is in module form: generate it with `--form program`".to_owned()));
        }
        let plan = Arc::new(plan);
        check_size(context, size)?;
        let values = Values::new(plan.clone(), size);
        let requirements = check(context, &plan, &values)?;
        let gpu = Gpu::new(context, &requirements)?;
        let host = Host {
            engine: Engine::new(context, gpu, (plan.clone(), &files), read, size)?,
            context,
            walk: Walk::new(plan.clone()),
            rows: None,
            uniforms: Uniforms::new(&plan),
            values,
        };
        context.check()?;
        Ok(host)
    }

    /// The inputs of a vertex, in their order.
    pub fn vertex_inputs(&self) -> &[VertexInput] {
        &self.engine.plan.vertex_inputs
    }

    /// The plan that the host follows.
    pub fn plan(&self) -> &Plan {
        &self.engine.plan
    }

    /// Sets a symbol, such as `k`, from the next frame on.
    pub fn set_symbol(&mut self, name: &str, value: u64) -> Result<(), Error> {
        self.values.set(name, value)
    }

    /// Sets a uniform of the description.
    pub fn set_uniform(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        self.uniforms.set(name, bytes)
    }

    /// Sets the texels of a texture that the engine supplies, row by row from the top. A new size needs new texels.
    pub fn set_texture(&mut self, name: &str, texels: &[u8]) -> Result<(), Error> {
        let resource = self.engine.plan.resource(name).filter(|resource| resource.init == "external");
        resource.ok_or_else(|| Error(format!("the plan has no external texture `{name}`")))?;
        let texture = self.engine.texture(name, &self.values)?;
        self.engine.write_texture(texture, name, texels)?;
        self.context.check()
    }

    /// Sets a texture of the description, by its name there. It is kept until the frame is resized.
    pub fn set_texels(&mut self, name: &str, texels: &Texels<'_>) -> Result<(), Error> {
        let limits = &self.engine.gpu.limits;
        let most = [limits.max_image_dimension2_d, limits.max_image_dimension3_d];
        let plan = self.engine.plan.clone();
        let (resource, dimension) = texels.resource(&plan, name, most)?;
        let [width, height, slices] = texels.size;
        let slices = (dimension == ViewDimension::D3).then_some(slices);
        let kind = (&TEXEL_FORMATS[..], vk::SampleCountFlags::TYPE_1, false);
        let what = format!("the texture `{name}`");
        let texture = Texture::with_slices(self.context, &self.engine.gpu, &what, kind, ([width, height], slices))?;
        self.engine.write_texture(texture, &resource.name, &texels.bytes())?;
        self.context.check()
    }

    /// Draws slices of this number of rows, one after the other, so that buffers need less memory. `None`: the whole
    /// frame.
    pub fn set_rows(&mut self, rows: Option<u32>) -> Result<(), Error> {
        if rows == Some(0) {
            return Err(Error("a slice of 0 rows: set 1 at least".to_owned()));
        }
        let [_, height] = self.engine.size;
        if self.engine.plan.whole_frame && rows.is_some_and(|rows| rows < height) {
            let reason = "closures read images of the description at other pixels";
            return Err(Error(format!("slices of fewer rows than the {height} of the frame: {reason}")));
        }
        self.rows = rows;
        Ok(())
    }

    /// Resizes the frame. Pipelines stay.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), Error> {
        check_size(self.context, size)?;
        let values = self.values.resized(size);
        check(self.context, &self.engine.plan, &values)?;
        self.values = values;
        self.walk = Walk::new(self.engine.plan.clone());
        self.engine.reset(size)
    }

    /// Draws a frame over a background and reads the image back.
    pub fn render(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<Image, Error> {
        self.uniforms.bytes()?;
        let stride = vertex_bytes(&self.engine.plan.vertex_inputs);
        check_scene(scene, stride)?;
        let has_boxes = self.engine.plan.passes().any(|(_, pass)| matches!(pass.objects, Objects::Boxes));
        let boxes = if has_boxes { scene.boxes(stride) } else { Vec::new() };
        self.engine.upload(scene, &boxes)?;
        let rendered = self.frame(scene, background).and_then(|image| self.context.check().map(|()| image));
        if rendered.is_err() {
            // What was recorded has not run, so the notes about the state of memory are wrong.
            self.engine.reset(self.engine.size)?;
            self.walk = Walk::new(self.engine.plan.clone());
        }
        rendered
    }

    fn frame(&mut self, scene: &Scene<'_>, background: [f32; 4]) -> Result<Image, Error> {
        let [_, height] = self.engine.size;
        let rows = self.rows.unwrap_or(height).min(height);
        let plan = self.engine.plan.clone();
        let mut counts = vec![0; plan.counters.len()];
        let (mut first_row, mut swapped) = (0, Vec::new());
        while first_row < height {
            self.values.begin_slice(first_row, rows.min(height - first_row));
            self.engine.allocate(&self.values)?;
            if first_row == 0 {
                self.engine.clear(OUTPUT, 0, Some(&background.as_slice().into()))?;
            }
            let mut frame = Frame { engine: &mut self.engine, scene, uniforms: &self.uniforms };
            let size = frame.engine.size;
            swapped = self.walk.run(&mut self.values, (scene, size), &mut frame)?;
            // The next slice clears them.
            for (count, value) in counts.iter_mut().zip(self.counters()?) {
                *count += u64::from(value);
            }
            first_row += rows;
        }
        self.walk.end_frame(swapped);
        let pixels = self.engine.image()?;
        let counted = || plan.counters.iter().zip(&counts);
        Ok(Image {
            pixels,
            counters: counted().map(|(counter, count)| (counter.name.clone(), *count)).collect(),
            lost: counted().filter(|(counter, _)| counter.is_loss).map(|(_, count)| count).sum(),
        })
    }

    /// Reads the counters of a slice in their order.
    fn counters(&mut self) -> Result<Vec<u32>, Error> {
        let plan = self.engine.plan.clone();
        let Some(last) = plan.counters.iter().map(|counter| counter.index as u64).max() else { return Ok(Vec::new()) };
        let words = self.engine.words("counters", 0, last.saturating_add(1))?;
        Ok(plan.counters.iter().map(|counter| words.get(counter.index).copied().unwrap_or(0)).collect())
    }

    /// All words of a buffer after a frame, with [`Self::set_rows`] those of the last slice.
    pub fn words(&mut self, resource: &str) -> Result<Vec<u32>, Error> {
        let known = self.engine.plan.resource(resource);
        let known = known.ok_or_else(|| Error(format!("there is no resource `{resource}`")))?;
        let count = self.values.value(&known.words, 0)?;
        let words = self.engine.words(resource, 0, count)?;
        self.context.check()?;
        Ok(words)
    }
}

/// Checks that a device can draw frames of a size.
fn check_size(context: &Context, [width, height]: [u32; 2]) -> Result<(), Error> {
    if width == 0 || height == 0 {
        return Err(Error(format!("a frame of {width} × {height} pixels: it needs one pixel at least")));
    }
    let vk::PhysicalDeviceLimits { max_framebuffer_width, max_framebuffer_height, max_viewport_dimensions, .. } =
        context.properties().limits;
    let most = [max_framebuffer_width, max_framebuffer_height];
    let most = [most[0].min(max_viewport_dimensions[0]), most[1].min(max_viewport_dimensions[1])];
    if width > most[0] || height > most[1] {
        return Err(Error(format!(
            "a frame of {width} × {height} pixels: the device `{}` draws {} × {} at most",
            context.name, most[0], most[1]
        )));
    }
    Ok(())
}

/// Checks that the vertices of a scene are whole, and that those of its objects exist.
fn check_scene(scene: &Scene<'_>, stride: usize) -> Result<(), Error> {
    let count = scene.vertices.len() / stride.max(1);
    if stride == 0 || !scene.vertices.len().is_multiple_of(stride) {
        return Err(Error(format!("{} bytes are no whole vertices of {stride} bytes", scene.vertices.len())));
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let end = u64::from(object.first) + u64::from(object.count);
        if end > count as u64 || !object.count.is_multiple_of(3) {
            return Err(Error(format!(
                "object {index} has {} vertices from {} on: the scene has {count}, and a triangle has 3",
                object.count, object.first
            )));
        }
    }
    Ok(())
}
