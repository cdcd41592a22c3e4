//! Answers what the page offers: techniques and examples, scenes, devices and targets.

use std::time::Duration;

use fragbuf::{Registry, TARGETS, vocabulary};
use fragbuf_scene::BUILTIN_SCENES;
use serde_json::{Value, json};

use super::child::{self, Job};
use super::models::Models;
use super::problem::Problem;

/// The time that drivers may take to list their devices.
const DEVICES: Duration = Duration::from_secs(20);

/// Returns the text of an example by the name of its file, without the extension.
pub(in crate::cli) fn example(name: &str) -> Option<&'static str> {
    EXAMPLES.iter().find(|(key, _)| *key == name).map(|(_, text)| *text)
}

/// Descriptions of the folder `examples` that need no files.
const EXAMPLES: &[(&str, &str)] = &[
    ("glass", include_str!("../../../examples/glass.fragbuf")),
    ("most_visible", include_str!("../../../examples/most_visible.fragbuf")),
    ("by_object", include_str!("../../../examples/by_object.fragbuf")),
    ("behind_plane", include_str!("../../../examples/behind_plane.fragbuf")),
    ("farthest", include_str!("../../../examples/farthest.fragbuf")),
    ("csg", include_str!("../../../examples/csg.fragbuf")),
];

/// Returns what the page offers.
pub(super) async fn answer(models: &Models) -> Result<Value, Problem> {
    // Without their list, the page draws by WebGPU or by the device that the server selects.
    let (devices, devices_problem) = match devices().await {
        Ok(devices) => (devices, None),
        Err(problem) => (Vec::new(), Some(problem.message)),
    };
    let registry = Registry::builtin();
    let technique = |technique: &vocabulary::Technique| {
        json!({
            "key": technique.key,
            "title": technique.title,
            "paper": technique.paper,
            "summary": technique.summary,
            "text": description(&technique.key),
        })
    };
    let example = |(key, text): &(&str, &str)| json!({ "key": key, "text": text });
    let scenes = BUILTIN_SCENES.iter().map(|scene| {
        let parameter =
            |parameter: &fragbuf_scene::Parameter| json!({ "name": parameter.name, "default": parameter.default });
        json!({
            "name": scene.name,
            "summary": scene.summary,
            "parameters": scene.parameters.iter().map(parameter).collect::<Vec<_>>(),
        })
    });
    Ok(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "techniques": registry.techniques().iter().map(technique).collect::<Vec<_>>(),
        "examples": EXAMPLES.iter().map(example).collect::<Vec<_>>(),
        "scenes": scenes.collect::<Vec<_>>(),
        "models": models.list(),
        "devices": devices,
        "devices_problem": devices_problem,
        "targets": TARGETS.iter().map(|target| json!({ "name": target.name, "summary": target.summary })).collect::<Vec<_>>(),
    }))
}

/// Returns the names of the devices. Another process asks the drivers for them, because a driver may crash.
async fn devices() -> Result<Vec<String>, Problem> {
    let arguments = ["devices".to_owned(), "--json".to_owned()];
    let folder = std::env::temp_dir();
    let job = Job { arguments: &arguments, text: "", folder: &folder, most: DEVICES, queue: &child::LISTS };
    let printed = child::run(&job).await?;
    let rows: Vec<Value> = serde_json::from_slice(&printed.stdout).unwrap_or_default();
    Ok(rows.iter().filter_map(|row| Some(row["name"].as_str()?.to_owned())).collect())
}

/// Returns a description from a technique.
fn description(technique: &str) -> String {
    format!("// Changes of the technique go between the braces.\nbuffer Mine from {technique} {{\n}}\n")
}
