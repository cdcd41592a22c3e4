//! Checks defaults of symbols and the indices of counters.

use std::collections::{BTreeMap, BTreeSet};

use crate::formula::{evaluate, names};
use crate::manifest::{Plan, Symbol};

/// The greatest number of defaults of which each names a symbol with the next: evaluation calls itself for each.
const LONGEST_CHAIN: usize = 8;

/// Checks that no default depends on itself or on a long chain of others.
pub fn check_defaults(plan: &Plan) -> Result<(), String> {
    // Of several symbols of one name the first counts.
    let mut waiting: BTreeMap<&str, &str> = plan.symbols.iter().rev().filter_map(default).collect();
    for _ in 0..LONGEST_CHAIN {
        let names_before: BTreeSet<&str> = waiting.keys().copied().collect();
        waiting.retain(|_, default| names(default).any(|name| names_before.contains(name)));
    }
    match waiting.first_key_value() {
        Some((name, default)) => Err(format!(
            "the default `{default}` of the symbol `{name}` depends on itself or on more than {LONGEST_CHAIN} defaults"
        )),
        None => Ok(()),
    }
}

/// Returns the name and the default of a symbol that has no value of its own.
fn default(symbol: &Symbol) -> Option<(&str, &str)> {
    let default = symbol.default.as_deref().filter(|_| symbol.value.is_none())?;
    Some((&symbol.name, default))
}

/// Checks that every counter is a word of the resource `counters`.
pub fn check_counters(plan: &Plan) -> Result<(), String> {
    let Some(last) = plan.counters.iter().max_by_key(|counter| counter.index) else { return Ok(()) };
    let symbol = |name: &str| {
        let symbol = plan.symbols.iter().find(|symbol| symbol.name == name);
        plan.constants.get(name).copied().or_else(|| symbol?.value)
    };
    let words = plan.resource("counters").and_then(|counters| evaluate(&counters.words, &symbol).ok());
    match words {
        None => Err("`counters` is no resource whose size is the same in every frame".to_owned()),
        Some(words) if u64::try_from(last.index).is_ok_and(|index| index < words) => Ok(()),
        Some(words) => {
            Err(format!("the counter `{}` is word {} of `counters`, which has {words}", last.name, last.index))
        }
    }
}
