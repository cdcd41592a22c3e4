// Insertion sort for few fragments, Shell sort for many (K15 sec. 3.3: more than 16). The number of fragments of each
// pixel decides.

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_gather(entry);
}

fn sort_finish() {
    layers_finish();
    if gathered <= INSERTION_MOST {
        layers_insertion_sort(1u);
    } else {
        layers_shell_sort();
    }
}
