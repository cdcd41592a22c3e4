//! Generates the passes of a variant, opens hosts for them, and draws quads.

use fragbuf_codegen::{Form, Plan};
use fragbuf_model::Variant;
use fragbuf_targets::{Request, generate, manifest, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Technique;
use fragbuf_vulkan_host::{Context, Error, Host, Image, Scene, Settings, Validation};

use crate::hosts::scene::{Quad, vertices};
use crate::hosts::technique::{BACKGROUND, IDENTITY, k_of, objects, variant};

/// Opens the device that the environment variable `FRAGBUF_TEST_DEVICE` names, or the driver that is always there,
/// with the validation layer.
pub fn context(validation: Validation) -> Context {
    let device = std::env::var("FRAGBUF_TEST_DEVICE").unwrap_or_else(|_| "llvmpipe".to_owned());
    // `auto` is the device that the host chooses.
    let device = Some(device.as_str()).filter(|name| *name != "auto");
    // The mock driver has every extension, and does not report their features.
    let assume_features = device.is_some_and(|name| name.contains("Mock"));
    let context = Context::open(&Settings { device, validation, assume_features });
    context.unwrap_or_else(|error| {
        panic!("{error}; install Debian's packages mesa-vulkan-drivers and vulkan-validationlayers")
    })
}

/// Returns a technique with its k.
pub fn technique(technique: &Technique) -> Variant {
    let k = k_of(technique).map(|k| k.to_string());
    variant(&technique.key, &k.iter().map(|k| ("k", k.as_str())).collect::<Vec<_>>()).unwrap()
}

/// What `fragbuf generate --target spirv` writes.
pub struct Generated {
    pub manifest: String,
    pub files: Vec<(String, Vec<u8>)>,
    pub plan: Plan,
}

impl Generated {
    pub fn of(variant: &Variant, registry: &Registry) -> Self {
        let request = Request { targets: &[target("spirv").unwrap()], form: Form::Program, prefix: "", group: 0 };
        let mut generation =
            generate(variant, &request, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let files = generation.files.iter().map(|file| (file.path.clone(), file.bytes.clone())).collect();
        let manifest = manifest(&generation, 0).to_string();
        Generated { manifest, files, plan: generation.plans.remove(0).plan }
    }

    /// Opens a host.
    pub fn host<'c>(&self, context: &'c Context, size: [u32; 2]) -> Result<Host<'c>, Error> {
        let read = |path: &str| {
            let file = self.files.iter().find(|(known, _)| known == path);
            file.map(|(_, bytes)| bytes.clone()).ok_or_else(|| Error(format!("{path}: no such file")))
        };
        Host::new(context, &self.manifest, &read, size)
    }
}

pub fn inputs(host: &Host<'_>) -> Vec<String> {
    host.vertex_inputs().iter().map(|input| input.name.clone()).collect()
}

/// Draws quads over the background, one object each.
pub fn draw(host: &mut Host<'_>, quads: &[Quad], size: [u32; 2]) -> Result<Image, Error> {
    // Pools that no step of the frame sizes have room for every fragment.
    host.set_symbol("fragments", quads.len() as u64 * u64::from(size[0] * size[1]))?;
    let inputs = inputs(host);
    let vertices = vertices(quads, size, &inputs.iter().map(String::as_str).collect::<Vec<_>>());
    let objects = objects(quads);
    let [r, g, b] = BACKGROUND.map(|channel| channel as f32);
    host.render(&Scene { vertices: &vertices, objects: &objects, view_projection: IDENTITY }, [r, g, b, 1.0])
}
