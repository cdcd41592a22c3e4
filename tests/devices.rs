//! Compares the CPU device with a software driver on whole scenes, and tests its orders and a machine without any driver.

use std::path::Path;
use std::process::{Command, Output};

use fragbuf::{Registry, check};
use fragbuf_scene::{Camera, Scene};
use serde_json::Value;

use crate::render::{folder, fragbuf, read, stderr};

const SIZE: (u32, u32) = (256, 192);

/// The distance between sampled pixels.
const STRIDE: usize = 331;

/// Renders an image and returns its pixels.
fn picture(out: &Path, arguments: &[&str]) -> Vec<[u8; 4]> {
    let size = format!("{}x{}", SIZE.0, SIZE.1);
    let common = ["--linear", "--size", &size, "--out", out.to_str().unwrap()];
    let output = fragbuf(&[&["render"], arguments, &common].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    read(out).2
}

/// A triangle on the screen: x and y in pixels, depth.
type Projected = [[f64; 3]; 3];

fn projected(scene: &Scene) -> Vec<Projected> {
    let matrix = Camera::framing(&[scene], SIZE.0 as f32 / SIZE.1 as f32).view_projection.map(f64::from);
    let project = |position: [f32; 3]| -> [f64; 3] {
        let [x, y, z] = position.map(f64::from);
        let row = |row: usize| matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row];
        let w = row(3);
        let (half_width, half_height) = (f64::from(SIZE.0) / 2.0, f64::from(SIZE.1) / 2.0);
        [half_width + row(0) / w * half_width, half_height - row(1) / w * half_height, row(2) / w]
    };
    let of =
        |object: &fragbuf_scene::Object, triangle: &[u32; 3]| triangle.map(|v| project(object.positions[v as usize]));
    scene.objects.iter().flat_map(|object| object.triangles.iter().map(move |triangle| of(object, triangle))).collect()
}

/// Returns whether two rasterisers may differ in a pixel: an edge passes within 1.5/256 of a pixel from its centre, or two depths differ
/// by less than their rounding, which is two ulp of a depth near one for each of the two devices.
fn is_explained(triangles: &[Projected], x: f64, y: f64) -> bool {
    const NEAR: f64 = 1.5 / 256.0;
    const TIE: f64 = 4.0 / 16_777_216.0;
    let mut depths = Vec::new();
    for [a, b, c] in triangles {
        let area = |p: &[f64], q: &[f64], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let whole = area(a, b, [c[0], c[1]]);
        let shares = [area(b, c, [x, y]), area(c, a, [x, y]), area(a, b, [x, y])];
        let lengths = [(b, c), (c, a), (a, b)].map(|(p, q)| (q[0] - p[0]).hypot(q[1] - p[1]));
        let distances = [0, 1, 2].map(|edge| shares[edge] * whole.signum() / lengths[edge].max(1e-12));
        let nearest = distances.into_iter().fold(f64::INFINITY, f64::min);
        if nearest.abs() < NEAR {
            return true;
        }
        if nearest > 0.0 {
            depths.push((shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2]) / whole);
        }
    }
    depths.sort_by(f64::total_cmp);
    depths.windows(2).any(|pair| pair[1] - pair[0] <= TIE)
}

#[test]
fn images_differ_from_the_drivers_only_at_edges_and_ties() {
    let folder = folder("devices");
    let pixels = (SIZE.0 * SIZE.1) as usize;
    for scene in ["builtin:cubes", "builtin:slabs,n=24", "builtin:marbles"] {
        let triangles =
            projected(&fragbuf_scene::open(scene, [0.15, 0.45, 0.35, 0.4], &fragbuf_scene::Limits::default()).unwrap());
        // The explanation is valid only if it applies to few pixels: tests a sample of all pixels.
        let sample: Vec<usize> = (0..pixels).step_by(STRIDE).collect();
        let may = |at: &usize| {
            is_explained(&triangles, (at % SIZE.0 as usize) as f64 + 0.5, (at / SIZE.0 as usize) as f64 + 0.5)
        };
        let explained = sample.iter().filter(|at| may(at)).count();
        println!("{scene}: {explained} of {} pixels may differ", sample.len());
        assert!(4 * explained < sample.len(), "{scene}: {explained} of {} pixels may differ", sample.len());
        for key in ["kplus_array", "ab_ll"] {
            let [cpu, driver] = ["cpu", "llvmpipe"].map(|device| {
                picture(&folder.join(format!("{device}.png")), &[key, "--scene", scene, "--device", device])
            });
            let differ = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
            let different: Vec<usize> = (0..pixels).filter(|pixel| differ((&cpu[*pixel], &driver[*pixel]))).collect();
            assert!(1000 * different.len() <= pixels, "{key}, {scene}: {} pixels differ", different.len());
            for pixel in different {
                let (x, y) = (pixel % SIZE.0 as usize, pixel / SIZE.0 as usize);
                println!(
                    "{key}, {scene}: pixel {x}, {y} is {:?} on the CPU device and {:?} on the driver",
                    cpu[pixel], driver[pixel]
                );
                let why = is_explained(&triangles, x as f64 + 0.5, y as f64 + 0.5);
                assert!(why, "{key}, {scene}: nothing explains {:?} and {:?} at {x}, {y}", cpu[pixel], driver[pixel]);
            }
        }
    }
}

/// Interleaving shows the hazards of B06, Fig. 3, in the image of `kb`. It changes no image of a technique without hazards.
#[test]
fn interleaving_changes_only_racy_images() {
    let folder = folder("orders");
    let registry = Registry::builtin();
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let draw = |order: &str| {
            let out = folder.join(format!("{key}.png"));
            picture(&out, &[key, "--scene", "builtin:marbles", "--device", "cpu", "--order", order])
        };
        let draft = fragbuf::Draft::from_technique(key, &fragbuf::SourceSpan::new(key, 1, 1));
        let plan = fragbuf_cpu::Code::of(&check(&draft, &registry).unwrap(), &registry).unwrap().plan;
        let clean = draw("submission");
        for seed in ["shuffle:1", "shuffle:2"] {
            let shuffled = draw(seed);
            assert!(!plan.hazards.is_empty() || shuffled == clean, "{key}, {seed}");
            if key == "kb" {
                let different = clean.iter().zip(&shuffled).filter(|(a, b)| a != b).count();
                assert!(different > 1000, "{key}, {seed}: {different} pixels show a hazard");
                assert!(shuffled == draw(seed), "the same seed renders the same image");
            }
        }
    }
}

/// The images of the gallery are the output of their commands.
#[test]
fn the_gallery_shows_the_hazards() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/gallery");
    let out = folder("gallery").join("kb_hazards.png");
    let common = ["--scene", "builtin:marbles", "--size", "240x180", "--device", "cpu", "--out", out.to_str().unwrap()];
    let different = |order: &str, shown: &str| {
        let output = fragbuf(&[&["render", "kb", "--order", order], &common[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let differ = |(a, b): &([u8; 4], [u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
        read(&out).2.into_iter().zip(read(&gallery.join(shown)).2).filter(differ).count()
    };
    assert_eq!(different("shuffle:1", "kb_hazards.png"), 0);
    assert_eq!(different("submission", "kb.png"), 0);
    assert!(different("shuffle:1", "kb.png") > 1000);
}

#[test]
fn order_works_only_on_the_cpu_device() {
    let folder = folder("order-rejected");
    let out = folder.join("o.png");
    let run = |order: &str, device: &str| {
        let common = ["--scene", "builtin:cubes", "--size", "8x8", "--out", out.to_str().unwrap()];
        fragbuf(&[&["render", "kb", "--order", order, "--device", device], &common[..]].concat())
    };
    let rejected = run("shuffle:1", "llvmpipe");
    assert_eq!(rejected.status.code(), Some(2));
    assert!(stderr(&rejected).contains("--device cpu"), "{}", stderr(&rejected));
    assert!(!out.exists());
    assert_eq!(run("shuffle:one", "cpu").status.code(), Some(2));
    assert_eq!(run("shuffle:1", "cpu").status.code(), Some(0));
    assert_eq!(run("window:1,64", "cpu").status.code(), Some(0));
    for order in ["window:1", "window:1,0", "window:x,2", "window:1,2,3"] {
        let rejected = run(order, "cpu");
        assert_eq!(rejected.status.code(), Some(2), "{order}");
        assert!(stderr(&rejected).contains("window:SEED,TRIANGLES"), "{}", stderr(&rejected));
    }
}

/// The first command of the README works on a machine without a driver.
#[test]
fn the_cpu_device_renders_without_a_driver() {
    let folder = folder("no-driver");
    let out = folder.join("o.png");
    let run = |arguments: &[&str]| -> Output {
        Command::new(env!("CARGO_BIN_EXE_fragbuf"))
            .args(arguments)
            .env("VK_DRIVER_FILES", "/nowhere")
            .env("VK_ICD_FILENAMES", "/nowhere")
            .env("WGPU_BACKEND", "vulkan")
            .output()
            .unwrap()
    };
    let listed = run(&["devices", "--json"]);
    assert_eq!(listed.status.code(), Some(0), "{}", stderr(&listed));
    let listed: Value = serde_json::from_slice(&listed.stdout).unwrap();
    assert_eq!(listed.as_array().unwrap().len(), 1, "{listed}");
    assert_eq!(listed[0]["auto"], "always");
    let common = ["--scene", "builtin:cubes", "--size", "32x24", "--json", "--out", out.to_str().unwrap()];
    let output = run(&[&["render", "kplus_array"], &common[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let statistics: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&statistics["device"], &statistics["backend"]), (&"cpu".into(), &"interpreter".into()), "{statistics}");
    assert_eq!(statistics["device_reason"], "no adapter found");
    assert!(
        statistics["fragments"]["generated"].as_u64().unwrap() > 100 && statistics["ms"]["store"].is_number(),
        "{statistics}"
    );
    assert_eq!(read(&out).0, 32);
}

/// Returns the devices of `fragbuf devices --json`: the name, and when `auto` selects it.
fn listed() -> Vec<(String, String)> {
    let output = fragbuf(&["devices", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    rows.iter().map(|row| (text(&row["name"]), text(&row["auto"]))).collect()
}

/// Renders with `--device auto` and returns the device and the reason: those of the JSON, which a note on stderr has without `--json`.
fn automatic(out: &Path, arguments: &[&str]) -> (String, String) {
    let run = |more: &[&str]| {
        let output = fragbuf(&[&["render"], arguments, &["--out", out.to_str().unwrap()], more].concat());
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        output
    };
    let with_json = run(&["--json"]);
    let statistics: Value = serde_json::from_slice(&with_json.stdout).unwrap();
    assert_eq!(stderr(&with_json), "", "{arguments:?}");
    let text = |name: &str| statistics[name].as_str().unwrap().to_owned();
    let (device, reason) = (text("device"), text("device_reason"));
    assert_eq!(stderr(&run(&[])), format!("note: rendering on {device}: {reason}\n"), "{arguments:?}");
    (device, reason)
}

/// Without a GPU `auto` selects the CPU device for little work and a driver for much; a GPU for both.
#[test]
fn auto_selects_the_device_by_the_work() {
    let folder = folder("auto");
    let out = folder.join("o.png");
    let devices = listed();
    let auto = |when: &str| devices.iter().find(|(_, auto)| auto == when).map(|(name, _)| name.as_str());
    let (gpu, few, many) = (auto("always"), auto("frames of few fragments"), auto("frames of many fragments"));
    assert!(gpu.is_some() != (few.is_some() && many.is_some()), "{devices:?}");
    let cubes = |key: &str, size: &str| automatic(&out, &[key, "--scene", "builtin:cubes", "--size", size]);
    for (size, expected) in [("48x32", few), ("1280x1280", many)] {
        let (device, reason) = cubes("kplus_array", size);
        assert_eq!(Some(device.as_str()), gpu.or(expected), "{size}: {reason}");
        assert!(gpu.is_some() || reason.starts_with("estimated to be faster than "), "{size}: {reason}");
        assert_eq!(cubes("kplus_array", size), (device, reason), "the selection does not depend on time");
    }
    // The camera decides how many fragments there are.
    let (device, _) = automatic(
        &out,
        &["kplus_array", "--scene", "builtin:cubes", "--size", "2048x2048", "--camera", "eye:0,0,60,fov:60"],
    );
    assert_eq!(Some(device.as_str()), gpu.or(many), "a frame of few fragments has many pixels");
    let (device, _) =
        automatic(&out, &["ab_sb", "--scene", "builtin:cubes", "--size", "320x240", "--camera", "eye:0,0,60,fov:60"]);
    assert_eq!(Some(device.as_str()), gpu.or(few));
}

/// What a software driver cannot draw is drawn on the CPU device: an order of fragments, and more layers than Mesa's loops can sort.
#[test]
fn auto_selects_the_cpu_device_where_a_driver_is_unsuitable() {
    let folder = folder("auto-cpu");
    let out = folder.join("o.png");
    let view = ["--scene", "builtin:cubes", "--size", "800x800"];
    let ordered = automatic(&out, &[&["kb", "--order", "shuffle:1"], &view[..]].concat());
    assert_eq!(ordered, ("cpu".to_owned(), "the only device with `--order`".to_owned()));
    if listed().iter().any(|(_, auto)| auto == "frames of many fragments") {
        let large = ["ab_ll", "--set", "sort.layers=512", "--scene", "builtin:cubes", "--size", "1280x1280"];
        let (device, reason) = automatic(&out, &large);
        assert!(device == "cpu" && reason.contains("may not sort more than 256 layers"), "{device}: {reason}");
    }
    // A device that is named is used, or it is an error that names another one.
    let named =
        fragbuf(&[&["render", "kb_mdt64", "--device", "llvmpipe", "--out", out.to_str().unwrap()], &view[..]].concat());
    assert_eq!(named.status.code(), Some(0), "{}", stderr(&named));
    assert!(stderr(&named).starts_with("note: rendering on llvmpipe"), "{}", stderr(&named));
}

/// Drivers and their layers print nothing where the environment has no `XDG_RUNTIME_DIR`, as in containers.
#[test]
fn no_driver_prints_on_stderr() {
    let folder = folder("runtime-dir");
    let out = folder.join("o.png");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
        command.args(arguments).env_remove("XDG_RUNTIME_DIR").env_remove("WAYLAND_DISPLAY");
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        stderr(&output)
    };
    assert_eq!(run(&["devices"]), "");
    let view = ["--scene", "builtin:cubes", "--size", "16x16", "--out", out.to_str().unwrap()];
    let printed = run(&[&["render", "ab_sb", "--device", "llvmpipe"], &view[..]].concat());
    assert!(printed.starts_with("note: rendering on llvmpipe") && printed.lines().count() == 1, "{printed}");
    assert_eq!(run(&[&["render", "ab_sb", "--json"], &view[..]].concat()), "");
}
