//! Passes with attachments and interleaved shaders: fixed-function operations keep the submission order, shared memory does
//! not.

use fragbuf_cpu::{Code, FragmentOrder};
use fragbuf_frame::LoopEnd;
use fragbuf_templates::vocabulary::{
    Access, Blend, Compare, DepthState, Element, Pass, Repeat, Resource, Row, Step, TextureFormat, Until,
};
use std::sync::Arc;

use crate::stage::{FAR, Triangle, code, device, draw, numbers, stacked, storage, texture};

const SEEDS: std::ops::Range<u64> = 0..6;

/// Liu et al. 2009: stores k unordered keys without a lock, repeated until no key changes.
const STORE_AGAIN: &str = "
@fragment
fn store_again(inputs: FragmentInput) -> @location(0) vec4<f32> {
    let entry = fragment_pack(fragment_from_inputs(inputs));
    let pixel = pixel_index(inputs.position.xy);
    var worst = 0u;
    var worst_key = 0u;
    for (var slot = 0u; slot < frame.k; slot++) {
        let key = keys_load(slot, pixel);
        if key == entry.key {
            return vec4<f32>(inputs.position.z);
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
    return vec4<f32>(inputs.position.z);
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
        vec![Step::Repeat(Repeat::new(body, Until::WordIsZero("changed".to_owned()), at_most))],
    );
    code(rows, &[("store_again", STORE_AGAIN)], Some(4)).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the keys of each pixel in ascending order.
fn kept(words: &[u32]) -> Vec<Vec<u32>> {
    let pixels = words.len() / 4;
    let mut kept: Vec<Vec<u32>> =
        (0..pixels).map(|pixel| (0..4).map(|slot| words[slot * pixels + pixel]).collect()).collect();
    kept.iter_mut().for_each(|keys| keys.sort_unstable());
    kept
}

#[test]
fn repeated_passes_restore_keys_lost_to_races() {
    let (whole, once) = (repeated("64"), repeated("1"));
    let triangles = stacked(14, 2);
    let mut in_order = device(&whole, FragmentOrder::Submission);
    let first = draw(&mut in_order, &triangles);
    // In submission order the first iteration keeps all keys; the second changes nothing.
    assert_eq!((first.loops[0].iterations, first.loops[0].end), (2, LoopEnd::ConditionMet));
    let expected = kept(&in_order.words("keys").unwrap());
    let drawn = in_order.words("last_drawn").unwrap();
    let mut races = 0;
    for seed in SEEDS {
        let mut repaired = device(&whole, FragmentOrder::Shuffled(seed));
        let picture = draw(&mut repaired, &triangles);
        assert_eq!(picture.loops[0].end, LoopEnd::ConditionMet);
        assert!(picture.loops[0].iterations > 2, "seed {seed} shows no race");
        assert!(kept(&repaired.words("keys").unwrap()) == expected, "seed {seed}");
        // The depth test does not depend on the order of the shaders.
        assert!(repaired.words("last_drawn").unwrap() == drawn && picture.samples == first.samples, "seed {seed}");
        assert!(repaired.words("nearest") == in_order.words("nearest"), "seed {seed}");
        let mut racing = device(&once, FragmentOrder::Shuffled(seed));
        assert_eq!(draw(&mut racing, &triangles).loops[0].end, LoopEnd::LimitReached);
        races +=
            kept(&racing.words("keys").unwrap()).iter().zip(&expected).filter(|(seen, right)| seen != right).count();
    }
    assert!(races > 100, "{races} pixels lost fragments in a single iteration");
}

/// Fragments of one triangle alone never overlap, so nothing is lost; a wider window loses more than a narrow one.
#[test]
fn a_window_limits_which_fragments_overlap() {
    let once = repeated("1");
    let triangles = stacked(14, 2);
    let mut in_order = device(&once, FragmentOrder::Submission);
    draw(&mut in_order, &triangles);
    let expected = kept(&in_order.words("keys").unwrap());
    let lost = |triangles_in_flight: u32| -> usize {
        let of = |seed: u64| {
            let mut racing = device(&once, FragmentOrder::Window { seed, triangles: triangles_in_flight });
            draw(&mut racing, &triangles);
            let kept = kept(&racing.words("keys").unwrap());
            kept.iter().zip(&expected).filter(|(seen, right)| seen != right).count()
        };
        SEEDS.map(of).sum()
    };
    let counts = [1, 3, 1 << 20].map(lost);
    assert!(counts[0] == 0 && 0 < counts[1] && counts[1] < counts[2], "{counts:?}");
}

const COUNT_RUNS: &str = "
@fragment
fn count_runs(inputs: FragmentInput) -> @location(0) vec4<f32> {
    let pixel = pixel_index(inputs.position.xy);
    let order = runs_atomic_add(pixel, 1u);
    let color = fragment_from_inputs(inputs).color;
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

/// Returns triangles in an order that is neither front to back nor back to front.
fn mixed() -> Vec<Triangle> {
    let (mut triangles, mut number) = (stacked(12, 4), numbers(5));
    for at in (1..triangles.len()).rev() {
        triangles.swap(at, (number() * at as f32) as usize);
    }
    triangles
}

#[test]
fn blending_keeps_the_submission_order_under_any_schedule() {
    for blend in [Blend::Over, Blend::Under, Blend::Replace] {
        let expected = draw(&mut device(&blended(false, blend), FragmentOrder::Submission), &mixed());
        for seed in SEEDS {
            let seen = draw(&mut device(&blended(false, blend), FragmentOrder::Shuffled(seed)), &mixed());
            assert!(seen.pixels == expected.pixels, "{blend:?}, seed {seed}");
        }
    }
}

/// The number of fragments that run depends only on the submission order.
#[test]
fn early_tests_keep_the_submission_order_under_any_schedule() {
    let mut in_order = device(&blended(true, Blend::Over), FragmentOrder::Submission);
    let expected = draw(&mut in_order, &mixed());
    let runs = in_order.words("runs").unwrap();
    let all = crate::stage::fragments(&mixed());
    assert!(runs.iter().zip(&all).filter(|(runs, all)| runs < all).count() > 50, "the tests reject fragments");
    for seed in SEEDS {
        let mut shuffled = device(&blended(true, Blend::Over), FragmentOrder::Shuffled(seed));
        let seen = draw(&mut shuffled, &mixed());
        assert!(shuffled.words("runs").unwrap() == runs && seen.pixels == expected.pixels, "seed {seed}");
        assert_eq!(seen.samples, expected.samples);
    }
}
