@group(0) @binding(0) var<storage, read_write> data: array<u32>;

fn next(index: u32) -> u32 {
    return data[index];
}

@compute @workgroup_size(1)
fn main() {
    var sum = 0u;
    for (var i = 0u; i < 4u; i++) {
        sum += i;
    }
    for (var i = 8i; i > 0; i -= 2) {
        if i == 4 { continue; }
        if sum > 100u { break; }
        sum += u32(i);
    }
    var n = sum;
    while n > 1u && next(n) != 0u {
        n = next(n);
        if n == 7u { continue; }
        sum++;
    }
    loop {
        sum -= 1u;
        if sum < 10u { break; }
        if sum == 11u { continue; }
        continuing {
            data[0] = sum;
            data[1] = n;
            break if sum == 12u;
        }
    }
    loop {
        let old = data[2];
        continuing {
            data[2] = old + 1u;
            break if old > 9u;
        }
    }
    for (; ; ) {
        var local: u32;
        local += sum;
        if local > 3u { break; }
        sum = local;
    }
    var j: u32;
    for (j = data[3]; j < arrayLength(&data); j += data[j]) {
        for (var k = j; k < 9u; k++) {
            if data[k] == 0u { continue; }
            data[k] = j;
        }
    }
    switch sum {
        case 0u: { data[4] = 1u; }
        case 1u, 2u: {
            if n == 3u { break; }
            data[4] = 2u;
        }
        default: { data[4] = 3u; }
    }
    for (var i = 0u; i < 3u; i++) {
        switch i32(i) {
            case 1: { continue; }
            case -2: { return; }
            default: {}
        }
        data[5] = i;
    }
    {
        let scoped = data[6];
        data[7] = scoped;
    }
}
