// The k-buffer in several passes (Liu et al. 2009; K15 sec. 2, KB-Multi). A fragment whose key is in no slot replaces
// the slot of the greatest key if its own key is less; fragments of one pixel are not synchronised and may overwrite
// each other. The scene is drawn again until a whole pass changes nothing. Then every fragment has found its key in a
// slot, or no key greater than its own, and the slots hold the k least distinct keys.
//
// A fragment that finds its key writes its value words again, so the next pass repairs a payload that another fragment
// overwrote. Of fragments with equal keys the last to write is kept, word by word. Two concurrent fragments with one
// key may take two slots; a fragment that finds its key a second time empties that slot.
//
// Every key that a pass writes is less than the key that its slot held when the pass began, so the loop terminates.
// Sequential fragments need two passes; in the worst case each pass stores one more fragment for good. The number of
// iterations is nevertheless limited to k + 1; a fragment that still changes a slot in the last one is counted.
//
// Memory: k * entry_words words per pixel. Geometry passes: at most k + 1.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    var greatest = 0u;
    var greatest_slot = 0u;
    var found = false;
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key == entry.key {
            if found {
                multipass_array_empty(pixel, slot, entry.key);
            } else {
                entries_store(slot, pixel, entry);
                found = true;
            }
        }
        if key >= greatest {
            greatest = key;
            greatest_slot = slot;
        }
    }
    if found {
        multipass_array_count(EQUAL_KEYS);
        return;
    }
    if greatest != EMPTY {
        multipass_array_count(DISPLACED);
    }
    if entry.key < greatest {
        keys_store(greatest_slot, pixel, entry.key);
        entries_store(greatest_slot, pixel, entry);
        multipass_array_mark_changed();
    }
}

fn storage_first(pixel: u32) -> u32 {
    return multipass_array_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return multipass_array_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel, keys_load(cursor, pixel));
}

/// Empties a slot whose key is in another slot too, unless a lesser key has replaced it.
fn multipass_array_empty(pixel: u32, slot: u32, key: u32) {
    keys_atomic_compare_exchange(slot, pixel, key, EMPTY);
    multipass_array_mark_changed();
}

/// Requests another iteration. In the last iteration the change is counted as a loss.
fn multipass_array_mark_changed() {
    changed_store(1u);
    if frame.iteration == frame.k {
        count_loss(NOT_CONVERGED);
    }
}

/// Counts a loss in the first iteration only: later iterations draw the same fragments again.
fn multipass_array_count(counter: u32) {
    if frame.iteration == 0u {
        count_loss(counter);
    }
}

/// Returns the first slot from `slot` on that holds a fragment.
fn multipass_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if keys_load(cursor, pixel) != EMPTY {
            return cursor;
        }
    }
    return END;
}
