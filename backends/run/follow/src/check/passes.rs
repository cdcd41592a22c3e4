//! Checks single passes: what they draw, and the numbers of their bindings.

use std::collections::BTreeSet;

use crate::manifest::{Binding, Kind, Objects, Pass};

/// The greatest group, as in `fragbuf generate --group`.
const GREATEST_GROUP: u32 = 31;

/// The greatest number of a binding: `maxBindingsPerBindGroup` of WebGPU is 1000. Vulkan drivers allocate memory for
/// every number up to the greatest.
const GREATEST_BINDING: u32 = 999;

/// Checks that only geometry passes select objects, and that no two bindings of a pass have one number.
pub fn check(pass: &Pass) -> Result<(), String> {
    let Pass { name, .. } = pass;
    if !matches!(pass.objects, Objects::All) && pass.kind != Kind::Geometry {
        return Err(format!("the pass `{name}` has `objects`, which only a geometry pass draws"));
    }
    pass.binding_lists().try_for_each(bindings).map_err(|problem| format!("the pass `{name}`: {problem}"))
}

fn bindings(bindings: &[Binding]) -> Result<(), String> {
    let mut numbers = BTreeSet::new();
    for Binding { name, group, binding, .. } in bindings {
        if *group > GREATEST_GROUP || *binding > GREATEST_BINDING {
            return Err(format!(
                "`{name}` is binding {binding} of group {group}: at most {GREATEST_BINDING} and {GREATEST_GROUP} are allowed"
            ));
        }
        if !numbers.insert((group, binding)) {
            return Err(format!("two resources are binding {binding} of group {group}"));
        }
    }
    Ok(())
}
