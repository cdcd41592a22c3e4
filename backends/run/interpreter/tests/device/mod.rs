//! Runs shaders on a device, for tests.

use fragbuf_interpreter::Bytecode;
use fragbuf_runtime::headless::Headless;
use fragbuf_runtime::wgpu;
use fragbuf_runtime::wgpu::util::DeviceExt;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// Parses and validates a shader.
pub fn validated(source: &str) -> Result<(naga::Module, ModuleInfo), String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
    let info = info.map_err(|error| error.emit_to_string(source))?;
    Ok((module, info))
}

/// Parses and validates a shader that must be valid.
pub fn parsed(source: &str) -> (naga::Module, ModuleInfo) {
    validated(source).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs the shader on a device; returns the words of the buffers in the order of the program.
pub fn run(
    headless: &Headless,
    shader: &str,
    entry: &str,
    program: &Bytecode,
    groups: [u32; 3],
    initial: &[Vec<u32>],
) -> Vec<Vec<u32>> {
    let device = &headless.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(shader.into()),
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
        .zip(initial)
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
