//! The output folder of a site.
//!
//! Input: a folder and the files of a site. Output: the files on disk, and a list of them in the folder. Only files that the list of an
//! earlier run names are replaced or removed; a folder with other files and no list is an error, before anything is generated.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use serde_json::{Value, json};

use super::Files;
use crate::cli::generate::write_file;
use crate::cli::output::{self, Failure};

/// The file that lists the files of a site.
const LIST: &str = "fragbuf-site.json";

/// The version of the list.
const SCHEMA: &str = "fragbuf-site/1";

/// A folder that may be written to.
pub(super) struct Folder {
    path: PathBuf,
    /// The files of an earlier run.
    earlier: BTreeSet<String>,
}

impl Folder {
    /// Checks that the folder is new, empty or of an earlier run.
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        Failure::unless_folder(path)?;
        let mut folder = Folder { path: path.to_owned(), earlier: BTreeSet::new() };
        if let Some(earlier) = listed(&path.join(LIST)) {
            folder.earlier = earlier;
            return Ok(folder);
        }
        let mut entries = match fs::read_dir(path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(folder),
            Err(error) => return Err(Failure::files(path, &error)),
        };
        match entries.next() {
            None => Ok(folder),
            Some(_) => Err(Failure::Files(format!(
                "{} has files that `fragbuf site` did not write: give a new or an empty folder",
                path.display()
            ))),
        }
    }

    /// Writes the files, and removes those of an earlier run that are no longer among them.
    pub(super) fn write(&self, files: &Files) -> Result<(), Failure> {
        let now: BTreeSet<String> = files.iter().map(|(path, _)| path.to_owned()).collect();
        // Until everything is written, the list has the files of both runs: a run that fails leaves a folder that the next may write to.
        let both: BTreeSet<String> = now.union(&self.earlier).cloned().collect();
        self.list(&both)?;
        for (path, bytes) in files.iter() {
            write_file(&self.path.join(path), bytes)?;
        }
        for path in self.earlier.difference(&now) {
            self.remove(path)?;
        }
        self.list(&now)
    }

    fn list(&self, paths: &BTreeSet<String>) -> Result<(), Failure> {
        write_file(&self.path.join(LIST), output::json(&json!({ "schema": SCHEMA, "files": paths })).as_bytes())
    }

    /// Removes a file of an earlier run, and the folders that become empty.
    fn remove(&self, path: &str) -> Result<(), Failure> {
        let file = self.path.join(path);
        match fs::remove_file(&file) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(Failure::files(&file, &error)),
            _ => {}
        }
        let parents = file.ancestors().skip(1).take_while(|parent| *parent != self.path);
        for parent in parents {
            // A folder with other files stays.
            if fs::remove_dir(parent).is_err() {
                break;
            }
        }
        Ok(())
    }
}

/// Returns the files that a list names; `None`: it is no list of a site. A path that leaves the folder is not one that fragbuf wrote.
fn listed(path: &Path) -> Option<BTreeSet<String>> {
    let list: Value = serde_json::from_str(&fs::read_to_string(path).ok()?).ok()?;
    let is_inside = |path: &&str| Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
    let paths = list["files"].as_array().filter(|_| list["schema"] == SCHEMA)?;
    Some(paths.iter().filter_map(Value::as_str).filter(is_inside).map(str::to_owned).collect())
}
