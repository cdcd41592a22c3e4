//! Attributes of fragments from properties of a model, and from the command line.

use std::path::Path;

use serde_json::Value;

use crate::render::{folder, fragbuf, read, stderr};

const HEAT: [&str; 3] = ["examples/heat.fragbuf", "--scene", "examples/heat.ply"];

const VIEW: [&str; 10] =
    ["--device", "cpu", "--camera", "clip", "--linear", "--size", "8x8", "--background", "0,0,0,1", "--out"];

/// Renders 8² pixels on the CPU device without warnings. A software driver must agree within 1/255.
fn render(folder: &Path, arguments: &[&str]) -> Vec<[u8; 4]> {
    let out = folder.join("o.png");
    let image = |device: &str| {
        let view = VIEW.map(|argument| if argument == "cpu" { device } else { argument });
        let output = fragbuf(&[&["render"], arguments, &view[..], &[out.to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        assert!(!stderr(&output).contains("warning"), "{arguments:?}: {}", stderr(&output));
        read(&out).2
    };
    let [cpu, driver] = ["cpu", "llvmpipe"].map(image);
    for (cpu, driver) in cpu.iter().zip(&driver) {
        assert!(cpu.iter().zip(driver).all(|(a, b)| a.abs_diff(*b) <= 1), "{arguments:?}: {cpu:?}, not {driver:?}");
    }
    cpu
}

/// Returns the exit code and the messages of a command that writes no image.
fn refused(command: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let out = folder(&format!("refused-{command}")).join("o.png");
    let output = fragbuf(&[&[command], arguments, &VIEW[..], &[out.to_str().unwrap()]].concat());
    assert!(!out.exists() && output.stdout.is_empty(), "{arguments:?}");
    (output.status.code(), stderr(&output))
}

fn pixel(pixels: &[[u8; 4]], x: usize, y: usize) -> [u8; 4] {
    pixels[8 * y + x]
}

#[test]
fn the_hottest_fragment_of_a_ply_is_kept() {
    let pixels = render(&folder("heat"), &HEAT);
    // 0.8 behind 0.2: 3 · 0.8 - 2 = 0.4.
    assert_eq!(pixel(&pixels, 0, 0), [255, 255, 102, 255]);
    // 0.2 alone: 3 · 0.2 = 0.6.
    assert_eq!(pixel(&pixels, 6, 0), [153, 0, 0, 255]);
    // Nothing: the background.
    assert_eq!(pixel(&pixels, 7, 0), [0, 0, 0, 255]);
    // At the bottom heat grows with x: 0.9375 at 7.5 of 8, 0.5625 at 4.5, and 0.0625 at 0.5, where 0.2 is more.
    assert_eq!(pixel(&pixels, 7, 7), [255, 255, 207, 255]);
    assert_eq!(pixel(&pixels, 4, 7), [255, 175, 0, 255]);
    assert_eq!(pixel(&pixels, 0, 7), [153, 0, 0, 255]);
    // The guide shows the closures of the description.
    let (text, guide) = (include_str!("../examples/heat.fragbuf"), include_str!("../src/guide/run.md"));
    for keyword in ["keep", "resolve"] {
        let line = text.lines().map(str::trim).find(|line| line.starts_with(keyword)).unwrap();
        assert!(guide.contains(line), "{line}");
    }
}

#[test]
fn a_value_of_the_command_line_replaces_that_of_the_model() {
    let folder = folder("values");
    // The last value counts: 3 · 0.6 - 1 = 0.8.
    let pixels = render(&folder, &[&HEAT[..], &["--attribute", "heat=0.1", "--attribute", "heat=0.6"]].concat());
    assert_eq!([pixel(&pixels, 0, 0), pixel(&pixels, 7, 7)], [[255, 204, 0, 255]; 2]);
    let pixels = render(&folder, &[HEAT[0], "--scene", "builtin:slabs", "--attribute", "heat=0.6"]);
    assert!(pixels.contains(&[255, 204, 0, 255]), "{pixels:?}");
    // Data of every scene can be replaced, too.
    let red = ["ab_array", "--scene", "examples/heat.ply", "--attribute", "color=1,0,0,1"];
    assert_eq!(pixel(&render(&folder, &red), 0, 0), [255, 0, 0, 255]);
}

#[test]
fn vectors_and_integers_are_attributes() {
    let folder = folder("vectors");
    let (description, model) = (folder.join("v.fragbuf"), folder.join("v.ply"));
    let text = "buffer V from kplus_array {
        fragment { depth: f32, flow: vec2, label: u32, tint: rgba8 }
        keep 1 least |f| f.depth;
        resolve |fragments| vec4(fragments[0].flow.y, fragments[0].label as f32 / 4294967295.0, fragments[0].tint.z, 1.0);
    }";
    std::fs::write(&description, text).unwrap();
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float flow_x\n\
        property float flow_y\nproperty uint label\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let vertex = |position: &str| format!("{position} 0.5 0 0.2 4294967295\n");
    let body = ["-1 -1", "3 -1", "-1 3"].map(vertex).concat();
    std::fs::write(&model, format!("{header}{body}3 0 1 2\n")).unwrap();
    let arguments =
        [description.to_str().unwrap(), "--scene", model.to_str().unwrap(), "--attribute", "tint=0,0,0.4,1"];
    assert_eq!(pixel(&render(&folder, &arguments), 3, 3), [51, 255, 102, 255]);
}

#[test]
fn attributes_that_are_missing_are_errors() {
    let folder = folder("missing-attributes");
    let description = folder.join("haet.fragbuf");
    let text = std::fs::read_to_string(HEAT[0]).unwrap();
    std::fs::write(&description, text.replace("heat", "haet")).unwrap();
    let haet = description.to_str().unwrap();
    let every = "color or colour (rgba8, rgba16, vec4, vec3), alpha (f32), normal (octahedral, vec3), position (vec3), edges (vec3), id or object (u32), depth (f32), and front (u32)";
    let advice = "`--attribute haet=0.5` sets a value for every vertex";
    assert_eq!(
        refused("render", &[haet, "--scene", "examples/heat.ply"]),
        (
            Some(1),
            format!(
                "error: examples/heat.ply: the scene has no `haet: f32` for the fragments: did you mean `heat`? it has heat (f32 or u32), \
                 position (vec3), {every}; {advice}\n"
            )
        )
    );
    assert_eq!(
        refused("compare", &["kb", haet, "--scene", "builtin:cubes"]),
        (
            Some(1),
            format!("error: builtin:cubes: the scene has no `haet: f32` for the fragments: it has {every}; {advice}\n")
        )
    );
    let odd = folder.join("odd.ply");
    let model = std::fs::read_to_string(HEAT[2]).unwrap().replace("0.25 0.2\n", "0.25 nan\n");
    std::fs::write(&odd, model).unwrap();
    let odd = odd.to_str().unwrap();
    let message = |instead: &str| {
        format!("[invalid-attribute]: {odd}:12: a value of `heat`, NaN, has no finite `f32`{instead} (and 3 more)\n")
    };
    let note = "note: `--strict` rejects the model; without it, these are warnings\n";
    let rejected = format!("error{}{note}", message(""));
    assert_eq!(refused("render", &[HEAT[0], "--scene", odd, "--strict"]), (Some(1), rejected));
    let out = folder.join("odd.png");
    let arguments = ["render", HEAT[0], "--scene", odd];
    let output = fragbuf(&[&arguments[..], &VIEW[..], &[out.to_str().unwrap()]].concat());
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), format!("warning{}", message(": 0 is used"))));
    assert_eq!(pixel(&read(&out).2, 6, 0), [0, 0, 0, 255]);
}

#[test]
fn invalid_values_of_attributes_are_errors() {
    let cases = [
        ("haet=1", "no attribute `haet` to set: did you mean `heat`? it has heat"),
        ("depth=1", "the attribute `depth` comes from the rasteriser and cannot be set"),
        ("heat=nan", "attribute `heat: f32` takes one number, not `nan`"),
        ("heat=flow", "not `flow`; for the attribute `flow` of the scene, name it so in the description: `flow: f32`"),
        ("heat=1,2", "attribute `heat: f32` takes one number, not `1,2`"),
        ("heat", "write name=value: an attribute of the fragments"),
    ];
    for (given, text) in cases {
        let (code, message) = refused("render", &[&HEAT[..], &["--attribute", given]].concat());
        assert!(code == Some(2) && message.contains(text), "{given}: {message}");
    }
    let (code, message) = refused("render", &["kb", "--scene", "builtin:cubes", "--attribute", "color=1,0"]);
    assert!(code == Some(2) && message.contains("`color: rgba8` takes 4 numbers, separated by commas"), "{message}");
}

/// `--uniform` sets the uniforms of whichever description has them, and the others those of one.
/// What is not a number differs from a number.
#[test]
fn compare_counts_what_is_not_a_number() {
    let folder = folder("nan");
    let description = |name: &str, value: &str| {
        let path = folder.join(name);
        let text = format!(
            "buffer B from ab_array {{\n    uniform {{ z: f32 }}\n    resolve |fragments, u| {{\n        let v = {value};\n        \
             let mut c = 0.0;\n        for f in fragments {{ c += f.color.x; }}\n        vec4(c, v, v, 1.0)\n    }}\n}}\n"
        );
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (one, two) = (description("one.fragbuf", "u.z / u.z"), description("two.fragbuf", "u.z"));
    let out = folder.join("o.png");
    let arguments = ["compare", &one, &two, "--scene", "builtin:cubes", "--device", "cpu", "--size", "16x16", "--json"];
    let output = fragbuf(&[&arguments[..], &["--out", out.to_str().unwrap()]].concat());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["different_pixels"].as_u64().is_some_and(|count| count > 0), "{report}");
}

#[test]
fn compare_has_uniforms_of_each_description() {
    let folder = folder("compare-uniforms");
    let description = folder.join("scaled.fragbuf");
    let text = "buffer Scaled from kplus_array {
        uniform { scale: f32 }
        keep 1 least |f| f.depth;
        resolve |fragments, u| vec4(u.scale, 0.0, 0.0, 1.0);
    }";
    std::fs::write(&description, text).unwrap();
    let (scaled, out) = (description.to_str().unwrap(), folder.join("o.png"));
    let compare = |second: &str, more: &[&str]| {
        let arguments = ["compare", scaled, second, "--scene", "examples/heat.ply"];
        let output = fragbuf(&[&arguments[..], more, &VIEW[..], &[out.to_str().unwrap()]].concat());
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()), "{more:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let equal = compare(scaled, &["--uniform", "scale=0.4"]);
    assert!(equal.starts_with("PSNR       infinite\nmax error  0.0000 (0.00/255), 0 pixels differ\n"), "{equal}");
    // The second overrides `--uniform`: 0.4 and 1 in the 64 pixels but the 6 that have no fragment.
    let sets = ["--uniform", "scale=0.4", "--uniform-second", "scale=1"];
    let text = compare(scaled, &sets);
    let lines = "max error  0.6000 (153.00/255), 58 pixels differ\nheat map   black 0.0000, red 0.2000, yellow 0.4000, white 0.6000\n";
    assert!(text.contains(lines), "{text}");
    let numbers: Value = serde_json::from_str(&compare(scaled, &[&sets[..], &["--json"]].concat())).unwrap();
    assert_eq!(numbers["different_pixels"], 58, "{numbers}");
    assert_eq!(numbers["heat_map"]["white"], numbers["max_error"], "{numbers}");
    let psnr = format!("PSNR       {:.2} dB\n", numbers["psnr"].as_f64().unwrap());
    assert!(text.starts_with(&psnr), "{text}, not {psnr}");
    assert!(read(&out).2.contains(&[255; 4]), "the greatest difference is white");
    // The second has no uniform.
    compare("ab_array", &["--uniform", "scale=0.4", "--uniform-first", "scale=0.5"]);
    let cases: [(&[&str], &str); 4] = [
        (&["--uniform", "u.scale=1"], "did you mean `scale`?"),
        (&["--uniform", "scal=1"], "neither description has a uniform `scal`: did you mean `scale`? they have scale"),
        (&["--uniform-second", "scale=1"], "the description has no uniform `scale`: it has none"),
        (&["--uniform-first", "scale=red"], "uniform `scale` takes one number, not `red`"),
    ];
    for (arguments, text) in cases {
        let (code, message) =
            refused("compare", &[&[scaled, "kb", "--scene", "examples/heat.ply"], arguments].concat());
        assert!(code == Some(2) && message.contains(text), "{arguments:?}: {message}");
    }
}

/// Both sides of a triangle alternate along a ray through a closed body, and the camera is as far away as it was placed.
#[test]
fn sides_positions_and_the_camera_are_values_of_fragments() {
    let folder = folder("sides");
    let description = folder.join("s.fragbuf");
    let text = "buffer S from kplus_array {
        fragment { depth: f32, front: u32, position: vec3 }
        uniform { eye: vec3, towards: vec3 }
        keep 8 least |f| f.depth;
        resolve |fragments, u| {
            let offset = fragments[0].position - u.eye;
            let mut alternate = 1.0;
            let mut expected = 1;
            for f in fragments { if f.front != expected { alternate = 0.0; } expected = 1 - expected; }
            vec4(alternate, 0.01 * offset.length(), u.towards.z, 1.0)
        }
    }";
    std::fs::write(&description, text).unwrap();
    // A closed box, far from zero, so that its scene has other coordinates than the model.
    let model = folder.join("box.obj");
    let corner = |at: usize| format!("v {} {} {}\n", 1e5 + (at & 1) as f64, (at >> 1 & 1), -1e5 + (at >> 2) as f64);
    let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    std::fs::write(&model, format!("{}{faces}", (0..8).map(corner).collect::<String>())).unwrap();
    let out = folder.join("o.png");
    for device in ["cpu", "llvmpipe"] {
        let arguments =
            ["render", description.to_str().unwrap(), "--scene", model.to_str().unwrap(), "--device", device];
        let uniforms = ["--uniform", "eye=camera", "--uniform", "towards=direction", "--size", "9x9", "--linear"];
        // In front of the near face, at a distance of 50.
        let camera = ["--camera", "eye:100000.5,0.5,-99949,fov:3", "--out", out.to_str().unwrap()];
        let output = fragbuf(&[&arguments[..], &uniforms, &camera].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let pixels = read(&out).2;
        let [red, green, blue, _] = pixels[9 * 4 + 4];
        assert_eq!((red, blue), (255, 255), "{device}");
        assert!(green.abs_diff(128) <= 1, "{device}: {green}");
        assert!(pixels.iter().all(|[red, ..]| *red == 255), "{device}: {pixels:?}");
    }
    let run = |arguments: &[&str]| {
        let common = [description.to_str().unwrap(), "--scene", "builtin:cubes"];
        refused("render", &[&common, arguments].concat())
    };
    let (code, message) = run(&["--attribute", "front=1"]);
    assert_eq!(code, Some(2));
    assert!(message.contains("`front` comes from the rasteriser and cannot be set"), "{message}");
    let (code, message) = run(&["--uniform", "eye=camera", "--uniform", "towards=0,0,1"]);
    assert_eq!(code, Some(2));
    assert!(message.contains("write `--uniform eye=direction`"), "{message}");
    let (code, message) = run(&["--uniform", "eye=camra"]);
    assert_eq!(code, Some(2));
    assert!(message.contains("or `camera` or `direction`, not `camra`; did you mean `camera`?"), "{message}");
    let refused =
        refused("render", &["examples/most_visible.fragbuf", "--scene", "builtin:cubes", "--uniform", "far=camera"]);
    assert_eq!(refused.0, Some(2));
    assert!(refused.1.contains("declare `far: vec3`"), "{}", refused.1);
}
