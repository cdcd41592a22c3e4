//! Checks that the nodes of a model are a forest, as the format requires: a node has at most one parent, and is not its own
//! descendant.
//!
//! Without the check a few nodes that name each other twice would be drawn without end.

use gltf::Gltf;

use crate::error::FileError;

/// Checks all nodes. The error names the node.
pub(super) fn check(model: &Gltf) -> Result<(), FileError> {
    let mut parents: Vec<Option<usize>> = vec![None; model.nodes().len()];
    for node in model.nodes() {
        for child in node.children().map(|child| child.index()) {
            if child == node.index() {
                return Err(FileError::whole(format!("node {child} is its own child")).in_element("nodes", child));
            }
            let Some(parent) = parents.get_mut(child) else { continue };
            match parent.replace(node.index()) {
                None => {}
                Some(first) if first == node.index() => {
                    return Err(FileError::whole(format!("node {child} is a child of node {first} twice"))
                        .in_element("nodes", first));
                }
                Some(first) => {
                    let message = format!("node {child} has two parents, nodes {first} and {}", node.index());
                    return Err(FileError::whole(message).in_element("nodes", child));
                }
            }
        }
    }
    acyclic(&parents)
}

/// Checks that every node has an ancestor without a parent. Each node is visited once.
fn acyclic(parents: &[Option<usize>]) -> Result<(), FileError> {
    // The start of the walk that has visited a node.
    let mut visited: Vec<Option<usize>> = vec![None; parents.len()];
    for start in 0..parents.len() {
        let mut now = Some(start);
        while let Some(node) = now {
            let Some(mark) = visited.get_mut(node) else { break };
            match *mark {
                Some(walk) if walk == start => {
                    return Err(
                        FileError::whole(format!("node {node} is its own descendant")).in_element("nodes", node)
                    );
                }
                Some(_) => break,
                None => *mark = Some(start),
            }
            now = parents.get(node).copied().flatten();
        }
    }
    Ok(())
}
