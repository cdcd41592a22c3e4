//! The numbers of manifests: what OpenGL promises, sizes, samples and counters.

use std::collections::BTreeSet;

use fragbuf::{Form, OpenGlBindings, Registry, Request, generate, manifest, target};
use serde_json::Value;

use super::{ALL, evaluated, passes, plans};
use crate::cases::{checked, named};

/// What OpenGL 4.5 promises: Tables 23.64 and 23.66 of its specification.
const STORAGE_BUFFERS: u64 = 8;
const TEXTURE_UNITS: u64 = 16;
const UNIFORM_BLOCKS: u64 = 84;

/// No binding point of OpenGL is beyond what every driver has, in any bind group, unless a limit says so. In a pass no two bindings of a
/// kind have one point.
#[test]
fn opengl_bindings_are_within_the_promise() {
    let registry = Registry::builtin();
    let mut greatest = 0;
    for (name, description, set) in named() {
        let variant = checked(&description, &set).unwrap();
        for group in [0, 3, 31] {
            let request = Request { targets: &[target("glsl").unwrap()], form: Form::Program, prefix: "", group };
            let generation = generate(&variant, &request, &registry).unwrap();
            if generation.plans.is_empty() {
                continue;
            }
            let manifest = manifest(&generation, group);
            let limits = manifest["limits"].as_array().unwrap();
            let is_limited = |limit: &str, needed: u64| {
                let row = limits.iter().find(|row| row["opengl"] == limit).unwrap();
                row["needed"].as_u64().unwrap() >= needed && row["opengl_minimum"].as_u64().unwrap() < needed
            };
            for pass in passes(&manifest) {
                let mut points = BTreeSet::new();
                for binding in pass["bindings"].as_array().unwrap() {
                    let point = binding["opengl_binding"].as_u64().unwrap();
                    let (kind, promised, limit) = match binding["type"].as_str().unwrap() {
                        "uniform" => ("block", UNIFORM_BLOCKS, "GL_MAX_UNIFORM_BUFFER_BINDINGS"),
                        "texture" => ("texture", TEXTURE_UNITS, "GL_MAX_TEXTURE_IMAGE_UNITS"),
                        _ => ("buffer", STORAGE_BUFFERS, "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS"),
                    };
                    let what = format!("{name}, group {group}, {}: {binding}", pass["pass"]);
                    assert!(point < promised || is_limited(limit, point + 1), "{what}");
                    assert!(points.insert((kind, point)), "{what}");
                    greatest = greatest.max(if kind == "buffer" { point } else { 0 });
                }
            }
        }
    }
    assert!(greatest >= 6, "{greatest}");
}

/// Techniques with more buffers than OpenGL promises have points for them, because no pass uses all.
#[test]
fn more_buffers_than_points_share_them() {
    let mut shared = 0;
    for written in ALL.iter().filter(|written| written.manifest["technique"].is_string()) {
        for planned in &written.generation.plans {
            let buffers = planned.plan.resources.iter().filter(|planned| planned.sample_count().is_none()).count();
            let points = OpenGlBindings::of(&planned.plan);
            let most = planned.plan.passes.iter().map(|pass| pass.uses.len()).max().unwrap_or(0);
            assert!(u64::from(points.storage_buffers()) <= STORAGE_BUFFERS.max(most as u64), "{}", written.name);
            shared += usize::from(buffers as u64 > STORAGE_BUFFERS);
        }
    }
    assert!(shared > 0);
}

/// Every attachment has the samples of the state, for every k, and a pass that reads a texture knows whether it has several.
#[test]
fn textures_have_the_samples_of_the_states() {
    let mut several = 0;
    for written in ALL.iter() {
        for (part, _) in plans(written) {
            let most = part["symbols"].as_array().unwrap().iter().find(|symbol| symbol["name"] == "k").unwrap();
            let resources = part["resources"].as_array().unwrap();
            for k in 1..=most["most"].as_u64().unwrap().min(64) {
                let samples = |name: &Value| {
                    let resource = resources.iter().find(|resource| resource["name"] == *name)?;
                    Some(evaluated(part, &resource["texture"]["samples"], &[("k", k)]))
                };
                for pass in passes(part) {
                    let state = &pass["state"];
                    let count = &state["samples"]["count"];
                    let count = if count.is_null() { 1 } else { evaluated(part, count, &[("k", k)]) };
                    let targets = state["targets"].as_array().unwrap().iter().map(|target| &target["resource"]);
                    let tests = [&state["depth"]["resource"], &state["stencil"]["resource"]];
                    for name in targets.chain(tests).filter(|name| name.is_string() && *name != "output") {
                        assert_eq!(samples(name), Some(count), "{}, k {k}: {} in {}", written.name, name, pass["pass"]);
                        several += usize::from(count > 1);
                    }
                    for binding in pass["bindings"].as_array().unwrap().iter().filter(|one| one["type"] == "texture") {
                        let is_several = samples(&binding["name"]).unwrap() > 1;
                        assert_eq!(binding["multisampled"], is_several, "{}: {binding}", written.name);
                    }
                }
            }
        }
    }
    assert!(several > 10, "{several}");
}

/// A buffer has bytes where the symbols of its size are 0, and the whole elements that a shader declares at least.
#[test]
fn no_buffer_is_empty() {
    let (mut empty, mut wide) = (0, 0);
    for written in ALL.iter() {
        for (part, _) in plans(written) {
            let nothing = [("fragments", 0), ("kept", 0), ("n", 0), ("width", 1), ("height", 1), ("k", 1)];
            for resource in part["resources"].as_array().unwrap().iter().filter(|one| one["texture"].is_null()) {
                let words = evaluated(part, &resource["words"], &nothing);
                let bytes = evaluated(part, &resource["bytes"], &nothing);
                let least = if resource["element"] == "word64" { 8 } else { 4 };
                assert!(
                    bytes >= least && bytes >= 4 * words && bytes.is_multiple_of(4),
                    "{}: {resource}",
                    written.name
                );
                assert!(bytes >= resource["least_bytes"].as_u64().unwrap(), "{}: {resource}", written.name);
                empty += usize::from(words == 0);
                wide += usize::from(least > 4);
                let frame = [("fragments", 700), ("kept", 600), ("n", 9), ("width", 31), ("height", 7), ("k", 1)];
                let words = evaluated(part, &resource["words"], &frame);
                let bytes = evaluated(part, &resource["bytes"], &frame);
                assert!(words == 0 || bytes == 4 * words, "{}: {resource}", written.name);
            }
        }
    }
    assert!(empty > 10 && wide > 0, "{empty} empty buffers, {wide} of 64-bit words");
}

/// A pass lists the members whose formulas contain `iteration`: a word search finds the same.
#[test]
fn members_that_change_are_listed() {
    let mut changing = 0;
    for written in ALL.iter() {
        for pass in plans(written).into_iter().flat_map(|(part, _)| passes(part)) {
            let members = [
                ("groups", pass["groups"].to_string()),
                ("state.stencil.reference", pass["state"]["stencil"]["reference"].to_string()),
                ("state.samples.count", pass["state"]["samples"]["count"].to_string()),
                ("state.samples.mask", pass["state"]["samples"]["mask"].to_string()),
            ];
            let found: Vec<&str> =
                members.iter().filter(|(_, formula)| formula.contains("iteration")).map(|(name, _)| *name).collect();
            let listed: Vec<&str> =
                pass["per_iteration"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
            assert_eq!(listed, found, "{}: {}", written.name, pass["pass"]);
            changing += usize::from(!found.is_empty());
        }
    }
    assert!(changing > 0);
}

/// Counters of frames whose image is wrong.
#[test]
fn counters_of_wrong_images_are_losses() {
    let written = ALL.iter().find(|written| written.name == "kb_stream, Program").unwrap();
    let counters = written.manifest["counters"].as_array().unwrap();
    let losses: Vec<&str> = counters
        .iter()
        .filter(|counter| counter["is_loss"] == true)
        .filter_map(|counter| counter["name"].as_str())
        .collect();
    let wrong = [
        "pool_exhausted",
        "timed_out",
        "layers_exceeded",
        "equal_keys",
        "out_of_order",
        "not_converged",
        "samples_exhausted",
        "partial_coverage",
    ];
    assert_eq!(losses, wrong);
}
