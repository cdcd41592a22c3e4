@group(0) @binding(0) var cube: texture_cube<f32>;
@group(0) @binding(1) var cubes: texture_cube_array<f32>;
@group(0) @binding(2) var line: texture_1d<f32>;
@group(0) @binding(3) var shadows: texture_depth_2d_array;
@group(0) @binding(4) var shadow_cube: texture_depth_cube;
@group(0) @binding(5) var smooth_sampler: sampler;
@group(0) @binding(6) var compare: sampler_comparison;
@group(0) @binding(7) var signed: texture_2d<i32>;
@group(0) @binding(8) var layered: texture_storage_2d_array<rgba16float, read>;
@group(0) @binding(9) var deep: texture_storage_3d<r32float, read_write>;
@group(0) @binding(10) var plain_depth: texture_depth_2d;

@fragment
fn main(@location(0) direction: vec3<f32>) -> @location(0) vec4<f32> {
    var color = textureSample(cube, smooth_sampler, direction) + textureSample(cubes, smooth_sampler, direction, 2);
    color += textureSample(line, smooth_sampler, direction.x) + textureLoad(line, 3, 0) + vec4<f32>(textureLoad(signed, vec2<i32>(1), 0));
    color.x += textureSampleCompare(shadows, compare, direction.xy, 1, 0.5) + textureSampleCompare(shadow_cube, compare, direction, 0.5);
    color.y += textureSample(plain_depth, smooth_sampler, direction.xy) + textureSampleLevel(plain_depth, smooth_sampler, direction.xy, 1);
    color += textureGatherCompare(shadows, compare, direction.xy, 1, 0.5) + textureGather(plain_depth, smooth_sampler, direction.xy);
    color += textureLoad(layered, vec2<i32>(2), 1) + textureLoad(deep, vec3<i32>(1));
    textureStore(deep, vec3<i32>(0), color);
    color.z += f32(textureDimensions(cube).x + textureDimensions(line) + textureDimensions(deep).z + textureNumLayers(cubes));
    return color;
}
