//! The same shaders on a device and here: every word that they leave behind.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use fragbuf_interpreter::{Dispatch, Options, Program, dispatch};
use fragbuf_runtime::headless::{Choice, Headless};
use fragbuf_runtime::wgpu;
use fragbuf_runtime::wgpu::util::DeviceExt;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// How far words may be apart.
#[derive(Clone, Copy, PartialEq)]
enum Judge {
    Bits,
    /// As floats, by this part of the larger one's size.
    Floats(f32),
}

/// Words of a buffer whose length the shader does not say.
const LENGTH: usize = 4096;

const CORPUS: [(&str, &str, Judge, [u32; 3]); 7] = [
    ("whole_numbers", include_str!("corpus/whole_numbers.wgsl"), Judge::Bits, [1, 1, 1]),
    ("floats", include_str!("corpus/floats.wgsl"), Judge::Bits, [1, 1, 1]),
    ("functions_of_floats", include_str!("corpus/functions_of_floats.wgsl"), Judge::Floats(1.0 / 2048.0), [1, 1, 1]),
    ("memory", include_str!("corpus/memory.wgsl"), Judge::Bits, [1, 1, 1]),
    ("atomics", include_str!("corpus/atomics.wgsl"), Judge::Bits, [1, 1, 1]),
    ("workgroups", include_str!("corpus/workgroups.wgsl"), Judge::Bits, [2, 3, 1]),
    ("wide_numbers", include_str!("corpus/wide_numbers.wgsl"), Judge::Bits, [1, 1, 1]),
];

fn parsed(text: &str) -> (naga::Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
    (module, info)
}

/// Numbers with everything in them: small, large, zero, sign bits.
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

/// What each buffer of the program holds before: inputs are seeded, results are zero.
fn before(program: &Program) -> Vec<Vec<u32>> {
    let words = |buffer: &fragbuf_interpreter::Buffer| {
        if buffer.words == 0 || !buffer.name.contains("fixed") { LENGTH } else { buffer.words as usize }
    };
    let filled = |buffer: &fragbuf_interpreter::Buffer| match buffer.name.as_str() {
        "results" => vec![0; words(buffer)],
        _ => seeded(words(buffer)),
    };
    program.buffers.iter().map(filled).collect()
}

fn interpreted(text: &str, groups: [u32; 3]) -> (Program, Vec<Vec<u32>>) {
    let (module, info) = parsed(text);
    let program = Program::entry_point(&module, &info, "main", &Options::default()).unwrap();
    let mut buffers = before(&program);
    let end = dispatch(&program, groups, &mut buffers);
    if let Dispatch::Fault(fault) = end {
        let lines: Vec<u32> = program.trace(fault.at).iter().map(|span| span.location(text).line_number).collect();
        panic!("out of bounds at lines {lines:?} of\n{text}");
    }
    assert_eq!(end, Dispatch::Ended);
    (program, buffers)
}

/// What a device makes of `before`, in the program's order of buffers.
fn on_device(
    headless: &Headless,
    text: &str,
    entry: &str,
    program: &Program,
    groups: [u32; 3],
    before: &[Vec<u32>],
) -> Vec<Vec<u32>> {
    let device = &headless.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_SRC;
    let bytes = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let buffers: Vec<(Option<u32>, wgpu::Buffer)> = program
        .buffers
        .iter()
        .zip(before)
        .map(|(buffer, words)| {
            let contents = bytes(words);
            let init = wgpu::util::BufferInitDescriptor { label: None, contents: &contents, usage: storage };
            (buffer.binding.map(|(_, binding)| binding), device.create_buffer_init(&init))
        })
        .collect();
    let entries: Vec<wgpu::BindGroupEntry<'_>> = buffers
        .iter()
        .filter_map(|(binding, buffer)| {
            Some(wgpu::BindGroupEntry { binding: (*binding)?, resource: buffer.as_entire_binding() })
        })
        .collect();
    let layout = pipeline.get_bind_group_layout(0);
    let group =
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(groups[0], groups[1], groups[2]);
    }
    let read: Vec<wgpu::Buffer> = buffers
        .iter()
        .map(|(_, buffer)| {
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let descriptor =
                wgpu::BufferDescriptor { label: None, size: buffer.size(), usage, mapped_at_creation: false };
            let copy = device.create_buffer(&descriptor);
            encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
            copy
        })
        .collect();
    headless.queue.submit([encoder.finish()]);
    read.iter().for_each(|buffer| buffer.slice(..).map_async(wgpu::MapMode::Read, |result| result.unwrap()));
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let words = |buffer: &wgpu::Buffer| {
        let view = buffer.slice(..).get_mapped_range().unwrap();
        view.chunks_exact(4).map(|bytes| u32::from_le_bytes(bytes.try_into().unwrap())).collect()
    };
    read.iter().map(words).collect()
}

#[test]
fn a_device_leaves_the_same_words() {
    let features = wgpu::Features::SHADER_INT64 | wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS;
    let headless = Headless::open(&Choice::Cpu, features).unwrap();
    let mut faults = Vec::new();
    for (name, text, judge, groups) in CORPUS {
        let (program, ours) = interpreted(text, groups);
        let theirs = on_device(&headless, text, "main", &program, groups, &before(&program));
        for (buffer, (ours, theirs)) in program.buffers.iter().zip(ours.iter().zip(&theirs)) {
            if buffer.binding.is_none() {
                continue;
            }
            for (at, (own, other)) in ours.iter().zip(theirs).enumerate().filter(|(_, (a, b))| !agree(**a, **b, judge))
            {
                let floats = (f32::from_bits(*own), f32::from_bits(*other));
                faults.push(format!("{name}: {}[{at}]: {own:#x} here, {other:#x} there ({floats:?})", buffer.name));
            }
        }
        assert!(ours.iter().flatten().any(|word| *word != 0), "{name} writes nothing");
    }
    assert!(faults.is_empty(), "{} words:\n{}", faults.len(), faults.join("\n"));
}

fn agree(own: u32, other: u32, judge: Judge) -> bool {
    match judge {
        Judge::Floats(part) => {
            let (own, other) = (f32::from_bits(own), f32::from_bits(other));
            (own.is_nan() && other.is_nan()) || (own - other).abs() <= part * own.abs().max(other.abs()).max(1.0)
        }
        Judge::Bits => own == other,
    }
}

/// The printer's corpus, one shader per node: what is not run is named.
#[test]
fn every_other_node_is_refused_by_name() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../emit/glsl/tests/corpus");
    let mut refused = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let options = naga::front::wgsl::Options { parse_doc_comments: true, capabilities: Capabilities::all() };
        let module = naga::front::wgsl::Frontend::new_with_options(options).parse(&text).unwrap();
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
        for entry in &module.entry_points {
            if let Err(faults) = Program::entry_point(&module, &info, &entry.name, &Options::default()) {
                let what: std::collections::BTreeSet<String> = faults.into_iter().map(|fault| fault.what).collect();
                let file = path.file_stem().unwrap().to_string_lossy().into_owned();
                refused.push(format!("{file} {}: {}", entry.name, what.into_iter().collect::<Vec<_>>().join("; ")));
            }
        }
    }
    refused.sort();
    // Flat textures are read texel by texel; nothing is sampled or written.
    let shapes = "a texture that is not flat; a variable that was refused; layers of textures; samplers";
    let known = [
        "fragment_io early: derivatives".to_owned(),
        format!("texture_shapes main: {shapes}; writing textures"),
        format!("textures main: {shapes}; storage and external textures; writing textures"),
    ];
    assert_eq!(refused, known);
}

/// Frames of fragbuf's own linked passes, by the names of their snapshots, and what follows size and first row in the frame's uniform
/// buffer: entries, or room. Fragments go in one after the other.
const FRAMES: [(&str, u32, &[&str]); 4] = [
    ("kplus_array", 8, &["reset", "store", "resolve"]),
    ("kb", 8, &["reset", "store", "resolve"]),
    ("ab_ll", 300, &["store", "resolve"]),
    ("ab_sb", 300, &["count", "scan_blocks", "scan_sums", "scan_add", "store", "resolve"]),
];

/// What stands in for the rasteriser: the same fragments, from one invocation.
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

/// `pass/resolve.wgsl` without the target, for sorts that are finished once all is gathered.
const RESOLVED: &str = "
@group(0) @binding(20) var<storage, read_write> shown: array<vec4<f32>>;
@compute @workgroup_size(1)
fn wrapped(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = pixel_index(vec2<f32>(id.xy) + 0.5);
    gathered = 0u;
    var cursor = storage_first(pixel);
    while cursor != END {
        sort_gather(storage_read(pixel, cursor));
        cursor = storage_next(pixel, cursor);
    }
    shown[pixel] = resolve_layers();
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
            let text = snapshot.splitn(3, "---\n").nth(2).unwrap();
            let (text, entry, groups) = match *pass {
                "count" | "store" => {
                    (format!("{text}{}", DRAWN.replace("FUNCTION", &format!("{pass}_fragment"))), "wrapped", [1, 1, 1])
                }
                "resolve" => (format!("{text}{RESOLVED}"), "wrapped", [5, 4, 1]),
                other => (text.to_owned(), other, [1, 1, 1]),
            };
            let (module, info) = parsed(&text);
            let program = Program::entry_point(&module, &info, entry, &Options::default()).unwrap();
            let home = |buffer: &fragbuf_interpreter::Buffer| buffer.binding.map(|(_, binding)| binding);
            let mut ours: Vec<Vec<u32>> = program
                .buffers
                .iter()
                .map(|buffer| home(buffer).and_then(|at| memory.get(&at).cloned()).unwrap_or_else(|| vec![0; LENGTH]))
                .collect();
            let theirs = on_device(&headless, &text, entry, &program, groups, &ours);
            assert_eq!(dispatch(&program, groups, &mut ours), Dispatch::Ended, "{technique} {pass}");
            for (buffer, (ours, theirs)) in program.buffers.iter().zip(ours.into_iter().zip(theirs)) {
                let Some(at) = home(buffer) else { continue };
                let judge = if buffer.name == "shown" { Judge::Floats(1.0 / 4096.0) } else { Judge::Bits };
                let differ = ours.iter().zip(&theirs).position(|(own, other)| !agree(*own, *other, judge));
                assert_eq!(differ, None, "{technique} {pass}: a word of {}", buffer.name);
                memory.insert(at, ours);
            }
        }
        assert!(memory[&20].iter().filter(|word| **word != 0).count() > 40, "{technique} shows nothing");
    }
}
