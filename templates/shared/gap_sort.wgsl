// Shell sort (Shell 1959): insertion sort over decreasing distances. The gaps are Knuth's (The Art of Computer
// Programming 3, sec. 5.2.1): 1, 4, 13, 40, 121, 364, 1093, each three times the previous one plus one, for O(n^1.5)
// steps. They are computed, so private memory holds no table.

fn layers_shell_sort() {
    var gap = 1u;
    while gap < gathered / 3u {
        gap = 3u * gap + 1u;
    }
    while gap > 0u {
        layers_insertion_sort(gap);
        gap /= 3u;
    }
}

/// Sorts each of the `gap` interleaved sequences, nearest first. Gap 1 is plain insertion sort.
fn layers_insertion_sort(gap: u32) {
    for (var index = gap; index < gathered; index++) {
        let entry = layers[index];
        var slot = index;
        while slot >= gap && nearer(entry, layers[slot - gap]) {
            layers[slot] = layers[slot - gap];
            slot -= gap;
        }
        layers[slot] = entry;
    }
}
