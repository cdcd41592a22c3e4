//! Draws generated passes with the WebGPU host in `backends/run/webgpu`, on Dawn in Node and in headless Chromium, and compares every
//! pixel: every technique and every value of every axis that portable WGSL has, in permuted drawing orders, whole and in slices.
//!
//! The image is that of the reference, or of the CPU device where a description states that it loses fragments, or has an effect of its
//! own. Both run on SwiftShader, because Dawn rejects Debian's lavapipe.

mod chromium;
#[path = "oracle/cpu_image.rs"]
#[allow(dead_code, reason = "these tests render with attributes of their own")]
mod cpu_image;
mod effect_jobs;
#[path = "oracle/effects/mod.rs"]
pub mod effects;
mod jobs;
#[path = "oracle/lookups.rs"]
mod lookups;
#[path = "oracle/numbers.rs"]
mod numbers;
#[path = "../backends/run/cpu/tests/peeling_loop.rs"]
mod peeling_loop;
#[path = "oracle/scene.rs"]
mod scene;
/// What `lookups` uses of the hosts' module of this name.
mod technique {
    pub const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];
}

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use fragbuf::{Form, Registry, Request, generate};
use serde_json::Value;

use crate::cases::{checked, text};
use crate::oracle::reference;
use jobs::{Expected, Job};
use scene::first_difference;

/// SwiftShader's manifest for the Vulkan loader, from Debian's package chromium.
const SWIFTSHADER: &str = "/usr/lib/chromium/vk_swiftshader_icd.json";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns an empty folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a script of `tests/browser` in Node, on SwiftShader. Returns what it prints.
fn node(script: &str, arguments: &[&Path]) -> String {
    assert!(Path::new(SWIFTSHADER).exists(), "this test needs SwiftShader: install Debian's package chromium");
    let is_installed = root().join("tests/tint/node_modules/webgpu").exists();
    assert!(is_installed, "Dawn must be installed: run `npm ci` in tests/tint (see README)");
    let mut command = Command::new("node");
    command.arg(script).args(arguments).current_dir(root().join("tests/browser"));
    command.envs([("VK_DRIVER_FILES", SWIFTSHADER), ("VK_ICD_FILENAMES", SWIFTSHADER)]);
    let output = command.output();
    let output = output.unwrap_or_else(|error| panic!("Node must be installed, Debian's package is `nodejs`: {error}"));
    let [printed, errors] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{script}: {}\n{printed}\n{errors}", output.status);
    printed
}

/// Compares the results of jobs with what is expected. Returns the number of images.
fn compare(jobs: &[Job], results: &Value) -> usize {
    assert!(results["failed"].is_null(), "{}", results["failed"]);
    assert!(results["adapter"].as_str().unwrap().contains("swiftshader"), "{}", results["adapter"]);
    assert_eq!(results["uncaptured"], serde_json::json!([]), "errors outside of error scopes");
    let (mut images, mut problems) = (0, Vec::new());
    for job in jobs {
        let result = &results["results"][&job.name];
        match result["runs"].as_array() {
            None => problems.push(format!("{}: {}", job.name, result["error"])),
            Some(runs) => {
                assert_eq!(runs.len(), job.expected.len(), "{}", job.name);
                for (run, expected) in runs.iter().zip(&job.expected) {
                    images += expected.images.len();
                    problems.extend(
                        problem(run, expected).map(|problem| format!("{}, {}: {problem}", job.name, expected.what)),
                    );
                }
            }
        }
    }
    assert!(problems.is_empty(), "{} problems\n{}", problems.len(), problems.join("\n"));
    images
}

/// Returns what is wrong with a run.
fn problem(run: &Value, expected: &Expected) -> Option<String> {
    let images = run["images"].as_array().unwrap();
    assert_eq!(images.len(), expected.images.len());
    for (number, (image, expected)) in images.iter().zip(&expected.images).enumerate() {
        let seen: Vec<[f32; 4]> = image.as_array().unwrap().iter().map(pixel).collect();
        if let Some(difference) = first_difference(&seen, expected) {
            return Some(format!("scene {number}: {difference}"));
        }
    }
    if expected.loses_nothing && run["lost"].as_array().unwrap().iter().any(|lost| *lost != 0) {
        return Some(format!("{} fragments are counted as lost", run["lost"]));
    }
    let loops = run["loops"].as_array().unwrap().iter().flat_map(|frame| frame.as_array().unwrap());
    if loops.clone().any(|looped| looped["isMet"] != true) {
        return Some(format!("a loop ended at its limit: {}", run["loops"]));
    }
    if let Some(problem) = run["times"].as_array().unwrap().iter().find_map(|times| time_problem(times, expected)) {
        return Some(problem);
    }
    let slices = run["slices"].as_u64().unwrap();
    (slices != expected.slices).then(|| format!("{slices} slices, not {}", expected.slices))
}

/// Returns the colour of a pixel of a result.
fn pixel(pixel: &Value) -> [f32; 4] {
    let channel = |at: usize| pixel[at].as_f64().unwrap() as f32;
    [channel(0), channel(1), channel(2), 1.0]
}

/// Returns what is wrong with the times of a frame: each pass that ran has one, finite and not negative.
fn time_problem(times: &Value, expected: &Expected) -> Option<String> {
    let passes = times["passes"].as_object().unwrap();
    let names: BTreeSet<String> = passes.keys().cloned().collect();
    // JSON has no infinities.
    let are_times = passes.values().all(|ms| ms.as_f64().is_some_and(|ms| ms >= 0.0));
    let is_whole = times["unmeasured"] == 0 && times["reason"].is_null();
    (names != expected.timed || !are_times || !is_whole)
        .then(|| format!("the times are {times}, of the passes {:?}", expected.timed))
}

#[test]
fn every_technique_on_dawn() {
    let folder = folder("dawn");
    let jobs = jobs::all();
    jobs::write(&jobs, &folder, "jobs.json");
    node("dawn.mjs", &[&folder]);
    let results = serde_json::from_slice(&std::fs::read(folder.join("results.json")).unwrap()).unwrap();
    let images = compare(&jobs, &results);
    println!("{} plans, {images} images on Dawn", jobs.len());
    // Queries drop objects, and the image stays the same.
    let runs = jobs.iter().filter(|job| job.drops_objects).map(|job| &results["results"][&job.name]["runs"][0]);
    let count = |member: &str| runs.clone().map(|run| run[member].as_u64().unwrap()).sum::<u64>();
    let [drawn, every] = ["drawn", "every"].map(count);
    assert!(0 < drawn && drawn < every, "{drawn} of {every} objects");
    println!("{drawn} of {every} objects are drawn");
}

/// The effects of `examples/effects`: the image is that of the reference, which no device draws.
#[test]
fn every_effect_on_dawn() {
    let folder = folder("effects");
    let drawn = effect_jobs::write(&folder);
    node("dawn.mjs", &[&folder]);
    let results: Value = serde_json::from_slice(&std::fs::read(folder.join("results.json")).unwrap()).unwrap();
    assert_eq!(results["uncaptured"], serde_json::json!([]), "errors outside of error scopes");
    for (effect, what, expected) in &drawn {
        let result = &results["results"][what];
        let image = &result["runs"][0]["images"][0];
        let image = image.as_array().unwrap_or_else(|| panic!("{what}: {}", result["error"]));
        let seen: Vec<[f32; 4]> = image.iter().map(pixel).collect();
        effect.assert_image(what, &seen, expected);
    }
    assert!(drawn.len() >= 2 * effects::EFFECTS.len(), "{} images", drawn.len());
}

#[test]
fn every_technique_in_chromium() {
    let folder = folder("chromium");
    let jobs = jobs::techniques(&jobs::Runs::Whole);
    jobs::write(&jobs, &folder, "page.json");
    jobs::write_plan(&program("buffer Glass from ab_sb { }"), &folder.join("passes"));
    let results = chromium::results(&folder);
    let images = compare(&jobs, &results);
    println!("{} techniques, {images} images in Chromium", jobs.len());
    // The page of the guide's example, with a technique whose frames wait for the device.
    assert_eq!(results["example"]["said"], "");
    assert!(results["example"]["colours"].as_u64().unwrap() > 1000, "{}", results["example"]);
    // Two need what no browser has: 64-bit atomic operations, and a forced early depth test.
    assert_eq!(jobs.len() + 2, Registry::builtin().techniques().len());
}

/// The guide's picture is what its example draws: with the k best fragments, and with all of them. `INSTA_UPDATE=always` updates it.
#[test]
fn the_guide_shows_what_its_example_draws() {
    let folder = folder("knot");
    let drawn = ["buffer Glass from mdt32_coplanar { keep 16; }", "buffer Glass from ab_sb { }"].map(|description| {
        let passes = folder.join("passes");
        jobs::write_plan(&program(description), &passes);
        let file = folder.join("pixels");
        node("knot.mjs", &[&passes, &file]);
        let pixels = std::fs::read(&file).unwrap();
        pixels.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect::<Vec<u8>>()
    });
    let path = root().join("examples/web/knot.png");
    let [width, height] = [640, 480];
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        let mut encoder = png::Encoder::new(std::fs::File::create(&path).unwrap(), width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::High);
        encoder.write_header().unwrap().write_image_data(&drawn[0]).unwrap();
    }
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut shown = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut shown).unwrap();
    assert_eq!((info.width, info.height, info.color_type), (width, height, png::ColorType::Rgb));
    let differs = |a: &[u8], b: &[u8]| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    assert!(!differs(&drawn[0], &drawn[1]), "the k best fragments of the knot are not all of them");
    assert!(
        !differs(&drawn[0], &shown),
        "examples/web/knot.png is another picture: run the test with INSTA_UPDATE=always"
    );
    let background = drawn[0].chunks_exact(3).filter(|pixel| *pixel == &drawn[0][..3]).count();
    assert!((100_000..250_000).contains(&background), "{background} pixels show no glass");
}

/// Returns the passes of a description in portable WGSL.
fn program(description: &str) -> fragbuf::Generation {
    let variant = checked(&text(description), &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let request = Request { targets: &[fragbuf::target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    generate(&variant, &request, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

#[test]
fn formulas_host_functions_and_slots() {
    assert_eq!(node("parts.mjs", &[]), "the parts are right\n");
}

/// Every run of a pass is measured, runs are summed by the pass's name, and nothing is measured unless it is requested.
#[test]
fn passes_have_times_if_they_are_requested() {
    let folder = folder("times");
    for (name, description) in [("list", "buffer List from ab_ll { }"), ("peeling", "buffer Peeling from f2b_ll { }")] {
        jobs::write_plan(&program(description), &folder.join(name));
    }
    assert_eq!(node("times.mjs", &[&folder]), "the times are right\n");
}

/// A frame in slices has the greatest value that one of its slices decides, and later frames use it.
#[test]
fn decisions_that_lag_hold_for_every_slice() {
    let folder = folder("lag");
    let predicted = program("buffer Few from mdt32_coplanar { allocation: predicted; }");
    jobs::write_plan(&predicted, &folder.join("predicted"));
    assert_eq!(node("lag.mjs", &[&folder]), "decisions that lag are right\n");
}

/// The page of the playground compiles nothing again that has failed, and copies boxes of objects once.
#[test]
fn the_page_repeats_no_failure() {
    let folder = folder("frames");
    jobs::write_plan(&program("buffer Peeled from f2b { objects: unpeeled; }"), &folder.join("boxes"));
    assert_eq!(node("frames.mjs", &[&folder]), "the frames of the page are right\n");
}

/// Mistakes of a caller, what an adapter lacks, lost devices and lost fragments: each is an error or a report, in words.
#[test]
fn every_mistake_is_an_error_that_says_what_to_do() {
    let folder = folder("misuse");
    let uniforms = "buffer Custom from kplus_array {
        fragment { color: rgba8, depth: f32 }
        uniform { cut: f32, eye: vec3, steps: u32, offset: i32, texture: vec2, tint: vec4 }
        keep 5;
        where |f, u| f.depth > u.cut + u.eye.x * (u.steps as f32) + (u.offset as f32) * u.texture.x * u.tint.x;
    }";
    for (name, description, target, form) in [
        ("list", "buffer List from ab_ll { }", "wgsl", Form::Program),
        ("regions", "buffer Regions from ab_sb { }", "wgsl", Form::Program),
        ("uniforms", uniforms, "wgsl", Form::Program),
        ("external", "buffer Behind from ab_ll { opaque: in_shader; }", "wgsl", Form::Program),
        ("boxes", "buffer Peeled from f2b { objects: unpeeled; }", "wgsl", Form::Program),
        ("module", "buffer List from ab_ll { }", "wgsl", Form::Module),
        ("glsl", "buffer List from ab_ll { }", "glsl", Form::Program),
    ] {
        let variant = checked(&text(description), &[]).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
        let request = Request { targets: &[fragbuf::target(target).unwrap()], form, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &Registry::builtin()).unwrap();
        jobs::write_plan(&generation, &folder.join(name));
    }
    let printed = node("misuse.mjs", &[&folder]);
    assert!(printed.ends_with(" mistakes\n"), "{printed}");
}
