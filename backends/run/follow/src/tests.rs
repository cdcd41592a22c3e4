//! Manifests that anybody may have written: what would crash, not end, or write outside of memory is an error.
#![allow(clippy::unwrap_used, reason = "a test fails by a panic")]

use std::sync::Arc;

use serde_json::{Value, json};

use crate::manifest::{Kind, Manifest, Pass};
use crate::{Call, Device, Error, Image, Scene, Values, Walk};

fn symbol(name: &str, default: &str) -> Value {
    json!({ "name": name, "when": "frame", "set_by": "caller", "least": 0, "most": 9, "default": default })
}

fn pass(name: &str, kind: &str, objects: Value) -> Value {
    let binding = |name: &str, number: u32, kind: &str| json!({ "name": name, "group": 0, "binding": number, "opengl_binding": 0, "stages": [], "type": kind });
    json!({
        "do": "pass", "pass": name, "kind": kind, "objects": objects, "uses": { "counters": "atomic" },
        "bindings": [binding("frame", 0, "uniform"), binding("counters", 3, "storage")],
        "state": { "targets": [] },
    })
}

/// Returns a manifest without a mistake: a loop around a pass that draws visible objects and one that computes.
fn manifest() -> Value {
    let mut computes = pass("sum", "compute", json!("all"));
    computes["groups"] = json!(["width * GROUPS", "1", "1"]);
    let field = |name: &str, kind: &str| json!({ "name": name, "type": kind, "offset": 0 });
    let block = |name: &str, bytes: u32, field: Value| json!({ "name": name, "opengl_binding": 0, "bytes": bytes, "fields": [field] });
    json!({
        "schema": "fragbuf-manifest/4",
        "prefix": "",
        "files": [{ "path": "", "target": "glsl", "pass": "store", "stage": "fragment", "entry_point": "main" }],
        "conventions": { "scissor": ["0", "0", "width", "height"] },
        "alternatives": [],
        "symbols": [symbol("n", "pixels / 2"), symbol("pixels", "width * height")],
        "requires": {},
        "constants": { "ITERATIONS": 3, "NESTED": 2, "GROUPS": 1, "COUNTERS": 2 },
        "uniform_blocks": [block("frame", 16, field("n", "u32")), block("camera", 64, field("matrix", "mat4x4<f32>"))],
        "resources": [{ "name": "counters", "init": { "clear": 0 }, "words": "COUNTERS", "bytes": "4 * COUNTERS" }],
        "exchanges": [],
        "steps": [
            pass("boxes", "geometry", json!("boxes")),
            { "do": "loop", "max_iterations": "ITERATIONS", "end": 6 },
            { "do": "loop", "max_iterations": "NESTED", "end": 5 },
            pass("store", "geometry", json!({ "visible_in": "boxes" })),
            computes,
            { "do": "loop_end", "begin": 2 },
            { "do": "loop_end", "begin": 1, "until": { "no_samples": "store" } },
        ],
        "counters": [{ "name": "lost", "index": 1, "is_loss": true }],
        "limits": [],
    })
}

fn changed(change: impl Fn(&mut Value)) -> Value {
    let mut manifest = manifest();
    change(&mut manifest);
    manifest
}

/// Returns the mistake of a changed manifest.
fn mistake(change: impl Fn(&mut Value)) -> String {
    Manifest::parse(&changed(change).to_string(), "glsl").err().map_or("no mistake".to_owned(), |error| error.0)
}

/// Notes the workgroups of the passes that compute. Every sample passes.
#[derive(Default)]
struct Noted {
    groups: Vec<[u32; 3]>,
}

impl Device for Noted {
    fn clear(&mut self, _: &str, _: u32, _: Option<&Value>) -> Result<(), Error> {
        Ok(())
    }

    fn copy(&mut self, _: &str, _: &str) -> Result<(), Error> {
        Ok(())
    }

    fn pass(&mut self, pass: &Pass, call: &Call<'_>) -> Result<(), Error> {
        if pass.kind == Kind::Compute {
            self.groups.push(call.groups(pass, [65_535; 3])?);
        }
        Ok(())
    }

    fn words(&mut self, _: &str, _: u64, _: u64) -> Result<Vec<u32>, Error> {
        Ok(Vec::new())
    }

    fn samples(&mut self, _: &str) -> Result<Vec<u64>, Error> {
        Ok(vec![1])
    }

    fn allocate(&mut self, _: &Values) -> Result<(), Error> {
        Ok(())
    }
}

/// Returns the workgroups of a frame of 4 × 4 pixels with these constants.
fn frame(constants: &[(&str, u64)]) -> Result<Vec<[u32; 3]>, String> {
    let manifest = changed(|manifest| {
        constants.iter().for_each(|(name, value)| manifest["constants"][*name] = json!(value));
    });
    let (_, plan) = Manifest::parse(&manifest.to_string(), "glsl").unwrap();
    let plan = Arc::new(plan);
    let (mut values, mut noted) = (Values::new(plan.clone(), [4, 4]), Noted::default());
    let scene = Scene { vertices: &[], objects: &[], view_projection: [0.0; 16] };
    let ran = Walk::new(plan).run(&mut values, (&scene, [4, 4]), &mut noted);
    ran.map(|_| noted.groups).map_err(|error| error.0)
}

#[test]
fn a_manifest_without_a_mistake_runs() {
    assert_eq!(mistake(|_| {}), "no mistake");
    assert_eq!(frame(&[]), Ok(vec![[4, 1, 1]; 6]));
}

#[test]
fn uniform_blocks_hold_what_is_written() {
    let matrix = |bytes: u32| mistake(|manifest| manifest["uniform_blocks"][1]["bytes"] = json!(bytes));
    assert!(matrix(16).contains("`camera` has 16 bytes, and its matrix 64"), "{}", matrix(16));
    assert!(matrix(128).contains("`camera` has 128 bytes"), "{}", matrix(128));
    assert!(matrix(65).contains("no whole words") && matrix(65_540).contains("more than 65536"));
    let field = |kind: &str, offset: u64| {
        mistake(|manifest| {
            let field = &mut manifest["uniform_blocks"][0]["fields"][0];
            (field["type"], field["offset"]) = (json!(kind), json!(offset));
        })
    };
    for (kind, greatest) in [("f32", 12), ("vec2<f32>", 8), ("vec3<f32>", 4), ("vec4<f32>", 0)] {
        assert_eq!(field(kind, greatest), "no mistake");
        for offset in [greatest + 1, u64::MAX] {
            assert!(field(kind, offset).contains("`n` is outside of the uniform block `frame`"), "{kind} at {offset}");
        }
    }
    assert!(field("mat4x4<f32>", 0).contains("`n` is outside of the uniform block"));
    assert!(field("array<vec4<f32>, 9>", 0).contains("has the type `array<vec4<f32>, 9>`"));
    let twice = mistake(|manifest| {
        let block = manifest["uniform_blocks"][1].clone();
        manifest["uniform_blocks"].as_array_mut().unwrap().push(block);
    });
    assert!(twice.contains("two uniform blocks have the name `camera`"), "{twice}");
}

#[test]
fn defaults_end() {
    let circular = [vec![("a", "a")], vec![("a", "b + 1"), ("b", "a")], vec![("a", "2 * a"), ("a", "1")]];
    for symbols in circular {
        let symbols: Vec<Value> = symbols.into_iter().map(|(name, default)| symbol(name, default)).collect();
        let circular = mistake(|manifest| manifest["symbols"] = json!(symbols));
        assert!(circular.contains("the symbol `a` depends on itself"), "{circular}");
    }
    // Each default names the one before it many times: without a memory of values the last takes 10^16 evaluations.
    let chain = |length: usize| -> Vec<Value> {
        let sum = |of: usize| vec![format!("s{of}"); 100].join(" + ");
        (1..=length).rev().map(|at| symbol(&format!("s{at}"), &sum(at - 1))).collect()
    };
    assert!(mistake(|manifest| manifest["symbols"] = chain(9).into()).contains("more than 8 defaults"));
    let manifest = changed(|manifest| {
        manifest["symbols"] = chain(8).into();
        manifest["constants"]["s0"] = json!(3);
    });
    let (_, plan) = Manifest::parse(&manifest.to_string(), "glsl").unwrap();
    assert_eq!(Values::new(Arc::new(plan), [4, 4]).value("s8", 0).ok(), Some(3 * 100_u64.pow(8)));
}

#[test]
fn workgroups_are_compared_with_the_device() {
    for (groups, count) in [(1_u64 << 30, "4294967296"), ((1 << 30) + 1, "4294967300"), (16_384, "65536")] {
        let message = frame(&[("GROUPS", groups)]).unwrap_err();
        let expected = format!("`sum` has {count} workgroups, and the device allows 65535");
        assert!(message.contains(&expected), "{message}");
    }
    assert_eq!(frame(&[("GROUPS", 16_383)]).map(|groups| groups[0]), Ok([65_532, 1, 1]));
}

#[test]
fn queried_passes_draw() {
    let computes = |step: usize| {
        mistake(|manifest| {
            (manifest["steps"][step]["kind"], manifest["steps"][step]["objects"]) = (json!("compute"), json!("all"));
        })
    };
    for (step, name) in [(0, "boxes"), (3, "store")] {
        assert!(computes(step).contains(&format!("`{name}` computes, so it has no samples")), "{}", computes(step));
    }
    for (step, kind) in [(0, "fullscreen"), (0, "compute"), (3, "fullscreen"), (3, "compute")] {
        let message = mistake(|manifest| manifest["steps"][step]["kind"] = json!(kind));
        assert!(message.contains("has `objects`, which only a geometry pass draws"), "{message}");
    }
    let nowhere = mistake(|manifest| manifest["steps"][6]["until"] = json!({ "no_samples": "nowhere" }));
    assert!(nowhere.contains("there is no pass `nowhere`"), "{nowhere}");
}

#[test]
fn loops_have_a_limit() {
    // Without the check the first two frames do not end in the time of a test.
    for (constants, message) in [
        (&[("ITERATIONS", u64::MAX)][..], "step 1 has up to 18446744073709551615 iterations, more than 1048576"),
        (&[("NESTED", u64::MAX)], "step 2 has up to 18446744073709551615 iterations"),
        (&[("ITERATIONS", (1 << 20) + 1)], "step 1 has up to 1048577 iterations"),
        (&[("ITERATIONS", 1 << 20), ("NESTED", 17)], "step 2 has up to 17825792 iterations, more than 16777216"),
    ] {
        let error = frame(constants).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    assert_eq!(frame(&[("ITERATIONS", 100)]).map(|groups| groups.len()), Ok(200));
}

#[test]
fn counters_and_bindings_have_numbers_in_range() {
    for index in [2, u64::from(u32::MAX), u64::MAX] {
        let outside = mistake(|manifest| manifest["counters"][0]["index"] = json!(index));
        assert!(outside.contains(&format!("`lost` is word {index} of `counters`, which has 2")), "{outside}");
    }
    let unknown = mistake(|manifest| manifest["resources"][0]["words"] = json!("width"));
    assert!(unknown.contains("`counters` is no resource whose size is the same in every frame"), "{unknown}");
    let bound = |key: &str, number: u32| mistake(|manifest| manifest["steps"][3]["bindings"][1][key] = json!(number));
    assert_eq!((bound("group", 31), bound("binding", 999)), ("no mistake".to_owned(), "no mistake".to_owned()));
    for number in [32, u32::MAX] {
        assert!(bound("group", number).contains(&format!("binding 3 of group {number}")), "{number}");
    }
    assert!(bound("binding", u32::MAX).contains("binding 4294967295 of group 0"));
    assert!(bound("binding", 0).contains("`store`: two resources are binding 0 of group 0"), "{}", bound("binding", 0));
    let of_target = mistake(|manifest| {
        let binding = manifest["steps"][3]["bindings"][0].clone();
        manifest["steps"][3]["bindings_of"] = json!({ "glsl": [binding, binding] });
    });
    assert!(of_target.contains("two resources are binding 0 of group 0"), "{of_target}");
}

#[test]
fn an_image_with_losses_is_an_error() {
    let image = |lost| {
        let counters = [("culled", 2), ("emitted", 0), ("partial_coverage", lost)];
        let counters = counters.into_iter().map(|(name, count)| (name.to_owned(), count)).collect();
        Image { pixels: Vec::new(), counters, lost }.without_losses().map(|image| image.lost).map_err(|error| error.0)
    };
    assert_eq!(image(0), Ok(0));
    assert!(image(3).unwrap_err().contains("add up to 3 (culled 2, partial_coverage 3)"));
}
