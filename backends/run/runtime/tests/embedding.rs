//! The module form: the caller's material shader in the caller's pipeline ends with a call of `store_fragment`.

use fragbuf_codegen::{Form, Linking, Profile, link};
use fragbuf_runtime::headless::Offscreen;
use fragbuf_runtime::{GeometryPass, Output, Renderer, Shaders};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;

use crate::kept;
use crate::oracle::{PLAIN, kept_words};
use crate::quads::{Quad, SIZE};
use crate::stage::{FORMAT, device, read_buffers, renderer, settings, technique};

/// The bind group of fragbuf's buffers; those of the caller are in group 0.
const GROUP: u32 = 1;

/// A material: quads over the whole frame, with colours and depths from a buffer of the caller.
const MATERIAL: &str = "
struct Sheet { color: vec4<f32>, depth: f32 }
@group(0) @binding(0) var<storage, read> sheets: array<Sheet>;
struct Shaded { @builtin(position) at: vec4<f32>, @location(0) @interpolate(flat) sheet: u32 }
@vertex fn material_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) sheet: u32) -> Shaded {
    let corner = vec2<f32>(vec2<u32>(vertex & 1u, vertex >> 1u));
    return Shaded(vec4<f32>(4.0 * corner - 1.0, sheets[sheet].depth, 1.0), sheet);
}
@fragment fn material_fragment(shaded: Shaded) {
    store_fragment(shaded.at.xy, Fragment(sheets[shaded.sheet].color, shaded.at.z));
}";

fn sheets() -> Vec<Quad> {
    (0..6u8).map(|index| Quad::whole(f32::from(index * 5 % 6) / 8.0, [40 * index, 255 - 9 * index, 7, 100])).collect()
}

fn pipeline(
    device: &wgpu::Device,
    renderer: &Renderer,
    pass: &GeometryPass,
    material_layout: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(format!("{}\n{MATERIAL}", pass.source).into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("material"), source });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(material_layout), renderer.bind_group_layout(&pass.name)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("material"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("material_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("material_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &pass.targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[test]
fn a_material_of_the_caller_stores_fragments() {
    let stage = device();
    let device = &stage.device;
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Module, prefix: "", group: GROUP };
    let variant = technique("kplus_array", &[("k", "3")]);
    let generation =
        generate(&variant, &request, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let shaders = Shaders::from_generation(&generation, "wgsl", GROUP).unwrap();
    let mut renderer = renderer(&stage, &shaders, &settings()).unwrap();

    let words =
        sheets().iter().flat_map(|quad| [quad.rgba(), [quad.depth, 0.0, 0.0, 0.0]]).flatten().collect::<Vec<f32>>();
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    let size = bytes.len() as u64;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    stage.queue.write_buffer(&buffer, 0, &bytes);
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    });
    let passes: Vec<GeometryPass> = renderer.geometry_passes().cloned().collect();
    let names: Vec<_> = passes.iter().map(|pass| (pass.name.as_str(), pass.function.as_str())).collect();
    assert_eq!(names, [("store", "store_fragment")]);
    let material = pipeline(device, &renderer, &passes[0], &layout);

    let offscreen = Offscreen::new(device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
    let draw = &mut |pass: &mut wgpu::RenderPass<'_>, _: &fragbuf_runtime::Call<'_>| {
        pass.set_pipeline(&material);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..sheets().len() as u32);
    };
    renderer.render(&output, draw).unwrap();
    let kept = kept::kept(&renderer, &read_buffers(&stage, &renderer), &sheets());
    assert_eq!(kept, kept_words(&PLAIN, &sheets(), Some(3)));
}

/// Both constructors of shaders give the same passes, in the order of a frame, with the samples that the description chooses.
#[test]
fn geometry_passes_have_their_functions_and_samples() {
    let stage = device();
    let registry = Registry::builtin();
    let variant = technique("ab_sb", &[("samples", "coverage")]);
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Module, prefix: "glass", group: GROUP };
    let generation = generate(&variant, &request, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let plan = &generation.plans[0].plan;
    let linking = Linking { profile: Profile::Portable, form: Form::Module, prefix: "glass".to_owned(), group: GROUP };
    let program = link(plan, &linking, &registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    let shaders =
        [Shaders::from_generation(&generation, "wgsl", GROUP).unwrap(), Shaders::from_program(plan, &program)];
    let [generated, linked] = shaders.map(|shaders| {
        let renderer = renderer(&stage, &shaders, &settings()).unwrap();
        renderer.geometry_passes().cloned().collect::<Vec<_>>()
    });
    assert_eq!(generated, linked);
    let found: Vec<_> = linked.iter().map(|pass| (&*pass.name, &*pass.function, pass.multisample.count)).collect();
    assert_eq!(found, [("count", "glass_count_fragment", 4), ("store", "glass_store_fragment", 4)]);
    let plain =
        Shaders::from_program(plan, &link(plan, &Linking { form: Form::Program, ..linking }, &registry).unwrap());
    assert_eq!(renderer(&stage, &plain, &settings()).unwrap().geometry_passes().count(), 0);
}
