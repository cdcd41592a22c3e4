// Shell sort after all fragments are read: fewer moves than insertion sort if there are many.

fn sort_begin() {
    layers_begin();
}

fn sort_gather(entry: Packed) {
    layers_gather(entry);
}

fn sort_finish() {
    layers_finish();
    layers_shell_sort();
}
