// A k-buffer that detects its races (after Zhang 2014, KB-MHA, as K15 sec. 2 describes it; the paper was not
// available, so the details are fragbuf's). Fragments of one pixel race as in the sorted array, but an entry of two
// words has a checksum over both. A fragment reads all slots, drops entries with a wrong checksum and duplicates,
// sorts the rest and inserts itself, writes the changed slots, and reads all slots again. If it is missing, another
// fragment overwrote it, and it retries up to REPAIRS times.
//
// Invariant: an entry read from a slot is a fragment, or for one in four torn entries the words of two fragments; no
// fragment is read twice. Storage is not guaranteed: a fragment can be overwritten after its last check.
//
// The checksum is the two bits that no depth from 0 to 1 needs, so depth and payload lose no bits to it. Fragments with
// equal words count as one.
//
// Memory: k * entry_words words per pixel, for at most two words an entry.

/// The bits of a depth of 1, the greatest key that is stored. Greater keys count as 1.
const KEY_OF_ONE = 0x3f800000u;
/// The lowest bit of the checksum in the first word.
const CHECKSUM_SHIFT = 30u;
const KEY_BITS = 0x3fffffffu;

/// The slots as read, first words with their checksums.
var<private> seen: array<Packed, CAPACITY>;
/// The valid fragments of the slots, sorted, each once.
var<private> repaired: array<Packed, CAPACITY>;
var<private> repaired_count: u32;

fn storage_reset(pixel: u32) {
    for (var slot = 0u; slot < frame.k; slot++) {
        keys_store(slot, pixel, EMPTY);
    }
}

fn storage_insert(pixel: u32, entry: Packed) {
    var clamped = entry;
    clamped.key = min(entry.key, KEY_OF_ONE);
    for (var attempt = 0u; attempt <= REPAIRS; attempt++) {
        checksummed_array_repair(pixel);
        if checksummed_array_holds(clamped) {
            if attempt == 0u {
                on_lost(pixel, clamped, EQUAL_KEYS);
            }
            return;
        }
        if repaired_count == frame.k {
            let last = repaired[frame.k - 1u];
            if !better(clamped, last) {
                on_lost(pixel, clamped, DISPLACED);
                return;
            }
            on_lost(pixel, last, DISPLACED);
            repaired_count -= 1u;
        }
        checksummed_array_add(clamped);
        checksummed_array_write(pixel);
    }
    checksummed_array_repair(pixel);
    if !checksummed_array_holds(clamped) {
        on_lost(pixel, clamped, TIMED_OUT);
    }
}

fn storage_first(pixel: u32) -> u32 {
    return checksummed_array_seek(pixel, 0u);
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    return checksummed_array_seek(pixel, cursor + 1u);
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return checksummed_array_without_checksum(checksummed_array_slot(pixel, cursor));
}

/// Reads all slots and sorts the valid fragments in them, each once.
fn checksummed_array_repair(pixel: u32) {
    repaired_count = 0u;
    for (var slot = 0u; slot < frame.k; slot++) {
        seen[slot] = checksummed_array_slot(pixel, slot);
        if checksummed_array_is_valid(seen[slot]) {
            let entry = checksummed_array_without_checksum(seen[slot]);
            if !checksummed_array_holds(entry) {
                checksummed_array_add(entry);
            }
        }
    }
}

fn checksummed_array_holds(entry: Packed) -> bool {
    for (var index = 0u; index < repaired_count; index++) {
        if checksummed_array_are_equal(repaired[index], entry) {
            return true;
        }
    }
    return false;
}

/// Inserts a fragment in order. A slot must be free.
fn checksummed_array_add(entry: Packed) {
    var slot = repaired_count;
    while slot > 0u && better(entry, repaired[slot - 1u]) {
        repaired[slot] = repaired[slot - 1u];
        slot -= 1u;
    }
    repaired[slot] = entry;
    repaired_count += 1u;
}

/// Writes the slots whose content changed.
fn checksummed_array_write(pixel: u32) {
    for (var slot = 0u; slot < repaired_count; slot++) {
        var stored = repaired[slot];
        stored.key |= checksummed_array_checksum(stored) << CHECKSUM_SHIFT;
        if stored.key != seen[slot].key || packed_word(stored, 0u) != packed_word(seen[slot], 0u) {
            entries_store(slot, pixel, stored);
            keys_store(slot, pixel, stored.key);
        }
    }
}

/// Returns the first slot from `slot` on with a fragment that no slot before it holds.
fn checksummed_array_seek(pixel: u32, slot: u32) -> u32 {
    for (var cursor = slot; cursor < frame.k; cursor++) {
        let stored = checksummed_array_slot(pixel, cursor);
        var is_new = checksummed_array_is_valid(stored);
        for (var before = 0u; before < cursor && is_new; before++) {
            let other = checksummed_array_slot(pixel, before);
            is_new = stored.key != other.key || packed_word(stored, 0u) != packed_word(other, 0u);
        }
        if is_new {
            return cursor;
        }
    }
    return END;
}

/// Returns the words of a slot as stored.
fn checksummed_array_slot(pixel: u32, slot: u32) -> Packed {
    return entries_load(slot, pixel, keys_load(slot, pixel));
}

/// Returns whether the checksum matches both words. An empty slot is never valid.
fn checksummed_array_is_valid(stored: Packed) -> bool {
    let entry = checksummed_array_without_checksum(stored);
    return entry.key <= KEY_OF_ONE && stored.key >> CHECKSUM_SHIFT == checksummed_array_checksum(entry);
}

/// Returns a stored fragment without its checksum.
fn checksummed_array_without_checksum(stored: Packed) -> Packed {
    var entry = stored;
    entry.key &= KEY_BITS;
    return entry;
}

fn checksummed_array_checksum(entry: Packed) -> u32 {
    return ((entry.key * 0x9e3779b1u) ^ (packed_word(entry, 0u) * 0x85ebca6bu)) >> CHECKSUM_SHIFT;
}

fn checksummed_array_are_equal(a: Packed, b: Packed) -> bool {
    return !better(a, b) && !better(b, a);
}
