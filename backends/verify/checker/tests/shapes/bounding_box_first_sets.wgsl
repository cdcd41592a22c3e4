// entry: main; fragments: 2,3; sc: wrong; relaxed: wrong
// why: The first arrival sets the box by stores, which overwrite what later arrivals have merged before.
// after: bounds that the first thread initialises
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> box: array<atomic<u32>, 2>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    let v = id.x + 5u;
    if atomicAdd(&count, 1u) == 0u { atomicStore(&box[0], v); atomicStore(&box[1], v); return; }
    atomicMin(&box[0], v);
    atomicMax(&box[1], v);
}
fn holds() -> bool { return atomicLoad(&box[0]) == 5u && atomicLoad(&box[1]) >= 6u; }
