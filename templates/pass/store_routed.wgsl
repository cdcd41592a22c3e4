// Stores the scene's fragments in targets of several samples; the stencil decides which samples take them. A fragment
// that covers its pixel in part is routed in those samples alone, whatever the others do: it is counted.

/// One bit for each sample of a pixel.
const WHOLE_PIXEL = (1u << CAPACITY) - 1u;

@fragment
fn store(varyings: Varyings, @builtin(sample_mask) covered: u32) -> Targets {
    let fragment = varyings_fragment(varyings);
    if !admit(fragment) {
        discard;
    }
    if opaque_hides(varyings.position.xy, fragment) {
        count_event(OCCLUDED);
        discard;
    }
    count_event(GENERATED);
    if covered != WHOLE_PIXEL {
        count_loss(PARTLY_COVERED);
    }
    return fragment_targets(fragment_pack(fragment));
}
