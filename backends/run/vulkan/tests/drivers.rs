//! The same tests on SwiftShader, which runs helper invocations beside the frame where lavapipe does not.

use std::path::Path;
use std::process::Command;

/// SwiftShader's manifest for the Vulkan loader, from Debian's package chromium.
const SWIFTSHADER: &str = "/usr/lib/chromium/vk_swiftshader_icd.json";

/// The Vulkan loader reads its settings when a process opens the first device, so the second driver runs in a process
/// of its own.
#[test]
fn every_technique_on_swiftshader() {
    assert!(Path::new(SWIFTSHADER).exists(), "this test needs SwiftShader: install Debian's package chromium");
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["pixels::every_technique", "--exact", "--nocapture"])
        .env("VK_DRIVER_FILES", SWIFTSHADER)
        .env("VK_ICD_FILENAMES", SWIFTSHADER)
        .env("FRAGBUF_TEST_DEVICE", "SwiftShader")
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{printed}\n{}", String::from_utf8_lossy(&output.stderr));
    assert!(printed.contains("driver: SwiftShader") && printed.contains("1 passed"), "{printed}");
}
