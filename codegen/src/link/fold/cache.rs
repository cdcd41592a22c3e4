//! Caches the results of folding functions. A function is folded once per set of answers to its lookups of declarations.
//!
//! Input: the source of a function, and its environment. Output: the result. A cached result is used only if all lookups that led to it
//! return the same answers, so it equals the result of folding. The number of results is bounded: the first ones remain.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use super::environment::{DeclarationKind, Environment};
use super::substitute::Substitute;
use crate::link::folded::FoldedFunction;

/// Returns the cached result for `text`, or calls `fold` and caches its result. `None` means that nothing changes.
pub(super) fn folded(
    text: &str,
    environment: &Environment<'_>,
    fold: impl FnOnce(&Environment<'_>) -> Option<FoldedFunction>,
) -> Option<Arc<FoldedFunction>> {
    if let Some(result) = cached(text, environment) {
        return result;
    }
    let log = LookupLog::default();
    let result = {
        let substitute = |name: &str| {
            let answer = (environment.substitute)(name);
            log.substitutes.borrow_mut().entry(name.to_owned()).or_insert(answer).clone()
        };
        let has_effects = |name: &str| {
            let answer = (environment.has_effects)(name);
            *log.effects.borrow_mut().entry(name.to_owned()).or_insert(answer)
        };
        let kind = |name: &str| {
            let answer = (environment.kind)(name);
            *log.kinds.borrow_mut().entry(name.to_owned()).or_insert(answer)
        };
        fold(&Environment { substitute: &substitute, has_effects: &has_effects, kind: &kind }).map(Arc::new)
    };
    let entry = CacheEntry {
        substitutes: log.substitutes.into_inner().into_iter().collect(),
        effects: log.effects.into_inner().into_iter().collect(),
        kinds: log.kinds.into_inner().into_iter().collect(),
        result: result.clone(),
    };
    cache().insert(text, entry);
    result
}

/// The maximum number of cached results. Each template has a few. Further sources are folded each time.
const MAX_ENTRIES: usize = 4096;

/// The lookups of one folding and their answers.
#[derive(Default)]
struct LookupLog {
    substitutes: RefCell<BTreeMap<String, Substitute>>,
    effects: RefCell<BTreeMap<String, Option<bool>>>,
    kinds: RefCell<BTreeMap<String, Option<DeclarationKind>>>,
}

/// A result, and the lookups that led to it.
struct CacheEntry {
    substitutes: Vec<(String, Substitute)>,
    effects: Vec<(String, Option<bool>)>,
    kinds: Vec<(String, Option<DeclarationKind>)>,
    result: Option<Arc<FoldedFunction>>,
}

/// The results by the sources of the functions.
#[derive(Default)]
struct FoldCache {
    entries: HashMap<Arc<str>, Vec<CacheEntry>>,
    count: usize,
}

impl FoldCache {
    /// Inserts a result unless the limit is reached.
    fn insert(&mut self, text: &str, entry: CacheEntry) {
        if self.count < MAX_ENTRIES {
            self.count += 1;
            self.entries.entry(text.into()).or_default().push(entry);
        }
    }
}

fn cache() -> std::sync::MutexGuard<'static, FoldCache> {
    static CACHE: LazyLock<Mutex<FoldCache>> = LazyLock::new(Mutex::default);
    // A thread that panicked while holding the lock left only complete entries.
    CACHE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the cached result of this source whose lookups have the same answers in `environment`.
fn cached(text: &str, environment: &Environment<'_>) -> Option<Option<Arc<FoldedFunction>>> {
    let cache = cache();
    let is_same = |entry: &&CacheEntry| {
        let substitutes = entry.substitutes.iter().all(|(name, answer)| (environment.substitute)(name) == *answer);
        let kinds = || entry.kinds.iter().all(|(name, answer)| (environment.kind)(name) == *answer);
        substitutes && kinds() && entry.effects.iter().all(|(name, answer)| (environment.has_effects)(name) == *answer)
    };
    cache.entries.get(text)?.iter().find(is_same).map(|entry| entry.result.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_cache_keeps_the_first_results() {
        let mut cache = FoldCache::default();
        for number in 0..=MAX_ENTRIES {
            let entry = CacheEntry { substitutes: Vec::new(), effects: Vec::new(), kinds: Vec::new(), result: None };
            cache.insert(&format!("fn f{number}() {{}}"), entry);
        }
        assert_eq!(cache.count, MAX_ENTRIES);
        assert!(cache.entries.contains_key("fn f0() {}"));
        assert!(!cache.entries.contains_key(format!("fn f{MAX_ENTRIES}() {{}}").as_str()));
    }
}
