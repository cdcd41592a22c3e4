//! Models with random changes: whatever a file has, a reader returns a valid scene, or an error with a position, within its memory.
//!
//! The changes follow a seed, so that a failure can be repeated: its message has the number of the model. `FRAGBUF_FUZZ_MODELS=1000000`
//! tries so many models instead of the default, and `FRAGBUF_FUZZ_FIRST=4711` begins with that number.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::Path;

use base64::Engine as _;
use fragbuf_scene::{AttributeRequest, Error, FilePosition, Limits, Scene, load, load_with};
use tempfile::TempDir;

mod vtk_files;

/// The number of models that the test command tries.
const MODELS: u64 = 10_000;

/// The memory of a model. Lists of an element that is malformed later may need it all.
const LIMITS: Limits = Limits { memory: 4 << 20, reads_named_files: true };

/// A generator of random numbers: SplitMix64.
struct Rng(u64);

impl Rng {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^ (word >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let (a, b) = (self.below(length + 1), self.below(length + 1));
        let near = a.min(b) + self.below(12);
        a.min(b)..if self.below(4) == 0 { a.max(b) } else { near.min(a.max(b)) }
    }
}

const OBJ: &str = "# exported\nmtllib a.mtl\no cube\nv -1 -1 0.5 1 0 0\nv 1.0 -1 .5\nv 1e0 1 0.5 0 1 0 0.5\nv -1 1 0.5\nvt 0 0\nvt 1 1\n\
    vn 0 0 1\nvn 0.5 0 -0.5\ns off\nusemtl red\nf 1/1/1 2/2/1 3//2 4\ng part two\nusemtl Material #2\nf -1 -2 -3\nf 1 2 3 4 1 3\nl 1 2\n\
    f 1// 2// \\\n 3//\np 1\nvw 1 2\n";

const MTL: &str = "# library\nnewmtl red\nKa 0 0 0\nKd 1 0 0\nd 0.5\nTr 0.5\nillum 2\nmap_Kd red.png\nnewmtl Material #2\nKd 0.25\n\
    d -halo 0.75\nmap_d -clamp on a.png\n";

const PLY_HEADER: &str = "ply\nformat ascii 1.0\ncomment exported\nobj_info none\nelement vertex 4\nproperty double x\nproperty float y\n\
    property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n\
    property ushort blue\nproperty float own\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nelement edge 1\nproperty int a\n\
    property list ushort float values\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";

const PLY_BODY: &str = "-1 -1 0.5 0 0 1 255 0 0 1\n1 -1 .5 0 0 1 0 255 0 2.5\n1 1 0.5 0 1 0 0 0 65535 inf\n-1 1 5e-1 nan 0 0 9 9 9 -4\n4 0 1 2 3 255\n\
    3 0 1 2 7\n5 2 0.5 1\n5 0 1 2 -1 3\n";

const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}, {}],
"nodes": [{"mesh": 0, "translation": [1, 2, 3], "children": [1]}, {"mesh": 0, "scale": [0.5, 1, 2], "rotation": [0, 0, 0, 1]},
{"mesh": 0, "skin": 0, "weights": [0.5], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}], "skins": [{"joints": [1]}],
"meshes": [{"name": "m", "weights": [1], "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0, "COLOR_0": 2, "_OWN": 1},
"indices": 1, "material": 0, "mode": 4, "targets": [{"POSITION": 0}]}, {"attributes": {"POSITION": 3}, "mode": 5}]}],
"materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5], "baseColorTexture": {"index": 0}}, "alphaMode": "MASK"}],
"textures": [{"source": 0}], "images": [{"uri": "a.png"}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
{"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"},
{"bufferView": 0, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"},
{"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5125},
"values": {"bufferView": 0}}}],
"bufferViews": [{"buffer": 0, "byteLength": 36, "byteStride": 12}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
"buffers": [{"byteLength": 48BUFFER}]}"#;

/// The name and the bytes of a model, and of a file that it names.
type Model = (&'static str, Vec<u8>, Option<(&'static str, Vec<u8>)>);

fn models() -> Vec<Model> {
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let buffer = [numbers, [0_u32, 1, 2].map(u32::to_le_bytes).concat()].concat();
    let text = base64::engine::general_purpose::STANDARD.encode(&buffer);
    let inside = GLTF.replace("BUFFER", &format!(r#", "uri": "data:application/octet-stream;base64,{text}""#));
    let beside = GLTF.replace("BUFFER", r#", "uri": "a%20b.bin""#);
    vec![
        ("m.obj", OBJ.into(), Some(("a.mtl", MTL.into()))),
        ("m.obj", OBJ.replace('\n', "\r\n").into(), None),
        ("m.ply", [PLY_HEADER, PLY_BODY].concat().into(), None),
        ("m.ply", binary_ply(false), None),
        ("m.ply", binary_ply(true), None),
        ("m.gltf", inside.into(), None),
        ("m.gltf", beside.into(), Some(("a b.bin", buffer.clone()))),
        ("m.glb", glb(&GLTF.replace("BUFFER", ""), &buffer), None),
    ]
    .into_iter()
    .chain(vtk_files::files().into_iter().map(|(name, bytes)| (name, with_own(&bytes), None)))
    .collect()
}

/// Returns a file of VTK with the attribute `own`.
fn with_own(bytes: &[u8]) -> Vec<u8> {
    let (mut own, mut rest) = (Vec::new(), bytes);
    while let Some(at) = rest.windows(4).position(|window| window == b"heat") {
        own.extend_from_slice(&rest[..at]);
        own.extend_from_slice(b"own");
        rest = &rest[at + 4..];
    }
    [own, rest.to_vec()].concat()
}

fn binary_ply(is_big: bool) -> Vec<u8> {
    let mut body = Vec::new();
    let mut push = |mut bytes: Vec<u8>| {
        if is_big {
            bytes.reverse();
        }
        body.extend(bytes);
    };
    for [x, y] in [[-1.0_f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
        push(f64::from(x).to_le_bytes().into());
        [y, 0.5, 0.0, 0.0, 1.0].iter().for_each(|value| push(value.to_le_bytes().into()));
        push(vec![255]);
        push(vec![0]);
        push(65_535_u16.to_le_bytes().into());
        push(0.25_f32.to_le_bytes().into());
    }
    for face in [&[0, 1, 2, 3][..], &[0, 1, 2]] {
        push(vec![face.len() as u8]);
        face.iter().for_each(|index: &i32| push(index.to_le_bytes().into()));
        push(vec![7]);
    }
    push(5_i32.to_le_bytes().into());
    push(1_u16.to_le_bytes().into());
    push(0.5_f32.to_le_bytes().into());
    push(5_i32.to_le_bytes().into());
    [0, 1, 2, -1, 3].iter().for_each(|index: &i32| push(index.to_le_bytes().into()));
    let format = if is_big { "binary_big_endian" } else { "binary_little_endian" };
    [PLY_HEADER.replace("ascii", format).into_bytes(), body].concat()
}

fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind.as_slice(), bytes].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", binary)].concat();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

/// Words that replace numbers and names.
const WORDS: [&str; 30] = [
    "0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "7",
    "255",
    "256",
    "65536",
    "2147483647",
    "-2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e-9",
    "1e38",
    "1e39",
    "-1e300",
    "1e301",
    "nan",
    "inf",
    "-1.#IND",
    "0.5",
    "",
    "face",
    "double",
    "a/b",
    "[]",
    "null",
];

fn change(bytes: &mut Vec<u8>, rng: &mut Rng) {
    match rng.below(8) {
        0 if !bytes.is_empty() => {
            let at = rng.below(bytes.len());
            bytes[at] ^= 1 << rng.below(8);
        }
        1 => {
            let at = rng.below(bytes.len() + 1);
            bytes.insert(at, rng.next() as u8);
        }
        2 => drop(bytes.drain(rng.range(bytes.len()))),
        3 => {
            let range = rng.range(bytes.len());
            let part = bytes[range].repeat(1 + rng.below(3));
            let at = rng.below(bytes.len() + 1);
            bytes.splice(at..at, part);
        }
        4 if rng.below(4) == 0 => bytes.truncate(rng.below(bytes.len() + 1)),
        _ => replace_word(bytes, rng),
    }
}

/// Replaces a number or a name.
fn replace_word(bytes: &mut Vec<u8>, rng: &mut Rng) {
    let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || b"+-._".contains(byte);
    let at = rng.below(bytes.len());
    let Some(begin) = bytes.iter().skip(at).position(is_part).map(|skipped| at + skipped) else { return };
    let length = bytes[begin..].iter().take_while(|byte| is_part(byte)).count();
    bytes.splice(begin..begin + length, WORDS[rng.below(WORDS.len())].bytes());
}

/// Writes the model with this number, and loads it.
fn attempt(number: u64, models: &[Model], folder: &Path) -> Result<Scene, Error> {
    let mut rng = Rng(number.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let (name, mut bytes, second) = models[rng.below(models.len())].clone();
    let changes = 1 + rng.below(4);
    if let Some((other, mut content)) = second {
        if rng.below(2) == 0 {
            (0..changes).for_each(|_| change(&mut content, &mut rng));
        }
        std::fs::write(folder.join(other), content).unwrap();
    }
    (0..changes).for_each(|_| change(&mut bytes, &mut rng));
    let path = folder.join(name);
    std::fs::write(&path, &bytes).unwrap();
    // Half of the models are loaded with attributes, which an OBJ does not have.
    let own = [AttributeRequest {
        name: "own".to_owned(),
        components: 1,
        is_integer: number.is_multiple_of(3),
        is_optional: false,
    }];
    let requests = if number.is_multiple_of(2) || name == "m.obj" { &[][..] } else { &own };
    load_with(&path, [0.5; 4], requests, &LIMITS)
}

fn check_scene(scene: &Scene) {
    assert!(scene.triangles() > 0 && scene.placement.unit > 0.0 && scene.placement.unit.is_finite());
    assert!(scene.placement.origin.iter().all(|value| value.is_finite()));
    for object in &scene.objects {
        let count = object.positions.len();
        assert!(object.normals.len() == count && object.colors.len() == count);
        assert!(object.triangles.iter().flatten().all(|index| (*index as usize) < count));
        assert!(object.positions.iter().chain(&object.normals).flatten().all(|value| value.is_finite()));
        assert!(object.normals.iter().all(|[x, y, z]| (x * x + y * y + z * z - 1.0).abs() < 1.0e-3));
        assert!(object.colors.iter().flatten().all(|value| value.is_finite()));
        assert_eq!(object.attributes.len(), scene.attributes.len());
        for (request, words) in scene.attributes.iter().zip(&object.attributes) {
            assert_eq!(words.len(), request.components * count);
            assert!(request.is_integer || words.iter().all(|word| f32::from_bits(*word).is_finite()));
        }
    }
    assert!(scene.warnings.len() < 40, "{}", scene.warnings.len());
    let extent =
        scene.bounds().map(|(least, greatest)| (0..3).map(|axis| greatest[axis] - least[axis]).fold(0.0, f32::max));
    assert!(extent.is_some_and(|extent| extent < 1.0e5));
    let camera = fragbuf_scene::Camera::framing(&[scene], 1.0);
    assert!(camera.view_projection.iter().all(|value| value.is_finite()), "{camera:?}");
}

/// Checks that an error has a position: a line or a byte.
fn check_error(error: &Error) {
    let text = error.to_string();
    match error {
        Error::Malformed { position: FilePosition::Whole, message, .. } => {
            let about_whole = ["the model has no triangles", "the name of a file", "the file is "];
            assert!(about_whole.iter().any(|begin| message.starts_with(begin)), "{text}");
        }
        Error::Malformed { .. } | Error::TooLarge { .. } | Error::Unreadable { .. } => {}
        Error::MissingAttribute { available, .. } => assert!(available.len() < 1000),
        Error::Unknown(_) => panic!("{text}"),
    }
    assert!(text.chars().count() < 1200, "{text}");
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|value| value.parse().unwrap())
}

/// Returns the most memory that this process has had at one time, in KiB.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or_default()
}

#[test]
fn changed_models_are_scenes_or_errors() {
    let models = models();
    // In memory where the system has such a folder: writing to a disk takes longer than reading the model.
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() { TempDir::new_in(memory) } else { TempDir::new() }.unwrap();
    // Without changes, every model is valid.
    for (name, bytes, second) in &models {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        second.iter().for_each(|(other, content)| std::fs::write(folder.path().join(other), content).unwrap());
        check_scene(&load(&path, [0.5; 4], &LIMITS).unwrap_or_else(|error| panic!("{error}")));
    }
    let (first, count) =
        (variable("FRAGBUF_FUZZ_FIRST").unwrap_or(0), variable("FRAGBUF_FUZZ_MODELS").unwrap_or(MODELS));
    let mut scenes = 0;
    for number in first..first + count {
        let checked = std::panic::catch_unwind(|| {
            let result = attempt(number, &models, folder.path());
            match &result {
                Ok(scene) => check_scene(scene),
                Err(error) => check_error(error),
            }
            result.is_ok()
        });
        scenes += u64::from(checked.unwrap_or_else(|_| panic!("model {number}")));
    }
    // The changes are small enough for some models to stay valid.
    assert!(count < 1000 || (count / 10..count).contains(&scenes), "{scenes} of {count} models are valid");
    assert!(peak() < 256 << 10, "{} KiB", peak());
}
