//! Implementation choices do not change the image: for every technique without declared hazards and every single change on an
//! implementation axis, the CPU device's image is equal bit by bit.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Mesh, Settings};
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::{PoolSize, Sizing, VertexInputs};
use fragbuf_targets::target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Feature, KeepDefault, Technique};

use crate::capture::scattered;
use crate::order::{Numbers, orders};
use crate::quads::{Quad, vertices};

/// The implementation axes.
const AXES: [&str; 7] = ["sync", "cull", "opaque", "select", "addressing", "counters", "sort"];

/// Not a multiple of any tile size, so that all padding occurs.
const FRAME: (u32, u32) = (13, 11);

/// Returns a technique with one change, and with `k` if it has a k; `None` if the rules reject it.
fn changed(technique: &Technique, k: &str, (axis, value): (&str, &str)) -> Option<Variant> {
    let span = SourceSpan::new(&*technique.key, 1, 1);
    let mut draft = Draft::from_technique(&technique.key, &span);
    if technique.keep != KeepDefault::All {
        draft.set("k", k, &span).unwrap();
    }
    draft.set(axis, value, &span).unwrap();
    check(&draft, &Registry::builtin()).ok()
}

/// Returns a CPU device for the variant; `None` if no target of the CPU device supports it.
fn device(variant: &Variant) -> Option<Device> {
    let languages = ["wgsl", "wgsl-native"].map(|name| target(name).unwrap().provides);
    languages.iter().find(|provides| variant.select(provides).is_ok())?;
    let code = Code::of(variant, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let settings = Settings {
        sizing: Sizing::Capacity(PoolSize::Fragments(50 * FRAME.0 * FRAME.1)),
        ..Settings::new(FRAME.0, FRAME.1)
    };
    let mut device = Device::new(Arc::new(code), settings).unwrap();
    // The far plane: nothing is opaque.
    let external = device.plan().resources.iter().find(|planned| planned.is_external());
    if let Some(name) = external.map(|planned| planned.resource.name.clone()) {
        device.set_texture(&name, &[1.0; (FRAME.0 * FRAME.1) as usize]).unwrap();
    }
    Some(device)
}

/// Returns the images of some scenes as bits: random quads of few depths and colours, so that many are equal, in two orders; and 40
/// quads over every pixel.
fn images(device: &mut Device) -> Vec<Vec<[u32; 4]>> {
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
        let image = device.render(&Mesh { vertices: &words, indices: &indices }, &|_| {}).unwrap();
        assert!(image.out_of_bounds.is_empty(), "{:?}", image.out_of_bounds);
        let lost = image.counters.map_or(0, |counters| counters.get("pool_exhausted"));
        assert_eq!(lost, 0, "no fragment overflows");
        image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    scenes.into_iter().map(draw).collect()
}

/// Returns the techniques whose kept set does not depend on the order of arrival.
fn exact(registry: &Registry) -> impl Iterator<Item = &Technique> {
    registry.techniques().iter().filter(|technique| {
        let (_, storage) = technique.choices.iter().find(|(axis, _)| *axis == "storage").unwrap();
        let provides = &registry.row("storage", storage).unwrap().provides;
        provides.contains(&Capability::KeepsAll) || provides.contains(&Capability::KeepsBest)
    })
}

#[test]
fn no_single_implementation_choice_changes_the_image() {
    let registry = Registry::builtin();
    let mut compared: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    // Rows that do not support k = 5 are compared with k = 1.
    let cases = exact(&registry).map(|technique| (technique, "5"));
    for (technique, k) in cases.chain(exact(&registry).map(|technique| (technique, "1"))) {
        // Storages that support only certain k are skipped.
        let Some(plain) = changed(technique, k, ("addressing", "linear")) else { continue };
        let Some(mut plain) = device(&plain).filter(|device| device.plan().hazards.is_empty()) else { continue };
        let expected = images(&mut plain);
        assert!(expected[0].iter().any(|pixel| *pixel != expected[0][0]), "{}", technique.key);
        for row in AXES.iter().flat_map(|axis| registry.rows_of(axis)) {
            if k == "1" && compared.contains_key(&(&*row.axis, &*row.key)) {
                continue;
            }
            let variant = changed(technique, k, (&row.axis, &row.key));
            let Some(mut other) = variant.as_ref().and_then(device) else { continue };
            if other.plan().hazards.is_empty() {
                assert!(images(&mut other) == expected, "{} with {}: {}", technique.key, row.axis, row.key);
                *compared.entry((&row.axis, &row.key)).or_default() += 1;
            }
        }
    }
    println!("invariance: {compared:?}");
    for row in AXES.iter().flat_map(|axis| registry.rows_of(axis)) {
        // Without a lock the sorted array has hazards, and no target of this device has an interlock. Fixed function declares the
        // fragments that it does not keep.
        let capabilities = [Capability::RaceTolerant, Capability::FixedFunction, Capability::LeavesDepth];
        let features = [Feature::Interlock, Feature::EarlyDepth];
        let is_exempt = capabilities.iter().any(|capability| row.requires.contains(capability))
            || features.iter().any(|feature| row.needs.contains(feature));
        assert!(is_exempt || compared.contains_key(&(&*row.axis, &*row.key)), "{}: {}", row.axis, row.key);
    }
}
