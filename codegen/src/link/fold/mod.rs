//! Removes code without effect from linked functions, before any target prints them.
//!
//! Input: the linked declarations. Output: new sources of some functions, with the origin of each line. Calls of empty functions are
//! removed. Calls of functions that return a constant or their argument are replaced by it. Known conditions select a branch, and
//! unread locals are removed. This repeats until nothing changes.
//!
//! Invariant: an expression is removed only if it has no side effects, so a program keeps its meaning. Never changed: user files and
//! closures; marker functions, whose calls other targets replace; functions that cannot be parsed or that have block comments.

mod cache;
mod choice;
mod edit;
mod effects;
mod environment;
mod expression;
mod lines;
mod locals;
mod rules;
mod substitute;
mod syntax;
mod types;
mod values;

#[cfg(test)]
mod tests;

pub(super) use effects::has_effects;
pub(super) use substitute::{Substitute, substitute};

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::folded::FoldedFunction;
use super::index::Index;
use super::item::{Item, mentions};
use super::reach::Reachability;
use super::token::{Token, tokens};
use crate::MARKERS;
use edit::Lines;
use environment::{DeclarationKind, Environment};

/// Folds the reached functions. `is_fixed` tests whether a source must not change.
pub(super) fn fold(
    items: &[(usize, &Item<'_>)],
    index: &Index<'_>,
    reached: &Reachability,
    is_fixed: &dyn Fn(usize) -> bool,
) -> BTreeMap<usize, Arc<FoldedFunction>> {
    let is_unchanged = |id: &usize| is_fixed(items[*id].0) || MARKERS.contains(&items[*id].1.name);
    let foldable: Vec<usize> = reached.ids().filter(|id| !is_unchanged(id)).collect();
    let replaced = foldable.iter().filter(|id| items[**id].1.substitute != Substitute::None);
    let mut folding = Folding {
        items,
        index,
        reached,
        substitutes: replaced.map(|id| (items[*id].1.name, items[*id].1.substitute.clone())).collect(),
        is_replaced: vec![false; items.len()],
        folded: BTreeMap::new(),
    };
    let functions: Vec<usize> = foldable.iter().copied().filter(|id| items[*id].1.is_function).collect();
    for &id in functions.iter().filter(|id| items[**id].1.substitute != Substitute::None) {
        folding.is_replaced[id] = true;
    }
    let mut is_first = true;
    loop {
        let count = folding.substitutes.len();
        for &id in &functions {
            if folding.may_fold(id, is_first) {
                folding.function(id);
            }
        }
        if !is_first && count == folding.substitutes.len() {
            return folding.folded;
        }
        is_first = false;
    }
}

/// The state of folding.
struct Folding<'f> {
    items: &'f [(usize, &'f Item<'f>)],
    index: &'f Index<'f>,
    reached: &'f Reachability,
    /// The substitutes found so far, by name.
    substitutes: BTreeMap<&'f str, Substitute>,
    /// For each declaration, whether it is a function with a substitute.
    is_replaced: Vec<bool>,
    folded: BTreeMap<usize, Arc<FoldedFunction>>,
}

impl Folding<'_> {
    /// Tests whether a function uses another that has a substitute. The rules do not support block comments, so a function that has one
    /// is not folded.
    fn may_fold(&self, id: usize, is_first: bool) -> bool {
        let uses_replaced = || self.uses(id).iter().any(|used| *used != id && self.is_replaced[*used]);
        ((is_first && self.items[id].1.compares_constants) || uses_replaced()) && !self.items[id].1.text.contains("/*")
    }

    /// Folds a function.
    fn function(&mut self, id: usize) {
        let item = self.items[id].1;
        let environment = Environment {
            substitute: &|name| self.substitutes.get(name).cloned().unwrap_or_default(),
            has_effects: &|name| self.index.get(name).map(|id| self.has_effects(*id)),
            kind: &|name| self.index.get(name).map(|id| DeclarationKind::of(self.items[*id].1)),
        };
        let folded = match self.folded.get(&id) {
            Some(folded) => {
                let before = Lines { text: folded.text.clone(), origins: folded.lines.clone() };
                iterate(before, &environment).map(Arc::new)
            }
            None => cache::folded(item.text, &environment, |environment| iterate(Lines::new(item.text), environment)),
        };
        let Some(folded) = folded else { return };
        if folded.substitute != Substitute::None {
            self.substitutes.insert(item.name, folded.substitute.clone());
            self.is_replaced[id] = true;
        }
        self.folded.insert(id, folded);
    }

    /// Tests whether a call of a function has side effects. Each function is visited once: WGSL has no recursion, but a user file can
    /// contain it until the validator rejects it.
    fn has_effects(&self, id: usize) -> bool {
        let (mut pending, mut visited) = (vec![id], BTreeSet::from([id]));
        while let Some(id) = pending.pop() {
            let item = self.items[id].1;
            let folded = self.folded.get(&id);
            if MARKERS.contains(&item.name) || folded.map_or(item.has_effects, |folded| folded.has_effects) {
                return true;
            }
            let uses = self.uses(id);
            pending
                .extend(uses.iter().copied().filter(|used| self.items[*used].1.is_function && visited.insert(*used)));
        }
        false
    }

    /// Returns the declarations that one uses after the folding so far.
    fn uses(&self, id: usize) -> Cow<'_, [usize]> {
        match self.folded.get(&id) {
            Some(folded) => folded.mentions.iter().filter_map(|name| self.index.get(name.as_str())).copied().collect(),
            None => Cow::Borrowed(self.reached.uses(id)),
        }
    }
}

/// Applies the rules until nothing changes. Returns `None` if nothing changed.
fn iterate(mut lines: Lines, environment: &Environment<'_>) -> Option<FoldedFunction> {
    let mut has_changed = false;
    loop {
        let (code, _) = tokens(&lines.text);
        let edits = rules::edits(&lines.text, &code, environment, !has_changed);
        // Every iteration leaves fewer or shorter tokens, so this ends.
        if edits.is_empty() {
            return has_changed.then(|| folded_function(&lines, &code));
        }
        lines = lines.apply(edits);
        has_changed = true;
    }
}

fn folded_function(lines: &Lines, code: &[Token<'_>]) -> FoldedFunction {
    FoldedFunction {
        text: lines.text.clone(),
        lines: lines.origins.clone(),
        mentions: mentions(code).into_iter().map(str::to_owned).collect(),
        substitute: substitute(code),
        has_effects: has_effects(code),
    }
}
