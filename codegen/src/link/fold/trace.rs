//! What folding a function came to, kept for the next text that links it: templates are folded once for each answer to what
//! they ask of the declarations around them.
//!
//! In: a text, and what is known of names. Out: the result, with every question that led to it. A result is taken over only
//! where all of its questions have the same answers, so it is what folding would give. The number of results is bounded.

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
    let mut kept = kept();
    if kept.values().map(Vec::len).sum::<usize>() >= MOST {
        kept.clear();
    }
    kept.entry(text.into()).or_default().push(trace);
    result
}

/// Results that are kept at most: each template has a few.
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

type Kept = HashMap<Arc<str>, Vec<Trace>>;

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
    kept.get(text)?.iter().find(is_same).map(|trace| trace.result.clone())
}
