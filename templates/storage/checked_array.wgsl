// A k-buffer that notices its hazards (after Zhang 2014, KB-MHA, as K15 sec. 2 describes it; the paper was not at hand:
// what follows is fragbuf's own). Writers of one pixel race as in the sorted array, but an entry of two words carries a
// checksum over both. A fragment reads all slots, drops entries whose checksum is wrong and those that are there twice,
// sorts the rest, takes its place among them, writes back what has changed, and looks again: if it is gone, another
// fragment wrote over it, and it tries once more, REPAIRS times.
//
// Invariant: what is read out of a slot is a fragment, or, for one in four of those torn, the words of two; and no
// fragment twice. Nothing is promised for a schedule: a fragment can be written over after its last look.
//
// The checksum is the two bits that no depth from 0 to 1 needs, so nothing of depth or payload is given up for it.
// Fragments with the same words count as one.
//
// Memory: k * entry_words words per pixel, for at most two words an entry.

/// The bits of a depth of 1, the greatest key that is stored. Greater ones count as 1.
const KEY_OF_ONE = 0x3f800000u;
/// Where the checksum begins in the first word.
const CHECKSUM_SHIFT = 30u;
const KEY_BITS = 0x3fffffffu;

/// The slots as they were read, first words with their checksums.
var<private> seen: array<Packed, CAPACITY>;
/// The fragments in them, in order.
var<private> mended: array<Packed, CAPACITY>;
var<private> mended_count: u32;

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    var own = entry;
    own.key = min(entry.key, KEY_OF_ONE);
    for (var attempt = 0u; attempt <= REPAIRS; attempt++) {
        checked_array_mend(pixel);
        if checked_array_holds(own) {
            if attempt == 0u {
                on_lost(pixel, own, EQUAL_KEYS);
            }
            return;
        }
        if mended_count == frame.k {
            let last = mended[frame.k - 1u];
            if !better(own, last) {
                on_lost(pixel, own, DISPLACED);
                return;
            }
            on_lost(pixel, last, DISPLACED);
            mended_count -= 1u;
        }
        checked_array_add(own);
        checked_array_write(pixel);
    }
    checked_array_mend(pixel);
    if !checked_array_holds(own) {
        on_lost(pixel, own, SPIN_EXHAUSTED);
    }
}

fn storage_first(pixel: u32) -> u32 {
    return checked_array_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return checked_array_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return checked_array_open(checked_array_slot(pixel, cursor));
}

/// Reads all slots and puts the fragments in them in order, each once.
fn checked_array_mend(pixel: u32) {
    mended_count = 0u;
    for (var slot = 0u; slot < frame.k; slot++) {
        seen[slot] = checked_array_slot(pixel, slot);
        if checked_array_is_whole(seen[slot]) {
            let entry = checked_array_open(seen[slot]);
            if !checked_array_holds(entry) {
                checked_array_add(entry);
            }
        }
    }
}

fn checked_array_holds(entry: Packed) -> bool {
    for (var index = 0u; index < mended_count; index++) {
        if checked_array_are_equal(mended[index], entry) {
            return true;
        }
    }
    return false;
}

/// Puts a fragment into its place; there is room.
fn checked_array_add(entry: Packed) {
    var place = mended_count;
    while place > 0u && better(entry, mended[place - 1u]) {
        mended[place] = mended[place - 1u];
        place -= 1u;
    }
    mended[place] = entry;
    mended_count += 1u;
}

/// Writes the slots that hold something else than they should.
fn checked_array_write(pixel: u32) {
    for (var slot = 0u; slot < mended_count; slot++) {
        var sealed = mended[slot];
        sealed.key |= checked_array_checksum(sealed) << CHECKSUM_SHIFT;
        if sealed.key != seen[slot].key || packed_word(sealed, 0u) != packed_word(seen[slot], 0u) {
            entries_store(slot, pixel, sealed);
            keys_store(slot, pixel, sealed.key);
        }
    }
}

/// The first slot from `slot` on that holds a fragment which no slot before it holds.
fn checked_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        let sealed = checked_array_slot(pixel, cursor);
        var is_new = checked_array_is_whole(sealed);
        for (var before = 0u; before < cursor && is_new; before++) {
            let other = checked_array_slot(pixel, before);
            is_new = sealed.key != other.key || packed_word(sealed, 0u) != packed_word(other, 0u);
        }
        if is_new {
            return cursor;
        }
    }
    return END;
}

/// The words of a slot as they are stored.
fn checked_array_slot(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

/// Whether both words come from one fragment, as far as the checksum tells. No empty slot is whole.
fn checked_array_is_whole(sealed: Packed) -> bool {
    let entry = checked_array_open(sealed);
    return entry.key <= KEY_OF_ONE && sealed.key >> CHECKSUM_SHIFT == checked_array_checksum(entry);
}

/// A fragment without its checksum.
fn checked_array_open(sealed: Packed) -> Packed {
    var entry = sealed;
    entry.key &= KEY_BITS;
    return entry;
}

fn checked_array_checksum(entry: Packed) -> u32 {
    return (entry.key * 0x9e3779b1u ^ packed_word(entry, 0u) * 0x85ebca6bu) >> CHECKSUM_SHIFT;
}

fn checked_array_are_equal(a: Packed, b: Packed) -> bool {
    return !better(a, b) && !better(b, a);
}
