//! The files of a new crate.
//!
//! Input: a name and a technique. Output: paths and texts. The description is checked and its passes are generated before anything is
//! written, so the crate builds.

use fragbuf::build::module_name;
use fragbuf::vocabulary::{KeepDefault, Technique};
use fragbuf::{Diagnostics, Form, Generation, Registry, Request, TARGETS, Target, Variant, generate, parse};

use super::name::CrateName;
use super::program;
use crate::cli::output::Failure;

/// A new crate.
pub(super) struct Project {
    name: String,
    /// The key of the technique.
    pub(super) technique: String,
    description: String,
    target: &'static Target,
    generation: Generation,
}

impl Project {
    /// Creates the crate of a technique. Without one, it is the first whose fragments need no lock and of which a pixel keeps the best.
    pub(super) fn new(name: &CrateName, key: Option<&str>, registry: &Registry) -> Result<Self, Failure> {
        let techniques = registry.techniques();
        match key {
            Some(key) => {
                let known: Vec<&str> = techniques.iter().map(|technique| technique.key.as_str()).collect();
                let technique = registry.technique(key).ok_or_else(|| Failure::unknown("technique", key, &known))?;
                Project::of(name, technique, registry)
            }
            None => {
                let best = techniques.iter().filter(|technique| matches!(technique.keep, KeepDefault::Best(_)));
                let mut projects = best.filter_map(|technique| Project::of(name, technique, registry).ok());
                let sound = projects.find(|project| project.tier() == fragbuf::TIERS[0]);
                sound.ok_or_else(|| Failure::Input("no technique works without a lock".to_owned()))
            }
        }
    }

    fn of(name: &CrateName, technique: &Technique, registry: &Registry) -> Result<Self, Failure> {
        let file = format!("{}.fragbuf", name.0);
        let mut failure = Diagnostics::new();
        for part in [Part::Constraint, Part::Keep, Part::Nothing] {
            let description = description((&file, &name.in_camel_case()), technique, part);
            match parse(&description, &file).check(registry).and_then(|variant| generated(&variant, registry)) {
                Ok((target, generation)) => {
                    let (name, technique) = (name.0.clone(), technique.key.clone());
                    return Ok(Project { name, technique, description, target, generation });
                }
                Err(errors) => failure = errors,
            }
        }
        Err(Failure::Description(failure, Vec::new()))
    }

    /// Returns the soundness tier.
    fn tier(&self) -> &'static str {
        self.generation.plans.first().map_or("", |planned| fragbuf::tier(planned.plan.soundness, self.target))
    }

    /// Returns every file: its path in the folder and its text. `dependency` is the origin of fragbuf in the manifest.
    pub(super) fn files(&self, dependency: &str) -> Vec<(String, String)> {
        let name = &self.name;
        let main = program::main(&module_name(name), name, &self.generation, self.target);
        let build = BUILD.replace("NAME", name).replace("TARGET", self.target.name);
        vec![
            ("Cargo.toml".to_owned(), MANIFEST.replace("NAME", name).replace("DEPENDENCY", dependency)),
            (format!("{name}.fragbuf"), self.description.clone()),
            ("build.rs".to_owned(), build),
            ("src/main.rs".to_owned(), main),
            (".gitignore".to_owned(), "/target\n".to_owned()),
        ]
    }
}

/// Generates the passes for the first target that supports the variant.
fn generated(variant: &Variant, registry: &Registry) -> Result<(&'static Target, Generation), Diagnostics> {
    let mut last = Err(Diagnostics::new());
    for target in TARGETS.iter() {
        let request = Request { targets: &[target], form: Form::Program, prefix: "", group: 0 };
        last = generate(variant, &request, registry).map(|generation| (target, generation));
        if last.as_ref().is_ok_and(|(_, generation)| !generation.plans.is_empty()) {
            break;
        }
    }
    last
}

/// What a description has beside its payload. Some techniques keep a fixed number of fragments, or test nothing in their shaders.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// A number to keep and a constraint.
    Constraint,
    Keep,
    Nothing,
}

/// Returns a description that starts from a technique.
fn description((file, buffer): (&str, &str), technique: &Technique, part: Part) -> String {
    let mut letters = technique.summary.chars();
    let summary: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    let mut text = format!(
        "// {summary}.\n// `fragbuf show {file}` prints the plan of this file, `fragbuf language` the reference of its closures.\n\
         buffer {buffer} from {} {{\n    // The attributes of a fragment. `depth` is required.\n    \
         fragment {{ color: rgba8, depth: f32 }}\n",
        technique.key
    );
    if part == Part::Constraint {
        text += "    // A value that the program sets for each frame: fragments nearer than it are not stored.\n    \
                 uniform { near: f32 }\n    where |f, u| f.depth >= u.near;\n";
    }
    if part != Part::Nothing {
        text += &match technique.keep {
            KeepDefault::All => "    // A pixel keeps all of its fragments.\n    keep all;\n".to_owned(),
            KeepDefault::Best(k) => format!("    // A pixel keeps the nearest {k}.\n    keep {k};\n"),
        };
    }
    text + "}\n"
}

const MANIFEST: &str = "[package]
name = \"NAME\"
version = \"0.1.0\"
edition = \"2024\"

[build-dependencies]
# Without the default features fragbuf generates passes and does not build wgpu.
fragbuf = { DEPENDENCY, default-features = false }
";

const BUILD: &str =
    "//! Generates the passes of `NAME.fragbuf` and their bindings. It runs again only if the description changes.

fn main() -> Result<(), fragbuf::build::Error> {
    fragbuf::build::Build::new().file(\"NAME.fragbuf\").targets(&[\"TARGET\"]).emit()?;
    Ok(())
}
";
