//! From the functions as written to the functions of a draft.
//!
//! In: the items of a buffer. Out: a [`Draft`] in which every function is checked, lowered, and knows what it reads
//! through the helpers it calls. A function with a mistake is left out; the mistake is reported.

use fragbuf_model::{Draft, Format, Keep, Spanned, UserFunction, codes};

use crate::check::{self, Environment, Signature};
use crate::grammar::{Items, RawFunction, Role};
use crate::lower;
use crate::reads;
use crate::report::Report;
use crate::tree::Function;
use crate::types::Type;

/// Checks and lowers all functions.
pub(crate) fn finish(
    name: Spanned<String>,
    preset: Option<Spanned<String>>,
    items: Items,
    report: &mut Report,
) -> Draft {
    let environment = environment(&items, report);
    let Items { attributes, uniforms, keep, choices, functions, .. } = items;
    let checked: Vec<(Role, Option<Function>)> =
        functions.into_iter().map(|raw| (raw.role.clone(), check::function(raw, &environment, report))).collect();
    let helpers: Vec<Option<&Function>> = helper_functions(&checked, &environment);
    reads::refuse_recursion(&helpers, report);
    let keep = keep.map(|(count, _)| Keep { count, criterion: None });
    let mut draft = Draft { preset, attributes, uniforms, keep, choices, ..Draft::empty(name) };
    for (role, function) in &checked {
        let Some(function) = function else { continue };
        let lowered = lower::function(function, &environment.helpers);
        let user = UserFunction {
            name: function.name.clone(),
            origin: function.origin.clone(),
            rust: function.rust.clone(),
            wgsl: lowered.text,
            lines: lowered.lines,
            reads: reads::of(function, &helpers),
        };
        place(&mut draft, role, user);
    }
    draft
}

fn place(draft: &mut Draft, role: &Role, function: UserFunction) {
    match role {
        Role::Criterion => {
            if let Some(keep) = &mut draft.keep {
                keep.criterion = Some(function);
            }
        }
        Role::Admit(_) => draft.constraints.push(function),
        Role::Resolve => draft.resolve = Some(function),
        Role::Helper(_) => draft.helpers.push(function),
    }
}

/// What closures can see. Names whose type was refused are there too, so that nobody hears of them twice.
fn environment(items: &Items, report: &mut Report) -> Environment {
    let broken = |names: &[String]| names.iter().map(|name| (name.clone(), Type::Error)).collect::<Vec<_>>();
    let mut attributes = broken(&items.broken_attributes);
    for attribute in &items.attributes {
        attributes.push((attribute.name.value.clone(), Type::of_attribute(attribute.format.value)));
    }
    if attributes.is_empty() {
        let payload = [("color", Format::Rgba8), ("depth", Format::F32)];
        attributes = payload.map(|(name, format)| (name.to_string(), Type::of_attribute(format))).to_vec();
    }
    let mut uniforms = broken(&items.broken_uniforms);
    for uniform in &items.uniforms {
        uniforms.push((uniform.name.value.clone(), Type::of_uniform(uniform.kind.value)));
    }
    let mut helpers = Vec::new();
    for raw in &items.functions {
        if let Role::Helper(name) = &raw.role {
            helpers.push(signature(name, raw, report));
        }
    }
    Environment { attributes, uniforms, helpers }
}

fn signature(name: &str, raw: &RawFunction, report: &mut Report) -> Signature {
    let parameters = raw
        .parameters
        .iter()
        .map(|parameter| parameter.kind.as_ref().map_or(Type::Error, |kind| check::written_type(kind, report)))
        .collect();
    let result = match &raw.output {
        Some(kind) => check::written_type(kind, report),
        None => {
            let message = format!("the function `{name}` gives no value");
            report.error(codes::MISSING_VALUE, &raw.name_origin, message, "write its type: `fn … -> f32 { … }`");
            Type::Error
        }
    };
    if matches!(result, Type::Uniforms | Type::Unit) {
        let message = format!("a function cannot give `{}`", result.rust());
        report.error(codes::WRONG_TYPE, &raw.name_origin, message, "give a number, a vector, a `bool` or a `Fragment`");
    }
    Signature { name: name.to_string(), origin: raw.name_origin.clone(), parameters, result }
}

fn helper_functions<'a>(
    checked: &'a [(Role, Option<Function>)],
    environment: &Environment,
) -> Vec<Option<&'a Function>> {
    let find = |signature: &Signature| {
        let role = Role::Helper(signature.name.clone());
        checked.iter().find(|(other, _)| *other == role).and_then(|(_, function)| function.as_ref())
    };
    environment.helpers.iter().map(find).collect()
}
