//! Tests `--camera` by the pixels of known models, and its errors.

use std::path::{Path, PathBuf};

use crate::render::{folder, fragbuf, read, stderr};

const SIZE: usize = 64;

/// Writes two squares of side 1, red with its lower left corner at the origin and green at a distance of 2 behind it, moved and scaled.
fn squares(folder: &Path, origin: [f64; 3], scale: f64) -> PathBuf {
    let path = folder.join("squares.obj");
    std::fs::write(folder.join("m.mtl"), "newmtl r\nKd 1 0 0\nnewmtl g\nKd 0 1 0\n").unwrap();
    let corners = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let vertices = corners(0.0).into_iter().chain(corners(-2.0)).map(|corner| {
        let [x, y, z] = [0, 1, 2].map(|axis| origin[axis] + scale * corner[axis]);
        format!("v {x} {y} {z}\n")
    });
    let vertices: String = vertices.collect();
    std::fs::write(&path, format!("mtllib m.mtl\n{vertices}usemtl r\nf 1 2 3 4\nusemtl g\nf 5 6 7 8\n")).unwrap();
    path
}

fn draw(folder: &Path, model: &Path, camera: &str, device: &str) -> Vec<[u8; 4]> {
    let out = folder.join("o.png");
    let size = format!("{SIZE}x{SIZE}");
    let output = fragbuf(&[
        "render",
        "kplus_array",
        "--scene",
        model.to_str().unwrap(),
        "--camera",
        camera,
        "--shading",
        "unlit",
        "--linear",
        "--size",
        &size,
        "--device",
        device,
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{camera}: {}", stderr(&output));
    read(&out).2
}

/// Returns the pixels of a colour: their number and their bounds, x and y from the upper left corner.
fn extent(pixels: &[[u8; 4]], color: [u8; 4]) -> (usize, Option<[usize; 4]>) {
    let found = (0..pixels.len()).filter(|at| pixels[*at] == color).map(|at| (at % SIZE, at / SIZE));
    let found: Vec<(usize, usize)> = found.collect();
    let bounds = found.iter().map(|(x, y)| [*x, *y, *x, *y]);
    let bounds = bounds.reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]);
    (found.len(), bounds)
}

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];

#[test]
fn a_placed_camera_shows_the_model_where_it_is() {
    let folder = folder("camera-eye");
    let model = squares(&folder, [0.0; 3], 1.0);
    for device in ["cpu", "llvmpipe"] {
        // Half of the frame is 4 wide at the distance 4, so a unit has 8 pixels. The farther square is behind the nearer one.
        let pixels = draw(&folder, &model, "eye:0,0,4,target:0,0,0,fov:90", device);
        assert_eq!(extent(&pixels, RED), (64, Some([32, 24, 39, 31])), "{device}");
        assert_eq!(extent(&pixels, GREEN).0, 0, "{device}");
        let pixels = draw(&folder, &model, "eye:0,0,4,target:0,0,0,fov:90,zoom:2", device);
        assert_eq!(extent(&pixels, RED), (256, Some([32, 16, 47, 31])), "{device}");
        // From behind, right and left change places, and so do near and far.
        let pixels = draw(&folder, &model, "eye:0,0,-6,target:0,0,0,fov:90", device);
        assert_eq!(extent(&pixels, GREEN), (64, Some([24, 24, 31, 31])), "{device}");
        assert_eq!(extent(&pixels, RED).0, 0, "{device}");
        // Between the squares the red one is behind the eye. The green one has a unit of 32 pixels.
        let pixels = draw(&folder, &model, "eye:0,0,-1,target:0,0,-2,fov:90", device);
        assert_eq!(extent(&pixels, GREEN), (1024, Some([32, 0, 63, 31])), "{device}");
        assert_eq!(extent(&pixels, RED).0, 0, "{device}");
        // A triangle that passes the eye is clipped: the eye is in front of the middle of the red square, and looks along it to its right
        // edge, which is in the middle of the image.
        let pixels = draw(&folder, &model, "eye:0.5,0.25,0.01,target:1,0.25,0,fov:90", device);
        let [left, top, right, bottom] = extent(&pixels, RED).1.unwrap();
        assert!(left == 0 && (28..=33).contains(&right), "{device}: {left} {right}");
        assert!(top == 0 && bottom == SIZE - 1, "{device}: {top} {bottom}");
    }
    // In front, an orbit shows the red square in the middle.
    let (count, bounds) = extent(&draw(&folder, &model, "orbit:0,0", "cpu"), RED);
    let [left, top, right, bottom] = bounds.unwrap();
    assert!(count > 3000 && left + right == SIZE - 1 && top + bottom == SIZE - 1, "{count} {bounds:?}");
    // Straight down, from between the squares: the upper edge of the image is that of negative z, where the green one is.
    let pixels = draw(&folder, &model, "eye:0,4,-1,target:0,0,-1,fov:90", "cpu");
    let [green, red] = [GREEN, RED].map(|color| extent(&pixels, color).1.unwrap());
    assert!(
        green[3] < SIZE / 2 && red[1] >= SIZE / 2 && green[0] >= SIZE / 2 && red[0] >= SIZE / 2,
        "{green:?} {red:?}"
    );
}

/// A model at map coordinates has the same image, if the eye is there, too.
#[test]
fn the_eye_is_in_the_coordinates_of_the_model() {
    let folder = folder("camera-map");
    let expected = draw(&folder, &squares(&folder, [0.0; 3], 1.0), "eye:2.03,1.51,3.02,target:0.5,0.5,-1", "cpu");
    let there = squares(&folder, [447_000.0, 5_411_000.0, 12.0], 1.0);
    let found = draw(&folder, &there, "eye:447002.03,5411001.51,15.02,target:447000.5,5411000.5,11", "cpu");
    assert!(extent(&expected, RED).0 > 100 && extent(&expected, GREEN).0 > 50);
    assert!(found == expected);
    // The target is the centre of the model by default.
    assert!(draw(&folder, &there, "eye:447002.03,5411001.51,15.02", "cpu") == expected);
}

#[test]
fn invalid_cameras_are_errors() {
    let folder = folder("camera-errors");
    let out = folder.join("o.png");
    let run = |command: &[&str], camera: &str| {
        let common = ["--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu", "--out", out.to_str().unwrap()];
        fragbuf(&[command, &common, &["--camera", camera]].concat())
    };
    for (camera, expected) in [
        ("behind", "write auto, clip, orbit:AZIMUTH,ELEVATION or eye:X,Y,Z"),
        ("orbit:30", "`orbit` takes 2 numbers, not 1"),
        ("orbit:30,91", "the elevation 91 is not from -90 to 90 degrees"),
        ("orbit:nan,0", "`nan` is not a finite number"),
        ("orbit:30,20,target:0,0,0", "unknown or repeated field `target`"),
        ("eye:1,2", "`eye` takes 3 numbers, not 2"),
        ("eye:1,2,inf", "`inf` is not a finite number"),
        ("eye:1,2,3,fov:180", "from 0.1 to 179 degrees"),
        ("eye:1,2,3,fov:0", "from 0.1 to 179 degrees"),
        ("eye:1,2,3,fov:40,fov:50", "unknown or repeated field `fov`"),
        ("eye:1,2,3,target:1,2,3", "the eye and the target are the same point"),
        ("orbit:30,20,zoom:0", "magnified by 0.01 to 1000"),
        ("eye:1e9,0,0", "100,000 times the size of the scene"),
        ("eye:1,2,3,up:0,0,1", "unknown or repeated field `up`"),
    ] {
        let output = run(&["render", "kb"], camera);
        assert_eq!(output.status.code(), Some(2), "{camera}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{camera}: {}", stderr(&output));
        assert!(!out.exists());
    }
    let compared = run(&["compare", "kplus_array", "ab_ll"], "orbit:-60,-20,fov:30");
    assert_eq!(compared.status.code(), Some(0), "{}", stderr(&compared));
    assert!(String::from_utf8(compared.stdout).unwrap().contains("PSNR       infinite"));
}
