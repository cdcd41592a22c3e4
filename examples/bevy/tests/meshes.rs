//! Transparent meshes of Bevy with every technique in module form, in permuted drawing orders, with 4 samples per pixel.
//!
//! The meshes are quads of constant depth and unlit colours, so the image is that of the reference.

use bevy::asset::RenderAssetUsages;
use bevy::camera::{ClearColorConfig, Hdr, RenderTarget, ScalingMode};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use fragbuf_bevy::headless::{app, image_texels, ready, target};
use fragbuf_bevy::{Error, FragmentBuffer, FragmentBufferPlugin, FragmentCounters, Passes};
use fragbuf_templates::Registry;

use crate::cpu_image::{is_exact, shown};
use crate::numbers::Numbers;
use crate::scene::{Quad, first_difference, image, quads};
use crate::technique::{BACKGROUND, variant};
use crate::techniques::{alone, pixel};

const SIZE: [u32; 2] = [29, 17];

/// The number of fragments that a pixel keeps.
const KEEP: u32 = 4;

/// Colours are linear floats, so that nothing is rounded but what the buffer stores.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A Bevy app with a camera that looks at quads.
pub struct Stage {
    app: App,
    camera: Entity,
    image: Handle<Image>,
    meshes: Vec<Entity>,
}

impl Stage {
    pub fn new(msaa: Msaa) -> Self {
        let mut app = app();
        app.add_plugins(FragmentBufferPlugin);
        ready(&mut app).unwrap_or_else(|error| panic!("{error}"));
        let image = target(&mut app, SIZE, FORMAT);
        let [width, height] = SIZE.map(|side| side as f32);
        let [red, green, blue] = BACKGROUND.map(|channel| channel as f32);
        let projection = OrthographicProjection {
            near: 0.0,
            far: 1.0,
            scaling_mode: ScalingMode::Fixed { width, height },
            ..OrthographicProjection::default_3d()
        };
        let clear_color = ClearColorConfig::Custom(Color::linear_rgb(red, green, blue));
        let camera = app.world_mut().spawn((
            Camera3d::default(),
            Camera { clear_color, ..default() },
            (Projection::Orthographic(projection), Transform::default()),
            RenderTarget::Image(image.clone().into()),
            (Hdr, msaa, Tonemapping::None, DebandDither::Disabled),
        ));
        let camera = camera.id();
        Stage { app, camera, image, meshes: Vec::new() }
    }

    pub fn set_buffer(&mut self, buffer: FragmentBuffer) {
        self.app.world_mut().entity_mut(self.camera).insert(buffer).remove::<FragmentCounters>();
    }

    /// Replaces all meshes. The first of the quads is drawn first, whatever its distance.
    pub fn set_quads(&mut self, quads: &[Quad], opaque: Option<&Quad>) {
        for mesh in self.meshes.drain(..) {
            self.app.world_mut().despawn(mesh);
        }
        let of_mesh = |(index, quad)| (mesh(quad), material(quad, AlphaMode::Blend, 1000.0 * index as f32), quad.depth);
        let mut wanted: Vec<_> = quads.iter().enumerate().map(of_mesh).collect();
        wanted.extend(opaque.map(|quad| (mesh(quad), material(quad, AlphaMode::Opaque, 0.0), quad.depth)));
        for (mesh, material, depth) in wanted {
            let world = self.app.world_mut();
            let mesh = Mesh3d(world.resource_mut::<Assets<Mesh>>().add(mesh));
            let material = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(material));
            let transform = Transform::from_xyz(0.0, 0.0, -depth);
            self.meshes.push(world.spawn((mesh, material, transform)).id());
        }
    }

    /// Draws frames until the image is whole, and returns its pixels.
    pub fn pixels(&mut self) -> Vec<[f32; 4]> {
        // Assets arrive in the first frame, Bevy specialises in the second, the plugin in the third.
        for _ in 0..6 {
            self.app.update();
        }
        let bytes = image_texels(&self.app, &self.image).unwrap_or_else(|error| panic!("{error}"));
        bytes.chunks_exact(8).map(pixel).collect()
    }

    /// Returns the counters of a recent frame.
    pub fn counters(&mut self) -> FragmentCounters {
        for _ in 0..100 {
            if let Some(counters) = self.app.world().get::<FragmentCounters>(self.camera) {
                return counters.clone();
            }
            self.app.update();
        }
        panic!("no counters after 100 frames");
    }
}

/// Returns a quad in pixels around the centre of the frame.
fn mesh(quad: &Quad) -> Mesh {
    let [width, height] = SIZE.map(|side| side as f32 / 2.0);
    let [left, right] = quad.x.map(|x| x as f32 - width);
    let [top, bottom] = quad.y.map(|y| height - y as f32);
    let corners = vec![[left, top, 0.0], [left, bottom, 0.0], [right, bottom, 0.0], [right, top, 0.0]];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 4])
        .with_inserted_indices(Indices::U32(vec![0, 1, 2, 0, 2, 3]))
}

fn material(quad: &Quad, alpha_mode: AlphaMode, depth_bias: f32) -> StandardMaterial {
    let [red, green, blue, alpha] = quad.color.map(|channel| f32::from(channel) / 255.0);
    let base_color = Color::linear_rgba(red, green, blue, alpha);
    StandardMaterial { base_color, alpha_mode, depth_bias, unlit: true, ..default() }
}

/// Returns quads of different depths, so that no tie is decided by how a colour is stored.
fn different_quads(numbers: &mut Numbers) -> Vec<Quad> {
    let mut quads = quads(9, SIZE, numbers);
    numbers.shuffle(&mut quads);
    for (index, quad) in quads.iter_mut().enumerate() {
        quad.depth = (2 * index + 3) as f32 / 32.0;
    }
    quads
}

/// Returns the expected image: of the nearest `k`, in front of the opaque quad, over it and the background.
fn expected(quads: &[Quad], opaque: Option<&Quad>, k: Option<u32>) -> Vec<[f64; 3]> {
    let visible: Vec<Quad> = quads.iter().filter(|quad| opaque.is_none_or(|opaque| quad.depth < opaque.depth)).copied().collect();
    let Some(opaque) = opaque else { return image(&visible, SIZE, k, BACKGROUND) };
    let over_opaque = image(&visible, SIZE, k, [0, 1, 2].map(|channel| f64::from(opaque.color[channel]) / 255.0));
    let over_background = image(quads, SIZE, k, BACKGROUND);
    let is_covered = |pixel: usize| {
        let (x, y) = (pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]);
        (opaque.x[0]..opaque.x[1]).contains(&x) && (opaque.y[0]..opaque.y[1]).contains(&y)
    };
    (0..over_opaque.len()).map(|pixel| if is_covered(pixel) { over_opaque[pixel] } else { over_background[pixel] }).collect()
}

/// An opaque surface in front of some quads.
const OPAQUE: Quad = Quad { x: [5, 20], y: [3, 12], depth: 0.4, color: [230, 20, 60, 255], id: 99 };

/// Techniques whose geometry passes need entry points of their own, so that no material can call them, and those that portable WGSL does
/// not have.
const WITHOUT_MODULE: [&str; 6] = ["f2b", "f2b2", "f2b_3p", "kb_mdt64", "kb_sr", "z_buffer"];

/// Techniques that state that they lose fragments. The reference does not have their images.
const LOSING: [&str; 0] = [];

/// Returns the description of a technique with what it takes of `keep` and `opaque`, and how many fragments a pixel keeps.
fn described(key: &str) -> (String, Option<u32>, bool) {
    for opaque in [true, false] {
        for keep in [Some(KEEP), None] {
            let number = keep.map(|keep| keep.to_string());
            let mut set: Vec<(&str, &str)> = number.iter().map(|keep| ("k", keep.as_str())).collect();
            set.extend(opaque.then_some(("opaque", "in_shader")));
            if variant(key, &set).is_some() {
                let keeps = keep.map_or(String::new(), |keep| format!("keep {keep};"));
                let hides = if opaque { "opaque: in_shader;" } else { "" };
                return (format!("buffer Glass from {key} {{ {keeps} {hides} }}"), keep, opaque);
            }
        }
    }
    panic!("{key} is no technique");
}

/// Draws a technique in several drawing orders. Returns whether the reference has its image.
fn compare(stage: &mut Stage, key: &str) -> Result<bool, Error> {
    let (description, keep, hides) = described(key);
    let passes = Passes::module(&description)?;
    let Some(plan) = passes.plan().filter(|plan| is_exact(plan)) else { return Ok(false) };
    stage.set_buffer(FragmentBuffer::new(&description)?);
    let mut numbers = Numbers::seeded(7);
    let mut quads = different_quads(&mut numbers);
    let opaque = hides.then_some(&OPAQUE);
    for order in 0..2 {
        stage.set_quads(&quads, opaque);
        let expected = expected(&quads, opaque, shown(plan, keep));
        let difference = first_difference(&stage.pixels(), &expected);
        assert!(difference.is_none(), "{description}, order {order}: {}: {quads:?}", difference.unwrap_or_default());
        numbers.shuffle(&mut quads);
    }
    assert_eq!(stage.counters().counters.lost, 0, "{description}");
    Ok(true)
}

/// Every technique that has a module form, with 4 samples per pixel.
#[test]
fn every_technique_with_meshes() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    let (mut rejected, mut losing) = (Vec::new(), Vec::new());
    for technique in Registry::builtin().techniques() {
        match compare(&mut stage, &technique.key) {
            Ok(true) => println!("{}: drawn", technique.key),
            Ok(false) => losing.push(technique.key.clone()),
            Err(error) => {
                assert!(error.to_string().contains("`wgsl` does not have these passes"), "{}: {error}", technique.key);
                rejected.push(technique.key.clone());
            }
        }
    }
    rejected.sort();
    losing.sort();
    assert_eq!(rejected, WITHOUT_MODULE);
    assert_eq!(losing, LOSING);
}
