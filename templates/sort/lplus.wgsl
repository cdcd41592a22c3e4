// The l+ sort (K15 sec. 4.4, Alg. 4, corrected): no array for all fragments of a pixel. The nearest LPLUS_BATCH
// fragments are kept sorted while the pixel is read. When an effect reads past them, the pixel is read again for as
// many behind them. So any number of fragments is resolved, none is dropped, and an effect that stops early reads no
// more than it needs.
//
// Fragments are sorted by their words, and equal ones by their position in the order of reading. The published
// algorithm collects the first batch for ever, emits one fragment less than it holds, and loses or repeats equal
// depths at the end of a batch; this order, and a bound that outlives the batch, correct all three.

var<private> lplus_batch: array<Packed, LPLUS_BATCH>;
/// The position of each fragment of the batch in the order of reading.
var<private> lplus_positions: array<u32, LPLUS_BATCH>;
var<private> lplus_size: u32;
/// The number of fragments nearer than the batch.
var<private> lplus_begin: u32;
/// The number of fragments of the pixel.
var<private> lplus_count: u32;

fn sort_begin() {
    lplus_begin = 0u;
    lplus_size = 0u;
    lplus_count = 0u;
}

fn sort_gather(entry: Packed) {
    lplus_offer(entry, lplus_count);
    lplus_count += 1u;
}

fn sort_finish() {}

fn sorted_count() -> u32 {
    return lplus_count;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper invocation may read a layer of a pixel without fragments.
    let clamped = min(index, max(lplus_count, 1u) - 1u);
    if clamped < lplus_begin {
        lplus_first_batch();
    }
    // An empty batch ends the loop: memory then differs from what the first walk read.
    while lplus_size > 0u && lplus_begin + lplus_size <= clamped && lplus_begin + lplus_size < lplus_count {
        lplus_next_batch();
    }
    return fragment_unpack(lplus_batch[min(clamped - lplus_begin, LPLUS_BATCH - 1u)]);
}

fn lplus_first_batch() {
    lplus_begin = 0u;
    lplus_size = 0u;
    var position = 0u;
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        lplus_offer(resolve_read(cursor), position);
        position += 1u;
    }
}

/// Reads the nearest fragments behind the last of this batch.
fn lplus_next_batch() {
    let last = lplus_batch[lplus_size - 1u];
    let last_position = lplus_positions[lplus_size - 1u];
    lplus_begin += lplus_size;
    lplus_size = 0u;
    var position = 0u;
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        let entry = resolve_read(cursor);
        if nearer(last, entry) || (position > last_position && !nearer(entry, last)) {
            lplus_offer(entry, position);
        }
        position += 1u;
    }
}

/// Inserts a fragment in the batch if it is nearer than the last or the batch is not full. Equal ones keep their order.
fn lplus_offer(entry: Packed, position: u32) {
    if lplus_size == LPLUS_BATCH {
        if !nearer(entry, lplus_batch[LPLUS_BATCH - 1u]) {
            return;
        }
    } else {
        lplus_size += 1u;
    }
    var at = lplus_size - 1u;
    while at > 0u && nearer(entry, lplus_batch[at - 1u]) {
        lplus_batch[at] = lplus_batch[at - 1u];
        lplus_positions[at] = lplus_positions[at - 1u];
        at -= 1u;
    }
    lplus_batch[at] = entry;
    lplus_positions[at] = position;
}
