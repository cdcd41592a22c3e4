// Shell sort (Shell 1959): insertion sort over ever shorter distances. The gaps are Knuth's (The Art of Computer
// Programming 3, sec. 5.2.1): 1, 4, 13, 40, 121, 364, 1093, each three times the last and one more, for O(n^1.5) steps.
// They are computed, not looked up: private memory holds no table.

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

/// Brings each of the `gap` interleaved sequences into order, nearest first. Gap 1 is plain insertion sort.
fn layers_insertion_sort(gap: u32) {
    for (var index = gap; index < gathered; index++) {
        let entry = layers[index];
        var place = index;
        while place >= gap && nearer(entry, layers[place - gap]) {
            layers[place] = layers[place - gap];
            place -= gap;
        }
        layers[place] = entry;
    }
}
