//! Models that declare or unpack to more than the limits, files without end, and structures that repeat: each is an error with
//! its numbers. Limits are small, so that the tests are cheap.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::io::Write as _;
use std::path::{Path, PathBuf};

use fragbuf_scene::{Error, FilePosition, Limits, Scene, load, open};
use tempfile::TempDir;

const COLOR: [f32; 4] = [0.5, 0.5, 0.5, 0.25];

/// The limit of most tests.
const SMALL: u64 = 1 << 20;

/// The names and the bytes of files.
type Files<'a> = &'a [(&'a str, &'a [u8])];

/// Writes the files and loads the first.
fn loaded(files: &[(&str, &[u8])], memory: u64) -> Result<Scene, Error> {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    for (path, (_, bytes)) in paths.iter().zip(files) {
        std::fs::write(path, bytes).unwrap();
    }
    load(&paths[0], COLOR, &Limits { memory, ..Limits::default() })
}

fn too_large(files: &[(&str, &[u8])], memory: u64) -> (String, u64, u64) {
    match loaded(files, memory) {
        Err(Error::TooLarge { what, needed, left, limit, .. }) if limit == memory => (what, needed, left),
        other => panic!("{}: {:?}", files[0].0, other.map(|scene| scene.triangles())),
    }
}

fn malformed(files: &[(&str, &[u8])]) -> (FilePosition, String) {
    match loaded(files, SMALL) {
        Err(Error::Malformed { position, message, .. }) => (position, message),
        other => panic!("{}: {:?}", files[0].0, other.map(|scene| scene.triangles())),
    }
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn files_without_end_are_not_read() {
    let folder = TempDir::new().unwrap();
    let zeros = |name: &str| {
        let path = folder.path().join(name);
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        path
    };
    let pipe = folder.path().join("pipe.gltf");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reason = |path: &Path| match load(path, COLOR, &Limits::default()) {
        Err(Error::Unreadable { file, reason }) => (file, reason),
        other => panic!("{other:?}"),
    };
    for path in [zeros("a.obj"), zeros("a.ply"), zeros("a.gltf"), zeros("a.glb"), zeros("a.obj.gz"), pipe] {
        let (file, reason) = reason(&path);
        assert_eq!(file, path.display().to_string());
        assert!(reason.starts_with("a device, a pipe or a socket is not a model"), "{reason}");
    }
    let inner = folder.path().join("folder.obj");
    std::fs::create_dir(&inner).unwrap();
    assert!(reason(&inner).1.starts_with("a folder is not a model"));
    // A file that a model names.
    let model = folder.path().join("m.obj");
    std::fs::write(&model, format!("mtllib a.ply\n{TRIANGLE}")).unwrap();
    assert_eq!(reason(&model).0, folder.path().join("a.ply").display().to_string());
    let model = folder.path().join("m.gltf");
    std::fs::write(&model, gltf("[{\"mesh\": 0}]", r#""uri": "/dev/zero""#)).unwrap();
    assert_eq!(reason(&model).0, "/dev/zero");
}

#[test]
fn files_are_read_up_to_the_limit() {
    let text = vec![b'\n'; SMALL as usize + 5];
    assert_eq!(too_large(&[("m.obj", &text)], SMALL), ("the file".to_owned(), SMALL + 5, SMALL));
    assert_eq!(too_large(&[("m.ply", &text)], 1000), ("the file".to_owned(), SMALL + 5, 1000));
    // The size after decompression is not known before the limit.
    let zeros = gzip(&vec![0; 8 << 20]);
    assert!(zeros.len() < 100_000);
    for name in ["m.obj.gz", "m.ply.gz", "m.gltf.gz", "m.glb.gz"] {
        let expected = ("the decompressed file".to_owned(), SMALL + 1, SMALL);
        assert_eq!(too_large(&[(name, &zeros)], SMALL), expected, "{name}");
    }
    let members = gzip(&vec![0; 600_000]).repeat(2);
    assert_eq!(too_large(&[("m.obj.gz", &members)], SMALL).0, "the decompressed file");
    // The limit is that of all files of a model together.
    let model = format!("mtllib a\nmtllib b\nmtllib c\n{TRIANGLE}");
    let library = vec![b'\n'; 400_000];
    let files = [("m.obj", model.as_bytes()), ("a", &library), ("b", &library), ("c", &library)];
    let left = SMALL - model.len() as u64 - 800_000;
    assert_eq!(too_large(&files, SMALL), ("the file".to_owned(), 400_000, left));
    // One library that is named often is read once.
    let model = format!("{}{TRIANGLE}", "mtllib a\n".repeat(100));
    assert!(loaded(&[("m.obj", model.as_bytes()), ("a", &library)], SMALL).is_ok());
}

#[test]
fn vertices_and_triangles_of_an_obj_count() {
    let all = |corners: usize| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3".repeat(corners / 3));
    // A polygon has two triangles less than corners.
    let (what, needed, _) = too_large(&[("m.obj", all(150_000).as_bytes())], SMALL);
    assert_eq!((what.as_str(), needed), ("the scene's triangles", 12 * 149_998));
    let (what, needed, _) = too_large(&[("m.obj", all(30_000).as_bytes())], SMALL);
    assert_eq!((what.as_str(), needed), ("the corners of a face", 44 * 30_000));
    assert!(loaded(&[("m.obj", all(15_000).as_bytes())], SMALL).is_ok());
    let positions = "v 0 0 0\n".repeat(40_000);
    assert_eq!(too_large(&[("m.obj", positions.as_bytes())], SMALL).0, "the list of positions");
    let materials = "newmtl a\n".repeat(40_000);
    let files = [("m.obj", &b"mtllib l\n"[..]), ("l", materials.as_bytes())];
    assert_eq!(too_large(&files, SMALL).0, "the materials");
}

#[test]
fn lines_have_a_greatest_length() {
    let limit = 64 << 20;
    let long = "v 0 0 0\n".to_owned() + &"x".repeat((16 << 20) + 1);
    let continued = "v 0 0 0\n".to_owned() + &"\\\n".repeat((16 << 20) + 1);
    for text in [&long, &continued] {
        match loaded(&[("m.obj", text.as_bytes())], limit) {
            Err(Error::Malformed { position: FilePosition::Line(2), message, .. }) => {
                assert_eq!(message, "the line has more than 16777216 bytes");
            }
            other => panic!("{:?}", other.map(|scene| scene.triangles())),
        }
    }
    // Messages quote the beginning of a long word.
    let text = format!("{TRIANGLE}{}\n", "x".repeat(1000));
    let scene = loaded(&[("m.obj", text.as_bytes())], SMALL).unwrap();
    assert_eq!(scene.warnings[0].message, format!("unknown statement `{}…`", "x".repeat(60)));
}

#[test]
fn messages_quote_the_beginning_of_a_long_name() {
    let long = "x".repeat(1 << 16);
    let quoted = format!("`{}…`", "x".repeat(60));
    let elements = format!("element vertex 1\n{VERTEX}");
    let materials = format!("mtllib l\n{TRIANGLE}usemtl a\n");
    let library = format!("newmtl {long}\n");
    let name = format!("mtllib {long}\n{TRIANGLE}");
    let model = gltf(r#"[{"mesh": 0}]"#, URI);
    let version = model.replace("2.0", &long);
    let extension = model.replacen('{', &format!(r#"{{"extensionsRequired": ["{long}"], "#), 1);
    let cases: [(Files<'_>, String); 5] = [
        (&[("m.ply", &ply("ascii", &elements, long.as_bytes()))], format!("{quoted} is not a number")),
        (
            &[("m.ply", &ply("ascii", &elements, &[0xff; 2000]))],
            format!("`{}…` is not a number", "\u{fffd}".repeat(60)),
        ),
        (&[("m.obj", name.as_bytes())], format!("the name of a file, {quoted}, has 65536 bytes: it can have 4096")),
        (&[("m.gltf", version.as_bytes())], format!("glTF version {quoted}: version 2 is read")),
        (&[("m.gltf", extension.as_bytes())], format!("the required extension {quoted} is not supported")),
    ];
    for (files, expected) in cases {
        assert_eq!(malformed(files).1, expected);
    }
    let scene = loaded(&[("m.obj", materials.as_bytes()), ("l", library.as_bytes())], SMALL).unwrap();
    assert_eq!(scene.warnings[0].message, format!("unknown material `a`: the materials are {quoted}"));
    assert_eq!(scene.warnings[0].instead, "the default colour is used");
    let (_, message) =
        malformed(&[("m.gltf", model.replace(r#""scene": 0"#, &format!(r#""scene": "{long}""#)).as_bytes())]);
    assert!(message.chars().count() <= 350 && message.contains("xxx"), "{message}");
}

fn ply(format: &str, elements: &str, body: &[u8]) -> Vec<u8> {
    [format!("ply\nformat {format} 1.0\n{elements}end_header\n").as_bytes(), body].concat()
}

const VERTEX: &str = "property float x\nproperty float y\nproperty float z\n";
const FACE: &str = "property list uint int vertex_indices\n";

/// Three vertices and one triangle in little-endian order.
fn body() -> Vec<u8> {
    let mut body: Vec<u8> = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    body.extend([3_u32, 0, 1, 2].map(u32::to_le_bytes).concat());
    body
}

#[test]
fn records_without_properties_are_nothing() {
    for count in ["18446744073709551615", "4294967296", "1"] {
        let elements = format!("element nothing {count}\nelement vertex 3\n{VERTEX}element face 1\n{FACE}");
        let scene = loaded(&[("m.ply", &ply("binary_little_endian", &elements, &body()))], SMALL).unwrap();
        assert_eq!(scene.triangles(), 1);
        let text: &[u8] = b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        assert_eq!(loaded(&[("m.ply", &ply("ascii", &elements, text))], SMALL).unwrap().triangles(), 1);
    }
}

/// Counts that disagree with the file are told with both numbers, in either encoding.
#[test]
fn counts_of_a_ply_that_disagree_with_the_file_are_told() {
    let elements =
        |vertices: u32, faces: u32| format!("element vertex {vertices}\n{VERTEX}element face {faces}\n{FACE}");
    let text = b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (vertices, faces, line, expected) in [
        (3, 2, 13, "line 7 declares 2 of `face`, and the file has 1"),
        (4, 1, 13, "the header declares 4 `vertex` and 1 `face`, and 4 lines follow it"),
        // The third vertex is read as a face.
        (2, 1, 12, "the header declares 2 `vertex` and 1 `face`, and the file has 2 more lines"),
        (5, 2, 13, "line 3 declares 5 of `vertex`, and the file has 4"),
    ] {
        let file = ply("ascii", &elements(vertices, faces), text);
        let told = match loaded(&[("m.ply", &file)], SMALL) {
            Err(Error::Malformed { position, message, .. }) => {
                assert_eq!(position, FilePosition::Line(line), "{message}");
                message
            }
            Err(other) => panic!("{other}"),
            Ok(scene) => scene.warnings.iter().map(|warning| warning.to_string()).collect::<Vec<_>>().join("\n"),
        };
        assert!(told.contains(expected), "{vertices} {faces}: {told}");
    }
    // A vertex too many shifts the faces.
    let file = ply("ascii", &elements(3, 1), b"0 0 0\n1 0 0\n0 1 0\n0.5 1 0\n3 0 1 2\n");
    let (position, message) = malformed(&[("m.ply", &file)]);
    assert_eq!(position, FilePosition::Line(13), "{message}");
    assert!(message.contains("the header declares 3 `vertex` and 1 `face`, and 5 lines follow it"), "{message}");
    let binary = |vertices, faces| ply("binary_little_endian", &elements(vertices, faces), &body());
    let (position, message) = malformed(&[("m.ply", &binary(3, 2))]);
    assert_eq!(position, FilePosition::Byte(binary(3, 2).len()));
    assert!(message.contains("line 7 declares 2 of `face`, and the file has 1"), "{message}");
    let (_, message) = malformed(&[("m.ply", &binary(2, 1))]);
    // The third vertex is read as a face without vertices.
    let expected = "24 bytes follow the last element: the header declares 2 `vertex` and 1 `face`";
    assert!(message.contains(expected), "{message}");
    let face = [3_u32, 0, 1, 2].map(u32::to_le_bytes).concat();
    let scene = loaded(&[("m.ply", &[binary(3, 1), face].concat())], SMALL).unwrap();
    let warnings: Vec<String> = scene.warnings.iter().map(|warning| warning.to_string()).collect();
    let expected = "16 bytes follow the last element: the header declares 3 `vertex` and 1 `face`: it is skipped";
    assert!(warnings.iter().any(|warning| warning.contains(expected)), "{warnings:?}");
    // Bytes that align a file are no records.
    let aligned = [binary(3, 1), vec![0; 8]].concat();
    assert!(loaded(&[("m.ply", &aligned)], SMALL).unwrap().warnings.is_empty());
}

#[test]
fn counts_of_a_ply_beyond_the_file_are_errors() {
    for count in ["4294967295", "18446744073709551615"] {
        let elements = format!("element vertex {count}\n{VERTEX}element face 1\n{FACE}");
        let (position, message) = malformed(&[("m.ply", &ply("ascii", &elements, b"0 0 0\n"))]);
        let ended =
            format!("the file ends before its last element: line 3 declares {count} of `vertex`, and the file has 1");
        assert_eq!((position, message.as_str()), (FilePosition::Line(10), ended.as_str()));
        let file = ply("binary_little_endian", &elements, &[0; 12]);
        assert_eq!(malformed(&[("m.ply", &file)]).0, FilePosition::Byte(file.len()));
        let elements = format!("element vertex 3\n{VERTEX}element face {count}\n{FACE}");
        let file = ply("binary_little_endian", &elements, &body());
        assert_eq!(malformed(&[("m.ply", &file)]).0, FilePosition::Byte(file.len()));
    }
    // One more than the greatest count.
    let elements = format!("element vertex 18446744073709551616\n{VERTEX}");
    assert_eq!(malformed(&[("m.ply", &ply("ascii", &elements, b""))]).0, FilePosition::Line(3));
}

#[test]
fn lists_of_a_ply_beyond_the_file_are_errors() {
    let elements = format!("element vertex 3\n{VERTEX}element face 1\n{FACE}");
    let mut long = body();
    long.truncate(36);
    long.extend(u32::MAX.to_le_bytes());
    long.extend([0; 8]);
    let (_, message) = malformed(&[("m.ply", &ply("binary_little_endian", &elements, &long))]);
    assert_eq!(
        message,
        "a list of 4294967295 numbers, and 8 bytes follow; the header declares 3 `vertex` and 1 `face`"
    );
    let text = b"0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n";
    let (position, message) = malformed(&[("m.ply", &ply("ascii", &elements, text))]);
    assert_eq!(position, FilePosition::Line(13));
    assert_eq!(message, "a list of 4294967295 numbers, and 7 bytes follow");
    // The list of an element that is skipped.
    let elements = "element other 1\nproperty list int double values\n";
    let (_, message) = malformed(&[("m.ply", &ply("binary_little_endian", elements, &[255, 255, 255, 127]))]);
    assert_eq!(message, "a list of 2147483647 numbers, and 0 bytes follow; the header declares 1 `other`");
}

#[test]
fn a_polygon_of_a_ply_counts() {
    // A byte per corner in the file; 44 bytes in memory while the face is divided, and 12 for its triangle.
    let face = "property list uint uchar vertex_indices\n";
    let elements = format!("element vertex 3\n{VERTEX}element face 1\n{face}");
    let mut file = ply("binary_little_endian", &elements, &body()[..36]);
    file.extend(100_000_u32.to_le_bytes());
    file.extend([0, 1, 2].repeat(33_333));
    file.push(0);
    let (what, needed, _) = too_large(&[("m.ply", &file)], SMALL);
    assert_eq!((what.as_str(), needed), ("the scene's triangles", 12 * 99_998));
    assert_eq!(too_large(&[("m.ply", &file)], 4 << 20).0, "the corners of a face");
    assert_eq!(loaded(&[("m.ply", &file)], 6 << 20).unwrap().triangles(), 99_998);
}

#[test]
fn binary_bodies_begin_after_the_line_end_of_the_header() {
    let elements = format!("element first 1\nproperty uchar a\nelement vertex 3\n{VERTEX}element face 1\n{FACE}");
    let header = String::from_utf8(ply("binary_little_endian", &elements, b"")).unwrap();
    for end in ["\n", "\r\n", "\r"] {
        for first in [b'\n', b'\r', 0] {
            // A long file has bytes after its body, which are ignored, and no further line end.
            for rest in [0, 1 << 20] {
                let header = header.replace('\n', end).into_bytes();
                let file = [header, vec![first], body(), vec![0; rest]].concat();
                let scene = loaded(&[("m.ply", &file)], 2 * SMALL);
                assert_eq!(scene.map(|scene| scene.triangles()), Ok(1), "{end:?}, {first}, {rest}");
            }
        }
    }
}

#[test]
fn headers_have_a_greatest_length() {
    let header = format!("ply\nformat ascii 1.0\n{}", "comment\n".repeat(200_000));
    match loaded(&[("m.ply", header.as_bytes())], 8 << 20) {
        Err(Error::Malformed { message, .. }) => {
            assert_eq!(message, "`end_header` is missing in the first 1048576 bytes");
        }
        other => panic!("{other:?}"),
    }
}

/// A model with a triangle in mesh 0. `nodes` is a list; scene 0 has node 0.
fn gltf(nodes: &str, buffer: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": {nodes},
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
            {{"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 12}}],
        "buffers": [{{"byteLength": 48, {buffer}}}]}}"#
    )
}

/// The bytes of the triangle.
fn buffer() -> Vec<u8> {
    let body = body();
    [&body[..36], &body[40..]].concat()
}

fn gltf_message(model: &str) -> String {
    malformed(&[("m.gltf", model.as_bytes()), ("b.bin", &buffer())]).1
}

const URI: &str = r#""uri": "b.bin""#;

#[test]
fn nodes_are_a_forest() {
    let doubled: Vec<String> = (1..40).map(|child| format!(r#"{{"children": [{child}, {child}]}}"#)).collect();
    let cases = [
        (format!("[{}, {{\"mesh\": 0}}]", doubled.join(", ")), "node 1 is a child of node 0 twice"),
        (
            r#"[{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}]"#.to_owned(),
            "node 3 has two parents, nodes 1 and 2",
        ),
        (r#"[{"children": [0]}]"#.to_owned(), "node 0 is its own child"),
        (r#"[{"children": [1]}, {"children": [2]}, {"children": [0]}]"#.to_owned(), "node 0 is its own descendant"),
        // A cycle beside the scene.
        (r#"[{"mesh": 0}, {"children": [2]}, {"children": [1]}]"#.to_owned(), "node 1 is its own descendant"),
    ];
    for (nodes, expected) in cases {
        assert_eq!(gltf_message(&gltf(&nodes, URI)), expected);
    }
    let model = gltf(r#"[{"mesh": 0}]"#, URI).replace(r#""nodes": [0]"#, r#""nodes": [0, 0]"#);
    assert_eq!(gltf_message(&model), "node 0 occurs twice in scene 0");
    // A chain of nodes is as deep as there are nodes.
    let chain: Vec<String> = (1..500).map(|child| format!(r#"{{"children": [{child}]}}"#)).collect();
    let model = gltf(&format!("[{}, {{\"mesh\": 0}}]", chain.join(", ")), URI);
    let files = [("m.gltf", model.as_bytes()), ("b.bin", &buffer()[..])];
    assert_eq!(loaded(&files, SMALL).unwrap().triangles(), 1);
}

#[test]
fn instances_of_a_mesh_count() {
    let children: Vec<String> = (1..=600).map(|child| child.to_string()).collect();
    let nodes = format!("[{{\"children\": [{}]}}{}]", children.join(", "), r#", {"mesh": 0}"#.repeat(600));
    let model = gltf(&nodes, URI);
    let files = [("m.gltf", model.as_bytes()), ("b.bin", &buffer()[..])];
    let whole = loaded(&files, 2 * SMALL).unwrap();
    assert_eq!((whole.objects.len(), whole.triangles()), (600, 600));
    let (what, ..) = too_large(&files, 900_000);
    assert!(what.starts_with("the scene's"), "{what}");
}

#[test]
fn parsed_json_counts() {
    // Three bytes per node.
    let model = gltf(&format!("[{{}}{}]", ",{}".repeat(10_000)), URI);
    let (what, needed, _) = too_large(&[("m.gltf", model.as_bytes())], SMALL);
    assert!(what == "the parsed JSON" && needed > 10_000 * 1024, "{what}: {needed}");
    // Brackets in strings are no values.
    let model = gltf(r#"[{"mesh": 0}]"#, &format!(r#""name": "{}\"", {URI}"#, "{".repeat(10_000)));
    let files = [("m.gltf", model.as_bytes()), ("b.bin", &buffer()[..])];
    assert!(loaded(&files, SMALL).is_ok());
    // Deep nesting is an error of the parser.
    let nested = format!("{}{}", "[".repeat(5000), "]".repeat(5000));
    let model = gltf(r#"[{"mesh": 0}]"#, URI).replace("[0, 0, 0]", &nested);
    assert!(gltf_message(&model).contains("recursion limit"));
}

#[test]
fn buffers_count() {
    let data = "A".repeat(600_000);
    let model = gltf(r#"[{"mesh": 0}]"#, &format!(r#""uri": "data:;base64,{data}""#));
    let (what, needed, _) = too_large(&[("m.gltf", model.as_bytes())], 1_300_000);
    assert_eq!((what.as_str(), needed), ("buffer 0", 600_000 + ";base64,".len() as u64));
    // Each of many buffers reads the same file.
    let more = r#", {"byteLength": 48, "uri": "b.bin"}"#.repeat(20);
    let model = gltf(r#"[{"mesh": 0}]"#, URI).replace("b.bin\"}]", &format!("b.bin\"}}{more}]"));
    let bytes = vec![0; 100_000];
    let (what, needed, _) = too_large(&[("m.gltf", model.as_bytes()), ("b.bin", &bytes)], SMALL);
    assert_eq!((what.as_str(), needed), ("the file", 100_000));
}

#[test]
fn accessors_beyond_their_buffers_are_errors() {
    let model = gltf(r#"[{"mesh": 0}]"#, URI);
    let changed = |from: &str, to: &str| {
        assert!(model.contains(from), "{from}");
        gltf_message(&model.replacen(from, to, 1))
    };
    for count in ["1099511627776", "4294967296", "18446744073709551615", "4"] {
        let message = changed(r#""count": 3"#, &format!(r#""count": {count}"#));
        let expected = format!(
            "accessor 0: it reaches beyond its buffer: {count} elements of 12 bytes from byte 0, of a view of 36 bytes and a buffer of 48"
        );
        assert_eq!(message, expected);
    }
    let beyond = "accessor 0: it reaches beyond its buffer";
    let max = r#""count": 3, "byteOffset": 18446744073709551615"#;
    assert!(changed(r#""count": 3"#, max).starts_with(beyond));
    let view = r#""byteOffset": 18446744073709551615, "byteLength": 36"#;
    assert!(changed(r#""byteLength": 36"#, view).starts_with(beyond));
    assert!(changed(r#""byteLength": 36"#, r#""byteLength": 49"#).starts_with(beyond));
    let stride = changed(r#""byteLength": 36"#, r#""byteLength": 36, "byteStride": 4"#);
    assert_eq!(stride, "accessor 0: its elements have 12 bytes, and its view a stride of 4");
    for stride in [0, 3, 253] {
        let message = changed(r#""byteLength": 36"#, &format!(r#""byteLength": 36, "byteStride": {stride}"#));
        assert_eq!(message, format!("buffer view 0: a stride of {stride} bytes is not from 4 to 252"));
    }
    assert_eq!(changed(r#""count": 3"#, r#""count": 0"#), "accessor 0: it is empty");
    assert!(changed("\"byteLength\": 48", "\"byteLength\": 18446744073709551615").contains("declares"));
}

#[test]
fn indices_beyond_their_lists_are_errors() {
    let model = gltf(r#"[{"mesh": 0}]"#, URI).replace(r#""indices": 1"#, r#""indices": 1, "material": 0"#);
    let model = model.replace(r#""meshes""#, r#""materials": [{}], "meshes""#);
    assert!(loaded(&[("m.gltf", model.as_bytes()), ("b.bin", &buffer())], SMALL).is_ok());
    let changed = |from: &str, to: &str| {
        assert!(model.contains(from), "{from}");
        gltf_message(&model.replacen(from, to, 1))
    };
    let cases = [
        (r#""scene": 0"#, r#""scene": 1"#, "the default scene is number 1, and the file has 1"),
        (r#""nodes": [0]"#, r#""nodes": [4]"#, "scene 0: its node is number 4, and the file has 1"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 9}"#, "node 0: its mesh is number 9, and the file has 1"),
        (r#"{"mesh": 0}"#, r#"{"children": [1]}"#, "node 0: its child is number 1, and the file has 1"),
        (r#""POSITION": 0"#, r#""POSITION": 2"#, "mesh 0, primitive 0: the accessor of an attribute is number 2"),
        (r#""indices": 1"#, r#""indices": 7"#, "mesh 0, primitive 0: the accessor of its indices is number 7"),
        (r#""material": 0"#, r#""material": 1"#, "mesh 0, primitive 0: its material is number 1"),
        (r#""material": 0"#, r#""mode": 7"#, "mesh 0, primitive 0: its mode is unknown"),
        (r#""material": 0"#, r#""targets": [{"POSITION": 5}]"#, "mesh 0, primitive 0: the accessor of a morph target"),
        (r#""bufferView": 0"#, r#""bufferView": 2"#, "accessor 0: its buffer view is number 2, and the file has 2"),
        (r#""buffer": 0"#, r#""buffer": 1"#, "buffer view 0: its buffer is number 1, and the file has 1"),
        ("5126", "5130", "accessor 0: its component type is unknown"),
        ("VEC3", "VEC5", "accessor 0: its type is unknown"),
    ];
    for (from, to, expected) in cases {
        let message = changed(from, to);
        assert!(message.starts_with(expected), "{to}: {message}");
    }
    // No accessors at all.
    let end = model.find(r#""bufferViews""#).unwrap();
    let none = format!("{}{}", &model[..model.find(r#""accessors""#).unwrap()], &model[end..]);
    assert!(gltf_message(&none).ends_with("is number 0, and the file has 0"));
}

#[test]
fn accessors_have_the_types_of_their_use() {
    let model = gltf(r#"[{"mesh": 0}]"#, URI);
    let changed = |from: &str, to: &str| gltf_message(&model.replacen(from, to, 1));
    for shape in ["VEC2", "VEC4", "SCALAR", "MAT4"] {
        let message = changed("VEC3", shape);
        assert!(message.starts_with("accessor 0: its type is "), "{message}");
    }
    assert!(changed("5126", "5125").starts_with("accessor 0: its type is "));
    for component in ["5126", "5122", "5120"] {
        assert!(changed("5125", component).starts_with("accessor 1: its type is "));
    }
    assert!(changed("SCALAR", "VEC3").starts_with("accessor 1: its type is "));
    assert!(changed("\"POSITION\": 0", "\"NORMAL\": 0").contains("a primitive without POSITION is not drawn"));
    assert!(changed("\"POSITION\": 0", "\"POSITION\": 0, \"COLOR_0\": 1").starts_with("accessor 1: its type is "));
}

#[test]
fn sparse_elements_replace_others() {
    // The first vertex moves to (0, 1, 0), which the view of the third holds.
    let sparse = |count: u64, number: u64, offset: u64| {
        format!(
            r#""count": 3, "sparse": {{"count": {count},
            "indices": {{"bufferView": 1, "byteOffset": {number}, "componentType": 5125}},
            "values": {{"bufferView": 0, "byteOffset": {offset}}}}}"#
        )
    };
    let model = |sparse: &str, base: &str| {
        let model = gltf(r#"[{"mesh": 0}]"#, URI).replacen(r#""count": 3"#, sparse, 1);
        model.replacen(r#"{"bufferView": 0, "componentType": 5126"#, &format!(r#"{{{base}"componentType": 5126"#), 1)
    };
    let positions = |model: &str| {
        let scene = loaded(&[("m.gltf", model.as_bytes()), ("b.bin", &buffer())], SMALL).unwrap();
        scene.objects[0].positions.clone()
    };
    let base = r#""bufferView": 0, "#;
    let moved = positions(&model(&sparse(1, 0, 24), base));
    assert_eq!(moved, [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    // Without a view the others are 0.
    assert_eq!(positions(&model(&sparse(1, 4, 12), "")), [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]]);
    let failed = |sparse: &str| gltf_message(&model(sparse, base));
    assert_eq!(failed(&sparse(4, 0, 0)), "accessor 0: it replaces 4 of 3 elements");
    assert!(failed(&sparse(3, 4, 0)).starts_with("accessor 0: it reaches beyond its buffer: 3 elements of 4 bytes"));
    assert!(failed(&sparse(2, 0, 24)).starts_with("accessor 0: it reaches beyond its buffer: 2 elements of 12 bytes"));
    let floats = sparse(1, 12, 0).replace("\"bufferView\": 1", "\"bufferView\": 0");
    // The bits of 1.0, as an integer.
    assert_eq!(failed(&floats), "accessor 0: it replaces element 1065353216 of 3");
    let zeros = sparse(2, 0, 0).replace("\"bufferView\": 1", "\"bufferView\": 0");
    assert_eq!(failed(&zeros), "accessor 0: the numbers of its sparse elements do not increase at 1");
}

#[test]
fn morph_targets_count() {
    let sparse = r#""count": 10000, "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5125},
        "values": {"bufferView": 0}}"#;
    let model = gltf(r#"[{"mesh": 0}]"#, URI).replacen(r#""count": 3"#, sparse, 1);
    let model = model.replacen(r#"{"bufferView": 0, "componentType""#, r#"{"componentType""#, 1);
    let loaded = |targets: usize, weight: &str| {
        let list = |word: &str| vec![word; targets].join(", ");
        let targets = format!(r#""indices": 1, "targets": [{}]"#, list(r#"{"POSITION": 0}"#));
        let weights = format!(r#""mesh": 0, "weights": [{}]"#, list(weight));
        let model = model.replace(r#""indices": 1"#, &targets).replace(r#""mesh": 0"#, &weights);
        loaded(&[("m.gltf", model.as_bytes()), ("b.bin", &buffer())], SMALL)
    };
    // All targets share one accessor of 10 000 positions.
    let error = loaded(20, "1").unwrap_err();
    let Error::TooLarge { what, needed, .. } = &error else { panic!("{error}") };
    assert_eq!((what.as_str(), *needed), ("the morph targets", 12 * 10_000));
    assert_eq!(loaded(2, "1").unwrap().vertices(), 10_000);
    // A target without weight is not read.
    assert_eq!(loaded(20, "0").unwrap().vertices(), 10_000);
}

#[test]
fn lengths_in_a_glb_are_checked() {
    let json = gltf(r#"[{"mesh": 0}]"#, URI).into_bytes();
    let file = |length: u32, json_length: u32| {
        let words = [2, length, json_length].map(u32::to_le_bytes).concat();
        [b"glTF".as_slice(), &words, b"JSON", &json].concat()
    };
    let whole = 20 + json.len() as u32;
    for length in [0, 11, 12, 19, u32::MAX, whole + 1] {
        let (_, message) = malformed(&[("m.glb", &file(length, json.len() as u32))]);
        assert_eq!(message, format!("the header declares {length} bytes, and the file has {whole}"));
    }
    for json_length in [u32::MAX, whole] {
        malformed(&[("m.glb", &file(whole, json_length))]);
    }
    assert_eq!(malformed(&[("m.glb", b"glTF\x02\0\0\0")]).1, "the header is incomplete: 8 of 20 bytes");
}

#[test]
fn generated_scenes_count() {
    let error =
        open("builtin:hairball,strands=100000", COLOR, &Limits { memory: SMALL, ..Limits::default() }).unwrap_err();
    let Error::TooLarge { file, limit, .. } = &error else { panic!("{error}") };
    assert_eq!((file.as_str(), *limit), ("builtin:hairball", SMALL));
    assert!(error.to_string().contains("of 1048576 bytes are left: use a smaller model or a larger budget"), "{error}");
}
