@group(0) @binding(0) @coherent var<storage, read_write> entries: array<u32>;
fn critical_begin() {}
fn critical_end() {}
fn insert(pixel: u32, key: u32) {
    if entries[pixel] < key {
        entries[pixel] = key;
    }
}
@fragment
fn main(@builtin(position) position: vec4<f32>, @location(0) @interpolate(flat) key: u32) {
    let pixel = u32(position.x);
    critical_begin();
    insert(pixel, key);
    critical_end();
}
