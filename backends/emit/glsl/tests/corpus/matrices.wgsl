struct Camera {
    view: mat4x4<f32>,
    normal: mat3x3<f32>,
    eye: vec3<f32>,
    near: f32,
}
@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<storage, read> models: array<mat4x4<f32>>;

struct VertexOutput {
    @builtin(position) @invariant position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) @interpolate(flat) instance: u32,
    @location(2) @interpolate(linear, centroid) distance: f32,
    @location(3) @interpolate(perspective, sample) uv: vec2<f32>,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
) -> VertexOutput {
    let model = models[instance];
    let world = model * vec4<f32>(position, 1.0);
    var output: VertexOutput;
    output.position = camera.view * world;
    output.normal = normalize(camera.normal * normal);
    output.instance = instance + index;
    output.distance = length(world.xyz - camera.eye) / camera.near;
    output.uv = (transpose(mat2x2<f32>(1.0, 2.0, 3.0, 4.0)) * position.xy) * determinant(camera.normal);
    output.uv.x = model[3].x + camera.view[index % 4u][1];
    return output;
}

@fragment
fn fragment(input: VertexOutput) -> @location(0) vec4<f32> {
    return vec4<f32>(input.normal * input.distance, f32(input.instance) + input.uv.x);
}

@vertex
fn plain(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0);
}
