//! What the printed text looks like, in the cases where that matters most. The expectations are written by hand.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use fragbuf_glsl::{Dialect, Unit};
use support::{ALL, accept, function, print, print_with};

const DATA: &str = "
@group(0) @binding(0) var<storage, read_write> a: array<u32>;
@group(0) @binding(1) var<storage, read_write> locks: array<atomic<u32>>;
const LIMIT: u32 = 64u;
fn memory_fence() {}
fn is_helper_lane() -> bool { return false; }
fn bump(i: u32) -> u32 { a[i] += 1u; return a[i]; }
fn read(i: u32) -> u32 { return a[i]; }
";

/// Prints a function of a library in the OpenGL dialect, after every dialect has been accepted.
#[track_caller]
fn expect(name: &str, wgsl: &str, expected: &str) {
    let source = format!("{DATA}{wgsl}");
    for dialect in ALL {
        let text = print(&source, Unit::Library, dialect).unwrap_or_else(|errors| panic!("{errors:?}"));
        let version = match dialect {
            Dialect::Es310 => "#version 310 es\nprecision highp float;",
            _ => "#version 450",
        };
        let whole = format!("{version}\n{text}\nvoid main() {{}}\n");
        accept(&whole, &format!("golden_{name}"), "frag", dialect).unwrap_or_else(|message| panic!("{message}"));
    }
    let text = print(&source, Unit::Library, Dialect::OpenGl450).unwrap();
    assert_eq!(function(&text, name), expected.trim_start_matches('\n'), "\n{text}");
}

#[test]
fn for_loop() {
    expect(
        "sum",
        "fn sum(n: u32) -> u32 {
            var total = 0u;
            for (var i = 0u; i < n; i++) {
                if a[i] == 0u { continue; }
                total += a[i];
            }
            for (var i = n; i > 0u; i -= 2u) { total ^= i; }
            return total;
        }",
        "
uint sum(uint n) {
    uint total = 0u;
    for (uint i = 0u; i < n; i++) {
        if (a[i] == 0u) {
            continue;
        }
        total += a[i];
    }
    for (uint i = n; i > 0u; i -= 2u) {
        total ^= i;
    }
    return total;
}
",
    );
}

#[test]
fn for_loop_over_an_outer_variable() {
    expect(
        "find",
        "fn find(n: u32) -> u32 {
            var i: u32;
            for (i = n; i < LIMIT; i++) {
                if a[i] == 0u { break; }
            }
            return i;
        }",
        "
uint find(uint n) {
    uint i = n;
    for (; i < LIMIT; i++) {
        if (a[i] == 0u) {
            break;
        }
    }
    return i;
}
",
    );
}

#[test]
fn while_loop_with_continue() {
    expect(
        "walk",
        "fn walk(head: u32) -> u32 {
            var node = head;
            var count = 0u;
            while node != 0u && count < LIMIT {
                node = a[node];
                if node == 7u { continue; }
                count++;
            }
            return count;
        }",
        "
uint walk(uint head) {
    uint node = head;
    uint count = 0u;
    while (node != 0u && count < LIMIT) {
        node = a[node];
        if (node == 7u) {
            continue;
        }
        count++;
    }
    return count;
}
",
    );
}

#[test]
fn continuing_runs_at_continue() {
    expect(
        "spin",
        "fn spin(n: u32) {
            var i = 0u;
            loop {
                if a[i] == n { continue; }
                a[i] = n;
                continuing {
                    i += 1u;
                    a[0] = i;
                    break if i == 9u;
                }
            }
        }",
        "
void spin(uint n) {
    uint i = 0u;
    while (true) {
        if (a[i] == n) {
            i++;
            a[0] = i;
            if (i == 9u) {
                break;
            }
            continue;
        }
        a[i] = n;
        i++;
        a[0] = i;
        if (i == 9u) {
            break;
        }
    }
}
",
    );
}

#[test]
fn variables_of_a_loop_body_begin_anew() {
    expect(
        "anew",
        "fn anew(n: u32) {
            for (var i = 0u; i < n; i++) {
                var seen: bool;
                var first = i;
                if a[i] > 3u { seen = true; first = 2u; }
                if seen { a[i] = first; }
            }
        }",
        "
void anew(uint n) {
    for (uint i = 0u; i < n; i++) {
        bool seen = false;
        uint first = i;
        if (a[i] > 3u) {
            seen = true;
            first = 2u;
        }
        if (seen) {
            a[i] = first;
        }
    }
}
",
    );
}

#[test]
fn short_circuits() {
    expect(
        "decide",
        "fn decide(i: u32, strict: bool) -> bool {
            let near = i < LIMIT && a[i] != 0u;
            if near || (strict && bump(i) > 3u) { return true; }
            return !near && (a[0] == 1u || a[1] == 1u);
        }",
        "
bool decide(uint i, bool strict) {
    bool near = i < LIMIT && a[i] != 0u;
    if (near || (strict && bump(i) > 3u)) {
        return true;
    }
    return !near && (a[0] == 1u || a[1] == 1u);
}
",
    );
}

#[test]
fn else_if_chain() {
    expect(
        "grade",
        "fn grade(n: u32) -> u32 {
            if n < 3u { return 0u; } else if n < 5u && a[n] == 1u { return 1u; } else if n < 9u { a[n] = 2u; } else { a[n] = 3u; }
            return n;
        }",
        "
uint grade(uint n) {
    if (n < 3u) {
        return 0u;
    } else if (n < 5u && a[n] == 1u) {
        return 1u;
    } else if (n < 9u) {
        a[n] = 2u;
    } else {
        a[n] = 3u;
    }
    return n;
}
",
    );
}

#[test]
fn swap_keeps_its_temporary() {
    expect(
        "swap",
        "fn swap(i: u32, j: u32) { let t = a[i]; a[i] = a[j]; a[j] = t; }",
        "
void swap(uint i, uint j) {
    uint t = a[i];
    a[i] = a[j];
    a[j] = t;
}
",
    );
}

#[test]
fn reads_do_not_pass_writes() {
    // The index is read before the call changes it, the value after.
    expect(
        "order",
        "fn order(i: u32) -> u32 {
            var n = i;
            let p = &a[n];
            n += 1u;
            *p = n;
            a[a[i]] = a[0] + bump(0u);
            return a[0] * bump(0u) + read(0u);
        }",
        "
uint order(uint i) {
    uint n = i;
    uint n_value = n;
    n++;
    a[n_value] = n;
    uint a_value = a[i];
    uint a_value_2 = a[0];
    a[a_value] = a_value_2 + bump(0u);
    uint a_value_3 = a[0];
    uint bump_result = bump(0u);
    return a_value_3 * bump_result + read(0u);
}
",
    );
}

#[test]
fn effects_are_not_skipped() {
    expect(
        "choose",
        "fn choose(c: bool) -> u32 { return select(bump(0u), a[1], c); }",
        "
uint choose(bool c) {
    uint bump_result = bump(0u);
    return c ? a[1] : bump_result;
}
",
    );
}

#[test]
fn effects_inside_arguments_are_not_skipped() {
    expect(
        "nested",
        "fn nested(c: bool) -> u32 {
            a[bump(1u)] = a[2];
            a[3] = bump(bump(4u));
            return select(0u, read(bump(0u)), c) + a[5];
        }",
        "
uint nested(bool c) {
    uint bump_result = bump(1u);
    a[bump_result] = a[2];
    a[3] = bump(bump(4u));
    uint read_result = read(bump(0u));
    return (c ? read_result : 0u) + a[5];
}
",
    );
}

#[test]
fn effects_keep_their_order_in_a_condition() {
    expect(
        "guarded",
        "fn guarded(i: u32) -> u32 {
            while a[0] > 1u && bump(0u) < 5u { a[1] += bump(i); }
            let sum = a[i] + u32(bump(1u) > 2u || bump(2u) > 3u);
            return sum;
        }",
        "
uint guarded(uint i) {
    while (a[0] > 1u && bump(0u) < 5u) {
        uint a_value = a[1];
        a[1] = a_value + bump(i);
    }
    uint a_value = a[i];
    uint sum = a_value + uint(bump(1u) > 2u || bump(2u) > 3u);
    return sum;
}
",
    );
}

#[test]
fn spin_lock() {
    expect(
        "sync_store",
        "fn sync_store(pixel: u32, key: u32) {
            if is_helper_lane() { return; }
            for (var attempt = 0u; attempt < LIMIT; attempt++) {
                if atomicCompareExchangeWeak(&locks[pixel], 0u, 1u).exchanged {
                    memory_fence();
                    // slot 0 is published last
                    a[pixel] = key;
                    memory_fence();
                    atomicStore(&locks[pixel], 0u);
                    return;
                }
            }
            a[0] = key;
        }",
        "
void sync_store(uint pixel, uint key) {
    if (gl_HelperInvocation) {
        return;
    }
    for (uint attempt = 0u; attempt < LIMIT; attempt++) {
        if (atomicCompSwap(locks[pixel], 0u, 1u) == 0u) {
            memoryBarrierBuffer();
            // slot 0 is published last
            a[pixel] = key;
            memoryBarrierBuffer();
            atomicExchange(locks[pixel], 0u);
            return;
        }
    }
    a[0] = key;
}
",
    );
}

#[test]
fn comments_stand_where_they_stood() {
    expect(
        "commented",
        "fn commented(n: u32) -> u32 {
            // the first
            var total = 0u; // starts at zero

            // above the loop,
            // in two lines
            for (var i = 0u; i < n; i++) {
                // inside
                let value = a[i]; // read once
                if value > 3u { // large
                    total += value;
                    // end of the branch
                } else {
                    // small
                    total++;
                }
                // end of the loop
            }

            return total; // done
        }",
        "
uint commented(uint n) {
    // the first
    uint total = 0u; // starts at zero

    // above the loop,
    // in two lines
    for (uint i = 0u; i < n; i++) {
        // inside
        uint value = a[i]; // read once
        if (value > 3u) {
            // large
            total += value;
            // end of the branch
        } else {
            // small
            total++;
        }
        // end of the loop
    }

    return total; // done
}
",
    );
}

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
fn plain_loads_are_allowed_by_name() {
    let source = format!("{DATA}fn peek(i: u32) -> u32 {{ return atomicLoad(&locks[i]); }}");
    let atomic = print(&source, Unit::Library, Dialect::OpenGl450).unwrap();
    assert!(atomic.contains("return atomicOr(locks[i], 0u);"), "{atomic}");
    assert!(atomic.contains("coherent buffer LocksBuffer"), "{atomic}");
    let plain = print_with(&source, Unit::Library, Dialect::OpenGl450, &["locks"]).unwrap();
    assert!(plain.contains("return locks[i];"), "{plain}");
    assert!(plain.contains("coherent volatile buffer LocksBuffer"), "{plain}");
    let vulkan = print_with(&source, Unit::Library, Dialect::Vulkan450, &["locks"]).unwrap();
    assert!(vulkan.contains("atomicLoad(locks[i], gl_ScopeDevice"), "{vulkan}");
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
fn header_stands_below_the_version() {
    let source = "/// Doubles.\nfn twice(n: u32) -> u32 { return n * 2u; }\n@compute @workgroup_size(1) fn main() { let n = twice(1u); }";
    let (module, info) = support::parse(source);
    let slot = |_, _| fragbuf_glsl::Slot::default();
    let header = "made by a test\nin two lines";
    let options = fragbuf_glsl::Options {
        dialect: Dialect::Vulkan450,
        header,
        markers: &[],
        bindings: &slot,
        plain_loads: &[],
        written_first: &[],
        zero_workgroup_memory: true,
    };
    let text = fragbuf_glsl::print(&module, &info, source, Unit::EntryPoint("main"), &options).unwrap();
    assert!(
        text.starts_with("#version 450\n\n// made by a test\n// in two lines\n\nlayout(local_size_x = 1"),
        "{text}"
    );
    let library = fragbuf_glsl::print(&module, &info, source, Unit::Library, &options).unwrap();
    let expected = "// made by a test\n// in two lines\n\n/// Doubles.\nuint twice(uint n) {\n    return n * 2u;\n}\n";
    assert_eq!(library, expected);
    // A text that the module does not come from costs the comments, and nothing else.
    let strange = fragbuf_glsl::print(&module, &info, "\u{1F600} // ?", Unit::EntryPoint("main"), &options).unwrap();
    assert!(strange.contains("uint n = twice(1u);"), "{strange}");
}

#[test]
fn comments_above_functions_go_along() {
    let source =
        "// The head of a file.\n\n// Two lines\n// about it.\nfn twice(n: u32) -> u32 {\n    return n * 2u;\n}\n";
    let text = print(source, Unit::Library, Dialect::OpenGl450).unwrap();
    assert_eq!(text, "// Two lines\n// about it.\nuint twice(uint n) {\n    return n * 2u;\n}\n");
}
