// Conditions inside of loops whose headers declare a counter: the variable of `||` is declared above the outer loop.

@group(0) @binding(0) var<storage, read_write> words: array<u32>;

@compute @workgroup_size(1)
fn main() {
    var n = 0u;
    for (var i = words[0]; i > 0u; i--) {
        for (var j = words[1]; j < 4u; j++) {
            if i == 3u {
                if false || true || true {
                    n += j;
                }
            }
        }
    }
    words[2] = n + unused(n);
}

// An unused value in the first branch; the second declares a variable.
fn unused(a: u32) -> u32 {
    if a > 2u {
        let b = a * 3u;
    } else {
        var c: u32;
        if a == 1u {
            c = 4u;
        } else {
            c = 5u;
        }
        return 1u << c;
    }
    return a;
}
