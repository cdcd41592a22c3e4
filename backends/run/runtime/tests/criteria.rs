//! Compares every criterion on every storage that keeps the k best, and the examples of criteria, with the oracle.

use std::collections::BTreeMap;

use fragbuf_model::{Variant, check};
use fragbuf_runtime::{PoolSize, Renderer, Settings, Sizing, Value};
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Formula, KeepDefault, Row};

use crate::capture::{check_as, compare, scattered};
use crate::oracle::{self, PLAIN, Rules, Words, ordered_key, over};
use crate::order::orders;
use crate::quads::{Quad, SIZE};
use crate::stage::{self, described, render_frame, renderer, settings, shaders, technique};

/// The preferred object, and the plane.
const OBJECT: u32 = 3;
const PLANE: f32 = 0.375;

fn words_of(quad: &Quad, value: f32) -> Words {
    vec![ordered_key(value), u32::from_le_bytes(quad.color), quad.depth.to_bits(), quad.id]
}

/// Reorders words to depth, the other words, the key.
fn nearest_first(mut words: Words) -> Words {
    let key = words.remove(0);
    let (color, depth, id) = (words[0], words[1], words[2]);
    vec![depth, color, id, key]
}

/// Returns criteria in the language, with the oracle's rules.
fn criteria() -> Vec<(&'static str, Rules)> {
    macro_rules! rules {
        ($value:expr) => {
            Rules {
                admits: |_| true,
                words: |quad| words_of(quad, $value(quad)),
                nearer: |quad| nearest_first(words_of(quad, $value(quad))),
                resolve: over,
            }
        };
    }
    vec![
        ("-f.depth", rules!(|quad: &Quad| -quad.depth)),
        ("f.depth - 0.25 * f.color.w", rules!(|quad: &Quad| quad.depth - 0.25 * quad.rgba()[3])),
        (
            "if f.id == u.object { f.depth - 1.0 } else { f.depth }",
            rules!(|quad: &Quad| if quad.id == OBJECT { quad.depth - 1.0 } else { quad.depth }),
        ),
        ("(f.depth - u.plane).abs()", rules!(|quad: &Quad| (quad.depth - PLANE).abs())),
        // Criteria with few values or one value: ties decide.
        ("(3.0 * f.depth).floor()", rules!(|quad: &Quad| (3.0 * quad.depth).floor())),
        ("-7.5", rules!(|_: &Quad| -7.5)),
    ]
}

fn description(key: &str, criterion: &str) -> Option<Variant> {
    let source = format!(
        "buffer Criterion from {key} {{
            fragment {{ color: rgba8, depth: f32, id: u32 }}
            uniform {{ object: u32, plane: f32 }}
            keep 3 least |f, u| {criterion};
            sort: insertion;
            counters: all;
        }}"
    );
    let parsed = fragbuf_syntax::parse(&source, "criterion.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    check(&parsed.draft.unwrap(), &Registry::builtin()).ok()
}

fn set_uniforms(renderer: &mut Renderer) {
    assert_eq!(renderer.unset_uniforms().collect::<Vec<_>>(), ["object", "plane"]);
    renderer.set_uniform("object", Value::U32(OBJECT)).unwrap();
    assert_eq!(renderer.unset_uniforms().collect::<Vec<_>>(), ["plane"]);
    renderer.set_uniform("plane", Value::F32(PLANE)).unwrap();
}

/// Checks that the k least keys are kept, each once, with any fragment of the key.
fn compare_distinct(rules: &Rules, kept: &[Vec<Words>], quads: &[Quad]) {
    for (kept, (x, y)) in kept.iter().zip(oracle::pixels()) {
        let mut by_key: BTreeMap<u32, Vec<Words>> = BTreeMap::new();
        for words in oracle::kept(rules, quads, None, x, y).iter().map(rules.words) {
            by_key.entry(words[0]).or_default().push(words);
        }
        assert_eq!(kept.len(), by_key.len().min(3), "{x}, {y} of {quads:?}");
        for (kept, (_, alike)) in kept.iter().zip(&by_key) {
            assert!(alike.contains(kept), "{kept:?} at {x}, {y} of {quads:?}");
        }
    }
}

#[test]
fn any_criterion_over_any_storage_of_the_k_best() {
    let registry = Registry::builtin();
    let stage = stage::device();
    let mut tested = BTreeMap::new();
    for row in registry.techniques().iter().filter(|row| row.keep != KeepDefault::All) {
        for (criterion, rules) in criteria() {
            let Some(variant) = description(&row.key, criterion) else { continue };
            if variant.select(target("wgsl").unwrap().provides).is_err() {
                continue;
            }
            let settings = Settings { sizing: Sizing::Auto, ..settings() };
            let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
            set_uniforms(&mut renderer);
            let is_distinct = renderer.plan().hazards.iter().any(|hazard| hazard.name == "equal-keys");
            let all = renderer.plan().selection.provides().contains(&Capability::KeepsAll);
            for quads in [scattered(8, 21), scattered(8, 22)] {
                let quads: Vec<Quad> = (0..).zip(quads).map(|(id, quad)| quad.named(id)).collect();
                for quads in orders(&quads).into_iter().take(4) {
                    let seen = render_frame(&stage, &mut renderer, &quads);
                    match is_distinct {
                        true => compare_distinct(&rules, &seen.kept, &quads),
                        false => compare(criterion, &seen, &rules, &quads, (Some(3).filter(|_| !all), Some(3))),
                    }
                }
            }
            *tested.entry(row.key.clone()).or_insert(0) += 1;
        }
    }
    println!("criteria: {tested:?}");
    let keeps_best = |key: &str| {
        let choices = &registry.technique(key).unwrap().choices;
        let storage = choices.iter().find(|(axis, _)| *axis == "storage").unwrap().1;
        let row = registry.row("storage", storage).unwrap();
        let rows: Vec<&Row> = choices.iter().filter_map(|(axis, key)| registry.row(axis, key)).collect();
        let keeps = row.provides.contains(&Capability::KeepsBest) || row.provides.contains(&Capability::KeepsAll);
        // A slot of two words is too small for a criterion, and a depth test compares only depth.
        let conditions = || rows.iter().flat_map(|row| &row.conditions);
        let is_narrow = |symbol| conditions().any(|condition| condition.formula.mentions(symbol));
        // Layers by another key than depth are not in the order in which the effect composites them.
        let orders =
            |(when, then): &(Formula, Capability)| *then == Capability::LayersInOrder && when.mentions("depth_key");
        let is_by_depth = rows.iter().flat_map(|row| &row.implies).any(orders);
        keeps && !is_narrow("entry_words") && !is_narrow("depth_key") && !is_by_depth
    };
    for row in registry.techniques().iter().filter(|row| row.keep != KeepDefault::All && keeps_best(&row.key)) {
        assert_eq!(tested.get(&row.key), Some(&criteria().len()), "{}", row.key);
    }
}

/// A 64-bit slot holds a criterion and the depth.
#[test]
fn a_criterion_over_slots_of_two_words() {
    fn words(quad: &Quad) -> Words {
        vec![ordered_key(-quad.depth), quad.depth.to_bits()]
    }
    let text = "buffer Farthest from kb_mdt64 {
        fragment { depth: f32 }
        keep 3 least |f| -f.depth;
        sort: insertion;
        resolve |fragments, u| {
            let mut sum = 0.0;
            for f in fragments { sum = 0.5 * sum + 0.5 * f.depth; }
            vec4(sum, sum, sum, 1.0)
        }
    }";
    let rules = Rules {
        admits: |_| true,
        words,
        nearer: |quad| vec![quad.depth.to_bits()],
        resolve: |kept| {
            let sum = kept.iter().fold(0.0, |sum, quad| 0.5 * sum + 0.5 * f64::from(quad.depth));
            [sum, sum, sum, 1.0]
        },
    };
    check_as("wgsl-native", &described(text), &settings(), &rules, |_| {});
    let wide = text.replace("{ depth: f32 }", "{ depth: f32, id: u32 }");
    let parsed = fragbuf_syntax::parse(&wide, "wide.fragbuf");
    let errors = check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_err().to_string();
    assert!(errors.contains("at most one value word"), "{errors}");
}

#[test]
fn the_examples_keep_what_their_descriptions_specify() {
    let of = |text: &str| described(text);
    // Two words: the criterion's key, then colour and depth.
    let farthest = Rules {
        words: |quad| words_of(quad, -quad.depth)[..3].to_vec(),
        nearer: |quad| vec![quad.depth.to_bits(), u32::from_le_bytes(quad.color)],
        ..PLAIN
    };
    check_as("wgsl", &of(include_str!("../../../../examples/farthest.fragbuf")), &settings(), &farthest, |_| {});
    let behind = Rules { admits: |quad| quad.depth > PLANE, ..PLAIN };
    let plane = |renderer: &mut Renderer| renderer.set_uniform("plane", Value::F32(PLANE)).unwrap();
    check_as("wgsl", &of(include_str!("../../../../examples/behind_plane.fragbuf")), &settings(), &behind, plane);
    let (_, by_object) = criteria().swap_remove(2);
    let object = |renderer: &mut Renderer| renderer.set_uniform("object", Value::U32(OBJECT)).unwrap();
    check_as("wgsl", &of(include_str!("../../../../examples/by_object.fragbuf")), &settings(), &by_object, object);
    most_visible();
}

/// At a right angle to their normals, colours keep their full opacity.
fn most_visible() {
    const FAR: f32 = 0.8;
    /// (0, 0, 1) as two 16-bit coordinates on the octahedron.
    const NORMAL: u32 = 0;
    fn words(quad: &Quad) -> Words {
        let key = ordered_key(quad.depth - 0.25 * quad.rgba()[3]);
        vec![key, u32::from_le_bytes(quad.color), quad.depth.to_bits(), NORMAL]
    }
    let rules = Rules {
        admits: |quad| quad.depth < FAR,
        words,
        nearer: |quad| {
            let words = words(quad);
            vec![words[2], words[1], words[0]]
        },
        resolve: over,
    };
    let variant = described(include_str!("../../../../examples/most_visible.fragbuf"));
    check_as("wgsl", &variant, &settings(), &rules, |renderer| {
        renderer.set_uniform("far", Value::F32(FAR)).unwrap();
        renderer.set_uniform("eye", Value::Vec3([1.0, 0.0, 0.0])).unwrap();
    });
}

/// Every k-buffer with a bound on its kept keys rejects fragments before the critical section (K15, Fig. 7). `WITHOUT` lists those
/// without a bound, with the reason.
#[test]
fn k_buffers_cull_early() {
    const WITHOUT: [(&str, &str); 13] = [
        ("f2b", "the depth test is the cull"),
        ("f2b2", "the depth test is the cull"),
        ("kb_stream", "every fragment is composited, none is worse than another"),
        ("kb_mha", "a race may overwrite a key, which is stored again later"),
        ("z_buffer", "the depth test is the cull"),
        ("kb_sr", "the first fragments are kept, independent of depth"),
        ("kb_multi", "the greatest key of a pass may be a duplicate and not the k-th"),
        ("kb_ab_array", "keeps every fragment until it is resolved"),
        ("kb_ab_ll", "keeps every fragment until it is resolved"),
        ("kb_ab_sb", "keeps every fragment until it is resolved"),
        ("kb_ll", "no word holds the k-th key of a list: finding it takes the same walk as an insertion"),
        ("depth_partition", "every range has its own bound"),
        ("bad", "every part of the range has its own bound"),
    ];
    let registry = Registry::builtin();
    let stage = stage::device();
    let mut without: Vec<String> = Vec::new();
    for row in registry.techniques().iter().filter(|row| row.keep != KeepDefault::All) {
        let span = fragbuf_model::SourceSpan::new(&*row.key, 1, 1);
        let mut draft = fragbuf_model::Draft::from_technique(&row.key, &span);
        draft.set("cull", "early", &span).unwrap();
        if let Err(errors) = check(&draft, &registry) {
            assert!(errors.to_string().contains("a bound that no fragment"), "{}: {errors}", row.key);
            without.push(row.key.clone());
            continue;
        }
        let variant = technique(&row.key, &[("k", "3"), ("cull", "early"), ("counters", "all")]);
        if variant.select(target("spirv").unwrap().provides).unwrap().provides().contains(&Capability::KeepsLater) {
            // Every iteration culls, and in the end nothing is missing: see `peeling`.
            continue;
        }
        let language = if variant.select(target("wgsl").unwrap().provides).is_ok() { "wgsl" } else { "wgsl-native" };
        let roomy = Settings { sizing: Sizing::Capacity(PoolSize::Fragments(20 * SIZE * SIZE)), ..settings() };
        let mut renderer = renderer(&stage, &shaders(&variant, language), &roomy).unwrap();
        // The nearest come first: after three of them, each other fragment is rejected.
        let quads: Vec<Quad> = (0..12).map(|layer| Quad::whole(layer as f32 / 16.0, [9, 9, 9, 9])).collect();
        let seen = render_frame(&stage, &mut renderer, &quads);
        assert_eq!(seen.counters.get("culled"), 9 * SIZE * SIZE, "{}: {:?}", row.key, seen.counters);
        assert_eq!(seen.kept, oracle::kept_words(&PLAIN, &quads, Some(3)), "{}", row.key);
    }
    let expected: Vec<&str> = WITHOUT.iter().map(|(key, _)| *key).collect();
    without.sort_by_key(|key| expected.iter().position(|other| other == key));
    assert_eq!(without, expected);
}
