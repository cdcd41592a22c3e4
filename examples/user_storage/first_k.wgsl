// The first k fragments of every pixel, in order of arrival: a counter allocates the slots. It is the cheapest storage, and
// exact if no pixel has more than k fragments. In other pixels the draw order decides which fragments it keeps.
//
// Memory: k * entry_words + 1 words per pixel.

//: storage -- the first k fragments of a pixel, in order of arrival
//: buffer taken[pixel < pixels]: word, clear 0 -- fragments that requested a slot
//: buffer slots[slot < k][pixel < pixels]: entry -- the fragments in the slots that are taken
//: pass store: taken atomic, slots plain
//: pass resolve: taken read, slots read
//: provides lock-free, indexed
//: requires fragment-atomics
//: suits sync slot_counter

fn storage_insert(pixel: u32, entry: Packed) {
    let slot = taken_atomic_add(pixel, 1u);
    if slot >= frame.k {
        on_lost(pixel, entry, DISPLACED);
        return;
    }
    slots_store(slot, pixel, entry);
}

fn storage_first(pixel: u32) -> u32 {
    return first_k_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return first_k_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return slots_load(cursor, pixel);
}

fn first_k_cursor(pixel: u32, slot: u32) -> u32 {
    return select(END, slot, slot < min(taken_load(pixel), frame.k));
}
