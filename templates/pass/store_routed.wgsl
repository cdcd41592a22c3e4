// Stores the scene's fragments in targets of several samples; the stencil decides which samples take them. A fragment
// that covers its pixel in part is routed in those samples alone, whatever the others do: it is counted.

/// One bit for each sample of a pixel.
const WHOLE_PIXEL = (1u << CAPACITY) - 1u;

@fragment
fn store(varyings: Varyings, @builtin(sample_mask) covered: u32) -> Targets {
    let fragment = varyings_fragment(varyings);
    if !fragment_enters_counted(varyings.position.xy, fragment) {
        discard;
    }
    if covered != WHOLE_PIXEL {
        count_loss(PARTLY_COVERED);
    }
    return fragment_targets(fragment_pack(fragment));
}
