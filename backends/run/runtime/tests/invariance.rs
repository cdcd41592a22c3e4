//! Changing the how never changes the picture: for every technique without a hazard and every single change on an axis of
//! how, the CPU device's picture is the same to the bit.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_targets::target;
use fragbuf_cpu::{Code, Device, Mesh, Order, Settings};
use fragbuf_model::{Draft, Origin, Variant, check};
use fragbuf_runtime::{Room, Sizing, VertexInputs};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Fact, KeepDefault, Technique};

use crate::capture::scattered;
use crate::order::{Numbers, orders};
use crate::quads::{Quad, vertices};

/// What says how, and not what.
const AXES: [&str; 7] = ["sync", "cull", "opaque", "select", "addressing", "counters", "sort"];

/// No multiple of any tile: every padding is there.
const FRAME: (u32, u32) = (13, 11);

/// A technique with one change, where there is a k with `k` of it; `None`: the rules refuse it.
fn changed(technique: &Technique, k: &str, (axis, value): (&str, &str)) -> Option<Variant> {
    let origin = Origin::new(&*technique.key, 1, 1);
    let mut draft = Draft::from_technique(&technique.key, &origin);
    if technique.keep != KeepDefault::All {
        draft.set("k", k, &origin).unwrap();
    }
    draft.set(axis, value, &origin).unwrap();
    check(&draft, &Registry::builtin()).ok()
}

/// Whether some target of the CPU device can say it.
fn device(variant: &Variant) -> Option<Device> {
    let languages = ["wgsl", "wgsl-native"].map(|name| target(name).unwrap().offers);
    languages.iter().find(|offers| variant.select(offers).is_ok())?;
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let settings = Settings {
        width: FRAME.0,
        height: FRAME.1,
        sizing: Sizing::Reserve(Room::Fragments(50 * FRAME.0 * FRAME.1)),
        order: Order::Submission,
    };
    let mut device = Device::new(Arc::new(code), settings).unwrap();
    // Nothing is opaque.
    let brought = device.plan().resources.iter().find(|planned| planned.is_brought());
    if let Some(name) = brought.map(|planned| planned.resource.name.clone()) {
        device.set_texture(&name, &[1.0; (FRAME.0 * FRAME.1) as usize]).unwrap();
    }
    Some(device)
}

/// The pictures of some scenes, bit by bit: quads anywhere of few depths and colours, so that many are equal, in two orders;
/// and more of them than 32 over a pixel.
fn pictures(device: &mut Device) -> Vec<Vec<[u32; 4]>> {
    let mut numbers = Numbers::seeded(17);
    let few = |mut quad: Quad| {
        quad.color = quad.color.map(|channel| channel / 86 * 85);
        quad
    };
    let pile = |id| Quad::whole(numbers.below(9) as f32 / 16.0, [numbers.below(2) as u8 * 200, 90, 0, 20]).named(id);
    let mut scenes: Vec<Vec<Quad>> = orders(&scattered(12, 3).into_iter().map(few).collect::<Vec<_>>());
    scenes.truncate(2);
    scenes.push((0..40).map(pile).collect());
    let draw = |quads: Vec<Quad>| {
        let bytes = vertices(&quads, &VertexInputs::of(device.plan()));
        let words: Vec<u32> = bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        let indices: Vec<u32> = (0..6 * quads.len() as u32).collect();
        let picture = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
        assert!(picture.out_of_bounds.is_empty(), "{:?}", picture.out_of_bounds);
        let lost = picture.counters.map_or(0, |counters| counters.get("pool_exhausted"));
        assert_eq!(lost, 0, "there is room for all");
        picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    scenes.into_iter().map(draw).collect()
}

/// Those that keep exactly what they say, in whatever order fragments come.
fn exact(registry: &Registry) -> impl Iterator<Item = &Technique> {
    registry.techniques().iter().filter(|technique| {
        let (_, storage) = technique.choices.iter().find(|(axis, _)| *axis == "storage").unwrap();
        let offers = &registry.row("storage", storage).unwrap().offers;
        offers.contains(&Fact::KeepsAll) || offers.contains(&Fact::KeepsBest)
    })
}

#[test]
fn no_single_change_of_how_changes_the_picture() {
    let registry = Registry::builtin();
    let mut compared: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    // Rows for which five are too many are compared where one is kept.
    let cases = exact(&registry).map(|technique| (technique, "5"));
    for (technique, k) in cases.chain(exact(&registry).map(|technique| (technique, "1"))) {
        // What keeps one, or as many as there are samples, says so.
        let Some(plain) = changed(technique, k, ("addressing", "linear")) else { continue };
        let Some(mut plain) = device(&plain).filter(|device| device.plan().hazards.is_empty()) else { continue };
        let expected = pictures(&mut plain);
        assert!(expected[0].iter().any(|pixel| *pixel != expected[0][0]), "{}", technique.key);
        for row in AXES.iter().flat_map(|axis| registry.rows_of(axis)) {
            if k == "1" && compared.contains_key(&(&*row.axis, &*row.key)) {
                continue;
            }
            let variant = changed(technique, k, (&row.axis, &row.key));
            let Some(mut other) = variant.as_ref().and_then(device) else { continue };
            if other.plan().hazards.is_empty() {
                assert!(pictures(&mut other) == expected, "{} with {}: {}", technique.key, row.axis, row.key);
                *compared.entry((&row.axis, &row.key)).or_default() += 1;
            }
        }
    }
    println!("invariance: {compared:?}");
    for row in AXES.iter().flat_map(|axis| registry.rows_of(axis)) {
        // Without a lock the sorted array has hazards; no target of this device has an interlock.
        // Fixed function states what it does not keep.
        let facts = [Fact::SurvivesRaces, Fact::FixedFunction];
        let capabilities = [Capability::Interlock, Capability::EarlyDepth];
        let is_elsewhere = facts.iter().any(|fact| row.requires.contains(fact))
            || capabilities.iter().any(|capability| row.needs.contains(capability));
        assert!(is_elsewhere || compared.contains_key(&(&*row.axis, &*row.key)), "{}: {}", row.axis, row.key);
    }
}
