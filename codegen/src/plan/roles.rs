//! Who fulfils each contract that a pass calls, and what they touch.
//!
//! A skeleton's row says which contracts it calls, the rows that fulfil them say which they call in turn. A contract goes
//! to the instance that the pass names for it, else to the variant's own choice on the axis of that name.

use fragbuf_model::Selection;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Instance, Memory, Pass, Resource, Role, Row, Step, Use};

use super::edit::for_each_pass;

/// Completes roles and uses of every pass, and adds the resources of instances.
pub(super) fn complete(
    steps: &mut [Step],
    resources: &mut Vec<Resource>,
    selection: &Selection,
    registry: &Registry,
) -> Result<(), String> {
    let mut problem = None;
    for_each_pass(steps, &mut |pass| {
        if let Err(error) = complete_pass(pass, resources, selection, registry) {
            problem.get_or_insert(error);
        }
    });
    problem.map_or(Ok(()), Err)
}

fn complete_pass(
    pass: &mut Pass,
    resources: &mut Vec<Resource>,
    selection: &Selection,
    registry: &Registry,
) -> Result<(), String> {
    let skeleton = registry.row("pass", &pass.skeleton);
    let mut wanted: Vec<String> =
        skeleton.map(|row| row.calls.iter().map(|call| (*call).to_owned()).collect()).unwrap_or_default();
    wanted.extend(pass.roles.iter().map(|role| role.contract.clone()));
    let mut next = 0;
    while let Some(contract) = wanted.get(next).cloned() {
        next += 1;
        let row = match pass.roles.iter().find(|role| role.contract == contract) {
            Some(role) => instance_row(role, selection, registry)?,
            None => {
                let Some(selected) = selection.row(&contract) else {
                    return Err(format!("pass `{}` calls `{contract}`, and nothing fulfils it", pass.anchor));
                };
                let instance = Instance { row: selected.row.key.clone(), name: contract.clone(), memory: Memory::Own };
                pass.roles.push(Role { contract, instance });
                &selected.row
            }
        };
        for call in &row.calls {
            if !wanted.iter().any(|known| known == call) {
                wanted.push((*call).to_owned());
            }
        }
    }
    for role in pass.roles.clone() {
        let row = instance_row(&role, selection, registry)?;
        if role.instance.memory == Memory::Borrowed {
            continue;
        }
        let own_name = role.instance.name == axis_of(&role.contract, registry);
        let prefix = if own_name { String::new() } else { format!("{}_", role.instance.name) };
        let steps_uses = if own_name { &[][..] } else { uses_at(row, &pass.anchor) };
        for usage in row.uses.iter().chain(steps_uses) {
            let usage = Use { resource: format!("{prefix}{}", usage.resource), ..usage.clone() };
            if !pass.uses.iter().any(|old| old.resource == usage.resource) {
                pass.uses.push(usage);
            }
        }
        if !own_name {
            for resource in &row.resources {
                let name = format!("{prefix}{}", resource.name);
                if !resources.iter().any(|old| old.name == name) {
                    resources.push(Resource { name, ..resource.clone() });
                }
            }
        }
    }
    for usage in &pass.uses {
        if !resources.iter().any(|resource| resource.name == usage.resource) {
            return Err(format!("pass `{}` touches `{}`, which no row declares", pass.anchor, usage.resource));
        }
    }
    Ok(())
}

/// How a row's own pass of the same anchor touches its resources.
fn uses_at<'a>(row: &'a Row, anchor: &str) -> &'a [Use] {
    row.steps
        .iter()
        .find_map(|step| match step {
            Step::Pass(pass) if pass.anchor == anchor => Some(pass.uses.as_slice()),
            _ => None,
        })
        .unwrap_or(&[])
}

/// The row of a role. A contract is an axis, or a name of the pass's own for an instance of a storage.
pub(crate) fn instance_row<'a>(
    role: &Role,
    selection: &'a Selection,
    registry: &'a Registry,
) -> Result<&'a Row, String> {
    let axis = axis_of(&role.contract, registry);
    let selected = selection.row(axis).map(|selected| &*selected.row).filter(|row| row.key == role.instance.row);
    selected.or_else(|| registry.row(axis, &role.instance.row)).ok_or_else(|| {
        format!("`{}` names the row `{}: {}`, which does not exist", role.contract, axis, role.instance.row)
    })
}

/// The axis that a contract's rows are on.
pub(crate) fn axis_of<'a>(contract: &'a str, registry: &Registry) -> &'a str {
    if registry.axis(contract).is_some() { contract } else { "storage" }
}
