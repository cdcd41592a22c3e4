//! Finds the implementation of each contract that a pass calls, and the resources that the implementations use.
//!
//! The row of a skeleton lists the contracts that it calls; the rows that implement them list further contracts. The implementation
//! of a contract is the instance that the pass names, or else the row that the variant selects on the axis of that name.

use fragbuf_model::Selection;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Implementation, Instance, InstanceMemory, Pass, Resource, Row, Step, Use};

use super::edit::for_each_pass;

/// Completes implementations and uses of every pass, and adds the resources of instances.
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
    add_implementations(pass, selection, registry)?;
    add_uses(pass, resources, selection, registry)?;
    for usage in &pass.uses {
        if !resources.iter().any(|resource| resource.name == usage.resource) {
            return Err(format!("pass `{}` uses `{}`, which no row declares", pass.name, usage.resource));
        }
    }
    Ok(())
}

/// Adds an implementation of every contract that the pass calls, directly or through other implementations.
fn add_implementations(pass: &mut Pass, selection: &Selection, registry: &Registry) -> Result<(), String> {
    let skeleton = registry.row("pass", &pass.skeleton);
    let mut contracts: Vec<String> =
        skeleton.map(|row| row.calls.iter().map(|call| (*call).to_owned()).collect()).unwrap_or_default();
    contracts.extend(pass.implementations.iter().map(|implementation| implementation.contract.clone()));
    let mut next = 0;
    while let Some(contract) = contracts.get(next).cloned() {
        next += 1;
        let row = match pass.implementations.iter().find(|implementation| implementation.contract == contract) {
            Some(implementation) => instance_row(implementation, selection, registry)?,
            None => {
                let Some(selected) = selection.row(&contract) else {
                    return Err(format!("pass `{}` calls `{contract}`, which no row implements", pass.name));
                };
                let instance =
                    Instance { row: selected.row.key.clone(), name: contract.clone(), memory: InstanceMemory::Own };
                pass.implementations.push(Implementation { contract, instance });
                &selected.row
            }
        };
        for call in &row.calls {
            if !contracts.iter().any(|known| known == call) {
                contracts.push((*call).to_owned());
            }
        }
    }
    Ok(())
}

/// Adds the resources that the implementations use, and those that instances declare.
fn add_uses(
    pass: &mut Pass,
    resources: &mut Vec<Resource>,
    selection: &Selection,
    registry: &Registry,
) -> Result<(), String> {
    for implementation in pass.implementations.clone() {
        let row = instance_row(&implementation, selection, registry)?;
        if implementation.instance.memory == InstanceMemory::Delegated {
            continue;
        }
        let is_default_name = implementation.instance.name == axis_of(&implementation.contract, registry);
        let prefix = if is_default_name { String::new() } else { format!("{}_", implementation.instance.name) };
        let pass_uses = if is_default_name { &[][..] } else { uses_of_pass(row, &pass.name) };
        for usage in row.uses.iter().chain(pass_uses) {
            let usage = Use { resource: format!("{prefix}{}", usage.resource), ..usage.clone() };
            if !pass.uses.iter().any(|old| old.resource == usage.resource) {
                pass.uses.push(usage);
            }
        }
        if !is_default_name {
            for resource in &row.resources {
                let name = format!("{prefix}{}", resource.name);
                if !resources.iter().any(|old| old.name == name) {
                    resources.push(Resource { name, ..resource.clone() });
                }
            }
        }
    }
    Ok(())
}

/// Returns the resources that the row's pass of this name uses.
fn uses_of_pass<'a>(row: &'a Row, name: &str) -> &'a [Use] {
    row.steps
        .iter()
        .find_map(|step| match step {
            Step::Pass(pass) if pass.name == name => Some(pass.uses.as_slice()),
            _ => None,
        })
        .unwrap_or(&[])
}

/// Returns the row of an implementation. A contract is an axis, or a name that the pass gives to an instance of a storage.
pub(crate) fn instance_row<'a>(
    implementation: &Implementation,
    selection: &'a Selection,
    registry: &'a Registry,
) -> Result<&'a Row, String> {
    let axis = axis_of(&implementation.contract, registry);
    let selected =
        selection.row(axis).map(|selected| &*selected.row).filter(|row| row.key == implementation.instance.row);
    selected.or_else(|| registry.row(axis, &implementation.instance.row)).ok_or_else(|| {
        format!(
            "`{}` names the row `{}: {}`, which does not exist",
            implementation.contract, axis, implementation.instance.row
        )
    })
}

/// Returns the axis of the rows that implement a contract.
pub(crate) fn axis_of<'a>(contract: &'a str, registry: &Registry) -> &'a str {
    if registry.axis(contract).is_some() { contract } else { "storage" }
}
