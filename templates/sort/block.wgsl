// Register-based block sort (Knowles, Leach & Zambetta 2014). Private memory is slow if an index selects the word. So
// blocks of eight fragments are sorted in variables that are never indexed, which compilers keep in registers. The
// blocks are merged as an effect reads them. An effect that reads backwards restarts the merge.

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
/// The number of fragments in the variables.
var<private> block_filled: u32;
/// For each block, the number of merged fragments.
var<private> block_heads: array<u32, BLOCKS>;
var<private> block_merged: u32;
/// The fragment that was merged last.
var<private> block_current: Packed;

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_gather(entry);
}

fn sort_finish() {
    layers_finish();
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
    // A helper invocation may read a layer of a pixel without fragments.
    let clamped = min(index, max(gathered, 1u) - 1u);
    if clamped + 1u < block_merged {
        block_restart();
    }
    while block_merged <= clamped {
        block_merge_one();
    }
    return fragment_unpack(block_current);
}

/// Restarts the merge at the first fragment of every block.
fn block_restart() {
    block_merged = 0u;
    for (var block = 0u; block < BLOCKS; block++) {
        block_heads[block] = 0u;
    }
}

/// Merges the nearest of the blocks' next fragments.
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

/// Inserts a fragment without an index: in each variable the nearer fragment stays, and the other moves on.
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

fn block_pass(slot: u32, resident: ptr<private, Packed>, moving: ptr<function, Packed>) {
    let before = *resident;
    if slot >= block_filled || nearer(*moving, before) {
        *resident = *moving;
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
