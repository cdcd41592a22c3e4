//! Describes the accessors of the buffers of a user file, for messages about the file.
//!
//! Input: a pass of a plan. Output: each buffer of the row with its declared access and the accessors that it has in this pass. Nothing
//! here is printed into a source.

use fragbuf_templates::vocabulary::{Access, Element, Pass};

use super::buffers::OPERATIONS;
use crate::{Plan, PlannedResource};

/// A buffer of a user file in one pass.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UserBuffer {
    /// Its name.
    pub name: String,
    /// The declared access, as the header has it: `read`, `plain`. `None`: the pass does not use the buffer.
    pub access: Option<&'static str>,
    /// The accessors of the pass with their parameters, as `slots_load(slot: u32, pixel: u32) -> Packed`.
    pub accessors: Vec<String>,
}

/// The operations of accessors, and the access that gives them.
const NEEDED: [(&str, &str); 5] =
    [("load", "read"), ("store", "plain"), ("hint", "hinted"), ("publish", "hinted"), ("atomic_", "atomic")];

impl UserBuffer {
    /// Returns the access that an accessor of this buffer needs; `None`: the name is no accessor of it.
    pub fn access_of(&self, accessor: &str) -> Option<&'static str> {
        let operation = accessor.strip_prefix(self.name.as_str())?.strip_prefix('_')?;
        let is_operation = |name: &str| match name.strip_suffix('_') {
            Some(atomic) => operation.strip_prefix(atomic).is_some_and(|rest| rest.starts_with('_')),
            None => operation == name,
        };
        NEEDED.iter().find(|(name, _)| is_operation(name)).map(|(_, access)| *access)
    }
}

/// Returns the buffers of the user files of a plan.
pub(crate) fn user_buffers(plan: &Plan, pass: &Pass) -> Vec<UserBuffer> {
    let is_user_file = |template: &fragbuf_templates::vocabulary::Template| template.user_file.is_some();
    let rows = plan.selection.rows.iter().filter(|selected| selected.row.template.as_ref().is_some_and(is_user_file));
    let mut buffers = Vec::new();
    for resource in rows.flat_map(|selected| &selected.row.resources) {
        let Some(planned) = plan.resources.iter().find(|planned| planned.resource.name == resource.name) else {
            continue;
        };
        let access = pass.uses.iter().find(|usage| usage.resource == resource.name).map(|usage| usage.access);
        let word = access.map(|access| match access {
            Access::Plain => "plain",
            Access::Atomic => "atomic",
            Access::Coherent => "coherent",
            Access::Hinted => "hinted",
            _ => "read",
        });
        let accessors = access.map(|access| accessors(planned, access)).unwrap_or_default();
        buffers.push(UserBuffer { name: resource.name.clone(), access: word, accessors });
    }
    buffers
}

fn accessors(planned: &PlannedResource, access: Access) -> Vec<String> {
    let name = &planned.resource.name;
    let scalar = match planned.resource.element {
        Element::Word => Some("u32"),
        Element::Word64 => Some("u64"),
        _ => None,
    };
    let index = || planned.resource.extents.iter().map(|extent| format!("{}: u32", extent.name));
    let with = |more: &[String]| index().chain(more.iter().cloned()).collect::<Vec<_>>().join(", ");
    let key = (planned.resource.element == Element::Value).then(|| "key: u32".to_owned());
    let result = scalar.unwrap_or("Packed");
    let mut list = vec![format!("{name}_load({}) -> {result}", with(key.as_slice()))];
    if access == Access::Read {
        return list;
    }
    let value = scalar.map_or("entry: Packed".to_owned(), |scalar| format!("value: {scalar}"));
    list.push(format!("{name}_store({})", with(std::slice::from_ref(&value))));
    let Some(scalar) = scalar else { return list };
    match access {
        Access::Atomic => {
            let operations = OPERATIONS.iter().map(|(operation, _)| {
                format!("{name}_atomic_{operation}({}) -> {scalar}", with(std::slice::from_ref(&value)))
            });
            list.extend(operations);
            let expected = format!("expected: {scalar}");
            list.push(format!("{name}_atomic_compare_exchange({}) -> bool", with(&[expected, value])));
        }
        Access::Hinted => {
            list.push(format!("{name}_hint({}) -> {scalar}", with(&[])));
            list.push(format!("{name}_publish({})", with(&[value])));
        }
        _ => {}
    }
    list
}
