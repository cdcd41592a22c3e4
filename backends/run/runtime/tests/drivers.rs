//! Every technique on two software drivers at odd sizes, whole and in slices, in permuted drawing orders: the image is that of the
//! reference, or of the CPU device where a technique states that it loses fragments.
//!
//! The drivers differ where it matters: SwiftShader runs helper invocations beside the frame, lavapipe does not.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use fragbuf_codegen::Arrival;
use fragbuf_cpu::{Code, Device};
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Error, Interlock, Renderer, Settings, Shaders};
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::KeepDefault;

use crate::oracle::reference;
use crate::order::numbers;
use crate::stage::{self, BACKGROUND, FORMAT, renderer, shaders, technique};
use cpu_image::{cpu_image, is_exact, shown};
use numbers::Numbers;
use scene::{Quad, first_difference, image, quads, vertices};

#[path = "../../../../tests/oracle/cpu_image.rs"]
mod cpu_image;
#[path = "../../../../tests/oracle/scene.rs"]
pub mod scene;

/// The width and height of each frame, and the rows of its slices.
const FRAMES: [([u32; 2], Option<u32>); 6] =
    [([13, 7], None), ([13, 7], Some(3)), ([1, 1], None), ([31, 1], None), ([1, 9], Some(2)), ([37, 23], None)];

/// SwiftShader's manifest for the Vulkan loader, from Debian's package chromium.
pub const SWIFTSHADER: &str = "/usr/lib/chromium/vk_swiftshader_icd.json";

/// Draws quads over the background, and returns the image.
pub fn draw(stage: &Headless, renderer: &mut Renderer, quads: &[Quad], size: [u32; 2]) -> Result<Vec<[f32; 4]>, Error> {
    let inputs: Vec<&str> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.as_str()).collect();
    let bytes = vertices(quads, size, &inputs);
    let offscreen = Offscreen::new(&stage.device, FORMAT, size[0], size[1])?;
    stage::draw_bytes(stage, renderer, (&bytes, 6 * quads.len() as u32), &offscreen)?;
    offscreen.colors(&stage.device, &stage.queue)
}

/// Compares a variant in every frame. Fails with what the device lacks.
fn compare(stage: &Headless, key: &str, variant: &Variant, k: Option<u32>) -> Result<(), Error> {
    // Techniques that portable WGSL cannot express use naga's WGSL.
    let is_portable = variant.select(target("wgsl").unwrap().provides).is_ok();
    compare_shaders(stage, key, &shaders(variant, if is_portable { "wgsl" } else { "wgsl-native" }), variant, k)
}

/// Compares shaders in every frame with a variant that has the same image.
fn compare_shaders(
    stage: &Headless,
    key: &str,
    shaders: &Shaders,
    variant: &Variant,
    k: Option<u32>,
) -> Result<(), Error> {
    let code = Arc::new(Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{key}: {error}")));
    for (size, slice) in FRAMES {
        let [width, height] = size;
        let settings = Settings { slice, interlock: stage.interlock, ..Settings::new(FORMAT, width, height) };
        let mut renderer = renderer(stage, shaders, &settings)?;
        let settings = fragbuf_cpu::Settings::new(width, height);
        let mut cpu = Device::new(code.clone(), settings).unwrap();
        let inputs: Vec<String> = renderer.vertex_inputs().inputs.iter().map(|input| input.name.clone()).collect();
        let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
        let mut numbers = Numbers::seeded(u64::from(width));
        // As many as automatic sizing reserves memory for.
        let mut quads = quads(8, size, &mut numbers);
        for order in 0..3 {
            let seen = draw(stage, &mut renderer, &quads, size).unwrap();
            let expected = match is_exact(cpu.plan()) {
                true => image(&quads, size, shown(cpu.plan(), k), BACKGROUND),
                false => cpu_image(&mut cpu, &quads, size, &inputs, BACKGROUND),
            };
            if let Some(difference) = first_difference(&seen, &expected) {
                panic!("{key}, {size:?}, slices of {slice:?} rows, order {order}: {difference}: {quads:?}");
            }
            numbers.shuffle(&mut quads);
        }
    }
    Ok(())
}

#[test]
fn every_technique_at_odd_sizes() {
    let stage = stage::device();
    println!("driver: {}", stage.info.name);
    let (mut right, mut left_out) = (0, Vec::new());
    let registry = Registry::builtin();
    for row in registry.techniques() {
        let k = match row.keep {
            KeepDefault::All => None,
            KeepDefault::Best(most) => Some(most.min(4)),
        };
        let set = k.map(|k| k.to_string());
        let variant = technique(&row.key, &set.iter().map(|k| ("k", k.as_str())).collect::<Vec<_>>());
        match compare(&stage, &row.key, &variant, k) {
            Ok(()) => right += 1,
            Err(error) => left_out.push(format!("{}: {error}", row.key)),
        }
    }
    println!("{right} techniques are right; left out: {left_out:?}");
    // A device without 64-bit atomics, as SwiftShader, leaves out the technique that needs them.
    let is_lacking = |text: &String| text.contains("SHADER_INT64");
    let has_wide_atomics = stage.device.features().contains(wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS);
    let expected = usize::from(!has_wide_atomics);
    assert!(left_out.len() == expected && left_out.iter().all(is_lacking), "{left_out:?}");
    assert_eq!(right + expected, registry.techniques().len());
}

/// Every technique in SPIR-V with every interlock that it takes. A device without interlock says so, and draws nothing.
#[test]
fn interlock_where_the_device_has_it() {
    let stage = stage::chosen_device();
    let (mut compared, registry) = (0, Registry::builtin());
    for row in registry.techniques() {
        let k = match row.keep {
            KeepDefault::All => None,
            KeepDefault::Best(most) => Some(most.min(4)),
        };
        let number = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> = number.iter().map(|k| ("k", k.as_str())).collect();
        for sync in ["interlock", "interlock_ordered"] {
            let span = SourceSpan::new(row.key.as_str(), 1, 1);
            let mut draft = Draft::from_technique(&row.key, &span);
            for (name, value) in set.iter().copied().chain([("sync", sync)]) {
                draft.set(name, value, &span).unwrap();
            }
            let Ok(variant) = check(&draft, &registry) else { continue };
            let what = format!("{} with {sync}", row.key);
            // The CPU device has no interlock. The choice of a sync does not change the image.
            let shaders = shaders(&variant, "spirv");
            if stage.interlock == Interlock::Enabled && shaders.plan.arrival() == Arrival::Race {
                println!("{what}: not compared, because races change its image");
                continue;
            }
            let seen = compare_shaders(&stage, &what, &shaders, &technique(&row.key, &set), k);
            match stage.interlock {
                Interlock::Enabled => assert!(seen.is_ok(), "{what}: {seen:?}"),
                Interlock::Absent => {
                    let message = seen.unwrap_err().to_string();
                    assert!(message.contains("fragment shader interlock"), "{what}: {message}");
                }
            }
            compared += 1;
        }
    }
    println!("{compared} techniques with {:?} interlock", stage.interlock);
    assert!(compared > 8, "{compared}");
}

/// Runs a test of this binary on SwiftShader and returns what it printed.
pub fn on_swiftshader(test: &str) -> String {
    assert!(Path::new(SWIFTSHADER).exists(), "this test needs SwiftShader: install Debian's package chromium");
    let output = Command::new(std::env::current_exe().unwrap())
        .args([test, "--exact", "--nocapture"])
        .env("VK_DRIVER_FILES", SWIFTSHADER)
        .env("VK_ICD_FILENAMES", SWIFTSHADER)
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{printed}\n{}", String::from_utf8_lossy(&output.stderr));
    printed
}

/// The Vulkan loader reads its settings when a process opens the first device, so the second driver runs in a process of its own.
#[test]
fn every_technique_at_odd_sizes_on_swiftshader() {
    let printed = on_swiftshader("drivers::every_technique_at_odd_sizes");
    assert!(printed.contains("driver: SwiftShader") && printed.contains("1 passed"), "{printed}");
}
