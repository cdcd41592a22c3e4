//! Finds targets by name, and refuses a description that none of the requested targets supports.

use fragbuf::{Diagnostic, Form, Generation, Request, SourceSpan, TARGETS, Target, Variant, select, target};
use fragbuf_model::codes;

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

/// Returns the targets that support a description as `request` has it.
pub(crate) fn supporting(variant: &Variant, request: &Request<'_>) -> Vec<&'static Target> {
    TARGETS.iter().filter(|target| select(variant, target, request).is_ok()).collect()
}

/// Returns the failure if none of the requested targets supports the description. The help names what works alone.
pub(crate) fn unsupported(
    description: &str,
    variant: &Variant,
    request: &Request<'_>,
    generation: &Generation,
) -> Failure {
    let reasons: Vec<String> =
        generation.unsupported.iter().map(|(target, missing)| format!("{}: {missing}", target.name)).collect();
    let others: Vec<&str> = supporting(variant, request).iter().map(|target| target.name).collect();
    let mut fixes: Vec<String> = Vec::new();
    if !others.is_empty() {
        fixes.push(format!("choose a target that supports it ({})", others.join(", ")));
    }
    let works = |changed: &Request<'_>| request.targets.iter().any(|target| select(variant, target, changed).is_ok());
    if works(&Request { form: Form::Program, ..*request }) {
        fixes.push("choose `--form program`".to_owned());
    }
    if works(&Request { group: 0, ..*request }) {
        fixes.push("choose a `--group` from 0 to 3".to_owned());
    }
    fixes.push("add an `else` alternative to the axis".to_owned());
    let diagnostic = Diagnostic::new(
        codes::UNSUPPORTED_TARGET,
        &SourceSpan::new(description, 1, 1),
        format!("none of the targets supports the description: {}", reasons.join("; ")),
        fixes.join(", or "),
    );
    Failure::Description(diagnostic.into(), Vec::new())
}
