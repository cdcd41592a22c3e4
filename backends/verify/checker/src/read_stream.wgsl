// What the checker asks of a storage that hands fragments on: the colour of what has left, and what two fragments that
// follow each other add to one. The functions are called by name; the entry point only keeps them.

@compute @workgroup_size(1)
fn read_stream() {
    let entry = storage_read(0u, 0u);
    _ = stream_composite(storage_streamed(0u), entry, entry);
}
