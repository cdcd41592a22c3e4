@group(0) @binding(0) @coherent var<storage, read_write> entries: array<u32>;
fn ordered_critical_begin() {}
fn critical_end() {}
@fragment
fn main(@builtin(position) position: vec4<f32>, @location(0) @interpolate(flat) key: u32) {
    ordered_critical_begin();
    if key != 0u {
        entries[u32(position.x)] = key;
    }
    critical_end();
}
