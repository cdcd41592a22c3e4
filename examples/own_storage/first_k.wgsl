// The first k fragments of every pixel, in the order in which they come: a counter hands out the slots. Right where no
// pixel has more than k, and the cheapest storage there is; beyond that it is the draw order's word which fragments stay.
//
// Memory: k * entry_words + 1 words per pixel.

//: storage -- the first k fragments of a pixel, as they come
//: buffer taken[pixel < pixels]: word, clear 0 -- fragments that asked for a slot
//: buffer slots[slot < k][pixel < pixels]: entry -- the fragments, as many as slots are taken
//: pass store: taken atomic, slots plain
//: pass resolve: taken read, slots read
//: offers own-atomics, indexed
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
