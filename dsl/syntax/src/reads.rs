//! What a function reads, including through helpers, and recursion among helpers.
//!
//! Input: checked functions and the names that their bodies use. Output: attribute and uniform names in order of first use;
//! an error for every cycle of calls.

use fragbuf_model::{Diagnostic, Reads, SourceSpan, codes};

use crate::report::Report;
use crate::tree::{Function, Use};

/// Returns what `function` reads, directly and through helpers.
pub(crate) fn of(function: &Function, helpers: &[Option<&Function>]) -> Reads {
    let mut reads = Reads::default();
    let mut entered = vec![false; helpers.len()];
    let mut open = vec![function.uses.iter()];
    while let Some(top) = open.last_mut() {
        match top.next() {
            None => drop(open.pop()),
            Some(Use::Attribute(name)) => add(&mut reads.attributes, name),
            Some(Use::Uniform(name)) => add(&mut reads.uniforms, name),
            Some(Use::Texture(name)) => add(&mut reads.textures, name),
            Some(Use::Image(name)) => add(&mut reads.images, name),
            Some(Use::Helper(index, _)) => {
                let first = entered.get_mut(*index).is_some_and(|seen| !std::mem::replace(seen, true));
                let helper = helpers.get(*index).copied().flatten();
                open.extend(helper.filter(|_| first).map(|helper| helper.uses.iter()));
            }
        }
    }
    reads
}

/// Tests for each helper whether one of the closures calls it, directly or through helpers.
pub(crate) fn called<'a>(closures: impl Iterator<Item = &'a Function>, helpers: &[Option<&'a Function>]) -> Vec<bool> {
    let mut called = vec![false; helpers.len()];
    let mut open: Vec<&Function> = closures.collect();
    while let Some(function) = open.pop() {
        for used in &function.uses {
            let Use::Helper(index, _) = used else { continue };
            let first = called.get_mut(*index).is_some_and(|seen| !std::mem::replace(seen, true));
            open.extend(helpers.get(*index).copied().flatten().filter(|_| first));
        }
    }
    called
}

fn add(names: &mut Vec<String>, name: &str) {
    if !names.iter().any(|other| other == name) {
        names.push(name.to_string());
    }
}

/// Reports each cycle of calls once, at the call that closes it.
pub(crate) fn reject_recursion(helpers: &[Option<&Function>], report: &mut Report) {
    let mut done = vec![false; helpers.len()];
    for start in 0..helpers.len() {
        search(start, helpers, &mut done, report);
    }
}

/// Searches depth first with an explicit stack of helpers, each with the index of its next call.
fn search(start: usize, helpers: &[Option<&Function>], done: &mut [bool], report: &mut Report) {
    let mut path: Vec<(usize, usize)> = vec![(start, 0)];
    while let Some((helper, next)) = path.last().copied() {
        let calls = helpers.get(helper).copied().flatten().map_or(&[][..], |function| function.uses.as_slice());
        let Some(used) = calls.get(next).filter(|_| !done.get(helper).copied().unwrap_or(true)) else {
            if let Some(flag) = done.get_mut(helper) {
                *flag = true;
            }
            path.pop();
            continue;
        };
        if let Some(top) = path.last_mut() {
            top.1 += 1;
        }
        let Use::Helper(callee, span) = used else { continue };
        if let Some(first) = path.iter().position(|(other, _)| other == callee) {
            let cycle: Vec<usize> = path.iter().skip(first).map(|(index, _)| *index).collect();
            report.push(recursion(&cycle, span, helpers));
        } else {
            path.push((*callee, 0));
        }
    }
}

/// The maximum number of functions of a cycle that a message names.
const NAMED: usize = 6;

fn recursion(cycle: &[usize], span: &SourceSpan, helpers: &[Option<&Function>]) -> Diagnostic {
    let functions: Vec<&Function> = cycle.iter().filter_map(|index| helpers.get(*index).copied().flatten()).collect();
    let name = |function: &Function| function.name.trim_start_matches("user_").to_string();
    let mut names: Vec<String> = functions.iter().map(|function| format!("`{}`", name(function))).collect();
    let first = names.first().cloned().unwrap_or_default();
    names.push(first.clone());
    let message = match functions.len() {
        1 => format!("{first} calls itself"),
        2..=NAMED => format!("{first} calls itself: {}", names.join(" calls ")),
        count => format!("{first} calls itself through {} others", count - 1),
    };
    let help = "shaders have no recursion: write a loop, `for _ in 0..64 { … }`";
    let mut diagnostic = Diagnostic::new(codes::RECURSION, span, message, help);
    for function in functions.into_iter().skip(1).take(NAMED) {
        diagnostic = diagnostic.label(&function.span, format!("`{}` is part of the cycle", name(function)));
    }
    diagnostic
}
