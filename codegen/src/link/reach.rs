//! Which declarations the roots reach, and which others each of them uses.
//!
//! In: the declarations, where each name is declared, the roots. Out: numbers of declarations. Names are looked up once per
//! declaration: everything later asks by number.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::fold::Folded;
use super::index::Index;
use super::item::Item;

/// What is reached from the roots.
pub(super) struct Reached {
    roots: Vec<usize>,
    is_reached: Vec<bool>,
    /// What each reached declaration uses, as it was written.
    uses: Vec<Vec<usize>>,
}

impl Reached {
    /// From the entry points, or from `exports` where there are any. `Err`: nothing declares an export.
    pub(super) fn new(items: &[(usize, &Item<'_>)], index: &Index<'_>, exports: &[&str]) -> Result<Self, String> {
        let mut roots: Vec<usize> = Vec::new();
        if exports.is_empty() {
            roots.extend((0..items.len()).filter(|&id| items[id].1.stage.is_some()));
        }
        for export in exports {
            roots.push(*index.get(export).ok_or_else(|| format!("nothing declares `{export}`"))?);
        }
        let mut uses = vec![Vec::new(); items.len()];
        let is_reached = walk(&roots, items.len(), |id, found| {
            let used = &mut uses[id];
            used.extend(items[id].1.mentions.iter().filter_map(|name| index.get(name)).copied());
            found.extend_from_slice(used);
        });
        Ok(Reached { roots, is_reached, uses })
    }

    /// The same once these declarations have new texts. A new text uses nothing that was out of reach.
    pub(super) fn after(self, folded: &BTreeMap<usize, Arc<Folded>>, index: &Index<'_>) -> Self {
        let is_reached = walk(&self.roots, self.is_reached.len(), |id, found| match folded.get(&id) {
            Some(folded) => found.extend(folded.mentions.iter().filter_map(|name| index.get(name.as_str()))),
            None => found.extend_from_slice(&self.uses[id]),
        });
        Reached { is_reached, ..self }
    }

    /// The reached declarations, in the order of the sources.
    pub(super) fn ids(&self) -> impl Iterator<Item = usize> {
        self.is_reached.iter().enumerate().filter(|(_, is_reached)| **is_reached).map(|(id, _)| id)
    }

    pub(super) fn contains(&self, id: usize) -> bool {
        self.is_reached[id]
    }

    /// What a reached declaration uses, itself included.
    pub(super) fn uses(&self, id: usize) -> &[usize] {
        &self.uses[id]
    }
}

/// Everything that can be reached; `uses` adds what a declaration uses.
fn walk(roots: &[usize], count: usize, mut uses: impl FnMut(usize, &mut Vec<usize>)) -> Vec<bool> {
    let mut is_reached = vec![false; count];
    let (mut waiting, mut found) = (roots.to_vec(), Vec::new());
    waiting.iter().for_each(|root| is_reached[*root] = true);
    while let Some(id) = waiting.pop() {
        found.clear();
        uses(id, &mut found);
        waiting.extend(found.iter().copied().filter(|&used| !std::mem::replace(&mut is_reached[used], true)));
    }
    is_reached
}
