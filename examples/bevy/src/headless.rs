//! Bevy without a window, for tests and pictures.
//!
//! Input: nothing. Output: an app whose renderer is ready, and the bytes of textures. Shaders are compiled before a frame ends, so that
//! every frame shows everything.

use std::time::{Duration, Instant};

use bevy::app::PluginsState;
use bevy::prelude::*;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::settings::{InstanceFlags, WgpuSettings};
use bevy::render::texture::GpuImage;
use bevy::render::{RenderApp, RenderPlugin};
use bevy::window::{ExitCondition, WindowPlugin};
use fragbuf_follow::Error;

use crate::Gpu;

/// How long the driver may take to open a device.
const PATIENCE: Duration = Duration::from_secs(60);

/// Returns an app with Bevy's plugins and no window. Add plugins, then call [`ready`].
pub fn app() -> App {
    let mut app = App::new();
    let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    // The validation layer of Debian 12 rejects every SPIR-V module whose source language is WGSL. That of wgpu stays on.
    let settings = WgpuSettings { instance_flags: InstanceFlags::VALIDATION_INDIRECT_CALL, ..default() };
    let render = RenderPlugin { synchronous_pipeline_compilation: true, render_creation: settings.into(), ..default() };
    app.add_plugins(DefaultPlugins.set(window).set(render));
    app
}

/// Waits for the device, and finishes the plugins.
pub fn ready(app: &mut App) -> Result<(), Error> {
    let begin = Instant::now();
    while app.plugins_state() == PluginsState::Adding {
        if begin.elapsed() > PATIENCE {
            return Err(Error(
                "no device was opened: install a Vulkan driver, such as Debian's mesa-vulkan-drivers".to_owned(),
            ));
        }
        bevy::tasks::tick_global_task_pools_on_main_thread();
        std::thread::sleep(Duration::from_millis(1));
    }
    app.finish();
    app.cleanup();
    Ok(())
}

/// Returns the device of the render world.
pub fn gpu(app: &App) -> Result<Gpu, Error> {
    let world = app.get_sub_app(RenderApp).map(SubApp::world);
    let device = world.and_then(|world| world.get_resource::<RenderDevice>());
    let queue = world.and_then(|world| world.get_resource::<RenderQueue>());
    let (Some(device), Some(queue)) = (device, queue) else {
        return Err(Error("the app has no renderer: add `RenderPlugin`, and call `ready`".to_owned()));
    };
    Ok(Gpu { device: device.wgpu_device().clone(), queue: (**queue.0).clone() })
}

/// Adds an image that cameras can draw into and [`image_texels`] can read.
pub fn target(app: &mut App, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> Handle<Image> {
    let mut image = Image::new_target_texture(width, height, format, None);
    image.texture_descriptor.usage |= wgpu::TextureUsages::COPY_SRC;
    app.world_mut().resource_mut::<Assets<Image>>().add(image)
}

/// Returns the bytes of an image after a frame, row by row.
pub fn image_texels(app: &App, image: &Handle<Image>) -> Result<Vec<u8>, Error> {
    let world = app.get_sub_app(RenderApp).map(SubApp::world);
    let images = world.and_then(|world| world.get_resource::<RenderAssets<GpuImage>>());
    let image = images.and_then(|images| images.get(image));
    let image = image.ok_or_else(|| Error("the image has not been drawn: call `update` before".to_owned()))?;
    texels(&gpu(app)?, &image.texture)
}

/// Waits for everything that has been submitted, and returns the bytes of a texture, row by row.
pub fn texels(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>, Error> {
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    let row = texel * texture.width();
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = crate::follower::staging(&gpu.device, u64::from(padded) * u64::from(texture.height()));
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("texels") });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
    let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), target, texture.size());
    gpu.queue.submit([encoder.finish()]);
    let bytes = crate::follower::wait(gpu, &buffer)?;
    Ok(bytes.chunks(padded as usize).flat_map(|padded| padded.iter().take(row as usize)).copied().collect())
}
