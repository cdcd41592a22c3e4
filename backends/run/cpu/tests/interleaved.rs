//! Passes with attachments whose shaders are interleaved: the fixed function keeps the order of submission, what shaders share does not.

use fragbuf_cpu::{Code, Order};
use fragbuf_frame::LoopEnd;
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, DepthState, Element, Pass, Repeat, Resource, Row, Step, TextureFormat, Until,
};
use std::sync::Arc;

use crate::stage::{FAR, Triangle, code, device, draw, numbers, stacked, storage, texture};

const SEEDS: std::ops::Range<u64> = 0..6;

/// Liu et al. 2009: k keys in no order, without a lock, again and again until nothing changes.
const STORE_AGAIN: &str = "
@fragment
fn store_again(varyings: Varyings) -> @location(0) vec4<f32> {
    let entry = fragment_pack(varyings_fragment(varyings));
    let pixel = pixel_index(varyings.position.xy);
    var worst = 0u;
    var worst_key = 0u;
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key == entry.key {
            return vec4<f32>(varyings.position.z);
        }
        if key >= worst_key {
            worst = slot;
            worst_key = key;
        }
    }
    if entry.key < worst_key {
        keys_store(worst, pixel, entry.key);
        changed_store(1u);
    }
    return vec4<f32>(varyings.position.z);
}
";

fn repeated(at_most: &'static str) -> Arc<Code> {
    let mut store = Pass::geometry("store", "store_again")
        .uses("keys", Access::Atomic)
        .uses("changed", Access::Atomic)
        .target("last_drawn", Blend::Replace);
    store.state.depth =
        Some(DepthState { resource: "nearest".to_owned(), compare: Compare::LessEqual, write: true, early: false });
    let body = vec![Step::Clear { resource: "changed".to_owned(), value: 0 }, Step::Pass(store)];
    let rows: Row = storage(
        vec![
            Resource::new("keys", Element::Word, "").by("slot", "k").by("pixel", "pixels").cleared(u32::MAX),
            texture("nearest", TextureFormat::Depth32Float).cleared(FAR),
            texture("last_drawn", TextureFormat::R32Float).cleared(0),
            Resource::new("changed", Element::Word, ""),
        ],
        vec![Step::Repeat(Repeat { body, until: Until::Zero("changed".to_owned()), at_most: at_most.into() })],
    );
    code(rows, &[("store_again", STORE_AGAIN)], Some(4)).unwrap_or_else(|error| panic!("{error}"))
}

/// The keys of each pixel, least first.
fn kept(words: &[u32]) -> Vec<Vec<u32>> {
    let pixels = words.len() / 4;
    let mut kept: Vec<Vec<u32>> =
        (0..pixels).map(|pixel| (0..4).map(|slot| words[slot * pixels + pixel]).collect()).collect();
    kept.iter_mut().for_each(|keys| keys.sort_unstable());
    kept
}

#[test]
fn repeated_passes_repair_what_races_lost() {
    let (whole, once) = (repeated("64"), repeated("1"));
    let triangles = stacked(14, 2);
    let mut in_order = device(&whole, Order::Submission);
    let first = draw(&mut in_order, &triangles);
    // Whatever comes in order is kept at once; the second round changes nothing.
    assert_eq!((first.loops[0].rounds, first.loops[0].end), (2, LoopEnd::Reached));
    let expected = kept(&in_order.words("keys").unwrap());
    let drawn = in_order.words("last_drawn").unwrap();
    let mut races = 0;
    for seed in SEEDS {
        let mut repaired = device(&whole, Order::Shuffled(seed));
        let picture = draw(&mut repaired, &triangles);
        assert_eq!(picture.loops[0].end, LoopEnd::Reached);
        assert!(picture.loops[0].rounds > 2, "seed {seed} shows no race");
        assert!(kept(&repaired.words("keys").unwrap()) == expected, "seed {seed}");
        // What the depth test lets through does not depend on the order of the shaders.
        assert!(repaired.words("last_drawn").unwrap() == drawn && picture.samples == first.samples, "seed {seed}");
        assert!(repaired.words("nearest") == in_order.words("nearest"), "seed {seed}");
        let mut racing = device(&once, Order::Shuffled(seed));
        assert_eq!(draw(&mut racing, &triangles).loops[0].end, LoopEnd::Cut);
        races +=
            kept(&racing.words("keys").unwrap()).iter().zip(&expected).filter(|(seen, right)| seen != right).count();
    }
    assert!(races > 100, "{races} pixels lost fragments in a single round");
}

const COUNT_RUNS: &str = "
@fragment
fn count_runs(varyings: Varyings) -> @location(0) vec4<f32> {
    let pixel = pixel_index(varyings.position.xy);
    let order = runs_atomic_add(pixel, 1u);
    let color = varyings_fragment(varyings).color;
    return vec4<f32>(color.rgb * color.a, color.a);
}
";

fn blended(early: bool, blend: Blend) -> Arc<Code> {
    let mut pass = Pass::geometry("count_runs", "count_runs").uses("runs", Access::Atomic).target("output", blend);
    pass.state.depth = Some(DepthState { resource: "nearest".to_owned(), compare: Compare::Less, write: early, early });
    let rows = storage(
        vec![
            texture("nearest", TextureFormat::Depth32Float).cleared(FAR),
            Resource::new("runs", Element::Word, "").by("pixel", "pixels").cleared(0),
        ],
        vec![Step::Pass(pass)],
    );
    code(rows, &[("count_runs", COUNT_RUNS)], None).unwrap_or_else(|error| panic!("{error}"))
}

/// Triangles in an order that is neither from the front nor from the back.
fn mixed() -> Vec<Triangle> {
    let (mut triangles, mut number) = (stacked(12, 4), numbers(5));
    for at in (1..triangles.len()).rev() {
        triangles.swap(at, (number() * at as f32) as usize);
    }
    triangles
}

#[test]
fn blending_keeps_the_order_of_submission_under_any_schedule() {
    for blend in [Blend::Over, Blend::Under, Blend::Replace] {
        let expected = draw(&mut device(&blended(false, blend), Order::Submission), &mixed());
        for seed in SEEDS {
            let seen = draw(&mut device(&blended(false, blend), Order::Shuffled(seed)), &mixed());
            assert!(seen.pixels == expected.pixels, "{blend:?}, seed {seed}");
        }
    }
}

/// How many fragments run depends on the depths before each: on the order of submission, and on nothing else.
#[test]
fn early_tests_come_in_the_order_of_submission_under_any_schedule() {
    let mut in_order = device(&blended(true, Blend::Over), Order::Submission);
    let expected = draw(&mut in_order, &mixed());
    let runs = in_order.words("runs").unwrap();
    let all = crate::stage::fragments(&mixed());
    assert!(runs.iter().zip(&all).filter(|(runs, all)| runs < all).count() > 50, "tests turn fragments away");
    for seed in SEEDS {
        let mut shuffled = device(&blended(true, Blend::Over), Order::Shuffled(seed));
        let seen = draw(&mut shuffled, &mixed());
        assert!(shuffled.words("runs").unwrap() == runs && seen.pixels == expected.pixels, "seed {seed}");
        assert_eq!(seen.samples, expected.samples);
    }
}
