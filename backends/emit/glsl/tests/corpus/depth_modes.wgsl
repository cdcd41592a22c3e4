enable dual_source_blending;

struct Sources {
    @location(0) @blend_src(0) color: vec4<f32>,
    @location(0) @blend_src(1) factor: vec4<f32>,
}

@early_depth_test(less_equal)
@fragment
fn conservative(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    return position.z * 0.5;
}

@fragment
fn dual(@location(0) @interpolate(flat, either) id: u32) -> Sources {
    return Sources(vec4<f32>(1.0), vec4<f32>(f32(id)));
}

@fragment
fn two(@location(0) @interpolate(flat) id: u32) -> @location(1) vec2<u32> {
    switch id {
        case 0u: { return vec2<u32>(1u); }
        case 1u: { return vec2<u32>(id, 3u); }
        default: { return vec2<u32>(id); }
    }
}
