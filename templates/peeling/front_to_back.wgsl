// Front-to-back depth peeling (Everitt 2001; Vasilakis & Fudos 2013, D13 sec. 3.1.1: F2B). An iteration keeps the
// nearest of the fragments behind the one that the last iteration kept, in any storage of one fragment: by the depth
// test, or by a lock. The effect goes on where it stopped. Of fragments with equal depths one is kept.
//
// Invariant: the last key is the greatest that an iteration has kept, and no fragment of a lesser or equal key enters.
// The loop ends with an iteration that keeps nothing, so D layers take D + 1 iterations. The last iteration that is
// allowed keeps nothing: it counts the fragments that remain.
//
// Memory: 5 words per pixel, and one word.

fn peeling_skips(position: vec2<f32>, fragment: Fragment) -> bool {
    let last = last_keys_load(pixel_index(position));
    return last != EMPTY && fragment_pack(fragment).key <= last;
}

fn peeling_is_first(position: vec2<f32>) -> bool {
    return frame.iteration == 0u;
}

fn peeling_admits(position: vec2<f32>, fragment: Fragment) -> bool {
    if peeling_skips(position, fragment) {
        return false;
    }
    if frame.iteration + 1u == PEELING_ITERATIONS {
        count_loss(NOT_CONVERGED);
        remaining_store(1u);
        return false;
    }
    return true;
}

fn peeling_advance() {
    let cursor = resolve_first();
    if cursor != END {
        last_keys_store(accumulated_pixel, resolve_read(cursor).key);
        remaining_store(1u);
    }
}

fn peeling_reached(pixel: u32) -> u32 {
    return last_keys_load(pixel);
}
