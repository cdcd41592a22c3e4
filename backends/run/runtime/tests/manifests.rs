//! Pipelines from a manifest alone: wgpu judges the layouts that it describes, and the features that it requires.

use std::collections::BTreeSet;

use fragbuf_codegen::Form;
use fragbuf_runtime::Shaders;
use fragbuf_targets::{Generation, Request, generate, manifest, target};
use fragbuf_templates::Registry;
use serde_json::Value;

use crate::limits::{device, ready};
use crate::stage::technique;

fn generation(key: &str, target_name: &str) -> Option<Generation> {
    let request = Request { targets: &[target(target_name).unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&technique(key, &[]), &request, &Registry::builtin()).unwrap();
    (!generation.plans.is_empty()).then_some(generation)
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("{value} is no text"))
}

/// A bind group layout as the bindings of a pass describe it. Each buffer has the least size that the manifest gives.
fn layout(device: &wgpu::Device, manifest: &Value, pass: &Value) -> wgpu::BindGroupLayout {
    let entry = |binding: &Value| {
        let name = &binding["name"];
        let stages = list(&binding["stages"]).map(|stage| match text(stage) {
            "vertex" => wgpu::ShaderStages::VERTEX,
            "fragment" => wgpu::ShaderStages::FRAGMENT,
            "compute" => wgpu::ShaderStages::COMPUTE,
            other => panic!("{other}"),
        });
        let buffer = |ty: wgpu::BufferBindingType| {
            let blocks = list(&manifest["uniform_blocks"]).map(|block| (&block["name"], &block["bytes"]));
            let resources = list(&manifest["resources"]).map(|resource| (&resource["name"], &resource["least_bytes"]));
            let (_, bytes) = blocks.chain(resources).find(|(known, _)| *known == name).unwrap();
            let min_binding_size = wgpu::BufferSize::new(bytes.as_u64().unwrap());
            wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size }
        };
        let ty = match text(&binding["type"]) {
            "uniform" => buffer(wgpu::BufferBindingType::Uniform),
            "storage" => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
            "read-only-storage" => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
            "texture" => wgpu::BindingType::Texture {
                sample_type: match text(&binding["sample_type"]) {
                    "float" => wgpu::TextureSampleType::Float { filterable: true },
                    "unfilterable-float" => wgpu::TextureSampleType::Float { filterable: false },
                    "uint" => wgpu::TextureSampleType::Uint,
                    "depth" => wgpu::TextureSampleType::Depth,
                    other => panic!("{other}"),
                },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: binding["multisampled"].as_bool().unwrap(),
            },
            other => panic!("{other}"),
        };
        let visibility = stages.fold(wgpu::ShaderStages::NONE, |all, stage| all | stage);
        wgpu::BindGroupLayoutEntry { binding: binding["binding"].as_u64().unwrap() as u32, visibility, ty, count: None }
    };
    let entries: Vec<wgpu::BindGroupLayoutEntry> = list(&pass["bindings"]).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

fn format(manifest: &Value, name: &Value) -> wgpu::TextureFormat {
    let resource = list(&manifest["resources"]).find(|resource| resource["name"] == *name);
    match resource.map_or("rgba16float", |resource| text(&resource["texture"]["format"])) {
        "r32uint" => wgpu::TextureFormat::R32Uint,
        "rg16uint" => wgpu::TextureFormat::Rg16Uint,
        "r32float" => wgpu::TextureFormat::R32Float,
        "rg32float" => wgpu::TextureFormat::Rg32Float,
        "rgba8unorm" => wgpu::TextureFormat::Rgba8Unorm,
        "rgba16float" => wgpu::TextureFormat::Rgba16Float,
        "depth32float" => wgpu::TextureFormat::Depth32Float,
        "depth24plus-stencil8" => wgpu::TextureFormat::Depth24PlusStencil8,
        other => panic!("{other}"),
    }
}

fn factor(name: &Value) -> wgpu::BlendFactor {
    match text(name) {
        "zero" => wgpu::BlendFactor::Zero,
        "one" => wgpu::BlendFactor::One,
        "one-minus-src-alpha" => wgpu::BlendFactor::OneMinusSrcAlpha,
        "one-minus-dst-alpha" => wgpu::BlendFactor::OneMinusDstAlpha,
        other => panic!("{other}"),
    }
}

fn target_state(manifest: &Value, target: &Value) -> wgpu::ColorTargetState {
    let blend = &target["blend"];
    let component = || wgpu::BlendComponent {
        src_factor: factor(&blend["source"]),
        dst_factor: factor(&blend["destination"]),
        operation: match text(&blend["operation"]) {
            "add" => wgpu::BlendOperation::Add,
            "min" => wgpu::BlendOperation::Min,
            "max" => wgpu::BlendOperation::Max,
            other => panic!("{other}"),
        },
    };
    let blend = (!blend.is_null()).then(|| wgpu::BlendState { color: component(), alpha: component() });
    wgpu::ColorTargetState { format: format(manifest, &target["resource"]), blend, write_mask: wgpu::ColorWrites::ALL }
}

/// Creates the pipeline of a pass: the files, the layout, the formats of targets and tests, and the samples.
fn create(device: &wgpu::Device, generation: &Generation, manifest: &Value, pass: &Value) {
    let files: Vec<&Value> = list(&manifest["files"]).filter(|file| file["pass"] == pass["pass"]).collect();
    let path = text(&files[0]["path"]);
    let file = generation.files.iter().find(|file| file.path == path).unwrap();
    let source = wgpu::ShaderSource::Wgsl(std::str::from_utf8(&file.bytes).unwrap().into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let entry = |stage: &str| files.iter().find(|file| file["stage"] == stage).map(|file| text(&file["entry_point"]));
    let layout = layout(device, manifest, pass);
    let layouts = [Some(&layout)];
    let descriptor = wgpu::PipelineLayoutDescriptor { label: None, bind_group_layouts: &layouts, immediate_size: 0 };
    let layout = device.create_pipeline_layout(&descriptor);
    if pass["kind"] == "compute" {
        let _ = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &module,
            entry_point: entry("compute"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        return;
    }
    let state = &pass["state"];
    let mut targets: Vec<_> = list(&state["targets"]).map(|target| Some(target_state(manifest, target))).collect();
    let tested = [&state["depth"], &state["stencil"]].into_iter().find(|test| !test.is_null());
    if targets.is_empty() && tested.is_none() {
        let format = wgpu::TextureFormat::R8Unorm;
        targets.push(Some(wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::empty() }));
    }
    let mut multisample = wgpu::MultisampleState::default();
    if state["samples"].is_object() {
        // Every WebGPU device has 4 samples, and portable plans have no others.
        multisample.count = 4;
    }
    let mut attributes = Vec::new();
    let mut stride = 0;
    for input in list(&manifest["vertex_inputs"]).filter(|_| pass["kind"] == "geometry") {
        let (format, bytes) = match text(&input["type"]) {
            "f32" => (wgpu::VertexFormat::Float32, 4),
            "u32" => (wgpu::VertexFormat::Uint32, 4),
            "vec2<f32>" => (wgpu::VertexFormat::Float32x2, 8),
            "vec3<f32>" => (wgpu::VertexFormat::Float32x3, 12),
            "vec4<f32>" => (wgpu::VertexFormat::Float32x4, 16),
            other => panic!("{other}"),
        };
        let shader_location = input["location"].as_u64().unwrap() as u32;
        attributes.push(wgpu::VertexAttribute { format, offset: stride, shader_location });
        stride += bytes;
    }
    let step_mode = wgpu::VertexStepMode::Vertex;
    let buffers = [Some(wgpu::VertexBufferLayout { array_stride: stride, step_mode, attributes: &attributes })];
    let depth_stencil = tested.map(|test| wgpu::DepthStencilState {
        format: format(manifest, &test["resource"]),
        depth_write_enabled: Some(state["depth"]["write"] == true),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    });
    let _ = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: entry("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: if stride == 0 { &[] } else { &buffers },
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil,
        multisample,
        fragment: entry("fragment").map(|entry_point| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    });
}

#[test]
fn layouts_of_manifests_fit_their_text() {
    let mut passes = 0;
    for technique in Registry::builtin().techniques() {
        let Some(generation) = generation(&technique.key, "wgsl") else { continue };
        let shaders = Shaders::from_generation(&generation, "wgsl", 0).unwrap();
        let (device, _) = device(shaders.features(), shaders.limits());
        let manifest = manifest(&generation, 0);
        for pass in list(&manifest["steps"]).filter(|step| step["do"] == "pass") {
            let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
            create(&device, &generation, &manifest, pass);
            let error = ready(scope.pop());
            assert!(error.is_none(), "{}, {}: {}", technique.key, pass["pass"], error.unwrap());
            passes += 1;
        }
    }
    assert!(passes > 90, "{passes} passes");
}

/// A layout with one binding less, or with a buffer of the other kind, does not fit: the judge above is no rubber stamp.
#[test]
fn layouts_of_broken_manifests_do_not_fit() {
    let generation = generation("kb_sr", "wgsl").unwrap();
    let shaders = Shaders::from_generation(&generation, "wgsl", 0).unwrap();
    let (device, _) = device(shaders.features(), shaders.limits());
    let manifest = manifest(&generation, 0);
    let pass = list(&manifest["steps"]).find(|step| step["pass"] == "resolve").unwrap();
    let changes: [(&str, Value); 4] = [
        ("/bindings/1/type", "read-only-storage".into()),
        ("/bindings/1/stages/0", "vertex".into()),
        ("/bindings/2/multisampled", false.into()),
        ("/bindings/2/sample_type", "unfilterable-float".into()),
    ];
    for (pointer, value) in changes {
        let mut broken = pass.clone();
        *broken.pointer_mut(pointer).unwrap() = value;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        create(&device, &generation, &manifest, &broken);
        assert!(ready(scope.pop()).is_some(), "{pointer}");
    }
    let mut broken = pass.clone();
    broken["bindings"].as_array_mut().unwrap().pop();
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    create(&device, &generation, &manifest, &broken);
    assert!(ready(scope.pop()).is_some());
}

/// The features that a manifest requires of wgpu are those that the runtime requests.
#[test]
fn features_of_manifests_are_those_of_the_runtime() {
    let mut seen = BTreeSet::new();
    for technique in Registry::builtin().techniques() {
        for target in ["wgsl", "wgsl-native"] {
            let Some(generation) = generation(&technique.key, target) else { continue };
            let shaders = Shaders::from_generation(&generation, target, 0).unwrap();
            let manifest = manifest(&generation, 0);
            let listed: BTreeSet<&str> = list(&manifest["requires"][target]["features"]).map(text).collect();
            let requested: BTreeSet<&str> = shaders.features().iter_names().map(|(name, _)| name).collect();
            assert_eq!(listed, requested, "{}, {target}", technique.key);
            seen.extend(shaders.features().iter_names().map(|(name, _)| name));
        }
    }
    assert_eq!(seen.len(), 4, "{seen:?}");
}
