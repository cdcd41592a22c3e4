//! The files of the player: a page of its own, which draws with the modules of the playground's page and the WebGPU host.
//!
//! Input: the techniques and scenes of the site. Output: the modules, and what they read. Only `api.mjs` differs from the playground: it
//! reads static files. Names end with `.js`, because some hosts send `.mjs` with a type that browsers do not run.

use serde_json::{Value, json};

use super::scenes::Scenes;
use super::{Entry, Files};
use crate::cli::output::Failure;
use crate::cli::playground::{HOST, asset};

/// The folder of the player.
const FOLDER: &str = "play";

/// The folder of what the player reads first: a list, and a file per technique.
const DATA: &str = "data";

/// The modules of the playground's page that the player has, and its style.
const SHARED: &[&str] = &[
    "axes.mjs",
    "base.css",
    "camera.mjs",
    "check.css",
    "code_style.mjs",
    "code_view.mjs",
    "controls.mjs",
    "costs.css",
    "dom.mjs",
    "editor.css",
    "file_tabs.mjs",
    "geometry.mjs",
    "language.mjs",
    "markdown.mjs",
    "picture.css",
    "picture.mjs",
    "scenes.mjs",
    "sliders.mjs",
    "state.mjs",
    "statistics.mjs",
    "status.mjs",
    "style.css",
    "tabs.mjs",
    "theme.mjs",
    "uniforms.mjs",
    "vendor/codemirror.mjs",
    "webgpu_frames.mjs",
    "windows.css",
];

/// The files of the folder `page`, with their paths in the site.
const OWN: &[(&str, &str)] = &[
    ("site.css", include_str!("page/site.css")),
    ("colours.mjs", include_str!("page/colours.mjs")),
    ("play/address.mjs", include_str!("page/address.mjs")),
    ("play/api.mjs", include_str!("page/api.mjs")),
    ("play/choices.mjs", include_str!("page/choices.mjs")),
    ("play/index.html", include_str!("page/index.html")),
    ("play/passes.mjs", include_str!("page/passes.mjs")),
    ("play/player.css", include_str!("page/player.css")),
    ("play/player.mjs", include_str!("page/player.mjs")),
    ("play/prerendered.mjs", include_str!("page/prerendered.mjs")),
    ("play/vendor/LICENSES.txt", include_str!("../playground/page/vendor/LICENSES.txt")),
];

/// Adds the player and what it reads.
pub(super) fn add(entries: &[Entry], scenes: &Scenes, files: &mut Files) -> Result<(), Failure> {
    for (path, text) in OWN {
        add_text(path, text, files);
    }
    let shared = SHARED.iter().map(|name| (*name).to_owned());
    let host = HOST.iter().map(|asset| asset.path.to_owned());
    for name in shared.chain(host) {
        let text = asset(&name).and_then(|bytes| std::str::from_utf8(bytes).ok());
        let text = text.ok_or_else(|| Failure::Files(format!("this program has no `{name}`: build it again")))?;
        add_text(&format!("{FOLDER}/{name}"), text, files);
    }
    let list: Vec<Value> = entries.iter().map(|entry| listed(entry, files)).collect();
    let site = json!({ "version": env!("CARGO_PKG_VERSION"), "techniques": list, "scenes": scenes.0 });
    files.add(format!("{DATA}/site.json"), site.to_string());
    Ok(())
}

/// Adds a text. Modules and what they import are renamed.
fn add_text(path: &str, text: &str, files: &mut Files) {
    let path = path.strip_suffix(".mjs").map_or_else(|| path.to_owned(), |stem| format!("{stem}.js"));
    files.add(path, text.replace(".mjs\"", ".js\""));
}

/// Adds the file of a technique. Returns the part of it that the player reads before it is chosen.
fn listed(entry: &Entry, files: &mut Files) -> Value {
    let path = format!("{DATA}/{}.json", entry.key);
    files.add(path.as_str(), entry.player.to_string());
    let [title, unsupported] = ["title", "unsupported"].map(|field| &entry.player[field]);
    json!({ "key": entry.key, "title": title, "drawn": unsupported.is_null(), "data": path })
}
