//! Finds targets by name, and refuses a description that none of the requested targets supports.

use fragbuf::load::{Description, alternatives};
use fragbuf::{Diagnostic, Form, Registry, Request, SourceSpan, TARGETS, Target, Variant, select, target};
use fragbuf_model::{MissingFeature, codes};

use super::input::Input;
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

/// Returns the failure if none of the requested targets supports the description: each with the feature that it lacks. The help names
/// what works alone.
pub(crate) fn unsupported(
    input: &Input,
    variant: &Variant,
    request: &Request<'_>,
    set: &[(String, String)],
    registry: &Registry,
) -> Failure {
    let unsupported: Vec<(&'static Target, MissingFeature)> =
        request.targets.iter().filter_map(|target| Some((*target, select(variant, target, request).err()?))).collect();
    // Targets that lack the same feature are named together.
    let mut reasons: Vec<(Vec<&str>, &MissingFeature)> = Vec::new();
    for (target, missing) in &unsupported {
        match reasons.iter_mut().find(|(_, other)| *other == missing) {
            Some((targets, _)) => targets.push(target.name),
            None => reasons.push((vec![target.name], missing)),
        }
    }
    let spans: Vec<&SourceSpan> = reasons.iter().filter_map(|(_, missing)| variant.span_of(missing)).collect();
    let described: Vec<String> =
        reasons.iter().map(|(targets, missing)| format!("{}: {missing}", targets.join(", "))).collect();
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
    let alternatives = alternatives(input.description(), set, registry, &unsupported, request);
    fixes.extend(alternatives.iter().map(|(axis, value)| match input.description() {
        Description::Technique(_) => format!("add `--set \"{axis}={value}\"`"),
        Description::Text { .. } => format!("write `{axis}: {value};`"),
    }));
    if fixes.is_empty() {
        fixes.push("start from another technique: `fragbuf list` prints the features that each requires".to_owned());
    }
    let mut diagnostic = Diagnostic::new(
        codes::UNSUPPORTED_TARGET,
        spans.first().copied().unwrap_or(&variant.name.span),
        format!("none of the targets supports the description: {}", described.join("; ")),
        fixes.join(", or "),
    );
    for span in spans.iter().skip(1).filter(|span| **span != spans[0]) {
        diagnostic = diagnostic.label(span, "requires another feature");
    }
    input.failure(diagnostic.into())
}
