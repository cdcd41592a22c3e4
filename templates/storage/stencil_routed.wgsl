// The stencil-routed k-buffer (Myers & Bavoil 2007; K15 sec. 2, KB-SR). The samples of a multisampled pixel are
// slots. The stencil of sample i begins at ROUTED + i; a fragment is written to the samples whose stencil is ROUTED,
// and takes one off the stencil of every sample, as far as zero. So the first fragment goes to sample 0, the next to
// sample 1, and so on in the order of submission: the first k are kept, whatever their depth.
//
// The paper begins at 2. Here ROUTED is as great as the 8 bits of a stencil allow, so that what the last sample has
// fallen below it says how many fragments came too late, up to 255 - CAPACITY of them; they are counted when the
// pixel is resolved.
//
// All this holds where a fragment covers every sample of its pixel. At the border of an object it covers some: those
// alone move on, and fragments of that pixel may be lost or stored twice. Each fragment that covers its pixel in part
// is counted by the store pass: a pixel without one holds the first k, so no more pixels than are counted do not. Two
// triangles that share an edge through a pixel count there too, although between them they cover it once. OpenGL can
// switch coverage by sample off and has no such borders.
//
// Memory: k * (entry_words + 1) words per pixel, in textures of k samples; k is 2, 4 or 8.

/// The stencil of a sample whose turn it is.
const ROUTED = 256u - CAPACITY;

fn storage_first(pixel: u32) -> u32 {
    let last = routing_load(frame.k - 1u, pixel);
    count_losses(SAMPLES_EXHAUSTED, ROUTED - 1u - min(last, ROUTED - 1u));
    return stencil_routed_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return stencil_routed_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor, pixel);
}

/// The first sample from `slot` on whose turn is over: it holds a fragment.
fn stencil_routed_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if routing_load(cursor, pixel) < ROUTED {
            return cursor;
        }
    }
    return END;
}
