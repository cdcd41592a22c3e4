//! The templates of a pass: its skeleton, and one source per instance that implements a contract.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Implementation, InstanceMemory, Pass, Row};

use crate::link::{Renames, Source, names};
use crate::plan::{axis_of, instance_row};
use crate::{CONTRACTS, Plan};

/// Returns the source of a skeleton.
pub(super) fn skeleton(key: &str, registry: &Registry) -> Result<Source, String> {
    let template = registry.row("pass", key).and_then(|row| row.template.as_ref());
    template
        .map(|template| Source::template(template, &Renames::default()))
        .ok_or_else(|| format!("the skeleton `{key}` has no source"))
}

/// Returns one source per instance, in the order of the axes. An instance that implements two contracts is linked once.
pub(super) fn sources(pass: &Pass, plan: &Plan, registry: &Registry) -> Result<Vec<Source>, String> {
    let mut sources = Vec::new();
    for implementation in ordered(pass, registry) {
        let row = instance_row(implementation, &plan.selection, registry)?;
        if let Some(template) = &row.template {
            let renames = renames(implementation, axis_of(&implementation.contract, registry), row, &template.source);
            sources.push(Source::template(template, &renames));
        }
    }
    Ok(sources)
}

/// Returns the printed headers of templates that implement papers, without comment signs.
pub(super) fn algorithms(
    pass: &Pass,
    plan: &Plan,
    registry: &Registry,
    headers: &BTreeMap<Arc<str>, String>,
) -> Result<String, String> {
    let mut algorithms: Vec<String> = Vec::new();
    for implementation in ordered(pass, registry) {
        let row = instance_row(implementation, &plan.selection, registry)?;
        let template = row.template.as_ref().filter(|_| !row.paper.is_empty());
        if let Some((template, header)) = template.and_then(|one| Some((one, headers.get(&*one.path)?))) {
            let lines: Vec<&str> = header.lines().map(|line| line.trim_start_matches("//").trim()).collect();
            let text = format!("{}:\n{}\n", template.path, lines.join("\n").trim_end());
            if !algorithms.contains(&text) {
                algorithms.push(text);
            }
        }
    }
    Ok(algorithms.join("\n"))
}

/// Returns the implementations of a pass in the order of the axes, one per instance.
fn ordered<'a>(pass: &'a Pass, registry: &Registry) -> Vec<&'a Implementation> {
    let mut ordered: BTreeMap<(usize, &str), &Implementation> = BTreeMap::new();
    for implementation in &pass.implementations {
        let axis = axis_of(&implementation.contract, registry);
        let order = registry.axes().iter().position(|other| other.key == axis).unwrap_or(usize::MAX);
        ordered.insert((order, &implementation.instance.name), implementation);
    }
    ordered.into_values().collect()
}

/// Returns the renames of an instance. An instance that has the name of its axis keeps the names of the template. Otherwise the name of
/// the instance replaces the axis in contract functions, and precedes private names and the accessors of its own resources.
fn renames(implementation: &Implementation, axis: &str, row: &Row, text: &str) -> Renames {
    let name = &implementation.instance.name;
    let mut renames = Renames::default();
    if name == axis {
        return renames;
    }
    for declared in names(text) {
        let is_contract = CONTRACTS.iter().any(|contract| contract.name == declared);
        let rest = declared.strip_prefix(axis).and_then(|rest| rest.strip_prefix('_')).filter(|_| is_contract);
        renames.insert(declared.clone(), format!("{name}_{}", rest.unwrap_or(&declared)));
    }
    let resources = row.resources.iter().filter(|_| implementation.instance.memory == InstanceMemory::Own);
    for resource in resources {
        for accessor in ACCESSORS {
            let old = format!("{}_{accessor}", resource.name);
            renames.insert(old.clone(), format!("{name}_{old}"));
        }
    }
    renames
}

/// The names of the generated accessors of a resource `x`, after `x_`.
const ACCESSORS: [&str; 10] = [
    "load",
    "store",
    "atomic_add",
    "atomic_sub",
    "atomic_min",
    "atomic_max",
    "atomic_or",
    "atomic_and",
    "atomic_exchange",
    "atomic_compare_exchange",
];
