//! Removes code without effect from linked functions, before any target prints them.
//!
//! In: the declarations that a text links. Out: new texts for some of its functions, each line with the line that it comes
//! from. Calls of empty functions are removed. Calls of functions that return a constant or their own argument are replaced
//! by it. Known conditions select a branch, unread locals are removed. This repeats until nothing changes.
//!
//! Invariant: an expression is removed only if it has no side effects, so a program keeps its meaning. Never changed: texts
//! of the user's own, marker functions, whose calls other targets replace, and functions that cannot be parsed or that have
//! block comments.

mod choice;
mod edit;
mod effects;
mod expression;
mod lines;
mod locals;
mod rules;
mod substitute;
mod syntax;
mod trace;
mod types;
mod values;

#[cfg(test)]
mod tests;

pub(super) use effects::has_effects;
pub(super) use substitute::{Substitute, substitute};

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::index::Index;
use super::item::{Item, mentions};
use super::reach::Reached;
use super::token::{Token, tokens};
use crate::MARKERS;
use edit::Lines;
use values::{Declared, Known};

/// A function after folding.
#[derive(Clone, Debug)]
pub(super) struct Folded {
    pub(super) text: String,
    /// For each line the one of the source's item, from 0.
    pub(super) lines: Vec<usize>,
    pub(super) mentions: Vec<String>,
    substitute: Substitute,
    has_effects: bool,
}

/// Folds the functions among `reached`; `is_fixed` says whether a source keeps its text.
pub(super) fn fold(
    items: &[(usize, &Item<'_>)],
    index: &Index<'_>,
    reached: &Reached,
    is_fixed: &dyn Fn(usize) -> bool,
) -> BTreeMap<usize, Arc<Folded>> {
    let stays = |id: &usize| is_fixed(items[*id].0) || MARKERS.contains(&items[*id].1.name);
    let ours: Vec<usize> = reached.ids().filter(|id| !stays(id)).collect();
    let constants = ours.iter().filter(|id| items[**id].1.substitute != Substitute::None);
    let mut folding = Folding {
        items,
        index,
        reached,
        substitutes: constants.map(|id| (items[*id].1.name, items[*id].1.substitute.clone())).collect(),
        is_replaced: vec![false; items.len()],
        folded: BTreeMap::new(),
    };
    let functions: Vec<usize> = ours.iter().copied().filter(|id| items[*id].1.is_function).collect();
    for &id in functions.iter().filter(|id| items[**id].1.substitute != Substitute::None) {
        folding.is_replaced[id] = true;
    }
    let mut is_first = true;
    loop {
        let known = folding.substitutes.len();
        for &id in &functions {
            if folding.may_fold(id, is_first) {
                folding.function(id);
            }
        }
        if !is_first && known == folding.substitutes.len() {
            return folding.folded;
        }
        is_first = false;
    }
}

struct Folding<'f> {
    items: &'f [(usize, &'f Item<'f>)],
    index: &'f Index<'f>,
    reached: &'f Reached,
    /// The substitutes found so far, by name.
    substitutes: BTreeMap<&'f str, Substitute>,
    /// The functions among them, by number.
    is_replaced: Vec<bool>,
    folded: BTreeMap<usize, Arc<Folded>>,
}

impl Folding<'_> {
    /// Whether a function uses another that has a substitute. Block comments are not understood here: a function with one
    /// stays as it was written.
    fn may_fold(&self, id: usize, is_first: bool) -> bool {
        let uses_replaced = || self.uses(id).iter().any(|used| *used != id && self.is_replaced[*used]);
        ((is_first && self.items[id].1.compares_constants) || uses_replaced()) && !self.items[id].1.text.contains("/*")
    }

    fn function(&mut self, id: usize) {
        let item = self.items[id].1;
        let known = Known {
            substitute: &|name| self.substitutes.get(name).cloned().unwrap_or_default(),
            has_effects: &|name| self.index.get(name).map(|id| self.has_effects(*id)),
            declared: &|name| self.index.get(name).map(|id| Declared::of(self.items[*id].1)),
        };
        let folded = match self.folded.get(&id) {
            Some(folded) => {
                let before = Lines { text: folded.text.clone(), origins: folded.lines.clone() };
                rounds(before, &known).map(Arc::new)
            }
            None => trace::folded(item.text, &known, |known| rounds(Lines::written(item.text), known)),
        };
        let Some(folded) = folded else { return };
        if folded.substitute != Substitute::None {
            self.substitutes.insert(item.name, folded.substitute.clone());
            self.is_replaced[id] = true;
        }
        self.folded.insert(id, folded);
    }

    /// Whether calling a function does more than return a value. Calls that lead back are followed once: WGSL has no
    /// recursion, but a user's text may have it until the validator refuses it.
    fn has_effects(&self, id: usize) -> bool {
        let (mut waiting, mut seen) = (vec![id], BTreeSet::from([id]));
        while let Some(id) = waiting.pop() {
            let item = self.items[id].1;
            let folded = self.folded.get(&id);
            if MARKERS.contains(&item.name) || folded.map_or(item.has_effects, |folded| folded.has_effects) {
                return true;
            }
            let uses = self.uses(id);
            waiting.extend(uses.iter().copied().filter(|used| self.items[*used].1.is_function && seen.insert(*used)));
        }
        false
    }

    /// The declarations that one uses, as its text is by now.
    fn uses(&self, id: usize) -> Cow<'_, [usize]> {
        match self.folded.get(&id) {
            Some(folded) => folded.mentions.iter().filter_map(|name| self.index.get(name.as_str())).copied().collect(),
            None => Cow::Borrowed(self.reached.uses(id)),
        }
    }
}

/// Repeats the rules until nothing changes; `None` where nothing did.
fn rounds(mut lines: Lines, known: &Known<'_>) -> Option<Folded> {
    let mut has_changed = false;
    loop {
        let (code, _) = tokens(&lines.text);
        let edits = rules::edits(&lines.text, &code, known, !has_changed);
        // Every round leaves fewer tokens, or shorter ones, so one finds nothing to do.
        if edits.is_empty() {
            return has_changed.then(|| folded(&lines, &code));
        }
        lines = lines.apply(edits);
        has_changed = true;
    }
}

fn folded(lines: &Lines, code: &[Token<'_>]) -> Folded {
    Folded {
        text: lines.text.clone(),
        lines: lines.origins.clone(),
        mentions: mentions(code).into_iter().map(str::to_owned).collect(),
        substitute: substitute(code),
        has_effects: has_effects(code),
    }
}
