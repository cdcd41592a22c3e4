//! Transparent meshes of Bevy with every technique in module form, in permuted drawing orders, with 4 samples per pixel.
//!
//! The meshes are quads of constant depth and unlit colours, so the image is that of the reference.

use bevy::asset::RenderAssetUsages;
use bevy::camera::{ClearColorConfig, Hdr, RenderTarget, ScalingMode};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use fragbuf_bevy::headless::{app, gpu, image_texels, ready, target};
use fragbuf_bevy::{Error, FragmentBuffer, FragmentBufferPlugin, FragmentCounters, Passes};
use fragbuf_codegen::Arrival;
use fragbuf_templates::Registry;

use crate::cpu_image::{is_exact, shown};
use crate::numbers::Numbers;
use crate::scene::{Quad, first_difference, image, quads};
use crate::technique::{BACKGROUND, is_parallel, on_cpu, variant};
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

    pub fn set_target(&mut self, size: [u32; 2]) {
        self.image = target(&mut self.app, size, FORMAT);
        let image = RenderTarget::Image(self.image.clone().into());
        self.app.world_mut().entity_mut(self.camera).insert(image);
    }

    pub fn remove_buffer(&mut self) {
        self.app.world_mut().entity_mut(self.camera).remove::<FragmentBuffer>();
    }

    /// Turns all meshes around the axis of the view.
    pub fn turn(&mut self, angle: f32) {
        for mesh in &self.meshes {
            if let Some(mut transform) = self.app.world_mut().get_mut::<Transform>(*mesh) {
                transform.rotation = Quat::from_rotation_z(angle);
            }
        }
    }

    /// Returns the latest value of a diagnostic.
    pub fn diagnostic(&self, path: &str) -> Option<f64> {
        self.app.world().resource::<DiagnosticsStore>().get(&DiagnosticPath::new(path.to_owned()))?.value()
    }

    /// The name of the driver.
    pub fn driver(&self) -> String {
        gpu(&self.app).unwrap_or_else(|error| panic!("{error}")).device.adapter_info().name
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
    let visible: Vec<Quad> =
        quads.iter().filter(|quad| opaque.is_none_or(|opaque| quad.depth < opaque.depth)).copied().collect();
    let Some(opaque) = opaque else { return image(&visible, SIZE, k, BACKGROUND) };
    let over_opaque = image(&visible, SIZE, k, [0, 1, 2].map(|channel| f64::from(opaque.color[channel]) / 255.0));
    let over_background = image(quads, SIZE, k, BACKGROUND);
    let is_covered = |pixel: usize| {
        let (x, y) = (pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]);
        (opaque.x[0]..opaque.x[1]).contains(&x) && (opaque.y[0]..opaque.y[1]).contains(&y)
    };
    (0..over_opaque.len())
        .map(|pixel| if is_covered(pixel) { over_opaque[pixel] } else { over_background[pixel] })
        .collect()
}

/// An opaque surface in front of some quads.
const OPAQUE: Quad = Quad { x: [5, 20], y: [3, 12], depth: 0.4, color: [230, 20, 60, 255], id: 99 };

/// Techniques whose geometry passes need entry points of their own, so that no material can call them, and those that portable WGSL does
/// not have.
const WITHOUT_MODULE: [&str; 6] = ["f2b", "f2b2", "f2b_3p", "kb_mdt64", "kb_sr", "z_buffer"];

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

/// Draws a technique in several drawing orders. Where it states that it loses fragments, the expected image is that of the CPU device.
fn compare(stage: &mut Stage, driver: &str, key: &str) -> Result<(), Error> {
    let (mut description, keep, hides) = described(key);
    let mut passes = Passes::module(&description)?;
    let hides = hides && passes.plan().is_some_and(is_exact);
    if !hides {
        description = description.replace("opaque: in_shader;", "");
        passes = Passes::module(&description)?;
    }
    let plan = passes.plan().unwrap_or_else(|| panic!("{key} has no plan"));
    if is_parallel(driver) && plan.arrival() == Arrival::Race {
        println!("{key}: not compared, because races change its image on {driver}");
        return Ok(());
    }
    stage.set_buffer(FragmentBuffer::new(&description)?);
    let mut numbers = Numbers::seeded(7);
    let mut quads = different_quads(&mut numbers);
    let opaque = hides.then_some(&OPAQUE);
    for order in 0..2 {
        stage.set_quads(&quads, opaque);
        let inputs = ["position", "color"].map(str::to_owned);
        let expected = match is_exact(plan) {
            true => expected(&quads, opaque, shown(plan, keep)),
            false => on_cpu(plan, &inputs, &[], (&quads, SIZE)),
        };
        let difference = first_difference(&stage.pixels(), &expected);
        assert!(difference.is_none(), "{description}, order {order}: {}: {quads:?}", difference.unwrap_or_default());
        numbers.shuffle(&mut quads);
    }
    assert!(!is_exact(plan) || stage.counters().counters.lost == 0, "{description}");
    Ok(())
}

/// Every technique that has a module form, with 4 samples per pixel.
#[test]
fn every_technique_with_meshes() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    let driver = stage.driver();
    let mut rejected = Vec::new();
    for technique in Registry::builtin().techniques() {
        if let Err(error) = compare(&mut stage, &driver, &technique.key) {
            assert!(error.to_string().contains("`wgsl` does not have these passes"), "{}: {error}", technique.key);
            rejected.push(technique.key.clone());
        }
    }
    rejected.sort();
    assert_eq!(rejected, WITHOUT_MODULE);
}

/// Bevy alone does not draw the quads in the order of their depths, so the other tests would fail if meshes were not stored.
#[test]
fn without_a_buffer_the_order_shows() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    let quads = different_quads(&mut Numbers::seeded(7));
    stage.set_quads(&quads, None);
    let expected = expected(&quads, None, None);
    assert!(first_difference(&stage.pixels(), &expected).is_some());
    // The component may come and go.
    stage.set_buffer(FragmentBuffer::new("buffer Glass from ab_ll { }").unwrap_or_else(|error| panic!("{error}")));
    assert_eq!(first_difference(&stage.pixels(), &expected), None);
    stage.remove_buffer();
    assert!(first_difference(&stage.pixels(), &expected).is_some());
}

/// Meshes may come and go, and so may the size of the target.
#[test]
fn meshes_and_sizes_change() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    let mut quads = different_quads(&mut Numbers::seeded(3));
    stage.set_buffer(FragmentBuffer::new("buffer Glass from ab_sb { }").unwrap_or_else(|error| panic!("{error}")));
    for count in [3, 0, 9] {
        stage.set_quads(&quads[..count], None);
        assert_eq!(first_difference(&stage.pixels(), &expected(&quads[..count], None, None)), None, "{count} quads");
    }
    // A target of twice the size has four equal pixels for each.
    stage.set_target([2 * SIZE[0], 2 * SIZE[1]]);
    let seen = stage.pixels();
    let at = |pixel: usize| {
        let (x, y) = (pixel % SIZE[0] as usize, pixel / SIZE[0] as usize);
        seen[2 * y * 2 * SIZE[0] as usize + 2 * x]
    };
    let sampled: Vec<[f32; 4]> = (0..seen.len() / 4).map(at).collect();
    quads.reverse();
    assert_eq!(first_difference(&sampled, &expected(&quads, None, None)), None);
}

/// An edge covers a part of the samples of a pixel. One surface has no order, so Bevy's own image is what is expected.
#[test]
fn edges_are_smooth_where_fragments_store_coverage() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    let quad = Quad { x: [4, 20], y: [3, 12], depth: 0.3, color: [200, 40, 90, 150], id: 0 };
    stage.set_quads(&[quad], None);
    stage.turn(0.3);
    let expected: Vec<[f64; 3]> = stage.pixels().iter().map(|[r, g, b, _]| [*r, *g, *b].map(f64::from)).collect();
    stage.set_buffer(FragmentBuffer::new("buffer Glass from ab_ll { }").unwrap_or_else(|error| panic!("{error}")));
    assert!(first_difference(&stage.pixels(), &expected).is_some(), "without coverage, edges have steps");
    let smooth = "buffer Glass from ab_ll { samples: coverage; }";
    stage.set_buffer(FragmentBuffer::new(smooth).unwrap_or_else(|error| panic!("{error}")));
    assert_eq!(first_difference(&stage.pixels(), &expected), None);
}

/// Fragments that a pool has no slot for are counted, and the counters are diagnostics of Bevy.
#[test]
fn losses_are_diagnostics() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    let quads = different_quads(&mut Numbers::seeded(7));
    stage.set_quads(&quads, None);
    let buffer = |fragments| {
        let buffer = FragmentBuffer::new("buffer Glass from ab_ll { }").unwrap_or_else(|error| panic!("{error}"));
        buffer.with_fragments_per_pixel(fragments)
    };
    stage.set_buffer(buffer(0.5));
    stage.pixels();
    let covered: u64 = quads.iter().map(|quad| u64::from((quad.x[1] - quad.x[0]) * (quad.y[1] - quad.y[0]))).sum();
    let slots = u64::from(SIZE[0] * SIZE[1]) / 2;
    assert_eq!(stage.counters().counters.lost, covered - slots);
    for counter in ["lost", "pool_exhausted"] {
        assert_eq!(stage.diagnostic(&format!("fragbuf/Glass/{counter}")), Some((covered - slots) as f64));
    }
    stage.set_buffer(buffer(9.0));
    stage.pixels();
    assert_eq!(stage.counters().counters.lost, 0);
}

/// What the plugin does not have is logged, and the camera draws without its buffer.
#[test]
fn a_buffer_that_fails_leaves_the_meshes_to_bevy() {
    let _guard = alone();
    let mut stage = Stage::new(Msaa::Sample4);
    stage.set_quads(&different_quads(&mut Numbers::seeded(7)), None);
    let blended = stage.pixels();
    for buffer in [
        FragmentBuffer::new("buffer Glass from kplus_ab_sb { allocation: by_importance; }"),
        FragmentBuffer::new("buffer Glass from ab_ll { }").map(|buffer| buffer.with_symbol("nonsense", 1)),
        FragmentBuffer::new("buffer Glass from kplus_array { }").map(|buffer| buffer.with_symbol("k", 1 << 40)),
    ] {
        stage.set_buffer(buffer.unwrap_or_else(|error| panic!("{error}")));
        assert_eq!(stage.pixels(), blended);
    }
}

/// Mistakes of a description are errors before a camera has it.
#[test]
fn mistakes_of_a_description_are_errors() {
    for (description, parts) in [
        ("buffer Glass from nonsense { }", ["nonsense", "technique"]),
        ("buffer Glass from z_buffer { }", ["`wgsl`", "entry points"]),
        ("buffer Glass from ab_ll { fragment { color: rgba8, depth: f32, id: u32 } }", ["`id`", "`normal`"]),
        (
            "buffer Glass from ab_ll { fragment { color: rgba8, normal: vec2, depth: f32 } }",
            ["`vec2<f32>`", "`vec3<f32>`"],
        ),
    ] {
        let error = FragmentBuffer::new(description).err().map_or(String::new(), |error| error.to_string());
        assert!(parts.iter().all(|part| error.contains(part)), "{description}: {error}");
    }
}
