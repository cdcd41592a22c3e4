// Multisample antialiasing by coverage (K15 sec. 5.3; Myers & Bavoil 2007): a pixel of SAMPLES samples keeps its
// fragments in one place, and each carries the mask of the samples that it covers. The effect runs once per sample
// over the fragments that cover it, and the pixel's colour is the mean.
//
// What is kept, and in which order it comes, is decided for the whole pixel: attributes and depth are those at its
// middle, as everywhere where shaders run once per pixel. So samples are those of supersampling except where surfaces
// cross inside of one pixel; and two triangles that share an edge are two fragments of the pixels along it. What an
// overflow makes of lost fragments is one colour for the pixel, to which each adds as much as it covers.
//
// Memory: 1 word per fragment.

/// Of each sample, how many fragments cover it.
var<private> covered_counts: array<u32, SAMPLES>;
/// The sample that the effect runs for.
var<private> covered_sample: u32;
/// The fragment that was asked for last: its number among those that cover the sample, and its place among all.
var<private> covered_number: u32;
var<private> covered_place: u32;

fn samples_resolve() -> vec4<f32> {
    for (var sample = 0u; sample < SAMPLES; sample++) {
        covered_counts[sample] = 0u;
    }
    for (var place = 0u; place < sorted_count(); place++) {
        let coverage = sorted_layer(place).coverage;
        for (var sample = 0u; sample < SAMPLES; sample++) {
            covered_counts[sample] += (coverage >> sample) & 1u;
        }
    }
    var sum = vec4<f32>(0.0);
    for (var sample = 0u; sample < SAMPLES; sample++) {
        if covered_counts[sample] > 0u {
            covered_sample = sample;
            covered_first();
            sum += resolve_layers();
        }
    }
    return sum / f32(SAMPLES);
}

fn samples_share(entry: Packed) -> f32 {
    return f32(countOneBits(fragment_unpack(entry).coverage)) / f32(SAMPLES);
}

fn layer_count() -> u32 {
    return covered_counts[covered_sample];
}

fn layer(index: u32) -> Fragment {
    if index < covered_number {
        covered_first();
    }
    while covered_number < index && covered_number + 1u < layer_count() {
        covered_number += 1u;
        covered_place = covered_from(covered_place + 1u);
    }
    return sorted_layer(covered_place);
}

fn covered_first() {
    covered_number = 0u;
    covered_place = covered_from(0u);
}

/// The place of the first fragment from `place` on that covers the sample.
fn covered_from(place: u32) -> u32 {
    var found = place;
    while found + 1u < sorted_count() && ((sorted_layer(found).coverage >> covered_sample) & 1u) == 0u {
        found += 1u;
    }
    return found;
}
