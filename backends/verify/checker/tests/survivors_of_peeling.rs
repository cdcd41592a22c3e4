//! Mutants of peeling that survive, each with its reason.

/// The reason of mutants that change only colours.
const COLORS: &str = "colours are none of the checker's: test `peeling` of the runtime";

/// Functions of peeling that are none of the checker's, so their mutants are not judged here: the depth that objects are culled
/// by, which `culled_objects` of the runtime tests.
pub(crate) const JUDGED_ELSEWHERE: [&str; 1] = ["peeling_reached"];

/// Row, line, mutated line, and the reason why the checker cannot kill the mutant.
pub(crate) const OF_PEELING: &[(&str, &str, &str, &str)] = &[
    (
        "peeling/k_layers",
        "boundary_store(pixel, last); unpeeled_store(PEELING_COPIES, pixel, 0u - copies);",
        "unpeeled_store(PEELING_COPIES, pixel, 0u - copies); boundary_store(pixel, last);",
        "one invocation per pixel, and no other reads them",
    ),
    (
        "peeling/k_layers",
        "if kept == 0u || done >= before {",
        "if kept == 0u || done > before {",
        "one more iteration, without fragments: test `peeling` of the runtime",
    ),
    ("peeling/k_layers", "last = entry; copies = 1u;", "copies = 1u; last = entry;", "variables of one invocation"),
    (
        "peeling/k_layers",
        "last = packed_of_key(0u);",
        "last = packed_of_key(1u);",
        "a pixel without fragments: only the count of hidden ones depends on it",
    ),
    ("peeling/k_layers", "remaining_store(1u);", "remaining_store(2u);", "any number but zero"),
    ("peeling/k_layers", "return index < peeling_copies;", "return index <= peeling_copies;", COLORS),
    (
        "peeling/k_layers",
        "unpeeled_store(PEELING_LEFT, pixel, before - done); remaining_store(1u);",
        "remaining_store(1u); unpeeled_store(PEELING_LEFT, pixel, before - done);",
        "one invocation per pixel, and no other reads them",
    ),
    (
        "peeling/k_layers",
        "var copies = 0u;",
        "var copies = 1u;",
        "of a pixel with fragments, the first sets it; one without has none left",
    ),
    (
        "peeling/k_layers",
        "count_losses(NOT_CONVERGED, met - peeling_copies);",
        "",
        "more copies than all iterations could keep: test `peeling` of the runtime",
    ),
    (
        "peeling/k_layers",
        "count_losses(NOT_CONVERGED, met - peeling_copies); boundary_store(pixel, last);",
        "boundary_store(pixel, last); count_losses(NOT_CONVERGED, met - peeling_copies);",
        "one invocation per pixel, and no other reads them",
    ),
    (
        "peeling/both_sides",
        "const PEELING_BACK = 1u;",
        "const PEELING_BACK = 0u;",
        "both sides share the words of one, and the loop takes more iterations: test `peeling` of the runtime counts them",
    ),
    (
        "peeling/both_sides",
        "const PEELING_FRONT = 0u;",
        "const PEELING_FRONT = 1u;",
        "both sides share the words of one, and the loop takes more iterations: test `peeling` of the runtime counts them",
    ),
    (
        "peeling/both_sides",
        "if key < layer_keys_load(PEELING_FRONT, pixel) {",
        "if key <= layer_keys_load(PEELING_FRONT, pixel) {",
        "a minimum that changes nothing",
    ),
    (
        "peeling/both_sides",
        "if key < next_keys_load(PEELING_FRONT, pixel) && next_keys_atomic_min(PEELING_FRONT, pixel, key) == EMPTY {",
        "if key <= next_keys_load(PEELING_FRONT, pixel) && next_keys_atomic_min(PEELING_FRONT, pixel, key) == EMPTY {",
        "a minimum that changes nothing",
    ),
    (
        "peeling/both_sides",
        "if ~key < layer_keys_load(PEELING_BACK, pixel) {",
        "if ~key <= layer_keys_load(PEELING_BACK, pixel) {",
        "a minimum that changes nothing",
    ),
    (
        "peeling/both_sides",
        "if ~key < next_keys_load(PEELING_BACK, pixel) {",
        "if ~key <= next_keys_load(PEELING_BACK, pixel) {",
        "a minimum that changes nothing",
    ),
    ("peeling/both_sides", "remaining_store(1u);", "remaining_store(2u);", "any number but zero"),
    (
        "peeling/both_sides",
        "return key == front || (key > front && ~key == layer_keys_load(PEELING_BACK, pixel));",
        "return key == front || (key >= front && ~key == layer_keys_load(PEELING_BACK, pixel));",
        "an equal key has been compared before",
    ),
    ("peeling/both_sides", "return;", "", "no iteration follows that reads what is found"),
    (
        "peeling/depth_layers",
        "if frame.iteration + 1u == PEELING_ITERATIONS {",
        "if frame.iteration + 2u == PEELING_ITERATIONS {",
        "the loop ends an iteration earlier and counts what is left: test `peeling` of the runtime",
    ),
    (
        "peeling/depth_layers",
        "if key < layer_keys_load(pixel) {",
        "if key <= layer_keys_load(pixel) {",
        "a minimum that changes nothing",
    ),
    (
        "peeling/depth_layers",
        "if key < next_keys_load(pixel) && next_keys_atomic_min(pixel, key) == EMPTY {",
        "if key <= next_keys_load(pixel) && next_keys_atomic_min(pixel, key) == EMPTY {",
        "a minimum that changes nothing",
    ),
    ("peeling/depth_layers", "remaining_store(1u);", "remaining_store(2u);", "any number but zero"),
    ("peeling/depth_layers", "return;", "", "no iteration follows that reads what is found"),
    (
        "storage/claimed_array",
        "for (var attempt = 0u; attempt < CLAIM_TRIES; attempt++) {",
        "for (var attempt = 0u; attempt <= CLAIM_TRIES; attempt++) {",
        "one more attempt: the number of attempts is a bound, not part of the specification",
    ),
    (
        "storage/claimed_array",
        "return;",
        "",
        "what a helper invocation writes has no effect: it would use all attempts",
    ),
    ("peeling/front_to_back", "remaining_store(1u);", "remaining_store(2u);", "any number but zero"),
    (
        "peeling/front_to_back",
        "return frame.iteration == 0u;",
        "return frame.iteration == 1u;",
        "every iteration draws the same fragments, and there are at least two",
    ),
    (
        "peeling/k_layers",
        "peeling_copies = min(peeling_copies_met(pixel), PEELING_ITERATIONS * frame.k);",
        "",
        "copies are counted as lost instead of composited: test `peeling` of the runtime",
    ),
];
