struct Item {
    key: u32,
    values: array<f32, 4>,
}
var<private> total: u32;
var<private> weights: array<f32, 3> = array<f32, 3>(1.0, 2.0, 3.0);
@group(0) @binding(0) var<storage, read_write> items: array<Item>;

fn bump(value: ptr<function, u32>) -> u32 {
    *value += 1u;
    return *value;
}

fn swap(keys: ptr<function, array<u32, 4>>, i: u32, j: u32) {
    let t = (*keys)[i];
    (*keys)[i] = (*keys)[j];
    (*keys)[j] = t;
}

fn note(value: ptr<private, u32>) {
    *value = 3u;
}

@compute @workgroup_size(1)
fn main() {
    var n = 2u;
    var keys: array<u32, 4>;
    var many: array<u32, 32>;
    let before = n;
    let after = bump(&n);
    keys[n] = bump(&n) + n;
    swap(&keys, 0u, 1u);
    note(&total);
    let pointer = &items[n];
    (*pointer).values[1] = weights[n] + (*pointer).values[before];
    n = after;
    (*pointer).key += keys[2] + many[n];
    let copy = items[0];
    items[1] = copy;
    var item = Item(1u, array<f32, 4>());
    item.values[n] = 2.0;
    items[2] = item;
    items[total].key++;
    for (var i = 0u; i < 2u; i++) {
        var fresh: array<u32, 16>;
        fresh[i] += 1u;
        n += fresh[0];
    }
    items[3].key = n;
}
