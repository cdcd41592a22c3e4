//! Early termination of blending (`resolve.opaque`): the error is within the bound of the parameter, and a sort that reads on demand
//! reads less.

use fragbuf_codegen::Form;
use fragbuf_model::{Draft, SourceSpan, check};
use fragbuf_runtime::{PoolSize, Settings, Shaders, Sizing};
use fragbuf_targets::{Request, generate, target};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Template;

use crate::order::Numbers;
use crate::quads::{Quad, SIZE};
use crate::stage::{device, render_frame, renderer, settings, shaders, technique};

/// Returns layers over the whole frame, of random colours and from faint to almost opaque. White over black comes closest to the
/// bound.
fn piles() -> Vec<Vec<Quad>> {
    let mut numbers = Numbers::seeded(5);
    let mut pile = |count: u32, alpha: (u32, u32)| -> Vec<Quad> {
        let quad = |id| {
            let [red, green, blue] = std::array::from_fn(|_| numbers.below(256) as u8);
            let alpha = (alpha.0 + numbers.below(alpha.1 - alpha.0)) as u8;
            Quad::whole(numbers.below(64) as f32 / 64.0, [red, green, blue, alpha]).named(id)
        };
        (0..count).map(quad).collect()
    };
    let mut piles = vec![pile(60, (1, 255)), pile(60, (20, 60)), pile(5, (200, 255)), pile(40, (250, 255))];
    let black_before_white = (0..60).map(|id| {
        let shade = if id < 20 { 0 } else { 255 };
        Quad::whole(id as f32 / 64.0, [shade, shade, shade, 40])
    });
    piles.push(black_before_white.collect());
    piles
}

#[test]
fn the_error_is_within_the_bound() {
    let stage = device();
    let roomy = Settings { sizing: Sizing::Capacity(PoolSize::Fragments(64 * SIZE * SIZE)), ..settings() };
    for sort in ["insertion", "lplus", "block"] {
        let exact = |opaque: &str| {
            let set = [("sort", sort), ("resolve.opaque", opaque)];
            let mut renderer = renderer(&stage, &shaders(&technique("ab_ll", &set), "wgsl"), &roomy).unwrap();
            piles().iter().map(|quads| render_frame(&stage, &mut renderer, quads).pixels).collect::<Vec<_>>()
        };
        let whole = exact("0");
        for opaque in [1_u32, 10, 100, 500] {
            let mut difference = 0.0_f32;
            for (whole, ended) in whole.iter().zip(exact(&opaque.to_string())) {
                // The background's share of the light is missing too, at most 1 per channel.
                let channels = whole.iter().flatten().zip(ended.iter().flatten());
                difference = channels.fold(difference, |most, (whole, ended)| most.max((whole - ended).abs()));
            }
            // The target has half floats.
            assert!(difference <= opaque as f32 / 1000.0 + 1.0 / 1024.0, "{sort}: {difference} for {opaque}");
            assert!(
                opaque < 10 || difference > 0.05 * opaque as f32 / 1000.0,
                "{sort}: {difference} for {opaque}: blending never ended early"
            );
        }
    }
}

/// Returns the registry with a linked list that counts its reads as generated fragments. The store pass counts one per fragment
/// too.
fn counting_reads() -> Registry {
    let registry = Registry::builtin();
    let mut list = registry.row("storage", "linked_list").unwrap().clone();
    let text = list.template.as_ref().unwrap().source.replace(
        "-> Packed {\n    return nodes_load(cursor);",
        "-> Packed {\n    count_event(GENERATED);\n    return nodes_load(cursor);",
    );
    assert!(text.contains("count_event"));
    list.template = Some(Template::new("counting.wgsl", text));
    list.calls.push("counters");
    registry.with(list)
}

#[test]
fn invisible_fragments_are_not_read() {
    let stage = device();
    let registry = counting_reads();
    let roomy = Settings { sizing: Sizing::Capacity(PoolSize::Fragments(64 * SIZE * SIZE)), ..settings() };
    let reads = |opaque: &str, quads: &[Quad]| {
        let span = SourceSpan::new("ab_ll", 1, 1);
        let mut draft = Draft::from_technique("ab_ll", &span);
        for (name, value) in [("sort", "lplus"), ("sort.batch", "4"), ("counters", "all"), ("resolve.opaque", opaque)] {
            draft.set(name, value, &span).unwrap();
        }
        let variant = check(&draft, &registry).unwrap();
        let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &registry).unwrap();
        let shaders = Shaders::from_generation(&generation, "wgsl", 0).unwrap();
        let mut renderer = renderer(&stage, &shaders, &roomy).unwrap();
        let seen = render_frame(&stage, &mut renderer, quads);
        seen.counters.get("generated") / (SIZE * SIZE) - quads.len() as u32
    };
    // The fifth of 32 layers, in the second batch, transmits 1/255 of the light.
    let layer = |id: u32| Quad::whole(id as f32 / 32.0, [0, 0, 255, if id == 4 { 254 } else { 10 }]).named(id);
    let quads: Vec<Quad> = (0..32).map(layer).collect();
    // Each of eight batches reads the list; with early termination, two do.
    assert_eq!(reads("0", &quads), 8 * 32);
    assert_eq!(reads("10", &quads), 2 * 32);
}
