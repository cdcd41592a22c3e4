// entry: main; fragments: 2; sc: holds; relaxed: race
// why: Arrivals are relaxed, so the data of the other workgroup is not ordered.
// after: Xiao and Feng 2010 without __threadfence
@coherent @group(0) @binding(0) var<storage, read_write> data: array<u32, 2>;
@group(0) @binding(1) var<storage, read_write> arrived: atomic<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<u32, 2>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    data[id.x] = id.x + 1u;
    atomicAdd(&arrived, 1u);
    loop { if atomicLoad(&arrived) == 2u { break; } }
    seen[id.x] = data[1u - id.x];
}
fn holds() -> bool { return seen[0] == 2u && seen[1] == 1u; }
