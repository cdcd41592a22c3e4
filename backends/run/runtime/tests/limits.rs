//! A device with the limits of a plan runs it, and a device with fewer storage buffers does not.

use fragbuf_codegen::Form;
use fragbuf_runtime::{Error, Renderer, Shaders, block_on};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;

use crate::stage::{settings, shaders, technique};

pub fn device(features: wgpu::Features, limits: wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    let backends = wgpu::Backends::VULKAN;
    let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor { backends, ..descriptor });
    let adapters = ready(instance.enumerate_adapters(backends));
    let is_cpu = |adapter: &wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    let adapter = adapters.into_iter().find(is_cpu).expect("these tests need a software driver");
    let descriptor =
        wgpu::DeviceDescriptor { required_features: features, required_limits: limits, ..Default::default() };
    ready(adapter.request_device(&descriptor)).unwrap()
}

/// Returns the result of a future of wgpu, which is ready at once on native devices.
pub fn ready<T>(future: impl Future<Output = T>) -> T {
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    match std::pin::pin!(future).poll(&mut context) {
        std::task::Poll::Ready(value) => value,
        std::task::Poll::Pending => panic!("wgpu waits"),
    }
}

fn renderer(shaders: &Shaders, limits: wgpu::Limits) -> Result<Renderer, Error> {
    let (device, queue) = device(shaders.features(), limits);
    block_on(&device, Renderer::new(&device, &queue, shaders, &settings())).unwrap()
}

#[test]
fn a_device_with_the_limits_of_a_plan_runs_it() {
    for key in ["z_buffer", "kb_ps", "kb_sr", "kb_mha", "kplus_array", "ab_ll_bun", "ab_sb", "kb_stream"] {
        let variant = technique(key, &[]);
        for target in ["wgsl", "wgsl-native"] {
            let shaders = shaders(&variant, target);
            let result = renderer(&shaders, shaders.limits());
            assert!(result.is_ok(), "{key}: {}", result.err().unwrap());
        }
    }
}

/// The number of storage buffers is the least that is sufficient.
#[test]
fn a_device_with_one_storage_buffer_less_does_not_run_it() {
    let shaders = shaders(&technique("kplus_array", &[("cull", "occupancy")]), "wgsl");
    let needed = fragbuf_targets::limits(&shaders.plan, 0, &[]);
    let needed = needed.iter().find(|limit| limit.is_of_webgpu("maxStorageBuffersPerShaderStage")).unwrap();
    let fragbuf_targets::Needed::Number(needed) = needed.needed else { panic!("{needed:?}") };
    let with = |count: u64| {
        let limits = wgpu::Limits { max_storage_buffers_per_shader_stage: count as u32, ..shaders.limits() };
        renderer(&shaders, limits).map(drop)
    };
    assert!(needed >= 3 && with(needed).is_ok(), "{needed}");
    let error = with(needed - 1).unwrap_err();
    assert!(matches!(error, Error::TooLarge { needed: found, .. } if found == needed), "{error}");
}

/// A generation without the requested target, or with a target that wgpu does not accept: the error names those that it runs.
#[test]
fn targets_that_do_not_run_name_others() {
    let targets = ["glsl", "hlsl", "spirv", "wgsl"].map(|name| target(name).unwrap());
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generation = generate(&technique("kplus_array", &[]), &request, &Registry::builtin()).unwrap();
    for name in ["glsl", "hlsl", "msl", "nothing"] {
        let error = Shaders::from_generation(&generation, name, 0).unwrap_err().to_string();
        assert!(
            error.contains("the runtime can run `spirv`, `wgsl`") || error.contains("`wgsl`, `spirv`"),
            "{name}: {error}"
        );
        assert!(!error.contains("`hlsl`, "), "{error}");
    }
    let request = Request { targets: &targets[..1], ..request };
    let generation = generate(&technique("kplus_array", &[]), &request, &Registry::builtin()).unwrap();
    let error = Shaders::from_generation(&generation, "glsl", 0).unwrap_err().to_string();
    assert!(error.contains("generate `wgsl`, `wgsl-native` or `spirv`"), "{error}");
}
