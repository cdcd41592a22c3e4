//! What rows of other axes change in a storage's steps.

use fragbuf_templates::vocabulary::{Access, Classes, DepthState, Edit, Kind, Pass, Repeat, Resource, Step, Use};

/// Applies one edit. `Err`: it names an anchor that the steps do not have, or a constant that there is not.
pub(super) fn apply(
    edit: &Edit,
    steps: &mut Vec<Step>,
    resources: &mut Vec<Resource>,
    constants: &[(String, u32)],
) -> Result<(), String> {
    match edit {
        Edit::Before(anchor, new) => insert(steps, anchor, new, 0),
        Edit::After(anchor, new) => insert(steps, anchor, new, 1),
        Edit::Around(from, to, repeat) => around(steps, from, to, repeat),
        Edit::SetState(anchor, state) => change(steps, anchor, &|pass| pass.state = state.clone()),
        Edit::TestDepth(test) => test_depth(steps, test),
        Edit::SetSkeleton(anchor, skeleton) => change(steps, anchor, &|pass| pass.skeleton.clone_from(skeleton)),
        Edit::FormOfSkeleton(anchor, form) => {
            change(steps, anchor, &|pass| pass.skeleton = format!("{}_{form}", pass.skeleton))
        }
        Edit::SetRole(anchor, role) => change(steps, anchor, &|pass| {
            pass.roles.retain(|old| old.contract != role.contract);
            pass.roles.push(role.clone());
        }),
        Edit::AddUse(anchor, usage) => change(steps, anchor, &|pass| pass.uses.push(usage.clone())),
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
        Edit::Classes(classes) => {
            let constant = constants.iter().find(|(name, _)| *name == classes.constant);
            let (_, most) = constant.ok_or_else(|| format!("an edit names the constant `{}`", classes.constant))?;
            split(steps, classes, *most)
        }
    }
}

/// One pass for each class, in place of the one.
fn split(steps: &mut Vec<Step>, classes: &Classes, most: u32) -> Result<(), String> {
    let Some(index) = position(steps, &classes.anchor) else {
        return in_some_loop(steps, &classes.anchor, &mut |body| split(body, classes, most));
    };
    let Step::Pass(pass) = steps.remove(index) else { return Err(unknown(&classes.anchor)) };
    let smaller = std::iter::successors(Some(classes.least), |size| size.checked_mul(2));
    let sizes: Vec<u32> = smaller.take_while(|size| *size < most).chain([most]).collect();
    for (number, size) in sizes.iter().enumerate() {
        let is_last = number + 1 == sizes.len();
        let mut one = Pass { anchor: format!("{}_{size}", pass.anchor), ..pass.clone() };
        one.constants.push((classes.constant.clone(), *size));
        one.constants.push(("CLASS_ABOVE".to_owned(), number.checked_sub(1).map_or(0, |before| sizes[before])));
        one.constants.push(("CLASS_MOST".to_owned(), if is_last { u32::MAX } else { *size }));
        if !is_last {
            one.roles.retain(|role| classes.before_last.iter().all(|other| other.contract != role.contract));
            one.roles.extend(classes.before_last.iter().cloned());
        }
        steps.insert(index + number, Step::Pass(one));
    }
    Ok(())
}

fn insert(steps: &mut Vec<Step>, anchor: &str, new: &[Step], offset: usize) -> Result<(), String> {
    if let Some(index) = position(steps, anchor) {
        steps.splice(index + offset..index + offset, new.iter().cloned());
        return Ok(());
    }
    in_some_loop(steps, anchor, &mut |body| insert(body, anchor, new, offset))
}

fn around(steps: &mut Vec<Step>, from: &str, to: &str, repeat: &Repeat) -> Result<(), String> {
    if let (Some(first), Some(last)) = (position(steps, from), position(steps, to))
        && first <= last
    {
        let body = steps.drain(first..=last).collect();
        steps.insert(first, Step::Repeat(Repeat { body, ..repeat.clone() }));
        return Ok(());
    }
    in_some_loop(steps, from, &mut |body| around(body, from, to, repeat))
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
