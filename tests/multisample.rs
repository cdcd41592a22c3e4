//! Tests the memory of several samples per pixel, and the targets that support them.

use fragbuf::vocabulary::Feature;
use fragbuf::{Registry, TARGETS, Target};
use fragbuf_codegen::plan;
use fragbuf_model::{Selection, Variant};

use crate::cases::{checked, text};

/// Returns the techniques that the rules accept with an item.
fn with(item: &str) -> impl Iterator<Item = (String, Variant)> {
    let registry = Registry::builtin();
    let keys: Vec<String> = registry.techniques().iter().map(|technique| technique.key.clone()).collect();
    keys.into_iter().filter_map(move |key| {
        let description = text(&format!("buffer B from {key} {{ {item} }}"));
        Some((key, checked(&description, &[]).ok()?))
    })
}

fn words(variant: &Variant) -> String {
    plan(variant, &Selection::first(variant), &Registry::builtin()).unwrap().words_per_pixel
}

#[test]
fn a_mask_costs_what_an_attribute_of_one_word_costs() {
    let masked: Vec<(String, String)> =
        with("samples: coverage;").map(|(key, variant)| (key, words(&variant))).collect();
    let wider = with("fragment { color: rgba8, depth: f32, more: u32 }").map(|(key, variant)| (key, words(&variant)));
    let wider: Vec<(String, String)> = wider.filter(|(key, _)| masked.iter().any(|(other, _)| key == other)).collect();
    assert!(masked.len() >= 15, "{masked:?}");
    assert_eq!(masked, wider);
    assert!(masked.contains(&("kplus_array".to_owned(), "3k+2".to_owned())), "{masked:?}");
}

/// OpenGL ES 3.1 has no input for the mask of covered samples.
#[test]
fn targets_without_a_mask_refuse_with_the_reason() {
    for (key, variant) in with("samples: coverage;") {
        for target in TARGETS {
            let rejected = variant.select(target.provides).err();
            let by_samples = rejected.as_ref().is_some_and(|missing| missing.axis == "samples");
            match target.name {
                "glsl-es" => assert!(rejected.is_some(), "{key}"),
                name => assert!(!by_samples, "{key} on {name}: {rejected:?}"),
            }
        }
    }
}

/// A WebGPU device has 1 and 4 samples per pixel.
#[test]
fn portable_wgsl_has_four_samples() {
    let descriptions = |count: u32| {
        [
            format!("buffer B from kplus_array {{ samples: coverage {{ count: {count} }}; }}"),
            format!("buffer B from kb_sr {{ keep {count}; }}"),
        ]
    };
    let missing = |variant: &Variant, target: &Target| {
        variant.select(&[target.provides, &[Feature::OwnEntryPoints]].concat()).err().map(|missing| missing.feature)
    };
    for count in [2, 4, 8] {
        for description in descriptions(count) {
            let variant = checked(&text(&description), &[]).unwrap();
            let plan = plan(&variant, &Selection::first(&variant), &Registry::builtin()).unwrap();
            assert_eq!(plan.requires.contains(&Feature::SampleCounts), count != 4, "{description}");
            for target in TARGETS {
                let is_missing = missing(&variant, target) == Some(Feature::SampleCounts);
                assert_eq!(is_missing, target.name == "wgsl" && count != 4, "{description} for {}", target.name);
            }
        }
    }
    let four = checked(&text("buffer B from kplus_array { samples: coverage; }"), &[]).unwrap();
    assert!(TARGETS.iter().all(|target| missing(&four, target) != Some(Feature::SampleCounts)));
}
