// No lock. Sound where the storage gives each fragment a place of its own (`slot_counter`); a race where it does
// not (`none`).

fn sync_store(pixel: u32, entry: Packed) {
    storage_insert(pixel, entry);
}
