//! Tests the messages about files: models that are empty, of another kind or missing, shaders that are not valid, descriptions that
//! are other files, and what a model has that is not read.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn fragbuf(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fragbuf")).args(arguments).current_dir(folder).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("inputs").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Renders a scene with the CPU device; returns the exit code and stderr.
fn render(description: &str, scene: &str, more: &[&str], folder: &Path) -> (Option<i32>, String) {
    let arguments = ["render", description, "--scene", scene, "--size", "8x8", "--device", "cpu", "--out", "x.png"];
    let output = fragbuf(&[&arguments, more].concat(), folder);
    (output.status.code(), stderr(&output))
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
    property float v\nproperty int id\nproperty float velx\nproperty float vely\nproperty float velz\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n-1 -1 0 0.25 0.5 7 1 2 3\n1 -1 0 0.25 0.5 7 1 2 3\n0 1 0 0.25 0.5 7 1 2 3\n3 0 1 2\n";

#[test]
fn what_is_no_model_is_named() {
    let folder = folder("foreign");
    let contents: [(&str, &[u8], &str); 8] = [
        ("empty", b"", "the file is empty"),
        ("space", b"\xef\xbb\xbf \n\t\n", "the file is empty"),
        ("png", b"\x89PNG\r\n\x1a\n0000", "the file is a PNG image"),
        ("page", b"<!DOCTYPE html>\n<html></html>", "a page in HTML"),
        ("wide", b"\xff\xfev\0 \0", "text in UTF-16: save it as UTF-8"),
        ("zip", b"PK\x03\x04rest", "a ZIP archive"),
        ("lfs", b"version https://git-lfs.github.com/spec/v1\n", "run `git lfs pull`"),
        ("stl", b"solid cube\n", "an STL model"),
    ];
    for (name, bytes, expected) in contents {
        for extension in ["obj", "ply", "gltf", "glb"] {
            let file = format!("{name}.{extension}");
            std::fs::write(folder.join(&file), bytes).unwrap();
            let (code, text) = render("kb", &file, &[], &folder);
            assert!(code == Some(1) && text.contains(&file) && text.contains(expected), "{file}: {text}");
        }
    }
    for (file, bytes, expected) in [
        ("a.obj", PLY, "the file is a PLY, and its extension is .obj: rename it to .ply"),
        ("a.ply", "{\"asset\":{\"version\":\"2.0\"}}", "rename it to .gltf"),
        ("b.gltf", "{\"asset\":", "b.gltf:1: column 9: invalid JSON: EOF while parsing a value"),
        ("c.gltf", "{\"asset\":{}}", "c.gltf:1: column 11: not a model of glTF 2: missing field `version`"),
    ] {
        std::fs::write(folder.join(file), bytes).unwrap();
        let (code, text) = render("kb", file, &[], &folder);
        assert!(code == Some(1) && text.contains(expected), "{file}: {text}");
    }
    std::fs::write(folder.join("marked.ply"), format!("\u{feff}{PLY}")).unwrap();
    let (code, text) = render("kb", "marked.ply", &[], &folder);
    assert_eq!(code, Some(0), "{text}");
}

/// What cannot be opened has the exit code 3, whatever its name; a file of an unknown kind has 1.
#[test]
fn a_missing_file_is_the_same_error_for_every_extension() {
    let folder = folder("missing");
    std::fs::write(folder.join("model.xyz"), "v 0 0 0").unwrap();
    std::fs::write(folder.join("glass.fragbuf"), "buffer Glass from kb { }").unwrap();
    for (scene, expected) in
        [("no.obj", 3), ("no.xyz", 3), ("no", 3), ("no/such.ply", 3), (".", 3), ("model.xyz", 1), ("glass.fragbuf", 1)]
    {
        let (code, text) = render("kb", scene, &[], &folder);
        assert_eq!(code, Some(expected), "{scene}: {text}");
    }
    for (description, code, expected) in [
        ("glas.fragbuf", 3, "does not exist: did you mean `glass.fragbuf`?"),
        ("./glass", 3, "did you mean `./glass.fragbuf`?"),
        ("glass", 2, "no technique `glass`: for the file, write `glass.fragbuf`"),
        ("glass.txt", 3, "does not exist"),
        ("kplus_array.fragbuf", 3, "give the key of the technique alone, `kplus_array`"),
        (".", 3, "is a folder"),
        ("kplus_aray", 1, "did you mean `kplus_array`?"),
        ("list.wgsl", 2, "`fragbuf check --wgsl list.wgsl --entry main`"),
        ("model.obj", 2, "give a model to `--scene model.obj`"),
    ] {
        let output = fragbuf(&["check", description], &folder);
        let text = stderr(&output);
        assert!(output.status.code() == Some(code) && text.contains(expected), "{description}: {text}");
    }
    let (code, text) = render("kb", "builtin:cubes", &["--strict"], &folder);
    assert_eq!(code, Some(0), "{text}");
    let missing = fragbuf(
        &["render", "kb", "--scene", "builtin:cubes", "--size", "8x8", "--device", "auto", "--out", "no/x.png"],
        &folder,
    );
    let text = stderr(&missing);
    assert!(missing.status.code() == Some(3) && text.contains("its folder no does not exist"), "{text}");
    assert!(!text.contains("rendering on"), "nothing is rendered: {text}");
}

/// The rejection of WGSL has a code, file, line and column, words about the source, and a fix.
#[test]
fn an_invalid_shader_is_explained() {
    let folder = folder("shaders");
    let with = |body: &str| {
        format!(
            "@group(0) @binding(0) var<storage, read_write> a: array<u32>;\n@group(0) @binding(1) var<storage, read> b: array<u32>;\n\
             override SIZE: u32;\n@compute @workgroup_size(1) fn main() {{\n    {body}\n}}\n"
        )
    };
    for (body, column, message, help) in [
        ("a[0] = coutn(1u);", 12, "cannot find `coutn`", "declare it, or correct its name"),
        ("let count = 1u; a[0] = coutn;", 28, "cannot find `coutn`", "did you mean `count`?"),
        ("a[0] = 1.5;", 5, "cannot convert", "`1u`, `1i` or `1.0`"),
        ("b[0] = 1u;", 5, "the place cannot be assigned", "var<storage, read_write>"),
        ("atomicAdd(&a[0], 1u);", 15, "no pointer to an atomic word", "`atomic<u32>`"),
        ("a[0] = 1u", 13, "expected `;`", "end the statement with `;`"),
        ("a[0] = (1u;", 15, "expected", "the statement before it"),
    ] {
        std::fs::write(folder.join("a.wgsl"), with(body)).unwrap();
        let output = fragbuf(&["check", "--wgsl", "a.wgsl", "--entry", "main", "--override", "SIZE=1"], &folder);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        for expected in ["error[invalid-wgsl]", &format!("a.wgsl:5:{column}"), message, "help: "] {
            assert!(text.contains(expected), "{body}: {expected}: {text}");
        }
        assert!(text.contains(help) && !text.contains("naga") && !text.contains(" is invalid: "), "{body}: {text}");
    }
    std::fs::write(folder.join("a.wgsl"), with("a[0] = SIZE;")).unwrap();
    let unknown = fragbuf(&["check", "--wgsl", "a.wgsl", "--entry", "main", "--override", "SIEZ=1"], &folder);
    assert!(stderr(&unknown).contains("did you mean `SIZE`? it has SIZE"), "{}", stderr(&unknown));
}

/// Properties of a PLY by their usual names, and one that has the name of the scene's data.
#[test]
fn properties_of_a_ply_are_attributes() {
    let folder = folder("ply");
    std::fs::write(folder.join("a.ply"), PLY).unwrap();
    let first_pixel = |attribute: &str, value: &str, scene: &str| {
        let text = format!(
            "buffer B from kb {{\n    fragment {{ color: rgba8, depth: f32, {attribute} }}\n    where |f| f.color.x < 9.0;\n    resolve |fragments, u| {{\n        \
             let mut sum = vec4(0.0, 0.0, 0.0, 1.0);\n        for f in fragments {{ sum = ({value} * 0.1).extend(1.0); }}\n        \
             sum\n    }}\n}}"
        );
        std::fs::write(folder.join("b.fragbuf"), text).unwrap();
        let arguments = ["--linear", "--camera", "clip", "--background", "0,0,0,1"];
        let (code, text) = render("b.fragbuf", scene, &arguments, &folder);
        assert_eq!((code, text.as_str()), (Some(0), ""), "{attribute}");
        let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(folder.join("x.png")).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        // The centre of the image, which the triangle covers.
        let at = 4 * (4 * 8 + 4);
        [pixels[at], pixels[at + 1], pixels[at + 2]]
    };
    let scaled = |value: [f32; 3]| value.map(|channel| (channel * 25.5).round() as u8);
    assert_eq!(first_pixel("uv: vec2", "f.uv.extend(0.0)", "a.ply"), scaled([0.25, 0.5, 0.0]));
    assert_eq!(first_pixel("vel: vec3", "f.vel", "a.ply"), scaled([1.0, 2.0, 3.0]));
    assert_eq!(first_pixel("id: u32", "vec3(f.id as f32, 0.0, 0.0)", "a.ply"), scaled([7.0, 0.0, 0.0]));
    // A model without the property has the number of the object.
    std::fs::write(folder.join("b.ply"), PLY.replace("property int id", "property int number")).unwrap();
    assert_eq!(first_pixel("id: u32", "vec3(f.id as f32 + 2.0, 0.0, 0.0)", "b.ply"), scaled([2.0, 0.0, 0.0]));
    let position = first_pixel("position: vec3", "(f.position + vec3(2.0, 2.0, 1.0))", "a.ply");
    assert!(position[2] == 26 && (45..=60).contains(&position[0]), "{position:?}");
    // The list of what the model has names them.
    std::fs::write(
        folder.join("b.fragbuf"),
        "buffer B from kb {\n    fragment { color: rgba8, depth: f32, heat: f32 }\n    where |f| f.heat > 0.0;\n}",
    )
    .unwrap();
    let (code, text) = render("b.fragbuf", "a.ply", &[], &folder);
    assert_eq!(code, Some(1));
    for name in ["vel (vec3)", "uv (vec2)", "position (vec3)", "id (f32 or u32)"] {
        assert!(text.contains(name), "{name}: {text}");
    }
}

/// A rejected model uses nothing in place of a part.
#[test]
fn a_rejected_model_has_no_replacements() {
    let folder = folder("strict");
    std::fs::write(folder.join("a.ply"), PLY.replace("7 1 2 3\n3 0", "7 1 nan 3\n3 0")).unwrap();
    let text =
        "buffer B from kb {\n    fragment { color: rgba8, depth: f32, vely: f32 }\n    where |f| f.vely > -1.0;\n}";
    std::fs::write(folder.join("b.fragbuf"), text).unwrap();
    let (code, text) = render("b.fragbuf", "a.ply", &[], &folder);
    assert!(code == Some(0) && text.contains("has no finite `f32`: 0 is used"), "{text}");
    let (code, text) = render("b.fragbuf", "a.ply", &["--strict"], &folder);
    assert!(code == Some(1) && text.contains("error[invalid-attribute]") && !text.contains("is used"), "{text}");
    assert!(text.contains("`--strict` rejects the model"), "{text}");
}

/// What an image lacks because a model has it and it is not read is said once per file, in every format.
#[test]
fn what_is_not_read_is_said_once() {
    let folder = folder("not-read");
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let _ = cases;
    std::fs::write(folder.join("a.mtl"), "newmtl m\nKd 1 0 0\nmap_Kd a.png\nmap_d b.png\nnewmtl n\nmap_Kd a.png\n")
        .unwrap();
    std::fs::write(folder.join("a.obj"), "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let (_, text) = render("kb", "a.obj", &[], &folder);
    assert_eq!(text.matches("textures are not read: `map_Kd`").count(), 1, "{text}");
    assert_eq!(text.matches("textures are not read: `map_d`").count(), 1, "{text}");
    let gltf = |extensions: &str, material: &str| {
        format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},{extensions}\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"mesh\":0}}],\
             \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}{material}}}]}}],\
             \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}}],\
             \"bufferViews\":[{{\"buffer\":0,\"byteLength\":36}}],\"buffers\":[{{\"byteLength\":36,\"uri\":\
             \"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}}]}}"
        )
    };
    let instancing = gltf("\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],", "");
    let texture = gltf(
        "\"images\":[{\"uri\":\"a.png\"}],\"textures\":[{\"source\":0}],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":\
         {\"index\":0}}},{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],",
        ",\"material\":0",
    );
    for (model, expected) in [
        (instancing, "`EXT_mesh_gpu_instancing` is not read: each node is drawn once"),
        (texture, "textures are not read: the factor of its base colour is used without them (and 1 more)"),
    ] {
        std::fs::write(folder.join("a.gltf"), model).unwrap();
        let (code, text) = render("kb", "a.gltf", &[], &folder);
        assert_eq!(code, Some(0), "{text}");
        assert_eq!(text.matches(expected).count(), 1, "{text}");
    }
    let out_of_range = gltf("", "").replace("\"nodes\":[{\"mesh\":0}]", "\"nodes\":[{\"mesh\":4}]");
    std::fs::write(folder.join("a.gltf"), out_of_range).unwrap();
    let (code, text) = render("kb", "a.gltf", &[], &folder);
    assert!(code == Some(1) && text.contains("node 0: its mesh is number 4, and the file has 1"), "{text}");
    std::fs::write(folder.join("a.ply"), PLY.replace("property int id", "comment TextureFile a.png\nproperty int id"))
        .unwrap();
    let (_, text) = render("kb", "a.ply", &[], &folder);
    assert_eq!(text.matches("textures are not read").count(), 1, "{text}");
}

/// Elements and properties of a PLY that have no effect are named with their lines.
#[test]
fn names_of_a_ply_that_have_no_effect_are_named() {
    let folder = folder("ply-names");
    let heat = |attribute: &str| {
        format!(
            "buffer B from kb {{\n    fragment {{ color: rgba8, depth: f32, {attribute}: f32 }}\n    where |f| f.{attribute} > -9.0;\n}}"
        )
    };
    let say = |model: &str, description: &str| {
        std::fs::write(folder.join("a.ply"), model).unwrap();
        std::fs::write(folder.join("b.fragbuf"), description).unwrap();
        render("b.fragbuf", "a.ply", &[], &folder)
    };
    let plain = "buffer B from kb { }";
    for (from, to, expected) in [
        ("element face 1", "element faces 1", "a.ply:13: the element `faces` is not read: its name in PLY is `face`"),
        (
            "element vertex 3",
            "element vertices 3",
            "a.ply:3: the element `vertices` is not read: its name in PLY is `vertex`",
        ),
        ("element vertex 3", "element Vertex 3", "a.ply:3: the element `Vertex` is not read"),
    ] {
        let (code, text) = say(&PLY.replace(from, to), plain);
        assert!(code == Some(1) && text.contains(expected), "{text}");
    }
    // It is a warning if an element has the right name.
    let more = PLY.replace("end_header", "element faces 0\nproperty list uchar int vertex_indices\nend_header");
    let (code, text) = say(&more, plain);
    assert!(
        code == Some(0)
            && text.contains("warning[unknown-statement]")
            && text.contains("a.ply:15: the element `faces`"),
        "{text}"
    );
    let (code, text) = say(&PLY.replace("property float v\n", "property float u\n"), plain);
    assert!(
        code == Some(0) && text.contains("a.ply:8: the element `vertex` has the property `u` twice: the last is used"),
        "{text}"
    );
    let of_face = PLY
        .replace("vertex_indices\n", "vertex_indices\nproperty float quality\n")
        .replace("3 0 1 2\n", "3 0 1 2 0.5\n");
    let (code, text) = say(&of_face, &heat("quality"));
    let expected = "the property `quality` belongs to the element `face`, and attributes are properties of `vertex`";
    assert!(code == Some(1) && text.contains("a.ply:15: ") && text.contains(expected), "{text}");
    let list = PLY
        .replace("property float velz\n", "property float velz\nproperty list uchar float heat\n")
        .replace("1 2 3\n", "1 2 3 1 0.5\n");
    let (code, text) = say(&list, &heat("heat"));
    let expected = "the property `heat` is a list, and attributes are single values";
    assert!(code == Some(1) && text.contains("a.ply:13: ") && text.contains(expected), "{text}");
}

/// A loop without end on the CPU device is an error with the line of the loop, and says what to change.
#[test]
fn a_loop_without_end_has_its_line() {
    let folder = folder("endless");
    let storage = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/user_storage/first_k.wgsl");
    let source = std::fs::read_to_string(storage).unwrap();
    let body = "fn storage_insert(pixel: u32, entry: Packed) {\n    var i = 0u;\n    loop {\n        i += 2u;\n        if i == 1u { break; }\n    }\n";
    let endless = source.replace("fn storage_insert(pixel: u32, entry: Packed) {\n", body);
    let line = 1 + endless.lines().position(|line| line.trim() == "loop {").unwrap();
    std::fs::write(folder.join("mine.wgsl"), endless).unwrap();
    std::fs::write(folder.join("b.fragbuf"), "buffer B {\n    storage: wgsl(\"mine.wgsl\");\n    keep 8;\n}").unwrap();
    let (code, text) = render("b.fragbuf", "builtin:cubes", &[], &folder);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains(&format!("mine.wgsl:{line}: pass `store` does not terminate")), "{text}");
    assert!(text.contains("use another device"), "{text}");
}

/// Empty names, files in place of folders, options without an effect, and sizes beyond every number: each has a sentence that says what to give.
#[test]
fn odd_arguments_are_explained() {
    let folder = folder("odd");
    std::fs::write(folder.join("file"), "").unwrap();
    let scene = ["--scene", "builtin:cubes", "--size", "8x8", "--device", "cpu"];
    let with_scene = |arguments: &[&'static str]| [arguments, &scene[..]].concat();
    let no_description = "the name of the description is empty: give the key of a technique";
    let no_scene = "the name of a scene is empty: give a model file, or a generated scene such as `builtin:cubes`";
    for (arguments, code, expected) in [
        (with_scene(&["render", "", "--out", "x.png"]), 2, no_description),
        (vec!["show", " "], 2, no_description),
        (vec!["generate", "", "--target", "wgsl", "--out", "p"], 2, no_description),
        (with_scene(&["compare", "kb", "", "--out", "x.png"]), 2, no_description),
        (vec!["render", "kb", "--scene", "", "--out", "x.png"], 2, no_scene),
        (vec!["predict", "kplus_array", "--scene", ""], 2, no_scene),
        (with_scene(&["render", "kb", "--opaque", "", "--out", "x.png"]), 2, no_scene),
        (with_scene(&["render", "kb", "--out", ""]), 2, "the path is empty: give a file, such as image.png"),
        (vec!["generate", "kb", "--target", "wgsl", "--out", "file"], 3, "file is a file: give a folder"),
        (vec!["man", "--out", "file"], 3, "file is a file: give a folder"),
        (vec!["figure", "k15-table-1", "--quick", "--out", "file"], 3, "file is a file: give a folder"),
        (vec!["figure", "peers", "--peer", "missing"], 3, "missing is not a folder: give a checkout to `--peer`"),
        (with_scene(&["predict", "kplus_array", "--plot", "."]), 3, ". is a folder: give a file"),
        (with_scene(&["render", "kb", "--out", "x.png", "--order", "window:1,0"]), 2, "at least one triangle"),
    ] {
        let output = fragbuf(&arguments, &folder);
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    }
    let unused = fragbuf(&with_scene(&["render", "kb", "--importance", "file", "--out", "x.png"]), &folder);
    assert!(stderr(&unused).contains("kb: `--importance` changes nothing: "), "{}", stderr(&unused));
    let largest = fragbuf(&["show", "kb", "--size", "4294967295x4294967295"], &folder);
    assert_eq!(largest.status.code(), Some(1));
    assert!(stderr(&largest).contains("beyond 64 bits: give a smaller `--size`"), "{}", stderr(&largest));
}

/// Runs the command with this text on stdin.
fn with_stdin(arguments: &[&str], text: &[u8]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.current_dir(env!("CARGO_MANIFEST_DIR")).spawn().unwrap();
    child.stdin.take().unwrap().write_all(text).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn a_description_is_read_from_stdin() {
    let shown = with_stdin(&["show", "-"], b"buffer Piped from kb { keep 3; }");
    assert_eq!(shown.status.code(), Some(0), "{}", String::from_utf8_lossy(&shown.stderr));
    assert!(String::from_utf8(shown.stdout).unwrap().contains("Piped"));
    // Files that it names are relative to the current folder.
    let described = std::fs::read_to_string("examples/user_storage/first_k.fragbuf").unwrap();
    let moved = described.replace("first_k.wgsl", "examples/user_storage/first_k.wgsl");
    let named = with_stdin(&["show", "-"], moved.as_bytes());
    assert_eq!(named.status.code(), Some(0), "{}", String::from_utf8_lossy(&named.stderr));
    assert_ne!(with_stdin(&["show", "-"], described.as_bytes()).status.code(), Some(0));
    for (text, expected) in
        [(&b"buffer Piped from kb {\n  kep 3;\n}"[..], "stdin:2:3"), (b"buffer \xff", "stdin:1:8"), (b"", "stdin:1:1")]
    {
        let failed = with_stdin(&["generate", "-", "--target", "wgsl", "--out", "unused"], text);
        let stderr = String::from_utf8(failed.stderr).unwrap();
        assert_eq!(failed.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains(expected), "{stderr}");
    }
}
