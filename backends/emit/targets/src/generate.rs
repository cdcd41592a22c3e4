//! Generates the files of a variant for several targets. Targets that share a plan or a linked program share that work.

use fragbuf_codegen::{Form, Linking, Plan, Profile, link, plan};
use fragbuf_model::{Diagnostic, Diagnostics, MissingFeature, Selection, Variant, codes};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Feature, Loads, Use};

use crate::emission::{Emission, File, Guards, InterlockOrder};
use crate::target::Target;
use crate::{Binding, Checked, OpenGlBindings, Workgroup, check};

/// The number of bind groups that every device has. WebGPU's limit `maxBindGroups` is 4 unless a program asks for more.
const COMMON_BIND_GROUPS: u32 = 4;

/// The parameters of a generation.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The targets.
    pub targets: &'a [&'static Target],
    /// Programs, or modules for the caller's shader.
    pub form: Form,
    /// Prefix of every name except entry points; empty for none.
    pub prefix: &'a str,
    /// The bind group of all declared resources.
    pub group: u32,
}

/// The result of [`generate`].
#[derive(Clone, Debug)]
pub struct Generation {
    /// Whether the files are programs or modules.
    pub form: Form,
    /// The prefix of every name except entry points.
    pub prefix: String,
    /// The plans, each with the targets that use it. There is one, unless an `else` was taken on some target.
    pub plans: Vec<PlanForTargets>,
    /// The files, in the order of the targets, the passes and the stages.
    pub files: Vec<File>,
    /// Targets that cannot express the variant, with the feature that they lack.
    pub unsupported: Vec<(&'static Target, MissingFeature)>,
}

/// A plan and the targets that use it.
#[derive(Clone, Debug)]
pub struct PlanForTargets {
    /// The plan.
    pub plan: Plan,
    /// The targets.
    pub targets: Vec<&'static Target>,
    /// The workgroups of its compute passes.
    pub workgroups: Vec<Workgroup>,
    /// What the text of each pass declares, for each of the targets: one list per pass of the plan.
    pub bindings: Vec<(&'static Target, Vec<Vec<Binding>>)>,
}

/// Generates a variant. A target that cannot express it is listed in [`Generation::unsupported`] and is not an error.
pub fn generate(variant: &Variant, request: &Request<'_>, registry: &Registry) -> Result<Generation, Diagnostics> {
    let mut generation = Generation {
        form: request.form,
        prefix: request.prefix.to_owned(),
        plans: Vec::new(),
        files: Vec::new(),
        unsupported: Vec::new(),
    };
    let mut programs: Vec<CheckedProgram> = Vec::new();
    for &target in request.targets {
        let Some(planned) = plan_for(variant, target, request, registry, &mut generation)? else { continue };
        let plan = &generation.plans[planned].plan;
        let known = programs.iter().position(|program| program.planned == planned && program.profile == target.profile);
        let index = match known {
            Some(index) => index,
            None => {
                let passes = checked(plan, target, request, registry)?;
                // The profiles of a plan have equal workgroups.
                generation.plans[planned].workgroups = passes.iter().filter_map(Checked::workgroup).collect();
                programs.push(CheckedProgram { planned, profile: target.profile, passes });
                programs.len() - 1
            }
        };
        let passes = &programs[index].passes;
        let bindings = declared(&generation.plans[planned].plan, passes)?;
        generation.plans[planned].bindings.push((target, bindings));
        let files = emit(target, &generation.plans[planned].plan, passes, request)?;
        generation.files.extend(files);
    }
    Ok(generation)
}

/// Returns the rows of a variant that `target` uses for a request, whose own targets do not matter here. `Err`: what the target lacks.
pub fn select(variant: &Variant, target: &Target, request: &Request<'_>) -> Result<Selection, MissingFeature> {
    let missing = |axis: &str, value: String, feature| MissingFeature { axis: axis.to_owned(), value, feature };
    if request.form == Form::Module && !target.provides.contains(&Feature::Linkable) {
        return Err(missing("form", "module".to_owned(), Feature::Linkable));
    }
    if request.group >= COMMON_BIND_GROUPS && !target.provides.contains(&Feature::BindGroups) {
        return Err(missing("group", request.group.to_string(), Feature::BindGroups));
    }
    let mut provides = target.provides.to_vec();
    provides.extend((request.form == Form::Program).then_some(Feature::OwnEntryPoints));
    variant.select(&provides)
}

/// Returns the index of the plan that `target` uses; `None` if the target does not support the variant.
fn plan_for(
    variant: &Variant,
    target: &'static Target,
    request: &Request<'_>,
    registry: &Registry,
    generation: &mut Generation,
) -> Result<Option<usize>, Diagnostics> {
    let selection = match select(variant, target, request) {
        Ok(selection) => selection,
        Err(missing) => {
            generation.unsupported.push((target, missing));
            return Ok(None);
        }
    };
    let known = generation.plans.iter().position(|planned| planned.plan.selection == selection);
    let index = match known {
        Some(index) => index,
        None => {
            let plan = plan(variant, &selection, registry)?;
            generation.plans.push(PlanForTargets {
                plan,
                targets: Vec::new(),
                workgroups: Vec::new(),
                bindings: Vec::new(),
            });
            generation.plans.len() - 1
        }
    };
    generation.plans[index].targets.push(target);
    Ok(Some(index))
}

/// The checked passes of one plan in one profile. All targets of that profile are emitted from them.
struct CheckedProgram {
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
        match check(pass, linking.profile, &plan.variant.name.span) {
            Ok(pass) => checked.push(pass),
            Err(more) => diagnostics.extend(more),
        }
    }
    diagnostics.into_result(checked)
}

/// Returns what the text of each pass declares.
fn declared(plan: &Plan, passes: &[Checked]) -> Result<Vec<Vec<Binding>>, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let mut all = Vec::with_capacity(passes.len());
    for checked in passes {
        match checked.bindings() {
            Ok(bindings) => all.push(bindings),
            Err(problem) => diagnostics.push(Diagnostic::new(
                codes::INTERNAL,
                &plan.variant.name.span,
                format!("the bindings of pass `{}`: {problem}", checked.pass().name),
                "report this defect with the description",
            )),
        }
    }
    diagnostics.into_result(all)
}

fn emit(
    target: &'static Target,
    plan: &Plan,
    passes: &[Checked],
    request: &Request<'_>,
) -> Result<Vec<File>, Diagnostics> {
    let prefix = if request.prefix.is_empty() { String::new() } else { format!("{}_", request.prefix) };
    let planned = &plan.passes;
    let opengl = OpenGlBindings::of(plan);
    let mut diagnostics = Diagnostics::new();
    let mut files: Vec<File> = Vec::new();
    for (checked, pass) in passes.iter().zip(planned) {
        let is_rechecked = |usage: &&Use| usage.loads == Loads::Rechecked || usage.access == Access::Hinted;
        let rechecked = pass.uses.iter().filter(is_rechecked);
        let emission = Emission {
            checked,
            target: target.name,
            prefix: &prefix,
            rechecked: rechecked.map(|usage| format!("{prefix}{}", usage.resource)).collect(),
            opengl: &opengl,
            interlock: match plan.requires.contains(&Feature::OrderedInterlock) {
                true => InterlockOrder::Submission,
                false => InterlockOrder::Any,
            },
            guards: if plan.selection.user_files().next().is_some() { Guards::On } else { Guards::Off },
        };
        match (target.emit)(&emission) {
            Ok(more) => files.extend(more),
            Err(problem) => diagnostics.push(Diagnostic::new(
                codes::INTERNAL,
                &plan.variant.name.span,
                format!("pass `{}` cannot be written as {}: {problem}", pass.name, target.name),
                "report this defect with the description; another target may work meanwhile",
            )),
        }
    }
    share(&mut files);
    diagnostics.into_result(files)
}

/// Gives files of equal content the path of the first one.
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
