// The storage has counted the fragments of each pixel (K15 sec. 4.2, exact allocation). The host predicts k from their
// histogram before the prefix sum, so that the regions of min(f, k) slots fit into the budget.
//
// Memory: 1025 words.

fn allocation_fragments(pixel: u32) -> u32 {
    return storage_fragments(pixel);
}

fn allocation_slots(pixel: u32) -> u32 {
    return frame.k;
}
