//! The validation layer of Vulkan has nothing to report about frames of every technique, in WGSL and in SPIR-V.
//!
//! The layer multiplies the time of a frame, so only this test loads it.

use std::process::Command;

use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::KeepDefault;

use crate::capture::scattered;
use crate::stage::{device, render_frame, renderer, settings, shaders, technique};

/// What messages of the layer contain.
const MESSAGE: &str = "Validation Error";

/// Messages about what wgpu does by itself, with the reason.
const OF_WGPU: [(&str, &str); 1] =
    [("VUID-SampleMask-SampleMask-04359", "naga's input sample mask is a number; the target `spirv` has an array")];

/// wgpu reads its settings when a process opens the first adapter, so the layer is loaded in a process of its own.
#[test]
fn the_validation_layer_reports_nothing() {
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["validation::with_the_layer", "--exact", "--ignored", "--nocapture"])
        // Without wgpu's own listener the layer prints its messages.
        .envs([("WGPU_VALIDATION", "1"), ("WGPU_DEBUG", "0")])
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{printed}\n{}", String::from_utf8_lossy(&output.stderr));
    assert!(printed.contains("1 passed"), "{printed}");
    let messages: Vec<&str> = printed.lines().filter(|line| line.contains(MESSAGE)).collect();
    let (of_wgpu, others): (Vec<&str>, Vec<&str>) =
        messages.into_iter().partition(|line| OF_WGPU.iter().any(|(name, _)| line.contains(name)));
    assert!(others.is_empty(), "{others:#?}");
    // What is known proves that messages arrive here.
    assert!(!of_wgpu.is_empty(), "the layer prints elsewhere, or wgpu is newer than {OF_WGPU:?}");
}

/// Not a test of its own: the one above runs it with the layer.
#[test]
#[ignore = "run by another test"]
fn with_the_layer() {
    let (stage, mut drawn) = (device(), 0);
    let loaded = std::fs::read_to_string("/proc/self/maps").unwrap();
    assert!(loaded.contains("VkLayer_khronos_validation"), "install Debian's package vulkan-validationlayers");
    for row in Registry::builtin().techniques() {
        let k = match row.keep {
            KeepDefault::All => None,
            KeepDefault::Best(most) => Some(most.min(4).to_string()),
        };
        let variant = technique(&row.key, &k.iter().map(|k| ("k", k.as_str())).collect::<Vec<_>>());
        let is_portable = variant.select(target("wgsl").unwrap().provides).is_ok();
        for language in [if is_portable { "wgsl" } else { "wgsl-native" }, "spirv"] {
            let shaders = shaders(&variant, language);
            match renderer(&stage, &shaders, &settings()) {
                Ok(mut renderer) => {
                    (0..2).for_each(|seed| drop(render_frame(&stage, &mut renderer, &scattered(8, seed))));
                    drawn += 1;
                }
                // What this driver lacks.
                Err(error) => assert!(error.to_string().contains("interlock"), "{}, {language}: {error}", row.key),
            }
        }
    }
    let techniques = Registry::builtin().techniques().len();
    assert!(drawn >= 2 * techniques - 3, "{drawn} of {techniques} techniques, in two languages");
}
