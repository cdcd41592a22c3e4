@group(0) @binding(0) var<storage, read_write> data: array<u32>;

fn take(index: u32) -> bool {
    data[index] += 1u;
    return data[index] > 2u;
}

fn even(index: u32) -> bool {
    return data[index] % 2u == 0u;
}

@compute @workgroup_size(1)
fn main(@builtin(local_invocation_index) i: u32) {
    let a = data[0] > 1u && data[1] > 2u;
    let b = data[0] > 1u || data[1] > 2u && even(3u);
    var c = (a || b) && !(a && b);
    if take(1u) && take(2u) || take(3u) {
        data[4] = 1u;
    }
    c = c && take(i) == even(i);
    data[5] = select(1u, 2u, c || a);
    while (i < 4u && take(i)) || even(i) {
        data[6] += 1u;
    }
    let d = take(1u) && (data[7] / data[8]) * (data[7] / data[8]) > 3u;
    data[9] = u32(d);
    if data[i] == 0u || data[data[i]] == 0u { return; }
    data[10] = u32(take(0u) | take(1u)) + select(0u, data[11], take(2u));
}

/// The only mention of `last` is inside an operand.
fn operand_alone(p: u32) -> bool {
    var last = 0.5 <= 3.25;
    if (true && 2i > i32(-2147483648)) || last {
        return p <= 255u;
    }
    return false;
}

@compute @workgroup_size(1)
fn operands() {
    data[0] = u32(operand_alone(data[1]));
}
