// Operators of booleans. GLSL has `&&` and `||` for scalars, `!=` for `^`, and no compound assignments.

@group(0) @binding(0) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(1)
fn main() {
    var a = words[0] > 1u;
    let b = words[1] > 1u;
    a &= b;
    a |= words[2] == 3u;
    var c = vec2<bool>(a, b);
    c |= vec2<bool>(b, a);
    c &= c.yx;
    a = a | (b & c.x);
    a = a != c.y;
    words[3] = select(0u, 1u, a & !b);
}
