//! Attributes of vertices by name: properties of a PLY, and attributes of a glTF.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use base64::Engine as _;
use fragbuf_scene::{AttributeRequest, Error, Limits, Scene, load_with, open_with};
use tempfile::TempDir;

fn request(name: &str, components: usize, is_integer: bool) -> AttributeRequest {
    AttributeRequest { name: name.to_owned(), components, is_integer, is_optional: false }
}

fn loaded_within(name: &str, bytes: &[u8], requests: &[AttributeRequest], memory: u64) -> Result<Scene, Error> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    load_with(&path, [1.0; 4], requests, &Limits { memory, ..Limits::default() })
}

fn loaded(name: &str, bytes: &[u8], requests: &[AttributeRequest]) -> Result<Scene, Error> {
    loaded_within(name, bytes, requests, 1 << 20)
}

/// Returns the values of an attribute of the first object, and the warnings without the folder.
fn floats(name: &str, bytes: &[u8], request: AttributeRequest) -> (Vec<f32>, Vec<String>) {
    let scene = loaded(name, bytes, &[request]).unwrap_or_else(|error| panic!("{error}"));
    let warnings = scene.warnings.iter().map(|warning| {
        let text = warning.to_string();
        format!("[{}] {}", warning.kind.code(), text.split_once(name).unwrap().1)
    });
    (scene.objects[0].attributes[0].iter().map(|word| f32::from_bits(*word)).collect(), warnings.collect())
}

/// Returns the names and components that the error lists.
fn available(name: &str, bytes: &[u8], request: AttributeRequest) -> Vec<(String, usize)> {
    match loaded(name, bytes, std::slice::from_ref(&request)) {
        Err(Error::MissingAttribute { request: missing, available, .. }) => {
            assert_eq!(missing, request);
            available.into_iter().map(|attribute| (attribute.name, attribute.components)).collect()
        }
        other => panic!("{other:?}"),
    }
}

/// Returns a PLY with a square and the values of its vertices.
fn ply(properties: &str, values: [&str; 4]) -> Vec<u8> {
    let positions = ["-1 -1 0.5", "1 -1 0.5", "1 1 0.5", "-1 1 0.5"];
    let vertices = positions.iter().zip(values).map(|(position, value)| format!("{position} {value}\n"));
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n{properties}element face 1\n\
         property list uchar int vertex_indices\nend_header\n{}4 0 1 2 3\n",
        vertices.collect::<String>()
    )
    .into_bytes()
}

#[test]
fn a_property_of_a_ply_is_an_attribute() {
    let model = ply("property float heat\n", ["0.25", "0.5", "0.75", "1"]);
    assert_eq!(floats("m.ply", &model, request("heat", 1, false)), (vec![0.25, 0.5, 0.75, 1.0], vec![]));
    // Case is ignored if no name is equal, and an integer is a number.
    let model = ply("property uchar Heat\nproperty short heat\n", ["7 -3", "7 0", "7 2", "7 300"]);
    assert_eq!(floats("m.ply", &model, request("heat", 1, false)).0, [-3.0, 0.0, 2.0, 300.0]);
    assert_eq!(floats("m.ply", &model, request("HEAT", 1, false)).0, [7.0; 4]);
    // What is part of every scene has its number, too.
    assert_eq!(floats("m.ply", &model, request("x", 1, false)).0, [-1.0, 1.0, 1.0, -1.0]);
    // A scene without requests is as before.
    let scene = loaded("m.ply", &model, &[]).unwrap();
    assert!(scene.attributes.is_empty() && scene.objects[0].attributes.is_empty());
}

#[test]
fn a_binary_ply_has_attributes() {
    for is_big in [false, true] {
        let order = |mut bytes: Vec<u8>| {
            bytes.reverse();
            bytes
        };
        let number = |bytes: Vec<u8>| if is_big { order(bytes) } else { bytes };
        let mut body = Vec::new();
        for (at, heat) in [([0.0_f32, 0.0, 0.0], 1_u16), ([1.0, 0.0, 0.0], 515), ([0.0, 1.0, 0.0], 65_535)] {
            at.iter().for_each(|value| body.extend(number(value.to_le_bytes().into())));
            // A list before the attribute.
            body.extend([2, 9, 9]);
            body.extend(number(heat.to_le_bytes().into()));
        }
        body.push(3);
        [0_i32, 1, 2].iter().for_each(|index| body.extend(number(index.to_le_bytes().into())));
        let format = if is_big { "binary_big_endian" } else { "binary_little_endian" };
        let header = format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty list uchar uchar \
             heats\nproperty ushort heat\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        );
        let model = [header.as_bytes(), &body].concat();
        assert_eq!(floats("m.ply", &model, request("heat", 1, false)).0, [1.0, 515.0, 65_535.0]);
        let scene = loaded("m.ply", &model, &[request("heat", 1, true)]).unwrap();
        assert_eq!(scene.objects[0].attributes, [[1, 515, 65_535]]);
        // A list is not an attribute.
        let expected = [("heat".to_owned(), 1), ("position".to_owned(), 3)];
        assert_eq!(available("m.ply", &model, request("heats", 1, false)), expected);
    }
}

#[test]
fn the_components_of_a_ply_have_endings() {
    for endings in [["_x", "_y"], ["_0", "_1"], ["_r", "_g"], ["_X", "_Y"], ["x", "y"], ["0", "1"], ["R", "G"]] {
        let [first, second] = endings;
        let properties = format!("property float flow{second}\nproperty float flow{first}\n");
        let model = ply(&properties, ["2 1", "4 3", "6 5", "8 7"]);
        let values = floats("m.ply", &model, request("flow", 2, false)).0;
        assert_eq!(values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], "{endings:?}");
    }
    let model = ply("property float flow_x\nproperty float flow_y\nproperty uchar red\n", ["0 0 0"; 4]);
    let found = available("m.ply", &model, request("flow", 3, false));
    let expected = [("flow_x", 1), ("flow", 2), ("flow_y", 1), ("position", 3)];
    assert_eq!(found, expected.map(|(name, components)| (name.to_owned(), components)));
}

/// Some names have other properties, and an optional attribute is of those that the model has.
#[test]
fn usual_names_of_a_ply_are_attributes() {
    for [u, v] in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]] {
        let model = ply(&format!("property float {u}\nproperty float {v}\n"), ["1 2", "3 4", "5 6", "7 8"]);
        let (values, _) = floats("m.ply", &model, request("uv", 2, false));
        assert_eq!(values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], "{u}");
    }
    let model = ply("property int id\n", ["4"; 4]);
    let optional = |name: &str| AttributeRequest { is_optional: true, ..request(name, 1, true) };
    let scene = loaded("m.ply", &model, &[optional("id"), optional("object")]).unwrap();
    assert_eq!(scene.attributes, [optional("id")]);
    assert_eq!(scene.objects[0].attributes, [[4; 4]]);
    let scene = loaded("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[optional("id")]).unwrap();
    assert_eq!(scene.attributes, []);
}

#[test]
fn values_that_have_no_word_are_replaced() {
    let model = ply("property double heat\n", ["nan", "-inf", "1e39", "1"]);
    let (values, warnings) = floats("m.ply", &model, request("heat", 1, false));
    assert_eq!(values, [0.0, 0.0, 0.0, 1.0]);
    let message = "a value of `heat`, NaN, has no finite `f32`: 0 is used (and 2 more)";
    assert_eq!(warnings, [format!("[invalid-attribute] :11: {message}")]);
    let model = ply("property double heat\n", ["-1", "2.5", "4294967296", "4294967295"]);
    let scene = loaded("m.ply", &model, &[request("heat", 1, true)]).unwrap();
    assert_eq!(scene.objects[0].attributes, [[0, 3, u32::MAX, u32::MAX]]);
    let warnings: Vec<(&str, &str)> =
        scene.warnings.iter().map(|warning| (warning.message.as_str(), warning.instead.as_str())).collect();
    assert_eq!(warnings, [("a value of `heat`, -1, is not a whole number from 0 to 4294967295", "0 is used")]);
    assert_eq!((scene.warnings[0].kind.code(), scene.warnings[0].more), ("out-of-range", 2));
}

/// A face with a colour of its own has copies of its vertices, and a concave one is divided.
#[test]
fn attributes_follow_the_vertices_of_faces() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float flow_x\n\
        property float flow_y\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n\
        0 0 0 1 2\n4 0 0 3 4\n1 1 0 5 6\n0 4 0 7 8\n4 0 1 2 3 255\n3 3 1 0 0\n";
    let scene = loaded("m.ply", text.as_bytes(), &[request("flow", 2, false)]).unwrap();
    let object = &scene.objects[0];
    assert_eq!((object.positions.len(), object.triangles.len()), (4 + 4 + 3, 3));
    for (vertex, [x, y, _]) in object.positions.iter().enumerate() {
        let flow = [0, 1].map(|component| f32::from_bits(object.attributes[0][2 * vertex + component]));
        let expected = match (*x as u32, *y as u32) {
            (0, 0) => [1.0, 2.0],
            (4, 0) => [3.0, 4.0],
            (1, 1) => [5.0, 6.0],
            _ => [7.0, 8.0],
        };
        assert_eq!(flow, expected, "{vertex}");
    }
}

/// Returns a glTF with a triangle, its attributes and their accessors from view 1 of `bytes`.
fn gltf(attributes: &str, accessors: &str, bytes: &[u8]) -> Vec<u8> {
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let text = base64::engine::general_purpose::STANDARD.encode([&positions, bytes].concat());
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "extras": {{"note": [1]}}, "scenes": [{{"nodes": [0, 1]}}],
        "nodes": [{{"mesh": 0}}, {{"mesh": 0, "scale": [2, 2, 2], "extras": []}}], "meshes": [{{"primitives": [
        {{"attributes": {{"POSITION": 0{attributes}}}, "targets": [{{"POSITION": 0}}]}}], "weights": [0.5], "extras": 3}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}}
        {accessors}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": {}}}],
        "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{text}"}}]}}"#,
        bytes.len(),
        36 + bytes.len()
    )
    .into_bytes()
}

fn accessor(component: u32, kind: &str, rest: &str) -> String {
    format!(r#", {{"bufferView": 1, "componentType": {component}, "count": 3, "type": "{kind}"{rest}}}"#)
}

#[test]
fn attributes_of_applications_are_read_from_a_gltf() {
    let heat = [0.25_f32, 0.5, f32::INFINITY].map(f32::to_le_bytes).concat();
    let model = gltf(r#", "_HEAT": 1"#, &accessor(5126, "SCALAR", ""), &heat);
    let (values, warnings) = floats("m.gltf", &model, request("heat", 1, false));
    assert_eq!(values, [0.25, 0.5, 0.0]);
    assert_eq!(
        warnings,
        ["[invalid-attribute] :2: a value of `heat`, inf, has no finite `f32`: 0 is used (and 1 more)"]
    );
    let bytes = [0, 51, 255];
    let model = gltf(r#", "_Heat": 1"#, &accessor(5121, "SCALAR", r#", "normalized": true"#), &bytes);
    assert_eq!(floats("m.gltf", &model, request("heat", 1, false)).0, [0.0, 0.2, 1.0]);
    let model = gltf(r#", "_HEAT": 1"#, &accessor(5121, "SCALAR", ""), &bytes);
    assert_eq!(floats("m.gltf", &model, request("heat", 1, false)).0, [0.0, 51.0, 255.0]);
    // Integers are exact.
    let labels = [1_u32, 16_777_217, u32::MAX].map(u32::to_le_bytes).concat();
    let model = gltf(r#", "_LABEL": 1"#, &accessor(5125, "SCALAR", ""), &labels);
    let scene = loaded("m.gltf", &model, &[request("label", 1, true)]).unwrap();
    assert_eq!((&scene.objects[0].attributes[..], scene.warnings.len()), (&[vec![1, 16_777_217, u32::MAX]][..], 0));
    // Both nodes draw the mesh.
    assert_eq!(scene.objects[1].attributes, scene.objects[0].attributes);
    // The morph target moved the vertices, which does not change the attribute.
    assert_eq!(scene.objects[0].positions[1], [1.5, 0.0, 0.0]);
}

#[test]
fn sets_of_colours_and_texture_coordinates_are_attributes() {
    let colors: Vec<u8> = (0..9).map(|value| 51 * (value % 6)).collect();
    let vec3 = accessor(5121, "VEC3", r#", "normalized": true"#);
    let model = gltf(r#", "COLOR_1": 1"#, &vec3, &colors);
    let three = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 0.0, 0.2, 0.4];
    assert_eq!(floats("m.gltf", &model, request("color_1", 3, false)).0, three);
    // A colour without alpha is opaque.
    let four = [0.0, 0.2, 0.4, 1.0, 0.6, 0.8, 1.0, 1.0, 0.0, 0.2, 0.4, 1.0];
    assert_eq!(floats("m.gltf", &model, request("color_1", 4, false)).0, four);
    let coordinates = [0.0_f32, 0.5, 1.0, 0.5, 0.25, 2.0].map(f32::to_le_bytes).concat();
    let model = gltf(r#", "TEXCOORD_0": 1, "bad name": 1"#, &accessor(5126, "VEC2", ""), &coordinates);
    assert_eq!(floats("m.gltf", &model, request("texcoord_0", 2, false)).0, [0.0, 0.5, 1.0, 0.5, 0.25, 2.0]);
    // The number of components must be that of the file.
    assert_eq!(available("m.gltf", &model, request("texcoord_0", 3, false)), [("texcoord_0".to_owned(), 2)]);
}

#[test]
fn a_primitive_without_the_attribute_has_zeros() {
    let heat = [0.25_f32, 0.5, 0.75].map(f32::to_le_bytes).concat();
    let model = String::from_utf8(gltf(r#", "_HEAT": 1"#, &accessor(5126, "SCALAR", ""), &heat)).unwrap();
    let model = model.replace(r#""primitives": ["#, r#""primitives": [{"attributes": {"POSITION": 0}}, "#);
    let (values, warnings) = floats("m.gltf", model.as_bytes(), request("heat", 1, false));
    assert_eq!(values, [0.0, 0.0, 0.0, 0.25, 0.5, 0.75]);
    assert_eq!(warnings, ["[missing-attribute] :2: primitive 0 of mesh 0 has no `heat`: 0 is used (and 1 more)"]);
    // An accessor of another length is an error.
    let short = model.replace(
        r#""componentType": 5126, "count": 3, "type": "SCALAR""#,
        r#""componentType": 5126, "count": 2, "type": "SCALAR""#,
    );
    let error = loaded("m.gltf", short.as_bytes(), &[request("heat", 1, false)]).unwrap_err().to_string();
    assert!(error.ends_with("primitive 1: 2 of _HEAT, and 3 of POSITION"), "{error}");
}

#[test]
fn scenes_without_attributes_say_so() {
    let heat = request("heat", 1, false);
    assert_eq!(available("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", heat.clone()), []);
    let builtin = open_with("builtin:cubes", [1.0; 4], std::slice::from_ref(&heat), &Limits::default());
    let Err(Error::MissingAttribute { scene, available, .. }) = builtin else { panic!("{builtin:?}") };
    assert_eq!((scene.as_str(), available), ("builtin:cubes", vec![]));
    // A name and a list of properties of any length are no problem.
    let long = "p".repeat(100_000);
    let many: String = (0..2000).map(|number| format!("property list uchar uchar p{number}_x\n")).collect();
    let model = ply(&format!("property float {long}\n{many}"), ["0"; 4]);
    let error = loaded("m.ply", &model, &[heat]).unwrap_err();
    let Error::MissingAttribute { available, .. } = error else { panic!("{error}") };
    assert_eq!((available.len(), available[0].name.len()), (2, 60));
}

#[test]
fn attributes_count() {
    let model = ply("property float heat_x\nproperty float heat_y\n", ["0 0"; 4]);
    let load = |requests: &[AttributeRequest], memory| loaded_within("m.ply", &model, requests, memory);
    let one = request("heat", 2, false);
    let needed = |requests: &[AttributeRequest]| (1..10_000).find(|memory| load(requests, *memory).is_ok()).unwrap();
    // Eight bytes for each of four vertices.
    assert_eq!(needed(std::slice::from_ref(&one)), needed(&[]) + 4 * 8);
    let (plain, with) = (load(&[], 10_000).unwrap(), load(&[one], 10_000).unwrap());
    assert_eq!(with.bytes(), plain.bytes() + 4 * 8);
}
