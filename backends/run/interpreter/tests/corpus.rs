//! Runs the same shaders on a device and in the interpreter and compares every word of their buffers.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod device;
mod lane_dispatch;

use fragbuf_interpreter::{Bytecode, DispatchEnd, Options, dispatch};
use fragbuf_runtime::headless::{Choice, Headless};
use fragbuf_runtime::wgpu;
use lane_dispatch::dispatch_in_lanes;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// The allowed difference between two words.
#[derive(Clone, Copy, PartialEq)]
enum Tolerance {
    Exact,
    /// As floats, relative to the larger magnitude.
    Relative(f32),
}

/// The length of a runtime-sized buffer in words.
const LENGTH: usize = 4096;

const CONTROL_FLOW: &str = include_str!("corpus/control_flow.wgsl");

const CORPUS: [(&str, &str, Tolerance, [u32; 3]); 8] = [
    ("whole_numbers", include_str!("corpus/whole_numbers.wgsl"), Tolerance::Exact, [1, 1, 1]),
    ("floats", include_str!("corpus/floats.wgsl"), Tolerance::Exact, [1, 1, 1]),
    (
        "functions_of_floats",
        include_str!("corpus/functions_of_floats.wgsl"),
        Tolerance::Relative(1.0 / 2048.0),
        [1, 1, 1],
    ),
    ("memory", include_str!("corpus/memory.wgsl"), Tolerance::Exact, [1, 1, 1]),
    ("control_flow", CONTROL_FLOW, Tolerance::Exact, [1, 1, 1]),
    ("atomics", include_str!("corpus/atomics.wgsl"), Tolerance::Exact, [1, 1, 1]),
    ("workgroups", include_str!("corpus/workgroups.wgsl"), Tolerance::Exact, [2, 3, 1]),
    ("wide_numbers", include_str!("corpus/wide_numbers.wgsl"), Tolerance::Exact, [1, 1, 1]),
];

/// Returns seeded numbers of all sizes, with zero and sign bits.
fn seeded(length: usize) -> Vec<u32> {
    let mut state = 0x2545_f491u32;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    };
    let edge = [0, 1, u32::MAX, 0x8000_0000, 0x7fff_ffff, 2, 31, 32];
    (0..length).map(|at| edge.get(at).copied().unwrap_or_else(|| next() >> (next() % 32))).collect()
}

/// Returns the initial words of each buffer: inputs are seeded, results are zero.
fn initial(program: &Bytecode) -> Vec<Vec<u32>> {
    let words = |buffer: &fragbuf_interpreter::Buffer| {
        if buffer.words == 0 || !buffer.name.contains("fixed") { LENGTH } else { buffer.words as usize }
    };
    let filled = |buffer: &fragbuf_interpreter::Buffer| match buffer.name.as_str() {
        "results" => vec![0; words(buffer)],
        _ => seeded(words(buffer)),
    };
    program.buffers.iter().map(filled).collect()
}

fn interpreted(source: &str, groups: [u32; 3]) -> (Bytecode, Vec<Vec<u32>>) {
    let (module, info) = device::parsed(source);
    let program = Bytecode::entry_point(&module, &info, "main", &Options::default()).unwrap();
    let mut buffers = initial(&program);
    let end = dispatch(&program, groups, &mut buffers);
    if let DispatchEnd::OutOfBounds(access) = end {
        let lines: Vec<u32> = program.trace(access.at).iter().map(|span| span.location(source).line_number).collect();
        panic!("out of bounds at lines {lines:?} of\n{source}");
    }
    assert_eq!(end, DispatchEnd::Ended);
    (program, buffers)
}

#[test]
fn a_device_leaves_the_same_words() {
    let features = wgpu::Features::SHADER_INT64 | wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS;
    let headless = Headless::open(&Choice::Cpu, features).unwrap();
    let mut differences = Vec::new();
    for (name, source, tolerance, groups) in CORPUS {
        let (program, ours) = interpreted(source, groups);
        let theirs = device::run(&headless, source, "main", &program, groups, &initial(&program));
        for (buffer, (ours, theirs)) in program.buffers.iter().zip(ours.iter().zip(&theirs)) {
            if buffer.binding.is_none() {
                continue;
            }
            for (at, (ours, theirs)) in
                ours.iter().zip(theirs).enumerate().filter(|(_, (a, b))| !agree(**a, **b, tolerance))
            {
                let floats = (f32::from_bits(*ours), f32::from_bits(*theirs));
                differences.push(format!(
                    "{name}: {}[{at}]: interpreter {ours:#x}, device {theirs:#x} ({floats:?})",
                    buffer.name
                ));
            }
        }
        assert!(ours.iter().flatten().any(|word| *word != 0), "{name} writes nothing");
    }
    assert!(differences.is_empty(), "{} words differ:\n{}", differences.len(), differences.join("\n"));
}

/// The same shaders in lanes. `tests/lanes.rs` has shaders whose lanes differ.
#[test]
fn lanes_leave_the_same_words() {
    for (name, source, _, groups) in CORPUS {
        let (program, expected) = interpreted(source, groups);
        let mut buffers = initial(&program);
        assert_eq!(dispatch_in_lanes(&program, groups, &mut buffers), DispatchEnd::Ended, "{name}");
        for (buffer, (found, expected)) in program.buffers.iter().zip(buffers.iter().zip(&expected)) {
            let different = (0..expected.len()).find(|at| found[*at] != expected[*at]);
            assert_eq!(different, None, "{name}: the first different word of {}", buffer.name);
        }
    }
}

/// GLSL on OpenGL leaves the words of the interpreter, too. The first values are computed by hand.
#[test]
fn printed_control_flow_leaves_the_same_words() {
    let (program, ours) = interpreted(CONTROL_FLOW, [1, 1, 1]);
    let of = |name: &str| program.buffers.iter().position(|buffer| buffer.name == name).unwrap();
    let expected = &ours[of("results")][..20];
    let (module, info) = device::parsed(CONTROL_FLOW);
    let options = fragbuf_glsl::Options {
        dialect: fragbuf_glsl::Dialect::OpenGl450,
        header: "",
        markers: &[],
        bindings: &|_, binding| fragbuf_glsl::Slot { set: 0, binding },
        plain_loads: &[],
        plain_functions: &[],
        written_first: &[],
        zero_workgroup_memory: false,
    };
    let unit = fragbuf_glsl::Unit::EntryPoint("main");
    let glsl = fragbuf_glsl::print(&module, &info, CONTROL_FLOW, unit, &options).unwrap();
    let context = fragbuf_opengl_host::Context::surfaceless()
        .unwrap_or_else(|error| panic!("{error}; install Debian's packages libegl1 and libgl1-mesa-dri"));
    let found = context.compute(&glsl, &initial(&program)[of("words")], expected.len(), 1).unwrap();
    assert_eq!(found, expected, "{glsl}");
    let by_hand = [415_099, 13, 14_966, 9016, 9, 3263, 5678, 810, 696, 2242, 41, 4, 5207];
    assert_eq!(expected[..by_hand.len()], by_hand);
}

fn agree(ours: u32, theirs: u32, tolerance: Tolerance) -> bool {
    match tolerance {
        Tolerance::Relative(part) => {
            let (ours, theirs) = (f32::from_bits(ours), f32::from_bits(theirs));
            (ours.is_nan() && theirs.is_nan()) || (ours - theirs).abs() <= part * ours.abs().max(theirs.abs()).max(1.0)
        }
        Tolerance::Exact => ours == theirs,
    }
}

/// Compiles the corpus of the GLSL printer, one shader per IR node, and lists the unsupported constructs.
#[test]
fn unsupported_nodes_are_named() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../emit/glsl/tests/corpus");
    let mut unsupported = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let source = std::fs::read_to_string(&path).unwrap();
        let options = naga::front::wgsl::Options { parse_doc_comments: true, capabilities: Capabilities::all() };
        let module = naga::front::wgsl::Frontend::new_with_options(options).parse(&source).unwrap();
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
        for entry in &module.entry_points {
            if let Err(errors) = Bytecode::entry_point(&module, &info, &entry.name, &Options::default()) {
                let constructs: std::collections::BTreeSet<String> =
                    errors.into_iter().map(|error| error.what).collect();
                let file = path.file_stem().unwrap().to_string_lossy().into_owned();
                unsupported.push(format!(
                    "{file} {}: {}",
                    entry.name,
                    constructs.into_iter().collect::<Vec<_>>().join("; ")
                ));
            }
        }
    }
    unsupported.sort();
    // Textures of two and three dimensions are read texel by texel; sampling and writing are unsupported.
    let shapes = "a texture that is not 2D or 3D; an unsupported variable; layers of textures; samplers; \
                  storage and external textures; writing textures";
    let known = [
        "fragment_io early: derivatives".to_owned(),
        format!("texture_shapes main: {shapes}"),
        format!("textures main: {shapes}"),
    ];
    assert_eq!(unsupported, known);
}

/// Frames of linked passes from fragbuf's snapshots, by technique: the word after size and first row in the uniform buffer
/// of the frame (k or the pool capacity), and the passes. The fragments are stored one after the other.
const FRAMES: [(&str, u32, &[&str]); 4] = [
    ("kplus_array", 8, &["reset", "store", "resolve"]),
    ("kb", 8, &["reset", "store", "resolve"]),
    ("ab_ll", 300, &["store", "resolve"]),
    ("ab_sb", 300, &["count", "scan_blocks", "scan_sums", "scan_add", "store", "resolve"]),
];

/// Replaces the rasteriser: one invocation emits the same fragments.
const DRAWN: &str = "
@compute @workgroup_size(1)
fn wrapped() {
    for (var i = 0u; i < 300u; i++) {
        let at = vec2<f32>(vec2<u32>(i * 7u % 5u, i * 3u % 4u)) + 0.5;
        let share = f32(i * 37u % 101u) / 128.0;
        FUNCTION(at, Fragment(vec4<f32>(share, 1.0 - share, 0.25, 0.5), share * share));
    }
}
";

/// `pass/resolve.wgsl` without the colour target. FINISH is the call of `sort_finish`, if the linker has not dropped it.
const RESOLVED: &str = "
@group(0) @binding(20) var<storage, read_write> shown: array<vec4<f32>>;
@compute @workgroup_size(1)
fn wrapped(@builtin(global_invocation_id) id: vec3<u32>) {
    resolved = pixel_index(vec2<f32>(id.xy) + 0.5);
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        sort_gather(resolve_read(cursor));
    }
    FINISH
    shown[resolved] = resolve_layers();
}
";

#[test]
fn a_device_leaves_the_same_words_after_every_pass_of_a_frame() {
    let headless = Headless::open(&Choice::Cpu, wgpu::Features::empty()).unwrap();
    for (technique, third, passes) in FRAMES {
        let mut memory = std::collections::BTreeMap::from([(0, vec![5, 4, 0, third])]);
        for pass in passes {
            let path = format!(
                "{}/../../../tests/snapshots/all__snapshots__{technique}.{pass}.wgsl.snap",
                env!("CARGO_MANIFEST_DIR")
            );
            let snapshot = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
            let source = snapshot.splitn(3, "---\n").nth(2).unwrap();
            let (source, entry, groups) = match *pass {
                "count" | "store" => (
                    format!("{source}{}", DRAWN.replace("FUNCTION", &format!("{pass}_fragment"))),
                    "wrapped",
                    [1, 1, 1],
                ),
                "resolve" => {
                    let finish = if source.contains("fn sort_finish") { "sort_finish();" } else { "" };
                    (format!("{source}{}", RESOLVED.replace("FINISH", finish)), "wrapped", [5, 4, 1])
                }
                other => (source.to_owned(), other, [1, 1, 1]),
            };
            let (module, info) = device::parsed(&source);
            let program = Bytecode::entry_point(&module, &info, entry, &Options::default()).unwrap();
            let binding_of = |buffer: &fragbuf_interpreter::Buffer| buffer.binding.map(|(_, binding)| binding);
            let mut ours: Vec<Vec<u32>> = program
                .buffers
                .iter()
                .map(|buffer| {
                    binding_of(buffer).and_then(|at| memory.get(&at).cloned()).unwrap_or_else(|| vec![0; LENGTH])
                })
                .collect();
            let theirs = device::run(&headless, &source, entry, &program, groups, &ours);
            assert_eq!(dispatch(&program, groups, &mut ours), DispatchEnd::Ended, "{technique} {pass}");
            for (buffer, (ours, theirs)) in program.buffers.iter().zip(ours.into_iter().zip(theirs)) {
                let Some(at) = binding_of(buffer) else { continue };
                let tolerance =
                    if buffer.name == "shown" { Tolerance::Relative(1.0 / 4096.0) } else { Tolerance::Exact };
                let differ = ours.iter().zip(&theirs).position(|(ours, theirs)| !agree(*ours, *theirs, tolerance));
                assert_eq!(differ, None, "{technique} {pass}: a word of {}", buffer.name);
                memory.insert(at, ours);
            }
        }
        assert!(memory[&20].iter().filter(|word| **word != 0).count() > 40, "{technique} shows nothing");
    }
}
