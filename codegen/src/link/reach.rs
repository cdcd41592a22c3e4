//! Computes which declarations the roots reach, and which declarations each of them uses.
//!
//! Input: the declarations, the index of their names, the roots. Output: numbers of declarations. Names are looked up once per
//! declaration; later lookups use numbers.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::folded::FoldedFunction;
use super::index::Index;
use super::item::Item;

/// The declarations that the roots reach.
pub(super) struct Reachability {
    roots: Vec<usize>,
    is_reached: Vec<bool>,
    /// The declarations that each reached declaration uses before folding.
    uses: Vec<Vec<usize>>,
}

impl Reachability {
    /// Computes the declarations that the entry points reach, or `exports` if there are any. Fails if an export is not declared.
    pub(super) fn new(items: &[(usize, &Item<'_>)], index: &Index<'_>, exports: &[&str]) -> Result<Self, String> {
        let mut roots: Vec<usize> = Vec::new();
        if exports.is_empty() {
            roots.extend((0..items.len()).filter(|&id| items[id].1.stage.is_some()));
        }
        for export in exports {
            roots.push(*index.get(export).ok_or_else(|| format!("`{export}` is not declared"))?);
        }
        let mut uses = vec![Vec::new(); items.len()];
        let is_reached = walk(&roots, items.len(), |id, found| {
            let used = &mut uses[id];
            used.extend(items[id].1.mentions.iter().filter_map(|name| index.get(name)).copied());
            found.extend_from_slice(used);
        });
        Ok(Reachability { roots, is_reached, uses })
    }

    /// Computes reachability again after folding. A folded function uses only declarations that were reachable before.
    pub(super) fn after(self, folded: &BTreeMap<usize, Arc<FoldedFunction>>, index: &Index<'_>) -> Self {
        let is_reached = walk(&self.roots, self.is_reached.len(), |id, found| match folded.get(&id) {
            Some(folded) => found.extend(folded.mentions.iter().filter_map(|name| index.get(name.as_str()))),
            None => found.extend_from_slice(&self.uses[id]),
        });
        Reachability { is_reached, ..self }
    }

    /// Returns the reached declarations, in the order of the sources.
    pub(super) fn ids(&self) -> impl Iterator<Item = usize> {
        self.is_reached.iter().enumerate().filter(|(_, is_reached)| **is_reached).map(|(id, _)| id)
    }

    pub(super) fn contains(&self, id: usize) -> bool {
        self.is_reached[id]
    }

    /// Returns the declarations that a reached declaration uses, including itself.
    pub(super) fn uses(&self, id: usize) -> &[usize] {
        &self.uses[id]
    }
}

/// Marks all reachable declarations. `uses` appends the declarations that one uses.
fn walk(roots: &[usize], count: usize, mut uses: impl FnMut(usize, &mut Vec<usize>)) -> Vec<bool> {
    let mut is_reached = vec![false; count];
    let (mut pending, mut found) = (roots.to_vec(), Vec::new());
    pending.iter().for_each(|root| is_reached[*root] = true);
    while let Some(id) = pending.pop() {
        found.clear();
        uses(id, &mut found);
        pending.extend(found.iter().copied().filter(|&used| !std::mem::replace(&mut is_reached[used], true)));
    }
    is_reached
}
