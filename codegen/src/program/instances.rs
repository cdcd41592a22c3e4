//! The templates of a pass: its skeleton, and one source per instance that fulfils a contract of it.

use std::collections::BTreeMap;
use std::sync::Arc;

use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Memory, Pass, Role, Row};

use crate::link::{Renames, Source, names};
use crate::plan::{axis_of, instance_row};
use crate::{CONTRACTS, Plan};

/// The skeleton's text.
pub(super) fn skeleton(key: &str, registry: &Registry) -> Result<Source, String> {
    let template = registry.row("pass", key).and_then(|row| row.template.as_ref());
    template
        .map(|template| Source::template(template, &Renames::default()))
        .ok_or_else(|| format!("no text for the skeleton `{key}`"))
}

/// One source per role, in the order of the axes. An instance of two roles is linked once.
pub(super) fn sources(pass: &Pass, plan: &Plan, registry: &Registry) -> Result<Vec<Source>, String> {
    let mut sources = Vec::new();
    for role in ordered(pass, registry) {
        let row = instance_row(role, &plan.selection, registry)?;
        if let Some(template) = &row.template {
            let renames = renames(role, axis_of(&role.contract, registry), row, &template.text);
            sources.push(Source::template(template, &renames));
        }
    }
    Ok(sources)
}

/// Those of the printed heads whose templates come from papers, without comment signs.
pub(super) fn algorithms(
    pass: &Pass,
    plan: &Plan,
    registry: &Registry,
    printed: &BTreeMap<Arc<str>, String>,
) -> Result<String, String> {
    let mut heads: Vec<String> = Vec::new();
    for role in ordered(pass, registry) {
        let row = instance_row(role, &plan.selection, registry)?;
        let template = row.template.as_ref().filter(|_| !row.paper.is_empty());
        if let Some((template, head)) = template.and_then(|one| Some((one, printed.get(&*one.path)?))) {
            let lines: Vec<&str> = head.lines().map(|line| line.trim_start_matches("//").trim()).collect();
            let text = format!("{}:\n{}\n", template.path, lines.join("\n").trim_end());
            if !heads.contains(&text) {
                heads.push(text);
            }
        }
    }
    Ok(heads.join("\n"))
}

/// The roles of a pass in the order of the axes, one per instance.
fn ordered<'a>(pass: &'a Pass, registry: &Registry) -> Vec<&'a Role> {
    let mut ordered: BTreeMap<(usize, &str), &Role> = BTreeMap::new();
    for role in &pass.roles {
        let axis = axis_of(&role.contract, registry);
        let order = registry.axes().iter().position(|other| other.key == axis).unwrap_or(usize::MAX);
        ordered.insert((order, &role.instance.name), role);
    }
    ordered.into_values().collect()
}

/// An instance named after its axis keeps the template's names. Any other puts its name in place of the contract's in the
/// names that the template exports, and before its private names and the accessors of its own resources.
fn renames(role: &Role, axis: &str, row: &Row, text: &str) -> Renames {
    let name = &role.instance.name;
    let mut renames = Renames::default();
    if name == axis {
        return renames;
    }
    for declared in names(text) {
        let is_contract = CONTRACTS.iter().any(|contract| contract.name == declared);
        let rest = declared.strip_prefix(axis).and_then(|rest| rest.strip_prefix('_')).filter(|_| is_contract);
        renames.insert(declared.clone(), format!("{name}_{}", rest.unwrap_or(&declared)));
    }
    let own = row.resources.iter().filter(|_| role.instance.memory == Memory::Own);
    for resource in own {
        for accessor in ACCESSORS {
            let old = format!("{}_{accessor}", resource.name);
            renames.insert(old.clone(), format!("{name}_{old}"));
        }
    }
    renames
}

/// What generated accessors of a resource `x` are called, after `x_`.
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
