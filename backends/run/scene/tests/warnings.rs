//! Models that every reader of their format accepts, although a part of them is missing, malformed or not read: the scene that they
//! give, and the warning with its position.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::PathBuf;

use base64::Engine as _;
use fragbuf_scene::{Camera, Limits, Scene, load};
use tempfile::TempDir;

const COLOR: [f32; 4] = [0.5, 0.5, 0.5, 0.25];
const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

const QUAD: &str = "v -1 -1 0.5\nv 1 -1 0.5\nv 1 1 0.5\nv -1 1 0.5\n";

/// Writes the files and loads the first. Returns the scene and its warnings without the folder.
fn loaded(files: &[(&str, &str)]) -> (Scene, Vec<String>) {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    for (path, (_, text)) in paths.iter().zip(files) {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let mut scene = load(&paths[0], COLOR, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    // Every model has a folder of its own.
    scene.files.clear();
    let prefix = format!("{}/", folder.path().display());
    let warnings = scene.warnings.iter();
    let warnings = warnings
        .map(|warning| format!("[{}] {}", warning.kind.code(), warning.to_string().replace(&prefix, "")))
        .collect();
    (scene, warnings)
}

/// A model of unknown origin could name any file of the machine.
#[test]
fn files_that_a_model_names_are_read_only_if_the_limits_allow_it() {
    let folder = TempDir::new().unwrap();
    let limits = Limits { reads_named_files: false, ..Limits::default() };
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("red.mtl", "newmtl red\nKd 1 0 0\n");
    write("m.obj", &format!("mtllib red.mtl\n{QUAD}usemtl red\nf 1 2 3\n"));
    let path = folder.path().join("m.obj");
    let scene = load(&path, COLOR, &limits).unwrap();
    assert_eq!((colors(&scene), &scene.files), (vec![COLOR], &vec![path]));
    let warning = scene.warnings[0].to_string();
    assert!(
        warning.ends_with(
            "m.obj:1: files that the model names are not read: `red.mtl`: its materials have the default colour"
        ),
        "{warning}"
    );
    // Whether a file exists is not told either.
    write("m.obj", &format!("mtllib /none/none.mtl\n{QUAD}usemtl red\nf 1 2 3\n"));
    let scene = load(&folder.path().join("m.obj"), COLOR, &limits).unwrap();
    assert!(scene.warnings[0].to_string().contains("files that the model names are not read: `/none/none.mtl`"));
    write("m.bin", "");
    write("m.gltf", r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"m.bin","byteLength":0}]}"#);
    let error = load(&folder.path().join("m.gltf"), COLOR, &limits).unwrap_err().to_string();
    assert!(
        error.contains("buffer 0: files that the model names are not read: `m.bin`: convert the model to GLB"),
        "{error}"
    );
}

/// Loads a model without warnings.
fn clean(files: &[(&str, &str)]) -> Scene {
    let (scene, warnings) = loaded(files);
    assert_eq!(warnings, Vec::<String>::new());
    scene
}

/// Returns the colour of the first corner of each triangle.
fn colors(scene: &Scene) -> Vec<[f32; 4]> {
    let objects = scene.objects.iter();
    objects.flat_map(|object| object.triangles.iter().map(|[first, ..]| object.colors[*first as usize])).collect()
}

#[test]
fn one_statement_names_several_libraries() {
    let model = |libraries: &str| format!("mtllib {libraries}\n{QUAD}usemtl red\nf 1 2 3\nusemtl green\nf 1 3 4\n");
    let (one, two) = ("newmtl red\nKd 1 0 0\n", "newmtl green\nKd 0 1 0\n");
    for (libraries, first, second) in [
        ("one.mtl two.mtl", "one.mtl", "two.mtl"),
        ("one.mtl  two.mtl # both", "one.mtl", "two.mtl"),
        ("first library.mtl two.mtl", "first library.mtl", "two.mtl"),
        ("one #1.mtl two #2.mtl", "one #1.mtl", "two #2.mtl"),
        (".\\sub\\one.mtl sub/two.mtl", "sub/one.mtl", "sub/two.mtl"),
        ("C:\\models\\one.mtl /home/none/two.mtl", "one.mtl", "two.mtl"),
    ] {
        let scene = clean(&[("m.obj", &model(libraries)), (first, one), (second, two)]);
        assert_eq!(colors(&scene), [RED, [0.0, 1.0, 0.0, 1.0]], "{libraries}");
    }
    let (scene, warnings) = loaded(&[("m.obj", &model("one.mtl none.mtl # both")), ("one.mtl", one)]);
    assert_eq!(colors(&scene), [RED, COLOR]);
    assert_eq!(
        warnings,
        [
            "[missing-file] m.obj:1: no file `none.mtl`: its materials have the default colour",
            "[missing-material] m.obj:8: unknown material `green`: the materials are `red`: the default colour is used"
        ]
    );
}

#[test]
fn missing_libraries_and_materials_have_the_default_colour() {
    let text = format!("{QUAD}mtllib none.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\nusemtl a\nf 1 2 3\n");
    let (scene, warnings) = loaded(&[("m.obj", &text)]);
    assert_eq!(colors(&scene), [COLOR; 3]);
    assert_eq!(
        warnings,
        [
            "[missing-file] m.obj:5: no file `none.mtl`: its materials have the default colour",
            "[missing-material] m.obj:6: unknown material `a`: no `mtllib` defines any: the default colour is used (and 2 more)"
        ]
    );
}

#[test]
fn materials_may_lack_a_name_and_follow_their_use() {
    let model = format!("{QUAD}usemtl\nf 1 2 3\nusemtl red\nf 1 3 4\nmtllib a.mtl\n");
    let scene = clean(&[("m.obj", &model), ("a.mtl", "newmtl\nKd 1 0 0\nnewmtl red\nKd 1 0 0\n")]);
    assert_eq!(colors(&scene), [RED; 2]);
}

#[test]
fn unknown_statements_and_degenerate_faces_are_skipped() {
    let text = format!(
        "vw 1 0 1\n{QUAD}#@ x\nvw 2 0 1\nf 1 2\nf\nf 1 2 3 4\nf 3\nxyz\nl 1 2\np 1\ncurv 0 1\nsurf 0 1\nusemap a\n"
    );
    let (scene, warnings) = loaded(&[("m.obj", &text)]);
    assert_eq!(scene.triangles(), 2);
    assert_eq!(
        warnings,
        [
            "[unknown-statement] m.obj:1: unknown statement `vw` (and 1 more)",
            "[degenerate-face] m.obj:8: a face with 2 vertices, which needs 3 or more: it is skipped (and 2 more)",
            "[unknown-statement] m.obj:12: unknown statement `xyz`",
            "[not-read] m.obj:13: lines and points are not read (and 1 more)",
            "[not-read] m.obj:15: curves and surfaces are not read (and 1 more)",
            "[not-read] m.obj:17: textures are not read"
        ]
    );
}

#[test]
fn normals_that_are_missing_or_not_finite_are_computed() {
    let expected = clean(&[("m.obj", &format!("{QUAD}f 1 2 3 4\n"))]).objects[0].normals[0];
    assert_eq!(expected, [0.0, 0.0, 1.0]);
    for (text, warning) in [
        (
            "f 1//1 2//1 3//7 4//-1\n",
            "[invalid-normal] m.obj:5: no normal 1: the file has 0: it is computed (and 3 more)",
        ),
        (
            "vn nan nan nan\nf 1//1 2//1 3//1 4//1\n",
            "[invalid-normal] m.obj:5: a normal `nan nan nan` is not three finite numbers: it is computed",
        ),
        (
            "vn -1.#IND 0 0\nf 1//1 2//1 3//1 4//1\n",
            "[invalid-normal] m.obj:5: a normal `-1.` is not three finite numbers: it is computed",
        ),
    ] {
        let (scene, warnings) = loaded(&[("m.obj", &format!("{QUAD}{text}"))]);
        assert_eq!((scene.objects[0].normals.as_slice(), warnings), (&[expected; 4][..], vec![warning.to_owned()]));
    }
    // Normals of any length are normalised.
    for length in ["1e-30", "1e30", "2"] {
        let scene = clean(&[("m.obj", &format!("{QUAD}vn 0 {length} 0\nf 1//1 2//1 3//1\n"))]);
        assert_eq!(scene.objects[0].normals[0], [0.0, 1.0, 0.0]);
    }
}

#[test]
fn faces_may_precede_their_vertices() {
    let expected = clean(&[("m.obj", &format!("{QUAD}vn 0 1 0\nf 1//1 2//1 3//1 4//1\n"))]);
    assert_eq!(clean(&[("m.obj", &format!("f 1//1 2//1 3//1 4//1\n{QUAD}vn 0 1 0\n"))]), expected);
    // Negative indices count from the line of the face.
    assert_eq!(clean(&[("m.obj", &format!("{QUAD}vn 0 1 0\nf -4//-1 -3//-1 -2//-1 -1//-1\nv 9 9 9\n"))]), expected);
    let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let faces = "element face 1\nproperty list uchar int vertex_indices\n";
    let ply = |elements: String, body: &str| format!("ply\nformat ascii 1.0\n{elements}end_header\n{body}");
    let expected = clean(&[("m.ply", &ply(format!("{vertices}{faces}"), "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"))]);
    assert_eq!(clean(&[("m.ply", &ply(format!("{faces}{vertices}"), "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"))]), expected);
}

#[test]
fn odd_materials_are_read_as_others_read_them() {
    let read = |library: &str| {
        let (scene, warnings) =
            loaded(&[("m.obj", &format!("mtllib a.mtl\n{QUAD}usemtl m\nf 1 2 3\n")), ("a.mtl", library)]);
        (scene.objects[0].colors[0], warnings)
    };
    let none = Vec::<String>::new;
    assert_eq!(read("newmtl m\nKd 1.000001 0 0\n"), (RED, none()));
    assert_eq!(read("newmtl m\nKd 1 0 0\nd 0.25\nTr 0.75\n"), ([1.0, 0.0, 0.0, 0.25], none()));
    assert_eq!(read("newmtl m\nKd 1 0 0\nd 0\n"), ([1.0, 0.0, 0.0, 0.0], none()));
    assert_eq!(read("newmtl m\nKd 1 0 0\nTr 0.75\n"), ([1.0, 0.0, 0.0, 0.25], none()));
    for (library, color, warning) in [
        ("newmtl m\nKd 1 0 0 1\n", RED, "[out-of-range] a.mtl:2: `Kd` has 4 values, and takes 3: the first 3 are used"),
        ("newmtl m\nKd 2 0 0\n", RED, "[out-of-range] a.mtl:2: 2 is not from 0 to 1: 1 is used"),
        (
            "newmtl m\nKd 1 0 0\nTr 1\nd 1\nTr 1\n",
            RED,
            "[out-of-range] a.mtl:5: `Tr` contradicts `d`: the opacity is 1",
        ),
        (
            "Kd 0 1 0\nnewmtl m\nKd 1 0 0\n",
            RED,
            "[unknown-statement] a.mtl:1: `Kd` before the first `newmtl` has no effect",
        ),
        ("newmtl m\nKd 1 0 0\nmap_d a.png\n", RED, "[not-read] a.mtl:3: textures are not read: `map_d` has no effect"),
        (
            "newmtl m\nKd 1 0 0\nTr 1\n",
            [1.0, 0.0, 0.0, 0.0],
            "[invisible] m.obj:6: material `m` is invisible by `Tr 1`, which some tools write for opaque materials: give it a `d`",
        ),
        (
            "newmtl m\nKd spectral a.rfl\n",
            [0.5, 0.5, 0.5, 1.0],
            "[not-read] a.mtl:2: `Kd spectral` is not read: give red, green and blue",
        ),
    ] {
        assert_eq!(read(library), (color, vec![warning.to_owned()]), "{library}");
    }
}

/// A pyramid as OBJ, moved and scaled.
fn pyramid(origin: [f64; 3], scale: f64) -> String {
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let lines = corners.map(|corner| {
        let [x, y, z] = [0, 1, 2].map(|axis| origin[axis] + scale * corner[axis]);
        format!("v {x:e} {y:e} {z:e}\n")
    });
    format!("{}f 1 2 3 4\nf 1 2 5\nf 2 3 5\n", lines.concat())
}

#[test]
fn every_size_and_place_has_the_same_view() {
    let expected = clean(&[("m.obj", &pyramid([0.0; 3], 1.0))]);
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1.0e-5);
    let view = |scene: &Scene| Camera::framing(&[scene], 1.0).view_projection;
    for scale in
        [1.0e-300, 1.0e-40, 1.0e-20, 1.0e-12, 1.0e-9, 1.0e-3, 1.0e3, 1.0e6, 1.0e15, 1.0e25, 1.0e38, 1.0e80, 1.0e299]
    {
        let scene = clean(&[("m.obj", &pyramid([0.0; 3], scale))]);
        let factor = (scale / scene.placement.unit) as f32;
        assert!((0.0005..=20_000.0).contains(&factor), "{scale}: {factor}");
        assert!(near(scene.objects[0].normals.as_flattened(), expected.objects[0].normals.as_flattened()), "{scale}");
        let positions: Vec<f32> = scene.objects[0].positions.as_flattened().iter().map(|axis| axis / factor).collect();
        assert!(near(&positions, expected.objects[0].positions.as_flattened()), "{scale}");
        assert!(view(&scene).iter().all(|value| value.is_finite()), "{scale}");
    }
    let point = clean(&[("m.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n")]);
    assert!(view(&point).iter().all(|value| value.is_finite()));
    // Map coordinates, which have steps of half a metre in `f32`.
    for (origin, scale) in [([447_000.25, 5_411_000.5, 12.0], 0.125), ([1.0e15, 0.0, 0.0], 1.0e3), ([1.0; 3], 1.0e-10)]
    {
        let scene = clean(&[("m.obj", &pyramid(origin, scale))]);
        let factor = (scale / scene.placement.unit) as f32;
        let centred = expected.objects[0].positions.iter().map(|[x, y, z]| [*x, *y, z - 0.5]);
        for (position, expected) in scene.objects[0].positions.iter().zip(centred) {
            assert!(
                (0..3).all(|axis| (position[axis] / factor - expected[axis]).abs() < 1.0e-4),
                "{position:?}, {expected:?}"
            );
        }
    }
}

#[test]
fn doubles_of_a_ply_are_centred_before_they_are_rounded() {
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n";
    let scene = clean(&[(
        "m.ply",
        &format!("{header}447000.125 5411000.125 7\n447000.375 5411000.125 7\n447000.125 5411000.375 7\n3 0 1 2\n"),
    )]);
    assert_eq!(scene.placement.origin, [447_000.25, 5_411_000.25, 7.0]);
    let positions = &scene.objects[0].positions;
    assert_eq!(positions, &[[-0.125, -0.125, 0.0], [0.125, -0.125, 0.0], [-0.125, 0.125, 0.0]]);
    // In the coordinates of the model, the distances are lost.
    let mut other = scene.clone();
    other.use_model_coordinates();
    assert_eq!(other.objects[0].positions[0], [447_000.13, 5_411_000.0, 7.0]);
    // Two scenes share their coordinates.
    let mut beside = clean(&[("m.obj", &pyramid([447_001.0, 5_411_001.0, 7.0], 0.25))]);
    let mut scene = scene;
    scene.share_placement(&mut beside);
    assert_eq!(scene.placement, beside.placement);
    let step = beside.objects[0].positions[0][1] - scene.objects[0].positions[0][1];
    assert!((step - (5_411_000.75_f64 - 5_411_000.125) as f32).abs() < 1.0e-3, "{step}");
}

#[test]
fn odd_values_of_a_ply_are_replaced() {
    let vertices = |properties: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{properties}"
        )
    };
    let faces = "element face 3\nproperty list uchar int vertex_indices\nend_header\n";
    let body = |values: &str| format!("0 0 0 {values}\n1 0 0 {values}\n0 1 0 {values}\n2 0 1\n3 0 1 2\n0\n");
    let skipped = "a face with 2 vertices, which needs 3 or more: it is skipped (and 1 more)";
    let (scene, warnings) = loaded(&[("m.ply", &format!("{}{faces}{}", vertices(""), body("")))]);
    assert_eq!((scene.triangles(), warnings), (1, vec![format!("[degenerate-face] m.ply:13: {skipped}")]));
    let properties = "property float nx\nproperty float ny\nproperty float nz\n";
    let (scene, warnings) = loaded(&[("m.ply", &format!("{}{faces}{}", vertices(properties), body("nan nan nan")))]);
    assert_eq!(scene.objects[0].normals[0], [0.0, 0.0, 1.0]);
    assert_eq!(warnings[0], "[invalid-normal] m.ply:13: a normal is not finite: it is computed (and 2 more)");
    let properties = "property float r\nproperty float g\nproperty float b\n";
    let (scene, warnings) = loaded(&[("m.ply", &format!("{}{faces}{}", vertices(properties), body("127.5 0 255")))]);
    assert_eq!(scene.objects[0].colors[0], [0.5, 0.0, 1.0, 1.0]);
    assert_eq!(
        warnings[0],
        "[out-of-range] m.ply:13: a colour of a vertex, 127.5, is not from 0 to 1: all are divided by 255"
    );
    let properties = "property uchar r\nproperty uchar g\nproperty uchar b\nproperty uchar a\n";
    let (scene, _) = loaded(&[("m.ply", &format!("{}{faces}{}", vertices(properties), body("255 0 0 51")))]);
    assert_eq!(scene.objects[0].colors[0], [1.0, 0.0, 0.0, 0.2]);
}

/// One of the short names of colours is another quantity, such as a radius; integers of 16 and 32 bits are often from 0 to 255.
#[test]
fn colours_of_a_ply_are_what_their_names_and_numbers_say() {
    let ply = |properties: &str, values: &str| {
        let vertex = |position: &str| format!("{position} {values}\n");
        let vertices: String = ["0 0 0", "1 0 0", "0 1 0"].map(vertex).concat();
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{properties}\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n{vertices}3 0 1 2\n"
        )
    };
    assert_eq!(colors(&clean(&[("m.ply", &ply("property float b\n", "0.9"))])), [COLOR]);
    assert_eq!(colors(&clean(&[("m.ply", &ply("property float r\nproperty float a\n", "300 7"))])), [COLOR]);
    let short = "property float r\nproperty float g\nproperty float b\n";
    assert_eq!(colors(&clean(&[("m.ply", &ply(short, "1 0 0"))])), [RED]);
    let integers = "property int red\nproperty int green\nproperty int blue\n";
    let (scene, warnings) = loaded(&[("m.ply", &ply(integers, "255 0 0"))]);
    assert_eq!(colors(&scene), [RED]);
    assert!(warnings[0].contains("colours of vertices are from 0 to 255"), "{warnings:?}");
    let words = "property ushort red\nproperty ushort green\nproperty ushort blue\n";
    assert_eq!(colors(&clean(&[("m.ply", &ply(words, "65535 0 0"))])), [RED]);
    let (_, warnings) = loaded(&[("m.ply", &format!("{}end\n", ply(short, "1 0 0")))]);
    assert!(warnings[0].ends_with("`end` follows the last element: the header declares 3 `vertex` and 1 `face`, and the file has 1 more line: it is skipped"), "{warnings:?}");
}

#[test]
fn faces_of_a_ply_have_colours_and_strips() {
    let vertices = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    let positions = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
    let faces = "element face 3\nproperty uchar red\nproperty list uchar int vertex_indices\nproperty uchar green\nproperty uchar blue\n";
    let text = format!("{vertices}{faces}end_header\n{positions}255 3 0 1 2 0 0\n0 3 1 3 2 0 255\n255 3 2 1 0 0 0\n");
    let scene = clean(&[("m.ply", &text)]);
    assert_eq!(colors(&scene), [RED, [0.0, 0.0, 1.0, 1.0], RED]);
    // The first and the last face share their vertices.
    assert_eq!(scene.objects[0].positions.len(), 4 + 6);
    let textured = text.replace("element face", "comment TextureFile a.png\nelement face");
    assert_eq!(loaded(&[("m.ply", &textured)]).1, ["[not-read] m.ply:7: textures are not read"]);
    let strips = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    let scene = clean(&[("m.ply", &format!("{vertices}{strips}{positions}9 0 1 2 3 -1 3 2 1 -1\n"))]);
    assert_eq!(scene.objects[0].triangles, [[0, 1, 2], [2, 1, 3], [3, 2, 1]]);
}

/// Returns a glTF model with one triangle.
fn gltf(rest: &str) -> String {
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let text = base64::engine::general_purpose::STANDARD.encode(positions);
    format!(
        r#"{{"asset": {{"version": "2.0"}}, {rest}"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0}}]}}],
        "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [1, 0, 0, 1]}}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "buffers": [{{"byteLength": 36, "uri": "data:;base64,{text}"}}]}}"#
    )
}

#[test]
fn a_gltf_without_scene_or_nodes_is_drawn() {
    let nodes = r#""nodes": [{"children": [1]}, {"mesh": 0}], "#;
    let first = |rest: &str, triangles: usize| {
        let (scene, warnings) = loaded(&[("m.gltf", &gltf(rest))]);
        assert_eq!(scene.triangles(), triangles, "{rest}");
        warnings
    };
    let no_scene = "[missing-scene] m.gltf: the file has no scene: all its nodes are drawn";
    let no_nodes = "[missing-scene] m.gltf:1: scene 0 has no nodes: all nodes of the file are drawn";
    assert_eq!(first(nodes, 1), [no_scene]);
    assert_eq!(first("", 1), [no_scene]);
    assert_eq!(first(&format!(r#""scene": 0, "scenes": [{{}}], {nodes}"#), 1), [no_nodes]);
    assert_eq!(first(&format!(r#""scenes": [{{"name": "s"}}, {{"nodes": [0]}}], {nodes}"#), 1), [no_nodes]);
    assert_eq!(first(&format!(r#""scene": 1, "scenes": [{{"name": "s"}}, {{"nodes": [0]}}], {nodes}"#), 1), [""; 0]);
    assert_eq!(first(r#""scene": 0, "scenes": [{"nodes": []}], "#, 1), [no_nodes]);
}

#[test]
fn what_a_gltf_has_beyond_the_scene_is_reported() {
    let node = r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0NODE}], "skins": [{"joints": [0]}], "extensionsUsed": [USED], "#;
    let warnings = |from: &str, to: &str| {
        let text = gltf(node).replacen(from, to, 1).replace("NODE", "").replace("USED", "");
        loaded(&[("m.gltf", &text)]).1
    };
    assert_eq!(warnings("NODE", ""), [""; 0]);
    assert_eq!(
        warnings("USED", r#""KHR_materials_unlit", "EXT_mesh_gpu_instancing""#),
        ["[not-read] m.gltf:1: `EXT_mesh_gpu_instancing` is not read: each node is drawn once"]
    );
    assert_eq!(
        warnings("NODE", r#", "skin": 0"#),
        ["[not-read] m.gltf:1: node 0: the joints of skins are not read: its mesh is drawn in its own pose"]
    );
    let texture = r#""textures": [{"source": 0}], "images": [{"uri": "a.png"}], "materials": [{"pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}, "#;
    assert_eq!(
        warnings(r#""materials": [{"pbrMetallicRoughness": {"#, texture),
        ["[not-read] m.gltf:2: material 0: textures are not read: the factor of its base colour is used without them"]
    );
    let lines = r#""primitives": [{"attributes": {"POSITION": 0}, "mode": 1}, "#;
    assert_eq!(warnings(r#""primitives": ["#, lines), ["[not-read] m.gltf:1: lines and points are not read"]);
}

#[test]
fn errors_of_a_gltf_have_the_line_of_their_part() {
    let folder = TempDir::new().unwrap();
    let error = |from: &str, to: &str| {
        let nodes = "\n\"nodes\": [\n{\"name\": \"accessors \\\" [\"},\n{\"mesh\": 0}],\n\"scenes\": [\n{\"nodes\": [0, 1]}],\n";
        let text = gltf(nodes).replacen(r#"}], "accessors""#, r#"}],"accessors""#, 1);
        assert!(text.contains(from), "{from}");
        let path = folder.path().join("m.gltf");
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        load(&path, COLOR, &Limits::default()).unwrap_err().to_string().rsplit_once('/').unwrap().1.to_owned()
    };
    for (from, to, expected) in [
        (r#""version": "2.0""#, r#""version": "1.0""#, "m.gltf:1: glTF version `1.0`: version 2 is read"),
        ("0, 1]", "0, 7]", "m.gltf:6: scene 0: its node is number 7, and the file has 2"),
        ("\"mesh\": 0", "\"children\": [1]", "m.gltf:4: node 1 is its own child"),
        ("\"mesh\": 0", "\"mesh\": 3", "m.gltf:4: node 1: its mesh is number 3, and the file has 1"),
        ("\"count\": 3", "\"count\": 4", "m.gltf:9: accessor 0: it reaches beyond its buffer"),
        (
            "\"byteLength\": 36, \"uri\"",
            "\"byteLength\": 37, \"uri\"",
            "m.gltf:11: buffer 0: it has 36 bytes, but declares 37",
        ),
        (
            "\"byteLength\": 36}",
            "\"byteLength\": 36, \"byteStride\": 2}",
            "m.gltf:10: buffer view 0: a stride of 2 bytes",
        ),
    ] {
        let found = error(from, to);
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn a_model_without_triangles_names_the_first_warning() {
    let folder = TempDir::new().unwrap();
    for (name, text, expected) in [
        ("m.obj", "\u{1}\u{2}\nxyz\n", "m.obj:1: the model has no triangles: unknown statement `\u{1}\u{2}`"),
        ("m.obj", "v 0 0 0\nl 1 1\n", "m.obj:2: the model has no triangles: lines and points are not read"),
        ("m.obj", "v 0 0 0\n", "m.obj: the model has no triangles"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let error = load(&path, COLOR, &Limits::default()).unwrap_err().to_string();
        assert!(error.ends_with(expected), "{error}");
    }
}

#[test]
fn warnings_are_few() {
    let unknown: String = (0..1000).map(|number| format!("keyword{number}\n")).collect();
    let (_, warnings) = loaded(&[("m.obj", &format!("{QUAD}{unknown}f 1 2\nf 1 2 3\n"))]);
    assert_eq!(warnings.len(), 25);
    assert_eq!(warnings[0], "[unknown-statement] m.obj:5: unknown statement `keyword0` (and 976 more)");
    assert_eq!(
        warnings[24],
        "[degenerate-face] m.obj:1005: a face with 2 vertices, which needs 3 or more: it is skipped"
    );
}

#[test]
fn a_line_of_a_ply_file_without_all_values_of_a_vertex_is_reported() {
    let model = |vertices: &str| {
        let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
        format!("{header}element face 1\nproperty list uchar int vertex_indices\nend_header\n{vertices}3 0 1 2\n")
    };
    clean(&[("a.ply", &model("0 0 0\n1 0 0\n\n0 1 0\n"))]);
    // The second vertex has four values, and the third two.
    let (scene, warnings) = loaded(&[("a.ply", &model("0 0 0\n1 0 0 0\n1 0\n"))]);
    let expected = "a.ply:11: a line has 4 values, and a vertex has 3: `x`, `y`, `z`: values are read across lines";
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains(expected), "{warnings:?}");
    assert_eq!(scene.objects[0].positions.len(), 3);
    // All on one line.
    let (_, warnings) = loaded(&[("a.ply", &model("0 0 0 1 0 0 0 1 0\n"))]);
    assert!(
        warnings.len() == 1 && warnings[0].contains("a.ply:10: a line has 9 values, and a vertex has 3"),
        "{warnings:?}"
    );
    // More properties are declared than the lines have values: the error is about the line, not about what follows from it.
    let declared =
        |vertices: &str| model(vertices).replace("property float z\n", "property float z\nproperty float heat\n");
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ply");
    for (vertices, found) in [
        (
            "0 0 0\n1 0 0\n0 1 0\n",
            "11: a line has 3 values, and a vertex has 4: `x`, `y`, `z`, `heat`: values are read across lines, and line 14: ",
        ),
        (
            "0 0 0 1\n1 0 0\n0 1 0 1\n",
            "12: the model has no triangles: a line has 3 values, and a vertex has 4: `x`, `y`, `z`, `heat`",
        ),
    ] {
        std::fs::write(&path, declared(vertices)).unwrap();
        let error = load(&path, COLOR, &Limits::default()).unwrap_err().to_string();
        assert!(error.contains(&format!("a.ply:{found}")), "{error}");
    }
}
