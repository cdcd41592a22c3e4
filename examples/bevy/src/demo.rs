//! A scene of glass, and a picture of it by the means of Bevy or by a fragment buffer.
//!
//! Input: how transparent surfaces are drawn. Output: the pixels, the bytes that this takes beside the camera's targets, and the time of a
//! frame. Panes and spheres intersect, so that no order of the meshes is right, and up to 30 surfaces lie behind each other.

use std::f32::consts::TAU;
use std::time::{Duration, Instant};

use bevy::camera::{ClearColorConfig, RenderTarget};
use bevy::core_pipeline::oit::{OitBuffers, OrderIndependentTransparencySettings};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::prelude::*;
use bevy::render::RenderApp;
use fragbuf_follow::Error;

use crate::headless::{app, gpu, image_texels, ready, target};
use crate::{FragmentBuffer, FragmentBufferPlugin, FragmentCounters};

/// How transparent surfaces are drawn.
pub enum Transparency {
    /// Bevy blends meshes in the order of their centres, with 4 samples per pixel.
    Sorted,
    /// Bevy's order-independent transparency, without samples, because it panics with them.
    Oit(OrderIndependentTransparencySettings),
    /// A fragment buffer, with 4 samples per pixel.
    Buffer(Box<FragmentBuffer>),
}

/// What a frame looks like and takes.
pub struct Picture {
    /// Red, green, blue and alpha of each pixel, row by row.
    pub pixels: Vec<u8>,
    /// The bytes of buffers and textures beside the camera's targets.
    pub bytes: u64,
    /// The fragments that are lost; `None`: nothing counts them.
    pub lost: Option<u64>,
    /// The shortest time of a frame.
    pub frame: Duration,
}

/// The frames that are drawn before any is measured: assets arrive, and pipelines are compiled.
const FIRST_FRAMES: usize = 8;

/// Draws the scene, and measures a number of frames.
pub fn picture(transparency: Transparency, size: [u32; 2], frames: usize) -> Result<Picture, Error> {
    let mut app = app();
    app.add_plugins(FragmentBufferPlugin);
    ready(&mut app)?;
    let image = target(&mut app, size, wgpu::TextureFormat::Rgba8UnormSrgb);
    let camera = spawn_camera(&mut app, &image);
    let has_oit = matches!(transparency, Transparency::Oit(_));
    let mut entity = app.world_mut().entity_mut(camera);
    match transparency {
        Transparency::Sorted => entity.insert(Msaa::Sample4),
        Transparency::Oit(settings) => entity.insert((Msaa::Off, settings)),
        Transparency::Buffer(buffer) => entity.insert((Msaa::Sample4, *buffer)),
    };
    spawn_scene(app.world_mut());
    for _ in 0..FIRST_FRAMES {
        app.update();
    }
    let gpu = gpu(&app)?;
    let mut frame = || -> Result<Duration, Error> {
        let begin = Instant::now();
        app.update();
        let waited = gpu.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| Error(format!("the frame did not end: {error}")))?;
        Ok(begin.elapsed())
    };
    let times = (0..frames.max(1)).map(|_| frame()).collect::<Result<Vec<_>, Error>>()?;
    let counters = app.world().get::<FragmentCounters>(camera).cloned();
    Ok(Picture {
        pixels: image_texels(&app, &image)?,
        bytes: counters.as_ref().map_or_else(|| if has_oit { oit_bytes(&app) } else { 0 }, |counters| counters.bytes),
        lost: counters.map(|counters| counters.counters.lost),
        frame: times.into_iter().min().unwrap_or_default(),
    })
}

/// Returns the bytes of the buffers of Bevy's order-independent transparency.
fn oit_bytes(app: &App) -> u64 {
    let world = app.get_sub_app(RenderApp).map(SubApp::world);
    let buffers = world.and_then(|world| world.get_resource::<OitBuffers>());
    // A node has three words.
    buffers.map_or(0, |buffers| 12 * buffers.nodes.capacity() as u64 + 4 * buffers.heads.capacity() as u64 + 4)
}

fn spawn_camera(app: &mut App, image: &Handle<Image>) -> Entity {
    let clear_color = ClearColorConfig::Custom(Color::linear_rgb(0.75, 0.8, 0.85));
    let camera = app.world_mut().spawn((
        Camera3d::default(),
        Camera { clear_color, ..default() },
        RenderTarget::Image(image.clone().into()),
        Transform::from_xyz(0.5, 2.3, 3.9).looking_at(Vec3::new(0.0, 0.85, 0.0), Vec3::Y),
        (Tonemapping::AcesFitted, DebandDither::Disabled),
    ));
    camera.id()
}

fn spawn_scene(world: &mut World) {
    let light = DirectionalLight { illuminance: 5_000.0, ..default() };
    world.spawn((light, Transform::from_xyz(2.0, 5.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y)));
    let opaque = |color| StandardMaterial { base_color: color, perceptual_roughness: 0.9, ..default() };
    let floor = Plane3d::default().mesh().size(9.0, 9.0).build();
    spawn(world, floor, opaque(Color::linear_rgb(0.5, 0.5, 0.5)), Transform::default());
    for (x, z) in [(-1.1, -0.6), (1.2, 0.7)] {
        let column = Cylinder::new(0.22, 2.2).mesh().build();
        spawn(world, column, opaque(Color::linear_rgb(0.8, 0.35, 0.15)), Transform::from_xyz(x, 1.1, z));
    }
    // Panes through one axis.
    for index in 0..7 {
        let angle = TAU * index as f32 / 14.0;
        let pane = Cuboid::new(3.4, 1.9, 0.02).mesh().build();
        let transform = Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(Quat::from_rotation_y(angle));
        spawn(world, pane, glass(index, 0.35), transform);
    }
    // Spheres around it, through the panes and each other.
    for index in 0..9 {
        let angle = TAU * index as f32 / 9.0;
        let sphere = Sphere::new(0.62).mesh().uv(48, 24);
        let transform = Transform::from_xyz(1.35 * angle.cos(), 0.75, 1.35 * angle.sin());
        spawn(world, sphere, glass(index + 3, 0.3), transform);
    }
}

fn spawn(world: &mut World, mesh: Mesh, material: StandardMaterial, transform: Transform) {
    let mesh = Mesh3d(world.resource_mut::<Assets<Mesh>>().add(mesh));
    let material = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(material));
    world.spawn((mesh, material, transform));
}

/// Returns coloured glass, both sides of which are drawn.
fn glass(index: u32, alpha: f32) -> StandardMaterial {
    StandardMaterial {
        base_color: Color::hsla(index as f32 * 77.0 % 360.0, 0.85, 0.55, alpha),
        alpha_mode: AlphaMode::Blend,
        perceptual_roughness: 0.35,
        double_sided: true,
        cull_mode: None,
        ..default()
    }
}
