//! Stencil routing (Myers & Bavoil 2007): the i-th fragment of a pixel is stored in its sample i. At edges it is correct only
//! with whole-pixel coverage.

use fragbuf_cpu::{Code, FragmentOrder};
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, Coverage, Pass, Repeat, Row, Samples, StencilOperation, StencilState, Step, TextureFormat,
    Until,
};
use std::sync::Arc;

use crate::stage::{FAR, built_in, code, device, different, draw, fragments, picture, sampled, scattered, storage};

const STORE_ROUTED: &str = "
struct Stored {
    @location(0) depth: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn store_routed(inputs: FragmentInput) -> Stored {
    let fragment = fragment_from_inputs(inputs);
    return Stored(fragment.depth, fragment.color);
}
";

const NOTHING: &str = "
@fragment
fn nothing() {}
";

const RESOLVE_SAMPLES: &str = "
@fragment
fn resolve_samples(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = pixel_index(position.xy);
    var sum = vec4<f32>();
    var last = -1.0;
    // Selects the nearest sample behind the last one, once per sample.
    for (var layer = 0u; layer < textureNumSamples(depths); layer++) {
        var nearest = 1.0;
        var color = vec4<f32>();
        for (var sample = 0u; sample < frame.k; sample++) {
            let depth = depths_load(sample, pixel);
            if depth > last && depth < nearest {
                nearest = depth;
                color = colors_load(sample, pixel);
            }
        }
        sum += (1.0 - sum.a) * vec4<f32>(color.rgb * color.a, color.a);
        last = nearest;
    }
    return sum;
}
";

const SKELETONS: [(&str, &str); 3] =
    [("nothing", NOTHING), ("store_routed", STORE_ROUTED), ("resolve_samples", RESOLVE_SAMPLES)];

/// The pass that counts the pixels with more fragments than samples. It is an occlusion query, because a shader that counts
/// would run before the test.
const OVERFLOW: usize = 2;

fn stencil(compare: Compare, both: [StencilOperation; 2], reference: &'static str) -> Option<StencilState> {
    let [fail, pass] = both;
    Some(StencilState { resource: "routing".to_owned(), compare, fail, pass, reference: reference.into() })
}

fn rows(coverage: Coverage) -> Row {
    use StencilOperation::{DecrementClamp, Keep, Replace};
    let samples = |mask: &'static str| Some(Samples { count: "capacity".into(), mask: mask.into(), coverage });
    let mut route = Pass::fullscreen("route", "nothing");
    route.state.stencil = stencil(Compare::Always, [Keep, Replace], "iteration + 2");
    route.state.samples = samples("pow2(iteration)");
    let mut store =
        Pass::geometry("store", "store_routed").target("depths", Blend::Replace).target("colors", Blend::Replace);
    store.state.stencil = stencil(Compare::Equal, [DecrementClamp, DecrementClamp], "2");
    store.state.samples = samples("pow2(capacity) - 1");
    let mut overflow = Pass::fullscreen("overflow", "nothing");
    overflow.state.stencil = stencil(Compare::Equal, [Keep, Keep], "0");
    overflow.state.samples = samples("pow2(capacity - 1)");
    let clears = Repeat::new(vec![Step::Pass(route)], Until::Times("k".into()), "k");
    storage(
        vec![
            sampled("depths", TextureFormat::R32Float).cleared(FAR),
            sampled("colors", TextureFormat::Rgba8Unorm),
            sampled("routing", TextureFormat::Depth24PlusStencil8),
        ],
        vec![
            Step::Repeat(clears),
            Step::Pass(store),
            Step::Pass(overflow),
            Step::Pass(picture("resolve_samples").uses("depths", Access::Sampled).uses("colors", Access::Sampled)),
        ],
    )
}

fn routed(coverage: Coverage, k: u32) -> Arc<Code> {
    code(rows(coverage), &SKELETONS, Some(k)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_fragment_gets_a_separate_sample_at_edges_too() {
    for (k, count, seed) in [(2, 2, 6), (4, 4, 2), (8, 8, 3), (8, 8, 4)] {
        let triangles = scattered(count, seed);
        let expected = draw(&mut built_in("ab_ll"), &triangles);
        for order in [FragmentOrder::Submission, FragmentOrder::Shuffled(7)] {
            let mut device = device(&routed(Coverage::WholePixel, k), order);
            let seen = draw(&mut device, &triangles);
            assert_eq!(different(&seen.pixels, &expected.pixels, 1.0 / 255.0), 0, "k = {k}, seed {seed}");
            assert_eq!(seen.samples[OVERFLOW], 0, "k = {k}");
        }
        // With multisample coverage, fragments at edges cover a part of the samples.
        let split = draw(&mut device(&routed(Coverage::PerSample, k), FragmentOrder::Submission), &triangles);
        assert!(different(&split.pixels, &expected.pixels, 1.0 / 255.0) > 4, "k = {k}, seed {seed}");
    }
}

#[test]
fn pixels_with_more_fragments_than_samples_are_counted() {
    for seed in 9..12 {
        let triangles = scattered(24, seed);
        let seen = draw(&mut device(&routed(Coverage::WholePixel, 4), FragmentOrder::Submission), &triangles);
        let over_capacity = fragments(&triangles).into_iter().filter(|count| *count > 4).count();
        assert!(over_capacity > 10);
        assert_eq!(seen.samples[OVERFLOW], over_capacity as u64, "seed {seed}");
    }
}
