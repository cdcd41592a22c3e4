//! What rows of other axes change in a storage's steps.

use fragbuf_templates::vocabulary::{Access, DepthState, Edit, Formula, Kind, Pass, Resource, Split, Step, Use};

/// Applies one edit. `Err`: it names an anchor that the steps do not have, or a formula has no value.
pub(super) fn apply(
    edit: &Edit,
    steps: &mut Vec<Step>,
    resources: &mut Vec<Resource>,
    constants: &[(String, u32)],
) -> Result<(), String> {
    match edit {
        Edit::Before(anchor, new) => insert(steps, anchor, new, 0),
        Edit::After(anchor, new) => insert(steps, anchor, new, 1),
        Edit::SetState(anchor, state) => change(steps, anchor, &|pass| pass.state = state.clone()),
        Edit::TestDepth(test) => test_depth(steps, test),
        Edit::SetSkeleton(anchor, skeleton) => change(steps, anchor, &|pass| pass.skeleton.clone_from(skeleton)),
        Edit::FormOfSkeleton(anchor, form) => {
            change(steps, anchor, &|pass| pass.skeleton = format!("{}_{form}", pass.skeleton))
        }
        Edit::AddResource(resource) => {
            resources.push(resource.clone());
            Ok(())
        }
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

/// Several passes in place of the one.
fn split(steps: &mut Vec<Step>, split_pass: &Split, constants: &[(String, u32)]) -> Result<(), String> {
    let anchor = &split_pass.anchor;
    let Some(index) = position(steps, anchor) else {
        return in_some_loop(steps, anchor, &mut |body| split(body, split_pass, constants));
    };
    let Step::Pass(pass) = steps.remove(index) else { return Err(unknown(anchor)) };
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
                one.anchor = format!("{}_{constant}", pass.anchor);
            }
            one.constants.push((name.clone(), constant));
        }
        if copy + 1 < copies {
            one.roles.retain(|role| split_pass.before_last.iter().all(|other| other.contract != role.contract));
            one.roles.extend(split_pass.before_last.iter().cloned());
        }
        steps.insert(index + copy as usize, Step::Pass(one));
    }
    Ok(())
}

/// The value of an edit's formula: a generated constant has 32 bits.
fn value(formula: &Formula, symbol: &dyn Fn(&str) -> Option<u64>) -> Result<u32, String> {
    let value = formula.evaluate(symbol).map_err(|error| format!("an edit's formula has no value: {error}"))?;
    u32::try_from(value).map_err(|_| format!("an edit's formula `{formula}` exceeds 32 bits"))
}

fn insert(steps: &mut Vec<Step>, anchor: &str, new: &[Step], offset: usize) -> Result<(), String> {
    if let Some(index) = position(steps, anchor) {
        steps.splice(index + offset..index + offset, new.iter().cloned());
        return Ok(());
    }
    in_some_loop(steps, anchor, &mut |body| insert(body, anchor, new, offset))
}

fn change(steps: &mut [Step], anchor: &str, how: &dyn Fn(&mut Pass)) -> Result<(), String> {
    let mut found = false;
    for_each_pass(steps, &mut |pass| {
        if pass.anchor == anchor {
            how(pass);
            found = true;
        }
    });
    if found { Ok(()) } else { Err(unknown(anchor)) }
}

/// The depth test of every geometry pass, of which none may have one.
fn test_depth(steps: &mut [Step], test: &DepthState) -> Result<(), String> {
    let mut taken = None;
    for_each_pass(steps, &mut |pass| match &pass.state {
        _ if pass.kind != Kind::Geometry => {}
        state if state.depth.is_some() || state.stencil.is_some() => taken = Some(pass.anchor.clone()),
        _ => {
            pass.state.depth = Some(test.clone());
            pass.uses.push(Use::new(&test.resource, Access::Attachment));
        }
    });
    match taken {
        Some(anchor) => Err(format!("an edit tests depth in the pass `{anchor}`, which has a test of its own")),
        None => Ok(()),
    }
}

fn in_some_loop(
    steps: &mut [Step],
    anchor: &str,
    edit: &mut dyn FnMut(&mut Vec<Step>) -> Result<(), String>,
) -> Result<(), String> {
    for step in steps {
        if let Step::Repeat(repeat) = step
            && edit(&mut repeat.body).is_ok()
        {
            return Ok(());
        }
    }
    Err(unknown(anchor))
}

fn position(steps: &[Step], anchor: &str) -> Option<usize> {
    steps.iter().position(|step| matches!(step, Step::Pass(pass) if pass.anchor == anchor))
}

fn unknown(anchor: &str) -> String {
    format!("an edit names the pass `{anchor}`, which the plan does not have")
}

/// Every pass, those inside loops included.
pub(super) fn for_each_pass(steps: &mut [Step], visit: &mut dyn FnMut(&mut Pass)) {
    for step in steps {
        match step {
            Step::Pass(pass) => visit(pass),
            Step::Repeat(repeat) => for_each_pass(&mut repeat.body, visit),
            _ => {}
        }
    }
}
