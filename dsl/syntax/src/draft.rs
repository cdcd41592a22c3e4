//! Builds a draft from the items of a buffer.
//!
//! Input: a description as written. Output: a [`Draft`] in which every function is type-checked and lowered, and lists
//! what it reads, including through helpers. A function with an error is reported and omitted.

use fragbuf_model::{Draft, Format, Image, Keep, Resumable, Spanned, Unused, UserFunction, codes};

use crate::check;
use crate::environment::{Environment, Signature};
use crate::items::{Items, RawDescription};
use crate::lower;
use crate::raw_function::{RawFunction, Role};
use crate::reads;
use crate::report::Report;
use crate::suspicious;
use crate::tree::Function;
use crate::types::{Shape, Type};

/// Returns the draft of a description: checks and lowers all functions.
pub(crate) fn build(description: RawDescription, report: &mut Report) -> Draft {
    let RawDescription { name, preset, mut items } = description;
    items.reject_names_twice(report);
    let environment = environment(&items, report);
    let Items { attributes, uniforms, textures, images, keep, choices, functions, invalid_attributes, effect, .. } =
        items;
    let mut incomplete = items.incomplete;
    let is_effect = |role: &Role| matches!(role, Role::Resolve | Role::Between);
    let of_effect = functions.iter().find(|function| is_effect(&function.role)).map(|function| function.span.clone());
    // An attribute of unknown format provides unknown capabilities.
    incomplete.attributes |= !invalid_attributes.is_empty();
    let checked: Vec<(Role, Option<Function>)> =
        functions.into_iter().map(|raw| (raw.role.clone(), check::function(raw, &environment, report))).collect();
    let helpers: Vec<Option<&Function>> = helper_functions(&checked, &environment);
    reads::reject_recursion(&helpers, report);
    let keep = keep.map(|(count, _)| Keep { count, criterion: None });
    let mut draft = Draft { preset, attributes, uniforms, textures, keep, choices, ..Draft::empty(name) };
    incomplete.resolve |= checked.iter().any(|(role, function)| is_effect(role) && function.is_none());
    incomplete.uniforms |= checked.iter().any(|(role, function)| matches!(role, Role::Image(_)) && function.is_none());
    draft.incomplete = incomplete;
    draft.effect = of_effect.or(effect).map(|span| Spanned::new((), span));
    draft.unused = unused(&checked, &environment, &helpers);
    for (role, function) in &checked {
        let Some(function) = function else { continue };
        draft.suspicious.extend(suspicious::of(function, &helpers));
        let lowered = lower::function(function, &environment.helpers);
        let user = UserFunction {
            name: function.name.clone(),
            span: function.span.clone(),
            rust: function.rust.clone(),
            wgsl: lowered.source,
            lines: lowered.lines,
            reads: reads::of(function, &helpers),
            resumable: None,
        };
        let user = match role {
            Role::Resolve => with_parts(user, function, &environment),
            _ => user,
        };
        reject_unknown_images(&user, role, &draft, report);
        add_function(&mut draft, role, user, &images);
    }
    draft
}

/// Returns the helpers that no closure calls, directly or through helpers, and the variables that nothing reads.
fn unused(
    checked: &[(Role, Option<Function>)],
    environment: &Environment,
    helpers: &[Option<&Function>],
) -> Vec<Spanned<Unused>> {
    let closures = checked.iter().filter(|(role, _)| !matches!(role, Role::Helper(_)));
    let called = reads::called(closures.filter_map(|(_, function)| function.as_ref()), helpers);
    let signatures = environment.helpers.iter().zip(called).filter(|(_, is_called)| !is_called);
    let functions =
        signatures.map(|(helper, _)| Spanned::new(Unused::Function(helper.name.clone()), helper.span.clone()));
    let variables = checked.iter().filter_map(|(_, function)| function.as_ref()).flat_map(|function| &function.unused);
    let variables = variables.map(|name| Spanned::new(Unused::Variable(name.value.clone()), name.span.clone()));
    functions.chain(variables).collect()
}

/// Adds the parts of an effect, or what prevents them.
fn with_parts(user: UserFunction, function: &Function, environment: &Environment) -> UserFunction {
    let parts = lower::resumable(function, &environment.helpers);
    let resumable = parts.map(|parts| {
        let [begin, advance, end] = [parts.begin, parts.advance, parts.end];
        let part = |name: &str, source: lower::WgslFunction| UserFunction {
            name: name.to_owned(),
            wgsl: source.source,
            lines: source.lines,
            ..user.clone()
        };
        let [first, second, third] = lower::PARTS;
        let (begin, advance, end) = (part(first, begin), part(second, advance), part(third, end));
        Box::new(Resumable { members: parts.members, begin, advance, end })
    });
    UserFunction { resumable: Some(resumable), ..user }
}

/// Reports images that a function reads before they are computed. Only images and `resolve` read images.
fn reject_unknown_images(function: &UserFunction, role: &Role, draft: &Draft, report: &mut Report) {
    if matches!(role, Role::Helper(_)) {
        return;
    }
    let is_computed = |name: &String| draft.images.iter().any(|image| image.name.value == *name);
    for name in function.reads.images.iter().filter(|name| !role.reads_list() || !is_computed(name)) {
        let (message, help) = match role {
            Role::Image(own) if own == name => {
                (format!("the image `{name}` reads itself"), "an image can read the images before it".to_owned())
            }
            Role::Image(own) => (
                format!("`{own}` reads the image `{name}`, which is computed later"),
                format!("move `image {name}` before `image {own}`"),
            ),
            Role::Resolve if draft.incomplete.uniforms => return,
            Role::Resolve => (
                format!("the effect reads the image `{name}`, which is computed later"),
                format!("move `image {name}` before `resolve`"),
            ),
            _ => (
                format!("this closure reads the image `{name}`, which is computed from kept fragments"),
                "only `resolve` and later images can read an image".to_owned(),
            ),
        };
        report.error(codes::UNSUPPORTED, &function.span, message, help);
    }
}

fn add_function(draft: &mut Draft, role: &Role, function: UserFunction, images: &[Spanned<String>]) {
    match role {
        Role::Criterion => {
            if let Some(keep) = &mut draft.keep {
                keep.criterion = Some(function);
            }
        }
        Role::Constraint(_) => draft.constraints.push(function),
        Role::Resolve => draft.resolve = Some(function),
        Role::Between => draft.between = Some(function),
        Role::Image(name) => {
            let name = images.iter().find(|image| image.value == *name).cloned();
            draft.images.extend(name.map(|name| Image { name, function }));
        }
        Role::Helper(_) => draft.helpers.push(function),
    }
}

/// Returns the names that closures can use. Names with an invalid type are included, so that their uses are not reported.
fn environment(items: &Items, report: &mut Report) -> Environment {
    let invalid = |names: &[String]| names.iter().map(|name| (name.clone(), Type::Error)).collect::<Vec<_>>();
    let mut attributes = invalid(&items.invalid_attributes);
    for attribute in &items.attributes {
        attributes.push((attribute.name.value.clone(), Type::of_attribute(attribute.format.value)));
    }
    if attributes.is_empty() {
        let payload = [("color", Format::Rgba8), ("depth", Format::F32)];
        attributes = payload.map(|(name, format)| (name.to_string(), Type::of_attribute(format))).to_vec();
    }
    let mut uniforms = invalid(&items.invalid_uniforms);
    for uniform in &items.uniforms {
        uniforms.push((uniform.name.value.clone(), Type::of_uniform(uniform.kind.value)));
    }
    for texture in &items.textures {
        uniforms.push((texture.name.value.clone(), Type::Texture(Shape::of(texture.dimension.value))));
    }
    uniforms.extend(items.images.iter().map(|name| (name.value.clone(), Type::Texture(Shape::Image))));
    let mut helpers = Vec::new();
    for raw in &items.functions {
        if let Role::Helper(name) = &raw.role {
            helpers.push(signature(name, raw, report));
        }
    }
    Environment { attributes, uniforms, helpers, constants: items.constants.clone(), incomplete: items.incomplete }
}

fn signature(name: &str, raw: &RawFunction, report: &mut Report) -> Signature {
    let parameters = raw
        .parameters
        .iter()
        .map(|parameter| parameter.ty.as_ref().map_or(Type::Error, |ty| check::written_type(ty, report)))
        .collect();
    let result = match &raw.output {
        Some(ty) => check::written_type(ty, report),
        None => {
            let message = format!("the function `{name}` has no return type");
            report.error(codes::MISSING_VALUE, &raw.name_span, message, "add one: `fn … -> f32 { … }`");
            Type::Error
        }
    };
    if matches!(result, Type::Uniforms | Type::Unit) {
        let message = format!("a function cannot return `{}`", result.rust());
        let help = "return a number, a vector, a `bool` or a `Fragment`";
        report.error(codes::TYPE_MISMATCH, &raw.name_span, message, help);
    }
    Signature { name: name.to_string(), span: raw.name_span.clone(), parameters, result }
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
