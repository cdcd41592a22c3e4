@group(0) @binding(0) var<storage, read_write> data: array<u32>;
@group(0) @binding(1) var<storage, read_write> locks: array<atomic<u32>>;

fn first_free(from_slot: u32, limit: u32) -> i32 {
    for (var slot = from_slot; slot < limit; slot++) {
        for (var word = 0u; word < 4u; word++) {
            if data[slot * 4u + word] != 0u { break; }
            if word == 3u { return i32(slot); }
        }
    }
    return -1;
}

fn depth_first(root: u32) -> u32 {
    var stack: array<u32, 16>;
    var top = 1u;
    var sum = 0u;
    stack[0] = root;
    while top > 0u {
        top--;
        let node = stack[top];
        sum += data[node];
        let left = data[node + 1u];
        let right = data[node + 2u];
        if left != 0u && top < 15u {
            stack[top] = left;
            top++;
        }
        if right != 0u && top < 15u {
            stack[top] = right;
            top += 1u;
        }
    }
    return sum;
}

fn heap_sift(count: u32, key: u32) {
    var hole = 0u;
    loop {
        var child = hole * 2u + 1u;
        if child >= count { break; }
        if child + 1u < count && data[child + 1u] > data[child] { child += 1u; }
        if data[child] <= key { break; }
        data[hole] = data[child];
        hole = child;
    }
    data[hole] = key;
}

fn acquire(pixel: u32) -> bool {
    var spins = 0u;
    var done = false;
    loop {
        let seen = atomicLoad(&locks[pixel]);
        if seen == 0u {
            let result = atomicCompareExchangeWeak(&locks[pixel], seen, 1u);
            if result.exchanged { done = true; break; }
        } else if seen == 2u {
            return false;
        }
        continuing {
            spins++;
            break if spins > 100u;
        }
    }
    return done;
}

@compute @workgroup_size(1)
fn main() {
    let slot = first_free(0u, 9u);
    if slot < 0 { return; }
    if acquire(u32(slot)) {
        heap_sift(4u, depth_first(u32(slot)));
        atomicStore(&locks[slot], 0u);
    }
}
