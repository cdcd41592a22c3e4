//! What does nothing is not printed.
//!
//! In: the declarations that a text links. Out: other texts for some of its functions, with where their lines come from. A
//! function with an empty body, or one that returns a constant or its own argument, is put in place of its calls; conditions
//! that are known decide; what nobody reads, or nobody reaches, goes. An expression disappears only where it has no effects,
//! so a program means what it meant. All of it is repeated until nothing changes.
//!
//! Texts of the user's own, and functions that targets replace by words of theirs, stay as they were written. What cannot be
//! read stays too.

mod choice;
mod edit;
mod effects;
mod expression;
mod lines;
mod rules;
mod syntax;
mod values;
mod worth;

#[cfg(test)]
mod tests;

pub(super) use effects::has_effects;
pub(super) use worth::{Worth, worth};

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::item::{Item, mentions};
use super::token::tokens;
use crate::MARKERS;
use edit::Lines;
use values::Known;

/// A function that is written otherwise than in its source.
#[derive(Clone, Debug)]
pub(super) struct Folded {
    pub(super) text: String,
    /// For each line the one of the source's item, from 0.
    pub(super) lines: Vec<usize>,
    pub(super) mentions: Vec<String>,
    worth: Worth,
    has_effects: bool,
}

/// Folds what `reached` holds of `items`; `is_fixed` says of a source that its text stays as it is.
pub(super) fn fold(
    items: &[(usize, &Item<'_>)],
    index: &HashMap<&str, usize>,
    reached: &BTreeSet<usize>,
    is_fixed: &dyn Fn(usize) -> bool,
) -> BTreeMap<usize, Folded> {
    let stays = |id: &usize| is_fixed(items[*id].0) || MARKERS.contains(&items[*id].1.name);
    let ours: Vec<usize> = reached.iter().copied().filter(|id| !stays(id)).collect();
    let constants = ours.iter().filter(|id| items[**id].1.worth != Worth::Itself);
    let mut folding = Folding {
        items,
        index,
        worths: constants.map(|id| (items[*id].1.name, items[*id].1.worth.clone())).collect(),
        folded: BTreeMap::new(),
    };
    let mut is_first = true;
    loop {
        let known = folding.worths.len();
        for &id in &ours {
            if items[id].1.is_function && folding.may_fold(id, is_first) {
                folding.function(id);
            }
        }
        if !is_first && known == folding.worths.len() {
            return folding.folded;
        }
        is_first = false;
    }
}

struct Folding<'f> {
    items: &'f [(usize, &'f Item<'f>)],
    index: &'f HashMap<&'f str, usize>,
    /// What stands in place of a declaration, for those of which something does.
    worths: BTreeMap<&'f str, Worth>,
    folded: BTreeMap<usize, Folded>,
}

impl Folding<'_> {
    /// Whether something stands in it that folds.
    fn may_fold(&self, id: usize, is_first: bool) -> bool {
        let item = self.items[id].1;
        let names = self.worths.iter().filter(|(_, worth)| !matches!(worth, Worth::Integer(_))).map(|(name, _)| *name);
        let mut names = names.filter(|name| *name != item.name);
        (is_first && item.compares_constants)
            || match self.folded.get(&id) {
                Some(folded) => names.any(|name| folded.mentions.iter().any(|other| other == name)),
                None => names.any(|name| item.mentions.binary_search(&name).is_ok()),
            }
    }

    fn function(&mut self, id: usize) {
        let item = self.items[id].1;
        let before = match self.folded.get(&id) {
            Some(folded) => Lines { text: folded.text.clone(), origins: folded.lines.clone() },
            None => Lines::written(item.text),
        };
        let Some(after) = self.rounds(before) else { return };
        let (code, _) = tokens(&after.text);
        let folded = Folded {
            mentions: mentions(&code).into_iter().map(str::to_owned).collect(),
            worth: worth(&code),
            has_effects: has_effects(&code),
            lines: after.origins,
            text: after.text,
        };
        if folded.worth != Worth::Itself {
            self.worths.insert(item.name, folded.worth.clone());
        }
        self.folded.insert(id, folded);
    }

    /// Rule after rule until nothing changes; `None` where nothing did.
    fn rounds(&self, mut lines: Lines) -> Option<Lines> {
        let known = Known {
            worth: &|name| self.worths.get(name).cloned().unwrap_or_default(),
            has_effects: &|name| self.index.get(name).map(|id| self.has_effects(*id)),
        };
        let mut has_changed = false;
        for _ in 0..MOST_ROUNDS {
            let (code, _) = tokens(&lines.text);
            let edits = rules::edits(&lines.text, &code, &known, !has_changed);
            if edits.is_empty() {
                break;
            }
            lines = lines.apply(edits);
            has_changed = true;
        }
        has_changed.then_some(lines)
    }

    /// Whether calling a function does more than return a value. WGSL has no recursion.
    fn has_effects(&self, id: usize) -> bool {
        let item = self.items[id].1;
        let calls = |name: &str| {
            self.index
                .get(name)
                .is_some_and(|other| *other != id && self.items[*other].1.is_function && self.has_effects(*other))
        };
        MARKERS.contains(&item.name)
            || match self.folded.get(&id) {
                Some(folded) => folded.has_effects || folded.mentions.iter().any(|name| calls(name)),
                None => item.has_effects || item.mentions.iter().any(|name| calls(name)),
            }
    }
}

/// More than any function of a template needs: each round leaves less than the one before.
const MOST_ROUNDS: usize = 64;
