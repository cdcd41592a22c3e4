//! Closures that read textures, images of other pixels and neighbours along the ray: on the driver, in permuted drawing orders, and on the
//! CPU device. The expected pictures share no code with templates and filters.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh};
use fragbuf_model::Variant;
use fragbuf_runtime::headless::Headless;
use fragbuf_runtime::{Renderer, Settings, block_on};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::TextureDimension;

use crate::drivers::{SWIFTSHADER, draw, scene};
use crate::order::numbers;
use crate::stage::{BACKGROUND, FORMAT, described, device, renderer, shaders};
use expected::{Lookup, SIZE, assert_lookup, lookups, scene as quads_of};
use numbers::Numbers;
use scene::{Quad, vertices};

#[path = "../../../../tests/oracle/lookups.rs"]
mod expected;

/// What the expected pictures use of the hosts' module of this name.
mod technique {
    pub use crate::stage::BACKGROUND;
}

/// Creates a texture of floats with these texels.
pub fn texture(stage: &Headless, dimension: TextureDimension, size: [u32; 3], texels: &[[f32; 4]]) -> wgpu::Texture {
    let [width, height, depth_or_array_layers] = size;
    let size = wgpu::Extent3d { width, height, depth_or_array_layers };
    let texture = stage.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: match dimension {
            TextureDimension::D2 => wgpu::TextureDimension::D2,
            TextureDimension::D3 => wgpu::TextureDimension::D3,
        },
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = texels.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: Some(height) };
    stage.queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    texture
}

fn set_textures(stage: &Headless, renderer: &mut Renderer, lookup: &Lookup) {
    for ((name, size, texels), declared) in lookup.textures.iter().zip(&lookup.variant.textures) {
        let texture = texture(stage, declared.dimension.value, *size, texels);
        block_on(&stage.device, renderer.set_texture(name, &texture)).unwrap().unwrap();
    }
}

fn on_cpu(lookup: &Lookup, quads: &[Quad]) -> Vec<[f32; 4]> {
    let code = Arc::new(Code::of(&lookup.variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}")));
    let mut cpu = Device::new(code, fragbuf_cpu::Settings::new(SIZE[0], SIZE[1])).unwrap();
    for (name, size, texels) in &lookup.textures {
        cpu.set_description_texture(name, *size, texels).unwrap();
    }
    let words: Vec<u32> = vertices(quads, SIZE, &["position", "color"])
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes(word.try_into().unwrap()))
        .collect();
    let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
    let picture = cpu.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
    let over = |[r, g, b, a]: [f32; 4]| {
        let [behind_r, behind_g, behind_b] = BACKGROUND.map(|channel| (1.0 - a) * channel as f32);
        [r + behind_r, g + behind_g, b + behind_b, 1.0]
    };
    picture.pixels.iter().copied().map(over).collect()
}

#[test]
fn closures_read_textures_images_and_neighbours() {
    let stage = device();
    println!("driver: {}", stage.info.name);
    for lookup in lookups() {
        let settings = Settings::new(FORMAT, SIZE[0], SIZE[1]);
        let mut renderer = renderer(&stage, &shaders(&lookup.variant, "wgsl"), &settings).unwrap();
        set_textures(&stage, &mut renderer, &lookup);
        for seed in [3, 4] {
            let mut quads = quads_of(seed);
            let mut numbers = Numbers::seeded(seed);
            for order in 0..3 {
                let seen = draw(&stage, &mut renderer, &quads, SIZE).unwrap();
                assert_lookup(&format!("driver, order {order}"), &lookup, &seen, &quads);
                assert_lookup(&format!("CPU device, order {order}"), &lookup, &on_cpu(&lookup, &quads), &quads);
                numbers.shuffle(&mut quads);
            }
        }
    }
}

/// Runs the test above on SwiftShader, which also runs helper invocations beside the frame.
#[test]
fn closures_read_textures_images_and_neighbours_on_swiftshader() {
    assert!(Path::new(SWIFTSHADER).exists(), "this test needs SwiftShader: install Debian's package chromium");
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["lookups::closures_read_textures_images_and_neighbours", "--exact", "--nocapture"]);
    command.envs([("VK_DRIVER_FILES", SWIFTSHADER), ("VK_ICD_FILENAMES", SWIFTSHADER)]);
    let output = command.output().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{printed}{}", String::from_utf8_lossy(&output.stderr));
    assert!(printed.contains("SwiftShader") && printed.contains("1 passed"), "{printed}");
}

fn one(name: &str) -> Lookup {
    lookups().into_iter().find(|lookup| lookup.name == name).unwrap()
}

/// A frame without a texture, or with one of another shape, is an error that names it.
#[test]
fn textures_must_be_set_and_fit() {
    let stage = device();
    let lookup = one("filters");
    let settings = Settings::new(FORMAT, SIZE[0], SIZE[1]);
    let mut renderer = renderer(&stage, &shaders(&lookup.variant, "wgsl"), &settings).unwrap();
    let error = draw(&stage, &mut renderer, &quads_of(3), SIZE).unwrap_err().to_string();
    assert!(error.contains("`texture_lut`") && error.contains("set_texture"), "{error}");
    let volume = texture(&stage, TextureDimension::D3, [2, 2, 2], &[[0.0; 4]; 8]);
    let error = block_on(&stage.device, renderer.set_texture("lut", &volume)).unwrap().unwrap_err().to_string();
    assert!(error.contains("`lut`") && error.contains("two dimensions"), "{error}");
    let mut cpu = Device::new(
        Arc::new(Code::of(&lookup.variant, &Registry::builtin()).unwrap()),
        fragbuf_cpu::Settings::new(SIZE[0], SIZE[1]),
    )
    .unwrap();
    let mut refused = |name: &str, size: [u32; 3], count: usize| {
        cpu.set_description_texture(name, size, &vec![[0.0; 4]; count]).unwrap_err().to_string()
    };
    assert!(refused("lot", [1, 1, 1], 1).contains("`lut`, `volume`"));
    assert!(refused("lut", [2, 2, 2], 8).contains("two dimensions"));
    assert!(refused("lut", [2, 2, 1], 3).contains("4 texels"));
    assert!(refused("lut", [0, 2, 1], 0).contains("0 x 2 x 1"));
}

/// A frame with images is not divided into slices: a slice does not have the pixels beside it.
#[test]
fn a_frame_with_images_has_no_slices() {
    let stage = device();
    let variant = one("images").variant;
    let settings = Settings { slice: Some(3), ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
    let error = renderer(&stage, &shaders(&variant, "wgsl"), &settings).err().unwrap().to_string();
    assert!(error.contains("other pixels"), "{error}");
    let settings = Settings { memory: 4096, ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
    let error = renderer(&stage, &shaders(&variant, "wgsl"), &settings).err().unwrap().to_string();
    assert!(error.contains("4096") && error.contains("13 x 7"), "{error}");
    // The same without images is drawn in slices.
    let other: Variant = described("buffer Sliced from kplus_array { keep 8; }");
    let settings = Settings { slice: Some(3), ..Settings::new(FORMAT, SIZE[0], SIZE[1]) };
    assert!(renderer(&stage, &shaders(&other, "wgsl"), &settings).is_ok());
}
