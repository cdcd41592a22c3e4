struct input { sample: f32, invariant: u32, half: vec2<f32>, distance: f32 }
var<private> output: f32;
var<private> buffer: input;
@group(0) @binding(0) var<storage, read_write> texture: array<f32>;
@group(0) @binding(1) var<storage, read_write> input_: array<u32>;

fn mix_(a: f32) -> f32 { return a; }
fn lerp(half: f32, int: f32) -> f32 {
    let distance = half * int;
    let mat4 = distance + mix_(half);
    return length(vec2<f32>(distance, mat4));
}

@compute @workgroup_size(1)
fn main() {
    var a = 1.0;
    let i = 3u;
    if a > 0.5 {
        let a = lerp(a, 2.0);
        texture[0] = a;
        for (var i = i; i < 5u; i++) {
            let i = i + 1u;
            input_[i] = i;
        }
    }
    buffer.sample = a;
    buffer.half = vec2<f32>(buffer.distance);
    output = buffer.sample;
    texture[1] = output + f32(buffer.invariant);
    let größe = 2.0;
    texture[2] = größe;
}
