//! Golden tests of entry points and resources.

use fragbuf_glsl::{Dialect, Unit};

use super::DATA;
use super::support::{function, print, print_with};

#[test]
fn entry_point_is_main() {
    let source = "
/// What is kept.
struct Surface {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec4<f32>,
    @location(1) @interpolate(flat) id: u32,
}
struct Target { @location(0) color: vec4<f32>, @builtin(frag_depth) depth: f32 }
/// Draws.
@fragment
fn draw(surface: Surface) -> Target {
    if surface.id == 0u { discard; }
    let depth = surface.position.z * 0.5;
    return Target(surface.color, depth);
}
";
    let text = print(source, Unit::EntryPoint("draw"), Dialect::Vulkan450).unwrap();
    let expected = "#version 450

layout(location = 0) in vec4 in_color;
layout(location = 1) flat in uint in_id;
layout(location = 0) out vec4 out_color;

/// Draws.
void main() {
    if (in_id == 0u) {
        discard;
    }
    float depth = gl_FragCoord.z * 0.5;
    out_color = in_color;
    gl_FragDepth = depth;
}
";
    assert_eq!(text, expected);
}

#[test]
fn vertex_stage_of_opengl() {
    let source = "
/// The camera.
struct Frame {
    /// World to clip space.
    view: mat4x4<f32>,
}
/// Set once a frame.
@group(0) @binding(2) var<uniform> frame: Frame;
struct Varyings { @builtin(position) position: vec4<f32>, @location(0) @interpolate(flat) id: u32 }
@vertex
fn geometry(@location(0) position: vec3<f32>, @builtin(vertex_index) index: u32) -> Varyings {
    // three vertices each
    let id = index / 3u;
    return Varyings(frame.view * vec4<f32>(position, 1.0), id);
}
";
    let text = print(source, Unit::EntryPoint("geometry"), Dialect::OpenGl450).unwrap();
    let expected = "#version 450

/// The camera.
struct Frame {
    /// World to clip space.
    mat4 view;
};

layout(location = 0) in vec3 in_position;
layout(location = 0) flat out uint out_id;

/// Set once a frame.
layout(std140, binding = 2) uniform FrameBlock {
    Frame frame;
};

void main() {
    uint index = uint(gl_VertexID);
    // three vertices each
    uint id = index / 3u;
    gl_Position = frame.view * vec4(in_position, 1.0);
    // OpenGL clips depth to -w..w, WGSL to 0..w.
    gl_Position.z = 2.0 * gl_Position.z - gl_Position.w;
    out_id = id;
}
";
    assert_eq!(text, expected);
}

#[test]
fn plain_loads_are_allowed_by_name() {
    let source = format!("{DATA}fn peek(i: u32) -> u32 {{ return atomicLoad(&locks[i]); }}");
    let atomic = print(&source, Unit::Library, Dialect::OpenGl450).unwrap();
    assert!(atomic.contains("return atomicOr(locks[i], 0u);"), "{atomic}");
    assert!(atomic.contains("coherent buffer LocksBuffer"), "{atomic}");
    let plain = print_with(&source, Unit::Library, Dialect::OpenGl450, (&["locks"], &[])).unwrap();
    assert!(plain.contains("return locks[i];"), "{plain}");
    assert!(plain.contains("coherent volatile buffer LocksBuffer"), "{plain}");
    let vulkan = print_with(&source, Unit::Library, Dialect::Vulkan450, (&["locks"], &[])).unwrap();
    assert!(vulkan.contains("atomicLoad(locks[i], gl_ScopeDevice"), "{vulkan}");
}

#[test]
fn accesses_are_plain_in_named_functions() {
    let functions = "fn guarded(i: u32) -> u32 { atomicStore(&locks[i], 7u); return atomicLoad(&locks[i]); }
        fn hint(i: u32) -> u32 { return atomicLoad(&locks[i]); }";
    let source = format!("{DATA}{functions}");
    for dialect in [Dialect::OpenGl450, Dialect::Es310, Dialect::Vulkan450] {
        let text = print_with(&source, Unit::Library, dialect, (&[], &["guarded"])).unwrap();
        let guarded = function(&text, "guarded");
        assert!(guarded.contains("locks[i] = 7u;") && !guarded.contains("atomic"), "{text}");
        assert!(function(&text, "hint").contains("atomic"), "{text}");
        assert!(text.contains("coherent buffer LocksBuffer"), "{text}");
    }
}
