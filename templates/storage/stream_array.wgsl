// The k-buffer as a stream (B06 sec. 3, second type; sec. 4.3): k entries per pixel, sorted by key. When the array is
// full, every new fragment evicts the nearest of all k + 1: it is composited, with the next one behind it, into the
// pixel's colour. The resolve pass streams the remaining entries.
//
// Invariant: inside the critical section the entries are sorted without a gap, and `emitted` is the farthest key that
// has left. A fragment nearer than `emitted` is nearer than all entries, leaves at once and is out of order, which is
// counted. So nothing is counted if no fragment arrives more than k positions late. If nothing is counted, the image
// is that of all fragments in depth order, except that fragments with equal keys may leave in the order of arrival.
//
// Memory: k * entry_words + 5 words per pixel, and the lock's: entries, a colour of four floats, the key that left.

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    if keys_load(frame.k - 1u, pixel) == EMPTY {
        stream_array_add(pixel, entry);
        return;
    }
    let nearest = stream_array_read(pixel, 0u);
    if better(entry, nearest) {
        stream_array_emit(pixel, entry, nearest);
        return;
    }
    // The nearest leaves slot 0, and the entries nearer than the new fragment move up.
    var slot = 0u;
    while slot + 1u < frame.k {
        let next = stream_array_read(pixel, slot + 1u);
        if better(entry, next) {
            break;
        }
        stream_array_write(pixel, slot, next);
        slot++;
    }
    stream_array_write(pixel, slot, entry);
    stream_array_emit(pixel, nearest, stream_array_read(pixel, 0u));
}

fn storage_streamed(pixel: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(vec4<u32>(
        colors_load(0u, pixel),
        colors_load(1u, pixel),
        colors_load(2u, pixel),
        colors_load(3u, pixel),
    ));
}

fn storage_first(pixel: u32) -> u32 {
    return stream_array_cursor(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return stream_array_cursor(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return stream_array_read(pixel, cursor);
}

/// Inserts a fragment in order. A slot must be free.
fn stream_array_add(pixel: u32, entry: Packed) {
    var carried = entry;
    for (var slot = 0u; slot < frame.k; slot++) {
        let resident = stream_array_read(pixel, slot);
        if better(carried, resident) {
            stream_array_write(pixel, slot, carried);
            carried = resident;
        }
        if carried.key == EMPTY {
            return;
        }
    }
}

/// Composites `front`, which leaves; `back` is the next fragment behind it.
fn stream_array_emit(pixel: u32, front: Packed, back: Packed) {
    count_event(EMITTED);
    if front.key < emitted_load(pixel) {
        count_loss(OUT_OF_ORDER);
    } else {
        emitted_store(pixel, front.key);
    }
    let color = bitcast<vec4<u32>>(stream_composite(storage_streamed(pixel), front, back));
    colors_store(0u, pixel, color.x);
    colors_store(1u, pixel, color.y);
    colors_store(2u, pixel, color.z);
    colors_store(3u, pixel, color.w);
}

fn stream_array_read(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

fn stream_array_write(pixel: u32, slot: u32, entry: Packed) {
    entries_store(slot, pixel, entry);
    keys_store(slot, pixel, entry.key);
}

fn stream_array_cursor(pixel: u32, slot: u32) -> u32 {
    if slot < frame.k && keys_load(slot, pixel) != EMPTY {
        return slot;
    }
    return END;
}
