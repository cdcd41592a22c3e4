//! A user's own WGSL file, between its head and the registry: does the text fulfil the contract of its axis?
//!
//! In: the row that the file's head says, and the places of its lines. Out: the row, whole (what a pass draws and how it
//! blends is its skeleton's affair, taken from the rows that use it already), or every mistake at the user's own line.
//! Which functions are needed follows from the rows that call them; nothing here names one.

use fragbuf_model::codes::{CONTRACT, REFUSED, ROW, UNKNOWN_AXIS, UNKNOWN_VALUE};
use fragbuf_model::{Diagnostic, Diagnostics, Origin, OwnRow, RowPlaces, mangled};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Fact, Host, Kind, Pass, Row, State, Step};

use crate::link::{Head, Item, heads, items, shape};
use crate::{CONTRACTS, Contract};

/// Makes the row of a user's file one of the registry's. Every mistake comes at once.
pub fn adopt(own: OwnRow, registry: &Registry) -> Result<Row, Diagnostics> {
    let OwnRow { mut row, ref places } = own;
    let mut faults = Diagnostics::new();
    steps(&mut row, places, registry, &mut faults);
    resources(&row, places, registry, &mut faults);
    parameters(&row, places, registry, &mut faults);
    defaults(&row, places, registry, &mut faults);
    if let Some(template) = &row.template {
        let file = File { text: &template.text, name: &places.row.file };
        match items(&template.text) {
            Ok(items) => {
                declarations(&items, &file, &mut faults);
                functions(&row, &file, places, registry, &mut faults);
                row.calls = calls(&row, &items, registry);
            }
            Err(line) => faults.push(Diagnostic::new(
                REFUSED,
                &file.line(line),
                "no declaration can be read here",
                "at module scope stand `fn`, `const`, `struct`, `alias` and `var<private>`, with every brace closed",
            )),
        }
    }
    faults.gate(row)
}

struct File<'a> {
    text: &'a str,
    name: &'a std::sync::Arc<str>,
}

impl File<'_> {
    /// A whole line, from 1.
    fn line(&self, number: usize) -> Origin {
        let text = self.text.lines().nth(number.saturating_sub(1)).unwrap_or("");
        let indent = text.chars().count() - text.trim_start().chars().count();
        Origin::new(self.name.clone(), number as u32, indent as u32 + 1).with_length(text.trim().chars().count() as u32)
    }

    /// A name by its byte offset.
    fn name_at(&self, at: usize, name: &str) -> Origin {
        let before = &self.text[..at];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |text| text.chars().count()) + 1;
        Origin::new(self.name.clone(), line as u32, column as u32).with_length(name.chars().count() as u32)
    }
}

/// Passes take their kind and state from a pass of the registry with the same skeleton.
fn steps(row: &mut Row, places: &RowPlaces, registry: &Registry, faults: &mut Diagnostics) {
    let (mut unknown, axis) = (false, row.axis.clone());
    for (step, place) in row.steps.iter_mut().zip(&places.steps) {
        if let Step::Host(host) = step {
            host_function(host, place, registry, faults);
        }
        let Step::Pass(pass) = step else { continue };
        if let Some((kind, state)) = shape_of(&pass.skeleton, registry) {
            (pass.kind, pass.state) = (kind, state);
            continue;
        }
        unknown = true;
        let hint = format!("the passes are {}", known_skeletons(registry).join(", "));
        let message = format!("there is no pass `{}`", pass.skeleton);
        faults.push(Diagnostic::new(UNKNOWN_VALUE, place, message, hint));
    }
    let mut others = registry.rows_of(&axis).peekable();
    let is_start = others.peek().is_some() && others.all(draws);
    if is_start && !unknown && !draws(row) {
        let message = format!("no pass of the row draws the scene, and a {axis} needs one");
        faults.push(Diagnostic::new(ROW, &places.row, message, "add a line such as `//: pass store: entries plain`"));
    }
}

/// A host step calls a row of the axis `host`.
fn host_function(host: &Host, place: &Origin, registry: &Registry, faults: &mut Diagnostics) {
    if registry.row("host", &host.function).is_some_and(|row| row.host.is_some()) {
        return;
    }
    let known: Vec<&str> = registry.rows_of("host").map(|row| row.key.as_str()).collect();
    let message = format!("there is no host function `{}`", host.function);
    let hint = format!("the functions are {}; a program adds its own by `Registry::with`", known.join(", "));
    faults.push(Diagnostic::new(UNKNOWN_VALUE, place, message, hint));
}

/// Whether a pass of the row draws the scene.
fn draws(row: &Row) -> bool {
    all_passes(&row.steps).iter().any(|pass| pass.kind == Kind::Geometry)
}

fn shape_of(skeleton: &str, registry: &Registry) -> Option<(Kind, State)> {
    passes(registry).find(|pass| pass.skeleton == skeleton).map(|pass| (pass.kind.clone(), pass.state.clone()))
}

fn known_skeletons(registry: &Registry) -> Vec<String> {
    let mut known: Vec<String> = Vec::new();
    for pass in passes(registry) {
        if !known.contains(&pass.skeleton) {
            known.push(pass.skeleton.clone());
        }
    }
    known
}

/// The passes that a file may have: not those with tests and targets of their own, whose textures no file declares.
fn passes(registry: &Registry) -> impl Iterator<Item = &Pass> {
    let is_plain = |pass: &&Pass| {
        let state = &pass.state;
        let tests = state.depth.is_some() || state.stencil.is_some() || state.samples.is_some();
        !tests && state.targets.iter().all(|target| target.resource == OUTPUT)
    };
    registry.rows().iter().flat_map(|row| all_passes(&row.steps)).filter(is_plain)
}

/// The vocabulary's name for the caller's own target.
const OUTPUT: &str = "output";

/// Passes in order, those inside loops included.
fn all_passes(steps: &[Step]) -> Vec<&Pass> {
    let mut passes = Vec::new();
    for step in steps {
        match step {
            Step::Pass(pass) => passes.push(pass),
            Step::Repeat(repeat) => passes.extend(all_passes(&repeat.body)),
            _ => {}
        }
    }
    passes
}

fn resources(row: &Row, places: &RowPlaces, registry: &Registry, faults: &mut Diagnostics) {
    for (resource, place) in row.resources.iter().zip(&places.resources) {
        let name = &resource.name;
        let owner = registry
            .rows()
            .iter()
            .find(|other| other.axis != row.axis && other.resources.iter().any(|resource| resource.name == *name));
        let taken = match owner {
            Some(owner) => format!("`{}: {}` has a buffer `{name}` too", owner.axis, owner.key),
            None if mangled(name) != name.as_str() => format!("`{name}` is a name of WGSL or of generated code"),
            None => continue,
        };
        faults.push(Diagnostic::new(CONTRACT, place, taken, format!("choose another name, such as `own_{name}`")));
    }
}

/// Constants of the rows of other axes may stand in the same program.
fn parameters(row: &Row, places: &RowPlaces, registry: &Registry, faults: &mut Diagnostics) {
    for (index, (parameter, place)) in row.parameters.iter().zip(&places.parameters).enumerate() {
        let constant = &parameter.constant;
        let others = registry.rows().iter().filter(|other| other.axis != row.axis).flat_map(|other| &other.parameters);
        if others.chain(&row.parameters[..index]).any(|other| other.constant == *constant) {
            let message = format!("another row, or this, has a constant `{constant}` too");
            let hint = format!("choose another name, such as `OWN_{constant}`");
            faults.push(Diagnostic::new(CONTRACT, place, message, hint));
        }
    }
}

fn defaults(row: &Row, places: &RowPlaces, registry: &Registry, faults: &mut Diagnostics) {
    for ((axis, value), place) in row.defaults.iter().zip(&places.defaults) {
        let values: Vec<&str> = registry.rows_of(axis).map(|row| row.key.as_str()).collect();
        if registry.axis(axis).is_none_or(|axis| !axis.chosen) {
            let known: Vec<&str> = registry.axes().iter().filter(|axis| axis.chosen).map(|axis| axis.key).collect();
            let hint = format!("the axes are {}", known.join(", "));
            faults.push(Diagnostic::new(UNKNOWN_AXIS, place, format!("there is no axis `{axis}`"), hint));
        } else if !values.contains(&value.as_ref()) {
            let message = format!("`{value}` is no value of the axis `{axis}`");
            let hint = format!("the values of `{axis}` are {}", values.join(", "));
            faults.push(Diagnostic::new(UNKNOWN_VALUE, place, message, hint));
        }
    }
}

/// Entry points and bindings are generated, or the skeletons'.
fn declarations(items: &[Item<'_>], file: &File<'_>, faults: &mut Diagnostics) {
    for item in items {
        let place = file.line(item.declared_line);
        if item.stage.is_some() {
            let message = format!("`{}` is an entry point, which only passes have", item.name);
            faults.push(Diagnostic::new(
                CONTRACT,
                &place,
                message,
                "make it a function that a contract function calls",
            ));
        } else if item.is_bound {
            let message = format!("`{}` has a binding of its own", item.name);
            let hint = "declare it in the head, `//: buffer name[pixel < pixels]: word`, and use `name_load(pixel)`";
            faults.push(Diagnostic::new(CONTRACT, &place, message, hint));
        }
    }
}

/// Contract functions have their heads, and those that somebody calls are there.
fn functions(row: &Row, file: &File<'_>, places: &RowPlaces, registry: &Registry, faults: &mut Diagnostics) {
    let heads = heads(file.text);
    for Head { name, signature, at } in &heads {
        let Some(contract) = CONTRACTS.iter().find(|contract| contract.name == *name) else { continue };
        let place = file.name_at(*at, name);
        if contract.axis != row.axis {
            let message = format!("`fn {name}` belongs to the axis `{}`", contract.axis);
            let hint = format!("this file is a {}: give the function another name", row.axis);
            faults.push(Diagnostic::new(CONTRACT, &place, message, hint));
        } else if shape(signature) != shape(contract.signature) {
            let message = format!("`fn {name}{signature}` does not fit the contract");
            let hint = format!("write `fn {name}{}`: {}", contract.signature, contract.promise);
            faults.push(Diagnostic::new(CONTRACT, &place, message, hint));
        }
    }
    for (contract, caller, place) in needed(row, places, registry) {
        let is_shared = || registry.shared().iter().any(|shared| heads_of(&shared.text, contract.name));
        if !heads.iter().any(|head| head.name == contract.name) && !is_shared() {
            let message = format!("{caller} calls `fn {}`, and the file has none", contract.name);
            let hint = format!("add `fn {}{}`: {}", contract.name, contract.signature, contract.promise);
            faults.push(Diagnostic::new(CONTRACT, &place, message, hint));
        }
    }
}

/// Whether the text has a function of this name. A shared one serves rows that have none of their own.
fn heads_of(text: &str, name: &str) -> bool {
    heads(text).iter().any(|head| head.name == name)
}

/// The functions that a row must have, each with a caller and the line that brings the caller in: skeletons call from the
/// row's passes, rows of other axes where everything that they require is offered here.
fn needed(row: &Row, places: &RowPlaces, registry: &Registry) -> Vec<(&'static Contract, String, Origin)> {
    let mut needed: Vec<(&'static Contract, String, Origin)> = Vec::new();
    for caller in registry.rows().iter().filter(|caller| caller.axis != row.axis) {
        let Some(template) = &caller.template else { continue };
        let is_chosen = registry.axis(&caller.axis).is_some_and(|axis| axis.chosen);
        // What no row of the axis offers is the affair of other axes, or of the description.
        let is_others = |fact: &Fact| !registry.rows_of(&row.axis).any(|other| other.may_offer(*fact));
        let suits = || caller.requires.iter().all(|fact| row.may_offer(*fact) || is_others(fact));
        let (name, place) = match is_chosen {
            true if suits() => (format!("`{}: {}`", caller.axis, caller.key), places.row.clone()),
            true => continue,
            false => match pass_line(row, &caller.key, places) {
                Some(place) => (format!("pass `{}`", caller.key), place),
                None => continue,
            },
        };
        let mentioned = items(&template.text).unwrap_or_default();
        for contract in CONTRACTS.iter().filter(|contract| contract.axis == row.axis) {
            let calls = mentioned.iter().any(|item| item.mentions.contains(&contract.name));
            if calls && !needed.iter().any(|(known, ..)| known.name == contract.name) {
                needed.push((contract, name.clone(), place.clone()));
            }
        }
    }
    needed
}

/// The line of the pass with this skeleton; the row's own where the row has no passes and serves everybody's.
fn pass_line(row: &Row, skeleton: &str, places: &RowPlaces) -> Option<Origin> {
    if row.steps.is_empty() {
        return Some(places.row.clone());
    }
    let is_it = |step: &Step| matches!(step, Step::Pass(pass) if pass.skeleton == skeleton);
    row.steps.iter().zip(&places.steps).find(|(step, _)| is_it(step)).map(|(_, place)| place.clone())
}

/// The contracts that the text calls, by axis. Functions of a pass are there wherever the pass is.
fn calls(row: &Row, items: &[Item<'_>], registry: &Registry) -> Vec<&'static str> {
    let mut calls: Vec<&'static str> = Vec::new();
    let is_chosen = |axis: &str| registry.axis(axis).is_some_and(|axis| axis.chosen);
    for contract in CONTRACTS.iter().filter(|contract| contract.axis != row.axis && is_chosen(contract.axis)) {
        let is_called = items.iter().any(|item| item.mentions.contains(&contract.name));
        if is_called && !calls.contains(&contract.axis) {
            calls.push(contract.axis);
        }
    }
    calls
}
