//! Small models in every format, and one malformed model per error with its position.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::io::Write as _;
use std::path::PathBuf;

use base64::Engine as _;
use fragbuf_scene::{Error, FilePosition, Limits, Scene, load};
use tempfile::TempDir;

const COLOR: [f32; 4] = [0.5, 0.5, 0.5, 0.25];

/// Writes the files and loads the first.
fn loaded(files: &[(&str, &[u8])]) -> Result<Scene, Error> {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    for (path, (_, bytes)) in paths.iter().zip(files) {
        std::fs::write(path, bytes).unwrap();
    }
    let mut scene = load(&paths[0], COLOR, &Limits::default())?;
    // Every model has a folder of its own.
    assert_eq!(scene.files.first(), paths.first());
    scene.files.clear();
    Ok(scene)
}

/// Returns the file name, the position and the message of the error.
fn malformed(files: &[(&str, &[u8])]) -> (String, FilePosition, String) {
    match loaded(files) {
        Err(Error::Malformed { file, position, message }) => {
            (file.rsplit('/').next().unwrap().to_owned(), position, message)
        }
        other => panic!("{:?}: {other:?}", String::from_utf8_lossy(files[0].1)),
    }
}

/// Checks that every text is an error at this line, with this part in its message.
fn malformed_lines(name: &str, cases: &[(&str, usize, &str)]) {
    for (text, line, part) in cases {
        let (file, position, message) = malformed(&[(name, text.as_bytes())]);
        assert_eq!((file.as_str(), position), (name, FilePosition::Line(*line)), "{text}: {message}");
        assert!(message.contains(part), "{text}: {message}");
    }
}

#[test]
fn obj_with_materials() {
    let model = b"# a square and a triangle\nmtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 \\\n 0\nv 0 1 0\nvt 0 0\nvn 0 0 2\no square\n\
        usemtl glass\nf 1//1 2//1 3//1 4//1\ng tri\nusemtl red\nf -4 -3 -2\nl 1 2\n";
    let library = b"newmtl glass\nKd 0.2 0.4 0.6\nd 0.5 # half\nNs 10\nnewmtl red\nKd 1 0 0\nTr 0.25\nmap_Kd x.png\n";
    let scene = loaded(&[("m.obj", model), ("a b.mtl", library)]).unwrap();
    let [square, triangle] = scene.objects.as_slice() else { panic!("{scene:?}") };
    assert_eq!((square.name.as_str(), triangle.name.as_str()), ("square", "tri"));
    assert_eq!(square.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(square.positions[2], [1.0, 1.0, 0.0]);
    assert_eq!(square.colors[0], [0.2, 0.4, 0.6, 0.5]);
    assert_eq!(square.normals[0], [0.0, 0.0, 1.0]);
    assert_eq!(triangle.colors, [[1.0, 0.0, 0.0, 0.75]; 3]);
    assert_eq!(triangle.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!((scene.triangles(), scene.vertices()), (3, 7));
    assert_eq!(scene.bounds(), Some(([0.0; 3], [1.0, 1.0, 0.0])));
}

#[test]
fn obj_without_materials() {
    let scene = loaded(&[("m.obj", b"v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n")]).unwrap();
    assert_eq!(scene.objects[0].colors, [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], COLOR]);
}

#[test]
fn corners_may_end_in_slashes() {
    let expected = loaded(&[("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")]).unwrap();
    let scene = loaded(&[("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1// 2/1/ 3/\n")]).unwrap();
    assert_eq!(scene, expected);
}

#[test]
fn obj_errors_have_lines() {
    malformed_lines(
        "m.obj",
        &[
            ("v 0 0\n", 1, "found 2"),
            ("\n# x\nv 0 0 x\n", 3, "`x` is not a number"),
            ("v 0 0 nan\n", 1, "not finite"),
            ("v 0 0 1e301\n", 1, "not from -1e300 to 1e300"),
            ("v 0 0 0\nf 1 1 3\nv 0 0 0\n", 2, "no position 3: the file has 2"),
            ("v 0 0 0\nf 1 1 0\n", 2, "no position 0"),
            ("v 0 0 0\nf 1 1 -2\n", 2, "no position -2"),
            ("v 0 0 0\nf 1 1 -2\nv 0 0 0\n", 2, "no position -2"),
            ("v 0 0 0\nf 1 1 1/2/3/4\n", 2, "more than position/texture/normal"),
            ("v 0 0 0\nf 1 1 1//a\n", 2, "`a` is not an index of a normal"),
            ("v 0 0 0\nf 1 1 a\n", 2, "`a` is not an index"),
            ("v 0 0 0\nf 1 1 1/a\n", 2, "`a` is not an index"),
        ],
    );
    let (_, position, message) = malformed(&[("m.obj", b"v 0 0 0\n")]);
    assert_eq!((position, message.as_str()), (FilePosition::Whole, "the model has no triangles"));
}

#[test]
fn mtl_errors_have_their_file_and_line() {
    let cases: [(&str, usize, &str); 4] = [
        ("newmtl a\nKd 1 1\n", 2, "found 2"),
        ("newmtl a\nKd 1 1 nan\n", 2, "`nan` is not finite"),
        ("newmtl a\n\nd x\n", 3, "`x` is not a number"),
        ("newmtl a\nd\n", 2, "found 0"),
    ];
    for (text, line, part) in cases {
        let (file, position, message) = malformed(&[("m.obj", b"mtllib l.mtl\n"), ("l.mtl", text.as_bytes())]);
        assert_eq!((file.as_str(), position), ("l.mtl", FilePosition::Line(line)), "{text}");
        assert!(message.contains(part), "{text}: {message}");
    }
}

#[test]
fn comments_end_with_their_line_and_names_have_any_letter() {
    let model = b"\xef\xbb\xbf# from C:\\models\\\nmtllib a.mtl\nv 0 0 0 # b\\\nv 1 0 0\nv 0 1 0\nusemtl Material #1\nf 1 2 3\n\
        usemtl Material #2\nf 1 3 2\nusemtl plain # a comment\nf 2 1 3\n";
    let library =
        b"\xef\xbb\xbfnewmtl Material #1\nKd 1 0 0\nnewmtl Material #2\nKd 0 1 0\nnewmtl plain # another\nKd 0 0 1\n";
    let scene = loaded(&[("m.obj", model), ("a.mtl", library)]).unwrap();
    let object = &scene.objects[0];
    let colors: Vec<[f32; 4]> = object.triangles.iter().map(|triangle| object.colors[triangle[0] as usize]).collect();
    assert_eq!(colors, [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
}

#[test]
fn a_number_sign_begins_a_comment_unless_it_is_part_of_a_name() {
    let library = |red: f32| format!("newmtl a\nKd {red} 0 0\n").into_bytes();
    let red = |statement: &str, files: &[(&str, &[u8])]| {
        let model = format!("{statement}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        let scene = loaded(&[&[("m.obj", model.as_bytes())], files].concat()).unwrap();
        scene.objects[0].colors[0][0]
    };
    let [plain, numbered] = [library(0.25), library(0.5)];
    let both: [(&str, &[u8]); 2] = [("a.mtl", &plain), ("a.mtl #1", &numbered)];
    for (statement, expected) in [
        ("mtllib a.mtl", 0.25),
        ("mtllib a.mtl # a comment", 0.25),
        ("mtllib a.mtl#", 0.25),
        ("mtllib a.mtl #1", 0.5),
        ("mtllib a.mtl #1 # a comment # and another", 0.5),
    ] {
        assert_eq!(red(statement, &both), expected, "{statement}");
    }
    // A backslash at the end of a comment does not continue it.
    let model = b"v 0 0 0\no cube # from C:\\models\\\nv 1 0 0\nv 0 1 0\ng  a  part # of it\nf 1 2 3\n";
    let scene = loaded(&[("m.obj", model)]).unwrap();
    assert_eq!((scene.objects[0].name.as_str(), scene.vertices()), ("a part", 3));
}

#[test]
fn a_later_material_replaces_one_of_the_same_name() {
    let red = |name: &str, library: &str| {
        let model = format!("mtllib l\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl {name}\nf 1 2 3\n");
        let scene = loaded(&[("m.obj", model.as_bytes()), ("l", library.as_bytes())]).unwrap();
        scene.objects[0].colors[0][0]
    };
    let twice = |first: &str, second: &str| format!("newmtl {first}\nKd 0.25 0 0\nnewmtl {second}\nKd 0.5 0 0\n");
    assert_eq!(red("a", &twice("a", "a")), 0.5);
    assert_eq!(red("a", &twice("a # one", "a # two")), 0.5);
    assert_eq!([red("a #1", &twice("a #1", "a #2")), red("a #2", &twice("a #1", "a #2"))], [0.25, 0.5]);
    // The whole name has precedence.
    assert_eq!([red("a", &twice("a", "a #2")), red("a # b", &twice("a", "a #2"))], [0.25, 0.25]);
}

#[test]
fn opacities_may_have_an_option() {
    for line in ["d 0.25", "d -halo 0.25", "d -halo\t0.25", "d\t-halo \t 0.25", "Tr 0.75"] {
        let library = format!("newmtl a\n{line}\n");
        let model = b"mtllib l\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
        let scene = loaded(&[("m.obj", model), ("l", library.as_bytes())]).unwrap();
        assert_eq!(scene.objects[0].colors[0][3], 0.25, "{line:?}");
    }
}

/// Returns how many triangles cover a point of the xy plane.
fn layers(scene: &Scene, [x, y]: [f32; 2]) -> usize {
    let object = &scene.objects[0];
    let covers = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(|index| object.positions[index as usize]);
        let edge = |from: [f32; 3], to: [f32; 3]| (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
        // All faces run counter-clockwise.
        edge(a, b) > 0.0 && edge(b, c) > 0.0 && edge(c, a) > 0.0
    };
    object.triangles.iter().filter(covers).count()
}

#[test]
fn concave_faces_keep_their_notches() {
    // An arrowhead with its notch at the bottom, from each of its corners on; and a comb of five teeth.
    let arrow = [[-1.0, -1.0], [0.0, 0.0], [1.0, -1.0], [0.0, 1.0]];
    let mut comb = vec![[0.0, -1.0], [10.0, -1.0]];
    comb.extend((0..5).flat_map(|tooth| {
        let right = 10.0 - 2.0 * tooth as f32;
        [[right, 1.0], [right - 1.0, 1.0], [right - 1.0, 0.0], [right - 2.0, 0.0]]
    }));
    for scale in [1.0, 1.0e-12, 1.0e15] {
        for first in 1..=4 {
            let face: Vec<String> = (0..4).map(|corner| ((first + corner - 1) % 4 + 1).to_string()).collect();
            let lines: String = arrow.map(|[x, y]| format!("v {} {} 0\n", x * scale, y * scale)).concat();
            let scene = loaded(&[("m.obj", format!("{lines}f {}\n", face.join(" ")).as_bytes())]).unwrap();
            assert_eq!(scene.triangles(), 2);
            let scale = (scale / scene.placement.unit) as f32;
            let at = |point: [f32; 2]| layers(&scene, point.map(|axis| axis * scale));
            assert_eq!([at([0.05, -0.5]), at([0.1, 0.5]), at([-0.6, -0.5]), at([0.6, -0.5])], [0, 1, 1, 1], "{first}");
        }
    }
    let lines: String = comb.iter().map(|[x, y]| format!("{x} {y} 0\n")).collect();
    let header = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n",
        comb.len()
    );
    let face: Vec<String> = (0..comb.len()).map(|corner| corner.to_string()).collect();
    let scene = loaded(&[("m.ply", format!("{header}{lines}{} {}\n", comb.len(), face.join(" ")).as_bytes())]).unwrap();
    for column in 0..10 {
        let x = column as f32 + 0.43;
        assert_eq!([layers(&scene, [x, 0.61]), layers(&scene, [x, -0.33])], [column % 2, 1], "{x}");
    }
    // Without area a face is a fan; too many corners of a concave one are an error.
    let line = b"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n";
    assert_eq!(loaded(&[("m.obj", line)]).unwrap().triangles(), 2);
    let zigzag: String = (0..5000).map(|at| format!("v {at} {} 0\n", at % 2)).collect();
    let face: Vec<String> = (1..=5000).map(|corner| corner.to_string()).collect();
    let text = format!("{zigzag}v 2500 -9 0\nf {} 5001\n", face.join(" "));
    let (_, position, message) = malformed(&[("m.obj", text.as_bytes())]);
    assert_eq!(
        (position, message.as_str()),
        (FilePosition::Line(5002), "a concave face with 5001 corners: it can have 4096")
    );
}

#[test]
fn colours_of_positions_have_an_alpha() {
    let scene = loaded(&[("m.obj", b"v 0 0 0 1 0 0 0.5\nv 1 0 0 0 1 0\nv 0 1 0 1.0\nf 1 2 3\n")]).unwrap();
    assert_eq!(scene.objects[0].colors, [[1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 1.0], COLOR]);
}

#[test]
fn lines_end_in_three_ways() {
    let text = "v 0 0 0\n\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n";
    for end in ["\n", "\r\n", "\r"] {
        let (_, position, message) = malformed(&[("m.obj", text.replace('\n', end).as_bytes())]);
        assert_eq!(position, FilePosition::Line(6), "{message}");
    }
    let text =
        String::from_utf8(ply("ascii", b"0 0 0 255 255 255\n1 0 0 0 0 0\n\n0 1 0.5 51 51 51\n3 0 1 2\n7\n")).unwrap();
    let expected = loaded(&[("m.ply", text.as_bytes())]).unwrap();
    let wrong = text.replace("3 0 1 2", "3 0 1 3");
    let line = 1 + wrong.lines().position(|line| line == "3 0 1 3").unwrap();
    for end in ["\r\n", "\r"] {
        assert_eq!(loaded(&[("m.ply", text.replace('\n', end).as_bytes())]).unwrap(), expected);
        let (_, position, message) = malformed(&[("m.ply", wrong.replace('\n', end).as_bytes())]);
        assert_eq!(position, FilePosition::Line(line), "{message}");
    }
    // Lines that do not have one vertex each are read, with a warning; a comment has any encoding.
    let body = text.find("end_header\n").unwrap() + "end_header\n".len();
    let one_line = format!("{}{}", &text[..body], text[body..].replace('\n', " "));
    let scene = loaded(&[("m.ply", one_line.as_bytes())]).unwrap();
    assert_eq!((&scene.objects, scene.warnings.len()), (&expected.objects, 1));
    let latin = [&text.as_bytes()[..body - 11], b"comment caf\xe9\n", &text.as_bytes()[body - 11..]].concat();
    assert_eq!(loaded(&[("m.ply", &latin)]).unwrap(), expected);
}

fn ply(format: &str, body: &[u8]) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\ncomment made here\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
         property list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n"
    );
    [header.as_bytes(), body].concat()
}

/// Returns the bytes of a body; `order` reorders the bytes of each number.
fn binary(index: i32, order: fn(&mut [u8])) -> Vec<u8> {
    let mut body = Vec::new();
    let mut push = |mut bytes: Vec<u8>| {
        order(&mut bytes);
        body.extend(bytes);
    };
    for (vertex, color) in [([0.0_f32, 0.0, 0.0], 255), ([1.0, 0.0, 0.0], 0), ([0.0, 1.0, 0.5], 51)] {
        vertex.iter().for_each(|value| push(value.to_le_bytes().to_vec()));
        [color; 3].iter().for_each(|channel: &u8| push(vec![*channel]));
    }
    push(vec![3]);
    [0, 1, index].iter().for_each(|index| push(index.to_le_bytes().to_vec()));
    push(7_i32.to_le_bytes().to_vec());
    body
}

#[test]
fn ply_in_three_encodings_and_compressed() {
    let ascii = ply("ascii", b"0 0 0 255 255 255\n1 0 0 0 0 0\n\n0 1 0.5 51 51 51\n3 0 1 2\n7\n");
    let little = ply("binary_little_endian", &binary(2, |_| {}));
    let big = ply("binary_big_endian", &binary(2, <[u8]>::reverse));
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gz.write_all(&little).unwrap();
    let gz = gz.finish().unwrap();
    let expected = loaded(&[("m.ply", &ascii)]).unwrap();
    assert_eq!(expected.objects[0].positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]]);
    assert_eq!(expected.objects[0].colors, [[1.0; 4], [0.0, 0.0, 0.0, 1.0], [0.2, 0.2, 0.2, 1.0]]);
    assert_eq!(expected.objects[0].triangles, [[0, 1, 2]]);
    for (name, bytes) in [("m.ply", &little), ("m.ply", &big), ("m.ply.gz", &gz)] {
        assert_eq!(loaded(&[(name, bytes)]).unwrap(), expected);
    }
    let (_, _, message) = malformed(&[("m.ply.gz", &gz[..gz.len() / 2])]);
    assert!(message.contains("invalid gzip data"), "{message}");
}

#[test]
fn ply_without_colours_uses_the_default_colour() {
    let text = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let scene = loaded(&[("m.ply", text)]).unwrap();
    assert_eq!((scene.objects[0].colors[0], scene.objects[0].normals[0]), (COLOR, [0.0, 0.0, 1.0]));
}

#[test]
fn ply_errors_have_lines() {
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n";
    let body = |body: &str| format!("{header}{body}");
    let cases = [
        ("plyx\n".to_owned(), 1, "begins with `ply`"),
        ("ply\nformat asci 1.0\n".to_owned(), 2, "unknown format `asci`"),
        ("ply\nformat ascii 1.0\nelement vertex many\n".to_owned(), 3, "`many` is not a count"),
        ("ply\nformat ascii 1.0\nproperty float x\n".to_owned(), 3, "a property before the first element"),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n".to_owned(),
            4,
            "unknown type `half`: the types are char, uchar, short, ushort, int, uint, float and double",
        ),
        ("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n".to_owned(), 3, "no `x`"),
        ("ply\nend_header\n".to_owned(), 2, "no `format`"),
        ("ply\nformat ascii 1.0\nelement face 0\nend_header\n".to_owned(), 3, "no list `vertex_indices`"),
        (body("0 0 0\n1 0\n"), 11, "ends before its last"),
        (body("0 0 0\n1 0 0 4\n"), 11, "ends before its last"),
        (body("0 0 0\n1 0 zero\n"), 11, "`zero` is not a number"),
        (body("0 0 0\n1 0 inf\n"), 11, "`z` is not finite"),
        (body("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), 13, "no vertex 3"),
        (body("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), 13, "no vertex -1"),
        (body("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"), 13, "not an integer"),
        (body("0 0 0\n1 0 0\n0 1 0\n"), 12, "ends before its last"),
    ];
    let cases: Vec<(&str, usize, &str)> =
        cases.iter().map(|(text, line, part)| (text.as_str(), *line, *part)).collect();
    malformed_lines("m.ply", &cases);
}

#[test]
fn binary_errors_have_bytes() {
    let header = ply("binary_little_endian", b"").len();
    let whole = ply("binary_little_endian", &binary(2, |_| {}));
    let (_, position, message) = malformed(&[("m.ply", &whole[..header + 20])]);
    assert_eq!(position, FilePosition::Byte(header + 19), "{message}");
    let (_, position, message) = malformed(&[("m.ply", &ply("binary_little_endian", &binary(3, |_| {})))]);
    assert_eq!(position, FilePosition::Byte(header + 58), "{message}");
    assert!(message.contains("no vertex 3"), "{message}");
}

/// Returns a model with one translucent red triangle, moved by its node.
fn gltf(count: usize, buffer: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0, "name": "pane", "translation": [1, 2, 3]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
        "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [1, 0, 0, 0.5]}}, "alphaMode": "BLEND"}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": {count}, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
            {{"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 12}}],
        "buffers": [{{"byteLength": 48{buffer}}}]}}"#
    )
}

fn buffer(last: u32) -> Vec<u8> {
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let positions = positions.iter().flat_map(|value| value.to_le_bytes());
    positions.chain([0, 1, last].iter().flat_map(|index: &u32| index.to_le_bytes())).collect()
}

fn uri(bytes: &[u8]) -> String {
    let text = base64::engine::general_purpose::STANDARD.encode(bytes);
    format!(r#", "uri": "data:application/octet-stream;base64,{text}""#)
}

fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind.as_slice(), bytes].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", binary)].concat();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

#[test]
fn gltf_buffers_in_all_three_storages() {
    let inside = gltf(3, &uri(&buffer(2)));
    let beside = gltf(3, r#", "uri": "b.bin""#);
    let scenes = [
        loaded(&[("m.gltf", inside.as_bytes())]).unwrap(),
        loaded(&[("m.gltf", beside.as_bytes()), ("b.bin", &buffer(2))]).unwrap(),
        loaded(&[("m.glb", &glb(&gltf(3, ""), &buffer(2)))]).unwrap(),
    ];
    for scene in &scenes {
        let object = &scene.objects[0];
        assert_eq!(object.name, "pane");
        assert_eq!(object.positions, [[1.0, 2.0, 3.0], [2.0, 2.0, 3.0], [1.0, 3.0, 3.0]]);
        assert_eq!((object.colors[0], object.normals[0]), ([1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0]));
        assert_eq!(object.triangles, [[0, 1, 2]]);
    }
}

/// Returns the first colour of a model in which this text replaces the alpha mode.
fn gltf_color(from: &str, to: &str) -> [f32; 4] {
    let model = gltf(3, &uri(&buffer(2)));
    assert!(model.contains(from), "{from}");
    loaded(&[("m.gltf", model.replace(from, to).as_bytes())]).unwrap().objects[0].colors[0]
}

#[test]
fn alpha_modes_decide_on_alpha() {
    let mode = |mode: &str| gltf_color(r#", "alphaMode": "BLEND""#, mode)[3];
    assert_eq!((mode(r#", "alphaMode": "BLEND""#), mode(r#", "alphaMode": "OPAQUE""#), mode("")), (0.5, 1.0, 1.0));
    let mask = |cutoff: &str| mode(&format!(r#", "alphaMode": "MASK", "alphaCutoff": {cutoff}"#));
    assert_eq!((mask("0.5"), mask("0.51"), mode(r#", "alphaMode": "MASK""#)), (1.0, 0.0, 1.0));
    // The colour of an extension.
    let factor = r#""extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0, 0.5, 0, 0.25]}}"#;
    let metallic = r#""pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5]}"#;
    assert_eq!(gltf_color(metallic, factor), [0.0, 0.5, 0.0, 0.25]);
}

#[test]
fn vertex_colours_need_no_material() {
    // The positions are the colours, too.
    let with_colors = r#""POSITION": 0, "COLOR_0": 0"#;
    let model = gltf(3, &uri(&buffer(2))).replace(r#""POSITION": 0"#, with_colors).replace(r#", "material": 0"#, "");
    let scene = loaded(&[("m.gltf", model.as_bytes())]).unwrap();
    assert_eq!(scene.objects[0].colors[1], [1.0, 0.0, 0.0, 1.0]);
    let mut infinite = buffer(2);
    infinite[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    let model = gltf(3, &uri(&infinite)).replace(r#""POSITION": 0"#, r#""POSITION": 2, "COLOR_0": 0"#);
    let zeros =
        r#"{"bufferView": 0, "byteOffset": 0, "componentType": 5121, "count": 3, "type": "VEC3"}], "bufferViews""#;
    let model = model.replace("}],\n        \"bufferViews\"", &format!("}}, {zeros}"));
    let (_, _, message) = malformed(&[("m.gltf", model.as_bytes())]);
    assert_eq!(message, "primitive 0: colour 1 is not finite");
}

#[test]
fn skins_morphs_and_lines() {
    let model = gltf(3, &uri(&buffer(2)));
    let first = |model: String| loaded(&[("m.gltf", model.as_bytes())]).unwrap().objects[0].positions[1];
    assert_eq!(first(model.clone()), [2.0, 2.0, 3.0]);
    // The node does not move a mesh with a skin.
    let skinned = model.replace(r#""mesh": 0"#, r#""mesh": 0, "skin": 0"#);
    let skinned = skinned.replace(r#""meshes""#, r#""skins": [{"joints": [0]}], "meshes""#);
    assert_eq!(first(skinned), [1.0, 0.0, 0.0]);
    // The target adds the positions once more; the weights of the node replace those of the mesh.
    let morphed = model.replace(r#""indices": 1"#, r#""indices": 1, "targets": [{"POSITION": 0}]"#);
    let morphed = morphed.replace("\"material\": 0}]", "\"material\": 0}], \"weights\": [0.5]");
    assert_eq!(first(morphed.clone()), [2.5, 2.0, 3.0]);
    assert_eq!(first(morphed.replace(r#""mesh": 0"#, r#""mesh": 0, "weights": [2]"#)), [4.0, 2.0, 3.0]);
    // Lines have no effect.
    let lines = r#""primitives": [{"attributes": {"POSITION": 0}, "mode": 1}, "#;
    let scene = loaded(&[("m.gltf", model.replace(r#""primitives": ["#, lines).as_bytes())]).unwrap();
    assert_eq!((scene.vertices(), scene.triangles()), (3, 1));
}

#[test]
fn uris_are_decoded() {
    let beside = gltf(3, r#", "uri": "b%C3%A9%20%2B.bin""#);
    assert!(loaded(&[("m.gltf", beside.as_bytes()), ("b\u{e9} +.bin", &buffer(2))]).is_ok());
    let text = base64::engine::general_purpose::STANDARD_NO_PAD.encode([buffer(2), vec![0]].concat());
    assert!(!text.len().is_multiple_of(4));
    assert!(loaded(&[("m.gltf", gltf(3, &format!(r#", "uri": "data:;base64,{text}""#)).as_bytes())]).is_ok());
    let percent: String = buffer(2).iter().map(|byte| format!("%{byte:02x}")).collect();
    let model = gltf(3, &format!(r#", "uri": "data:application/octet-stream,{percent}""#));
    assert_eq!(loaded(&[("m.gltf", model.as_bytes())]).unwrap().objects[0].positions[1], [2.0, 2.0, 3.0]);
}

#[test]
fn malformed_gltf_is_an_error() {
    let (_, position, message) = malformed(&[("m.gltf", b"{\n\"asset\": {\"version\": }\n}")]);
    assert_eq!(position, FilePosition::Line(2), "{message}");
    let cases = [
        (gltf(3, &uri(&buffer(3))), "no vertex 3"),
        (gltf(4, &uri(&buffer(2))), "accessor 0: it reaches beyond"),
        (gltf(0, &uri(&buffer(2))), "accessor 0"),
        (gltf(3, &uri(&buffer(2)[..40])), "it has 40 bytes, but declares 48"),
        (gltf(3, ""), "no binary chunk"),
        (gltf(3, r#", "uri": "data:;base64,!!""#), "its data is invalid"),
        (gltf(3, &uri(&buffer(2))).replace("\"mesh\": 0", "\"mesh\": 7"), "node 0: its mesh is number 7"),
        (gltf(3, &uri(&buffer(2))).replace("\"mesh\": 0", "\"children\": [0]"), "node 0 is its own child"),
    ];
    for (text, part) in cases {
        let (_, _, message) = malformed(&[("m.gltf", text.as_bytes())]);
        assert!(message.contains(part), "{part}: {message}");
    }
    let whole = glb(&gltf(3, ""), &buffer(2));
    malformed(&[("m.glb", &whole[..30])]);
    malformed(&[("m.glb", b"glTF")]);
}

#[test]
fn unsupported_files_are_errors() {
    let (_, _, message) = malformed(&[("m.stl", b"solid")]);
    assert!(message.contains(".obj"), "{message}");
    assert!(matches!(load("nowhere.ply".as_ref(), COLOR, &Limits::default()), Err(Error::Unreadable { .. })));
}
