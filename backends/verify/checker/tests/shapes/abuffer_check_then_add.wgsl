// entry: draw; fragments: 3; sc: race; relaxed: race
// why: Three fragments can read a count below 2 before any adds, so the last one gets layer 2 of 2.
// after: A-buffer that tests the counter before the addition
@group(0) @binding(0) var<storage, read_write> count: atomic<u32>;
@group(0) @binding(1) var<storage, read_write> layers: array<u32, 2>;
@fragment fn draw() {
    if atomicLoad(&count) >= 2u { return; }
    let at = atomicAdd(&count, 1u);
    layers[at] = 1u;
}
