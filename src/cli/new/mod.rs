//! `fragbuf new`: creates a crate with a description, a build script that generates its passes, and a program that lists them.
//!
//! Input: a name and a technique. Output: a folder. Nothing is overwritten, and the files have no paths but those that the user gives.

mod files;
mod name;
mod program;

use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use fragbuf::Registry;
use serde_json::json;

use self::files::Project;
use self::name::CrateName;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct New {
    /// Name of the crate, of its folder and of its description
    name: CrateName,
    /// Technique that the description starts from [default: the first that needs no lock]
    #[arg(long, value_name = "KEY")]
    technique: Option<String>,
    /// Folder of fragbuf's source, to use instead of the published version
    #[arg(long, value_name = "FOLDER")]
    path: Option<PathBuf>,
}

impl New {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let dependency = match &self.path {
            None => "version = \"0.1\"".to_owned(),
            Some(folder) => format!("path = {}", json!(seen_from_the_crate(folder)?)),
        };
        let project = Project::new(&self.name, self.technique.as_deref(), &Registry::builtin())?;
        let folder = Path::new(&self.name.0);
        fs::create_dir(folder).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => {
                Failure::Files(format!("`{}` exists already: choose another name, or remove it", folder.display()))
            }
            _ => Failure::files(folder, &error),
        })?;
        for (path, text) in project.files(&dependency) {
            let path = folder.join(path);
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent).map_err(|error| Failure::files(parent, &error))?;
            }
            fs::write(&path, text).map_err(|error| Failure::files(&path, &error))?;
        }
        let name = &self.name.0;
        output::print(&format!(
            "created {name}/ from `{}`: `cargo run` in it generates the passes of {name}.fragbuf and lists them{}\n",
            project.technique,
            if cfg!(feature = "pictures") {
                format!("\n`fragbuf render {name}/{name}.fragbuf --scene builtin:marbles --out {name}.png` draws it")
            } else {
                String::new()
            }
        ))
    }
}

/// Returns the path of fragbuf's source as a manifest in the new folder has it.
fn seen_from_the_crate(folder: &Path) -> Result<String, Failure> {
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    if !manifest.lines().any(|line| line.trim() == "name = \"fragbuf\"") {
        return Err(Failure::Usage(format!(
            "`--path {}`: no source of the crate `fragbuf`: give the folder of its Cargo.toml",
            folder.display()
        )));
    }
    let is_relative = !folder.has_root() && !matches!(folder.components().next(), Some(Component::Prefix(_)));
    let path = if is_relative { Path::new("..").join(folder) } else { folder.to_owned() };
    // Cargo accepts `/` on every system.
    path.to_str().map(|path| path.replace('\\', "/")).ok_or_else(|| {
        Failure::Usage(format!("`--path {}` is not Unicode, which a Cargo.toml requires", folder.display()))
    })
}
