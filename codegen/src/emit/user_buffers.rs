//! Describes the accessors of the buffers of a user file, for messages about the file.
//!
//! Input: a pass of a plan. Output: each buffer of the row with its declared access and the accessors that it has in this pass. Nothing
//! here is printed into a source.

use fragbuf_templates::vocabulary::{Access, Pass};

use super::buffers::signatures;
use crate::Plan;

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
        let accessors = access.map(|access| signatures(plan, planned, access)).unwrap_or_default();
        buffers.push(UserBuffer { name: resource.name.clone(), access: word, accessors });
    }
    buffers
}
