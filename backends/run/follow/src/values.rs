//! The values of a plan's symbols: what the caller sets, what host steps decide, constants and defaults.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::Error;
use crate::formula::evaluate;
use crate::manifest::{Action, Plan, Resource};

/// The values of symbols for a frame of one size.
#[derive(Clone)]
pub struct Values {
    plan: Arc<Plan>,
    set: BTreeMap<String, u64>,
    decided: BTreeMap<String, u64>,
    /// The symbols that host steps set.
    decisions: BTreeSet<String>,
    /// The resources that a command uses before a host step sets `k`. They have memory for the greatest k, so that
    /// their words keep their positions.
    used_before_k: BTreeSet<String>,
}

impl Values {
    /// Returns the values for frames, or slices of frames, of this size.
    pub fn new(plan: Arc<Plan>, [width, height]: [u32; 2]) -> Self {
        let actions = plan.steps.iter().map(|step| &step.action);
        let sets = actions.filter_map(|action| match action {
            Action::Host { sets, .. } => Some(sets),
            _ => None,
        });
        let set = BTreeMap::from([("width".to_owned(), width.into()), ("height".to_owned(), height.into())]);
        Values {
            set,
            decided: BTreeMap::new(),
            decisions: sets.flatten().cloned().collect(),
            used_before_k: used_before_k(&plan),
            plan,
        }
    }

    /// Returns the same values for another size.
    pub fn resized(&self, [width, height]: [u32; 2]) -> Self {
        let mut values = self.clone();
        values.set.insert("width".to_owned(), width.into());
        values.set.insert("height".to_owned(), height.into());
        values
    }

    /// Begins a slice of some rows: nothing is decided yet.
    pub fn begin_slice(&mut self, first_row: u32, rows: u32) {
        self.decided.clear();
        self.set.insert("first_row".to_owned(), first_row.into());
        self.set.insert("height".to_owned(), rows.into());
    }

    /// Sets a symbol for the caller.
    pub fn set(&mut self, name: &str, value: u64) -> Result<(), Error> {
        let is_settable = |set_by: &str| set_by == "caller" || set_by == "host";
        let fixed = ["width", "height"];
        let mut settable = self.plan.symbols.iter().filter(|symbol| {
            is_settable(&symbol.set_by) && symbol.value.is_none() && !fixed.contains(&symbol.name.as_str())
        });
        let Some(symbol) = settable.clone().find(|symbol| symbol.name == name) else {
            let names: Vec<String> = settable.by_ref().map(|symbol| format!("`{}`", symbol.name)).collect();
            return Err(Error(format!("no symbol `{name}` can be set; those that can be set: {}", names.join(", "))));
        };
        if !(symbol.least..=symbol.most).contains(&value) {
            return Err(Error(format!("`{name}` is {value}: set it from {} to {}", symbol.least, symbol.most)));
        }
        self.set.insert(name.to_owned(), value);
        Ok(())
    }

    /// Sets what a host step has decided.
    pub(crate) fn decide(&mut self, name: &str, value: u64) -> Result<(), Error> {
        let symbol = self.plan.symbols.iter().find(|symbol| symbol.name == name);
        let range = symbol.map_or(0..=u64::MAX, |symbol| symbol.least..=symbol.most);
        if !range.contains(&value) {
            let (least, most) = (range.start(), range.end());
            return Err(Error(format!("a host step sets `{name}` to {value}, which is not from {least} to {most}")));
        }
        self.decided.insert(name.to_owned(), value);
        Ok(())
    }

    /// Returns the value of a formula in this iteration of the innermost loop.
    pub fn value(&self, formula: &str, iteration: u64) -> Result<u64, Error> {
        self.value_with(formula, &[("iteration", iteration)])
    }

    /// Returns the value of a formula if some symbols had other values.
    pub(crate) fn value_with(&self, formula: &str, assumed: &[(&str, u64)]) -> Result<u64, Error> {
        let lookup = Lookup { values: self, assumed, defaults: RefCell::default() };
        let missing = RefCell::new(None);
        let symbol = |name: &str| {
            let value = lookup.symbol(name);
            if value.is_none() {
                *missing.borrow_mut() = Some(name.to_owned());
            }
            value
        };
        evaluate(formula, &symbol).map_err(|error| match missing.take() {
            Some(name) => Error(format!("the symbol `{name}` has no value: set it before the frame")),
            None => error,
        })
    }

    /// Returns the bytes of a buffer; an error while a symbol of its formula has no value.
    pub fn bytes(&self, resource: &Resource) -> Result<u64, Error> {
        self.bytes_with(resource, &[])
    }

    /// Returns the bytes of all buffers if symbols had these values.
    pub(crate) fn all_bytes_with(&self, assumed: &[(&str, u64)]) -> Result<u64, Error> {
        let buffers = self.plan.resources.iter().filter(|resource| resource.texture.is_none());
        buffers
            .map(|resource| self.bytes_with(resource, assumed))
            .try_fold(0_u64, |sum, bytes| Ok(sum.saturating_add(bytes?)))
    }

    fn bytes_with(&self, resource: &Resource, assumed: &[(&str, u64)]) -> Result<u64, Error> {
        let is_early = self.used_before_k.contains(&resource.name);
        let mut assumed = assumed.to_vec();
        if is_early && self.decisions.contains("k") {
            assumed.insert(0, ("k", self.value("capacity", 0)?));
        }
        self.value_with(&resource.bytes, &assumed)
    }
}

/// The values of symbols for one formula.
struct Lookup<'a> {
    values: &'a Values,
    /// Symbols with other values.
    assumed: &'a [(&'a str, u64)],
    /// The defaults that have been evaluated, by symbol: each is evaluated once, however often a formula names it.
    defaults: RefCell<BTreeMap<&'a str, Option<u64>>>,
}

impl<'a> Lookup<'a> {
    fn symbol(&self, name: &str) -> Option<u64> {
        let Values { plan, set, decided, decisions, .. } = self.values;
        if let Some((_, value)) = self.assumed.iter().find(|(known, _)| *known == name) {
            return Some(*value);
        }
        if let Some(value) = decided.get(name).or(set.get(name)).or(plan.constants.get(name)) {
            return Some(*value);
        }
        let symbol = plan.symbols.iter().find(|symbol| symbol.name == name)?;
        match (&symbol.default, symbol.value) {
            (_, Some(value)) => Some(value),
            // A host step of this frame has yet to set it.
            _ if decisions.contains(name) => None,
            (Some(default), _) => self.default(&symbol.name, default),
            // `first_row` and `iteration` outside of slices and loops.
            (None, None) => (symbol.when == "iteration").then_some(0),
        }
    }

    /// Returns the value of a default. `check` has limited how far defaults depend on each other.
    fn default(&self, name: &'a str, formula: &str) -> Option<u64> {
        let known = self.defaults.borrow().get(name).copied();
        known.unwrap_or_else(|| {
            let value = evaluate(formula, &|name| self.symbol(name)).ok();
            self.defaults.borrow_mut().insert(name, value);
            value
        })
    }
}

/// Returns the resources that commands use before a host step sets `k`, or in a loop around that step.
fn used_before_k(plan: &Plan) -> BTreeSet<String> {
    let sets_k = |action: &Action| matches!(action, Action::Host { sets, .. } if sets.iter().any(|name| name == "k"));
    let Some(decision) = plan.steps.iter().position(|step| sets_k(&step.action)) else { return BTreeSet::new() };
    let ends = plan.steps.iter().enumerate().filter_map(|(at, step)| match step.action {
        Action::Loop { end, .. } if (at..end).contains(&decision) => Some(end),
        _ => None,
    });
    let end = ends.max().unwrap_or(decision);
    let mut used = BTreeSet::new();
    for step in plan.steps.iter().take(end) {
        match &step.action {
            Action::Clear { resource, .. } => used.extend([resource.clone()]),
            Action::Copy { from, to } => used.extend([from.clone(), to.clone()]),
            Action::Pass(pass) => used.extend(pass.uses.keys().cloned()),
            _ => {}
        }
    }
    for pair in &plan.exchanges {
        if pair.resources.iter().any(|name| used.contains(name)) {
            used.extend(pair.resources.clone());
        }
    }
    used
}
