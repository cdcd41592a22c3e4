// Draws the scene before the store pass, for a cull that needs to know which parts of their range each pixel's keys
// occupy: the same fragments and constraints.

@fragment
fn occupancy_map(inputs: FragmentInput) {
    occupancy_map_fragment(inputs.position.xy, fragment_from_inputs(inputs));
}

/// Marks the bucket of one fragment. `position` is the fragment's, in pixels.
fn occupancy_map_fragment(position: vec2<f32>, fragment: Fragment) {
    if fragment_enters(position, fragment) {
        cull_occupancy_map(pixel_index(position), fragment_pack(fragment));
    }
}
