//! Errors say what is wrong, by how much, and how to fix it; the renderer stays unchanged.

use fragbuf_runtime::headless::{Choice, Headless, Offscreen};
use fragbuf_runtime::{
    Code, Error, Interlock, Output, PoolSize, Recorded, Renderer, Settings, Sizing, Value, block_on,
};
use fragbuf_templates::vocabulary::{Access, Use};

use crate::quads::{Quad, SIZE};
use crate::stage::{FORMAT, device, draw_over, render_frame, renderer, settings, shaders, technique};

fn fresh() -> Headless {
    Headless::open(&Choice::Cpu, wgpu::Features::empty()).unwrap()
}

fn message<T>(result: Result<T, Error>) -> String {
    result.err().expect("this fails").to_string()
}

#[test]
fn the_error_for_a_resource_beyond_the_limit_has_name_size_and_fix() {
    let stage = device();
    let whole = Settings { slice: Some(u32::MAX), ..settings() };
    let mut renderer = renderer(&stage, &shaders(&technique("kplus_array", &[("k", "64")]), "wgsl"), &whole).unwrap();
    let before = (renderer.allocated_bytes(), renderer.symbol("width"));
    let limit = stage.device.limits().max_storage_buffer_binding_size.min(stage.device.limits().max_buffer_size);
    let side = stage.device.limits().max_texture_dimension_2d;
    let bytes = 4 * 64 * u64::from(side) * u64::from(side);
    let error = block_on(&stage.device, renderer.resize(side, side)).unwrap().unwrap_err();
    let Error::TooLarge { what, needed, limit: reported, .. } = &error else { panic!("{error}") };
    assert_eq!((what.as_str(), *needed, *reported), ("`keys`", bytes, limit));
    assert!(error.to_string().contains("smaller frame"), "{error}");
    assert_eq!((renderer.allocated_bytes(), renderer.symbol("width")), before);
    let quads = [Quad::whole(0.5, [1, 2, 3, 4])];
    assert!(render_frame(&stage, &mut renderer, &quads).kept.iter().all(|kept| kept.len() == 1));
    let error = block_on(&stage.device, renderer.resize(side + 1, 1)).unwrap().unwrap_err();
    assert!(error.to_string().contains("max_texture_dimension_2d"), "{error}");
}

#[test]
fn a_pool_beyond_the_limit_is_rejected_before_allocation() {
    let stage = device();
    let settings = Settings { sizing: Sizing::Reserve(PoolSize::Fragments(u32::MAX)), ..settings() };
    let error = message(renderer(&stage, &shaders(&technique("ab_ll", &[]), "wgsl"), &settings));
    assert!(error.contains("`links`") && error.contains("reserve less"), "{error}");
}

#[test]
fn exact_sizing_without_a_count_suggests_to_reserve() {
    let stage = device();
    let settings = Settings { sizing: Sizing::Exact, ..settings() };
    let error = message(renderer(&stage, &shaders(&technique("ab_ll", &[]), "wgsl"), &settings));
    assert!(error.contains("`fragments`") && error.contains("Sizing::Capacity"), "{error}");
}

#[test]
fn interlock_is_rejected_on_a_device_without_it() {
    let stage = device();
    let shaders = shaders(&technique("kplus_array", &[("sync", "interlock")]), "spirv");
    assert_eq!(shaders.check_interlock(Interlock::Enabled), Ok(()));
    let settings = Settings { interlock: Interlock::Absent, ..settings() };
    let error = message(renderer(&stage, &shaders, &settings));
    assert!(error.contains("interlock") && error.contains("else spin_lock"), "{error}");
}

#[test]
fn missing_features_are_named() {
    let stage = device();
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let adapters = wgpu::Instance::new(descriptor).enumerate_adapters(wgpu::Backends::PRIMARY);
    let adapters = block_on(&stage.device, adapters).unwrap();
    let request = adapters[0].request_device(&wgpu::DeviceDescriptor::default());
    let (plain, queue) = block_on(&stage.device, request).unwrap().unwrap();
    for (target, feature) in [("spirv", "PASSTHROUGH_SHADERS"), ("wgsl-native", "MEMORY_DECORATION_COHERENT")] {
        let shaders = shaders(&technique("kplus_array", &[]), target);
        let error = message(block_on(&plain, Renderer::new(&plain, &queue, &shaders, &settings())).unwrap());
        assert!(error.contains(feature), "{error}");
    }
}

/// The caller draws the scene, so a plan cannot give the arguments of that draw.
#[test]
fn unsupported_passes_are_named() {
    let stage = device();
    let mut shaders = shaders(&technique("kplus_array", &[]), "wgsl");
    let store = shaders.plan.passes.iter_mut().find(|pass| pass.name == "store").unwrap();
    store.pass.uses.push(Use::new("locks", Access::Indirect));
    let error = message(renderer(&stage, &shaders, &settings()));
    assert!(error.contains("pass `store`: `locks` as Indirect"), "{error}");
}

#[test]
fn mismatched_code_and_settings_are_errors() {
    let stage = device();
    let good = shaders(&technique("kplus_array", &[]), "wgsl");
    let mut broken = good.clone();
    broken.modules[1].code = Code::Wgsl("fn store() { this is no WGSL }".to_owned());
    assert!(message(renderer(&stage, &broken, &settings())).contains("shader of pass `store`"));
    let mut without = good.clone();
    without.modules.retain(|module| module.pass != "resolve");
    let error = message(renderer(&stage, &without, &settings()));
    assert_eq!(error, "the shaders have no vertex entry point for pass `resolve`");
    let unblendable = Settings { target: wgpu::TextureFormat::Rgba32Uint, ..settings() };
    assert!(message(renderer(&stage, &good, &unblendable)).contains("pipeline of pass `resolve`"));
    let empty = Settings { width: 0, ..settings() };
    assert_eq!(message(renderer(&stage, &good, &empty)), "the frame's width must be at least 1");
}

#[test]
fn an_output_of_another_size_is_never_written_beyond_the_frame() {
    let stage = device();
    let mut renderer = renderer(&stage, &shaders(&technique("kplus_array", &[]), "wgsl"), &settings()).unwrap();
    let quads = [Quad::whole(0.5, [255, 255, 255, 255])];
    let greater = Offscreen::new(&stage.device, FORMAT, SIZE + 5, SIZE + 3).unwrap();
    // Clip space covers the attachment of the geometry pass only.
    draw_over(&stage, &mut renderer, &quads, &greater).unwrap();
    for (index, [r, ..]) in greater.colors(&stage.device, &stage.queue).unwrap().into_iter().enumerate() {
        let (x, y) = (index as u32 % (SIZE + 5), index as u32 / (SIZE + 5));
        assert_eq!(r == 1.0, x < SIZE && y < SIZE, "pixel {x}, {y}");
    }
    let smaller = Offscreen::new(&stage.device, FORMAT, SIZE - 1, SIZE).unwrap();
    assert!(message(draw_over(&stage, &mut renderer, &quads, &smaller)).contains("wgpu rejects the frame's commands"));
    assert!(
        render_frame(&stage, &mut renderer, &quads).kept.iter().all(|kept| kept.len() == 1),
        "the next frame succeeds"
    );
}

#[test]
fn values_out_of_range_are_rejected() {
    let stage = device();
    let mut array = renderer(&stage, &shaders(&technique("kplus_array", &[("k", "5")]), "wgsl"), &settings()).unwrap();
    for k in [0, 9] {
        assert!(message(block_on(&stage.device, array.set_k(k)).unwrap()).contains("from 1 to the capacity, 8"));
    }
    assert!(message(array.set_uniform("cut", Value::F32(1.0))).contains("uniform `cut`"));
    let mut list = renderer(&stage, &shaders(&technique("ab_ll", &[]), "wgsl"), &settings()).unwrap();
    assert!(message(block_on(&stage.device, list.set_k(3)).unwrap()).contains("keeps every fragment"));
}

#[test]
fn stale_frames_and_unsubmitted_segments_are_errors() {
    let stage = device();
    let mut renderer = renderer(&stage, &shaders(&technique("ab_sb", &[]), "wgsl"), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Load };
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let stale = renderer.begin().unwrap();
    let frame = renderer.begin().unwrap();
    assert_eq!(stale.record(&renderer, &mut encoder, &output, &mut |_, _| {}).err(), Some(Error::StaleFrame));
    let recorded = frame.record(&renderer, &mut encoder, &output, &mut |_, _| {}).unwrap();
    let Recorded::Suspended(suspended) = recorded else { panic!("the plan has a host step") };
    assert_eq!(block_on(&stage.device, suspended.resume(&mut renderer)).err(), Some(Error::NotSubmitted));
    assert!(render_frame(&stage, &mut renderer, &[]).kept.iter().all(Vec::is_empty), "the next frame succeeds");
}

#[test]
fn a_lost_device_is_an_error() {
    let stage = fresh();
    let mut renderer = renderer(&stage, &shaders(&technique("ab_sb", &[]), "wgsl"), &settings()).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Load };
    let frame = renderer.begin().unwrap();
    stage.device.destroy();
    assert_eq!(renderer.render(&output, &mut |_, _| {}), Err(Error::DeviceLost));
    assert_eq!(renderer.begin().err(), Some(Error::DeviceLost));
    assert_eq!(block_on(&stage.device, renderer.resize(7, 7)).unwrap(), Err(Error::DeviceLost));
    assert_eq!(
        self::renderer(&stage, &shaders(&technique("ab_sb", &[]), "wgsl"), &settings()).err(),
        Some(Error::DeviceLost)
    );
    assert_eq!(offscreen.read(&stage.device, &stage.queue), Err(Error::DeviceLost));
    // A frame that began before records commands, but its readbacks never complete.
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let Ok(Recorded::Suspended(suspended)) = frame.record(&renderer, &mut encoder, &output, &mut |_, _| {}) else {
        panic!("the frame is not suspended")
    };
    assert_eq!(block_on(&stage.device, suspended.resume(&mut renderer)).unwrap().err(), Some(Error::DeviceLost));
    assert!(stage.is_lost());
}

#[test]
fn the_error_for_an_unknown_adapter_names_the_available_ones() {
    let error = message(Headless::open(&"no such adapter".parse::<Choice>().unwrap(), wgpu::Features::empty()));
    let names: Vec<String> =
        fragbuf_runtime::headless::adapters().iter().map(|adapter| adapter.get_info().name).collect();
    assert!(error.contains("no such adapter") && error.contains(&names[0]), "{error}");
}
