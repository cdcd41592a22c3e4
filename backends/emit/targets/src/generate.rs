//! One variant, several targets: plan, link, check and emit, each step once for all targets that share it.

use fragbuf_codegen::{Form, Linking, Plan, Profile, link, plan};
use fragbuf_model::{Diagnostic, Diagnostics, Refusal, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Loads};

use crate::target::{Emission, File, Guards, InterlockOrder, Target};
use crate::{Checked, check};

/// What to generate.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The targets.
    pub targets: &'a [&'static Target],
    /// Programs, or modules for a shader of the caller's own.
    pub form: Form,
    /// Before every name but the entry points'; empty for none.
    pub prefix: &'a str,
    /// The bind group of everything declared.
    pub group: u32,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Generation {
    /// The plans, each with the targets that follow it. One, unless an `else` was taken on some target.
    pub plans: Vec<Planned>,
    /// The files, in the order of the targets, the passes and the stages.
    pub files: Vec<File>,
    /// Targets that cannot express the variant, and why.
    pub refusals: Vec<(&'static Target, Refusal)>,
}

/// A plan and the targets that follow it.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The plan.
    pub plan: Plan,
    /// The targets.
    pub targets: Vec<&'static Target>,
}

/// Generates a variant. A target that cannot express it is a refusal, not an error.
pub fn generate(variant: &Variant, request: &Request<'_>, registry: &Registry) -> Result<Generation, Diagnostics> {
    let mut generation = Generation { plans: Vec::new(), files: Vec::new(), refusals: Vec::new() };
    let mut texts: Vec<Texts> = Vec::new();
    for &target in request.targets {
        let Some(planned) = plan_for(variant, target, request, registry, &mut generation)? else { continue };
        let plan = &generation.plans[planned].plan;
        let known = texts.iter().position(|texts| texts.planned == planned && texts.profile == target.profile);
        let index = match known {
            Some(index) => index,
            None => {
                texts.push(Texts {
                    planned,
                    profile: target.profile,
                    passes: checked(plan, target, request, registry)?,
                });
                texts.len() - 1
            }
        };
        let files = emit(target, plan, &texts[index].passes, request)?;
        generation.files.extend(files);
    }
    Ok(generation)
}

/// The index of the plan that `target` follows; `None` where it was refused.
fn plan_for(
    variant: &Variant,
    target: &'static Target,
    request: &Request<'_>,
    registry: &Registry,
    generation: &mut Generation,
) -> Result<Option<usize>, Diagnostics> {
    if request.form == Form::Module && !target.offers.contains(&Capability::Linkable) {
        let refusal = Refusal { axis: "form".to_owned(), value: "module".to_owned(), capability: Capability::Linkable };
        generation.refusals.push((target, refusal));
        return Ok(None);
    }
    let mut offers = target.offers.to_vec();
    offers.extend((request.form == Form::Program).then_some(Capability::OwnEntryPoints));
    let selection = match variant.select(&offers) {
        Ok(selection) => selection,
        Err(refusal) => {
            generation.refusals.push((target, refusal));
            return Ok(None);
        }
    };
    let known = generation.plans.iter().position(|planned| planned.plan.selection == selection);
    let index = match known {
        Some(index) => index,
        None => {
            let plan = plan(variant, &selection, registry)?;
            generation.plans.push(Planned { plan, targets: Vec::new() });
            generation.plans.len() - 1
        }
    };
    generation.plans[index].targets.push(target);
    Ok(Some(index))
}

/// The checked texts of one plan in one profile: all targets of that profile are made from them.
struct Texts {
    planned: usize,
    profile: Profile,
    passes: Vec<Checked>,
}

fn checked(
    plan: &Plan,
    target: &Target,
    request: &Request<'_>,
    registry: &Registry,
) -> Result<Vec<Checked>, Diagnostics> {
    let linking = Linking {
        profile: target.profile,
        form: request.form,
        prefix: request.prefix.to_owned(),
        group: request.group,
    };
    let mut diagnostics = Diagnostics::new();
    let mut checked = Vec::new();
    for pass in link(plan, &linking, registry)?.passes {
        match check(pass, linking.profile, &plan.variant.name.origin) {
            Ok(pass) => checked.push(pass),
            Err(faults) => diagnostics.extend(faults),
        }
    }
    diagnostics.gate(checked)
}

fn emit(
    target: &'static Target,
    plan: &Plan,
    passes: &[Checked],
    request: &Request<'_>,
) -> Result<Vec<File>, Diagnostics> {
    let prefix = if request.prefix.is_empty() { String::new() } else { format!("{}_", request.prefix) };
    let planned = &plan.passes;
    let mut diagnostics = Diagnostics::new();
    let mut files: Vec<File> = Vec::new();
    for (checked, pass) in passes.iter().zip(planned) {
        let rechecked = pass.uses.iter().filter(|usage| usage.loads == Loads::Rechecked);
        let emission = Emission {
            checked,
            target: target.name,
            prefix: &prefix,
            rechecked: rechecked.map(|usage| format!("{prefix}{}", usage.resource)).collect(),
            interlock: match plan.requires.contains(&Capability::OrderedInterlock) {
                true => InterlockOrder::Submission,
                false => InterlockOrder::Any,
            },
            guards: if plan.selection.own_files().next().is_some() { Guards::On } else { Guards::Off },
        };
        match (target.emit)(&emission) {
            Ok(more) => files.extend(more),
            Err(problem) => diagnostics.push(Diagnostic::new(
                codes::INTERNAL,
                &plan.variant.name.origin,
                format!("pass `{}` cannot be written as {}: {problem}", pass.anchor, target.name),
                "report it with the description; another target may do meanwhile",
            )),
        }
    }
    share(&mut files);
    diagnostics.gate(files)
}

/// Files of equal content are one file: the later ones take the first one's path.
fn share(files: &mut [File]) {
    for index in 1..files.len() {
        let (before, rest) = files.split_at_mut(index);
        if let Some(first) =
            before.iter().find(|file| file.bytes == rest[0].bytes && suffix(&file.path) == suffix(&rest[0].path))
        {
            rest[0].path.clone_from(&first.path);
        }
    }
}

fn suffix(path: &str) -> &str {
    path.find('.').map_or("", |dot| &path[dot..])
}
