// A k of its own for each pixel, by an importance from 0 to 1 that the caller supplies (Vasilakis et al. 2017). The
// most important pixels keep the k of the frame, the others a share of it in proportion to their importance, and every
// pixel one fragment at least. The storage has counted the fragments of each pixel, and the host chooses the greatest k
// of the frame for which regions of min(f, k of the pixel) slots fit into the budget.
//
// Importance is rounded to 256 levels, so the numbers of pixels by level and fragments give the size of all regions.
//
// Memory: 256 * capacity words.

const MOST_IMPORTANT = 255u;

fn allocation_fragments(pixel: u32) -> u32 {
    return storage_fragments(pixel);
}

fn allocation_slots(pixel: u32) -> u32 {
    return max((allocation_level(pixel) * frame.k + MOST_IMPORTANT - 1u) / MOST_IMPORTANT, 1u);
}

fn allocation_level(pixel: u32) -> u32 {
    return min(u32(clamp(importance_load(pixel), 0.0, 1.0) * 255.0 + 0.5), MOST_IMPORTANT);
}
