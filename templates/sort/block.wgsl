// Register-based block sort (Knowles, Leach & Zambetta 2014). Private memory is slow where an index decides on the
// word, so blocks of eight fragments are sorted in variables that no index reaches, which compilers keep in registers;
// the blocks are merged as an effect goes along. An effect that goes back starts the merge over.

const BLOCK_LENGTH = 8u;
const BLOCKS = (LAYERS + BLOCK_LENGTH - 1u) / BLOCK_LENGTH;

var<private> block_0: Packed;
var<private> block_1: Packed;
var<private> block_2: Packed;
var<private> block_3: Packed;
var<private> block_4: Packed;
var<private> block_5: Packed;
var<private> block_6: Packed;
var<private> block_7: Packed;
/// Fragments in the variables.
var<private> block_filled: u32;
/// Of each block, how many are merged.
var<private> block_heads: array<u32, BLOCKS>;
var<private> block_merged: u32;
/// The last that was merged.
var<private> block_current: Packed;

fn sort_gather(entry: Packed) {
    layers_append(entry);
}

fn sort_finish() {
    for (var first = 0u; first < gathered; first += BLOCK_LENGTH) {
        let length = min(gathered - first, BLOCK_LENGTH);
        block_filled = 0u;
        for (var index = 0u; index < length; index++) {
            block_insert(layers[first + index]);
        }
        block_write(first);
    }
    block_restart();
}

fn sorted_count() -> u32 {
    return gathered;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper lane, whose pixel has no fragment, may ask for one all the same.
    let wanted = min(index, max(gathered, 1u) - 1u);
    if wanted + 1u < block_merged {
        block_restart();
    }
    while block_merged <= wanted {
        block_merge_one();
    }
    return fragment_unpack(block_current);
}

/// Begins the merge, with nothing taken of any block.
fn block_restart() {
    block_merged = 0u;
    for (var block = 0u; block < BLOCKS; block++) {
        block_heads[block] = 0u;
    }
}

/// Takes the nearest of the blocks' first.
fn block_merge_one() {
    var nearest = BLOCKS;
    for (var block = 0u; block * BLOCK_LENGTH < gathered; block++) {
        let at = block * BLOCK_LENGTH + block_heads[block];
        let is_left = block_heads[block] < BLOCK_LENGTH && at < gathered;
        if is_left && (nearest == BLOCKS || nearer(layers[at], block_current)) {
            nearest = block;
            block_current = layers[at];
        }
    }
    if nearest < BLOCKS {
        block_heads[nearest] += 1u;
    }
    block_merged += 1u;
}

/// Insertion sort without an index: whoever is nearer takes the place, the other goes on.
fn block_insert(entry: Packed) {
    var moving = entry;
    block_pass(0u, &block_0, &moving);
    block_pass(1u, &block_1, &moving);
    block_pass(2u, &block_2, &moving);
    block_pass(3u, &block_3, &moving);
    block_pass(4u, &block_4, &moving);
    block_pass(5u, &block_5, &moving);
    block_pass(6u, &block_6, &moving);
    block_pass(7u, &block_7, &moving);
    block_filled += 1u;
}

fn block_pass(place: u32, held: ptr<private, Packed>, moving: ptr<function, Packed>) {
    let before = *held;
    if place >= block_filled || nearer(*moving, before) {
        *held = *moving;
        *moving = before;
    }
}

fn block_write(first: u32) {
    block_put(first, block_0);
    block_put(first + 1u, block_1);
    block_put(first + 2u, block_2);
    block_put(first + 3u, block_3);
    block_put(first + 4u, block_4);
    block_put(first + 5u, block_5);
    block_put(first + 6u, block_6);
    block_put(first + 7u, block_7);
}

fn block_put(index: u32, entry: Packed) {
    if index < gathered {
        layers[index] = entry;
    }
}
