// What the checker asks of a storage after a pass. The functions are called by name; the entry point only keeps them.

@compute @workgroup_size(1)
fn read_out() {
    let cursor = storage_next(0u, storage_first(0u));
    _ = storage_read(0u, cursor).key;
}
