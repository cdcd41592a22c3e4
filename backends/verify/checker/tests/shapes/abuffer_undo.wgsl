// entry: draw; fragments: 2,3; sc: holds; relaxed: holds
// why: The count is at least 2 once two fragments have a layer, so a fragment that finds 2 or more undoes only its own addition.
// after: A-buffer with a counter per pixel (bevyengine/bevy oit_draw.wgsl)
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> layers: array<u32, 2>;
@fragment fn draw() {
    let at = atomicAdd(&count, 1u);
    if at >= 2u { atomicSub(&count, 1u); return; }
    layers[at] = 1u;
}
fn holds() -> bool { return atomicLoad(&count) == 2u && layers[0] == 1u && layers[1] == 1u; }
