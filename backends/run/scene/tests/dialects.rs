//! The same models as different programs write them: other numbers, white space, orders, types and extensions of each format.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::PathBuf;

use fragbuf_scene::{Limits, Scene, load};
use serde_json::{Value, json};
use tempfile::TempDir;

const COLOR: [f32; 4] = [0.5, 0.5, 0.5, 0.25];
const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const HALF_RED: [f32; 4] = [1.0, 0.0, 0.0, 0.5];

const CORNERS: [[f32; 3]; 4] = [[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [1.0, 1.0, 0.5], [-1.0, 1.0, 0.5]];

fn read(files: &[(&str, &[u8])]) -> Result<Scene, String> {
    let folder = TempDir::new().unwrap();
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    for (path, (_, bytes)) in paths.iter().zip(files) {
        std::fs::write(path, bytes).unwrap();
    }
    let prefix = format!("{}/", folder.path().display());
    let mut scene =
        load(&paths[0], COLOR, &Limits::default()).map_err(|error| error.to_string().replace(&prefix, ""))?;
    scene.files.clear();
    Ok(scene)
}

fn warnings(scene: &Scene) -> Vec<String> {
    scene.warnings.iter().map(|warning| warning.to_string().rsplit_once('/').unwrap().1.to_owned()).collect()
}

/// Reads a model without warnings, which is the quad of [`CORNERS`] in one colour.
fn quad(files: &[(&str, &[u8])], color: [f32; 4]) {
    let text = String::from_utf8_lossy(files[0].1);
    let scene = read(files).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(warnings(&scene), [""; 0], "{text}");
    assert_quad(&scene, color, &text);
}

fn assert_quad(scene: &Scene, color: [f32; 4], text: &str) {
    let object = &scene.objects[0];
    let corners = object.triangles.iter().map(|triangle| triangle.map(|index| object.positions[index as usize]));
    let [a, b, c, d] = CORNERS;
    assert_eq!(corners.collect::<Vec<_>>(), [[a, b, c], [a, c, d]], "{text}");
    assert!(object.colors.iter().all(|found| *found == color), "{text}: {:?}", object.colors[0]);
}

const POSITIONS: &str = "v -1 -1 0.5\nv 1 -1 0.5\nv 1 1 0.5\nv -1 1 0.5\n";

#[test]
fn numbers_of_an_obj_have_many_forms() {
    for text in [
        "v -1. -1.0e0 .5\nv +1 -1E+00 5e-1\nv 1.000000000000000000001 01 0.5\nv -1 1 .5e0\nf 1 2 3 4\n",
        "  v\t-1 \t-1  0.5  \nv 1 -1 0.5\t# right\n\tv 1 1 0.5\nv -1 1 0.5\n f\t1  2 3 4 \n",
        "v -1 -1 0.5\r\nv 1 -1 0.5\r\nv 1 1 0.5\r\nv -1 1 0.5\r\nf 1 2 \\\r\n3 4\r\n",
        "v -1 -1 0.5\rv 1 -1 0.5\rv 1 1 0.5\rv -1 1 0.5\rf +1 +2 +3 +4\r",
        // A fourth coordinate is a weight.
        "v -1 -1 0.5 1\nv 1 -1 0.5 1\nv 1 1 0.5 1\nv -1 1 0.5 1\nf 1 2 3 4",
    ] {
        quad(&[("m.obj", text.as_bytes())], COLOR);
    }
    for index in ["99999999999999999999", "-9223372036854775808", "9223372036854775807", "-99999999999999999999"] {
        let error = read(&[("m.obj", format!("{POSITIONS}f 1 2 {index}\n").as_bytes())]).unwrap_err();
        assert!(error.starts_with("m.obj:5: ") && error.contains(index), "{error}");
    }
}

#[test]
fn colours_of_an_obj_may_be_bytes() {
    let colored = |color: &str| POSITIONS.replace("0.5\n", &format!("0.5 {color}\n")) + "f 1 2 3 4\n";
    quad(&[("m.obj", colored("1 0 0").as_bytes())], RED);
    quad(&[("m.obj", colored("1 0 0 0.5").as_bytes())], HALF_RED);
    let scene = read(&[("m.obj", colored("255 0 0").as_bytes())]).unwrap();
    assert_quad(&scene, RED, "bytes");
    assert_eq!(warnings(&scene), ["m.obj:1: a colour of a vertex, 255, is not from 0 to 1: all are divided by 255"]);
}

#[test]
fn a_material_applies_until_the_next() {
    let library = "newmtl a\\b \\c\nKd 1 0 0\n".as_bytes();
    for uses in ["usemtl a\\b \\c\no first\ng second\ns 1\n", "g first\nusemtl a\\b \\c\ng second third\n"] {
        let text = format!("mtllib l.mtl\n{POSITIONS}{uses}f 1 2 3 4\n");
        quad(&[("m.obj", text.as_bytes()), ("l.mtl", library)], RED);
    }
}

#[test]
fn materials_of_other_programs_are_read() {
    let model = format!("mtllib l.mtl\n{POSITIONS}usemtl m\nf 1 2 3 4\n");
    let files = |library: &str| [("m.obj".to_owned(), model.clone()), ("l.mtl".to_owned(), library.to_owned())];
    let of = |library: &str| {
        let files = files(library);
        read(&files.each_ref().map(|(name, text)| (name.as_str(), text.as_bytes())))
    };
    for (library, color) in [
        (
            "\n\tnewmtl m  \n\tNs 96.07\n\tNi 1.5\n\tKa 0 0 0\n\t Kd\t1 0 0\n\tKs 0.5 0.5 0.5\n\tKe 0 0 0\n\tTf 1 1 1\n\tillum 2\n",
            RED,
        ),
        ("# Exported\r\nnewmtl m\r\nKd 1.000 0.000 0.000\r\nd 0.5\r\nillum 1\r\n", HALF_RED),
        ("newmtl m\nd 0.5\nKd 1 0 0\nnewmtl other\nKd 0 1 0\nd 1\n", HALF_RED),
        ("newmtl m\nKd 1.0000001 -0 0\nTr 0.5\nPr 0.3\nPm 0\n", HALF_RED),
    ] {
        let scene = of(library).unwrap();
        assert_eq!(warnings(&scene), [""; 0], "{library}");
        assert_quad(&scene, color, library);
    }
    for (library, color, warning) in [
        (
            "newmtl m\nKd 1 0 0\nTr 0.5 0.5 0.5\n",
            HALF_RED,
            "l.mtl:3: `Tr` has 3 values, and takes 1: the first is used",
        ),
        ("newmtl m\nKd 1 0 0\nd 1.5\n", RED, "l.mtl:3: 1.5 is not from 0 to 1: 1 is used"),
    ] {
        let scene = of(library).unwrap();
        assert_quad(&scene, color, library);
        assert_eq!(warnings(&scene), [warning]);
    }
}

/// Returns a PLY of the quad: its properties in an odd order and in odd types, other elements between, and a list on each vertex.
fn odd_ply(order: fn(&mut [u8])) -> Vec<u8> {
    let mut body: Vec<u8> = Vec::new();
    let mut put = |mut bytes: Vec<u8>| {
        order(&mut bytes);
        body.extend(bytes);
    };
    put(7_i16.to_le_bytes().to_vec());
    for [x, y, z] in CORNERS {
        put(32_768_u16.to_le_bytes().to_vec());
        put(f64::from(z).to_le_bytes().to_vec());
        put(vec![2]);
        [1.0_f32, 2.0].iter().for_each(|value| put(value.to_le_bytes().to_vec()));
        [65_535_u16, 0, 0].iter().for_each(|channel| put(channel.to_le_bytes().to_vec()));
        put(f64::from(y).to_le_bytes().to_vec());
        put(f64::from(x).to_le_bytes().to_vec());
    }
    put(9_u32.to_le_bytes().to_vec());
    put(4_u32.to_le_bytes().to_vec());
    [0_i8, 1, 2, 3].iter().for_each(|index| put(index.to_le_bytes().to_vec()));
    put(5_u16.to_le_bytes().to_vec());
    put(3.0_f32.to_le_bytes().to_vec());
    body
}

#[test]
fn properties_of_a_ply_have_any_order_and_type() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement before 1\nproperty int16 a\nelement vertex 4\nproperty ushort alpha\nproperty float64 z\n\
             property list uint8 float32 weights\nproperty uint16 red\nproperty ushort green\nproperty ushort blue\nproperty double y\n\
             property double x\nelement between 1\nproperty uint32 b\nelement face 1\nproperty list uint int8 vertex_index\n\
             property uint16 flags\nelement after 1\nproperty float c\nend_header\n"
        )
    };
    for (format, order) in
        [("binary_little_endian", (|_: &mut [u8]| {}) as fn(&mut [u8])), ("binary_big_endian", <[u8]>::reverse)]
    {
        let bytes = [header(format).as_bytes(), &odd_ply(order)].concat();
        let scene = read(&[("m.ply", &bytes)]).unwrap();
        let alpha = 32_768.0 / 65_535.0;
        assert_eq!(warnings(&scene), [""; 0]);
        assert_quad(&scene, [1.0, 0.0, 0.0, alpha], format);
    }
    let text = format!(
        "{}7\n32768 0.5 2 1 2 65535 0 0 -1 -1\n32768 0.5 0 65535 0 0 -1 1\n32768 0.5 1 9 65535 0 0 1 1\n32768 0.5 0 65535 0 0 1 -1\n9\n\
         4 0 1 2 3 5\n3\n",
        header("ascii")
    );
    let scene = read(&[("m.ply", text.as_bytes())]).unwrap();
    assert_quad(&scene, [1.0, 0.0, 0.0, 32_768.0 / 65_535.0], "ascii");
}

#[test]
fn headers_of_a_ply_have_comments_and_blank_lines() {
    let body = "-1 -1 0.5\n1 -1 0.5\n1 1 0.5\n-1 1 0.5\n4 0 1 2 3\n";
    for header in [
        "ply\nformat ascii 1.0\ncomment\nobj_info a b\nelement vertex 4\n\ncomment element vertex 9\nproperty float x\nproperty float y\n\
         property float z\n\n\nelement face 1\ncomment property\nproperty list uchar int vertex_indices\ncomment\nend_header\n",
        "ply \nformat  ascii  1.0 \nelement vertex\t4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header \n",
    ] {
        quad(&[("m.ply", format!("{header}{body}").as_bytes())], COLOR);
    }
}

#[test]
fn float_colours_of_a_ply_are_clamped_or_rejected() {
    let ply = |color: &str| {
        let vertices: String = CORNERS.map(|[x, y, z]| format!("{x} {y} {z} {color}\n")).concat();
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float red\n\
             property float green\nproperty float blue\nproperty float alpha\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n{vertices}4 0 1 2 3\n"
        )
    };
    quad(&[("m.ply", ply("1 0 0 0.5").as_bytes())], HALF_RED);
    let scene = read(&[("m.ply", ply("1 0 0 -0.5").as_bytes())]).unwrap();
    assert_quad(&scene, [1.0, 0.0, 0.0, 0.0], "negative");
    assert_eq!(warnings(&scene), ["m.ply:14: a colour of a vertex, -0.5, is not from 0 to 1: it is clamped"]);
    for value in ["nan", "inf"] {
        let error = read(&[("m.ply", ply(&format!("{value} 0 0 1")).as_bytes())]).unwrap_err();
        assert!(error.starts_with("m.ply:14: ") && error.contains("not finite"), "{error}");
    }
}

/// Returns a glTF of the quad, half red and blended, with a change of its JSON.
fn gltf(change: impl FnOnce(&mut Value)) -> String {
    let floats = CORNERS.iter().flatten().flat_map(|axis| axis.to_le_bytes());
    let bytes: Vec<u8> = floats.chain([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes())).collect();
    let mut model = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5]}, "alphaMode": "BLEND"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0.5], "max": [1, 1, 0.5]},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60, "uri": uri(&bytes)}],
    });
    change(&mut model);
    model.to_string()
}

fn uri(bytes: &[u8]) -> String {
    let bytes: String = bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
    format!("data:application/octet-stream,{bytes}")
}

/// Replaces the bytes of the only buffer.
fn set_buffer(model: &mut Value, bytes: &[u8]) {
    model["buffers"][0] = json!({"byteLength": bytes.len(), "uri": uri(bytes)});
}

#[test]
fn a_gltf_may_begin_with_a_byte_order_mark() {
    quad(&[("m.gltf", gltf(|_| {}).as_bytes())], HALF_RED);
    quad(&[("m.gltf", format!("\u{feff}{}", gltf(|_| {})).as_bytes())], HALF_RED);
}

/// The numbers of the quad as other types, with a node that scales them back.
#[test]
fn positions_of_a_gltf_may_be_integers() {
    for extension in [json!({}), json!({"used": true}), json!({"used": true, "required": true})] {
        let text = gltf(|model| {
            let corners = CORNERS.map(|corner| corner.map(|axis| (2.0 * axis + 2.0) as u16));
            let shorts = corners.iter().flat_map(|[x, y, z]| [*x, *y, *z, 0]).flat_map(u16::to_le_bytes);
            let bytes: Vec<u8> =
                shorts.chain([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes())).collect();
            set_buffer(model, &bytes);
            model["bufferViews"][0] = json!({"buffer": 0, "byteLength": 32, "byteStride": 8});
            model["bufferViews"][1] = json!({"buffer": 0, "byteOffset": 32, "byteLength": 12});
            model["accessors"][0] = json!({"bufferView": 0, "componentType": 5123, "count": 4, "type": "VEC3"});
            model["nodes"][0] = json!({"mesh": 0, "scale": [0.5, 0.5, 0.5], "translation": [-1, -1, -1]});
            if extension["used"] == true {
                model["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
            }
            if extension["required"] == true {
                model["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            }
        });
        quad(&[("m.gltf", text.as_bytes())], HALF_RED);
    }
}

#[test]
fn attributes_of_a_gltf_may_be_interleaved() {
    let text = gltf(|model| {
        let mut bytes: Vec<u8> = Vec::new();
        for corner in CORNERS {
            bytes.extend(corner.iter().chain(&[0.0, 0.0, 1.0]).flat_map(|axis| axis.to_le_bytes()));
            bytes.extend([255, 0, 0, 255]);
        }
        bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
        set_buffer(model, &bytes);
        model["bufferViews"] = json!([
            {"buffer": 0, "byteLength": 112, "byteStride": 28}, {"buffer": 0, "byteOffset": 112, "byteLength": 12}]);
        let accessors = model["accessors"].as_array_mut().unwrap();
        let with = |component: u32, shape: &str, offset: u32, normalized: bool| json!({"bufferView": 0, "byteOffset": offset, "componentType": component, "count": 4, "type": shape, "normalized": normalized});
        accessors.extend([with(5126, "VEC3", 12, false), with(5121, "VEC4", 24, true)]);
        model["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0, "NORMAL": 2, "COLOR_0": 3});
        model["materials"][0]["pbrMetallicRoughness"] = json!({});
    });
    quad(&[("m.gltf", text.as_bytes())], RED);
}

/// The format multiplies the colour of a vertex by that of its material, which is white if there is none.
#[test]
fn vertex_colours_with_alpha_need_no_material() {
    let colored = |has_material: bool| {
        gltf(|model| {
            let floats =
                CORNERS.iter().flat_map(|corner| corner.iter().chain(&HALF_RED)).flat_map(|axis| axis.to_le_bytes());
            let bytes: Vec<u8> =
                floats.chain([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes())).collect();
            set_buffer(model, &bytes);
            model["bufferViews"] = json!([
                {"buffer": 0, "byteLength": 112, "byteStride": 28}, {"buffer": 0, "byteOffset": 112, "byteLength": 12}]);
            let color = json!({"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 4, "type": "VEC4"});
            model["accessors"].as_array_mut().unwrap().push(color);
            model["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(2);
            match has_material {
                true => model["materials"][0]["pbrMetallicRoughness"] = json!({}),
                false => drop(model["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material")),
            }
        })
    };
    quad(&[("m.gltf", colored(false).as_bytes())], HALF_RED);
    quad(&[("m.gltf", colored(true).as_bytes())], HALF_RED);
    // The material is opaque.
    quad(&[("m.gltf", colored(true).replace("\"BLEND\"", "\"OPAQUE\"").as_bytes())], RED);
}

#[test]
fn unused_attributes_of_a_gltf_may_have_no_view() {
    let text = gltf(|model| {
        let empty = json!({"componentType": 5126, "count": 4, "type": "VEC4"});
        model["accessors"].as_array_mut().unwrap().push(empty);
        model["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(2);
        model["meshes"][0]["primitives"][0]["attributes"]["_HEAT"] = json!(2);
    });
    quad(&[("m.gltf", text.as_bytes())], HALF_RED);
}

#[test]
fn a_mirrored_node_keeps_its_triangles() {
    let scene =
        read(&[("m.gltf", gltf(|model| model["nodes"][0]["scale"] = json!([-0.5, 0.5, 1])).as_bytes())]).unwrap();
    let object = &scene.objects[0];
    let mirrored = CORNERS.map(|[x, y, z]| [-0.5 * x, 0.5 * y, z]);
    assert_eq!(object.positions, mirrored);
    // Corners of a mirrored node are clockwise, so they are turned.
    assert_eq!(object.triangles, [[0, 2, 1], [0, 3, 2]]);
    let by_matrix =
        gltf(|model| model["nodes"][0]["matrix"] = json!([-0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
    assert_eq!(read(&[("m.gltf", by_matrix.as_bytes())]).unwrap().objects[0].positions, mirrored);
}

#[test]
fn required_extensions_of_geometry_are_errors() {
    let required = |name: &str| {
        gltf(|model| (model["extensionsUsed"], model["extensionsRequired"]) = (json!([name]), json!([name])))
    };
    for name in [
        "KHR_lights_punctual",
        "KHR_texture_transform",
        "KHR_texture_basisu",
        "EXT_texture_webp",
        "KHR_materials_unlit",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_ior",
        "KHR_materials_clearcoat",
    ] {
        quad(&[("m.gltf", required(name).as_bytes())], HALF_RED);
    }
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing", "XYZ_own"] {
        let error = read(&[("m.gltf", required(name).as_bytes())]).unwrap_err();
        assert!(error.starts_with("m.gltf:1: ") && error.contains(&format!("`{name}` is not supported")), "{error}");
    }
}

#[test]
fn positions_of_a_gltf_are_finite() {
    for value in [f32::NAN, f32::INFINITY] {
        let text = gltf(|model| {
            let mut bytes: Vec<u8> = CORNERS.iter().flatten().flat_map(|axis| axis.to_le_bytes()).collect();
            bytes[16..20].copy_from_slice(&value.to_le_bytes());
            bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
            set_buffer(model, &bytes);
        });
        let error = read(&[("m.gltf", text.as_bytes())]).unwrap_err();
        assert_eq!(error, "m.gltf:1: primitive 0: position 1 is not finite");
    }
}

#[test]
fn version_1_of_gltf_is_an_error() {
    let error = read(&[("m.gltf", gltf(|model| model["asset"]["version"] = json!("1.0")).as_bytes())]).unwrap_err();
    assert_eq!(error, "m.gltf:1: glTF version `1.0`: version 2 is read");
    let words = [1_u32, 20, 0].map(u32::to_le_bytes).concat();
    let error = read(&[("m.glb", &[b"glTF".as_slice(), &words, b"\0\0\0\0"].concat())]).unwrap_err();
    assert_eq!(error, "m.glb: at byte 4: GLB version 1: version 2 is read");
}

/// The types of the error are those of the format.
#[test]
fn types_of_accessors_have_the_names_of_the_format() {
    let text = gltf(|model| model["accessors"][1]["componentType"] = json!(5122));
    let error = read(&[("m.gltf", text.as_bytes())]).unwrap_err();
    let expected = "its type is SCALAR of SHORT (5122); its use allows SCALAR of UNSIGNED_BYTE (5121), UNSIGNED_SHORT (5123) or UNSIGNED_INT (5125)";
    assert_eq!(error, format!("m.gltf:1: accessor 1: {expected}"));
}
