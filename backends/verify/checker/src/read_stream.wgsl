// Reads the colour that a stream has emitted, and composites two consecutive fragments onto it. The checker calls the
// functions by name; the entry point only keeps them linked.

@compute @workgroup_size(1)
fn read_stream() {
    let entry = storage_read(0u, 0u);
    _ = stream_composite(storage_streamed(0u), entry, entry);
}
