//! A peer's shaders beside ours. The peer is an A-buffer of fixed arrays that this file contains, written as others write theirs, with
//! two faults that its description corrects by line.

use fragbuf_opengl_host::{Context, Description, Object, Peer, Scene};

const HEADER: &str = "#version 450 core\n#define SLOTS 2\n";
const STORE: &str = "#include \"header.h\"
vec4 computePixelColor();
layout(binding = 0, r32ui) coherent uniform uimage2DRect counts;
layout(binding = 1, rg32f) writeonly uniform image2DArray data;
void main() {
    int slot = int(imageAtomicAdd(counts, ivec2(gl_FragCoord.xy), 1u));
    imageStore(data, ivec3(gl_FragCoord.xy, slot), vec4(gl_FragCoord.z, computePixelColor().r, 0.0, 0.0));
}
";
const SHOW: &str = "#include \"header.h\"
layout(binding = 0, r32ui) readonly uniform uimage2DRect counts;
layout(binding = 1, rg32f) readonly uniform image2DArray data;
out vec4 color;
void main() {
    color = vec4(imageLoad(no_such_image, ivec3(gl_FragCoord.xy, 1)).rg, float(imageLoad(counts, ivec2(gl_FragCoord.xy)).r), 1.0);
}
";

fn read(path: &str) -> Result<String, fragbuf_opengl_host::Error> {
    Ok(match path {
        "include/header.h" => HEADER,
        "store.frag" => STORE,
        "show.frag" => SHOW,
        other => return Err(fragbuf_opengl_host::Error(format!("no file {other}"))),
    }
    .to_owned())
}

/// The description, with this checksum of the file that it corrects.
fn description(checksum: &str) -> String {
    format!(
        r#"{{"technique": "ab_array", "note": "one name", "include": "include",
            "memory": [{{"kind": "image-rectangle", "binding": 0, "format": "r32ui", "clear": [0, 0]}},
                       {{"kind": "image-array", "binding": 1, "format": "rg32f", "layers": 2, "clear": [0.5, 0.25]}}],
            "passes": [{{"fragment": "store.frag", "scene": true}}, {{"fragment": "show.frag", "output": true}}],
            "corrections": {{"show.frag": {{"checksum": "{checksum}", "lines": {{"6":
                "    color = vec4(imageLoad(data, ivec3(gl_FragCoord.xy, 1)).rg, float(imageLoad(counts, ivec2(gl_FragCoord.xy)).r), 1.0);"}}}}}}}}"#
    )
}

/// FNV-1a of `SHOW`, computed as the specification of the hash states it.
fn checksum() -> String {
    let mut hash = 14_695_981_039_346_656_037_u64;
    for byte in SHOW.bytes() {
        hash ^= u64::from(byte);
        hash = hash.wrapping_mul(1_099_511_628_211);
    }
    format!("{hash:016x}")
}

#[test]
fn a_peer_draws_with_its_own_shaders_after_corrections() {
    let context = Context::surfaceless().unwrap();
    let description = Description::parse(&description(&checksum())).unwrap();
    let mut peer = Peer::new(&context, &description, &read, [4, 2]).unwrap();
    // Two triangles over the left half: the first at depth 0.25 with red 1, the second at depth 0.75 with red 0.5.
    let triangle =
        |depth: f32, red: f32| [[-1.0, -3.0], [0.0, -3.0], [0.0, 3.0]].map(|[x, y]| [x, y, depth, red, 0.0, 0.0, 1.0]);
    let left = |depth, red| {
        let [a, b, c] = triangle(depth, red);
        let d = [-1.0, 3.0, depth, red, 0.0, 0.0, 1.0];
        [a, b, c, a, c, d]
    };
    let vertices: Vec<u8> = [left(0.25, 1.0), left(0.75, 0.5)]
        .iter()
        .flatten()
        .flatten()
        .flat_map(|value: &f32| value.to_le_bytes())
        .collect();
    let objects = [Object { first: 0, count: 12, bounds: [[-1.0; 3], [1.0; 3]] }];
    let identity = std::array::from_fn(|index| if index % 5 == 0 { 1.0 } else { 0.0 });
    let scene = Scene { vertices: &vertices, objects: &objects, view_projection: identity };
    peer.upload(&scene);
    // A second frame begins with cleared memory.
    for _ in 0..2 {
        let image = peer.render(&scene, [0.0; 4]).unwrap();
        let rounded = |pixel: [f32; 4]| pixel.map(|channel| (channel * 100.0).round() as i32);
        // Left: slot 1 holds the second fragment's depth and red, and two fragments were counted. Right: the cleared values.
        assert_eq!(rounded(image.pixels[0]), [75, 50, 200, 100]);
        assert_eq!(rounded(image.pixels[3]), [50, 25, 0, 100]);
    }
}

#[test]
fn corrections_of_another_version_are_an_error() {
    let context = Context::surfaceless().unwrap();
    let description = Description::parse(&description("0123456789abcdef")).unwrap();
    let error = Peer::new(&context, &description, &read, [4, 2]).err().unwrap();
    assert!(error.0.contains("show.frag: the checksum is") && error.0.contains("0123456789abcdef"), "{error}");
}

#[test]
fn errors_name_the_file() {
    let context = Context::surfaceless().unwrap();
    let error = |from: &str, to: &str| {
        let text = description(&checksum()).replace(from, to);
        Description::parse(&text)
            .and_then(|description| Peer::new(&context, &description, &read, [4, 2]))
            .err()
            .unwrap()
            .0
    };
    assert!(error("store.frag", "other.frag").contains("no file other.frag"));
    assert!(error("\"6\":", "\"7-90\":").contains("show.frag: no lines `7-90`"));
    assert!(error("vec4(imageLoad(data", "vec4(missing(data").contains("show.frag: "));
    assert!(error("rg32f", "rg31f").contains("unknown image format `rg31f`"));
    assert!(error("image-array", "image-list").contains("the description of a peer: "));
}
