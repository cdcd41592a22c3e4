// The k-buffer in several passes (Liu et al. 2009; K15 sec. 2, KB-Multi). A fragment whose key no slot holds takes the
// slot of the greatest key, if its own is less; nobody keeps fragments of one pixel apart, so that they overwrite each
// other. The scene is drawn again until a whole pass changes nothing: then every fragment has found its key in a slot,
// or no key greater than its own, and the k least distinct keys are there.
//
// A fragment that finds its key writes what it carries once more: a payload that another fragment's key stood over is
// mended with the next pass. Of fragments with equal keys the last to write stays, word by word. Two that are stored at
// once may take two slots; whoever finds its key a second time empties that slot.
//
// Every word that is written in a pass is less than what its slot held when the pass began, so passes come to an end:
// one after the other, fragments need two passes; at worst each pass settles one fragment more. The rounds are bounded
// by k + 1 all the same, and a fragment that still changes something in the last one is counted.
//
// Memory: k * entry_words words per pixel. Geometry passes: at most k + 1.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    var greatest = 0u;
    var place = 0u;
    var found = false;
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key == entry.key {
            if found {
                repeated_array_empty(pixel, slot, entry.key);
            } else {
                entries_store(slot, pixel, entry);
                found = true;
            }
        }
        if key >= greatest {
            greatest = key;
            place = slot;
        }
    }
    if found {
        repeated_array_count(EQUAL_KEYS);
        return;
    }
    if greatest != EMPTY {
        repeated_array_count(DISPLACED);
    }
    if entry.key < greatest {
        keys_store(place, pixel, entry.key);
        entries_store(place, pixel, entry);
        repeated_array_changed();
    }
}

fn storage_first(pixel: u32) -> u32 {
    return repeated_array_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return repeated_array_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

/// Empties a slot whose key stands in another slot too, unless a lesser key has come to it meanwhile.
fn repeated_array_empty(pixel: u32, slot: u32, key: u32) {
    keys_atomic_compare_exchange(slot, pixel, key, EMPTY);
    repeated_array_changed();
}

/// Has the scene drawn again; after the last round it is a loss.
fn repeated_array_changed() {
    changed_store(1u);
    if frame.iteration == frame.k {
        count_loss(UNSETTLED);
    }
}

/// Losses are those of the first round: in later ones the same fragments come again.
fn repeated_array_count(counter: u32) {
    if frame.iteration == 0u {
        count_loss(counter);
    }
}

/// The first slot from `slot` on that holds a fragment.
fn repeated_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
