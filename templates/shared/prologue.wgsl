// Conditions that every pass over the scene tests first. All passes that draw the scene must test the same conditions.

/// Returns whether a fragment is inside the frame or slice, meets the constraints, no opaque surface hides it, and the
/// iteration takes it. `position` is the fragment's, in pixels.
fn fragment_enters(position: vec2<f32>, fragment: Fragment) -> bool {
    return is_in_frame(position) && admit(fragment) && !opaque_hides(position, fragment)
        && !peeling_skips(position, fragment);
}

/// Returns the same for a pass that no iteration draws.
fn fragment_is_drawn(position: vec2<f32>, fragment: Fragment) -> bool {
    return is_in_frame(position) && admit(fragment) && !opaque_hides(position, fragment);
}

/// Returns the same, and counts the fragment. One pass of a frame calls this function.
fn fragment_enters_counted(position: vec2<f32>, fragment: Fragment) -> bool {
    if !is_in_frame(position) {
        return false;
    }
    if !admit(fragment) {
        return false;
    }
    if opaque_hides(position, fragment) {
        if peeling_is_first(position) {
            count_event(OCCLUDED);
        }
        return false;
    }
    if peeling_is_first(position) {
        count_event(GENERATED);
    }
    return peeling_admits(position, fragment);
}
