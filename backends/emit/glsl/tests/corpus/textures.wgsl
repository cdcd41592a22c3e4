@group(0) @binding(0) var color_texture: texture_2d<f32>;
@group(0) @binding(1) var color_sampler: sampler;
@group(0) @binding(2) var ids: texture_2d<u32>;
@group(0) @binding(3) var samples: texture_multisampled_2d<f32>;
@group(0) @binding(4) var depth: texture_depth_2d;
@group(0) @binding(5) var depth_samples: texture_depth_multisampled_2d;
@group(0) @binding(6) var layers: texture_2d_array<f32>;
@group(0) @binding(7) var shadow: texture_depth_2d;
@group(0) @binding(8) var shadow_sampler: sampler_comparison;
@group(0) @binding(9) var volume: texture_3d<f32>;
@group(0) @binding(10) var target_image: texture_storage_2d<rgba8unorm, write>;
@group(0) @binding(11) var counts: texture_storage_2d<r32uint, read_write>;

@fragment
fn main(@builtin(position) position: vec4<f32>, @location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let cell = vec2<i32>(position.xy);
    let pixel = vec2<u32>(position.xy);
    var color = textureSample(color_texture, color_sampler, uv);
    color += textureSampleLevel(color_texture, color_sampler, uv, 1.0);
    color += textureSampleBias(color_texture, color_sampler, uv, 0.5);
    color += textureSampleGrad(color_texture, color_sampler, uv, uv, uv.yx);
    color += textureSample(color_texture, color_sampler, uv, vec2<i32>(1, -1));
    color += textureGather(1, color_texture, color_sampler, uv);
    color += textureLoad(color_texture, cell, 0) + textureLoad(layers, pixel, 2, 0) + textureLoad(samples, cell, 3);
    color += textureSample(layers, color_sampler, uv, 1) + textureSample(volume, color_sampler, vec3<f32>(uv, 0.5));
    color.x += textureLoad(depth, pixel, 0) + textureLoad(depth_samples, cell, 1);
    color.y += textureSampleCompare(shadow, shadow_sampler, uv, 0.5) + textureSampleCompareLevel(shadow, shadow_sampler, uv, 0.25);
    color.z += f32(textureLoad(ids, pixel, 0).x);
    let size = textureDimensions(color_texture) + textureDimensions(samples) + textureDimensions(layers, 1) + textureDimensions(counts);
    color.w += f32(size.x + textureNumLayers(layers) + textureNumLevels(color_texture) + textureNumSamples(samples));
    textureStore(target_image, pixel, color);
    let count = textureLoad(counts, pixel).x;
    textureStore(counts, pixel, vec4<u32>(count + 1u, 0u, 0u, 0u));
    return color;
}
