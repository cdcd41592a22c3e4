//! Changes that nothing notices, each with its reason. A line that stands in a template twice needs two.

/// Row, the changed line, what it became, and why nothing can notice.
pub(crate) const SURVIVORS: &[(&str, &str, &str, &str)] = &[
    (
        "storage/exact_regions",
        "if place >= size || begin + place >= frame.fragments {",
        "if place > size || begin + place >= frame.fragments {",
        "places count down from size - 1 to 0 and then wrap to far beyond any region: none is size itself",
    ),
    (
        "storage/linked_list",
        "nodes_store(node, entry); links_store(node, heads_atomic_exchange(pixel, node + 1u));",
        "links_store(node, heads_atomic_exchange(pixel, node + 1u)); nodes_store(node, entry);",
        "nobody reads a list before the pass has ended",
    ),
    (
        "storage/sorted_array",
        "entries_store(slot, pixel, carried); keys_store(slot, pixel, carried.key);",
        "keys_store(slot, pixel, carried.key); entries_store(slot, pixel, carried);",
        "inside the lock nobody reads between the two, and outside it the cull reads keys alone",
    ),
    (
        "storage/max_array",
        "entries_store(slot, pixel, entry); keys_store(slot, pixel, entry.key);",
        "keys_store(slot, pixel, entry.key); entries_store(slot, pixel, entry);",
        "inside the lock nobody reads between the two, and outside it the cull reads a key alone",
    ),
    (
        "storage/max_array",
        "if worst_slot != 0u {",
        "if worst_slot != 4294967295u {",
        "where slot 0 is the worst it already holds the entry, which is written there once more",
    ),
    (
        "storage/max_array",
        "keys_store(0u, pixel, EMPTY); filled_store(pixel, 0u);",
        "filled_store(pixel, 0u); keys_store(0u, pixel, EMPTY);",
        "a pass of its own resets both words, and nobody else touches them",
    ),
    (
        "storage/max_array",
        "max_array_write(pixel, frame.k - 1u - filled_before, entry); filled_store(pixel, filled_before + 1u);",
        "filled_store(pixel, filled_before + 1u); max_array_write(pixel, frame.k - 1u - filled_before, entry);",
        "inside the lock nobody reads between the two, and outside it the cull reads slot 0 alone, which is not written",
    ),
    (
        "storage/max_array",
        "worst = resident; worst_slot = slot;",
        "worst_slot = slot; worst = resident;",
        "variables of one invocation",
    ),
    (
        "storage/cascade",
        "return;",
        "",
        "a way out early: slots behind have greater keys, and an EMPTY that is carried on changes none",
    ),
    (
        "storage/max_heap",
        "entries_store(slot, pixel, entry); keys_store(slot, pixel, entry.key);",
        "keys_store(slot, pixel, entry.key); entries_store(slot, pixel, entry);",
        "inside the lock nobody reads between the two, and outside it the cull reads a key alone",
    ),
    (
        "storage/max_heap",
        "for (var parent = frame.k / 2u; parent > 1u; parent--) {",
        "for (var parent = frame.k / 1u; parent > 1u; parent--) {",
        "a slot without children stays as it is",
    ),
    (
        "storage/max_heap",
        "for (var parent = frame.k / 2u; parent > 1u; parent--) {",
        "for (var parent = frame.k / 2u; parent > 0u; parent--) {",
        "slot 0 is EMPTY, which is worse than any: it stays as it is",
    ),
    (
        "storage/max_heap",
        "for (var parent = frame.k / 2u; parent > 1u; parent--) {",
        "for (var parent = frame.k / 2u; parent >= 1u; parent--) {",
        "the same",
    ),
    (
        "storage/max_heap",
        "keys_store(0u, pixel, EMPTY); filled_store(pixel, 0u);",
        "filled_store(pixel, 0u); keys_store(0u, pixel, EMPTY);",
        "a pass of its own resets both words, and nobody else touches them",
    ),
    (
        "storage/max_heap",
        "max_heap_write(pixel, frame.k - 1u - filled_before, entry); filled_store(pixel, filled_before + 1u);",
        "filled_store(pixel, filled_before + 1u); max_heap_write(pixel, frame.k - 1u - filled_before, entry);",
        "inside the lock nobody reads between the two, and outside it the cull reads slot 0 alone, which is not written",
    ),
    (
        "storage/max_heap",
        "worst = sibling; child += 1u;",
        "child += 1u; worst = sibling;",
        "variables of one invocation",
    ),
    (
        "storage/revised_array",
        "entries_store(slot, pixel, entry); keys_store(slot, pixel, entry.key);",
        "keys_store(slot, pixel, entry.key); entries_store(slot, pixel, entry);",
        "in what is written inside the lock: nobody reads between the two there, and who waits outside reads keys alone, of \
         slots that were written before",
    ),
    (
        "storage/revised_array",
        "for (var attempt = 0u; attempt < WAIT_LIMIT; attempt++) {",
        "for (var attempt = 0u; attempt <= WAIT_LIMIT; attempt++) {",
        "one look more: the number of looks is a bound, not a promise",
    ),
    (
        "storage/revised_array",
        "if worst_slot != 0u {",
        "if worst_slot != 4294967295u {",
        "where slot 0 is the worst it already holds the entry, which is written there once more",
    ),
    (
        "storage/revised_array",
        "worst = resident; worst_slot = slot;",
        "worst_slot = slot; worst = resident;",
        "variables of one invocation",
    ),
    (
        "storage/ordered_list",
        "for (var attempt = 0u; attempt < LINK_TRIES; attempt++) {",
        "for (var attempt = 0u; attempt <= LINK_TRIES; attempt++) {",
        "one try more: the number of tries is a bound, not a promise",
    ),
    (
        "storage/ordered_list",
        "on_lost(pixel, nodes_load(beyond - 1u), DISPLACED);",
        "on_lost(pixel, nodes_load(beyond - 2u), DISPLACED);",
        "`overflow: drop`, the only one that there is, counts a fragment and does not look at it",
    ),
    (
        "storage/bounded_regions",
        "entries_store(slot, pixel, entry); keys_store(slot, pixel, entry.key);",
        "keys_store(slot, pixel, entry.key); entries_store(slot, pixel, entry);",
        "a slot of a pixel that is not crowded is one invocation's, and nobody reads it before the pass has ended",
    ),
    (
        "storage/bounded_regions",
        "if !bounded_regions_is_crowded(pixel) || offsets_load(pixel + 1u) > frame.kept {",
        "if !bounded_regions_is_crowded(pixel) || offsets_load(pixel + 1u) >= frame.kept {",
        "the last region that there is room for has no bound then: nobody is culled there early, and the lock turns away \
         whom it must",
    ),
    (
        "storage/bounded_regions",
        "if frame.k > ARRAY_MOST {",
        "if frame.k >= ARRAY_MOST {",
        "array and heap keep the same fragments: which of them does is a matter of speed",
    ),
    (
        "storage/bounded_regions",
        "if slot >= size || begin + slot >= frame.kept {",
        "if slot > size || begin + slot >= frame.kept {",
        "slots count down from size - 1 to 0 and then wrap to far beyond any region: none is size itself",
    ),
    (
        "storage/bounded_regions",
        "return bounded_regions_cursor(pixel, select(left, 0u, left > size));",
        "return bounded_regions_cursor(pixel, select(left, 0u, left >= size));",
        "as many are left as the region has slots only where it has none: positions are invariant, so whoever was counted \
         comes again",
    ),
    (
        "storage/wide_cascade",
        "return packed_with(packed_of_key(key), 0u, u32(wide - (u64(key) << 32u)));",
        "return packed_with(packed_of_key(key), 0u, u32(wide - (u64(key) << 33u)));",
        "what is taken off does not touch the lower word, and u32() takes the lower word here; the template takes \
         the upper one off all the same, so as to rest on no language's rule for numbers that are too great",
    ),
    (
        "storage/distinct_cascade",
        "if key >= entry.key {",
        "if key > entry.key {",
        "a way out early: slots behind that of a key have greater ones",
    ),
    ("storage/distinct_cascade", "return;", "", "the same, in the second pass"),
    (
        "storage/depth_ranges",
        "entries_store(slot, pixel, entry); keys_store(slot, pixel, entry.key);",
        "keys_store(slot, pixel, entry.key); entries_store(slot, pixel, entry);",
        "inside the critical section nobody reads between the two, and nothing is read outside it",
    ),
    ("sync/spin_lock", "const TAKEN = 1u;", "const TAKEN = 2u;", "every word but FREE means taken"),
    (
        "sync/spin_lock",
        "for (var attempt = 0u; attempt < SPIN_LIMIT; attempt++) {",
        "for (var attempt = 0u; attempt <= SPIN_LIMIT; attempt++) {",
        "one try more: the number of tries is a bound, not a promise",
    ),
];
