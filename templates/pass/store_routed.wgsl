// Stores the scene's fragments in multisampled targets; the stencil test selects the samples that receive them. A
// fragment with partial coverage is routed in the samples that it covers, independently of the others; it is counted.

/// One bit per sample of a pixel.
const WHOLE_PIXEL = (1u << CAPACITY) - 1u;

@fragment
fn store(inputs: FragmentInput, @builtin(sample_mask) covered: u32) -> Targets {
    let fragment = fragment_from_inputs(inputs);
    if !fragment_enters_counted(inputs.position.xy, fragment) {
        discard;
    }
    if covered != WHOLE_PIXEL {
        count_loss(PARTIAL_COVERAGE);
    }
    return fragment_targets(fragment_pack(fragment));
}
