//! The CPU device beside a software driver on whole scenes, its orders, and a machine without any driver.

use std::path::Path;
use std::process::{Command, Output};

use fragbuf::{Registry, check};
use fragbuf_scene::{Camera, Scene};
use serde_json::Value;

use crate::render::{folder, fragbuf, read, stderr};

const SIZE: (u32, u32) = (256, 192);

/// From one pixel that is looked at to the next.
const SOME: usize = 331;

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
    let matrix = Camera::framing(scene, SIZE.0 as f32 / SIZE.1 as f32).view_projection.map(f64::from);
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

/// Why two rasterisers may differ here: an edge runs through the pixel's middle, as exactly as 256ths of a pixel tell; or two depths are
/// closer than their roundings: two ulp of a depth near one, for each of the two devices.
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
fn pictures_differ_from_the_drivers_at_edges_and_ties_alone() {
    let folder = folder("devices");
    let pixels = (SIZE.0 * SIZE.1) as usize;
    for scene in ["builtin:cubes", "builtin:slabs,n=24", "builtin:marbles"] {
        let triangles = projected(&fragbuf_scene::open(scene, [0.15, 0.45, 0.35, 0.4]).unwrap());
        // What explains everything explains nothing: of some pixels from all over, few may differ.
        let some: Vec<usize> = (0..pixels).step_by(SOME).collect();
        let may = |at: &usize| {
            is_explained(&triangles, (at % SIZE.0 as usize) as f64 + 0.5, (at / SIZE.0 as usize) as f64 + 0.5)
        };
        let explained = some.iter().filter(|at| may(at)).count();
        println!("{scene}: {explained} of {} pixels may differ", some.len());
        assert!(4 * explained < some.len(), "{scene}: {explained} of {} pixels may differ", some.len());
        for key in ["kplus_array", "ab_ll"] {
            let [own, driver] = ["cpu", "llvmpipe"].map(|device| {
                picture(&folder.join(format!("{device}.png")), &[key, "--scene", scene, "--device", device])
            });
            let apart = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
            let different: Vec<usize> = (0..pixels).filter(|pixel| apart((&own[*pixel], &driver[*pixel]))).collect();
            assert!(1000 * different.len() <= pixels, "{key}, {scene}: {} pixels differ", different.len());
            for pixel in different {
                let (x, y) = (pixel % SIZE.0 as usize, pixel / SIZE.0 as usize);
                println!("{key}, {scene}: pixel {x}, {y} is {:?}, and {:?} on the driver", own[pixel], driver[pixel]);
                let why = is_explained(&triangles, x as f64 + 0.5, y as f64 + 0.5);
                assert!(why, "{key}, {scene}: nothing explains {:?} and {:?} at {x}, {y}", own[pixel], driver[pixel]);
            }
        }
    }
}

/// The hazards of B06, Fig. 3, as a picture; and none where writers take turns or need not.
#[test]
fn interleaved_fragments_change_a_racy_picture_alone() {
    let folder = folder("orders");
    let registry = Registry::builtin();
    for technique in registry.techniques() {
        let key = technique.key.as_str();
        let draw = |order: &str| {
            let out = folder.join(format!("{key}.png"));
            picture(&out, &[key, "--scene", "builtin:marbles", "--device", "cpu", "--order", order])
        };
        let draft = fragbuf::Draft::from_technique(key, &fragbuf::Origin::new(key, 1, 1));
        let plan = fragbuf_cpu::Code::of(&check(&draft, &registry).unwrap(), &registry).unwrap().plan;
        let clean = draw("submission");
        for seed in ["shuffle:1", "shuffle:2"] {
            let shuffled = draw(seed);
            assert!(!plan.hazards.is_empty() || shuffled == clean, "{key}, {seed}");
            if key == "kb" {
                let different = clean.iter().zip(&shuffled).filter(|(a, b)| a != b).count();
                assert!(different > 1000, "{key}, {seed}: {different} pixels show a hazard");
                assert!(shuffled == draw(seed), "the same seed is the same picture");
            }
        }
    }
}

/// The gallery shows what its command draws.
#[test]
fn the_gallery_shows_the_hazards() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/gallery");
    let out = folder("gallery").join("kb_hazards.png");
    let common = ["--scene", "builtin:marbles", "--size", "240x180", "--device", "cpu", "--out", out.to_str().unwrap()];
    let different = |order: &str, shown: &str| {
        let output = fragbuf(&[&["render", "kb", "--order", order], &common[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let apart = |(a, b): &([u8; 4], [u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
        read(&out).2.into_iter().zip(read(&gallery.join(shown)).2).filter(apart).count()
    };
    assert_eq!(different("shuffle:1", "kb_hazards.png"), 0);
    assert_eq!(different("submission", "kb.png"), 0);
    assert!(different("shuffle:1", "kb.png") > 1000);
}

#[test]
fn an_order_is_the_cpu_devices() {
    let folder = folder("order-refused");
    let out = folder.join("o.png");
    let run = |order: &str, device: &str| {
        let common = ["--scene", "builtin:cubes", "--size", "8x8", "--out", out.to_str().unwrap()];
        fragbuf(&[&["render", "kb", "--order", order, "--device", device], &common[..]].concat())
    };
    let refused = run("shuffle:1", "llvmpipe");
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("--device cpu"), "{}", stderr(&refused));
    assert!(!out.exists());
    assert_eq!(run("shuffle:one", "cpu").status.code(), Some(2));
    assert_eq!(run("shuffle:1", "cpu").status.code(), Some(0));
}

/// What the README's first picture needs on a machine without a driver: nothing.
#[test]
fn without_any_driver_the_cpu_device_draws() {
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
    let common = ["--scene", "builtin:cubes", "--size", "32x24", "--json", "--out", out.to_str().unwrap()];
    let output = run(&[&["render", "kplus_array"], &common[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let figures: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&figures["device"], &figures["backend"]), (&"cpu".into(), &"interpreter".into()), "{figures}");
    assert!(
        figures["fragments"]["generated"].as_u64().unwrap() > 100 && figures["ms"]["store"].is_number(),
        "{figures}"
    );
    assert_eq!(read(&out).0, 32);
}
