//! Snapshots for a caller's tests: one line keeps a description's plan and its text for every target under review.
//!
//! In: a description's path, relative to the package, or a technique's key. Out: named texts, or the report that the
//! command line prints. [`assert_variant_snapshot!`](crate::assert_variant_snapshot) hands them to the caller's own
//! `insta`; this crate does not depend on it.

use std::path::Path;

use fragbuf_targets::{Generation, Request, TARGETS, Target, generate, target};
use fragbuf_codegen::Form;
use fragbuf_templates::Registry;

use crate::load::{Description, load};
use crate::report::render;

/// Asserts an `insta` snapshot of a description's plan and of its text for each target: `NAME.plan`, `NAME.wgsl`, …
///
/// ```
/// #[test]
/// fn glass() {
///     fragbuf::assert_variant_snapshot!("shaders/glass.fragbuf", targets = ["wgsl", "glsl"]);
/// }
/// ```
///
/// The path is relative to the package; a technique's key does as well. Without `targets` it is `wgsl` alone. A description
/// with mistakes fails the test with the report that the command line prints.
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

/// The texts of a description by the names of their snapshots: its plans, then each target. `Err`: the report.
pub fn texts(description: &str, targets: &[&str]) -> Result<Vec<(String, String)>, String> {
    let targets: Vec<&'static Target> = targets.iter().map(|name| textual(name)).collect::<Result<_, _>>()?;
    let registry = Registry::builtin();
    let path = Path::new(description);
    let read = match registry.technique(description) {
        Some(technique) => Description::Technique(technique.key.clone()),
        None => Description::read(path).map_err(|error| format!("{description}: {error}"))?,
    };
    let loaded = load(&read, &[], &[], &registry);
    let texts = loaded.texts();
    let report = |faults| render(&faults, &texts);
    let variant = loaded.variant.map_err(report)?;
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let (mut plans, mut files) = (Vec::new(), Vec::new());
    for target in targets {
        let request = Request { targets: &[target], form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &registry).map_err(report)?;
        if let Some((target, refusal)) = generation.refusals.first() {
            return Err(format!("the target `{}` cannot express {description}: {refusal}", target.name));
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

/// Every text file of a generation once, under its path.
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

/// A target whose files are text.
fn textual(name: &str) -> Result<&'static Target, String> {
    // Binary files have no readable snapshot; what they are made from has.
    let known: Vec<&str> = TARGETS.iter().map(|target| target.name).filter(|name| *name != "spirv").collect();
    let found = target(name).filter(|target| known.contains(&target.name));
    found.ok_or_else(|| format!("`{name}` is no target of texts: those are {}", known.join(", ")))
}
