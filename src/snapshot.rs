//! Snapshots for a caller's tests: one line keeps the plan of a description and its generated text under review.
//!
//! Input: the path of a description, relative to the package, or the key of a technique. Output: named texts, or the report
//! that the command line prints. [`assert_variant_snapshot!`](crate::assert_variant_snapshot) passes them to the caller's
//! `insta`; this crate does not depend on it.

use std::path::Path;

use fragbuf_codegen::Form;
use fragbuf_targets::{Generation, Request, TARGETS, Target, generate, target};
use fragbuf_templates::Registry;

use crate::load::{Description, load};
use crate::report::render;

/// Asserts an `insta` snapshot of a description's plan and of its generated text for each target: `NAME.plan`, `NAME.wgsl`, …
///
/// ```
/// #[test]
/// fn glass() {
///     fragbuf::assert_variant_snapshot!("shaders/glass.fragbuf", targets = ["wgsl", "glsl"]);
/// }
/// ```
///
/// The description is a path relative to the package, or the key of a technique. The default of `targets` is `wgsl`. A
/// description with errors fails the test with the report that the command line prints.
#[macro_export]
macro_rules! assert_variant_snapshot {
    ($description:expr $(,)?) => {
        $crate::assert_variant_snapshot!($description, targets = ["wgsl"])
    };
    ($description:expr, targets = [$($target:expr),+ $(,)?] $(,)?) => {
        match $crate::snapshot::texts($description, &[$($target),+]) {
            Ok(texts) => {
                for (name, text) in texts {
                    ::insta::assert_snapshot!(name, text);
                }
            }
            Err(report) => ::core::panic!("{report}"),
        }
    };
}

/// Returns the texts of a description by the names of their snapshots: its plans, then each target. `Err`: the report.
pub fn texts(description: &str, targets: &[&str]) -> Result<Vec<(String, String)>, String> {
    let targets: Vec<&'static Target> = targets.iter().map(|name| text_target(name)).collect::<Result<_, _>>()?;
    let registry = Registry::builtin();
    let path = Path::new(description);
    let read = match registry.technique(description) {
        Some(technique) => Description::Technique(technique.key.clone()),
        None => Description::read(path).map_err(|error| format!("{description}: {error}"))?,
    };
    let loaded = load(&read, &[], &[], &registry);
    let sources = loaded.all_sources();
    let report = |errors| render(&errors, &sources);
    let variant = loaded.variant.map_err(report)?;
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let (mut plans, mut files) = (Vec::new(), Vec::new());
    for target in targets {
        let request = Request { targets: &[target], form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &registry).map_err(report)?;
        if let Some((target, missing)) = generation.unsupported.first() {
            return Err(format!("the target `{}` does not support {description}: {missing}", target.name));
        }
        for planned in &generation.plans {
            let plan = planned.plan.to_string();
            if !plans.contains(&plan) {
                plans.push(plan);
            }
        }
        files.push((format!("{name}.{}", target.name), joined(&generation)));
    }
    let mut texts = vec![(format!("{name}.plan"), plans.concat())];
    texts.extend(files);
    Ok(texts)
}

/// Returns every file of a generation once, under its path.
pub fn joined(generation: &Generation) -> String {
    let mut text = String::new();
    let mut seen: Vec<&str> = Vec::new();
    for file in &generation.files {
        if !seen.contains(&file.path.as_str()) {
            seen.push(&file.path);
            text.push_str(&format!("// ==== {}\n{}\n", file.path, String::from_utf8_lossy(&file.bytes)));
        }
    }
    text
}

/// Returns the target of this name, if its files are text.
fn text_target(name: &str) -> Result<&'static Target, String> {
    // Binary files have no readable snapshot; the text from which they are compiled has one.
    let known: Vec<&str> = TARGETS.iter().map(|target| target.name).filter(|name| *name != "spirv").collect();
    let found = target(name).filter(|target| known.contains(&target.name));
    found.ok_or_else(|| format!("`{name}` is not a target with text files: those are {}", known.join(", ")))
}
