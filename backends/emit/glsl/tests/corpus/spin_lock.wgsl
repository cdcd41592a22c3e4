const SPIN_LIMIT: u32 = 4096u;
const K: u32 = 8u;

/// A fragment as it is stored.
struct Packed {
    key: u32,
    color: u32,
}

struct Frame {
    width: u32,
    height: u32,
    k: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
/// One lock per pixel.
@group(0) @binding(1) var<storage, read_write> locks: array<atomic<u32>>;
@group(0) @binding(2) @coherent var<storage, read_write> entries: array<u32>;
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> lost: atomic<u32>;

fn is_helper_lane() -> bool {
    return false;
}

fn memory_fence() {}

fn entry_load(index: u32) -> Packed {
    return Packed(entries[index * 2u], entries[index * 2u + 1u]);
}

fn entry_store(index: u32, entry: Packed) {
    entries[index * 2u] = entry.key;
    entries[index * 2u + 1u] = entry.color;
}

fn on_lost(entry: Packed) {
    atomicAdd(&lost, 1u);
}

/// Keeps the k least fragments, the worst of them in slot 0.
fn storage_insert(pixel: u32, entry: Packed) {
    let base = pixel * frame.k;
    let count = atomicLoad(&counts[pixel]);
    if count < frame.k {
        entry_store(base + count, entry);
        atomicStore(&counts[pixel], count + 1u);
        return;
    }

    // look for the worst entry
    var worst = entry_load(base);
    var slot = 0u;
    for (var i = 1u; i < frame.k; i++) {
        let candidate = entry_load(base + i);
        if candidate.key > worst.key || (candidate.key == worst.key && candidate.color > worst.color) {
            worst = candidate; // remember it
            slot = i;
        }
    }
    if entry.key >= worst.key {
        on_lost(entry);
        return;
    }
    on_lost(worst);
    entry_store(base + slot, entry);
}

fn sync_store(pixel: u32, entry: Packed) {
    if is_helper_lane() { return; }
    for (var attempt = 0u; attempt < SPIN_LIMIT; attempt++) {
        if atomicCompareExchangeWeak(&locks[pixel], 0u, 1u).exchanged {
            memory_fence();
            // slot 0 is published last
            storage_insert(pixel, entry);
            memory_fence();
            atomicStore(&locks[pixel], 0u);
            return;
        }
    }
    on_lost(entry);
}

struct Surface {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec4<f32>,
}

@fragment
fn store(surface: Surface) {
    let cell = vec2<u32>(surface.position.xy);
    let pixel = cell.y * frame.width + cell.x;
    sync_store(pixel, Packed(bitcast<u32>(surface.position.z), pack4x8unorm(surface.color)));
}
