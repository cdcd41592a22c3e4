//! Reads multisampled textures, which only a shader can read: one word per texel, sample after sample.

use fragbuf_runtime::headless::Headless;

const DUMP: &str = "
@group(0) @binding(0) var texels: texture_multisampled_2d<u32>;
@group(0) @binding(1) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) at: vec3<u32>) {
    let size = textureDimensions(texels);
    let texel = textureLoad(texels, at.xy, at.z);
    words[(at.z * size.y + at.y) * size.x + at.x] = texel.x | (texel.y << 16u);
}";

/// Returns the words of a texture of integers, two 16-bit halves per word, or of a stencil.
pub fn read(stage: &Headless, texture: &wgpu::Texture) -> Vec<u32> {
    let Headless { device, queue, .. } = stage;
    let is_stencil = texture.format().has_stencil_aspect();
    let aspect = if is_stencil { wgpu::TextureAspect::StencilOnly } else { wgpu::TextureAspect::All };
    let view = texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..wgpu::TextureViewDescriptor::default() });
    let (width, height, samples) = (texture.width(), texture.height(), texture.sample_count());
    let size = u64::from(4 * width * height * samples);
    let buffer =
        |usage| device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let words = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let source = wgpu::ShaderSource::Wgsl(DUMP.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: words.as_entire_binding() },
        ],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(width, height, samples);
    drop(pass);
    encoder.copy_buffer_to_buffer(&words, 0, &read, 0, size);
    queue.submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = read.get_mapped_range(..).unwrap();
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}
