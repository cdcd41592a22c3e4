//! Draws the textures that other descriptions supply, such as shadow maps.
//!
//! Input: a rendered texture, and the task that reads it. Output: what the description's effect returns for each pixel, as floats; 0 where there are
//! no fragments. The CPU device draws it, whatever device draws the image, so that the texture is equal on all devices.

use std::sync::Arc;

use fragbuf::{Diagnostics, Registry, Variant};
use fragbuf_cpu::{Code, Device, Error, Mesh, Settings};

use super::request::RenderTask;
use crate::cli::attributes::{check_sources, geometry};
use crate::cli::input::Input;
use crate::cli::memory::Budget;
use crate::cli::output::Failure;
use crate::cli::rendered_texture::RenderedTexture;
use crate::cli::uniforms;

/// Returns the texels, row after row from the top.
pub(super) fn draw(texture: &RenderedTexture, task: &RenderTask<'_>, memory: Budget) -> Result<Vec<[f32; 4]>, Failure> {
    let registry = Registry::builtin();
    let name = &texture.name;
    let mut input = match texture.effect()? {
        Some(effect) => Input::text(effect.path, effect.text),
        None => Input::read(&texture.description, &registry)?,
    };
    let variant = input.variant(&[], &registry)?;
    reject_textures(name, &variant)?;
    let scene = task.scene;
    check_sources(&[&variant], &scene.scene, &task.view.attributes)?;
    let code = Code::of(&variant, &registry).map_err(|error| failure(error, |errors| input.failure(errors)))?;
    let code = Arc::new(code);
    let geometry = geometry((&scene.scene, &task.view.attributes), &code.plan, memory)?;
    task.progress.set_message(format!("drawing the texture {name}"));
    let (width, height) = texture.size;
    let settings = Settings { memory: geometry.memory.left(), ..Settings::new(width, height) };
    let mut device = Device::new(code, settings)?;
    let subject = format!("`--texture {name}`: {}", texture.description);
    uniforms::warn_unset_as(&subject, ",uniform.", &texture.uniforms, &variant);
    for (name, value) in uniforms::values(&texture.uniforms, &variant, scene)? {
        device.set_uniform(&name, value)?;
    }
    let camera = scene.texture_cameras.iter().find(|(known, _)| known == name);
    let (_, camera) = camera.ok_or_else(|| Failure::Input(format!("the texture `{name}` has no camera")))?;
    device.set_camera(&camera.view_projection);
    let mesh = Mesh { vertices: &geometry.vertices, indices: &geometry.indices };
    Ok(device.render(&mesh, &|_| {})?.pixels)
}

/// Rejects descriptions that read textures themselves.
fn reject_textures(name: &str, variant: &Variant) -> Result<(), Failure> {
    match variant.textures.first() {
        None => Ok(()),
        Some(texture) => Err(Failure::Usage(format!(
            "`--texture {name}`: the description reads the texture `{}`, which cannot be given: use one without textures",
            texture.name.value
        ))),
    }
}

fn failure(error: Error, with_sources: impl FnOnce(Diagnostics) -> Failure) -> Failure {
    match error {
        Error::Diagnostics(diagnostics) => with_sources(diagnostics),
        other => other.into(),
    }
}
