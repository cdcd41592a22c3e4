//! The jobs of effects for the scripts: each effect over every storage that portable WGSL has, with the image of its reference.

use std::path::Path;

use fragbuf::{Form, Registry, Request, Variant, generate, manifest, target};
use serde_json::{Map, Value, json};

use super::effects::{BACKGROUND, EFFECTS, Effect, Number, SIZE, Solids};
use super::jobs::write_plan;

/// An effect, the name of its job, and the expected image.
type Drawn = (&'static Effect, String, Vec<Option<[f64; 3]>>);

/// Writes the jobs into a folder, and their list into `jobs.json`.
pub fn write(folder: &Path) -> Vec<Drawn> {
    let (mut jobs, mut all) = (Vec::new(), Vec::new());
    for effect in EFFECTS {
        let solids = effect.solids();
        let expected = effect.expected(&solids);
        for (what, variant) in effect.variants() {
            let Some(job) = job((&what, effect, &variant), &solids, &folder.join(jobs.len().to_string())) else {
                continue;
            };
            jobs.push(job);
            all.push((effect, what, expected.clone()));
        }
    }
    std::fs::write(folder.join("jobs.json"), Value::from(jobs).to_string()).unwrap();
    all
}

/// Writes the files of a job, and returns it; `None` if portable WGSL lacks a feature that it needs.
fn job((what, effect, variant): (&str, &Effect, &Variant), solids: &Solids, folder: &Path) -> Option<Value> {
    let request = Request { targets: &[target("wgsl").unwrap()], form: Form::Program, prefix: "", group: 0 };
    let generation =
        generate(variant, &request, &Registry::builtin()).unwrap_or_else(|errors| panic!("{what}: {errors}"));
    generation.plans.first()?;
    write_plan(&generation, folder);
    let inputs = manifest(&generation, 0)["vertex_inputs"].clone();
    let inputs: Vec<&str> = inputs.as_array().unwrap().iter().map(|input| input["name"].as_str().unwrap()).collect();
    std::fs::write(folder.join("scene.bin"), solids.vertices(&inputs)).unwrap();
    let files = folder;
    let folder = folder.file_name().unwrap().to_str().unwrap();
    let textures = effect.textures(solids).into_iter().map(|(name, texels)| {
        let bytes: Vec<u8> = texels.values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        std::fs::write(files.join(format!("{name}.bin")), bytes).unwrap();
        let dimension = if texels.size[2] > 1 { "3d" } else { "2d" };
        json!({ "name": name, "dimension": dimension, "size": texels.size, "file": format!("{folder}/{name}.bin") })
    });
    let textures: Vec<Value> = textures.collect();
    let uniforms: Map<String, Value> =
        effect.uniforms.iter().map(|(name, number)| ((*name).to_owned(), value(*number))).collect();
    Some(json!({
        "name": what, "folder": folder, "size": SIZE, "background": BACKGROUND, "symbols": {}, "uniforms": uniforms,
        "textures": textures, "scenes": [{ "vertices": format!("{folder}/scene.bin"), "count": solids.count(), "objects": null }],
        "runs": [{ "scenes": [0], "options": {} }],
    }))
}

fn value(number: Number) -> Value {
    match number {
        Number::F32(value) => json!(value),
        Number::U32(value) => json!(value),
        Number::Vec3(values) => json!(values),
        Number::Vec4(values) => json!(values),
    }
}
