//! Checks whether the WGSL source of a user file implements the contract of its axis.
//!
//! Input: the row in the header of the file, and the spans of its lines. Output: the complete row, or a diagnostic per error. The
//! kind and state of a pass come from a row of the registry that uses the same skeleton. A function is required if a row calls it;
//! this source file names no function.

use fragbuf_model::codes::{
    CONTRACT_MISMATCH, INVALID_ROW, INVALID_WGSL, MISSING_CLEAR, UNKNOWN_AXIS, UNKNOWN_VALUE, UNUSED_EFFECT,
};
use fragbuf_model::{Diagnostic, Diagnostics, RowSpans, SourceSpan, UserRow, mangled};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Capability, Element, Host, Init, Kind, Lifetime, Pass, Row, State, Step};

use crate::link::{FunctionSignature, GrammarError, Item, grammar_errors, items, parameter_names, signatures, types};
use crate::{CONTRACTS, Contract};

/// Returns an error about the first expression or `if` of a source that is too long for naga, which recurses over both.
pub fn too_long(source: &str, file: &str) -> Option<Diagnostic> {
    let error = grammar_errors(source).into_iter().find(|error| error.is_length)?;
    Some(diagnostic(error, &File { source, name: &file.into() }))
}

fn diagnostic(error: GrammarError, file: &File<'_>) -> Diagnostic {
    let span = file.name_at(error.at, error.operator);
    Diagnostic::new(INVALID_WGSL, &span, error.message, error.help)
}

/// Checks the row of a user file and completes it for the registry. Reports all errors.
pub fn validate_user_row(user_row: UserRow, registry: &Registry) -> Result<Row, Diagnostics> {
    let UserRow { mut row, ref spans } = user_row;
    let mut diagnostics = Diagnostics::new();
    steps(&mut row, spans, registry, &mut diagnostics);
    resources(&row, spans, registry, &mut diagnostics);
    parameters(&row, spans, registry, &mut diagnostics);
    defaults(&row, spans, registry, &mut diagnostics);
    if let Some(template) = &row.template {
        let file = File { source: &template.source, name: &spans.row.file };
        for error in grammar_errors(&template.source) {
            diagnostics.push(diagnostic(error, &file));
        }
        match items(&template.source) {
            Ok(items) => {
                declarations(&items, &file, &mut diagnostics);
                functions(&row, &file, spans, registry, &mut diagnostics);
                row.calls = calls(&row, &items, registry);
            }
            Err(line) => diagnostics.push(Diagnostic::new(
                INVALID_WGSL,
                &file.line(line),
                "expected a declaration",
                "declare `fn`, `const`, `struct`, `alias` or `var<private>` at module scope, with every brace closed",
            )),
        }
    }
    diagnostics.into_result(row)
}

/// Returns the warnings about the row of a user file: no pass computes the effect, or a pass reads words that nothing wrote.
pub fn user_row_warnings(user_row: &UserRow, registry: &Registry) -> Diagnostics {
    let UserRow { row, spans } = user_row;
    let kind = |pass: &Pass| kind_and_state(&pass.skeleton, registry).map(|(kind, _)| kind);
    let passes = all_passes(&row.steps);
    let mut warnings = Diagnostics::new();
    let draws = |pass: &&Pass| kind(pass) == Some(Kind::Geometry);
    if !passes.iter().any(draws) {
        return warnings;
    }
    if !passes.iter().any(|pass| kind(pass) == Some(Kind::Fullscreen)) {
        let uses: Vec<String> = row.resources.iter().map(|resource| format!("{} read", resource.name)).collect();
        let message = format!("no pass of this {} computes the effect, so nothing is drawn", row.axis);
        let help = format!("add `//: pass resolve: {}`", uses.join(", "));
        warnings.push(Diagnostic::new(UNUSED_EFFECT, &spans.row, message, help));
    }
    for (resource, span) in row.resources.iter().zip(&spans.resources) {
        let uses = passes.iter().flat_map(|pass| pass.uses.iter().map(move |usage| (pass, usage)));
        let first = uses.into_iter().find(|(_, usage)| usage.resource == resource.name);
        // Entries are guarded by words, and a plain or coherent access may be a store.
        let is_word = resource.element == Element::Word && resource.lifetime == Lifetime::Frame;
        let Some((pass, usage)) = first.filter(|_| is_word && resource.init == Init::Keep) else { continue };
        let reads = usage.access == Access::Read || usage.access == Access::Atomic && draws(pass);
        if reads {
            let name = &resource.name;
            let message = format!(
                "pass `{}` reads words of `{name}` that nothing in the frame has set: they are those of an earlier frame",
                pass.name
            );
            let help =
                format!("add `clear 0` to its line, or `persistent` if `{name}` keeps its content across frames");
            warnings.push(Diagnostic::new(MISSING_CLEAR, span, message, help));
        }
    }
    warnings
}

/// A user file.
struct File<'a> {
    source: &'a str,
    name: &'a std::sync::Arc<str>,
}

impl File<'_> {
    /// Returns the span of a line, counted from 1.
    fn line(&self, number: usize) -> SourceSpan {
        let text = self.source.lines().nth(number.saturating_sub(1)).unwrap_or("");
        let indent = text.chars().count() - text.trim_start().chars().count();
        SourceSpan::new(self.name.clone(), number as u32, indent as u32 + 1)
            .with_length(text.trim().chars().count() as u32)
    }

    /// Returns the span of a name at a byte offset.
    fn name_at(&self, offset: usize, name: &str) -> SourceSpan {
        let before = &self.source[..offset];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |text| text.chars().count()) + 1;
        SourceSpan::new(self.name.clone(), line as u32, column as u32).with_length(name.chars().count() as u32)
    }
}

/// Completes the passes with the kind and state of a pass of the registry that has the same skeleton.
fn steps(row: &mut Row, spans: &RowSpans, registry: &Registry, diagnostics: &mut Diagnostics) {
    let (mut unknown, axis) = (false, row.axis.clone());
    for (step, span) in row.steps.iter_mut().zip(&spans.steps) {
        if let Step::Host(host) = step {
            host_function(host, span, registry, diagnostics);
        }
        let Step::Pass(pass) = step else { continue };
        if let Some((kind, state)) = kind_and_state(&pass.skeleton, registry) {
            (pass.kind, pass.state) = (kind, state);
            continue;
        }
        unknown = true;
        let help = format!("the passes are {}", known_skeletons(registry).join(", "));
        let message = format!("there is no pass `{}`", pass.skeleton);
        diagnostics.push(Diagnostic::new(UNKNOWN_VALUE, span, message, help));
    }
    let mut others = registry.rows_of(&axis).peekable();
    let is_start = others.peek().is_some() && others.all(draws);
    if is_start && !unknown && !draws(row) {
        let message = format!("no pass of the row draws the scene; a {axis} requires one");
        diagnostics.push(Diagnostic::new(
            INVALID_ROW,
            &spans.row,
            message,
            "add a line such as `//: pass store: entries plain`",
        ));
    }
}

/// Checks that a host step calls a row of the axis `host`.
fn host_function(host: &Host, span: &SourceSpan, registry: &Registry, diagnostics: &mut Diagnostics) {
    if registry.row("host", &host.function).is_some_and(|row| row.host.is_some()) {
        return;
    }
    let known: Vec<&str> = registry.rows_of("host").map(|row| row.key.as_str()).collect();
    let message = format!("there is no host function `{}`", host.function);
    let help = format!("the functions are {}; a program can add functions with `Registry::with`", known.join(", "));
    diagnostics.push(Diagnostic::new(UNKNOWN_VALUE, span, message, help));
}

/// Tests whether a pass of the row draws the scene.
fn draws(row: &Row) -> bool {
    all_passes(&row.steps).iter().any(|pass| pass.kind == Kind::Geometry)
}

fn kind_and_state(skeleton: &str, registry: &Registry) -> Option<(Kind, State)> {
    passes(registry).find(|pass| pass.skeleton == skeleton).map(|pass| (pass.kind.clone(), pass.state.clone()))
}

fn known_skeletons(registry: &Registry) -> Vec<String> {
    let mut known: Vec<String> = Vec::new();
    for pass in passes(registry) {
        if !known.contains(&pass.skeleton) {
            known.push(pass.skeleton.clone());
        }
    }
    known
}

/// Returns the passes that a user file can have. Passes with tests or other targets are excluded, because user files cannot declare
/// their textures.
fn passes(registry: &Registry) -> impl Iterator<Item = &Pass> {
    let is_plain = |pass: &&Pass| {
        let state = &pass.state;
        let tests = state.depth.is_some() || state.stencil.is_some() || state.samples.is_some();
        !tests && state.targets.iter().all(|target| target.resource == OUTPUT)
    };
    registry.rows().iter().flat_map(|row| all_passes(&row.steps)).filter(is_plain)
}

/// The name of the caller's render target in the vocabulary.
const OUTPUT: &str = "output";

/// Returns the passes in order, including passes inside loops.
fn all_passes(steps: &[Step]) -> Vec<&Pass> {
    let mut passes = Vec::new();
    for step in steps {
        match step {
            Step::Pass(pass) => passes.push(pass),
            Step::Repeat(repeat) => passes.extend(all_passes(&repeat.body)),
            _ => {}
        }
    }
    passes
}

/// Checks that the names of buffers are unique.
fn resources(row: &Row, spans: &RowSpans, registry: &Registry, diagnostics: &mut Diagnostics) {
    for (resource, span) in row.resources.iter().zip(&spans.resources) {
        let name = &resource.name;
        let owner = registry
            .rows()
            .iter()
            .find(|other| other.axis != row.axis && other.resources.iter().any(|resource| resource.name == *name));
        let message = match owner {
            Some(owner) => format!("`{}: {}` also has a buffer `{name}`", owner.axis, owner.key),
            None if mangled(name) != name.as_str() => format!("`{name}` is a name of WGSL or of generated code"),
            None => continue,
        };
        diagnostics.push(Diagnostic::new(
            CONTRACT_MISMATCH,
            span,
            message,
            format!("choose another name, such as `own_{name}`"),
        ));
    }
}

/// Checks that the constants are unique: rows of other axes can be in the same program.
fn parameters(row: &Row, spans: &RowSpans, registry: &Registry, diagnostics: &mut Diagnostics) {
    for (index, (parameter, span)) in row.parameters.iter().zip(&spans.parameters).enumerate() {
        let constant = &parameter.constant;
        let others = registry.rows().iter().filter(|other| other.axis != row.axis).flat_map(|other| &other.parameters);
        if others.chain(&row.parameters[..index]).any(|other| other.constant == *constant) {
            let message = format!("another parameter also has the constant `{constant}`");
            let help = format!("choose another name, such as `OWN_{constant}`");
            diagnostics.push(Diagnostic::new(CONTRACT_MISMATCH, span, message, help));
        }
    }
}

/// Checks that the default choices exist.
fn defaults(row: &Row, spans: &RowSpans, registry: &Registry, diagnostics: &mut Diagnostics) {
    for ((axis, value), span) in row.defaults.iter().zip(&spans.defaults) {
        let values: Vec<&str> = registry.rows_of(axis).map(|row| row.key.as_str()).collect();
        if registry.axis(axis).is_none_or(|axis| !axis.chosen) {
            let known: Vec<&str> = registry.axes().iter().filter(|axis| axis.chosen).map(|axis| axis.key).collect();
            let help = format!("the axes are {}", known.join(", "));
            diagnostics.push(Diagnostic::new(UNKNOWN_AXIS, span, format!("there is no axis `{axis}`"), help));
        } else if !values.contains(&value.as_ref()) {
            let message = format!("`{value}` is not a value of the axis `{axis}`");
            let help = format!("the values of `{axis}` are {}", values.join(", "));
            diagnostics.push(Diagnostic::new(UNKNOWN_VALUE, span, message, help));
        }
    }
}

/// Rejects entry points and bindings: skeletons contain them, or they are generated.
fn declarations(items: &[Item<'_>], file: &File<'_>, diagnostics: &mut Diagnostics) {
    for item in items {
        let span = file.line(item.declared_line);
        if item.stage.is_some() {
            let message = format!("`{}` is an entry point; only the skeletons of passes have entry points", item.name);
            diagnostics.push(Diagnostic::new(
                CONTRACT_MISMATCH,
                &span,
                message,
                "make it a function that a contract function calls",
            ));
        } else if item.is_bound {
            let message = format!("`{}` has a binding; bindings are generated", item.name);
            let help = "declare it in the header, `//: buffer name[pixel < pixels]: word`, and use `name_load(pixel)`";
            diagnostics.push(Diagnostic::new(CONTRACT_MISMATCH, &span, message, help));
        }
    }
}

/// Checks the signatures of contract functions, and that the functions that other rows call exist.
fn functions(row: &Row, file: &File<'_>, spans: &RowSpans, registry: &Registry, diagnostics: &mut Diagnostics) {
    let signatures = signatures(file.source);
    for FunctionSignature { name, signature, offset } in &signatures {
        let Some(contract) = CONTRACTS.iter().find(|contract| contract.name == *name) else { continue };
        let span = file.name_at(*offset, name);
        if contract.axis != row.axis {
            let message = format!("`fn {name}` belongs to the axis `{}`", contract.axis);
            let help = format!("this file is a {}: give the function another name", row.axis);
            diagnostics.push(Diagnostic::new(CONTRACT_MISMATCH, &span, message, help));
        } else if types(signature) != types(contract.signature) {
            let message = format!("`fn {name}{signature}` does not match the contract");
            let help = format!("write `fn {name}{}`: {}", contract.signature, contract.behaviour);
            diagnostics.push(Diagnostic::new(CONTRACT_MISMATCH, &span, message, help));
        } else if let Some((found, index)) = moved_parameter(signature, contract) {
            let message = format!("the parameters of `fn {name}{signature}` are in another order than in the contract");
            let help = format!(
                "write `fn {name}{}`: the argument for `{found}` is the {}",
                contract.signature,
                ["first", "second", "third", "fourth"].get(index).unwrap_or(&"last")
            );
            diagnostics.push(Diagnostic::new(CONTRACT_MISMATCH, &span, message, help));
        }
    }
    for (contract, caller, span) in required(row, spans, registry) {
        let is_shared = || registry.shared().iter().any(|shared| has_function(&shared.source, contract.name));
        if !signatures.iter().any(|function| function.name == contract.name) && !is_shared() {
            let message = format!("{caller} calls `fn {}`, which the file does not declare", contract.name);
            let help = format!("add `fn {}{}`: {}", contract.name, contract.signature, contract.behaviour);
            diagnostics.push(Diagnostic::new(CONTRACT_MISMATCH, &span, message, help));
        }
    }
}

/// Returns a parameter whose name another parameter of the contract has, and the index of that one. The types are equal, so that no
/// compiler notices an exchange such as `(cursor: u32, pixel: u32)`.
fn moved_parameter<'s>(signature: &'s str, contract: &Contract) -> Option<(&'s str, usize)> {
    let (found, expected) = (parameter_names(signature), parameter_names(contract.signature));
    let moved = |(index, name): (usize, &'s str)| {
        let other = expected.iter().position(|other| *other == name)?;
        (other != index).then_some((name, other))
    };
    found.into_iter().enumerate().find_map(moved)
}

/// Tests whether a source has a function of this name. Rows without one use the shared function.
fn has_function(source: &str, name: &str) -> bool {
    signatures(source).iter().any(|function| function.name == name)
}

/// Returns the functions that a row must have, each with a caller and the line that adds the caller. Callers are the skeletons of the
/// row's passes, and rows of other axes if this row provides the capabilities that they require of it.
fn required(row: &Row, spans: &RowSpans, registry: &Registry) -> Vec<(&'static Contract, String, SourceSpan)> {
    let mut required: Vec<(&'static Contract, String, SourceSpan)> = Vec::new();
    for caller in registry.rows().iter().filter(|caller| caller.axis != row.axis) {
        let Some(template) = &caller.template else { continue };
        let is_chosen = registry.axis(&caller.axis).is_some_and(|axis| axis.chosen);
        // A capability that no row of this axis provides comes from other axes or from the description.
        let is_of_other_axes =
            |capability: &Capability| !registry.rows_of(&row.axis).any(|other| other.may_provide(*capability));
        let is_compatible =
            || caller.requires.iter().all(|capability| row.may_provide(*capability) || is_of_other_axes(capability));
        let (name, span) = match is_chosen {
            true if is_compatible() => (format!("`{}: {}`", caller.axis, caller.key), spans.row.clone()),
            true => continue,
            false => match pass_line(row, &caller.key, spans) {
                Some(span) => (format!("pass `{}`", caller.key), span),
                None => continue,
            },
        };
        let mentioned = items(&template.source).unwrap_or_default();
        for contract in CONTRACTS.iter().filter(|contract| contract.axis == row.axis) {
            let calls = mentioned.iter().any(|item| item.mentions.contains(&contract.name));
            if calls && !required.iter().any(|(known, ..)| known.name == contract.name) {
                required.push((contract, name.clone(), span.clone()));
            }
        }
    }
    required
}

/// Returns the line of the pass with this skeleton, or the line of the row if the row has no passes.
fn pass_line(row: &Row, skeleton: &str, spans: &RowSpans) -> Option<SourceSpan> {
    if row.steps.is_empty() {
        return Some(spans.row.clone());
    }
    let is_match = |step: &Step| matches!(step, Step::Pass(pass) if pass.skeleton == skeleton);
    row.steps.iter().zip(&spans.steps).find(|(step, _)| is_match(step)).map(|(_, span)| span.clone())
}

/// Returns the axes whose contracts the source calls. Functions of a pass need no entry: they are present if the pass is.
fn calls(row: &Row, items: &[Item<'_>], registry: &Registry) -> Vec<&'static str> {
    let mut calls: Vec<&'static str> = Vec::new();
    let is_chosen = |axis: &str| registry.axis(axis).is_some_and(|axis| axis.chosen);
    for contract in CONTRACTS.iter().filter(|contract| contract.axis != row.axis && is_chosen(contract.axis)) {
        let is_called = items.iter().any(|item| item.mentions.contains(&contract.name));
        if is_called && !calls.contains(&contract.axis) {
            calls.push(contract.axis);
        }
    }
    calls
}
