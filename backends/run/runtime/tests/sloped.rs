//! Triangles at any angle. A shader of this test appends the coverage and depth of every pixel to a list, and the techniques must
//! keep the best of exactly these fragments.

use fragbuf_runtime::Output;
use fragbuf_runtime::headless::{Headless, Offscreen};

use crate::capture::compare;
use crate::kept;
use crate::oracle::PLAIN;
use crate::order::Numbers;
use crate::quads::{Quad, SIZE};
use crate::stage::{FORMAT, FrameResult, device, read_buffers, read_counters, renderer, settings, shaders, technique};

const CAPTURE: &str = "
struct Corner { @location(0) position: vec3<f32>, @location(1) color: vec4<f32> }
struct Inside { @builtin(position) @invariant position: vec4<f32>, @location(0) color: vec4<f32> }
struct List { count: atomic<u32>, words: array<u32> }
@group(0) @binding(0) var<storage, read_write> list: List;
@vertex fn corner(corner: Corner) -> Inside { return Inside(vec4<f32>(corner.position, 1.0), corner.color); }
@fragment fn append(inside: Inside) {
    let at = 6u * atomicAdd(&list.count, 1u);
    list.words[at] = u32(inside.position.x);
    list.words[at + 1u] = u32(inside.position.y);
    list.words[at + 2u] = bitcast<u32>(inside.position.z);
    // Eight bits a channel, rounded to nearest.
    let color = vec4<u32>(floor(255.0 * clamp(inside.color, vec4<f32>(0.0), vec4<f32>(1.0)) + 0.5));
    list.words[at + 3u] = color.r | (color.g << 8u) | (color.b << 16u) | (color.a << 24u);
}";

/// The floats of a vertex: position and colour.
const FLOATS: usize = 7;
/// The bytes of the list.
const LIST: u64 = 4 + 24 * 4096;

/// Returns triangles with random corners and depths, some partly outside the frame.
fn triangles(count: u32, seed: u64) -> Vec<f32> {
    let mut numbers = Numbers::seeded(seed);
    let mut unit = || numbers.below(1 << 20) as f32 / (1 << 20) as f32;
    let corners =
        (0..3 * count).flat_map(|_| [2.4 * unit() - 1.2, 2.4 * unit() - 1.2, unit(), unit(), unit(), unit(), unit()]);
    corners.collect()
}

/// Returns every fragment of the triangles, as a quad over one pixel.
fn captured(stage: &Headless, vertices: &wgpu::Buffer, count: u32) -> Vec<Quad> {
    let Headless { device, queue, .. } = stage;
    let source = wgpu::ShaderSource::Wgsl(CAPTURE.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("capture"), source });
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x4];
    let array_stride = 4 * FLOATS as u64;
    let buffers =
        wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Vertex, attributes: &attributes };
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("capture"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(buffers)],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("append"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::TextureFormat::R8Unorm.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let make = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("list"),
            size: LIST,
            usage,
            mapped_at_creation: false,
        })
    };
    let list = make(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = make(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: list.as_entire_binding() }],
    });
    let target = Offscreen::new(device, wgpu::TextureFormat::R8Unorm, SIZE, SIZE).unwrap();
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
        let view = target.view();
        let attachment = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..3 * count, 0..1);
    }
    encoder.copy_buffer_to_buffer(&list, 0, &read, 0, LIST);
    queue.submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = read.get_mapped_range(..).unwrap();
    let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    assert!(words[0] < 4096, "the list is long enough");
    let fragment = |words: &[u32]| {
        let [x, y] = [words[0], words[1]];
        Quad::whole(f32::from_bits(words[2]), words[3].to_le_bytes()).at(x, y, x + 1, y + 1)
    };
    words[1..].chunks_exact(6).take(words[0] as usize).map(fragment).collect()
}

#[test]
fn every_technique_keeps_the_best_captured_fragments() {
    let stage = device();
    let techniques =
        [("kplus_array", "3"), ("kplus_array", "8"), ("kb", "3"), ("kb", "8"), ("ab_ll", "all"), ("ab_sb", "all")]
            .into_iter()
            .chain(["kplus_array_revised", "kb_ll", "kplus_ab_sb"].map(|key| (key, "3")));
    for seed in 0..4 {
        let count = 24;
        let bytes: Vec<u8> = triangles(count, seed).iter().flat_map(|float| float.to_le_bytes()).collect();
        let buffer = crate::stage::vertex_buffer(&stage, &bytes);
        let fragments = captured(&stage, &buffer, count);
        assert!(fragments.len() > 500, "{} fragments", fragments.len());
        for (key, k) in techniques.clone() {
            let mut renderer = renderer(&stage, &shaders(&technique(key, &[("k", k)]), "wgsl"), &settings()).unwrap();
            let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
            let [r, g, b] = crate::stage::BACKGROUND;
            let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }) };
            let draw = &mut |pass: &mut wgpu::RenderPass<'_>, _: &fragbuf_runtime::Call<'_>| {
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..3 * count, 0..1);
            };
            renderer.render(&output, draw).unwrap();
            let kept = kept::kept(&renderer, &read_buffers(&stage, &renderer), &fragments);
            let pixels = offscreen.colors(&stage.device, &stage.queue).unwrap();
            let seen = FrameResult { pixels, kept, counters: read_counters(&stage, &renderer) };
            compare(key, &seen, &PLAIN, &fragments, (renderer.k(), renderer.k()));
        }
    }
}
