// What effects read where no iteration counts copies of a fragment: the sorted fragments. A row of `peeling` that
// counts them has functions of its own.

fn peeling_layer_count(sorted: u32) -> u32 {
    return sorted;
}

fn peeling_is_copy(index: u32) -> bool {
    return false;
}

fn peeling_copy() -> Packed {
    return packed_of_key(EMPTY);
}

fn peeling_sorted_index(index: u32) -> u32 {
    return index;
}
