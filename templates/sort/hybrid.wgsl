// Insertion sort for few fragments, Shell sort for many (K15 sec. 3.3: more than 16). Every pixel decides for itself,
// by the fragments that it holds.

fn sort_gather(entry: Packed) {
    layers_append(entry);
}

fn sort_finish() {
    if gathered <= INSERTION_MOST {
        layers_insertion_sort(1u);
    } else {
        layers_shell_sort();
    }
}
