//! Compares images of the built command with an oracle that needs no rasteriser: quads that cover whole pixels, in clip space.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::Registry;
use fragbuf::vocabulary::{Capability, KeepDefault, Technique};
use fragbuf_templates::COUNTERS;
use serde_json::Value;

use crate::oracle::over;
use crate::quads::{Colors, Quad, SIZE, quads, write};

pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("render").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Returns the nearest `keep` fragments over an opaque background, by the reference that `oracle` tests.
fn oracle(quads: &[Quad], keep: Option<usize>, x: usize, y: usize, background: [f64; 3]) -> [f64; 3] {
    let covers = |quad: &&Quad| (quad.x0..quad.x1).contains(&x) && (quad.y0..quad.y1).contains(&y);
    let mut fragments: Vec<&Quad> = quads.iter().filter(covers).collect();
    fragments.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let nearest = fragments.iter().take(keep.unwrap_or(usize::MAX));
    let layers: Vec<(f32, [f32; 4])> =
        nearest.map(|quad| (quad.depth as f32, quad.color.map(|channel| channel as f32))).collect();
    let front = over(&layers);
    std::array::from_fn(|channel| front[channel] + (1.0 - front[3]) * background[channel])
}

pub fn fragbuf(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Reads a PNG: width, height, and red, green, blue and alpha of every pixel.
pub fn read(path: &Path) -> (u32, u32, Vec<[u8; 4]>) {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgba);
    (info.width, info.height, bytes.chunks_exact(4).map(|pixel| pixel.try_into().unwrap()).collect())
}

/// The CPU device, and a software driver.
const DEVICES: [&str; 2] = ["cpu", "llvmpipe"];

/// Renders an image with `fragbuf render`. Both devices must agree within 1/255.
fn render(folder: &Path, arguments: &[&str]) -> Vec<[u8; 4]> {
    let [cpu, driver] = DEVICES.map(|device| render_on(device, folder, arguments));
    for (cpu, driver) in cpu.iter().zip(&driver) {
        assert!(cpu.iter().zip(driver).all(|(a, b)| a.abs_diff(*b) <= 1), "{arguments:?}: {cpu:?}, not {driver:?}");
    }
    cpu
}

fn render_on(device: &str, folder: &Path, arguments: &[&str]) -> Vec<[u8; 4]> {
    let out = folder.join("o.png");
    let size = format!("{SIZE}x{SIZE}");
    let common =
        ["--camera", "clip", "--shading", "unlit", "--linear", "--size", &size, "--out", out.to_str().unwrap()];
    let output = fragbuf(&[&["render", "--device", device], arguments, &common].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    assert!(!stderr(&output).contains("warning"), "{}", stderr(&output));
    let (width, height, pixels) = read(&out);
    assert_eq!((width as usize, height as usize), (SIZE, SIZE));
    pixels
}

/// Checks that every pixel is within 1/255 of the oracle.
fn check(key: &str, k: Option<usize>, count: usize, seed: u64, colors: Colors, background: [f64; 3]) {
    let folder = folder(&format!("{key}-{count}-{seed}-{colors:?}"));
    let quads = quads(count, seed, colors);
    let model = write(&folder, &quads);
    let back = background.map(|channel| channel.to_string()).join(",") + ",1";
    let set = k.map(|k| format!("k={k}"));
    let kept = k.filter(|_| !keeps_later(key));
    let mut arguments = vec![key, "--scene", model.to_str().unwrap(), "--background", &back];
    arguments.extend(set.iter().flat_map(|set| ["--set", set.as_str()]));
    let pixels = DEVICES.into_iter().flat_map(|device| render_on(device, &folder, &arguments).into_iter().enumerate());
    for (index, pixel) in pixels {
        let (x, y) = (index % SIZE, index / SIZE);
        let expected = oracle(&quads, kept, x, y, background);
        assert_eq!(pixel[3], 255);
        for (seen, expected) in pixel.iter().zip(expected) {
            let error = (f64::from(*seen) - 255.0 * expected).abs();
            assert!(
                error <= 1.0,
                "{key}, {count} quads, seed {seed}: pixel {x}, {y} is {seen}, not {}",
                255.0 * expected
            );
        }
    }
}

/// Returns whether a technique keeps every fragment, k in each of several iterations.
fn keeps_later(key: &str) -> bool {
    let registry = Registry::builtin();
    let rows = registry.technique(key).into_iter().flat_map(|technique| &technique.choices);
    let mut rows = rows.filter_map(|(axis, key)| registry.row(axis, key));
    rows.any(|row| row.provides.contains(&Capability::KeepsLater))
}

/// Returns the techniques that keep all fragments, or the k best.
///
/// `backends/run/runtime/tests/losses.rs` tests the others against their own oracle, and a test below those that keep one
/// fragment. A software driver runs the fragments of a pixel sequentially, so racy techniques are exact on it.
fn techniques(keep: KeepDefault) -> Vec<String> {
    let registry = Registry::builtin();
    let keeps = |technique: &Technique, capability: Capability| {
        let storage = technique.choices.iter().find(|(axis, _)| *axis == "storage").unwrap().1;
        registry.row("storage", storage).unwrap().provides.contains(&capability)
    };
    let selected = registry
        .techniques()
        .iter()
        .filter(|technique| (technique.keep == KeepDefault::All) == (keep == KeepDefault::All))
        .filter(|technique| keeps(technique, Capability::KeepsAll) || keeps(technique, Capability::KeepsBest))
        .filter(|technique| technique.keep != KeepDefault::Best(1));
    selected.map(|technique| technique.key.clone()).collect()
}

#[test]
fn the_k_best_are_within_a_255th_of_the_oracle() {
    for (seed, (k, count)) in (1..).zip([(8, 5), (8, 40), (1, 12), (3, 25), (16, 60)]) {
        for key in techniques(KeepDefault::Best(8)) {
            check(&key, Some(k), count, seed, Colors::Bytes, [0.0; 3]);
        }
    }
    check("kplus_array", Some(8), 30, 99, Colors::Bytes, [0.2, 0.9, 0.5]);
}

/// The depth test selects the nearest fragment.
#[test]
fn the_nearest_is_within_a_255th_of_the_oracle() {
    for (seed, count) in (1..).zip([1, 12, 60]) {
        check("z_buffer", Some(1), count, seed, Colors::Bytes, [0.2, 0.9, 0.5]);
    }
    check("z_buffer", Some(1), 30, 7, Colors::Thin, [0.0; 3]);
}

#[test]
fn all_fragments_are_within_a_255th_of_the_oracle() {
    for (seed, count) in (1..).zip([1, 9, 40, 60]) {
        for key in techniques(KeepDefault::All) {
            check(&key, None, count, seed, Colors::Bytes, [0.0; 3]);
        }
    }
}

/// A user storage with sufficient capacity renders the exact image.
#[test]
fn a_user_storage_is_within_a_255th_of_the_oracle() {
    for (seed, (k, count)) in (1..).zip([(8, 5), (40, 40), (60, 60)]) {
        check("examples/user_storage/first_k.fragbuf", Some(k), count, seed, Colors::Bytes, [0.0, 0.3, 0.0]);
    }
}

/// Beyond its capacity the storage keeps the first fragments: the CPU device runs the fragments of a pixel in draw order.
#[test]
fn a_user_storage_loses_the_fragments_beyond_its_capacity() {
    let folder = folder("user-storage");
    let mut quads = quads(5, 11, Colors::Bytes);
    for quad in &mut quads {
        (quad.x0, quad.y0, quad.x1, quad.y1) = (0, 0, SIZE, SIZE);
    }
    let model = write(&folder, &quads);
    let out = folder.join("o.png");
    let first_k = "examples/user_storage/first_k.fragbuf";
    let common = ["--camera", "clip", "--shading", "unlit", "--linear", "--size", "32x32", "--device", "cpu", "--json"];
    let arguments = ["render", first_k, "--set", "k=3", "--background", "0,0,0,1", "--scene", model.to_str().unwrap()];
    let output = fragbuf(&[&arguments, &common[..], &["--out", out.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let statistics: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(statistics["fragments"]["displaced"], 2 * SIZE * SIZE, "{statistics}");
    let expected = oracle(&quads[..3], None, 0, 0, [0.0; 3]);
    for (seen, expected) in read(&out).2[0].iter().zip(expected) {
        assert!((f64::from(*seen) - 255.0 * expected).abs() <= 1.0, "{seen}, not {}", 255.0 * expected);
    }
}

/// Techniques whose slots hold no more than the papers' payload are the exception: they use that payload.
#[test]
fn colors_that_are_not_255ths_are_not_rounded_layer_by_layer() {
    let registry = Registry::builtin();
    let narrow = |key: &String| {
        let storage = registry.technique(key).unwrap().choices.iter().find(|(axis, _)| *axis == "storage").unwrap().1;
        registry.row("storage", storage).unwrap().conditions.iter().any(|one| one.formula.mentions("entry_words"))
    };
    let (narrow, others): (Vec<String>, Vec<String>) = techniques(KeepDefault::Best(8)).into_iter().partition(narrow);
    for key in others {
        check(&key, Some(8), 60, 7, Colors::Thin, [0.0; 3]);
    }
    let folder = folder("narrow");
    let model = write(&folder, &quads(60, 7, Colors::Thin));
    for key in narrow {
        let pixels = render(&folder, &[&key, "--scene", model.to_str().unwrap(), "--background", "0,0,0,1"]);
        let papers = ["kplus_array", "--set", "fragment.color=rgba8", "--scene", model.to_str().unwrap()];
        assert_eq!(pixels, render(&folder, &[&papers[..], &["--background", "0,0,0,1"]].concat()), "{key}");
    }
    for key in techniques(KeepDefault::All) {
        check(&key, None, 60, 8, Colors::Thin, [0.0; 3]);
    }
}

#[test]
fn the_payload_is_that_of_the_papers_if_it_is_exact_or_requested() {
    let folder = folder("payload-choice");
    let format = |colors: Colors, more: &[&str]| {
        let model = write(&folder, &quads(3, 1, colors));
        let (model, out) = (model.to_str().unwrap(), folder.join("o.png"));
        let common = ["--scene", model, "--size", "8x8", "--camera", "clip", "--device", "cpu", "--json", "--out"];
        let output = fragbuf(&[&["render", "kplus_array"], &common[..], &[out.to_str().unwrap()], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let statistics: Value = serde_json::from_slice(&output.stdout).unwrap();
        statistics["fragment"]["color"].as_str().unwrap().to_owned()
    };
    assert_eq!(format(Colors::Bytes, &["--shading", "unlit"]), "rgba8");
    assert_eq!(format(Colors::Thin, &["--shading", "unlit"]), "rgba16");
    assert_eq!(format(Colors::Thin, &["--shading", "unlit", "--set", "fragment.color=rgba8"]), "rgba8");
    assert_eq!(format(Colors::Thin, &["--shading", "lit"]), "rgba8");
}

/// A user file that reads the word of the colour determines the format of the colour, whatever the colours of the scene are.
#[test]
fn a_user_file_keeps_the_payload_it_reads() {
    let folder = folder("payload-of-a-file");
    let model = write(&folder, &quads(3, 1, Colors::Thin));
    let source =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/user_storage/first_k.wgsl"));
    let read = "    return slots_load(cursor, pixel);";
    let red = "    var entry = slots_load(cursor, pixel);\n    entry.color = 0xff0000ffu;\n    return entry;";
    let source = source.unwrap();
    assert!(source.contains(read), "{source}");
    std::fs::write(folder.join("red.wgsl"), source.replace(read, red)).unwrap();
    let description = folder.join("red.fragbuf");
    std::fs::write(&description, "buffer Red {\n    storage: wgsl(\"red.wgsl\");\n    keep 8;\n}\n").unwrap();
    let pixels = render(
        &folder,
        &[description.to_str().unwrap(), "--scene", model.to_str().unwrap(), "--background", "0,0,0,1"],
    );
    let covered = pixels.iter().filter(|pixel| **pixel != [0, 0, 0, 255]);
    assert!(covered.clone().count() > 0 && covered.clone().all(|pixel| *pixel == [255, 0, 0, 255]));
}

#[test]
fn a_pool_overflow_loses_no_layers() {
    // More than eight per pixel, the initial pool size, and more than 64, the layers that a resolve pass holds.
    for key in ["ab_ll", "ab_sb"] {
        let folder = folder(&format!("deep-{key}"));
        let mut quads = quads(150, 5, Colors::Bytes);
        for quad in &mut quads {
            (quad.x0, quad.y0, quad.x1, quad.y1) = (0, 0, SIZE, SIZE);
            quad.color[3] = 2.0 / 255.0;
        }
        let model = write(&folder, &quads);
        let pixels = render(&folder, &[key, "--scene", model.to_str().unwrap(), "--background", "0,0,0,1"]);
        let expected = oracle(&quads, None, 0, 0, [0.0; 3]);
        for (seen, expected) in pixels[0].iter().zip(expected) {
            assert!((f64::from(*seen) - 255.0 * expected).abs() <= 1.0, "{key}: {:?}, not {expected}", pixels[0]);
        }
    }
}

#[test]
fn slices_do_not_change_the_image() {
    // 256² pixels of 1024 entries need 256 MiB: twice the binding limit of a software driver.
    let folder = folder("slices");
    let image = |k: &str| {
        let out = folder.join(format!("{k}.png"));
        let view = [
            "--scene",
            "builtin:slabs,n=40",
            "--camera",
            "clip",
            "--size",
            "256x256",
            "--device",
            "llvmpipe",
            "--json",
        ];
        let output =
            fragbuf(&[&["render", "kplus_array", "--set", k, "--out", out.to_str().unwrap()], &view[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let statistics: Value = serde_json::from_slice(&output.stdout).unwrap();
        (read(&out).2, statistics["fragments"].clone())
    };
    assert!(image("k=64") == image("k=1024"));
}

#[test]
fn remaining_losses_are_reported() {
    let folder = folder("lost");
    let mut quads = quads(12, 3, Colors::Bytes);
    quads.iter_mut().for_each(|quad| (quad.x0, quad.y0, quad.x1, quad.y1) = (0, 0, SIZE, SIZE));
    let (model, out) = (write(&folder, &quads), folder.join("o.png"));
    let (model, out) = (model.to_str().unwrap(), out.to_str().unwrap());
    let output = fragbuf(&[
        "render",
        "ab_ll",
        "--set",
        "sort.layers=4",
        "--scene",
        model,
        "--size",
        "32x32",
        "--camera",
        "clip",
        "--out",
        out,
    ]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("8192 fragments lost: layers_exceeded"), "{}", stderr(&output));
}

#[test]
fn statistics_are_json_on_stdout_and_add_up() {
    let folder = folder("json");
    let quads = quads(40, 8, Colors::Bytes);
    let (model, out) = (write(&folder, &quads), folder.join("o.png"));
    let covered: usize = quads.iter().map(|quad| (quad.x1 - quad.x0) * (quad.y1 - quad.y0)).sum();
    let (model, out) = (model.to_str().unwrap(), out.to_str().unwrap());
    let output = fragbuf(&[
        "render",
        "kplus_array",
        "--set",
        "k=2",
        "--scene",
        model,
        "--size",
        "32x32",
        "--camera",
        "clip",
        "--out",
        out,
        "--json",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let statistics: Value = serde_json::from_slice(&output.stdout).unwrap();
    let fragments = ["generated", "stored", "culled", "displaced"];
    let [generated, stored, culled, displaced] = fragments.map(|name| statistics["fragments"][name].as_u64().unwrap());
    let lost = &statistics["lost"];
    let losses = lost["by_counter"].as_object().unwrap().values();
    assert_eq!(lost["total"], losses.map(|count| count.as_u64().unwrap()).sum::<u64>(), "{statistics}");
    assert_eq!(generated, covered as u64);
    assert_eq!(generated, stored + culled + displaced + lost["total"].as_u64().unwrap());
    let layers =
        |x: usize, y: usize| quads.iter().filter(|q| (q.x0..q.x1).contains(&x) && (q.y0..q.y1).contains(&y)).count();
    let kept: usize = (0..SIZE * SIZE).map(|pixel| layers(pixel % SIZE, pixel / SIZE).min(2)).sum();
    assert_eq!(stored, kept as u64);
    assert_eq!(statistics["hit_ratio"].as_f64().unwrap(), kept as f64 / covered as f64);
    // 2k + 2 words per pixel, and the counters.
    assert_eq!(statistics["bytes"].as_u64().unwrap(), 4 * (32 * 32 * 6 + COUNTERS.len() as u64));
    assert!(statistics["device"].is_string() && statistics["ms"].is_object(), "{statistics}");
}

#[test]
fn generated_scenes_are_the_same_every_time_and_differ_by_seed() {
    let folder = folder("builtin");
    let image = |scene: &str| render(&folder, &["kplus_array", "--scene", scene]);
    let first = image("builtin:slabs,n=16");
    assert_eq!(first, image("builtin:slabs"));
    assert_ne!(first, image("builtin:slabs,seed=2"));
    assert!(first.iter().any(|pixel| *pixel != first[0]));
}

#[test]
fn attribute_names_select_scene_data_and_arguments_set_uniforms() {
    let folder = folder("payload");
    let text = "buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32, normal: octahedral, id: u32 }
        uniform { cut: f32, tint: vec3 }
        where |f, u| f.depth > u.cut;
        resolve |fragments, u| {
            let mut sum = vec4(0.0, 0.0, 0.0, 0.0);
            for f in fragments {
                if f.id == 1 && f.color.w > 0.0 && f.normal.z < 2.0 { sum = u.tint.extend(1.0); }
            }
            sum
        }
    }";
    let description = folder.join("glass.fragbuf");
    std::fs::write(&description, text).unwrap();
    let model = write(&folder, &[Quad { x0: 0, y0: 0, x1: SIZE, y1: SIZE, depth: 0.25, color: [0.5; 4] }; 2]);
    let (description, model) = (description.to_str().unwrap(), model.to_str().unwrap());
    let with = |uniforms: &[&str]| {
        render(&folder, &[&[description, "--scene", model, "--background", "0,0,0,1"], uniforms].concat())[0]
    };
    assert_eq!(with(&["--uniform", "cut=0", "--uniform", "tint=0,0,0"]), [0, 0, 0, 255]);
    assert_eq!(with(&["--uniform", "cut=0", "--uniform", "tint=0,1,0.2"]), [0, 255, 51, 255]);
    let out = folder.join("none.png");
    let output = fragbuf(&[
        "render",
        description,
        "--scene",
        model,
        "--uniform",
        "cut=0.5",
        "--size",
        "8x8",
        "--camera",
        "clip",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("the uniform `tint` is 0"), "{}", stderr(&output));
    assert!(read(&out).2.iter().all(|pixel| *pixel == [255; 4]), "only the background is visible");
}

#[test]
fn failures_have_their_exit_codes_and_write_nothing() {
    let folder = folder("failures");
    let out = folder.join("o.png");
    let path = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let broken = path("broken.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n");
    let lacking = path("lacking.fragbuf", "buffer B from kb { fragment { color: rgba8, depth: f32, heat: f32 } }");
    let cases: [(&[&str], i32, &str); 9] = [
        (&["kb", "--scene", &broken], 1, "broken.obj:4: no position 4: the file has 3"),
        (&[&lacking, "--scene", "builtin:cubes"], 1, "`heat: f32`"),
        (&["no_such", "--scene", "builtin:cubes"], 1, "unknown technique"),
        (&["kb", "--scene", "nowhere.obj"], 3, "nowhere.obj"),
        (&["kb", "--scene", "builtin:teapot"], 2, "cubes, slabs, layers, marbles, hairball, needles"),
        (&["kb", "--scene", "builtin:slabs,m=3"], 2, "n (16), seed (1)"),
        (&["kb", "--scene", "builtin:cubes", "--uniform", "x=1"], 2, "no uniform `x`"),
        (&["kb", "--scene", "builtin:cubes", "--size", "0x4"], 2, "WIDTHxHEIGHT"),
        (&["kb", "--scene", "builtin:cubes", "--device", "no such adapter"], 3, "no adapter is named"),
    ];
    for (arguments, code, text) in cases {
        let size: &[&str] = if arguments.contains(&"--size") { &[] } else { &["--size", "8x8"] };
        let output = fragbuf(&[&["render"], arguments, size, &["--out", out.to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(text), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty() && !out.exists(), "{arguments:?}");
    }
    let output = fragbuf(&["render", "kb", "--scene", "builtin:cubes", "--size", "8x8", "--out", "/nowhere/o.png"]);
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn compare_measures_the_difference_between_two_techniques() {
    let folder = folder("compare");
    let out = folder.join("heat.png");
    let compare = |second: &str| {
        let common = [
            "--scene",
            "builtin:slabs,n=40",
            "--size",
            "48x32",
            "--device",
            "cpu",
            "--json",
            "--out",
            out.to_str().unwrap(),
        ];
        let output = fragbuf(&[&["compare", "ab_sb", second], &common[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(read(&out).0, 48);
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let same = compare("ab_ll");
    assert!(same["psnr"].is_null() && same["max_error"] == 0.0, "{same}");
    assert_eq!(same["hit_ratio"], serde_json::json!([1.0, 1.0]));
    let different = compare("kb");
    assert!(
        different["hit_ratio"][1].as_f64().unwrap() <= 1.0 && different["max_error"].as_f64().unwrap() < 1.0,
        "{different}"
    );
}

#[test]
fn devices_are_listed() {
    let output = fragbuf(&["devices"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(String::from_utf8(output.stdout).unwrap().lines().any(|line| line.contains("Cpu")));
}

/// A model of which a part is missing is drawn with a default and a warning, and `--strict` rejects it, without the default.
#[test]
fn missing_parts_of_models_are_warnings_or_errors() {
    let folder = folder("missing_parts");
    let (model, out) = (folder.join("m.obj"), folder.join("m.png"));
    let text =
        "mtllib none.mtl\nv -1 -1 0.5\nv 1 -1 0.5\nv 1 1 0.5\nv -1 1 0.5\nusemtl a\nf 1 2\nf 1//1 2//1 3//1 4//1\n";
    std::fs::write(&model, text).unwrap();
    let arguments =
        ["render", "ab_array", "--device", "cpu", "--camera", "clip", "--shading", "unlit", "--size", "4x4"];
    let color = ["--color", "0,0,1,1", "--scene", model.to_str().unwrap(), "--out", out.to_str().unwrap()];
    // What is missing, and what replaces it.
    let messages = [
        ("[missing-file]: FILE:1: no file `none.mtl`", "its materials have the default colour", ""),
        ("[missing-material]: FILE:6: unknown material `a`: no `mtllib` defines any", "the default colour is used", ""),
        ("[degenerate-face]: FILE:7: a face with 2 vertices, which needs 3 or more", "it is skipped", ""),
        ("[invalid-normal]: FILE:8: no normal 1: the file has 0", "it is computed", " (and 3 more)"),
    ];
    let file = model.to_str().unwrap();
    let warnings =
        messages.map(|(missing, instead, more)| format!("warning{missing}: {instead}{more}\n").replace("FILE", file));
    let errors = messages.map(|(missing, _, more)| format!("error{missing}{more}\n").replace("FILE", file));
    let note = "note: `--strict` rejects the model; without it, these are warnings\n";
    let drawn = fragbuf(&[&arguments[..], &color].concat());
    assert_eq!((drawn.status.code(), stderr(&drawn)), (Some(0), warnings.concat()));
    assert!(read(&out).2.iter().all(|pixel| *pixel == [0, 0, 255, 255]));
    std::fs::remove_file(&out).unwrap();
    let refused = fragbuf(&[&arguments[..], &color, &["--strict"]].concat());
    assert_eq!((refused.status.code(), stderr(&refused)), (Some(1), errors.concat() + note));
    assert!(!out.exists());
    // A model that is complete has no warnings.
    std::fs::write(&model, "v -1 -1 0.5\nv 1 -1 0.5\nv 1 1 0.5\nf 1 2 3\n").unwrap();
    let drawn = fragbuf(&[&arguments[..], &color, &["--strict"]].concat());
    assert_eq!((drawn.status.code(), stderr(&drawn)), (Some(0), String::new()));
}

#[test]
fn one_layer_alone_and_loops_that_end_on_the_device() {
    let folder = folder("layers");
    let model = write(&folder, &quads(9, 5, Colors::Bytes));
    let set = ["dual", "--scene", model.to_str().unwrap(), "--set", "peeling.iterations=24"];
    let drawn = |more: &[&str]| render(&folder, &[&set[..], more].concat());
    let whole = drawn(&[]);
    assert_eq!(drawn(&["--loops", "device"]), whole);
    let (front, back) = (drawn(&["--layer", "0"]), drawn(&["--layer", "1"]));
    assert_eq!(back, drawn(&["--set", "resolve=layer", "--set", "resolve.number=1"]));
    assert!(front != back && front != whole);
    let model = ["--scene", model.to_str().unwrap(), "--camera", "clip", "--out", "-"];
    let output = fragbuf(&[&["render", "f2b", "--layer", "40", "--device", "cpu"], &model[..]].concat());
    assert!(stderr(&output).contains("no pixel has the layer 40"), "{}", stderr(&output));
    let output = fragbuf(&["render", "kb_stream", "--scene", "builtin:marbles", "--layer", "0", "--out", "-"]);
    assert!(stderr(&output).contains("`resolve: layer`"), "{}", stderr(&output));
    assert_eq!(output.status.code(), Some(1));
}
