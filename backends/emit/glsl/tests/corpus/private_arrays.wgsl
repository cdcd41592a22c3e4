struct Packed { key: u32, color: u32 }
const LAYERS = 16u;
var<private> layers: array<Packed, LAYERS>;
var<private> gathered: u32;
var<workgroup> sums: array<u32, 256>;
var<workgroup> total: u32;
@group(0) @binding(0) var<storage, read_write> data: array<u32>;

fn nearer(a: Packed, b: Packed) -> bool {
    return a.key < b.key || (a.key == b.key && a.color < b.color);
}

fn sort_gather(entry: Packed) {
    if gathered == LAYERS {
        if !nearer(entry, layers[LAYERS - 1u]) {
            return;
        }
    } else {
        gathered += 1u;
    }
    var place = gathered - 1u;
    while place > 0u && nearer(entry, layers[place - 1u]) {
        layers[place] = layers[place - 1u];
        place -= 1u;
    }
    layers[place] = entry;
}

fn workgroup_scan(local: u32, own: u32) -> u32 {
    workgroupBarrier();
    sums[local] = own;
    workgroupBarrier();
    for (var distance = 1u; distance < 256u; distance *= 2u) {
        var before = 0u;
        if local >= distance {
            before = sums[local - distance];
        }
        workgroupBarrier();
        sums[local] += before;
        workgroupBarrier();
    }
    return sums[local];
}

@compute @workgroup_size(256)
fn scan(@builtin(local_invocation_index) local: u32) {
    sort_gather(Packed(data[local], 1u));
    total += gathered;
    var offset = workgroup_scan(local, layers[0].key) - gathered;
    for (var pixel = offset; pixel < 9u; pixel++) {
        data[pixel] = offset;
        offset += data[pixel];
    }
    if local == 255u {
        data[0] = offset + total;
    }
}

@fragment
fn fragment() -> @location(0) vec4<f32> {
    sort_gather(Packed(1u, 2u));
    if gathered == 0u {
        discard;
    }
    return vec4<f32>(f32(layers[0].key));
}
