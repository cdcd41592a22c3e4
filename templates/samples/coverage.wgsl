// Multisample antialiasing by coverage (K15 sec. 5.3; Myers & Bavoil 2007): the SAMPLES samples of a pixel share one
// storage, and each fragment has the mask of the samples that it covers. The effect runs once per sample over the
// fragments that cover it, and the pixel's colour is the mean.
//
// Which fragments are kept, and in which order, is decided for the whole pixel. Attributes and depth are evaluated at
// the pixel centre, as in any shader that runs once per pixel. So samples equal those of supersampling except where
// surfaces intersect inside a pixel; and two triangles that share an edge are two fragments of the pixels along it. An
// overflow row makes one colour of a pixel's lost fragments, to which each contributes in proportion to its coverage.
//
// Memory: 1 word per fragment.

/// For each sample, the number of fragments that cover it.
var<private> coverage_counts: array<u32, SAMPLES>;
/// The sample that the effect runs for.
var<private> coverage_sample: u32;
/// The last fragment that was read: its index among the fragments that cover the sample, and among all.
var<private> coverage_number: u32;
var<private> coverage_index: u32;

fn samples_resolve() -> vec4<f32> {
    for (var sample = 0u; sample < SAMPLES; sample++) {
        coverage_counts[sample] = 0u;
    }
    for (var index = 0u; index < sorted_count(); index++) {
        let coverage = sorted_layer(index).coverage;
        for (var sample = 0u; sample < SAMPLES; sample++) {
            coverage_counts[sample] += (coverage >> sample) & 1u;
        }
    }
    var sum = vec4<f32>(0.0);
    for (var sample = 0u; sample < SAMPLES; sample++) {
        if coverage_counts[sample] > 0u {
            coverage_sample = sample;
            coverage_first();
            sum += resolve_layers();
        }
    }
    return sum / f32(SAMPLES);
}

fn samples_share(entry: Packed) -> f32 {
    return f32(countOneBits(fragment_unpack(entry).coverage)) / f32(SAMPLES);
}

fn layer_count() -> u32 {
    return coverage_counts[coverage_sample];
}

fn layer(index: u32) -> Fragment {
    if index < coverage_number {
        coverage_first();
    }
    while coverage_number < index && coverage_number + 1u < layer_count() {
        coverage_number += 1u;
        coverage_index = coverage_from(coverage_index + 1u);
    }
    return sorted_layer(coverage_index);
}

fn coverage_first() {
    coverage_number = 0u;
    coverage_index = coverage_from(0u);
}

/// Returns the index of the first fragment from `index` on that covers the sample.
fn coverage_from(index: u32) -> u32 {
    var found = index;
    while found + 1u < sorted_count() && ((sorted_layer(found).coverage >> coverage_sample) & 1u) == 0u {
        found += 1u;
    }
    return found;
}
