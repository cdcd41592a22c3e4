//! Applies the edits of rows to the steps of a plan.

use fragbuf_model::Variant;
use fragbuf_templates::vocabulary::{
    Access, DepthState, Edit, Formula, Kind, Objects, Pass, Repeat, Resource, Split, Step, Use,
};

use super::described;

/// Applies one edit. Fails if it names a pass that the steps do not have, or if a formula has no value.
pub(super) fn apply(
    edit: &Edit,
    steps: &mut Vec<Step>,
    resources: &mut Vec<Resource>,
    constants: &[(String, u32)],
    variant: &Variant,
) -> Result<(), String> {
    match edit {
        Edit::First(new) => {
            steps.splice(0..0, new.iter().cloned());
            Ok(())
        }
        Edit::Before(name, new) => insert(steps, name, new, 0),
        Edit::After(name, new) => insert(steps, name, new, 1),
        Edit::SetState(name, state) => change(steps, name, &|pass| pass.state = state.clone()),
        Edit::SetDepth(name, depth) => change(steps, name, &|pass| pass.state.depth = Some(depth.clone())),
        Edit::TestDepth(test) => test_depth(steps, test),
        Edit::SetSkeleton(name, skeleton) => change(steps, name, &|pass| pass.skeleton.clone_from(skeleton)),
        Edit::FormOfSkeleton(name, form) => {
            change(steps, name, &|pass| pass.skeleton = format!("{}_{form}", pass.skeleton))
        }
        Edit::AddResource(resource) => {
            resources.push(resource.clone());
            Ok(())
        }
        Edit::AddUse(name, usage) => change(steps, name, &|pass| pass.uses.push(usage.clone())),
        Edit::DrawVisible(query) => draw_visible(steps, query),
        Edit::Images(name) => {
            let effect = steps.iter().find_map(|step| match step {
                Step::Pass(pass) if pass.name == *name => Some(pass.clone()),
                _ => None,
            });
            let effect = effect.ok_or_else(|| unknown(name))?;
            insert(steps, name, &described::images(variant, &effect), 0)
        }
        Edit::Repeat(last, repeat) => repeat_to(steps, last, repeat),
        Edit::Samples(samples) => {
            for_each_pass(steps, &mut |pass| {
                if pass.kind == Kind::Geometry {
                    pass.state.samples = Some(samples.clone());
                }
            });
            Ok(())
        }
        Edit::Split(one) => split(steps, one, constants),
    }
}

/// Restricts the passes over the scene around a query to the objects that are visible in it.
fn draw_visible(steps: &mut [Step], query: &str) -> Result<(), String> {
    if position(steps, query).is_none() {
        return in_any_loop(steps, query, &mut |body| draw_visible(body, query));
    }
    for_each_pass(steps, &mut |pass| {
        if pass.kind == Kind::Geometry && pass.objects == Objects::All {
            pass.objects = Objects::Visible(query.to_owned());
        }
    });
    Ok(())
}

/// Moves all steps up to a pass into a loop.
fn repeat_to(steps: &mut Vec<Step>, last: &str, repeat: &Repeat) -> Result<(), String> {
    let end = position(steps, last).ok_or_else(|| unknown(last))?;
    let mut repeat = repeat.clone();
    repeat.body.splice(0..0, steps.drain(..=end));
    steps.insert(0, Step::Repeat(repeat));
    Ok(())
}

/// Replaces a pass by several copies.
fn split(steps: &mut Vec<Step>, split_pass: &Split, constants: &[(String, u32)]) -> Result<(), String> {
    let name = &split_pass.name;
    let Some(index) = position(steps, name) else {
        return in_any_loop(steps, name, &mut |body| split(body, split_pass, constants));
    };
    let Step::Pass(pass) = steps.remove(index) else { return Err(unknown(name)) };
    let constant = |symbol: &str| constants.iter().find(|(name, _)| name == symbol).map(|(_, value)| u64::from(*value));
    let copies = value(&split_pass.copies, &constant)?;
    for copy in 0..copies {
        let symbol = |symbol: &str| match symbol {
            "copy" => Some(u64::from(copy)),
            "copies" => Some(u64::from(copies)),
            _ => constant(symbol),
        };
        let mut one = pass.clone();
        for (number, (name, formula)) in split_pass.constants.iter().enumerate() {
            let constant = value(formula, &symbol)?;
            if number == 0 {
                one.name = format!("{}_{constant}", pass.name);
            }
            one.constants.push((name.clone(), constant));
        }
        if copy + 1 < copies {
            one.implementations.retain(|implementation| {
                split_pass.before_last.iter().all(|other| other.contract != implementation.contract)
            });
            one.implementations.extend(split_pass.before_last.iter().cloned());
        }
        steps.insert(index + copy as usize, Step::Pass(one));
    }
    Ok(())
}

/// Returns the value of a formula of an edit. A generated constant has 32 bits.
fn value(formula: &Formula, symbol: &dyn Fn(&str) -> Option<u64>) -> Result<u32, String> {
    let value = formula.evaluate(symbol).map_err(|error| format!("a formula of an edit has no value: {error}"))?;
    u32::try_from(value).map_err(|_| format!("the formula `{formula}` of an edit exceeds 32 bits"))
}

fn insert(steps: &mut Vec<Step>, name: &str, new: &[Step], offset: usize) -> Result<(), String> {
    if let Some(index) = position(steps, name) {
        steps.splice(index + offset..index + offset, new.iter().cloned());
        return Ok(());
    }
    in_any_loop(steps, name, &mut |body| insert(body, name, new, offset))
}

fn change(steps: &mut [Step], name: &str, edit: &dyn Fn(&mut Pass)) -> Result<(), String> {
    let mut found = false;
    for_each_pass(steps, &mut |pass| {
        if pass.name == name {
            edit(pass);
            found = true;
        }
    });
    if found { Ok(()) } else { Err(unknown(name)) }
}

/// Adds a depth test to every geometry pass. Fails if a geometry pass has a depth or stencil test.
fn test_depth(steps: &mut [Step], test: &DepthState) -> Result<(), String> {
    let mut taken = None;
    for_each_pass(steps, &mut |pass| match &pass.state {
        _ if pass.kind != Kind::Geometry => {}
        state if state.depth.is_some() || state.stencil.is_some() => taken = Some(pass.name.clone()),
        _ => {
            pass.state.depth = Some(test.clone());
            pass.uses.push(Use::new(&test.resource, Access::Attachment));
        }
    });
    match taken {
        Some(name) => {
            Err(format!("an edit adds a depth test to the pass `{name}`, which already has a depth or stencil test"))
        }
        None => Ok(()),
    }
}

fn in_any_loop(
    steps: &mut [Step],
    name: &str,
    edit: &mut dyn FnMut(&mut Vec<Step>) -> Result<(), String>,
) -> Result<(), String> {
    for step in steps {
        if let Step::Repeat(repeat) = step
            && edit(&mut repeat.body).is_ok()
        {
            return Ok(());
        }
    }
    Err(unknown(name))
}

fn position(steps: &[Step], name: &str) -> Option<usize> {
    steps.iter().position(|step| matches!(step, Step::Pass(pass) if pass.name == name))
}

fn unknown(name: &str) -> String {
    format!("an edit names the pass `{name}`, which the plan does not have")
}

/// Chooses the access of every use that depends on mutual exclusion.
pub(super) fn choose_accesses(steps: &mut [Step], is_exclusive: bool) {
    for_each_pass(steps, &mut |pass| {
        for usage in &mut pass.uses {
            let exclusive = usage.exclusive.take();
            usage.access = exclusive.filter(|_| is_exclusive).unwrap_or(usage.access);
        }
    });
}

/// Visits every pass, including passes inside loops.
pub(super) fn for_each_pass(steps: &mut [Step], visit: &mut dyn FnMut(&mut Pass)) {
    for step in steps {
        match step {
            Step::Pass(pass) => visit(pass),
            Step::Repeat(repeat) => for_each_pass(&mut repeat.body, visit),
            _ => {}
        }
    }
}
