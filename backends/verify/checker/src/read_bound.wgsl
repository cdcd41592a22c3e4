// What the checker asks of a storage at every instant. The function is called by name; the entry point only keeps it.

@compute @workgroup_size(1)
fn read_bound() {
    _ = storage_bound(0u);
}
