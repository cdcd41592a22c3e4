//! Pictures by the built command, against an oracle that needs no rasteriser: quads that cover whole pixels, in clip space.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragbuf::Registry;
use fragbuf::vocabulary::{Fact, KeepDefault, Technique};
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

/// The nearest `keep` fragments over an opaque background, by the oracle whose laws `oracle.rs` tests.
fn oracle(quads: &[Quad], keep: Option<usize>, x: usize, y: usize, background: [f64; 3]) -> [f64; 3] {
    let covers = |quad: &&Quad| (quad.x0..quad.x1).contains(&x) && (quad.y0..quad.y1).contains(&y);
    let mut fragments: Vec<&Quad> = quads.iter().filter(covers).collect();
    fragments.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let nearest = fragments.iter().take(keep.unwrap_or(usize::MAX));
    let layers: Vec<(f32, [f32; 4])> =
        nearest.map(|quad| (quad.depth as f32, quad.color.map(|channel| channel as f32))).collect();
    let front = over(&layers).map(f64::from);
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

/// Red, green, blue and alpha of every pixel.
pub fn read(path: &Path) -> (u32, u32, Vec<[u8; 4]>) {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgba);
    (info.width, info.height, bytes.chunks_exact(4).map(|pixel| pixel.try_into().unwrap()).collect())
}

/// The device without a driver, and a driver without a GPU.
const DEVICES: [&str; 2] = ["cpu", "llvmpipe"];

/// The command of the README with these arguments, and its picture, which is the same within 1/255 on both devices.
fn render(folder: &Path, arguments: &[&str]) -> Vec<[u8; 4]> {
    let [own, driver] = DEVICES.map(|device| render_on(device, folder, arguments));
    for (own, driver) in own.iter().zip(&driver) {
        assert!(own.iter().zip(driver).all(|(a, b)| a.abs_diff(*b) <= 1), "{arguments:?}: {own:?}, and not {driver:?}");
    }
    own
}

fn render_on(device: &str, folder: &Path, arguments: &[&str]) -> Vec<[u8; 4]> {
    let out = folder.join("o.png");
    let size = format!("{SIZE}x{SIZE}");
    let common = ["--camera", "clip", "--shading", "flat", "--linear", "--size", &size, "--out", out.to_str().unwrap()];
    let output = fragbuf(&[&["render", "--device", device], arguments, &common].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    assert!(!stderr(&output).contains("warning"), "{}", stderr(&output));
    let (width, height, pixels) = read(&out);
    assert_eq!((width as usize, height as usize), (SIZE, SIZE));
    pixels
}

/// Within 1/255 of the oracle, everywhere.
fn check(key: &str, k: Option<usize>, count: usize, seed: u64, colors: Colors, background: [f64; 3]) {
    let folder = folder(&format!("{key}-{count}-{seed}-{colors:?}"));
    let quads = quads(count, seed, colors);
    let model = write(&folder, &quads);
    let back = background.map(|channel| channel.to_string()).join(",") + ",1";
    let set = k.map(|k| format!("k={k}"));
    let mut arguments = vec![key, "--scene", model.to_str().unwrap(), "--background", &back];
    arguments.extend(set.iter().flat_map(|set| ["--set", set.as_str()]));
    let pixels = DEVICES.into_iter().flat_map(|device| render_on(device, &folder, &arguments).into_iter().enumerate());
    for (index, pixel) in pixels {
        let (x, y) = (index % SIZE, index / SIZE);
        let expected = oracle(&quads, k, x, y, background);
        assert_eq!(pixel[3], 255);
        for (seen, expected) in pixel.iter().zip(expected) {
            let apart = (f64::from(*seen) - 255.0 * expected).abs();
            assert!(
                apart <= 1.0,
                "{key}, {count} quads, seed {seed}: pixel {x}, {y} is {seen}, and not {}",
                255.0 * expected
            );
        }
    }
}

/// The techniques that keep all, or the k best of all: what keeps neither is tested against an oracle of its own, in
/// `backends/run/runtime/tests/losses.rs`. On a software driver, which runs the fragments of a pixel one after the
/// other, those are exact too whose races lose fragments elsewhere. What keeps one alone is tried with one, below.
fn techniques(keep: KeepDefault) -> Vec<String> {
    let registry = Registry::builtin();
    let keeps = |technique: &Technique, fact: Fact| {
        let storage = technique.choices.iter().find(|(axis, _)| *axis == "storage").unwrap().1;
        registry.row("storage", storage).unwrap().offers.contains(&fact)
    };
    let alike = registry
        .techniques()
        .iter()
        .filter(|technique| (technique.keep == KeepDefault::All) == (keep == KeepDefault::All))
        .filter(|technique| keeps(technique, Fact::KeepsAll) || keeps(technique, Fact::KeepsBest))
        .filter(|technique| technique.keep != KeepDefault::Best(1));
    alike.map(|technique| technique.key.clone()).collect()
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

/// The depth test.
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

/// A storage of the user's own, with as much room as any pixel needs: the picture is everybody's.
#[test]
fn a_storage_of_the_users_own_is_within_a_255th_of_the_oracle() {
    for (seed, (k, count)) in (1..).zip([(8, 5), (40, 40), (60, 60)]) {
        check("examples/own_storage/first_k.fragbuf", Some(k), count, seed, Colors::Bytes, [0.0, 0.3, 0.0]);
    }
}

/// Beyond its room it keeps what came first: a software driver runs the fragments of a pixel in the order of drawing.
#[test]
fn a_storage_of_the_users_own_loses_what_its_file_says() {
    let folder = folder("own-first");
    let mut quads = quads(5, 11, Colors::Bytes);
    for quad in &mut quads {
        (quad.x0, quad.y0, quad.x1, quad.y1) = (0, 0, SIZE, SIZE);
    }
    let model = write(&folder, &quads);
    let out = folder.join("o.png");
    let first_k = "examples/own_storage/first_k.fragbuf";
    let common = ["--camera", "clip", "--shading", "flat", "--linear", "--size", "32x32", "--device", "cpu", "--json"];
    let what = ["render", first_k, "--set", "k=3", "--background", "0,0,0,1", "--scene", model.to_str().unwrap()];
    let output = fragbuf(&[&what, &common[..], &["--out", out.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(figures["lost"]["displaced"], 2 * SIZE * SIZE, "{figures}");
    let expected = oracle(&quads[..3], None, 0, 0, [0.0; 3]);
    for (seen, expected) in read(&out).2[0].iter().zip(expected) {
        assert!((f64::from(*seen) - 255.0 * expected).abs() <= 1.0, "{seen}, and not {}", 255.0 * expected);
    }
}

/// But for those whose slots have no room for more than the papers' payload: they are drawn with that.
#[test]
fn colors_that_are_no_255ths_are_not_rounded_layer_by_layer() {
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
fn the_payload_is_the_papers_where_it_rounds_nothing_or_is_asked_for() {
    let folder = folder("payload-choice");
    let format = |colors: Colors, more: &[&str]| {
        let model = write(&folder, &quads(3, 1, colors));
        let (model, out) = (model.to_str().unwrap(), folder.join("o.png"));
        let common = ["--scene", model, "--size", "8x8", "--camera", "clip", "--device", "cpu", "--json", "--out"];
        let output = fragbuf(&[&["render", "kplus_array"], &common[..], &[out.to_str().unwrap()], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
        figures["fragment"]["color"].as_str().unwrap().to_owned()
    };
    assert_eq!(format(Colors::Bytes, &["--shading", "flat"]), "rgba8");
    assert_eq!(format(Colors::Thin, &["--shading", "flat"]), "rgba16");
    assert_eq!(format(Colors::Thin, &["--shading", "flat", "--set", "fragment.color=rgba8"]), "rgba8");
    assert_eq!(format(Colors::Thin, &["--shading", "lit"]), "rgba8");
}

#[test]
fn more_layers_than_there_was_room_for_are_not_lost() {
    // More than eight per pixel, for which room is made, and more than 64, which a resolve pass holds.
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
            assert!((f64::from(*seen) - 255.0 * expected).abs() <= 1.0, "{key}: {:?}, and not {expected}", pixels[0]);
        }
    }
}

#[test]
fn a_picture_in_slices_is_the_picture() {
    // 256² pixels of 1024 entries are 256 MiB: twice what a software driver binds.
    let folder = folder("slices");
    let picture = |k: &str| {
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
        let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
        (read(&out).2, figures["fragments"].clone())
    };
    assert!(picture("k=64") == picture("k=1024"));
}

#[test]
fn what_is_lost_all_the_same_is_said() {
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
fn figures_are_json_on_stdout_and_add_up() {
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
    let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
    let fragments =
        ["generated", "stored", "culled", "dropped"].map(|name| figures["fragments"][name].as_u64().unwrap());
    let [generated, stored, culled, dropped] = fragments;
    assert_eq!(generated, covered as u64);
    assert_eq!(generated, stored + culled + dropped);
    let layers =
        |x: usize, y: usize| quads.iter().filter(|q| (q.x0..q.x1).contains(&x) && (q.y0..q.y1).contains(&y)).count();
    let kept: usize = (0..SIZE * SIZE).map(|pixel| layers(pixel % SIZE, pixel / SIZE).min(2)).sum();
    assert_eq!(stored, kept as u64);
    assert_eq!(figures["hit_ratio"].as_f64().unwrap(), kept as f64 / covered as f64);
    // 2k + 2 words per pixel, and the counters.
    assert_eq!(figures["bytes"].as_u64().unwrap(), 4 * (32 * 32 * 6 + COUNTERS.len() as u64));
    assert!(figures["device"].is_string() && figures["ms"].is_object(), "{figures}");
}

#[test]
fn generated_scenes_are_the_same_every_time_and_differ_by_seed() {
    let folder = folder("builtin");
    let picture = |scene: &str| render(&folder, &["kplus_array", "--scene", scene]);
    let first = picture("builtin:slabs,n=16");
    assert_eq!(first, picture("builtin:slabs"));
    assert_ne!(first, picture("builtin:slabs,seed=2"));
    assert!(first.iter().any(|pixel| *pixel != first[0]));
}

#[test]
fn a_description_is_fed_by_name_and_its_uniforms_from_outside() {
    let folder = folder("payload");
    let text = "buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32, normal: octahedral, id: u32 }
        uniform { cut: f32, tint: vec3 }
        where |f, u| f.depth > u.cut;
        resolve |fragments, u| {
            let mut sum = vec4(0.0, 0.0, 0.0, 0.0);
            for f in fragments {
                if f.id == 1 { sum = u.tint.extend(1.0); }
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
    assert_eq!(with(&[]), [0, 0, 0, 255]);
    assert_eq!(with(&["--uniform", "tint=0,1,0.2"]), [0, 255, 51, 255]);
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
    assert!(stderr(&output).contains("warning") && stderr(&output).contains("uniforms"), "{}", stderr(&output));
    assert!(read(&out).2.iter().all(|pixel| *pixel == [255; 4]), "only the background is seen");
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
        (&["kb", "--scene", &broken], 1, "broken.obj:4: no position 4: there are 3 so far"),
        (&[&lacking, "--scene", "builtin:cubes"], 1, "`heat: f32`"),
        (&["no_such", "--scene", "builtin:cubes"], 1, "there is no technique"),
        (&["kb", "--scene", "nowhere.obj"], 3, "nowhere.obj"),
        (&["kb", "--scene", "builtin:teapot"], 2, "cubes, slabs, marbles, hairball, needles"),
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
fn comparing_says_how_far_two_techniques_are_apart() {
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
    let apart = compare("kb");
    assert!(apart["hit_ratio"][1].as_f64().unwrap() <= 1.0 && apart["max_error"].as_f64().unwrap() < 1.0, "{apart}");
}

#[test]
fn devices_are_listed() {
    let output = fragbuf(&["devices"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(String::from_utf8(output.stdout).unwrap().lines().any(|line| line.contains("Cpu")));
}
