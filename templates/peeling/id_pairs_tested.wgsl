// Peeling of fragments of equal depth by their ids, behind a depth test (Vasilakis & Fudos 2013, D13 sec. 3.1.2:
// F2B-3P). As id_pairs, but an iteration begins with a draw that does little: it writes the depth of the nearest
// fragment that is left. In the two draws that find the ids and store their fragments, an early depth test then
// rejects all fragments of other depths before they are shaded.
//
// The result does not rely on the depth test: the first draw also finds the key of the layer, and the others compare
// it.
//
// Invariant: the fragments composited so far are those of all layers before the last one, and those of the last one
// whose ids are not between the two of the window. The loop ends with an iteration that finds nothing. The last
// iteration that is allowed stores nothing: it counts the fragments that remain.
//
// Memory: 15 words per pixel, and one word.

/// The only side, and the slots of an iteration's fragments, which are also parts of what has been composited.
const PEELING_FRONT = 0u;
const PEELING_LEAST = 0u;
const PEELING_GREATEST = 1u;

/// The pixel that is resolved, and the slot.
var<private> peeling_pixel: u32;
var<private> peeling_part: u32;

fn peeling_find(pixel: u32, entry: Packed) {
    if FIND_IDS == 0u {
        peeling_find_layer(pixel, entry.key);
        return;
    }
    if peeling_is_in_layer(pixel, entry) {
        id_pairs_find(PEELING_FRONT, pixel, id_pairs_id(entry));
    }
}

/// Finds the key of the nearest fragments that are left.
fn peeling_find_layer(pixel: u32, key: u32) {
    if frame.iteration + 1u == PEELING_ITERATIONS {
        // No iteration follows, and the loop ends at its limit.
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return;
    }
    id_pairs_find_next(PEELING_FRONT, pixel, key);
}

fn peeling_is_left(pixel: u32, entry: Packed) -> bool {
    let last = window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
    let id = id_pairs_id(entry);
    return last == EMPTY || entry.key > last
        || (entry.key == last && id > window_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel)
            && ~id > window_load(ID_PAIRS_GREATEST, PEELING_FRONT, pixel));
}

fn peeling_is_in_layer(pixel: u32, entry: Packed) -> bool {
    return entry.key == found_load(ID_PAIRS_NEXT, PEELING_FRONT, pixel) && peeling_is_left(pixel, entry);
}

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    return !peeling_takes(pixel_index(position), fragment_pack(fragment));
}

/// Returns whether this iteration stores a fragment.
fn peeling_takes(pixel: u32, entry: Packed) -> bool {
    return peeling_is_in_layer(pixel, entry) && id_pairs_takes(PEELING_FRONT, pixel, id_pairs_id(entry));
}

/// The draw that finds the layer counts fragments.
fn peeling_is_first(position: vec2<f32>) -> bool {
    return false;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    return peeling_takes(pixel_index(position), fragment_pack(fragment));
}

fn peeling_resume(pixel: u32) {
    peeling_pixel = pixel;
}

fn peeling_slots() -> u32 {
    return PEELING_SLOTS;
}

fn peeling_slot(pixel: u32, entry: Packed) -> u32 {
    let is_least = id_pairs_id(entry) == found_load(ID_PAIRS_LEAST, PEELING_FRONT, pixel);
    return select(PEELING_GREATEST, PEELING_LEAST, is_least);
}

fn peeling_begin(slot: u32) {
    peeling_part = slot;
    let layer = found_load(ID_PAIRS_NEXT, PEELING_FRONT, peeling_pixel);
    if slot == PEELING_LEAST && layer != window_load(ID_PAIRS_KEY, PEELING_FRONT, peeling_pixel) {
        // The last layer has ended.
        accumulated_join(PEELING_LEAST, PEELING_GREATEST, peeling_pixel);
    }
}

fn peeling_layer_count(sorted: u32) -> u32 {
    return sorted;
}

fn peeling_is_copy(index: u32) -> bool {
    return false;
}

fn peeling_copy() -> Packed {
    return packed_of_key(EMPTY);
}

fn peeling_sorted_index(index: u32) -> u32 {
    return index;
}

fn peeling_color(transparent: vec3<f32>) -> vec3<f32> {
    if peeling_part == PEELING_LEAST {
        return accumulated_color(peeling_pixel);
    }
    // The fragments with the greatest id are composited alone, and then over those behind them.
    return transparent;
}

fn peeling_transmittance() -> f32 {
    if peeling_part == PEELING_LEAST {
        return accumulated_transmittance(peeling_pixel);
    }
    return 1.0;
}

fn peeling_suspend(color: vec3<f32>, transmittance: f32) {
    var composited = vec4<f32>(color, transmittance);
    if peeling_part == PEELING_GREATEST {
        composited = accumulated_over(composited, accumulated_part(PEELING_GREATEST, peeling_pixel));
    }
    accumulated_save_part(peeling_part, peeling_pixel, composited);
}

fn peeling_advance() {
    let layer = found_load(ID_PAIRS_NEXT, PEELING_FRONT, peeling_pixel);
    if layer == EMPTY {
        return;
    }
    window_store(ID_PAIRS_KEY, PEELING_FRONT, peeling_pixel, layer);
    for (var word = ID_PAIRS_LEAST; word <= ID_PAIRS_GREATEST; word++) {
        window_store(word, PEELING_FRONT, peeling_pixel, found_load(word, PEELING_FRONT, peeling_pixel));
    }
}

fn peeling_reached(pixel: u32) -> u32 {
    return window_load(ID_PAIRS_KEY, PEELING_FRONT, pixel);
}

fn peeling_result(pixel: u32) -> vec4<f32> {
    let all = accumulated_over(accumulated_part(PEELING_LEAST, pixel), accumulated_part(PEELING_GREATEST, pixel));
    return vec4<f32>(all.rgb, 1.0 - all.a);
}
