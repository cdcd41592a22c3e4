//! What folding a function came to, kept for the next text that links it: templates are folded once for each answer to what
//! they ask of the declarations around them.
//!
//! In: a text, and what is known of names. Out: the result, with every question that led to it. A result is taken over only
//! where all of its questions have the same answers, so it is what folding would give. The number of results is bounded: the
//! first ones stay.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use super::Folded;
use super::substitute::Substitute;
use super::values::{Declared, Known};

/// Folds `text`, or takes over what it came to before. `fold` does the work; `None`: nothing changes.
pub(super) fn folded(
    text: &str,
    known: &Known<'_>,
    fold: impl FnOnce(&Known<'_>) -> Option<Folded>,
) -> Option<Arc<Folded>> {
    if let Some(result) = taken_over(text, known) {
        return result;
    }
    let asked = Asked::default();
    let result = {
        let substitute = |name: &str| {
            let answer = (known.substitute)(name);
            asked.substitutes.borrow_mut().entry(name.to_owned()).or_insert(answer).clone()
        };
        let has_effects = |name: &str| {
            let answer = (known.has_effects)(name);
            *asked.effects.borrow_mut().entry(name.to_owned()).or_insert(answer)
        };
        let declared = |name: &str| {
            let answer = (known.declared)(name);
            *asked.declared.borrow_mut().entry(name.to_owned()).or_insert(answer)
        };
        fold(&Known { substitute: &substitute, has_effects: &has_effects, declared: &declared }).map(Arc::new)
    };
    let trace = Trace {
        substitutes: asked.substitutes.into_inner().into_iter().collect(),
        effects: asked.effects.into_inner().into_iter().collect(),
        declared: asked.declared.into_inner().into_iter().collect(),
        result: result.clone(),
    };
    kept().keep(text, trace);
    result
}

/// Results that are kept at most: each template has a few. Beyond them a text is folded again each time.
const MOST: usize = 4096;

/// The questions of one folding and their answers.
#[derive(Default)]
struct Asked {
    substitutes: RefCell<BTreeMap<String, Substitute>>,
    effects: RefCell<BTreeMap<String, Option<bool>>>,
    declared: RefCell<BTreeMap<String, Option<Declared>>>,
}

/// A result, and what led to it.
struct Trace {
    substitutes: Vec<(String, Substitute)>,
    effects: Vec<(String, Option<bool>)>,
    declared: Vec<(String, Option<Declared>)>,
    result: Option<Arc<Folded>>,
}

/// The results by the texts that they are of.
#[derive(Default)]
struct Kept {
    traces: HashMap<Arc<str>, Vec<Trace>>,
    count: usize,
}

impl Kept {
    /// Keeps a result if there is room.
    fn keep(&mut self, text: &str, trace: Trace) {
        if self.count < MOST {
            self.count += 1;
            self.traces.entry(text.into()).or_default().push(trace);
        }
    }
}

fn kept() -> std::sync::MutexGuard<'static, Kept> {
    static KEPT: LazyLock<Mutex<Kept>> = LazyLock::new(Mutex::default);
    // A thread that panicked while holding the lock left only whole entries behind.
    KEPT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The result of a folding of this text whose questions have these answers; `None`: there was none.
fn taken_over(text: &str, known: &Known<'_>) -> Option<Option<Arc<Folded>>> {
    let kept = kept();
    let is_same = |trace: &&Trace| {
        let substitutes = trace.substitutes.iter().all(|(name, answer)| (known.substitute)(name) == *answer);
        let declared = || trace.declared.iter().all(|(name, answer)| (known.declared)(name) == *answer);
        substitutes && declared() && trace.effects.iter().all(|(name, answer)| (known.has_effects)(name) == *answer)
    };
    kept.traces.get(text)?.iter().find(is_same).map(|trace| trace.result.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_results_stay_and_later_ones_find_no_room() {
        let mut kept = Kept::default();
        for number in 0..=MOST {
            let trace = Trace { substitutes: Vec::new(), effects: Vec::new(), declared: Vec::new(), result: None };
            kept.keep(&format!("fn f{number}() {{}}"), trace);
        }
        assert_eq!(kept.count, MOST);
        assert!(kept.traces.contains_key("fn f0() {}"));
        assert!(!kept.traces.contains_key(format!("fn f{MOST}() {{}}").as_str()));
    }
}
