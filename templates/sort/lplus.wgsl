// The l+ sort (K15 sec. 4.4, Alg. 4, mended): no array for all fragments of a pixel. The nearest LPLUS_BATCH are kept
// in order while the pixel is read; when an effect asks for the next, the pixel is read again for as many behind them.
// So any number of fragments is seen, none is left out, and an effect that stops early reads no more than it needs.
//
// Fragments are ordered by their words, equal ones by their place among those that are read. As printed, the paper
// takes up the first batch for ever, emits one fragment less than it holds, and loses or repeats equal depths at the
// end of a batch; this order, and a bound that outlives the batch, mend all three.

var<private> lplus_batch: array<Packed, LPLUS_BATCH>;
/// Where each of the batch stands among the fragments that are read.
var<private> lplus_places: array<u32, LPLUS_BATCH>;
var<private> lplus_size: u32;
/// Fragments nearer than the batch.
var<private> lplus_begin: u32;
/// Fragments of the pixel.
var<private> lplus_count: u32;

fn sort_gather(entry: Packed) {
    lplus_offer(entry, lplus_count);
    lplus_count += 1u;
}

fn sort_finish() {}

fn sorted_count() -> u32 {
    return lplus_count;
}

fn sorted_layer(index: u32) -> Fragment {
    // A helper lane, whose pixel has no fragment, may ask for one all the same.
    let wanted = min(index, max(lplus_count, 1u) - 1u);
    if wanted < lplus_begin {
        lplus_first_batch();
    }
    while lplus_begin + lplus_size <= wanted && lplus_begin + lplus_size < lplus_count {
        lplus_next_batch();
    }
    return fragment_unpack(lplus_batch[wanted - lplus_begin]);
}

fn lplus_first_batch() {
    lplus_begin = 0u;
    lplus_size = 0u;
    var place = 0u;
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        lplus_offer(resolve_read(cursor), place);
        place += 1u;
    }
}

/// The nearest behind the last of this batch.
fn lplus_next_batch() {
    let last = lplus_batch[lplus_size - 1u];
    let last_place = lplus_places[lplus_size - 1u];
    lplus_begin += lplus_size;
    lplus_size = 0u;
    var place = 0u;
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        let entry = resolve_read(cursor);
        if nearer(last, entry) || (place > last_place && !nearer(entry, last)) {
            lplus_offer(entry, place);
        }
        place += 1u;
    }
}

/// Puts a fragment into the batch, if it is nearer than the last or there is room. Of equal ones the first came first.
fn lplus_offer(entry: Packed, place: u32) {
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
        lplus_places[at] = lplus_places[at - 1u];
        at -= 1u;
    }
    lplus_batch[at] = entry;
    lplus_places[at] = place;
}
