// What every pass over the scene asks of a fragment first. Passes that draw the same scene must ask the same.

/// Whether a fragment takes part in the frame: it meets the constraints, and no opaque surface hides it. `position` is
/// the fragment's, in pixels.
fn fragment_enters(position: vec2<f32>, fragment: Fragment) -> bool {
    return admit(fragment) && !opaque_hides(position, fragment);
}

/// The same for the one pass of a frame that counts fragments.
fn fragment_enters_counted(position: vec2<f32>, fragment: Fragment) -> bool {
    if !admit(fragment) {
        return false;
    }
    if opaque_hides(position, fragment) {
        count_event(OCCLUDED);
        return false;
    }
    count_event(GENERATED);
    return true;
}
