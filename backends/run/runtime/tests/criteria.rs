//! Any criterion over any storage that keeps the k best, and the examples of criteria, against the oracle.

use std::collections::BTreeMap;

use fragbuf_targets::target;
use fragbuf_model::{Variant, check};
use fragbuf_runtime::{Renderer, Room, Settings, Sizing, Value};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Fact, KeepDefault};

use crate::capture::{check_as, compare, scattered};
use crate::oracle::{self, PLAIN, Rules, Words, over};
use crate::order::orders;
use crate::quads::{Quad, SIZE};
use crate::stage::{self, described, renderer, see, settings, shaders, technique};

/// The object that comes first, and the plane.
const OBJECT: u32 = 3;
const PLANE: f32 = 0.375;

/// A number as a word whose unsigned order is the numbers' (IEEE 754 sec. 5.10).
fn ordered(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

fn beside(quad: &Quad, value: f32) -> Words {
    vec![ordered(value), u32::from_le_bytes(quad.color), quad.depth.to_bits(), quad.id]
}

/// Depth, then the rest, then the key.
fn nearest_first(mut words: Words) -> Words {
    let key = words.remove(0);
    let (color, depth, id) = (words[0], words[1], words[2]);
    vec![depth, color, id, key]
}

/// Criteria as the language says them, and by the oracle.
fn criteria() -> Vec<(&'static str, Rules)> {
    macro_rules! rules {
        ($value:expr) => {
            Rules {
                admits: |_| true,
                words: |quad| beside(quad, $value(quad)),
                nearer: |quad| nearest_first(beside(quad, $value(quad))),
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
        // Few values, and one: ties decide.
        ("(3.0 * f.depth).floor()", rules!(|quad: &Quad| (3.0 * quad.depth).floor())),
        ("-7.5", rules!(|_: &Quad| -7.5)),
    ]
}

fn description(key: &str, criterion: &str) -> Option<Variant> {
    let text = format!(
        "buffer Criterion from {key} {{
            fragment {{ color: rgba8, depth: f32, id: u32 }}
            uniform {{ object: u32, plane: f32 }}
            keep 3 least |f, u| {criterion};
            sort: insertion;
            counters: all;
        }}"
    );
    let parsed = fragbuf_syntax::parse(&text, "criterion.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    check(&parsed.draft.unwrap(), &Registry::builtin()).ok()
}

fn set_uniforms(renderer: &mut Renderer) {
    renderer.set_uniform("object", Value::U32(OBJECT)).unwrap();
    renderer.set_uniform("plane", Value::F32(PLANE)).unwrap();
}

/// The k least keys, each once; where keys are equal, any fragment of that key.
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
    let mut tried = BTreeMap::new();
    for row in registry.techniques().iter().filter(|row| row.keep != KeepDefault::All) {
        for (criterion, rules) in criteria() {
            let Some(variant) = description(&row.key, criterion) else { continue };
            if variant.select(target("wgsl").unwrap().offers).is_err() {
                continue;
            }
            let settings = Settings { sizing: Sizing::Auto, ..settings() };
            let mut renderer = renderer(&stage, &shaders(&variant, "wgsl"), &settings).unwrap();
            set_uniforms(&mut renderer);
            let is_distinct = renderer.plan().hazards.iter().any(|hazard| hazard.name == "equal-keys");
            let all = renderer.plan().selection.offers().contains(&Fact::KeepsAll);
            for quads in [scattered(8, 21), scattered(8, 22)] {
                let quads: Vec<Quad> = (0..).zip(quads).map(|(id, quad)| quad.named(id)).collect();
                for quads in orders(&quads).into_iter().take(4) {
                    let seen = see(&stage, &mut renderer, &quads);
                    match is_distinct {
                        true => compare_distinct(&rules, &seen.kept, &quads),
                        false => compare(criterion, &seen, &rules, &quads, (Some(3).filter(|_| !all), Some(3))),
                    }
                }
            }
            *tried.entry(row.key.clone()).or_insert(0) += 1;
        }
    }
    println!("criteria: {tried:?}");
    let keeps_best = |key: &str| {
        let storage = registry.technique(key).unwrap().choices.iter().find(|(axis, _)| *axis == "storage").unwrap().1;
        let row = registry.row("storage", storage).unwrap();
        let keeps = row.offers.contains(&Fact::KeepsBest) || row.offers.contains(&Fact::KeepsAll);
        // Slots of two words have no room for a criterion, and a depth test knows nothing but depth.
        let is_narrow = |symbol| row.conditions.iter().any(|condition| condition.formula.mentions(symbol));
        keeps && !is_narrow("entry_words") && !is_narrow("depth_key")
    };
    for row in registry.techniques().iter().filter(|row| row.keep != KeepDefault::All && keeps_best(&row.key)) {
        assert_eq!(tried.get(&row.key), Some(&criteria().len()), "{}", row.key);
    }
}

/// A slot of 64 bits holds a criterion and the depth.
#[test]
fn a_criterion_over_slots_of_two_words() {
    fn words(quad: &Quad) -> Words {
        vec![ordered(-quad.depth), quad.depth.to_bits()]
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
    let refused = check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_err().to_string();
    assert!(refused.contains("at most one word beside the key"), "{refused}");
}

#[test]
fn the_examples_keep_what_their_heads_say() {
    let of = |text: &str| described(text);
    // Two words: the key is of the criterion, depth comes after colour.
    let farthest = Rules {
        words: |quad| beside(quad, -quad.depth)[..3].to_vec(),
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

/// Looked at across their normals, colours keep all their opacity.
fn most_visible() {
    const FAR: f32 = 0.8;
    /// (0, 0, 1) as two 16-bit coordinates on the octahedron.
    const NORMAL: u32 = 0;
    fn words(quad: &Quad) -> Words {
        let key = ordered(quad.depth - 0.25 * quad.rgba()[3]);
        vec![key, u32::from_le_bytes(quad.color), quad.depth.to_bits(), NORMAL, quad.id]
    }
    let rules = Rules {
        admits: |quad| quad.depth < FAR,
        words,
        nearer: |quad| {
            let words = words(quad);
            vec![words[2], words[1], words[4], words[0]]
        },
        resolve: over,
    };
    let variant = described(include_str!("../../../../examples/most_visible.fragbuf"));
    check_as("wgsl", &variant, &settings(), &rules, |renderer| {
        renderer.set_uniform("far", Value::F32(FAR)).unwrap();
        renderer.set_uniform("eye", Value::Vec3([1.0, 0.0, 0.0])).unwrap();
    });
}

/// Every k-buffer with one word that no kept fragment exceeds turns fragments away before the critical section (K15, Fig. 7);
/// those that have none are named here, with the reason.
#[test]
fn k_buffers_cull_early() {
    const WITHOUT: [(&str, &str); 10] = [
        ("kb_stream", "every fragment is composited, none is worse than another"),
        ("kb_mha", "a key may be written over by a race and come back"),
        ("z_buffer", "the depth test is the cull"),
        ("kb_sr", "the first are kept, whatever their depth"),
        ("kb_multi", "the greatest key of a pass may be doubled, and not the k-th"),
        ("kb_ab_array", "keeps every fragment until it is resolved"),
        ("kb_ab_ll", "keeps every fragment until it is resolved"),
        ("kb_ab_sb", "keeps every fragment until it is resolved"),
        ("kb_ll", "no word names the k-th of a list: finding it is the walk that an insertion makes"),
        ("depth_partition", "every range has a bound of its own"),
    ];
    let registry = Registry::builtin();
    let stage = stage::device();
    let mut without: Vec<String> = Vec::new();
    for row in registry.techniques().iter().filter(|row| row.keep != KeepDefault::All) {
        let origin = fragbuf_model::Origin::new(&*row.key, 1, 1);
        let mut draft = fragbuf_model::Draft::from_technique(&row.key, &origin);
        draft.set("cull", "early", &origin).unwrap();
        if let Err(refused) = check(&draft, &registry) {
            assert!(refused.to_string().contains("a bound that no fragment"), "{}: {refused}", row.key);
            without.push(row.key.clone());
            continue;
        }
        let variant = technique(&row.key, &[("k", "3"), ("cull", "early"), ("counters", "all")]);
        let language = if variant.select(target("wgsl").unwrap().offers).is_ok() { "wgsl" } else { "wgsl-native" };
        let roomy = Settings { sizing: Sizing::Reserve(Room::Fragments(20 * SIZE * SIZE)), ..settings() };
        let mut renderer = renderer(&stage, &shaders(&variant, language), &roomy).unwrap();
        // The nearest come first: once three are in, each of the others is turned away.
        let quads: Vec<Quad> = (0..12).map(|layer| Quad::whole(layer as f32 / 16.0, [9, 9, 9, 9])).collect();
        let seen = see(&stage, &mut renderer, &quads);
        assert_eq!(seen.counters.get("culled"), 9 * SIZE * SIZE, "{}: {:?}", row.key, seen.counters);
        assert_eq!(seen.kept, oracle::kept_words(&PLAIN, &quads, Some(3)), "{}", row.key);
    }
    let expected: Vec<&str> = WITHOUT.iter().map(|(key, _)| *key).collect();
    without.sort_by_key(|key| expected.iter().position(|other| other == key));
    assert_eq!(without, expected);
}
