//! The memory budget of the command line, and files without end: a command finishes within the budget or refuses with numbers, and
//! then it writes nothing.

use std::path::Path;

use serde_json::Value;

use crate::render::{folder, fragbuf, read, stderr};

/// The pixels of the images: 3 MB of four floats.
const SIZE: &str = "500x401";
const PIXELS: u64 = 500 * 401;

/// Renders on the CPU device.
fn render(key: &str, out: &Path, arguments: &[&str]) -> (Option<i32>, String, Option<Value>) {
    render_on("cpu", key, out, arguments)
}

/// Renders on a device; returns the exit code, stderr, and the statistics.
fn render_on(device: &str, key: &str, out: &Path, arguments: &[&str]) -> (Option<i32>, String, Option<Value>) {
    let view = ["--scene", "builtin:cubes", "--device", device, "--json", "--out", out.to_str().unwrap()];
    let output = fragbuf(&[&["render", key], &view[..], arguments].concat());
    (output.status.code(), stderr(&output), serde_json::from_slice(&output.stdout).ok())
}

#[test]
fn a_small_budget_draws_the_same_image_in_slices() {
    let folder = folder("memory");
    let [whole, sliced] = ["whole.png", "sliced.png"].map(|name| folder.join(name));
    for key in ["kplus_array", "ab_ll", "ab_sb"] {
        let (code, text, statistics) = render(key, &whole, &["--size", SIZE]);
        assert_eq!((code, statistics.unwrap()["slices"].as_u64()), (Some(0), Some(1)), "{text}");
        // The image, a twentieth of another one, and a little for the scene.
        let memory = (16 * PIXELS * 21 / 20 + 10_000).to_string();
        let (code, text, statistics) = render(key, &sliced, &["--size", SIZE, "--memory", &memory]);
        assert_eq!(code, Some(0), "{key}: {text}");
        assert!(statistics.unwrap()["slices"].as_u64() > Some(10), "{key}");
        assert!(std::fs::read(&whole).unwrap() == std::fs::read(&sliced).unwrap(), "{key}");
    }
}

/// The pool of a slice is too large for the budget once its fragments are counted, so slices become lower than those that were drawn first.
#[test]
fn slices_are_halved_after_an_overflow() {
    let folder = folder("memory_overflow");
    let draw = |out: &str, memory: &str| {
        let out = folder.join(out);
        let scene = ["--scene", "builtin:slabs,n=200", "--size", "128x128", "--device", "cpu", "--json"];
        let view = ["render", "ab_ll", "--memory", memory, "--out", out.to_str().unwrap()];
        let output = fragbuf(&[&view[..], &scene].concat());
        assert_eq!(output.status.code(), Some(0), "{memory}: {}", stderr(&output));
        let statistics: Value = serde_json::from_slice(&output.stdout).unwrap();
        (std::fs::read(&out).unwrap(), statistics["slices"].as_u64().unwrap(), statistics["frames"].as_u64().unwrap())
    };
    let (whole, slices, _) = draw("whole.png", "2GiB");
    assert_eq!(slices, 1);
    for memory in ["900KiB", "700KiB", "600KiB"] {
        let (image, slices, frames) = draw("sliced.png", memory);
        assert!(image == whole && slices > 3 && frames > 2, "{memory}: {slices} slices, {frames} frames");
    }
}

#[test]
fn the_opaque_scene_and_both_images_of_a_comparison_count() {
    let folder = folder("memory_of_images");
    let out = folder.join("o.png");
    let out = out.to_str().unwrap();
    let view = ["--scene", "builtin:cubes", "--device", "cpu", "--size", SIZE, "--out", out];
    let run = |command: &[&str], per_pixel: u64| {
        let memory = (per_pixel * PIXELS + 200_000).to_string();
        fragbuf(&[command, &view, &["--memory", &memory]].concat())
    };
    // The image of the opaque scene, its depth buffer twice, and the image. Without a slice's buffers that is too little.
    let opaque = ["render", "kplus_array", "--opaque", "builtin:slabs"];
    let refused = run(&opaque, 16 + 4 + 16);
    assert_eq!(refused.status.code(), Some(3), "{}", stderr(&refused));
    assert!(!Path::new(out).exists(), "{}", stderr(&refused));
    assert_eq!(run(&opaque, 16 + 4 + 4 + 16 + 4).status.code(), Some(0));
    std::fs::remove_file(out).unwrap();
    // Two images and the difference.
    let compare = ["compare", "kplus_array", "ab_array"];
    let refused = run(&compare, 16 + 16 + 3);
    assert_eq!(refused.status.code(), Some(3), "{}", stderr(&refused));
    assert!(!Path::new(out).exists(), "{}", stderr(&refused));
    assert_eq!(run(&compare, 16 + 16 + 4 + 1).status.code(), Some(0));
    assert_eq!(read(Path::new(out)).0, 500);
}

#[test]
fn a_frame_beyond_the_budget_is_refused_with_its_numbers() {
    let folder = folder("memory_refused");
    let out = folder.join("o.png");
    let opaque = ["--opaque", "builtin:hairball,strands=100000", "--memory", "16MiB"];
    let (code, text, _) = render("ab_array", &out, &opaque);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("of 16777216 bytes are left"), "{text}");
    let (code, text, _) = render("ab_array", &out, &["--size", "20000x20000"]);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("a frame of 20000 x 20000 pixels") && text.contains("image 6400000000"), "{text}");
    assert!(text.contains("raise the budget (`--memory`"), "{text}");
    let (code, text, _) = render("ab_array", &out, &["--size", "32768x32768", "--memory", "8GiB"]);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("image 17179869184"), "{text}");
    let (code, text, _) = render("ab_array", &out, &["--memory", "1KiB"]);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("of 1024 bytes are left") && text.contains("--memory"), "{text}");
    for size in ["4294967295x4294967295", "4294967295x1"] {
        for device in ["cpu", "llvmpipe"] {
            let (code, text, _) = render_on(device, "ab_array", &out, &["--size", size, "--memory", "16777215TiB"]);
            assert!(matches!(code, Some(2 | 3)), "{size} on {device}: {text}");
        }
    }
    assert!(!out.exists());
    for memory in ["0", "2GB", "-1", "16777216TiB"] {
        let (code, text, _) = render("ab_array", &out, &["--memory", memory]);
        assert_eq!(code, Some(2), "{memory}: {text}");
    }
}

#[test]
fn a_driver_draws_within_the_budget() {
    let folder = folder("memory_driver");
    let [whole, sliced] = ["whole.png", "sliced.png"].map(|name| folder.join(name));
    let image = |memory: &str, out: &Path| {
        let (code, text, statistics) = render_on("llvmpipe", "ab_sb", out, &["--size", SIZE, "--memory", memory]);
        assert_eq!(code, Some(0), "{text}");
        let statistics = statistics.unwrap();
        (statistics["slices"].as_u64().unwrap(), statistics["bytes"].as_u64().unwrap())
    };
    assert_eq!(image("2GiB", &whole).0, 1);
    // The image on the device and here, the attachment of geometry passes, and a megabyte for buffers.
    let memory = 25 * PIXELS + (1 << 20);
    let (slices, bytes) = image(&memory.to_string(), &sliced);
    assert!(slices > 1 && bytes <= 1 << 20, "{slices} slices of {bytes} bytes");
    assert!(read(&whole) == read(&sliced));
    let (code, text, _) = render_on("llvmpipe", "ab_sb", &sliced, &["--size", SIZE, "--memory", "1MiB"]);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains(&format!("{} bytes are needed for the image", 24 * PIXELS)), "{text}");
}

#[test]
fn files_without_end_are_refused_by_every_command() {
    let folder = folder("endless");
    let description = folder.join("d.fragbuf");
    let text =
        "buffer D { fragment { depth: f32, color: rgba8 } keep 4 least |f| f.depth; storage: wgsl(\"endless.wgsl\"); }";
    std::fs::write(&description, text).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.join("endless.wgsl")).unwrap();
    let large = folder.join("large.fragbuf");
    std::fs::write(&large, vec![b' '; (4 << 20) + 1]).unwrap();
    let pipe = folder.join("pipe.fragbuf");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let [description, large, pipe] = [&description, &large, &pipe].map(|path| path.to_str().unwrap());
    let out = folder.join("out");
    let out = out.to_str().unwrap();
    let commands = [
        (vec!["show", "/dev/zero", "--dump", "plan"], "a device, a pipe or a socket is not a source"),
        (vec!["show", pipe, "--dump", "plan"], "a device, a pipe or a socket is not a source"),
        (vec!["show", description, "--dump", "plan"], "a device, a pipe or a socket is not a source"),
        (vec!["check", "/dev/zero"], "a device, a pipe or a socket is not a source"),
        (vec!["check", "--wgsl", "/dev/zero", "--entry", "main"], "a device, a pipe or a socket is not a source"),
        (
            vec!["generate", "kb", "--target", "wgsl", "--with", "/dev/zero", "--out", out],
            "a device, a pipe or a socket is not a source",
        ),
        (
            vec!["generate", "kb", "--target", "wgsl", "--with", pipe, "--out", out],
            "a device, a pipe or a socket is not a source",
        ),
        (vec!["show", large, "--dump", "plan"], "a source of 4194305 bytes or more: it can have 4194304"),
    ];
    for (arguments, expected) in commands {
        let output = fragbuf(&arguments);
        assert!(matches!(output.status.code(), Some(1 | 3)), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
}
