//! Finds targets by name, and refuses a description that none of the requested targets supports.

use fragbuf::{Diagnostic, Generation, SourceSpan, TARGETS, Target, Variant, target};
use fragbuf_model::codes;
use fragbuf_templates::vocabulary::Feature;

use super::output::Failure;

/// Returns the target of this name.
pub(crate) fn named(name: &str) -> Result<&'static Target, Failure> {
    target(name.trim()).ok_or_else(|| Failure::unknown("target", name, &names()))
}

/// Returns the targets of these names; `all` is every target.
pub(crate) fn several(names_given: &[String]) -> Result<Vec<&'static Target>, Failure> {
    if names_given.iter().any(|name| name == "all") {
        return Ok(TARGETS.iter().collect());
    }
    let mut targets: Vec<&'static Target> = Vec::new();
    for name in names_given {
        let known: Vec<&str> = names().into_iter().chain(["all"]).collect();
        let found = target(name.trim()).ok_or_else(|| Failure::unknown("target", name, &known))?;
        if !targets.iter().any(|target| target.name == found.name) {
            targets.push(found);
        }
    }
    Ok(targets)
}

/// Returns the names of all targets.
pub(crate) fn names() -> Vec<&'static str> {
    TARGETS.iter().map(|target| target.name).collect()
}

/// Returns the targets that support whole programs of a description.
pub(crate) fn supporting(variant: &Variant) -> Vec<&'static Target> {
    let supports = |target: &&Target| {
        let mut provides = target.provides.to_vec();
        provides.push(Feature::OwnEntryPoints);
        variant.select(&provides).is_ok()
    };
    TARGETS.iter().filter(supports).collect()
}

/// Returns the failure if none of the requested targets supports the description.
pub(crate) fn unsupported(description: &str, variant: &Variant, generation: &Generation) -> Failure {
    let reasons: Vec<String> =
        generation.unsupported.iter().map(|(target, missing)| format!("{}: {missing}", target.name)).collect();
    let requested = |target: &&Target| generation.unsupported.iter().any(|(other, _)| other.name == target.name);
    let others: Vec<&str> =
        supporting(variant).iter().filter(|target| !requested(target)).map(|target| target.name).collect();
    let others = match others.as_slice() {
        [] => "choose other targets".to_owned(),
        names => format!("choose a target that supports it ({})", names.join(", ")),
    };
    let diagnostic = Diagnostic::new(
        codes::UNSUPPORTED_TARGET,
        &SourceSpan::new(description, 1, 1),
        format!("none of the targets supports the description: {}", reasons.join("; ")),
        format!("{others}, `--form program`, `--group` from 0 to 3, or add `else` alternatives to the axis"),
    );
    Failure::Description(diagnostic.into(), Vec::new())
}
