// No lock. Sound if the storage reserves a slot for each fragment (`slot_counter`); a race otherwise (`none`).

fn sync_store(pixel: u32, entry: Packed) {
    storage_insert(pixel, entry);
}
