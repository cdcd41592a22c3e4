//! Finds the files of earlier runs in a folder. Only files that the folder's manifest lists are ever removed: those of the run before
//! as `files` and `c_header`, and those that were left before as `earlier_files`. If this run writes nothing in the folder, the manifest is one of them.

use std::fs;
use std::path::{Component, Path, PathBuf};

use fragbuf::{Generation, TARGETS, Target};
use fragbuf_model::counted;
use serde_json::Value;

use super::output::{self, Failure};

const MANIFEST: &str = "manifest.json";

/// The files that the manifest in a folder lists, that exist, and that this run does not write.
pub(crate) struct EarlierFiles {
    folder: PathBuf,
    /// Relative to the folder.
    files: Vec<PathBuf>,
}

impl EarlierFiles {
    /// Finds the files, before this run writes its own and `header`.
    pub(crate) fn find(folder: &Path, generation: &Generation, header: Option<&str>) -> Self {
        let mut found = EarlierFiles { folder: folder.to_owned(), files: Vec::new() };
        let Ok(text) = fs::read_to_string(folder.join(MANIFEST)) else { return found };
        let Ok(manifest) = serde_json::from_str::<Value>(&text) else { return found };
        if !manifest["schema"].as_str().is_some_and(|schema| schema.starts_with("fragbuf-manifest/")) {
            return found;
        }
        let list = |name: &str| manifest[name].as_array().into_iter().flatten();
        let files = list("files").filter_map(|file| file["path"].as_str());
        let earlier = list("earlier_files").chain([&manifest["c_header"]]).filter_map(Value::as_str);
        for path in files.chain(earlier) {
            // A path that leaves the folder is not of a manifest that fragbuf wrote.
            let is_inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
            let is_written = header == Some(path) || generation.files.iter().any(|file| file.path == path);
            let path = PathBuf::from(path);
            if is_inside && !is_written && !found.files.contains(&path) && folder.join(&path).is_file() {
                found.files.push(path);
            }
        }
        if generation.plans.is_empty() {
            found.files.push(MANIFEST.into());
        }
        found
    }

    /// Adds the files to a manifest, so that a later run can remove them.
    pub(crate) fn list_in(&self, manifest: &mut Value) {
        let paths: Vec<&str> = self.files.iter().filter_map(|file| file.to_str()).collect();
        if !paths.is_empty() {
            manifest["earlier_files"] = paths.into();
        }
    }

    /// Removes the files, and the folders that become empty.
    pub(crate) fn remove(&self) -> Result<(), Failure> {
        for file in &self.files {
            let file = self.folder.join(file);
            fs::remove_file(&file).map_err(|error| Failure::files(&file, &error))?;
            let parents = file.ancestors().skip(1).take_while(|parent| parent.starts_with(&self.folder));
            for parent in parents {
                // A folder with other files stays.
                if fs::remove_dir(parent).is_err() {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Warns of the files, and says how to keep those for other targets than those of this run.
    pub(crate) fn warn(&self, targets: &[&Target]) {
        let Some(first) = self.files.first() else { return };
        let files = counted(self.files.len(), "file");
        let (folder, first) = (self.folder.display(), self.folder.join(first));
        let others = self.other_targets(targets);
        let keep = match others.as_slice() {
            [] => String::new(),
            others => {
                let written = targets.iter().map(|target| target.name).chain(others.iter().copied());
                let all =
                    TARGETS.iter().map(|target| target.name).filter(|name| written.clone().any(|other| other == *name));
                let all: Vec<&str> = all.collect();
                format!(
                    "those for {} are complete only if `manifest.json` describes them: generate all of them in one run, with \
                     `--target {}`, or each in its own folder; ",
                    others.join(", "),
                    all.join(",")
                )
            }
        };
        output::warn(&format!(
            "{folder} has {files} of earlier runs, such as {}: {keep}`--clean` removes all files of earlier runs",
            first.display()
        ));
    }

    /// Returns the other targets that files are for: the name of a target is the first folder of its files.
    fn other_targets(&self, targets: &[&Target]) -> Vec<&'static str> {
        let has_file = |target: &&Target| self.files.iter().any(|file| file.starts_with(target.name));
        let is_other = |target: &&Target| targets.iter().all(|other| other.name != target.name);
        TARGETS.iter().filter(has_file).filter(is_other).map(|target| target.name).collect()
    }
}
