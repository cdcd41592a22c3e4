//! Techniques with fragment shader interlock. No software driver has it: there the host says so, and draws nothing.
//! The mock driver of the Khronos group, which Chromium includes, has every extension and runs no command, so that
//! the validation layer checks the feature chain, the modules with their interlock, the pipelines and the commands.

use std::path::Path;
use std::process::Command;

use fragbuf_model::Variant;
use fragbuf_templates::Registry;
use fragbuf_vulkan_host::Validation;

use crate::hosts::numbers::Numbers;
use crate::hosts::scene::quads;
use crate::hosts::technique::{k_of, variant};
use crate::pixels::compare;
use crate::stage::{Generated, context, draw, technique};

const MOCK: &str = "/usr/lib/chromium/libVkICD_mock_icd.so";

/// Returns every technique that needs interlock, or takes it as its only change, with its k.
fn interlocked() -> Vec<(String, Variant, Option<u32>)> {
    let mut found = Vec::new();
    for row in Registry::builtin().techniques() {
        let k = k_of(row);
        let number = k.map(|k| k.to_string());
        for sync in ["interlock", "interlock_ordered"] {
            let set: Vec<(&str, &str)> = number.iter().map(|k| ("k", k.as_str())).chain([("sync", sync)]).collect();
            let variant = variant(&row.key, &set);
            found.extend(variant.map(|variant| (format!("{} with {sync}", row.key), variant, k)));
        }
        found.push((row.key.clone(), technique(row), k));
    }
    let needs = |variant: &Variant| {
        Generated::of(variant, &Registry::builtin()).manifest.contains("\"VK_EXT_fragment_shader_interlock\"")
    };
    found.retain(|(_, variant, _)| needs(variant));
    assert!(found.len() > 12, "{}", found.len());
    found
}

#[test]
fn a_device_without_interlock_is_rejected_by_the_name_of_the_extension() {
    let context = context(Validation::On);
    for (what, variant, k) in interlocked() {
        match compare(&context, &what, (&variant, k), &[([13, 7], None)], 2) {
            Ok(()) => println!("{what}: drawn on {}", context.name),
            Err(error) => {
                let names = ["`VK_EXT_fragment_shader_interlock`", "`fragmentShaderPixelInterlock`"];
                assert!(names.iter().all(|name| error.to_string().contains(name)), "{what}: {error}");
            }
        }
    }
}

/// The loader reads its settings when a process opens the first instance, so the mock driver has a process of its own.
#[test]
fn interlock_is_valid_on_a_driver_that_offers_it() {
    assert!(Path::new(MOCK).exists(), "this test needs Chromium's mock driver: install Debian's package chromium");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mock_icd.json");
    let driver = format!(
        r#"{{ "file_format_version": "1.0.1", "ICD": {{ "library_path": "{MOCK}", "api_version": "1.1.255" }} }}"#
    );
    std::fs::write(&file, driver).unwrap();
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["interlock::on_the_mock_driver", "--exact", "--ignored", "--nocapture"])
        .env("VK_DRIVER_FILES", &file)
        .env("VK_ICD_FILENAMES", &file)
        .env("FRAGBUF_TEST_DEVICE", "Vulkan Mock Device")
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{printed}\n{}", String::from_utf8_lossy(&output.stderr));
    assert!(printed.contains("driver: Vulkan Mock Device") && printed.contains("1 passed"), "{printed}");
}

/// Not a test of its own: the one above runs it on another driver.
#[test]
#[ignore = "run by another test"]
fn on_the_mock_driver() {
    let context = context(Validation::On);
    println!("driver: {}", context.name);
    let (size, mut checked) = ([13, 7], 0);
    for (what, variant, _) in interlocked() {
        let generated = Generated::of(&variant, &Registry::builtin());
        let mut host = match generated.host(&context, size) {
            // The mock driver has the least limits of Vulkan.
            Err(error) if error.to_string().contains(" lacks the limit `") => {
                continue;
            }
            host => host.unwrap_or_else(|error| panic!("{what}: {error}")),
        };
        let quads = quads(9, size, &mut Numbers::seeded(1));
        let drawn = draw(&mut host, &quads, size);
        assert_eq!(drawn.unwrap_or_else(|error| panic!("{what}: {error}")).pixels.len(), 91);
        drop(host);
        context.check().unwrap_or_else(|error| panic!("{what}: {error}"));
        checked += 1;
    }
    println!("{checked} on the mock driver");
    assert!(checked > 2, "{checked}");
}
