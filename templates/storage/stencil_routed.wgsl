// The stencil-routed k-buffer (Myers & Bavoil 2007; K15 sec. 2, KB-SR). The samples of a multisampled pixel are slots.
// The stencil of sample i begins at ROUTED + i. A fragment is written to the samples whose stencil is ROUTED, and
// decrements the stencil of every sample, clamped at zero. So the first fragment goes to sample 0, the next to sample
// 1, and so on in submission order: the first k are kept, whatever their depth.
//
// The paper begins at 2. Here ROUTED is as large as an 8-bit stencil allows. So the amount by which the last sample's
// stencil is below ROUTED - 1 is the number of fragments that came too late, up to 255 - CAPACITY; the resolve pass
// counts them.
//
// All this holds if a fragment covers every sample of its pixel. At the edge of an object a fragment covers some
// samples: only their stencils are decremented, and fragments of that pixel may be lost or stored twice. The store
// pass counts each fragment with partial coverage. A pixel without such a fragment holds the first k, so at most as
// many pixels are wrong as are counted. Two triangles that share an edge through a pixel count too, although together
// they cover it once. OpenGL can switch coverage by sample off and has no such pixels.
//
// Memory: k * (entry_words + 1) words per pixel, in textures of k samples; k is 2, 4 or 8.

/// The stencil value of the sample that takes the next fragment.
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

/// Returns the first sample from `slot` on whose stencil is below ROUTED: it holds a fragment.
fn stencil_routed_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        if routing_load(cursor, pixel) < ROUTED {
            return cursor;
        }
    }
    return END;
}
