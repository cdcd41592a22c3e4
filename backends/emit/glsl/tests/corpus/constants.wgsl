/// How many.
const COUNT: u32 = 4u;
const DOUBLE: u32 = COUNT * 2u;
const MASK = 0xFF00FF00u;
const ABSTRACT = 3;
const SCALE: f32 = 0.1;
const OFFSETS = array<vec2<f32>, COUNT>(vec2<f32>(0.0, 1.0), vec2<f32>(1.0), vec2<f32>(), vec2<f32>(-1.5, 2.0));
struct Pair { a: u32, b: f32 }
const PAIR = Pair(1u, 2.0);
const LEAST: i32 = -2147483648;
@group(0) @binding(0) var<storage, read_write> data: array<f32>;

@compute @workgroup_size(1)
fn main(@builtin(local_invocation_index) i: u32) {
    const LOCAL = 5u;
    let zero = vec3<f32>();
    data[0] = OFFSETS[i].x * SCALE + f32(DOUBLE & MASK) + f32(ABSTRACT) + f32(PAIR.a) + PAIR.b;
    data[LOCAL] = zero.x + f32(LEAST) + f32(i - COUNT);
    var local = OFFSETS;
    data[6] = local[i].y + f32(0xFFFFFFFFu) + 3.40282347e38;
}
