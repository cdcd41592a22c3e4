//! Finds the files of earlier runs in a folder. Only files that the folder's manifest lists are ever removed: those of the run before
//! as `files`, and those that were left before as `earlier_files`.

use std::fs;
use std::path::{Component, Path, PathBuf};

use fragbuf::Generation;
use serde_json::Value;

use super::output::{self, Failure};

/// Returns the files that the manifest in `folder` lists, that exist, and that `generation` does not write.
pub(crate) fn files(folder: &Path, generation: &Generation) -> Vec<PathBuf> {
    let Ok(text) = fs::read_to_string(folder.join("manifest.json")) else { return Vec::new() };
    let Ok(manifest) = serde_json::from_str::<Value>(&text) else { return Vec::new() };
    let is_manifest = manifest["schema"].as_str().is_some_and(|schema| schema.starts_with("fragbuf-manifest/"));
    let list = |name: &str| manifest[name].as_array().filter(|_| is_manifest).into_iter().flatten();
    let files = list("files").filter_map(|file| file["path"].as_str());
    let mut stale: Vec<PathBuf> = Vec::new();
    for path in files.chain(list("earlier_files").filter_map(Value::as_str)) {
        // A path that leaves the folder is not of a manifest that fragbuf wrote.
        let is_inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
        let is_written = generation.files.iter().any(|file| file.path == path);
        let file = folder.join(path);
        if is_inside && !is_written && !stale.contains(&file) && file.is_file() {
            stale.push(file);
        }
    }
    stale
}

/// Adds the files that are left to a manifest, so that a later run can remove them.
pub(crate) fn list(manifest: &mut Value, folder: &Path, left: &[PathBuf]) {
    let paths: Vec<&str> = left.iter().filter_map(|file| file.strip_prefix(folder).ok()?.to_str()).collect();
    if !paths.is_empty() {
        manifest["earlier_files"] = paths.into();
    }
}

/// Removes the files with `clean`, and the folders that become empty; otherwise warns of them.
pub(crate) fn report(folder: &Path, stale: &[PathBuf], clean: bool) -> Result<(), Failure> {
    let Some(first) = stale.first() else { return Ok(()) };
    if !clean {
        let files = if stale.len() == 1 { "1 file".to_owned() } else { format!("{} files", stale.len()) };
        output::warn(&format!(
            "{} has {files} of earlier runs, such as {}: run the command again with `--clean` to remove them",
            folder.display(),
            first.display()
        ));
        return Ok(());
    }
    for file in stale {
        fs::remove_file(file).map_err(|error| Failure::files(file, &error))?;
        let parents = file.ancestors().skip(1).take_while(|parent| *parent != folder);
        for parent in parents {
            // A folder with other files stays.
            if fs::remove_dir(parent).is_err() {
                break;
            }
        }
    }
    Ok(())
}
