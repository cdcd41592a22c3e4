enable primitive_index;

struct Input {
    @builtin(position) position: vec4<f32>,
    @builtin(front_facing) front: bool,
    @builtin(sample_index) sample: u32,
    @builtin(sample_mask) mask: u32,
    @builtin(primitive_index) primitive: u32,
    @location(0) color: vec4<f32>,
}

struct Output {
    @location(0) color: vec4<f32>,
    @location(1) id: u32,
    @builtin(frag_depth) depth: f32,
    @builtin(sample_mask) mask: u32,
}

fn shade(input: Input) -> vec4<f32> {
    return select(input.color, input.color.wzyx, input.front) * input.position.w;
}

fn outputs(color: vec4<f32>) -> Output {
    return Output(color, 3u, 0.5, 1u);
}

@fragment
fn members(input: Input) -> Output {
    if input.color.w == 0.0 {
        discard;
    }
    return Output(input.color, input.primitive + input.sample, input.position.z, input.mask);
}

@fragment
fn whole(input: Input) -> Output {
    var result: Output;
    result.color = shade(input);
    if input.front {
        result.depth = 1.0;
        return result;
    }
    return outputs(result.color);
}

@early_depth_test(force)
@fragment
fn early(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let dx = dpdx(position.x) + dpdyFine(position.y) + fwidthCoarse(position.z);
    return vec4<f32>(dx);
}

@fragment
fn nothing() {}
