// Reads the bound of a storage at an instant. The checker calls the function by name; the entry point only keeps it linked.

@compute @workgroup_size(1)
fn read_bound() {
    _ = storage_bound(0u);
}
