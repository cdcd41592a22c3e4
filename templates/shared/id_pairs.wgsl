// Peeling of fragments of equal depth by their ids, for one side or both (peeling/id_pairs and its kin). A side has a
// layer: the fragments of one key. Of those left in it, an iteration finds the least and the greatest id, then stores
// the fragments that have them. The id of a fragment is the first word that decides its ties.
//
// Keys of the back and greatest ids are inverted: minima find them all, and EMPTY is none.

/// Words of `window`: the key of the layer, and the ids between which fragments are left; EMPTY: all are.
const ID_PAIRS_KEY = 0u;
const ID_PAIRS_LEAST = 1u;
const ID_PAIRS_GREATEST = 2u;
/// Words of `found` beside the two ids: the key of the next layer, and whether fragments are left between the ids: 0.
const ID_PAIRS_NEXT = 0u;
const ID_PAIRS_BETWEEN = 3u;

fn id_pairs_id(entry: Packed) -> u32 {
    return packed_word(entry, 0u);
}

/// Returns whether a fragment of the side's layer has not been stored by an earlier iteration.
fn id_pairs_is_left(side: u32, pixel: u32, id: u32) -> bool {
    let least = window_load(ID_PAIRS_LEAST, side, pixel);
    return least == EMPTY || (id > least && ~id > window_load(ID_PAIRS_GREATEST, side, pixel));
}

/// Extends the ids of this iteration to include that of a fragment which is left in the side's layer.
fn id_pairs_find(side: u32, pixel: u32, id: u32) {
    if id < found_load(ID_PAIRS_LEAST, side, pixel) {
        found_atomic_min(ID_PAIRS_LEAST, side, pixel, id);
    }
    if ~id < found_load(ID_PAIRS_GREATEST, side, pixel) {
        found_atomic_min(ID_PAIRS_GREATEST, side, pixel, ~id);
    }
}

/// Returns whether this iteration stores a fragment which is left in the side's layer.
fn id_pairs_takes(side: u32, pixel: u32, id: u32) -> bool {
    return id == found_load(ID_PAIRS_LEAST, side, pixel) || ~id == found_load(ID_PAIRS_GREATEST, side, pixel);
}

/// Records a fragment that is left in the side's layer and that this iteration does not store.
fn id_pairs_leave(side: u32, pixel: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    if found_load(ID_PAIRS_BETWEEN, side, pixel) != 0u {
        found_store(ID_PAIRS_BETWEEN, side, pixel, 0u);
        remaining_store(1u);
    }
}

/// Records the key of a fragment behind the side's layer, on the way to the other side.
fn id_pairs_find_next(side: u32, pixel: u32, key: u32) {
    if key < found_load(ID_PAIRS_NEXT, side, pixel) && found_atomic_min(ID_PAIRS_NEXT, side, pixel, key) == EMPTY {
        remaining_store(1u);
    }
}

/// Ends the iteration of a side: goes on with the ids between, or else with the next layer. Returns whether the layer
/// has ended.
fn id_pairs_advance(side: u32, pixel: u32) -> bool {
    if found_load(ID_PAIRS_BETWEEN, side, pixel) == 0u {
        window_store(ID_PAIRS_LEAST, side, pixel, found_load(ID_PAIRS_LEAST, side, pixel));
        window_store(ID_PAIRS_GREATEST, side, pixel, found_load(ID_PAIRS_GREATEST, side, pixel));
        return false;
    }
    window_store(ID_PAIRS_KEY, side, pixel, found_load(ID_PAIRS_NEXT, side, pixel));
    window_store(ID_PAIRS_LEAST, side, pixel, EMPTY);
    return true;
}
